"""The node `dynamics`: ROS parameters, messages, and the run loop between them and the simulation."""
