# SPDX-License-Identifier: Apache-2.0
"""The kinds of a robot's parts, by the keys of their lists. A new kind is a line here."""

from eel_dynamics.model.robot.continuous import Muscle, PassiveTail
from eel_dynamics.model.robot.joint import Joint

KINDS: dict[str, type[Joint | PassiveTail | Muscle]] = {kind.key: kind for kind in (Joint, PassiveTail, Muscle)}
