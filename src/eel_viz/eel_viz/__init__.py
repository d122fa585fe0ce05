"""Shows a swimmer in Rerun and records its topics; wired to the rest by topics alone.

`scene3d` and `plots` draw, `recording` takes messages into recordings, `bags` holds rosbag2 files, `pictures` draws
recordings without a display, `ros` is the node. Only `ros` and `record`, `echo` and `definitions` in `bags` need ROS.

Nothing is imported here, so that `import eel_viz` costs nothing.
"""
