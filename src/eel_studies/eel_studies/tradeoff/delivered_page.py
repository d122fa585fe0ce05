# SPDX-License-Identifier: Apache-2.0
"""Writes docs/explanation/accuracy.md: what a target means, what it costs, and what targets deliver."""

from pathlib import Path

from eel_base.files.output_file import replacing

from eel_studies.tradeoff.delivered import REFERENCES, Trial, delivered_table
from eel_studies.tradeoff.price import SWIMS

PAGE = """# What a target of accuracy means

Made by `eel tradeoff --delivered --count {count} --seed {seed} --page {page}`.

`simulate(law, accuracy=1e-4)` sets a target for two relative errors:
- The error of the head's position is the greatest over the later half of the run, relative to the length of the path,
  or to the length of the body if that is greater.
- The error of the internal torque is the greatest over all samples and stations, relative to the greatest torque, or
  to a thousandth of m (l/T)^2 if that is greater (body mass m, body length l, period T).

The presets are targets: `draft` 1e-2, `standard` 1e-4, `fine` 1e-6, `reference` 1e-8.

**From a target to settings.** One rule (`accuracy.py`) chooses them. `simulate` and `simulate_batch` begin with a
tolerance per step of a 400th of the target, because a run takes hundreds of steps, and make the run finer where its
measured error asks for it. A motion that cannot be made finer (a node's, `Simulation`, `estimate=False`) has a
thousandth, and more points: sensitive ones need that. The body gets eight points per length for each decade of the
target (seven, less three, in a run that can be made finer), because Gauss quadrature in panels without kinks converges
exponentially. With `friction="blended"`, whose law changes along the body, it converges no faster than with some third
power of the points: then no points are spared. Runs with energy ledger use an embedded Runge-Kutta pair of orders 5(4),
and so do runs with torque at targets below 5e-4; others use Adams' method of order 5.
The data points of a body from a file are kinks that lie inside the panels. There the section data at the nodes have the
moments of the data's spline, so that the integrals converge as those of a smooth body
([moments.py](../../src/eel_dynamics/eel_dynamics/model/moments.py)).

**Each run measures its own error** (`companion.py`). A second run, the *companion*, has 20 times the tolerance (30
times where that of the run is above 1e-6), half of the points (always on another grid) and longest steps of 1.5 times
the length. It keeps no ledger, so it marches by Adams' method, with a third of that tolerance where the run used the
pair: Adams' error is some three times that of the pair.
The difference between the two is `run.error_estimate`. It is mostly the companion's error, so the estimate is
conservative. It is not scaled by an order. It includes the growth of errors in a sensitive motion, which the error of a
single step does not.

**If the estimate is above two thirds of the target**, the run becomes the companion of a finer run, up to four
times. The new estimate counts for no less than the last one times the ratio of the tolerances (or, with blended
friction, the third power of that of the nodes): where two runs are nearer than that, they agree by chance. If the
estimate is still above the target, `simulate` warns. `run.warnings` has the same line, with the estimate and the time
in which errors grow by a factor of e. A warning also says so if the growth of round-off alone exceeds a tenth of the
target. In `simulate_batch` this is `batch.above_target`, in `sweep` the measures error_position and error_torque.

**Without a target.** `estimate=False` gives the run without a companion. Settings given one by one are kept; their
error is measured, and not compared with a target. The same holds for a budget of time. `Simulation` measures none.

**In the node** `dynamics` (in Python: `Simulation(..., measure_error=True)`) a companion advances with it. It gets
the same laws and samples. Published samples cannot be refined, so a missed target is reported: WARN in the log and
in `/diagnostics`, which has `error_position`, `error_torque`, `error_growth_rate` [1/s] and `error_since` [s]. In a
sensitive motion the difference grows until it is no estimate any more. This is reported once, and the companion
begins again from the present state at `error_since`. The parameter `estimate_error` turns the companion off. With a
controller in the loop, the estimate is the error for the same curvature. It does not contain what the controller
would have done with a more accurate observation. Only a second run of the whole loop shows that.

**Errors that both runs share** are not in the estimate: the body's half-axes between given points, the law's splines,
and the samples of a controller between two instants. Separate tests compare these with exact values.

## What the targets deliver

{swims} random swims: bends in space and in the plane, periods of 0.2 to 3 s, densities of 200 to 8,000 kg/m^3,
every friction law, three bodies, starts at rest and in motion, 1 to 16 s, targets of 1e-2 to 1e-6. The true error is
the distance from a reference: {first:g} points with a tolerance of {tolerance:g}, trusted where another method with
{second:g} points agrees to a tenth of the target and of the estimate; else {finer:g} points with a tenth of the
tolerance, and {finest:g} points with a hundredth, are tried in the same way. If none agree so well, the two that agree
best count, if to a tenth of the target. The error is known no better than these two agree. An estimate counts as below
the error if it is below by more than that. The cost is nodes times evaluations of all runs, relative to the delivered
run. `make soak` swims 2,000 others, of up to 60 s.

{table}

![Estimated and true errors]({picture})

Each point is a run. Below the line the estimate is greater than the true error.

## What a target costs

![Cost over delivered error]({price})

Each grey point is a setting (points along the body, method, tolerance): medians over {priced} of the swims. The targets
lie at the lower edge of the grey points, which is what is possible. What sets the margin
between target and delivered error:
- The steps. At targets of 1e-3 and coarser the pair's steps are as long as stability allows: a looser tolerance leaves
  the number of evaluations and the error as they are. Adams' method has cheaper steps there.
- The grid is no limit but for its smallest sizes. Nodes come in blocks of eight; each block gains a factor of 100 or
  more: 16 nodes deliver 1e-1, 24 nodes 1e-3, 32 nodes 1e-5. Blended friction is the
  exception: a swim delivered 3e-4, 6e-5 and 2e-5 with 25, 60 and 100 points per length, whatever the tolerance.
- The estimate. It is the companion's error, some 15 times that of the run, and must lie below two thirds of the target.
  A closer companion is cheaper, and has missed errors: with 15 times the tolerance 4 of 355 sensitive swims, and with
  20 times 1 of 239 at a target of 1e-2, were as wrong as their companion, without a word.
- The spread. Errors of swims at one setting differ by a factor of 30 either way, and a run that is made finer for its
  estimate's sake gains a factor of 6 or more.

The companion follows the whole swim. Over the first half of it alone, the distance was 40 times too small in the worst
of 110 swims whose growth up to there was below e^3, and 145 times in the worst of 120 sensitive ones: the growth that
is seen early does not tell the later one.
"""


def write_delivered_page(path: Path, trials: list[Trial], count: int, seed: int, picture: str, price: str):
    """Write the page to `path`. picture, price: paths from there. `OSError` where the page cannot be written."""
    (first, second), (finer, _), (finest, _) = REFERENCES
    text = PAGE.format(
        count=count,
        seed=seed,
        page=path,
        swims=len(trials),
        first=first.resolution,
        tolerance=first.tolerance,
        second=second.resolution,
        finer=finer.resolution,
        finest=finest.resolution,
        table=delivered_table(trials, markdown=True),
        picture=picture,
        price=price,
        priced=min(count, SWIMS),
    )
    with replacing(path) as draft:
        draft.write_text(text, encoding="utf-8")
