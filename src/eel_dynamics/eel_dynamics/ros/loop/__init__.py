"""The node's run loop: pacing, waiting, requests and laws."""
