# SPDX-License-Identifier: Apache-2.0
"""The content of /diagnostics, collected from the run."""

import time
from typing import Any

from eel_common.ros.loop.diagnostics import ERROR, Report

from eel_dynamics.ros.declaration import Declaration
from eel_dynamics.ros.loop.run_loop import RunLoop

OVERDUE = 3.0  # s of wall time for one sample of a paced run, after which an error is reported
MANY = 100  # commands within one sample, which then explain its long computation
PERIOD = 1.0  # s of wall time, and of simulation time, after which /diagnostics is published again


class Status:
    """Collects the content of /diagnostics from a `run`."""

    def __init__(self, run: RunLoop, report: Report, parameters: Declaration) -> None:
        self._run, self._report, self._parameters = run, report, parameters
        self._seen = (0.0, 0.0)  # s: simulation time, wall time spent on samples
        self._last_published: tuple[float, float, Any] = (-PERIOD, 0.0, None)  # s, s: wall, simulation time; state

    def due(self) -> bool:
        """Whether to publish: after a second of wall time or of simulation time, and when the state has changed."""
        wall, simulated, state = self._last_published
        run = self._run
        return (
            time.monotonic() - wall >= PERIOD
            or abs(run.time - simulated) >= PERIOD
            or (run.standing, self._report.state()) != state
        )

    def collect(self, publishers_of_laws: int, final: bool = False) -> tuple[int, str, dict[str, Any]]:
        """Level, text and values. The real-time factor is that since the last call, or with `final` that of the run."""
        run = self._run
        if publishers_of_laws > 1:
            self._report.begin("laws", f"{publishers_of_laws} publishers of curvature_law: the later message wins")
        else:
            self._report.end("laws", "no more than one publisher of curvature_law again")
        if run.overdue > OVERDUE:
            acted = run.inputs.acted
            cause = f"for which {acted} commands have acted" if acted > MANY else "which takes too many steps"
            self._report.begin(
                "overdue",
                f"no sample for {run.overdue:.0f} s after t = {run.time:g} s, {cause}: another law, reset and pause "
                "are served",
                ERROR,
            )
        else:
            self._report.end("overdue")
        before, self._seen = (0.0, 0.0) if final else self._seen, (run.time, run.wall_time)
        simulated, wall = self._seen[0] - before[0], self._seen[1] - before[1]
        level, warnings = state = self._report.state()
        self._last_published = (time.monotonic(), run.time, (run.standing, state))
        values = {
            "law": run.laws.name,
            "accuracy": self._parameters.values.accuracy,
            "time": run.time,
            "real_time_factor": max(0.0, simulated) / wall if wall > 0.0 else 0.0,
            "late": max(0.0, run.pace.lost(run.samples_published)),
            **run.output.totals.values(),
            **run.output.errors.values,
            **run.inputs.joints.values(),
            **run.inputs.fins.values(),
            **run.inputs.wrenches.values(),
            **(run.output.saturation.values() if run.output.saturation is not None else {}),
            "samples_published": run.samples_published,
            "publishers_of_laws": publishers_of_laws,
            "warnings": "; ".join(warnings),
        }
        run.output.request_whole_snapshot()
        return level, (warnings[0] if warnings else "finished" if final else run.standing or "swimming"), values
