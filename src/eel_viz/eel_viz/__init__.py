# SPDX-License-Identifier: Apache-2.0
"""Shows a swimmer in Rerun and records its topics. Topics are the only connection to the other packages.

`ros` holds the nodes visualiser, markers and record, and `echo`. `recording` turns messages into Rerun recordings, and
reads these. `views` arranges what is seen. `scene3d` draws in three dimensions, `plots` curves, maps and texts,
`robots` fins, joints and motors. `bags` reads bags, replays them, and writes those that grow. `pictures` renders
recordings. Only `ros`, and `definitions` in `bags`, import ROS.

Nothing else is imported here, so that `import eel_viz` costs nothing.
"""

import sys
from types import SimpleNamespace
from typing import Any

import eel_command  # noqa: F401  first: Ctrl-C ends a command during the other imports


def keep_pandas_out() -> None:
    """Let pyarrow find no pandas. For a command's `main`: a library must leave pyarrow as its user wants it.

    pyarrow looks for pandas once, at its first array, and does without where it is not installed. The import takes more
    than half of the start of the visualiser, which has no pandas objects.
    """
    import pyarrow

    def refuse(name: str, path: object = None, target: object = None) -> None:
        if name == "pandas":
            raise ModuleNotFoundError("pandas is left out")

    finder: Any = SimpleNamespace(find_spec=refuse)
    sys.meta_path.insert(0, finder)
    pyarrow.array([0])
    sys.meta_path.remove(finder)
