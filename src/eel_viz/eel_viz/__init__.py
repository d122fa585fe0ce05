"""Shows a swimmer in Rerun and records its topics; wired to the rest by topics alone.

The modules without ROS: `entities` (where things lie in a recording), `blueprint` (how they are arranged), `skin`,
`profile_plot`, `heat_map`, `scene` (what is drawn), `loggers` (messages to Rerun), `sinks` (where it goes), `reading`
(a recording back to arrays) and `render` (a recording to a picture). With ROS: `node`, `record`, `echo`.

Nothing is imported here, so that `import eel_viz` costs nothing.
"""
