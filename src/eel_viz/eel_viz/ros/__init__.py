"""The node `visualiser`."""
