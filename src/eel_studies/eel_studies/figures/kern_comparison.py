# SPDX-License-Identifier: Apache-2.0
"""Comparison with published results for a second body: the eel of Kern and Koumoutsakos.

J. Exp. Biol. 209 (2006), 4841-4857, doi:10.1242/jeb.02526. They computed the flow from the Navier-Stokes equations in
three dimensions.
"""

from dataclasses import dataclass

from eel_base.files.markdown import table
from eel_dynamics.analysis.analysis import Analysis
from eel_dynamics.runs.simulate import simulate
from eel_model.body.body import Body
from eel_model.scene import Scene

from eel_gaits import kern_efficient, kern_fast
from eel_studies.points import AccuracyLike

VISCOSITY = 1.4e-4  # L^2/T of the computations: Reynolds numbers of some thousands
VOLUME = 0.0059326  # L^3, of the published shape
PUBLISHED_FASTER = 0.42  # excess of the fast gait over the efficient one
PUBLISHED_LESS_EFFICIENT = 0.15
PUBLISHED_SPEEDS = (0.26, 0.5)  # L per cycle, over the gaits computed


@dataclass(frozen=True)
class Comparison:
    """The analyses of both gaits, over the later half of runs from rest."""

    volume: float  # L^3
    fast: Analysis
    efficient: Analysis

    @property
    def faster(self) -> float:
        """Relative excess of the fast gait's mean speed over that of the efficient gait."""
        return self.fast.mean_speed / self.efficient.mean_speed - 1.0

    def less(self, efficiency: str) -> float:
        """Relative deficit of the fast gait in `efficiency`, the name of an `Analysis` property."""
        return 1.0 - float(getattr(self.fast, efficiency) / getattr(self.efficient, efficiency))


def compare(periods: int = 20, accuracy: AccuracyLike = "standard") -> Comparison:
    """Simulate `periods` periods of both gaits from rest, with L = 1 m, T = 1 s and the published viscosity."""
    body, scene = Body.kern2006(), Scene(viscosity=VISCOSITY)
    fast, efficient = (
        simulate(gait(), float(periods), body=body, scene=scene, accuracy=accuracy).analysis()
        for gait in (kern_fast, kern_efficient)
    )
    return Comparison(body.volume, fast, efficient)


def table_of(comparison: Comparison) -> str:
    """Our results beside the published ones, as a Markdown table."""
    low, high = PUBLISHED_SPEEDS
    rows = [
        ("volume [L^3]", f"{comparison.volume:.7f}", f"{comparison.volume:.7f}", f"{VOLUME}"),
        _row("mean speed U, stride U T/L", comparison, "stride", f"{low} to {high} over all their gaits"),
        ("its excess over the other", f"{comparison.faster:+.1%}", "", f"{PUBLISHED_FASTER:+.0%}"),
        _row("Strouhal number f A/U", comparison, "strouhal", "live eels near 0.32 (Tytell 2004), at higher Re"),
        _row("slip U T/lambda", comparison, "slip", ""),
        _row("Reynolds number U L/nu", comparison, "reynolds", "about 4e3", ".0f"),
        _row("propulsive efficiency", comparison, "propulsive_efficiency", "defined otherwise"),
        ("its excess over the other", f"{-comparison.less('propulsive_efficiency'):+.1%}", "", _less()),
        _row("hydromechanical efficiency", comparison, "hydromechanical_efficiency", "defined otherwise"),
        ("its excess over the other", f"{-comparison.less('hydromechanical_efficiency'):+.1%}", "", _less()),
    ]
    return table(("quantity", "`kern_fast`", "`kern_efficient`", "computed flow"), rows)


def _row(name: str, comparison: Comparison, field: str, theirs: str, form: str = ".3f") -> tuple[str, ...]:
    return name, *(format(getattr(each, field), form) for each in (comparison.fast, comparison.efficient)), theirs


def _less() -> str:
    return f"{-PUBLISHED_LESS_EFFICIENT:+.0%} in theirs"
