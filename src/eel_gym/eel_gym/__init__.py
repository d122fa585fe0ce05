# SPDX-License-Identifier: Apache-2.0
"""Environments of Gymnasium: a swimmer that learns. Importing this package registers them.

    import gymnasium
    import eel_gym

    env = gymnasium.make("Eel/Heading-v0")
    envs = gymnasium.make_vec("Eel/Heading-v0", num_envs=16)

`SwimmerEnv` is the base class for your own tasks. `ImportError` without gymnasium.
"""

try:
    import gymnasium
except ImportError as error:
    raise ImportError(f"eel_gym needs gymnasium ({error}); install it with: pip install gymnasium") from None

from eel_common.head_motion import HeadMotion

from eel_gym.depth import DepthEnv
from eel_gym.heading import HeadingEnv
from eel_gym.joint_action import JointAction
from eel_gym.knot_action import KnotAction
from eel_gym.law_action import LawAction
from eel_gym.swimmer_env import SwimmerEnv
from eel_gym.task import Episode, Observed, Start
from eel_gym.vector_env import ThreadedVectorEnv
from eel_gym.way_points import WayPointsEnv

__all__ = [
    "DepthEnv",
    "Episode",
    "HeadMotion",
    "HeadingEnv",
    "JointAction",
    "KnotAction",
    "LawAction",
    "Observed",
    "Start",
    "SwimmerEnv",
    "ThreadedVectorEnv",
    "WayPointsEnv",
]

for _task in (HeadingEnv, DepthEnv, WayPointsEnv):
    gymnasium.register(
        f"Eel/{_task.name}-v0",
        entry_point=f"{_task.__module__}:{_task.__name__}",
        vector_entry_point=f"eel_gym.vector_env:{_task.__name__.removesuffix('Env')}VectorEnv",
    )
