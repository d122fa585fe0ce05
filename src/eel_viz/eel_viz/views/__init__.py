"""The arrangements of views in a recording: Rerun blueprints, without data."""
