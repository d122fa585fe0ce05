"""The thread of the node that marches: waits, paces, takes requests and laws."""
