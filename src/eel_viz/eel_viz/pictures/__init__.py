"""Pictures and films of recordings, without a display: the command `render`."""
