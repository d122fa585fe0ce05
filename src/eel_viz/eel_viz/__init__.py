# SPDX-License-Identifier: Apache-2.0
"""Shows a swimmer in Rerun and records its topics. Topics are the only connection to the other packages.

`ros` holds the nodes visualiser, markers and record, and `echo`. `recording` turns messages into Rerun recordings, and
reads recordings. `views` arranges the views. `scene3d` draws in three dimensions, `plots` curves, maps and texts,
`robots` fins, joints and motors. `bags` reads bags, replays them, and writes growing ones. `pictures` renders
recordings. Only `ros`, and `definitions` in `bags`, import ROS.

Nothing else is imported here, so `import eel_viz` costs nothing.
"""

import eel_command  # noqa: F401  first: Ctrl-C ends a command during the other imports
