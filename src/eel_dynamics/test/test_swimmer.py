# SPDX-License-Identifier: Apache-2.0
"""A swimmer as one value: checked when it is made, the same for whoever takes it, and refused by name."""

import pickle
from dataclasses import fields

import numpy as np
import pytest
from eel_common.attitude import unit_quaternion

from eel_dynamics import (
    Body,
    ExternalWrench,
    Fin,
    Gust,
    Robot,
    Scene,
    Simulation,
    Swim,
    Swimmer,
    save_scene,
    simulate,
    simulate_batch,
)
from eel_gaits import falling, straight

PLANE = Scene(planar=True)
FINS = [Fin.pair(0.5, 1e-3, 2.5)]
TURNED = np.array([0.1, -0.4, 0.3, 0.8]) / np.linalg.norm([0.1, -0.4, 0.3, 0.8])


def test_its_parts_and_its_whole_make_the_same_simulation():
    start = {"position": (1.0, 2.0, 0.0), "orientation": TURNED, "twist": (0.0, 0.0, 0.1, 0.3, 0.0, 0.0)}
    flow = Gust(velocity=(0.1, 0.0, 0.0), rise=0.5)
    swimmer = Swimmer.of(law=straight(), accuracy=1e-3, fins=FINS, flow=flow, **start)
    alone = Simulation(law=straight(), accuracy=1e-3, fins=FINS, flow=flow, **start)
    changed = Simulation(swimmer.changed(accuracy="draft"), accuracy=1e-3)
    others = [Simulation(swimmer), changed, Simulation(pickle.loads(pickle.dumps(swimmer)))]
    for each in (alone, *others):
        each.advance(0.3)
        assert each.observe().whole.tobytes() == alone.observe().whole.tobytes()
    run = Swim.of(law=straight(), accuracy=1e-3, fins=FINS, flow=flow, duration=0.3, **start).run()
    assert run == simulate(straight(), 0.3, accuracy=1e-3, fins=FINS, flow=flow, **start)


def test_equal_fields_are_an_equal_swimmer():
    assert Swimmer(stations=[0.0, 0.5]) == Swimmer(stations=(0.0, 0.5)) == Swimmer(stations=np.array([0.0, 0.5]))
    assert Swimmer() == Swimmer().changed() != Swimmer(scene=PLANE)
    swimmer = Swimmer.of(orientation=TURNED, fins=FINS)
    again = swimmer.changed().changed()
    assert again == swimmer and again.start.orientation.tobytes() == swimmer.start.orientation.tobytes()
    assert [fin.name for fin in again.fins] == ["left", "right"]


def test_what_was_given_may_change_later():
    stations, place = np.array([0.0, 0.5, 1.0]), np.zeros(3)
    swimmer = Swimmer.of(stations=stations, position=place)
    stations[1], place[0] = 7.0, 5.0
    assert swimmer.x.tolist() == [0.0, 0.5, 1.0] and not swimmer.start.position.any()


def test_a_changed_swimmer_has_no_value_of_the_old_one():
    swimmer = Swimmer(robot=Robot.named("eight_servos"))
    assert swimmer.modes is not None and len(swimmer.x) == 51
    other = swimmer.unchecked(robot=None, stations=5)
    assert other.modes is None and len(other.x) == 5 and other.settings != swimmer.settings
    with pytest.raises(TypeError, match="Swimmer has no field duratoin, station"):
        swimmer.unchecked(station=5, duratoin=3)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"law": falling(), "scene": PLANE}, "has a pitch term: a planar scene cannot bend out of its plane"),
        ({"law": "straight"}, "law must be a Law or a SampledLaw, got 'straight'"),
        ({"start": None}, "start must be an InitialState, its position, orientation and twist, got None"),
        ({"start": ((0, 0, 0), (0, 0, 0, 1))}, "start must be an InitialState"),
        (
            {"robot": Robot.named("eight_servos"), "body": Body.spindle(0.2, 20.0)},
            "joint 'joint_2' position and width",
        ),
        ({"wrenches": [ExternalWrench(1.2)]}, "external wrench station must lie on the body"),
        ({"stations": 1}, "stations must be 2 or more"),
        ({"stations": [0.0, 1.5]}, "stations must rise within 0 to 1.0 m"),
        ({"most_evaluations": -1}, "most_evaluations must be > 0 per simulated second"),
        ({"until": -3.0}, "until must be >= 0 s"),
        ({"duration": -5.0}, "duration must be >= 0 s"),
        ({"duration": "long"}, "duration must be a number"),
        ({"sample_period": "x"}, "sample_period must be a number"),
    ],
)
def test_a_field_that_does_not_fit_is_refused_by_name(given, message):
    kind = Swim if given.keys() & {"duration", "sample_period"} else Swimmer
    with pytest.raises(ValueError, match=message):
        kind(**given)


def test_no_profiles_are_for_a_batch_alone():
    batch = simulate_batch([straight(), straight(period=0.8)], 0.3, accuracy="draft", stations=None)
    assert batch.backbone is None and len(batch) == 2
    for make in (lambda: Swim(straight(), stations=None).run(), lambda: Simulation(stations=None)):
        with pytest.raises(ValueError, match="stations must be a number of them, or their X in m, got None"):
            make()


def test_a_batch_takes_the_bodies_of_its_robots():
    robot = Robot.named("eight_servos")
    long = Robot(robot.parts, name="long", body=Body.spindle(1.2, 20.0))
    batch = simulate_batch(straight(), 0.2, robots=[long, None], accuracy="draft", estimate=False)
    assert [each.length for each in batch.bodies] == [1.2, 1.0]


def test_a_fault_of_all_names_no_swimmer_of_a_batch():
    for given, message in (({"most_evaluations": -1}, "^most_evaluations"), ({"duration": -1.0}, "^duration")):
        with pytest.raises(ValueError, match=message):
            simulate_batch([straight()] * 2, **{"duration": 0.2} | given)
    with pytest.raises(ValueError, match=r"^swimmer 1: .*pitch term"):
        simulate_batch([straight(), falling()], 0.2, scenes=PLANE)


def test_a_file_holds_a_swim_or_refuses_it(tmp_path):
    swim = Swim(straight(), duration=0.2)
    without_key = {item.name for item in fields(Swim)} & {"most_evaluations", "sensors", "estimate", "load", "until"}
    changes = {"most_evaluations": 50.0, "sensors": (0.5,), "estimate": False, "load": True, "until": 1.0}
    assert without_key == changes.keys()
    settings = swim.changed(gait=_straight())
    save_scene(settings, tmp_path / "scene.yaml")
    for name, value in ({"stations": None} | changes).items():
        with pytest.raises(ValueError, match=f"{name} cannot be written"):
            save_scene(settings.changed(**{name: value}), tmp_path / "scene.yaml")


def _straight():
    from eel_gaits.gaits.settings import Settings

    return Settings().changed({"gait": "straight"})


def test_a_quaternion_normalised_to_the_last_digit_stays():
    rng = np.random.default_rng(3)
    for given in rng.normal(size=(200, 4)):
        once = unit_quaternion("q", (given / np.linalg.norm(given)).tolist())
        assert unit_quaternion("q", once) == once
    assert unit_quaternion("q", (0.0, 0.0, 0.0, 1.0005)) == (0.0, 0.0, 0.0, 1.0)
