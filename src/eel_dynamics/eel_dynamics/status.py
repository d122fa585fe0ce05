"""How the run goes, as the level, the line and the values of /diagnostics, and when there is something to tell."""

import time

from .report import ERROR

OVERDUE = 3.0  # s of wall time on the way to a sample at real time, after which something is wrong
PERIOD = 1.0  # s of wall time, and of simulation time, after which it is told again


class Status:
    """Collects the figures of a `March` from time to time."""

    def __init__(self, march, report, accuracy):
        self._march, self._report, self._accuracy = march, report, accuracy
        self._seen = (0.0, 0.0)  # s: simulation time, wall time marched
        self._told = (-PERIOD, 0.0, None)  # s: wall time, simulation time, and the state that was told

    def due(self) -> bool:
        """Whether to tell: once a second of wall time and of simulation time, and when the state has changed."""
        wall, simulated, state = self._told
        march = self._march
        return (
            time.monotonic() - wall >= PERIOD
            or abs(march.time - simulated) >= PERIOD
            or (march.standing, self._report.state()) != state
        )

    def collect(self, publishers_of_laws: int, final: bool = False) -> tuple[int, str, dict]:
        """Level, text, values; the real-time factor is that since the last collection, at the end that of the run."""
        march = self._march
        if publishers_of_laws > 1:
            self._report.begin("laws", f"{publishers_of_laws} publishers of curvature_law: the later message wins")
        else:
            self._report.end("laws", "no more than one publisher of curvature_law again")
        if march.overdue > OVERDUE:
            self._report.begin(
                "overdue",
                f"no sample for {march.overdue:.0f} s after t = {march.time:g} s, which takes too many steps: another "
                "law, reset and pause are heard",
                ERROR,
            )
        else:
            self._report.end("overdue")
        before, self._seen = (0.0, 0.0) if final else self._seen, (march.time, march.marched_for)
        simulated, wall = self._seen[0] - before[0], self._seen[1] - before[1]
        level, warnings = state = self._report.state()
        self._told = (time.monotonic(), march.time, (march.standing, state))
        values = {
            "law": march.law,
            "accuracy": self._accuracy,
            "time": march.time,
            "real_time_factor": max(0.0, simulated) / wall if wall > 0.0 else 0.0,
            "late": march.lost_time,
            **march.accounts.values(),
            "samples_published": march.samples_published,
            "publishers_of_laws": publishers_of_laws,
            "warnings": "; ".join(warnings),
        }
        march.account()
        return level, (warnings[0] if warnings else "finished" if final else march.standing or "swimming"), values
