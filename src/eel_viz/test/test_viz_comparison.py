# SPDX-License-Identifier: Apache-2.0
"""Two runs laid over each other: the pairs, the differences, and what is drawn of the other, against its messages."""

import made_up
import numpy as np
import pytest
from eel_viz.batched_stream import Rates
from eel_viz.plots.pairs import Pairs, Stamped
from eel_viz.recording.loggers import Loggers
from eel_viz.recording.reading import read
from eel_viz.recording.recording_file import FileDestination
from eel_viz.settings import Settings
from made_up_recording import body, sample

from eel_viz import entities

STEP = 2 * 10**7  # ns
COUNT = 26
SHIFT = (0.003, -0.004, 0.0)  # m: between the two heads


def record(path, *, other_first=False):
    """Two swimmers beside each other, the other with other stations and half the torque; their samples."""
    settings = Settings(recording=str(path), compare="/draft", blueprint="compare")
    file = FileDestination(settings, print, print)
    delivery = file.open(1, "made up")
    loggers = Loggers(delivery.stream, settings, Rates(), "standard")
    for compared, law in ((False, "made up"), (True, "another")):
        loggers.log("body", 0, body(), compared=compared)
        loggers.log("curvature_law", 0, law, compared=compared)
    these, others = made_up.Swimmer(51), made_up.Swimmer(26, offset=SHIFT)
    calls = []
    logged = {}
    for k in range(COUNT):
        stamp = k * STEP
        logged[stamp] = sample(these, stamp), sample(others, stamp)
        for values in logged[stamp][1]["internal_wrench"][0].values.values():
            values *= 0.5
        pair = [(False, stamp, logged[stamp][0]), (True, stamp, logged[stamp][1])]
        calls += pair[::-1] if other_first else pair
    for compared, stamp, messages in calls:
        for method, arguments in messages.items():
            loggers.log(method, stamp, *arguments, compared=compared)
    loggers.flush()
    delivery.close()
    return logged


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    path = tmp_path_factory.mktemp("compared") / "compared.rrd"
    return path, record(path)


def test_pairs_are_exact_at_equal_stamps_and_linear_between():
    pairs = Pairs()
    assert pairs.add(Stamped(10, np.array([1.0])), of_other=False) == []
    assert pairs.add(Stamped(0, np.array([4.0])), of_other=True) == []
    ((stamp, _, this, other),) = pairs.add(Stamped(40, np.array([8.0])), of_other=True)
    assert (stamp, *this, *other) == (10, 1.0, 5.0)
    ((stamp, _, this, other),) = pairs.add(Stamped(40, np.array([2.0])), of_other=False)
    assert (stamp, *this, *other) == (40, 2.0, 8.0)


def test_pairs_are_brought_to_the_first_s_stations():
    pairs = Pairs()
    x, own = np.array([0.0, 0.25, 1.0]), np.array([0.0, 1.0])
    pairs.add(Stamped(0, np.array([[0.0], [4.0]]), own), of_other=True)
    ((_, _, _, other),) = pairs.add(Stamped(0, np.zeros((3, 1)), x), of_other=False)
    np.testing.assert_array_equal(other, [[0.0], [1.0], [4.0]])


def test_a_run_that_is_far_ahead_is_bounded_and_the_rest_still_pairs():
    pairs = Pairs()
    for k in range(5000):
        pairs.add(Stamped(k, np.zeros(1)), of_other=False)
    found = [pair[0] for k in range(5000) for pair in pairs.add(Stamped(k, np.zeros(1)), of_other=True)]
    assert found == list(range(5000 - 1024, 5000))


def test_differences_are_those_of_the_messages(made):
    path, logged = made
    distance = read(path, entities.DISTANCE)
    np.testing.assert_array_equal(distance.stamps, list(logged))
    np.testing.assert_allclose(distance["scalars"][:, 0], 0.005, rtol=1e-9)  # m
    most = read(path, entities.TORQUE_DIFFERENCE_MOST)
    np.testing.assert_array_equal(most.stamps, list(logged))
    for k, (this, other) in enumerate(logged.values()):
        wrench, half = this["internal_wrench"][0], other["internal_wrench"][0]
        differences = [
            np.abs(wrench.values[name] - np.interp(wrench.x, half.x, half.values[name])).max()
            for name in ("torque_1", "torque_2", "torque_3")
        ]
        np.testing.assert_allclose(most["scalars"][k], [max(differences)], rtol=1e-12)


def test_the_other_is_drawn_from_its_own_messages(made):
    path, logged = made
    speed = read(path, entities.OTHER_SPEED)
    expected = [[np.linalg.norm(other["head_twist"][0].linear)] for _, other in logged.values()]
    np.testing.assert_array_equal(speed["scalars"], expected)
    line, hoops = read(path, entities.OTHER_BACKBONE), read(path, entities.OTHER_HOOPS)
    np.testing.assert_array_equal(line.stamps, hoops.stamps)
    for k, stamp in enumerate(line.stamps.tolist()):
        backbone = logged[stamp][1]["backbone"][0]
        np.testing.assert_allclose(line["strips"][k][0], backbone.position, atol=1e-6)
        rings = np.array(hoops["strips"][k])
        np.testing.assert_array_equal(rings[:, 0], rings[:, -1])  # closed
        nearest = np.linalg.norm(rings[:, :, None] - backbone.position, axis=3).min(axis=2)
        assert nearest.max() < 0.06  # around the backbone, as thick as the body


def test_the_table_has_both_runs(made):
    path, _ = made
    text = read(path, entities.COMPARE_TEXT)["text"][-1][0]
    assert "| | standard | draft |" in text
    assert "| law | made up | another |" in text
    assert "heads apart by at most **5.00 mm** so far" in text


def test_the_order_of_the_two_does_not_matter(made, tmp_path):
    path, _ = made
    record(tmp_path / "turned.rrd", other_first=True)
    for entity, component in (
        (entities.DISTANCE, "scalars"),
        (f"{entities.TORQUE_DIFFERENCE}/{entities.CURVES}", "strips"),
        (f"{entities.COMPARED_TORQUE}/{entities.CURVES}", "strips"),
    ):
        one, two = read(path, entity), read(tmp_path / "turned.rrd", entity)
        np.testing.assert_array_equal(one.stamps, two.stamps)
        np.testing.assert_array_equal(one[component], two[component])


def test_the_arrangement_of_a_comparison_needs_another_run():
    with pytest.raises(ValueError, match="compare must be the other swimmer's namespace"):
        Settings(blueprint="compare")
