"""How exact a run is to be: from a target or a budget of time to settings."""
