"""Shows a swimmer in Rerun and records its topics; wired to the rest by topics alone.

The modules without ROS: `entities` (where things lie in a recording), `blueprint` (how they are arranged), `skin`,
`profile_plot`, `heat_map`, `scene` (what is drawn), `loggers` (messages to Rerun), `runs` and `intake` (which message
goes where), `sinks` (where recordings go), `bag` and `replay` (a bag to a recording), `library` (a run of the library
to one), `reading` (a recording back to arrays), `drawing` and `render` (a recording to pictures). With ROS: `node`,
`record`, `echo`.

Nothing is imported here, so that `import eel_viz` costs nothing.
"""
