"""The swimmer and its surroundings in three dimensions."""
