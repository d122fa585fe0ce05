"""The nodes `visualiser` and `markers`."""
