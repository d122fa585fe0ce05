# SPDX-License-Identifier: Apache-2.0
"""Many swimmers side by side: each is the run that it would be alone, and none disturbs another."""

import numpy as np
import pytest
from cases import random_law

from eel_dynamics import Accuracy, Batch, Body, Fin, RollHold, Scene, SimulationStopped, simulate, simulate_batch
from eel_gaits import Law, Term, falling, straight, turning

MOTION = ["time", "position", "orientation", "twist", "head_acceleration", "center_of_mass"]
ALONG = ["x", "backbone", "section_orientation", "curvature", "curvature_rate", "torque", "force"]
LOADS = [
    "fluid_force",
    "resistive_force",
    "tail_force",
    "nose_force",
    "wake_momentum_rate",
    "closure_torque",
    "closure_force",
]
KERN, BOYER = Body.kern2006(), Body.boyer2010()
# A light body in water without inertia: its drag brings it to rest in less than a step, and the march diverges.
HOPELESS, LONG = Scene(density=10.0, reactive=False), Accuracy(name="long steps", resolution=10.0, step=0.02)


def mixed(rng):
    """Six swimmers that differ in everything."""
    scenes = [
        Scene(),
        Scene(friction="laminar", ledger=False),
        Scene(planar=True),
        Scene(resistive=False, internal_wrench=False),
        Scene(current=(0.1, 0.0, 0.05), density=900.0),
        Scene(),
    ]
    laws = [falling(), random_law(rng), straight(), turning(), random_law(rng), straight(wavelength=0.4)]
    quaternions = rng.normal(size=(6, 4))
    quaternions[2] = 0.0, 0.0, 0.6, 0.8
    twists = 0.2 * rng.normal(size=(6, 6))
    twists[2, [0, 1, 5]] = 0.0
    return {
        "laws": laws,
        "bodies": [BOYER, KERN, BOYER, BOYER, KERN, KERN],
        "scenes": scenes,
        "accuracy": [1e-2, 1e-3, 1e-2, "draft", 1e-2, 1e-3],
        "positions": rng.normal(size=(6, 3)),
        "orientations": quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True),
        "twists": twists,
    }


def assert_same(run, alone):
    for name in MOTION + ALONG + LOADS:
        here, there = getattr(run, name), getattr(alone, name)
        assert (here is None) == (there is None), name
        assert here is None or np.array_equal(here, there), name
    assert (run.energy is None) == (alone.energy is None)
    if alone.energy is not None:
        for name in alone.energy.keys():  # noqa: SIM118 (a method of the ledger, not of a dict)
            assert np.array_equal(run.energy[name], alone.energy[name]), name
    assert (run.steps, run.evaluations) == (alone.steps, alone.evaluations)


@pytest.mark.parametrize("threads", [1, 2])
def test_every_swimmer_is_its_single_run_to_the_last_bit(threads):
    given = mixed(np.random.default_rng(5))
    batch = simulate_batch(duration=0.8, sample_period=0.1, stations=9, load=True, threads=threads, **given)
    assert len(batch) == 6 and not batch.stopped.any() and batch.valid.all()
    singular = {"laws": "law", "bodies": "body", "scenes": "scene", "positions": "position"}
    singular |= {"orientations": "orientation", "twists": "twist", "accuracy": "accuracy"}
    for index in range(6):
        one = {singular[name]: values[index] for name, values in given.items()}
        alone = simulate(duration=0.8, sample_period=0.1, stations=9, load=True, **one)
        assert_same(batch[index], alone)
        assert np.array_equal(batch.position[index], alone.position)
        assert np.array_equal(batch.backbone[index], alone.backbone)
    # not every scene has them
    assert batch.torque is None and batch.energy is None and batch.fluid_force.shape == (6, 9, 9, 3)


COARSE = {"accuracy": 1e-2, "stations": 5, "sample_period": 0.05}


def test_one_for_all_and_a_sequence_of_one():
    laws = [falling(period=period) for period in (0.8, 1.0, 1.2)]
    batch = simulate_batch(laws, 0.4, bodies=[KERN], twists=np.zeros((1, 6)), **COARSE)
    assert batch.position.shape == (3, 9, 3) and batch.torque.shape == (3, 9, 5, 3)
    assert batch.energy.kinetic_body.shape == (3, 9) and batch.x.shape == (3, 5)
    assert all(body is KERN for body in batch.bodies)
    assert_same(batch[-1], simulate_of_last := simulate(laws[2], 0.4, body=KERN, load=False, **COARSE))
    assert simulate_of_last.fluid_force is None and batch.fluid_force is None


def test_accuracies_are_a_sequence_or_an_array():
    for given in ([1e-3, 1e-4], np.array([1e-3, 1e-4])):
        batch = simulate_batch(straight(), 0.1, accuracy=given)
        assert [each.target for each in batch.accuracies] == [1e-3, 1e-4]
    assert simulate_batch(straight(), 0.1, accuracy=np.array(1e-3)).accuracies[0].target == 1e-3


def test_without_stations_only_the_motion_and_the_energies():
    batch = simulate_batch([falling(), straight()], 0.2, accuracy=1e-2)
    assert batch.backbone is None and batch.torque is None and batch[0].torque is None
    assert np.array_equal(batch.energy.drag_work[1], simulate(straight(), 0.2, accuracy=1e-2).energy.drag_work)


def test_a_swimmer_that_stops_keeps_its_samples_and_disturbs_no_other():
    scenes = [Scene(), HOPELESS, Scene()]
    batch = simulate_batch(falling(), 0.4, scenes=scenes, accuracy=LONG, sample_period=0.05, stations=5, threads=2)
    assert batch.stopped.tolist() == [False, True, False]
    with pytest.raises(SimulationStopped) as alone:
        simulate(falling(), 0.4, scene=HOPELESS, accuracy=LONG, sample_period=0.05, stations=5)
    stop = batch.error[1]
    assert (stop.time, stop.quantity) == (alone.value.time, alone.value.quantity)
    assert "is stable" in alone.value.hint  # a single run also looks for the step that would have been
    done = batch.samples[1]
    assert 0 < done == len(alone.value.run.time) < 9
    assert_same(batch[1], alone.value.run)
    assert batch.valid[1].tolist() == [True] * done + [False] * (9 - done)
    for array in (batch.position, batch.twist, batch.torque, batch.backbone, batch.energy.drag_work):
        assert np.all(np.isfinite(array)) and not np.any(array[1, done:])
    assert_same(batch[2], simulate(falling(), 0.4, accuracy=LONG, sample_period=0.05, stations=5))


@pytest.mark.parametrize("accuracy", [1e-2, "draft, fixed steps", Accuracy(name="long", resolution=10.0, step=0.05)])
def test_those_of_one_call_do_not_notice_who_stops_beside_them(accuracy):
    """Of the same body, scene and accuracy, up to sixteen at a time swim in the same work space."""
    wild = [Law(Term(axis=axis, amplitude=(1e28,), wavelength=0.4, period=0.3)) for axis in ("yaw", "pitch")]
    laws = [wild[k % 2] if k % 3 == 1 else falling(period=0.8 + 0.02 * k) for k in range(24)]
    settings = {"accuracy": accuracy, "sample_period": 0.1, "stations": 3, "load": True}
    batch = simulate_batch(laws, 0.3, threads=1, **settings)
    assert batch.stopped.tolist() == [law in wild for law in laws]
    for index, law in enumerate(laws):
        if law not in wild:
            assert_same(batch[index], simulate(law, 0.3, **settings))


def test_a_swimmer_that_stops_at_its_start_is_told_apart():
    twists = np.zeros((2, 6))
    twists[1, 3] = 1e30
    batch = simulate_batch(falling(), 0.1, twists=twists, accuracy=1e-2)
    assert batch.stopped.tolist() == [False, True] and batch.samples.tolist() == [3, 1]
    assert batch.error[1].time < 1e-9 and "more steps per simulated second" in str(batch.error[1])


def test_progress_reaches_the_end():
    told = []
    simulate_batch(falling(), 0.05, positions=np.zeros((7, 3)), accuracy=1e-2, progress=lambda *pair: told.append(pair))
    assert told == [(done, 7) for done in range(1, 8)]


@pytest.mark.parametrize(
    "given, words",
    [
        ({"laws": [falling(), "swim"]}, ("laws\\[1\\]", "swim")),
        ({"laws": 3}, ("laws", "3")),
        ({"laws": []}, ("laws", "none")),
        ({"laws": [falling()] * 3, "bodies": [KERN, BOYER]}, ("bodies", "laws", "3", "2")),
        ({"scenes": [Scene(), None]}, ("scenes\\[1\\]", "None")),
        ({"positions": np.zeros((2, 2))}, ("positions\\[0\\]", "3 numbers")),
        ({"twists": [[0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, np.nan]]}, ("twists\\[1\\]", "nan")),
        ({"orientations": [0, 0, 0, 2]}, ("orientation", "unit")),
        ({"accuracy": [1e-2, "quick"], "laws": [straight()] * 2}, ("accuracy", "quick")),
        ({"scenes": [Scene(), Scene(planar=True)]}, ("swimmer 1", "pitch")),
        ({"threads": 0}, ("threads", "0")),
        ({"duration": -1.0}, ("duration", "-1")),
        ({"duration": "a"}, ("duration must be a number, got 'a'",)),
        ({"sample_period": 0.3}, ("sample_period must be at most the duration of 0.1 s, got 0.3 s",)),
        ({"sample_period": 1e-12}, ("duration", "sample_period", r"1e\+11 samples")),
        ({"accuracy": np.array([1e-3, 0.5]), "laws": [straight()] * 2}, ("accuracy", "0.5")),
        (
            {"stations": 50_000, "positions": np.zeros((5000, 3)), "duration": 100.0},
            ("stations", "5000 swimmers", "GB"),
        ),
    ],
)
def test_bad_input_is_named(given, words):
    with pytest.raises(ValueError, match="(?s)" + "".join(f"(?=.*{word})" for word in words)):
        simulate_batch(**{"laws": falling(), "duration": 0.1, **given})


def test_fins_of_each_swimmer(tmp_path):
    """A list for all, or one for each: some with more fins than others, some with none."""
    pair = Fin.pair(0.2, 1e-3, 2.5, angle=RollHold(2.0, 0.15), time_constant=0.05, initial_angle=0.1)
    several = [[pair], None, [Fin(0.5, "left", 1e-3, 2.5, angle=0.2)]]
    batch = simulate_batch(falling(), 0.3, fins=several, accuracy=1e-2, sample_period=0.1, stations=11)
    for run, fins in zip(batch, several, strict=True):
        alone = simulate(falling(), 0.3, fins=fins, accuracy=1e-2, sample_period=0.1, stations=11)
        assert_same(run, alone)
        assert run.fins == alone.fins and np.array_equal(run.fin_angle, alone.fin_angle)
    assert batch[0].fin_angle[0].tolist() == [-0.1, 0.1]  # the servo's start
    assert batch.fin_force.shape == (3, 4, 2, 3) and not batch.fin_force[1].any()
    batch.save(tmp_path / "batch.nc")
    assert Batch.load(tmp_path / "batch.nc") == batch
    assert [len(each) for each in simulate_batch([falling()] * 2, 0.1, fins=[pair], accuracy=1e-2).fins] == [2, 2]
    with pytest.raises(ValueError, match="swimmer 1: fins need a scene in space"):
        simulate_batch(straight(), 0.1, scenes=[Scene(), Scene(planar=True)], fins=[pair])
