"""rosbag2 files: recorded, read, and replayed into recordings; topics on a terminal."""
