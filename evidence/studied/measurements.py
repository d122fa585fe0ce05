# SPDX-License-Identifier: Apache-2.0
"""The model against measurements of robots and animals: docs/appendix/measurements.csv.

`make validation` writes it, from swims that this file defines. Nothing is fitted to what is compared: where a source
does not tell a number of the gait, the number is varied over a stated range, and our column shows the whole range.
"""

import csv
from dataclasses import dataclass
from functools import cache
from itertools import product
from pathlib import Path

import numpy as np

from eel_dynamics import Body, Scene, simulate
from eel_gaits import Law, Ramp, Term, anguilliform
from eel_studies import optimise

WATER = Scene(friction="blended", planar=True)
EEL = Body.kern2006(0.6)  # m: Methling et al. had silver eels of 0.599 m
# L, from side to side: between 0.15 (D'Aout and Aerts, J. Exp. Biol. 202 (1999), 1511-1521) and 2 x 0.08 (Gillis)
TAIL = 0.155
WAVELENGTHS, GROWTHS = (0.6, 0.8), (1.0, 3.0)  # L, and of the amplitude e^(growth X/L): not told, varied
FREQUENCIES = (1.0, 3.0)  # Hz
PERIODS = 16
SPEED = 0.545  # m/s, of the measured costs
OXYGEN = 13.6  # J/mg, of aerobic metabolism
MAMBA = {"amplitude": np.radians(40.0), "links": 10, "frequency": 120.0 / 360.0, "links per wave": 360.0 / 40.0}

COLUMNS = "compared", "measured", "source", "ours", "verdict"
AMPLITUDES = (1.0, 2.0, 4.0, 6.0, 8.0)  # rad/L, of a uniform wave
SOURCES = {
    "G": "Gillis, J. Exp. Biol. 201 (1998), 949-961",
    "T1": "Tytell, Proc. R. Soc. B 271 (2004), 2535-2540",
    "T2": "Tytell, J. Exp. Biol. 207 (2004), 3265-3279",
    "K": "cited by Kern and Koumoutsakos, J. Exp. Biol. 209 (2006), 4841-4857",
    "B": "Burgerhout et al., J. Exp. Mar. Biol. Ecol. (2013)",
    "M": "Kelasidi et al., IEEE Robot. Autom. Mag. 23(1) (2016), 44-62; links: Robotics and Biomimetics 2:8 (2015)",
    "A": "Anastasiadis et al., Sci. Rep. 13 (2023), doi:10.1038/s41598-023-41074-9",
    "S": "Saadat et al., Phys. Rev. Fluids 2 (2017), 083102",
}


@dataclass(frozen=True)
class Row:
    """One line of the file: what is compared, theirs with its error bar, ours, the verdict and its reason."""

    what: str
    theirs: str
    source: str
    ours: str
    verdict: str


def swum(law: Law, period: float, body: Body, speed: float):
    """The analysis of a steady swim of the `period` [s], which begins at a `speed` [m/s]."""
    run = simulate(
        law,
        PERIODS * period,
        body=body,
        scene=WATER,
        accuracy=1e-3,
        sample_period=period / 24,
        twist=(0.0, 0.0, 0.0, speed, 0.0, 0.0),
    )
    return run.analysis()


@cache
def eel(frequency: float, wavelength: float, growth: float):
    """The analysis of a model eel whose tail goes as far as a live one's."""
    tail = TAIL
    for _ in range(3):
        law = anguilliform(
            length=EEL.length, period=1.0 / frequency, waves=1.0 / wavelength, lateral_tail=0.5 * tail, growth=growth
        )
        found = swum(law, 1.0 / frequency, EEL, 0.5 * wavelength * EEL.length * frequency)
        tail *= TAIL * EEL.length / found.tail_excursion
    return found


def eels(figure, frequency: float) -> tuple[float, float]:
    """The least and the greatest `figure(analysis)` over what the sources do not tell."""
    found = [figure(eel(frequency, *numbers)) for numbers in product(WAVELENGTHS, GROWTHS)]
    return min(found), max(found)


def mamba(eel_like: bool):
    """The analysis of a continuous body that bends as the robot's joints do: each angle over one link's length.

    Joint i of n, counted from the tail, has (n - i)/(n + 1) of the amplitude in the eel-like motion: X/L - 1/(n + 1).
    """
    body = Body.boyer2010()
    bend = MAMBA["amplitude"] * MAMBA["links"] / body.length
    law = Law(
        Term(
            amplitude=(-bend / MAMBA["links"], bend / body.length) if eel_like else (bend,),
            wavelength=MAMBA["links per wave"] / MAMBA["links"] * body.length,
            period=1.0 / MAMBA["frequency"],
            envelope=(Ramp(0.0, 1.0 / MAMBA["frequency"], 1.0),),
        ),
        name="mamba",
    )
    return swum(law, 1.0 / MAMBA["frequency"], body, 0.1)


def trend() -> tuple[list[float], list[float]]:
    """Stride and cost of transport [J/(kg m)] of the paper's robot at 1 Hz, by growing amplitude of a uniform wave."""
    body, stride, cost = Body.boyer2010(), [], []
    for bend in AMPLITUDES:
        law = Law(Term(amplitude=(bend,), wavelength=0.8, period=1.0, envelope=(Ramp(0.0, 1.0, 1.0),)), name="wave")
        found = swum(law, 1.0, body, 0.3)
        stride.append(found.stride)
        cost.append(found.cost_of_transport)
    return stride, cost


@cache
def frugal():
    """The gaits of least cost of the paper's robot at 0.3 and 0.5 body lengths per second."""
    bounds = {"period": (0.5, 4.0), "wavelength": (0.6, 1.5), "amplitude_0": (0.2, 6.0)}
    numbers = {"amplitude_1": 0.0, "amplitude_2": 1.0}
    return optimise(bounds, [0.3, 0.5], numbers=numbers, scene=WATER, accuracy=1e-2, progress=False)


def at_speed(speed: float, slow: tuple[float, float], fast: tuple[float, float]) -> float:
    """The cost at `speed`, by the power law through two pairs of speed and cost."""
    power = np.log(fast[1] / slow[1]) / np.log(fast[0] / slow[0])
    return float(slow[1] * (speed / slow[0]) ** power)


def span(pair, form: str = ".2f") -> str:
    """Two numbers as a range."""
    return f"{pair[0]:{form}} to {pair[1]:{form}}"


def inside(ours, low: float, high: float) -> str:
    """The verdict on our range beside theirs."""
    if low <= ours[0] and ours[1] <= high:
        return "inside"
    return "overlaps" if ours[0] <= high and ours[1] >= low else "outside"


def rows() -> list[Row]:
    """All lines of the section."""
    slow, fast = FREQUENCIES
    strouhal = eels(lambda found: found.strouhal, fast)
    stride = eels(lambda found: found.stride, fast)
    growth = eels(lambda found: found.stride, slow)
    change = max(abs(f / s - 1.0) for f, s in zip(stride, growth, strict=True))
    pairs = [(eel(slow, *numbers), eel(fast, *numbers)) for numbers in product(WAVELENGTHS, GROWTHS)]
    exponents = [
        float(np.log(b.wake_power * a.mean_speed / (a.wake_power * b.mean_speed)) / np.log(b.mean_speed / a.mean_speed))
        for a, b in pairs
    ]
    exponent = min(exponents), max(exponents)
    each = [at_speed(SPEED, *((found.mean_speed, found.cost_of_transport) for found in pair)) for pair in pairs]
    cost = min(each), max(each)
    group, alone = (oxygen * OXYGEN * 1e-3 for oxygen in (21.3, 32.0))
    uniform, like = mamba(False), mamba(True)
    ratio = like.mean_speed / uniform.mean_speed
    strides, costs = trend()
    peak = int(np.argmax(strides))
    rises = bool(np.all(np.diff(costs) > 0.0))
    front = frugal()
    least = sorted(run.analysis().strouhal for run in front.runs)
    tails = sorted(run.analysis().tail_excursion / run.body.length for run in front.runs)
    bound = ", ".join(name for index, name in enumerate(front.names) if front.at_bound[:, index].any())
    return [
        Row(
            "Strouhal number of steady eels",
            "0.32 at 0.6 to 1.9 L/s",
            "T1",
            span(strouhal),
            f"{strouhal[0] / 0.32 - 1.0:+.0%} to {strouhal[1] / 0.32 - 1.0:+.0%}: our tail ends in a "
            "point, without fin",
        ),
        Row(
            "stride U T/L of anguilliform swimmers",
            "0.26 to 0.5",
            "K",
            span(stride),
            f"{inside(stride, 0.26, 0.5)}; their gaits are others",
        ),
        Row(
            f"change of the stride from {slow:g} to {fast:g} Hz: speed against frequency",
            "no consistent effect of speed",
            "G",
            f"up to {change:.0%}",
            "as measured" if change < 0.1 else "more than measured",
        ),
        Row(
            "exponent n of the wake's cost per way, going like U^n",
            "1.48",
            "T2",
            span(exponent),
            "at a fixed wave it is 2; live eels change their wave with speed",
        ),
        Row(
            "cost of transport [J/(kg m)]",
            f"{group:.2f} ± {3.2 * OXYGEN * 1e-3:.2f} in a group, {alone:.2f} ± {0.6 * OXYGEN * 1e-3:.2f} alone, of "
            "metabolism, at 0.52 to 0.57 m/s",
            "B",
            f"{span(cost, '.3f')} of mechanical work, at {SPEED:g} m/s",
            f"{cost[0] / alone:.0%} to {cost[1] / group:.0%} of theirs, which hold rest and the muscles' losses too: "
            "ours is probably too great. Their mg O2 per kg and hour are read as per kg and km",
        ),
        Row(
            "speed of Mamba's eel-like motion by that of its lateral undulation",
            "0.0894 / 0.1288 = 0.694",
            "M",
            f"{ratio:.3f}",
            f"NOT as measured: {ratio / 0.694 - 1.0:+.0%}. Our thrust comes from the tail, which moves nearly as far "
            "in both; joints, blunt links and the drag between them are not in the model",
        ),
        Row(
            "length of Mamba from its speed, frequency and our stride",
            "9 links of 0.18 m, 1.62 m",
            "M",
            f"{0.1288 / MAMBA['frequency'] / uniform.stride:.2f} m from the undulation, "
            f"{0.0894 / MAMBA['frequency'] / like.stride:.2f} m from the eel-like motion",
            "NOT as measured: our stride is three to four times too great for this robot; what does it: "
            "explanation/life.md",
        ),
        Row(
            "stride by growing amplitude",
            "rises to a greatest value, then falls",
            "A",
            ", ".join(f"{value:.2f}" for value in strides)
            + f" at {', '.join(f'{bend:g}' for bend in AMPLITUDES)} rad/L",
            "as measured" if 0 < peak < len(strides) - 1 else "NOT as measured: it goes on rising",
        ),
        Row(
            "cost of transport by growing amplitude",
            "rises",
            "A",
            ", ".join(f"{value:.2f}" for value in costs) + " J/(kg m)",
            "as measured" if rises else "NOT as measured",
        ),
        Row(
            "Strouhal number of efficient swimming",
            "0.2 to 0.4",
            "S",
            f"{span(least)} of the gaits of least cost at 0.3 and 0.5 L/s (`optimise`)",
            f"{inside(least, 0.2, 0.4)}" + (f"; at its bound: {bound}" if bound else ""),
        ),
        Row(
            "tail's excursion of efficient swimming, by the length",
            "0.1 to 0.3",
            "S",
            f"{span(tails)} of the same gaits",
            inside(tails, 0.1, 0.3),
        ),
    ]


def write(path: Path) -> None:
    """Write the rows to `path`, each with its source."""
    with path.open("w", newline="", encoding="utf-8") as file:
        lines = [(row.what, row.theirs, SOURCES[row.source], row.ours, row.verdict) for row in rows()]
        csv.writer(file, lineterminator="\n").writerows([COLUMNS, *lines])
