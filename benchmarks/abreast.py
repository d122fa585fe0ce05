"""Eight swimmers at a time, one in each lane, against the same one by one: `python benchmarks/run.py abreast`."""

import statistics

import numpy as np
from eel_dynamics.abreast import swim_abreast
from eel_dynamics.broadcast import swimmers_of
from eel_dynamics.leg import COUNT, KNOWN, PLACE, swim
from eel_dynamics.member import Crew
from eel_dynamics.one_abreast import BEGIN
from eel_dynamics.profiles import profiles_of, row_of
from measuring import median_ratio, times_in_turn

from eel_dynamics import Accuracy, Scene
from eel_gaits import falling, straight

SWIMMERS = 64
TIMES = np.array([0.0, 10.0])  # s, the samples
AT = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0), (0.0,) * 6  # position, orientation, twist
LEAN = {"ledger": False, "internal_wrench": False}
CASES = [("laminar", kinks, points) for kinks in ("none", "all") for points in (3.0, 9.0, 19.0)]
CASES += [("printed", kinks, 9.0) for kinks in ("jumps", "all")]


def abreast():
    """64 gaits of periods from 0.8 to 1.4 s, 10 s each, steps of Adams and Bashforth of order 5, tolerance 1e-4: CPU
    time per evaluation and step, the march in the loops alone."""
    for planar in (False, True):
        for friction, kinks, points in CASES:
            accuracy = Accuracy(name="bench", resolution=points, kinks=kinks, tolerance=1e-4, method="adams")
            legs, places, _kept = _ready(Scene(friction=friction, planar=planar, **LEAN), accuracy, planar)
            rows = np.array([leg.row for leg in legs])
            trial = rows.copy()
            swim_abreast(legs, trial)
            if np.any(trial[:, BEGIN] != KNOWN):
                raise RuntimeError("a swimmer left its lane")
            evaluations = places[:, COUNT + 2].sum()
            times = times_in_turn(
                {
                    "abreast": lambda: swim_abreast(legs, rows.copy()),  # noqa: B023
                    "one by one": lambda: swim(rows.copy()),  # noqa: B023
                }
            )
            nodes = len(legs[0].swimmer.value.x)
            name = f"{'plane' if planar else 'space'}, {friction} friction, kinks {kinks}, {nodes} nodes"
            for way, seconds in times.items():
                yield f"{name}, {way}", statistics.median(seconds) / evaluations * 1e9, "ns per evaluation (CPU)"
            yield f"{name}, ratio", median_ratio(times["one by one"], times["abreast"]), "times cheaper abreast"


def _ready(scene: Scene, accuracy: Accuracy, planar: bool):
    """Legs of as many swimmers, the (28,) numbers that each leaves, and what has to stay in memory."""
    gait = straight if planar else falling
    laws = [gait(period=period) for period in np.linspace(0.8, 1.4, SWIMMERS)]
    swimmers, crew, x = swimmers_of(laws, None, scene, accuracy, *AT, TIMES[-1]), Crew(), np.zeros(1)
    places, works = np.zeros((SWIMMERS, PLACE)), np.zeros((SWIMMERS, len(TIMES), 4))
    out = profiles_of(len(TIMES), 1, False, False, (SWIMMERS,))
    rows = row_of(out, False, False)
    legs = [
        crew.member(each, x).leg_of(each, places[k], TIMES, works[k], rows[k], wrench=False, load=False)
        for k, each in enumerate(swimmers)
    ]
    return legs, places, (out, works, crew, rows)
