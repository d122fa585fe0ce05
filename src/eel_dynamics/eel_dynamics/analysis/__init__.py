"""What a run tells: speed, power, efficiency, actuators, limits of the model, summary."""
