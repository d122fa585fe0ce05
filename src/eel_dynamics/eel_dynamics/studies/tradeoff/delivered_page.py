# SPDX-License-Identifier: Apache-2.0
"""Writes docs/explanation/accuracy.md: what a target means, what it costs, and what targets deliver."""

from pathlib import Path

from eel_gaits.input_output.output_file import replacing

from eel_dynamics.studies.tradeoff.delivered import REFERENCES, Trial, delivered_table

PAGE = """# What a target of accuracy means

Made by `tradeoff --delivered --count {count} --seed {seed} --page {page}`.

`simulate(law, accuracy=1e-4)` asks for a relative error. The error of the head's position is the greatest over the
later half of the swim, relative to the length of its path, or of the body if that is longer. The error of the
internal torque is the greatest over all samples and stations, relative to its maximum; torques below a thousandth
of m (l/T)^2 count by that. Presets are targets: `draft` 1e-2, `standard` 1e-4, `fine` 1e-6, `reference` 1e-8.

**From a target to settings**, one rule (`accuracy.py`): the tolerance per step is a thousandth of the target,
because a swim takes hundreds of steps; the body gets eight points per length for each decade of the target, because
Gauss points in panels without kinks converge exponentially. Runs with torque or ledger march by an embedded pair of
orders 5(4), runs of the motion alone by Adams' method of order 5.

**Each run measures its own error** (`companion.py`). A companion swims the same with 30 times the tolerance,
half of the points (always on another grid) and longest steps of 1.5 times the length. Their distance is
`run.error_estimate`. It is the companion's error more than the run's, so it lies on the safe side, and it is not
scaled by an order. It sees how errors grow in a sensitive motion, which the error of a single step does not.

**If the estimate is above two thirds of the target**, the run becomes the next companion of a finer one, up to
three times. If it then still is above the target, `simulate` warns, and `run.warnings` has the same line with the
estimate and the time in which errors grow by a factor of e. Where grown round-off alone would take a tenth of the
target, it is said too. `simulate_batch` tells it as `batch.above_target`, `sweep` as the measures error_position
and error_torque.

**Without it**: `estimate=False` gives the bare run. Settings that were given one by one are kept, and their error
is measured and not judged; so is a budget of time. `Simulation` measures nothing.

**In the node** `dynamics` (and `MeasuredSimulation` in Python) a companion follows the simulation as it goes. It gets
the same laws and samples. What is published cannot be made finer, so a missed target is reported: WARN in the log and
in `/diagnostics`, which has `error_position`, `error_torque`, `error_growth_rate` [1/s] and `error_since` [s]. In a
sensitive motion the distance grows until it says nothing more; this is reported once; the companion begins anew from
the present state at `error_since`. The parameter `estimate_error` turns it off. A controller that answers to what it
observes closes a loop: the estimate knows the error that the same curvature leads to, not what the controller would
have done with a truer observation. Only a second run of the whole loop tells that.

**What both runs share**, no companion sees: the body's half-axes between given points, the law's splines, and the
samples of a controller between two instants. Tests of their own compare these with exact values.

## What the targets deliver

{swims} random swims: bends in space and in the plane, periods of 0.2 to 3 s, densities of 200 to 8,000 kg/m^3,
every friction law, three bodies, heads at rest and moving, 1 to 16 s, targets of 1e-2 to 1e-6. The true error is
the distance from a reference: {first:g} points with a tolerance of {tolerance:g}, trusted where another method with
{second:g} points agrees to a tenth of the target; else {finer:g} points with a tenth of the tolerance, and {finest:g}
points with a hundredth, are tried in the same way. The error is known no better than these two
agree. An estimate counts as below the error where it is so by more than that. The cost is nodes times evaluations of
all its runs, relative to the delivered run's.

{table}

![Estimated and true errors]({picture})

Each point is a swim. Below the line an estimate lies on the safe side.
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
