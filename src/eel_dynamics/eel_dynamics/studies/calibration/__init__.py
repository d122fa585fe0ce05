"""The table of accuracy: settings measured to deliver each target."""
