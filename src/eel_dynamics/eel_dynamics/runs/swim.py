# SPDX-License-Identifier: Apache-2.0
"""A swim as one value: a swimmer, for how long it swims, and what of it is kept."""

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Self

from eel_common.cached import cached_property
from eel_common.quantity import number, positive
from eel_common.wording import shown
from eel_gaits.gaits.settings import Settings

from eel_dynamics.runs.motions import LAWS, check_motion, law_from
from eel_dynamics.runs.observed_swim import ObservedSwim, times_of
from eel_dynamics.runs.progress_monitor import ProgressMonitor
from eel_dynamics.runs.run import Run
from eel_dynamics.runs.sampling import check_memory
from eel_dynamics.runs.settled_duration import settling_time, until_settled
from eel_dynamics.simulation.simulation import Simulation
from eel_dynamics.simulation.swimmer import Swimmer


@dataclass(frozen=True, eq=False)
class Swim(Swimmer):
    """The arguments of `simulate` as one value. Every field has a default.

    law: any motion of `simulate`; None in settings that several swims share.
    """

    duration: float | str = 10.0  #: s, or "settled"
    sample_period: float | None = None  #: s
    load: bool = False  #: whether the water's load along the body is kept
    estimate: bool = True  #: whether the error is estimated
    gait: Settings | None = None  #: the settings of the gait that gave the law, if one did
    body_file: str = ""  #: the body's file, if any
    robot_file: str = ""  #: the robot's file, if any

    def __post_init__(self) -> None:
        super().__post_init__()
        if not until_settled(self.duration):
            number("duration", self.duration, "s", minimum=0.0)
        if self.sample_period is not None:
            positive("sample_period", self.sample_period, "s")
        self._set(load=bool(self.load), estimate=bool(self.estimate))

    def _checked_law(self) -> Any:
        if self.law is None or isinstance(self.law, LAWS):
            return super()._checked_law()
        check_motion(self.law)
        return self.law

    @cached_property
    def seconds(self) -> float:
        """The duration [s], also of one until the gait has settled."""
        if until_settled(self.duration):
            return settling_time(self)
        return float(self.duration)

    def observed(self) -> ObservedSwim[Run]:
        """The swim with the instants of its samples. `ValueError` where law, flow or memory do not suffice for them."""
        self.check_stations()
        law = law_from(self.law, self.seconds, self.body.length)
        swim = self if law is self.law else self.unchecked(law=law)
        times = times_of(swim, self.seconds, self.sample_period)
        check_memory(1, len(times), len(self.x), self.has_internal_wrench, self.load, 2 if self.estimate else 1)
        observed = ObservedSwim(Run, swim, times, self.load)
        return observed.to_refine() if self.estimate else observed

    def run(
        self, progress: Callable[[float, float], None] | None = None, *, stacklevel: int = 2, **changes: Any
    ) -> Run:
        """The run. progress, errors: as in `simulate`. stacklevel: of warnings. changes: of fields, as in `changed`."""
        observed = (self.changed(**changes) if changes else self).observed()
        if (slow := observed.slow_motors) is not None:
            warnings.warn(slow.text, stacklevel=stacklevel)
        seconds = float(observed.times[-1])
        run = observed.swim_to_end(ProgressMonitor(seconds, progress, stacklevel + 5).update)
        if run.error_estimate is not None and (missed := run.error_estimate.over_target(run.accuracy.target, seconds)):
            warnings.warn(missed, stacklevel=stacklevel)
        return run

    def simulation(self, **changes: Any) -> Simulation:
        """The swimmer at its start. changes: of fields, as in `changed`."""
        return Simulation(self, **changes)

    def with_gait(self, **numbers: Any) -> Self:
        """The same with changed `numbers` of the gait. `ValueError` if no gait gave the law."""
        return self.changed(**self.fields_of_gait(numbers))

    def fields_of_gait(self, numbers: dict[str, Any]) -> dict[str, Any]:
        """The law and the gait with changed `numbers`. `ValueError` if no gait gave the law."""
        if self.gait is None:
            raise ValueError(f"law {shown(getattr(self.law, 'name', None))} has no numbers: no gait gave it")
        gait = self.gait.changed(numbers)
        return {"law": gait.law(), "gait": gait}
