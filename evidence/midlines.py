# SPDX-License-Identifier: Apache-2.0
"""`python evidence/midlines.py`: swim a file of midlines, and compare what comes out.

python evidence/midlines.py fish.csv                       # the distance, as a number
python evidence/midlines.py fish.csv --out midlines.png    # and a picture
"""

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from eel_common.command.command import checked_out, command
from eel_common.command.command_line import Parser
from eel_common.command.progress import Progress
from eel_common.files.output_file import written_as
from eel_dynamics.commands.options import add_options
from eel_dynamics.model.body.text import body_of
from eel_gaits.sources.midlines import Midlines
from eel_gaits.sources.order import laid_on
from eel_studies.pictures import PICTURES, Figure, write_picture

from eel_dynamics import Run, simulate
from eel_gaits import read_midlines

NAME = "midlines.py"
SHOWN = 8  # instants in the picture


@dataclass(frozen=True)
class MidlineComparison:
    """Midlines at T instants and n points, in the plane or in space. The run's are laid on the measured ones."""

    time: np.ndarray  # (T,) s
    measured: np.ndarray  # (T, n, 2 or 3) m
    found: np.ndarray  # (T, n, 2 or 3) m
    length: float  # m, of the body

    @property
    def distance(self) -> np.ndarray:
        """(T, n) relative to the body's length."""
        return np.asarray(np.linalg.norm(self.found - self.measured, axis=2) / self.length)

    @property
    def rms(self) -> float:
        """Root mean square of the distances, relative to the body's length."""
        return float(np.sqrt(np.mean(self.distance**2)))

    def __str__(self) -> str:
        worst = np.unravel_index(np.argmax(self.distance), self.distance.shape)
        most = f"{self.distance[worst]:.3%} at most, at point {worst[1] + 1} at t = {self.time[worst[0]]:.3g} s"
        return f"{self.rms:.3%} of the body's length apart (RMS), {most}; rigid motion removed"


def _add_options(parser: Parser) -> None:
    about = "a .csv or .npz file with the columns time, x, y (right-handed, z up): docs/howto/motions.md"
    parser.add_argument("file", help=about)
    add_options(parser, "--body", "--scale")
    parser.add_argument("-o", "--out", metavar="FILE", help="a picture: .png, .svg or .pdf")


@command(
    NAME, "Simulate a file of midlines, and compare the computed ones with those measured.", add_options=_add_options
)
def main(options: argparse.Namespace) -> None:
    out = None if options.out is None else checked_out(NAME, options.out, PICTURES)
    body = body_of(options.body)
    midlines = read_midlines(options.file, length=body.length, scale=options.scale)
    law = midlines.law(Path(options.file).stem)
    stations = midlines.arc / midlines.arc[-1] * body.length
    period = law.duration / max(1, round(law.duration / 0.05))
    progress = Progress(NAME, "simulated s")
    run = simulate(
        law,
        law.duration,
        body=body,
        accuracy=1e-2,
        sample_period=period,
        stations=stations,
        estimate=False,
        progress=lambda reached, left: progress(float(f"{reached:.5g}"), law.duration),
    )
    found = compared(run, midlines)
    print(f"motion              {law.about}")
    print(f"midlines            {found}")
    if out is not None:
        instants = np.unique(np.linspace(len(found.time) // 2, len(found.time) - 1, SHOWN).astype(int))
        write_picture(lambda figure: _draw(figure, found, instants), (6.4, 1.1 * len(instants) + 0.8), out)
        print(f"written to          {written_as(out)}")


def _draw(figure: Figure, found: MidlineComparison, instants: np.ndarray) -> None:
    """Draw the `instants` (n,), without the rigid motion: what was measured as points, the run's as lines."""
    axes = figure.add_subplot()
    for row, instant in enumerate(instants):
        measured, line = (_upright(each[instant], found.measured[instant]) for each in (found.measured, found.found))
        shift = np.array([0.0, -0.25 * found.length * row])
        (points,) = axes.plot(*(measured + shift).T, ".", color="0.3", markersize=4)
        (curve,) = axes.plot(*(line + shift).T, color="C0", linewidth=1.2)
        place = 1.02 * found.length, shift[1]
        axes.annotate(f"{found.time[instant]:.2f} s", place, va="center", annotation_clip=False)
    points.set_label("measured")
    curve.set_label("of the run, rigid motion removed")
    axes.set(title=f"Midlines: {found.rms:.2%} of the body's length apart (RMS)", xlabel="along the body [m]")
    axes.set_aspect("equal")
    axes.set_yticks([])
    figure.legend(loc="outside lower center", ncols=2)


def _upright(points: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """The `points` (n, d) seen along the axes of the `reference` (n, d): nose at 0, its long axis ahead; (n, 2)."""
    centred = reference - reference.mean(axis=0)
    axes = np.linalg.svd(centred, full_matrices=False)[2][:2]
    axes[0] *= np.sign(axes[0] @ (reference[-1] - reference[0]))
    return np.asarray((points - reference[0]) @ axes.T)


def compared(run: Run, midlines: Midlines) -> MidlineComparison:
    """Compare a `run`, whose stations are the measured points, with the `midlines` at its instants."""
    from scipy.interpolate import CubicSpline

    measured = CubicSpline(midlines.time, midlines.position)(run.time)
    assert run.backbone is not None  # it has stations
    found = run.backbone[..., : measured.shape[2]]
    return MidlineComparison(run.time, measured, laid_on(found, measured), run.body.length)


if __name__ == "__main__":
    sys.exit(main())
