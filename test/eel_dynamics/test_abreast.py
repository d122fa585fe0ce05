"""Swimmers of a batch that swim abreast, one in each lane, are the single runs to round-off, whoever is beside them."""

import numpy as np
import pytest
from eel_dynamics.leg import KNOWN
from eel_dynamics.one_abreast import BEGIN

from eel_dynamics import Accuracy, Scene, SimulationStopped, member, simulate, simulate_batch
from eel_gaits import Law, Ramp, Term, falling, straight, turning

MOTION = {"ledger": False, "internal_wrench": False}
FIELDS = "position", "orientation", "twist", "head_acceleration", "center_of_mass", "backbone", "fluid_force"


@pytest.fixture
def through(monkeypatch):
    """Of each call of the lanes, how many swimmers were in it and how many came through."""
    calls, swim = [], member.swim_abreast

    def counted(group, rows):
        swim(group, rows)
        calls.append((len(rows), int(np.sum(rows[:, BEGIN] == KNOWN))))

    monkeypatch.setattr(member, "swim_abreast", counted)
    return calls


def waving(rng, axis, terms):
    """Waves no shorter than the body: all of them have the same grid."""
    return [
        Term(
            axis=axis,
            amplitude=tuple(rng.normal(size=rng.integers(1, 4))),
            wavelength=rng.uniform(1.0, 2.0),
            period=rng.uniform(0.5, 2.0),
            phase=rng.uniform(0.0, 6.0),
            envelope=(Ramp(0.1, rng.uniform(0.5, 1.5), 1.0),) if rng.random() < 0.5 else (),
        )
        for _ in range(terms)
    ]


def laws_in_space(rng):
    """From none to ten terms, in yaw, in pitch, in both."""
    mixed = [Law(*waving(rng, "yaw", rng.integers(0, 4)), *waving(rng, "pitch", rng.integers(1, 6))) for _ in range(9)]
    return [falling(), turning(), straight(), *mixed, Law(*waving(rng, "yaw", 2)), Law(*waving(rng, "pitch", 1))]


def laws_in_plane(rng):
    return [straight(), turning(), *(Law(*waving(rng, "yaw", rng.integers(1, 4))) for _ in range(12))]


def assert_round_off(batch, indices, laws, duration, **given):
    for index, law in zip(indices, laws, strict=True):
        one = {name: values[index] for name, values in given.items() if name in ("position", "orientation", "twist")}
        same = {name: value for name, value in given.items() if name not in one}
        alone, run = simulate(law, duration, **one, **same), batch[index]
        assert (run.steps, run.evaluations) == (alone.steps, alone.evaluations), law.name
        for name in FIELDS:
            here, there = getattr(run, name), getattr(alone, name)
            assert np.max(np.abs(here - there)) < 1e-8 * max(1.0, np.max(np.abs(there))), (law.name, name)


@pytest.mark.parametrize("friction", ["laminar", "printed", "blended", "none"])
@pytest.mark.parametrize("kinks", ["none", "jumps", "all"])
def test_swimmers_abreast_are_their_single_runs(through, friction, kinks):
    rng = np.random.default_rng(8)
    laws = laws_in_space(rng)
    scene = Scene(friction=friction, current=(0.1, -0.05, 0.02), **MOTION)
    accuracy = Accuracy(name="own", resolution=8.0, tolerance=1e-5, method="adams", kinks=kinks)
    quaternions = rng.normal(size=(len(laws), 4))
    start = {
        "position": rng.normal(size=(len(laws), 3)),
        "orientation": quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True),
        "twist": 0.1 * rng.normal(size=(len(laws), 6)),
    }
    settings = {"accuracy": accuracy, "sample_period": 0.3, "stations": 7, "load": True}
    batch = simulate_batch(
        laws, 1.5, scenes=scene, threads=1, **{f"{name}s": rows for name, rows in start.items()}, **settings
    )
    assert not batch.stopped.any() and sum(count for _, count in through) == len(laws) - 1  # the first swims alone
    assert_round_off(batch, range(len(laws)), laws, 1.5, scene=scene, **start, **settings)


@pytest.mark.parametrize("friction, accuracy", [("laminar", 1e-2), ("printed", 1e-5), ("none", 1e-6)])
def test_swimmers_abreast_in_the_plane(through, friction, accuracy):
    laws, scene = laws_in_plane(np.random.default_rng(9)), Scene(planar=True, friction=friction, **MOTION)
    settings = {"accuracy": accuracy, "sample_period": 0.5, "stations": 5, "load": True}
    batch = simulate_batch(laws, 2.0, scenes=scene, threads=1, **settings)
    assert not batch.stopped.any() and sum(count for _, count in through) == len(laws) - 1
    assert_round_off(batch, range(len(laws)), laws, 2.0, scene=scene, **settings)


def test_who_cannot_go_on_abreast_goes_on_alone(through):
    """One that is thrown beyond all numbers leaves its lane, and stops alone as it would; none disturbs the others."""
    laws, twists = [falling(period=0.8 + 0.02 * k) for k in range(17)], np.zeros((17, 6))
    twists[3, 3] = twists[11, 3] = -1e100
    accuracy = Accuracy(name="own", resolution=8.0, tolerance=1e-4, method="adams")
    scene, settings = (
        Scene(friction="laminar", **MOTION),
        {"accuracy": accuracy, "sample_period": 0.2, "stations": 3, "load": True},
    )
    batch = simulate_batch(laws, 0.6, scenes=scene, twists=twists, threads=1, **settings)
    assert np.flatnonzero(batch.stopped).tolist() == [3, 11] and through == [(8, 7), (8, 7)]
    with pytest.raises(SimulationStopped) as alone:
        simulate(laws[3], 0.6, scene=scene, twist=twists[3], **settings)
    assert (batch.error[3].time, batch.error[3].quantity) == (alone.value.time, alone.value.quantity)
    going = [index for index in range(17) if index not in (3, 11)]
    assert_round_off(batch, going, [laws[index] for index in going], 0.6, scene=scene, **settings)


def test_results_do_not_hang_on_who_is_beside():
    """Each lane is its own: in another company a swimmer is the same to the last bit."""
    accuracy = Accuracy(name="own", resolution=8.0, tolerance=1e-3, method="adams")  # the same for all: one company
    laws, settings = [falling(period=0.8 + 0.03 * k) for k in range(17)], {"accuracy": accuracy, "sample_period": 1.0}
    scene = Scene(friction="laminar", **MOTION)
    together = simulate_batch(laws, 3.0, scenes=scene, threads=1, **settings)
    reversed_ = simulate_batch(laws[::-1], 3.0, scenes=scene, threads=1, **settings)
    for index in range(1, len(laws) - 1):  # the first of a batch swims alone
        assert np.array_equal(together.position[index], reversed_.position[-1 - index])


def test_with_the_ledger_each_swims_alone(through):
    simulate_batch([falling()] * 12, 0.1, accuracy=1e-2, threads=1)
    assert not through
