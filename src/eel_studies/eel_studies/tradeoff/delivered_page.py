# SPDX-License-Identifier: Apache-2.0
"""Writes docs/explanation/accuracy.md: what a target means, what it costs, and what targets deliver."""

from pathlib import Path

from eel_base.output_file import replacing

from eel_studies.tradeoff.delivered import REFERENCES, Trial, delivered_table

PAGE = """# What a target of accuracy means

Made by `tradeoff --delivered --count {count} --seed {seed} --page {page}`.

`simulate(law, accuracy=1e-4)` sets a target for two relative errors:
- The error of the head's position is the greatest over the later half of the run, relative to the length of the path,
  or to the length of the body if that is greater.
- The error of the internal torque is the greatest over all samples and stations, relative to the greatest torque, or
  to a thousandth of m (l/T)^2 if that is greater (body mass m, body length l, period T).

The presets are targets: `draft` 1e-2, `standard` 1e-4, `fine` 1e-6, `reference` 1e-8.

**From a target to settings.** One rule (`accuracy.py`) chooses them. The tolerance per step is a thousandth of the
target, because a run takes hundreds of steps. The body gets eight points per length for each decade of the target,
because Gauss quadrature in panels without kinks converges exponentially. Runs with torque or energy ledger use an
embedded Runge-Kutta pair of orders 5(4), runs of the motion alone Adams' method of order 5.

**Each run measures its own error** (`companion.py`). A second run, the *companion*, has 30 times the tolerance, half
of the points (always on another grid) and longest steps of 1.5 times the length. The difference between the two is
`run.error_estimate`. It is mostly the companion's error, so the estimate is conservative. It is not scaled by an
order. It includes the growth of errors in a sensitive motion, which the error of a single step does not.

**If the estimate is above two thirds of the target**, the run becomes the companion of a finer run, up to three
times. The new estimate counts for no less than the last one times the ratio of the tolerances: where two runs are
nearer than that, they agree by chance. If the estimate is still above the target, `simulate` warns. `run.warnings` has
the same line, with the estimate and the time in which errors grow by a factor of e. A warning also says so if the
growth of round-off alone exceeds a tenth of the target. In `simulate_batch` this is `batch.above_target`, in `sweep`
the measures error_position and error_torque.

**Without a target.** `estimate=False` gives the run without a companion. Settings given one by one are kept; their
error is measured, and not compared with a target. The same holds for a budget of time. `Simulation` measures no error.

**In the node** `dynamics` (and `MeasuredSimulation` in Python) a companion advances with the simulation. It gets
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
"""


def write_delivered_page(path: Path, trials: list[Trial], count: int, seed: int, picture: str):
    """Write the page to `path`. picture: its path from there. `OSError` where the page cannot be written."""
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
    )
    with replacing(path) as draft:
        draft.write_text(text, encoding="utf-8")
