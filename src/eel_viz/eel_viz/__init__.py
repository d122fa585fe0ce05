# SPDX-License-Identifier: Apache-2.0
"""Shows a swimmer in Rerun and records its topics. Topics are the only connection to the other packages.

`ros` holds the visualiser node. `recording` turns messages into Rerun recordings: dispatcher, loggers, destinations,
blueprint, and the reader of recordings. `scene3d` draws in three dimensions, `plots` draws curves, maps and texts.
`bags` records, prints and replays bags. `pictures` renders recordings. Only `ros`, and `record`, `echo` and
`definitions` in `bags`, import ROS.

Nothing else is imported here, so that `import eel_viz` costs nothing.
"""

import eel_command  # noqa: F401  first: Ctrl-C ends a command during the other imports
