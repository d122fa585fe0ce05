"""The best accuracy for a budget of time: "fastest within 5 ms per second", on this machine.

A short swim of a gait is timed in the scene at hand at one target after the other, from the coarsest to the finest,
until one takes longer than the budget; what was timed is kept for the process.
"""

import re
import time
from dataclasses import dataclass, replace
from functools import cache

from eel_gaits.wording import shown

from .accuracy import Accuracy, key_of, table
from .difficulty import NOMINAL, Difficulty
from .scene import Scene

UNITS = {"us": 1e-6, "ms": 1e-3, "s": 1.0}
PATTERN = re.compile(r"fastest within\s+([0-9.eE+-]+)\s*(us|ms|s) per second")
DURATION = 2.0  # s, of the swims that are timed
REPEATS = 3


@dataclass(frozen=True)
class Budget:
    """Wall time by simulated time, at most."""

    name: str
    seconds_per_second: float

    @staticmethod
    def of(text: str) -> "Budget":
        """The budget that a text such as "fastest within 5 ms per second" gives. `ValueError` where it does not."""
        found = PATTERN.fullmatch(text.strip())
        try:
            seconds = float(found.group(1)) * UNITS[found.group(2)] if found else 0.0
        except ValueError:
            seconds = 0.0
        if not 0.0 < seconds < float("inf"):
            raise ValueError(
                "accuracy must give its budget as in 'fastest within 5 ms per second' (us, ms or s; > 0), "
                f"got {shown(text)}"
            )
        return Budget(text.strip(), seconds)

    def in_scene(self, scene: Scene, plane: bool = False, difficulty: Difficulty = NOMINAL) -> Accuracy:
        """The finest settings of the table that keep within the budget in `scene`, for a motion that stays in a `plane`
        or for any, with the target that they deliver in a swim of such `difficulty`. `ValueError` where none does."""
        best, fastest = None, None
        for row in table()[key_of(scene)]:
            seconds = seconds_per_second(scene, row["target"])
            fastest = seconds if fastest is None else min(fastest, seconds)
            if seconds > self.seconds_per_second:
                break
            best = row["target"]
        if best is None:
            raise ValueError(
                f"accuracy {shown(self.name)} cannot be met on this machine in this scene: the coarsest run takes "
                f"{1e3 * fastest:.3g} ms per second"
            )
        key = key_of(scene, plane)
        target_scale = difficulty.target_scale(key.drag, key.torque, key.plane)
        return replace(Accuracy.of(best).in_scene(scene, plane), name=self.name, target=best / target_scale)


@cache
def seconds_per_second(scene: Scene, target: float) -> float:
    """Wall time [s] by second of the falling gait (straight in the plane) at a `target` in `scene`, samples every
    0.05 s."""
    from eel_gaits import falling, straight

    from .run import simulate

    law = straight() if scene.planar else falling()
    settings = Accuracy.of(target).in_scene(scene).as_it_is()
    best = float("inf")
    for repeat in range(REPEATS + 1):  # the first call tabulates, and may compile
        start = time.perf_counter()
        simulate(law, DURATION, scene=scene, accuracy=settings)
        if repeat:
            best = min(best, (time.perf_counter() - start) / DURATION)
    return best
