"""The paper's own scheme against the library, at equal error: `python benchmarks/run.py paper_scheme`."""

import statistics
from functools import partial

import numpy as np
from eel_dynamics.calibration import REFERENCE
from measuring import median_ratio, times_in_turn
from paper_scheme import cells_of, curvatures, swim

from eel_dynamics import Body, Scene, Simulation, simulate
from eel_gaits import falling

DURATION = 10.0  # s
STEP = 0.01  # s, of the paper's scheme
CELLS = (50, 100, 200)
TARGETS = (1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 1e-7)
COMMON = 50  # cells whose ends all share, where torques are compared


def paper_scheme():
    """Runge-Kutta 4 in space (cells) and time (steps of 0.01 s), as in section 7.1 of the paper, in the same numba,
    against the library at no greater error; falling gait, 10 s, laminar friction. Errors of the head's position at the
    end by its path, and of the torque by its maximum. CPU times; set-up is the tabulation of body and law, theirs
    never counted."""
    law, body = falling(), Body.boyer2010()
    for internal in (False, True):
        scene = Scene(friction="laminar", ledger=False, internal_wrench=internal)
        ours = partial(simulate, law, DURATION, body=body, scene=scene)
        period = STEP if internal else DURATION
        finest = ours(accuracy=REFERENCE, sample_period=period, stations=COMMON + 1)
        runs = {target: ours(accuracy=target, sample_period=period, stations=COMMON + 1) for target in TARGETS}
        errors = {target: _errors(run.position[-1], run.torque, finest) for target, run in runs.items()}
        yield "with the internal torque at each step" if internal else "motion alone", None, ""
        for count in CELLS:
            cells, shapes = cells_of(body, count), curvatures(law, DURATION, STEP, count, body.length)
            theirs = partial(swim, cells, shapes, STEP, internal)
            positions, torque = theirs()
            error = _errors(positions[-1], torque[:, :: count // COMMON] if internal else None, finest)
            target = next(target for target in TARGETS if all(np.array(errors[target]) <= error))
            swimmer = Simulation(body=body, scene=scene, accuracy=target, stations=count + 1)
            swimmer.adopt(law)
            instants = np.arange(round(DURATION / period) + 1) * period
            marched = partial(swimmer.record, instants, internal, False)
            whole = partial(ours, accuracy=target, sample_period=period, stations=count + 1)
            times = times_in_turn({"theirs": theirs, "ours": (swimmer.reset, marched), "with set-up": whole})
            seconds = {name: statistics.median(values) for name, values in times.items()}
            yield f"  {count} cells", DURATION / seconds["theirs"], f"s per CPU second, error {_text(error)}"
            said = f"s per CPU second, error {_text(errors[target])}, target {target:g}"
            yield "    ours", DURATION / seconds["ours"], said
            yield "    ours is cheaper", median_ratio(times["theirs"], times["ours"]), "times, both without set-up"
            yield "    its set-up counted", median_ratio(times["theirs"], times["with set-up"]), "times"


def _errors(position, torque, finest) -> tuple[float, ...]:
    error = float(np.linalg.norm(position - finest.position[-1]) / _path(finest))
    if torque is None:
        return (error,)
    return error, float(np.max(np.abs(torque - finest.torque)) / np.max(np.linalg.norm(finest.torque, axis=2)))


def _path(run) -> float:
    """Length [m] of the head's path, or of a run at the same scene sampled often enough to tell."""
    if len(run.time) > 100:
        return run.path_length
    return simulate(
        run.law, run.time[-1], body=run.body, scene=run.scene, accuracy=1e-6, sample_period=0.01
    ).path_length


def _text(errors) -> str:
    return " and ".join(f"{error:.1e}" for error in errors)
