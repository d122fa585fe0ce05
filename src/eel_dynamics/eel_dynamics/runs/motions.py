# SPDX-License-Identifier: Apache-2.0
"""A law from any description of a motion: a law, a function K(t, X), or a file; and the effect of smoothing on it."""

import inspect
import os
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from eel_common.files.tables import is_table
from eel_common.quantity import is_finite
from eel_common.wording import shown
from eel_gaits.gaits.registry import GAITS
from eel_gaits.laws.law import Law
from eel_gaits.sources.function_law import sampled
from eel_gaits.sources.motion_file import ARCHIVE, read_motion
from eel_gaits.sources.sampled_law import SampledLaw

from eel_dynamics.analysis.analysis import Analysis
from eel_dynamics.runs.run_data import RunData

LAWS = Law, SampledLaw
Motion = Law | SampledLaw | Callable[..., Any] | str | os.PathLike[str]


def law_from(motion: Motion, duration: float, length: float) -> Law | SampledLaw:
    """The law of a `motion` for `duration` [s] and a body of `length` [m]. `ValueError` for an unsuitable one."""
    check_motion(motion)
    if isinstance(motion, LAWS):
        return motion
    if callable(motion):
        return sampled(motion, duration, length=length)
    return read_motion(motion, length=length)


def check_motion(motion: Any) -> None:
    """`ValueError` for a `motion` that is no law, no function K(t, X), and no file."""
    if isinstance(motion, LAWS) or (isinstance(motion, (str, os.PathLike)) and is_table(motion, ARCHIVE)):
        return
    if not callable(motion):
        raise _no_motion(motion, f": write gait({motion!r})" if isinstance(motion, str) and motion in GAITS else "")
    if not _takes(motion, 0.0, None):
        name = getattr(motion, "__name__", type(motion).__name__)
        raise _no_motion(motion, f": call it, {name}()" if _takes(motion) else ", which does not take (t, X)")


def _no_motion(motion: object, hint: str) -> ValueError:
    kinds = "a Law, a SampledLaw, a function K(t, X) or a table (.csv, .txt ...) or .npz file"
    return ValueError(f"law must be {kinds}, got {shown(motion)}{hint}")


def _takes(function: Callable[..., Any], *arguments: Any) -> bool:
    """Whether `function` can be called with these arguments; True if that is unknown."""
    try:
        inspect.signature(function).bind(*arguments)
    except TypeError:
        return False
    except ValueError:  # it has no signature
        return True
    return True


def check_duration(law: Law | SampledLaw, duration: float) -> None:
    """`ValueError` if the motion of `law` is shorter than `duration` [s]."""
    if isinstance(law, SampledLaw) and is_finite(duration) and duration > law.duration * (1.0 + 1e-9):
        raise ValueError(
            f"duration must be at most {law.duration:g} s, that of the motion {shown(law.name)}, got {duration:g} s"
        )


class SmoothingEffect(NamedTuple):
    """A run without the smoothing of its measured motion, relative to the run; None: undefined."""

    speed: float | None  # mean speed
    torque: float | None  # root mean square of the internal torque
    path: float  # distance of the heads at the end, relative to the length of the path

    def __str__(self) -> str:
        speed = "undefined" if self.speed is None else f"{self.speed:.3f} times"
        torque = "" if self.torque is None else f", RMS torque {self.torque:.3f} times"
        return f"without it: mean speed {speed}{torque}, the head ends {self.path:.2%} of its path elsewhere"


def effect_of_smoothing(run: RunData, without: RunData) -> SmoothingEffect:
    """The effect of smoothing the motion of `run`. without: the run of the same motion without smoothing."""
    before, after = _mean_speed(without), _mean_speed(run)
    speed = before / after if before is not None and after is not None and after > 0.0 else None
    torque = None
    if run.torque is not None and without.torque is not None and np.any(run.torque):
        torque = float(np.linalg.norm(without.torque) / np.linalg.norm(run.torque))
    apart = float(np.linalg.norm(without.position[-1] - run.position[-1]))
    return SmoothingEffect(speed, torque, apart / max(run.path_length, run.body.length))


def _mean_speed(run: RunData) -> float | None:
    try:
        return Analysis(run).mean_speed
    except ValueError:  # the motion does not repeat
        return None
