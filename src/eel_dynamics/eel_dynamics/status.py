"""How the run goes, as the level, the line and the values of /diagnostics."""


class Status:
    """Collects the figures of a `March` from time to time."""

    def __init__(self, march, report, accuracy):
        self._march, self._report, self._accuracy = march, report, accuracy
        self._seen = (0.0, 0.0)  # s: simulation time, wall time marched

    def collect(self, publishers_of_laws: int, final: bool = False) -> tuple[int, str, dict]:
        """Level, text, values; the real-time factor is that since the last collection, at the end that of the run."""
        march = self._march
        if publishers_of_laws > 1:
            self._report.begin("laws", f"{publishers_of_laws} publishers of curvature_law: the later message wins")
        else:
            self._report.end("laws", "no more than one publisher of curvature_law again")
        before, self._seen = (0.0, 0.0) if final else self._seen, (march.time, march.marched_for)
        simulated, wall = self._seen[0] - before[0], self._seen[1] - before[1]
        level, warnings = self._report.state()
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
