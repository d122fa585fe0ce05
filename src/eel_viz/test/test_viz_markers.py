# SPDX-License-Identifier: Apache-2.0
"""The node `markers` over DDS: what RViz and Foxglove get is the swimmer of the messages."""

import time

import numpy as np
import pytest
from eel_viz.message_readers import read_backbone, read_load
from eel_viz.ros.marker_messages import WIDTHS
from eel_viz.scene3d import colours
from eel_viz.scene3d.centre_line import ALONG, forces_along, forces_at_ends
from eel_viz.scene3d.skin import RINGS, SIDES, Skin
from eel_viz.settings import MarkerSettings
from fake_swimmer import LATCHED, TOPICS, body_message, messages
from made_up import Swimmer
from nav_msgs.msg import Path
from visualization_msgs.msg import Marker, MarkerArray

from eel_msgs.msg import BodyGeometry

LIMIT = 90.0  # s; for busy machines
STATIONS = 31
DRAWN = ("backbone", "internal_wrench", "hydrodynamic_load")


def triples(points):
    return np.array([(point.x, point.y, point.z) for point in points])


@pytest.fixture
def show(start, network):
    """show(*samples, topics, spaces, coloured, said, words): publishes them in turn in the namespace /eel1 until the
    node `markers`, with the ROS arguments `words`, has drawn markers in the `spaces`, the skin by its torque if
    `coloured`, and has `said` a text; the last MarkerArray, the last Path, and the node's process."""
    arrays, paths = [], []
    network.create_subscription(MarkerArray, "/eel1/markers", arrays.append, 10)
    network.create_subscription(Path, "/eel1/midline", paths.append, 10)
    body = network.create_publisher(BodyGeometry, "/eel1/body", LATCHED)
    body.publish(body_message(STATIONS))

    def are_drawn(markers, spaces, coloured):
        return {marker.ns for marker in markers} == {*spaces} and (
            not coloured or any(marker.ns == "skin" and marker.colors for marker in markers)
        )

    def run(*samples, topics=DRAWN, spaces=("skin", "load", "end_force"), coloured=False, said="", words=()):
        publishers = {topic: network.create_publisher(TOPICS[topic], f"/eel1/{topic}", 10) for topic in topics}
        node = start("markers", "--ros-args", "-r", "__ns:=/eel1", *words)
        limit = time.monotonic() + LIMIT
        while not (arrays and paths and are_drawn(arrays[-1].markers, spaces, coloured) and said in node.output()):
            assert time.monotonic() < limit, "no markers\n" + node.output()
            for sample in samples:
                for topic, publisher in publishers.items():
                    publisher.publish(sample[topic])
            for _ in range(5):
                network.executor_of_test.spin_once(timeout_sec=0.02)
        run.publishers = publishers
        return arrays[-1], paths[-1], node

    run.arrays = arrays
    return run


@pytest.fixture(scope="module")
def sample():
    return messages(Swimmer(STATIONS), 1_300_000_000)


def test_markers_are_the_swimmer(show, sample):
    array, path, node = show(sample, coloured=True)  # the wrench may be found after the others
    for header in (path.header, *(marker.header for marker in array.markers)):
        assert header == sample["backbone"].header  # stamp, and the frame of the publisher
    backbone, load = read_backbone(sample["backbone"]), read_load(sample["hydrodynamic_load"])
    assert np.array_equal(triples(pose.pose.position for pose in path.poses), backbone.position)

    (skin,) = (marker for marker in array.markers if marker.ns == "skin")
    given = body_message(STATIONS)
    mesh = Skin(np.array(given.x), np.array(given.half_width), np.array(given.half_height))
    vertices, _ = mesh.place(backbone.x, backbone.position, backbone.orientation)
    assert skin.type == Marker.TRIANGLE_LIST and len(mesh.triangles) > RINGS * SIDES
    assert np.allclose(triples(skin.points), vertices[mesh.triangles.ravel()], rtol=0, atol=1e-6)
    torque = mesh.at_vertices(backbone.x, np.array(sample["internal_wrench"].torque_3))[mesh.triangles.ravel()]
    shades = np.array([(each.r, each.g, each.b) for each in skin.colors]) * 255
    assert np.allclose(shades, colours.diverging(torque, MarkerSettings().colour_limit), atol=0.01)
    assert shades[np.argmax(torque), 0] > 150 > shades[np.argmin(torque), 0], (
        "red for the greatest torque, blue for the least"
    )

    settings = MarkerSettings()
    for space, count, scale, (origins, forces) in (
        ("load", ALONG, settings.load_scale, forces_along(backbone, load)),
        ("end_force", 2, settings.end_force_scale, forces_at_ends(backbone, load)),
    ):
        drawn = [marker for marker in array.markers if marker.ns == space and marker.type == Marker.ARROW]
        assert len(drawn) == count and [marker.id for marker in drawn] == list(range(count))
        for marker, origin, arrow in zip(drawn, origins, scale * forces, strict=True):
            assert np.allclose(triples(marker.points), (origin, origin + arrow), rtol=0, atol=1e-12)
            assert marker.scale.x >= WIDTHS[0] and marker.color.a == 1.0
    assert node.interrupt() == 0, node.output()


def test_the_last_sample_of_a_run_that_pauses_is_drawn(show, sample, network):
    """It comes once, right after another has been drawn, at two markers in a second."""
    show(sample, words=("-p", "rate:=2.0"))
    last, drawn = messages(Swimmer(STATIONS), 1_310_000_000), len(show.arrays)
    limit = time.monotonic() + LIMIT
    while len(show.arrays) == drawn:
        assert time.monotonic() < limit
        for topic, publisher in show.publishers.items():
            publisher.publish(sample[topic])
        network.executor_of_test.spin_once(timeout_sec=0.02)
    for topic, publisher in show.publishers.items():
        publisher.publish(last[topic])
    while show.arrays[-1].markers[0].header != last["backbone"].header:
        assert time.monotonic() < limit, "the last sample is not drawn"
        network.executor_of_test.spin_once(timeout_sec=0.02)


@pytest.mark.fault(
    "neighbours",
    "a backbone with values that are not finite, for the node markers",
    "a warning that names the field, once; good samples are drawn",
)
def test_bad_messages_are_named_once_and_good_ones_drawn(show, sample):
    bad = messages(Swimmer(STATIONS), 1_200_000_000)
    bad["backbone"].position[4] = np.nan
    array, path, node = show(sample, bad, said="left out")
    assert node.output().count("position has values that are not finite: left out") == 1
    assert np.isfinite(triples(pose.pose.position for pose in path.poses)).all()
    assert all(marker.header.stamp.nanosec == 300_000_000 for marker in array.markers)


def test_without_wrench_and_load_the_skin_is_grey(show, sample):
    array, _, _ = show(sample, topics=("backbone",), spaces=("skin",))
    (skin,) = array.markers
    assert not skin.colors and (skin.color.r, skin.color.a) == (pytest.approx(colours.GREY[0] / 255), 1.0)
