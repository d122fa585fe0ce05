# SPDX-License-Identifier: Apache-2.0
"""Four laws of swimming, and swims of one model eel to hold against them.

gazzola: Re = 0.03 Sw^(4/3) where friction is laminar, Re = 0.4 Sw where it is turbulent, with Re = U l / nu and
Sw = omega A l / nu, through more than a thousand measurements (Gazzola, Argentina and Mahadevan, Nature Physics 10
(2014), doi:10.1038/nphys3078).

eloy: the Strouhal number of least cost grows with drag, from 0.15 of whales to 0.8 of tadpoles (Eloy, J. Fluids Struct.
30 (2012), arXiv:1102.0223). Drag is given as Li = D / (1/2 rho U^2 h^2), with the span h of the tail. Balance of
thrust and drag in small motions says (pi^3 / 8) St^2 (1 - slip^2) = Li.

lighthill: of the work, (1 + U/c) / 2 is not shed into the wake, with the wave's speed c (Lighthill, J. Fluid Mech. 9
(1960), doi:10.1017/S0022112060001110, for small motions).

tytell: the cost of the wake by way grows as U^1.48 on live eels (Tytell, J. Exp. Biol. 207 (2004),
doi:10.1242/jeb.01139).
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from eel_dynamics.analysis.analysis import Analysis
from eel_gaits.film.kinematics import kinematics
from eel_studies.optimisation.optimise import optimise
from eel_studies.outputs import Table

from eel_dynamics import Body, Run, Scene, simulate_batch
from eel_gaits import Law, gait

EEL, ROBOT = Body.kern2006(1.0), Body.boyer2010()
VISCOSITIES = np.logspace(-2.5, -8.0, 12)  # m^2/s, of gazzola
LAMINAR, TURBULENT = (1e2, 3e3), (1e4, 1e7)  # Re
OF_COST = np.logspace(-7, -3, 5)  # m^2/s, of eloy
SPEED = 0.3  # m/s, at which gaits cost least
BOUNDS = {"period": (0.5, 4.0), "wavelength": (0.6, 1.5), "amplitude_0": (0.2, 6.0)}
NUMBERS = {"amplitude_1": 0.0, "amplitude_2": 1.0}
BENDS = 0.1, 0.3, 1.0, 2.0  # rad/m at the nose, twice that at the tail, of lighthill
OF_SLIP = np.logspace(-3, -8, 6)  # m^2/s: the less friction, the more slip
FREQUENCIES = np.linspace(0.5, 3.0, 6)  # Hz, of tytell
TYTELL = 1.48
TAIL = 0.15  # side to side, of the tail's excursion by the length, of live eels
WATER = 1e-6  # m^2/s
PERIOD, STATIONS, AT_START = 1.0, 41, 0.4  # s; along the body; lengths in a period


class Result(NamedTuple):
    """What a law says and what the model gives: points of curves by name, and sentences in figures."""

    x: str  # what is across, and up
    y: str
    ours: dict[str, np.ndarray]  # (n, 2)
    theirs: dict[str, np.ndarray]  # (n, 2), as lines
    table: Table
    logarithmic: bool


def gazzola(friction: str = "blended") -> Result:
    """Re over Sw of one gait in water of many viscosities, with this law of friction."""
    found = [Analysis(run) for run in _swims([_eel()] * len(VISCOSITIES), VISCOSITIES, friction=friction)]
    re = np.array([each.reynolds for each in found], dtype=float)
    sw = np.array([each.swimming_number for each in found], dtype=float)  # from side to side
    rows = []
    for name, (low, high), power, factor in (
        ("laminar", LAMINAR, 4.0 / 3.0, 0.03),
        ("turbulent", TURBULENT, 1.0, 0.4),
    ):
        inside = (re >= low) & (re <= high)
        slope = float(np.polyfit(np.log(sw[inside]), np.log(re[inside]), 1)[0])
        parts = [re[inside] / (factor * (part * sw[inside]) ** power) for part in (1.0, 0.5)]
        rows.append((f"exponent, Re {low:.0e} to {high:.0e}", f"{power:.3f}", f"{slope:.3f}"))
        for part, words in zip(parts, ("from side to side", "half of that"), strict=True):
            rows.append((f"prefactor by theirs, A {words}, {name}", "1", f"{part.min():.2f} to {part.max():.2f}"))
    line = np.logspace(2.0, 9.0, 8)
    theirs = {
        "0.03 Sw^(4/3)": np.column_stack((line, 0.03 * line ** (4.0 / 3.0)))[:4],
        "0.4 Sw": np.column_stack((line, 0.4 * line))[2:],
    }
    ours = {"A from side to side": np.column_stack((sw, re)), "A half of that": np.column_stack((0.5 * sw, re))}
    return Result("Sw", "Re", ours, theirs, Table(("", "measured", "ours"), rows), logarithmic=True)


def eloy() -> Result:
    """The Strouhal number of least cost over the drag."""
    points, rows, balance = [], [], []
    span = 2.0 * float(ROBOT.half_height(ROBOT.length))
    for viscosity in OF_COST:
        scene = Scene(planar=True, friction="blended", viscosity=viscosity)
        front = optimise(BOUNDS, [SPEED], numbers=NUMBERS, body=ROBOT, scene=scene, accuracy=1e-2, progress=False)
        found = front.runs[0].analysis()
        drag = -(found.friction_power + found.nose_power) / found.mean_speed
        load = drag / (0.5 * scene.fluid_density * found.mean_speed**2 * span**2)
        assert found.strouhal is not None and found.slip is not None  # it swims by a wave
        by_balance = np.sqrt(8.0 * load / (np.pi**3 * (1.0 - found.slip**2)))
        points.append((load, found.strouhal))
        balance.append((load, by_balance))
        at_bound = ", ".join(name for index, name in enumerate(front.names) if front.at_bound[0, index])
        rows.append(
            (f"{viscosity:.1e}", f"{load:.3f}", f"{found.strouhal:.3f}", f"{by_balance:.3f}", at_bound or "none")
        )
    ends = np.array([points[0][0], points[-1][0]])
    theirs = {
        "measured on 53 species: 0.15": np.column_stack((ends, [0.15, 0.15])),
        "to 0.8": np.column_stack((ends, [0.8, 0.8])),
        "balance of small motions, at our slip": np.array(balance),
    }
    head = ("viscosity [m^2/s]", "drag, Li", "St of least cost", "St by the balance at our slip", "at a bound")
    return Result("Li", "St", {"least cost": np.array(points)}, theirs, Table(head, rows), logarithmic=True)


def lighthill() -> Result:
    """Part of the work that is not shed, over the slip by the wave at the tail; without drag across the body."""
    ours, rows = {}, []
    for bend in BENDS:
        law = gait("straight", wavelength=1.0, amplitude_0=bend, amplitude_1=0.0, amplitude_2=bend)
        runs = _swims([law] * len(OF_SLIP), OF_SLIP, ROBOT, cross_flow=False)
        points = np.array([(_slip_at_tail(run), Analysis(run).hydromechanical_efficiency) for run in runs], dtype=float)
        name = f"{bend:g} to {2.0 * bend:g} rad/m"
        ours[name] = points
        off = points[:, 1] - 0.5 * (1.0 + points[:, 0])
        slips = f"{points[0, 0]:.2f} to {points[-1, 0]:.2f}"
        rows.append((name, slips, f"{off.min():+.3f} to {off.max():+.3f}"))
    line = np.linspace(0.0, 1.0, 2)
    theirs = {"(1 + slip) / 2": np.column_stack((line, 0.5 * (1.0 + line)))}
    head = ("curvature of the wave", "slip", "efficiency less (1 + slip) / 2")
    return Result("slip U / c", "part of the work not shed", ours, theirs, Table(head, rows), logarithmic=False)


def _slip_at_tail(run: Run) -> float:
    assert run.backbone is not None  # the run has stations
    last = run.time > run.time[-1] - 3.0 * PERIOD
    tail = kinematics(run.time[last], run.backbone[last][:, 3 * STATIONS // 4 :, :2], PERIOD)
    return tail.slip


def tytell() -> Result:
    """Cost of the wake by way over the speed: one wave at many frequencies."""
    ours, rows = {}, []
    for waves in (1.3, 1.6):
        laws = [_eel(0.5 * TAIL, 1.0 / each, waves) for each in FREQUENCIES]
        found = [
            Analysis(_swims([law], [WATER], period=1.0 / each)[0]) for law, each in zip(laws, FREQUENCIES, strict=True)
        ]
        speed = np.array([each.mean_speed for each in found])
        cost = np.array([-each.wake_power for each in found]) / speed
        ours[f"{waves:g} waves"] = np.column_stack((speed, cost))
        slope = float(np.polyfit(np.log(speed), np.log(cost), 1)[0])
        rows.append((f"exponent, {waves:g} waves on the body", f"{TYTELL:g}", f"{slope:.2f}"))
    first = next(iter(ours.values()))
    line = first[0, 1] * (first[:, 0] / first[0, 0]) ** TYTELL
    theirs = {f"U^{TYTELL:g}, from the slowest on": np.column_stack((first[:, 0], line))}
    head = ("", "live eels", "ours")
    return Result("speed [m/s]", "wake, cost by way [J/m]", ours, theirs, Table(head, rows), logarithmic=True)


LAWS: dict[str, Callable[..., Result]] = {"gazzola": gazzola, "eloy": eloy, "lighthill": lighthill, "tytell": tytell}


def _eel(tail: float = 0.09, period: float = 1.0, waves: float = 1.5) -> Law:
    return gait("anguilliform", length=EEL.length, lateral_tail=tail, period=period, waves=waves)


def _swims(
    laws: list[Law],
    viscosities: Sequence[float] | np.ndarray,
    body: Body = EEL,
    period: float = PERIOD,
    cross_flow: bool = True,
    friction: str = "blended",
) -> list[Run]:
    """Settled swims, one in water of each viscosity [m^2/s]."""
    scenes = [
        Scene(planar=True, friction=friction, internal_wrench=False, viscosity=float(each), cross_flow=cross_flow)
        for each in viscosities
    ]
    batch = simulate_batch(
        laws, "settled", bodies=body, scenes=scenes, accuracy=1e-2, stations=STATIONS, estimate=False,
        sample_period=period / 20.0, twists=(0.0, 0.0, 0.0, AT_START / period, 0.0, 0.0),
    )  # fmt: skip
    if np.any(batch.stopped):
        raise ValueError(f"a swim stops: {next(filter(None, batch.error))}")
    return [batch[index] for index in range(len(laws))]
