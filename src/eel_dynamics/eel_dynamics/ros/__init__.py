"""The node `dynamics`."""
