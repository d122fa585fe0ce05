# SPDX-License-Identifier: Apache-2.0
"""`eel record` and `eel echo` over DDS: nothing is lost, the bag is what other tools expect, both end well."""

import math
import signal
import time
from pathlib import Path

import made_up
import numpy as np
import pytest
import yaml
from eel_common.ros.testing.node_process import PROMPT, found_executable
from eel_common.topics import GLOBAL, OWN
from eel_viz.bags.definitions import definition, message_class, type_hash
from eel_viz.ros.echo import as_yaml, picked
from fake_swimmer import TOPICS, arrived, diagnostics, found, messages
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import Reader
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

SWIMMER = str(Path(__file__).with_name("fake_swimmer.py"))
ECHO = ("eel_echo",)
TYPES = sorted({*OWN.values(), *GLOBAL.values()})


def contents(folder):
    """topic -> [(time of reception, message)] by `rosbags` alone, with the types that the bag itself defines."""
    found = {}
    with AnyReader([folder]) as reader:
        for connection, stamp, raw in reader.messages():
            found.setdefault(connection.topic, []).append((stamp, reader.deserialize(raw, connection.msgtype)))
    return found


def so_far(folder):
    """As `contents`, of a bag that is being recorded; nothing where it has changed while it was read."""
    try:
        return contents(folder)
    except Exception:  # rosbags then finds anything, a size beyond all memory too
        return {}


def stamp_of(message):
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


def test_a_run_without_a_pace_is_recorded_completely(start, fresh_domain, tmp_path):
    count = 151
    folder = tmp_path / "bag"
    before = time.time_ns()
    recorder = start("record", "-o", str(folder), "--stop-with-publisher")
    recorder.wait_for_output("recording to")
    swimmer = start("python", SWIMMER, "1.5", "100.0", "51", "1")
    assert recorder.wait(90.0) == 0, recorder.output() + swimmer.output()
    for topic in TOPICS:
        assert f"/{topic} {count}" in recorder.output()
    bag = contents(folder)
    model = made_up.Swimmer()
    stamps = [round(k * 1e9 / 100) for k in range(count)]
    for topic in TOPICS:
        assert [stamp_of(message) for _, message in bag[f"/{topic}"]] == stamps
        received = np.array([stamp for stamp, _ in bag[f"/{topic}"]])
        assert np.all(np.diff(received) >= 0)
        assert before < received[0]
        assert received[-1] < time.time_ns()
    for k in (0, 57, count - 1):
        sent = messages(model, stamps[k])
        wrench, load = bag["/internal_wrench"][k][1], bag["/hydrodynamic_load"][k][1]
        np.testing.assert_array_equal(wrench.torque_3, sent["internal_wrench"].torque_3)
        np.testing.assert_array_equal(load.resistive_2, sent["hydrodynamic_load"].resistive_2)
        assert load.tail_force.x == sent["hydrodynamic_load"].tail_force.x
        assert bag["/odom"][k][1].pose.pose.position.x == sent["odom"].pose.pose.position.x
        assert bag["/energy"][k][1].residual == sent["energy"].residual
    assert bag["/body"][0][1].mass == 1.944
    assert bag["/curvature_law"][0][1].name == "falling"
    assert bag["/diagnostics"][0][1].status[0].values[0].value == "falling"

    described = yaml.safe_load((folder / "metadata.yaml").read_text())["rosbag2_bagfile_information"]
    assert described["storage_identifier"] == "mcap"
    assert described["message_count"] == sum(len(entries) for entries in bag.values())
    assert [entry["path"] for entry in described["files"]] == ["bag.mcap"]
    profiles = {}
    for entry in described["topics_with_message_count"]:
        about = entry["topic_metadata"]
        assert entry["message_count"] == len(bag[about["name"]])
        assert about["type_description_hash"] == type_hash(about["type"])
        (profiles[about["name"]],) = about["offered_qos_profiles"]
    assert (profiles["/body"]["durability"], profiles["/head_pose"]["durability"]) == ("transient_local", "volatile")
    assert {profile["reliability"] for profile in profiles.values()} == {"reliable"}


def test_a_repeated_sample_0_is_recorded_once(start, network, tmp_path):
    """Four times the same, as a run sends it that waits for a law; then another one, as a law makes it."""
    recorder = start("record", "-o", str(tmp_path / "bag"))
    recorder.wait_for_output("recording to")
    publisher = network.create_publisher(TOPICS["head_pose"], "head_pose", 1000)
    found(publisher)
    for stamp, x in [(0, 1.0)] * 4 + [(0, 2.0), (10, 3.0), (10, 3.0)]:
        message = messages(made_up.Swimmer(51), stamp)["head_pose"]
        message.pose.position.x = x
        publisher.publish(message)
    assert publisher.wait_for_all_acked()
    recorder.process.send_signal(signal.SIGINT)
    assert recorder.wait(90.0) == 0 and "/head_pose 4" in recorder.output(), recorder.output()
    bag = contents(tmp_path / "bag")["/head_pose"]
    assert [message.pose.position.x for _, message in bag] == [1.0, 2.0, 3.0, 3.0]


def test_sample_0_of_the_run_after_a_reset_is_recorded(start, network, tmp_path):
    """It has the same bytes as that of the run before."""
    recorder = start("record", "-o", str(tmp_path / "bag"))
    recorder.wait_for_output("recording to")
    publisher = network.create_publisher(TOPICS["head_pose"], "head_pose", 1000)
    found(publisher)
    for stamp in (0, 0, 10, 20, 0, 0, 10):
        publisher.publish(messages(made_up.Swimmer(51), stamp)["head_pose"])
    assert publisher.wait_for_all_acked()
    recorder.process.send_signal(signal.SIGINT)
    assert recorder.wait(90.0) == 0, recorder.output()
    bag = contents(tmp_path / "bag")["/head_pose"]
    assert [stamp_of(message) for _, message in bag] == [0, 10, 20, 0, 10]


@pytest.mark.parametrize("kind", TYPES)
def test_definitions_are_complete_and_their_hashes_are_those_of_the_types(kind):
    store = get_typestore(Stores.EMPTY)
    parts = definition(kind).split("=" * 80 + "\n")
    for k, part in enumerate(parts):
        name, text = (kind, part) if k == 0 else part.split("\n", 1)
        types = get_types_from_msg(text, name.removeprefix("MSG: ").replace("/", "/msg/") if k else kind)
        store.register({key: value for key, value in types.items() if key not in store.fielddefs})
    assert store.hash_rihs01(kind) == type_hash(kind)


def test_types_that_are_not_installed_are_named():
    for call in (message_class, definition, type_hash):
        with pytest.raises(ValueError, match="message type 'no_msgs/msg/None' is not installed here"):
            call("no_msgs/msg/None")


@pytest.mark.fault(
    "ending", "SIGINT or SIGTERM while `eel record` records", "prompt exit, status 0; the bag is complete"
)
@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_closes_the_bag_well(start, network, tmp_path, sent):
    recorder = start("record", "-o", str(tmp_path / "bag"))
    recorder.wait_for_output("recording to")
    publisher = network.create_publisher(TOPICS["head_pose"], "head_pose", 1000)
    found(publisher)
    for k in range(20):
        publisher.publish(messages(made_up.Swimmer(5), k * 10**8)["head_pose"])
    arrived(publisher)
    assert recorder.time_to_end(sent) < PROMPT
    assert recorder.status == 0, recorder.output()
    assert "Traceback" not in recorder.output()
    assert len(contents(tmp_path / "bag")["/head_pose"]) == 20


@pytest.mark.fault(
    "ending",
    "SIGKILL of `eel record`",
    "the bag opens everywhere, with all but the last 0.7 s (measured; 2.5 s with twenty busy processes on two cores)",
)
def test_a_recorder_that_is_killed_leaves_a_bag_with_all_that_it_had_saved(start_to_kill, network, tmp_path):
    recorder = start_to_kill("record", "-o", str(tmp_path / "bag"))
    recorder.wait_for_output("recording to")
    assert contents(tmp_path / "bag") == {}  # a bag from the beginning
    publishers = {topic: network.create_publisher(kind, topic, 1000) for topic, kind in TOPICS.items()}
    found(*publishers.values())
    sample = messages(made_up.Swimmer(51), 0)
    for sent in range(200):
        sample["head_pose"].pose.position.x = float(sent)
        for topic, message in sample.items():
            publishers[topic].publish(message)
        time.sleep(0.005)  # so that the bag was made whole a few times
    deadline = time.monotonic() + 90
    while len(so_far(tmp_path / "bag").get("/head_pose", ())) < 200:  # at most a second, and what the machine adds
        assert time.monotonic() < deadline, recorder.output()
        time.sleep(0.2)
    recorder.process.kill()
    recorder.wait(90.0)
    with Reader(tmp_path / "bag") as reader:
        raw = sum(1 for _ in reader.messages())
        assert reader.message_count == raw
    bag = contents(tmp_path / "bag")
    assert set(bag) == {f"/{topic}" for topic in TOPICS}
    received = [message.pose.position.x for _, message in bag["/head_pose"]]
    assert received == list(range(200))


@pytest.mark.fault(
    "ending",
    "no room for the bag of `eel record`",
    "one line that says how many messages it has, status 1; the bag opens",
)
def test_a_full_disk_is_said_in_one_line_and_what_was_written_opens(start, network, tmp_path):
    record = ['ulimit -f 600; exec "$@"', "-", found_executable("record"), "-o", str(tmp_path / "bag")]  # KiB
    recorder = start("bash", "-c", *record)
    recorder.wait_for_output("recording to")
    publisher = network.create_publisher(TOPICS["backbone"], "backbone", 1000)
    found(publisher)
    message, sent = messages(made_up.Swimmer(51), 0)["backbone"], 0
    deadline = time.monotonic() + 90
    while recorder.status is None and time.monotonic() < deadline:
        message.header.stamp.sec = sent
        publisher.publish(message)
        sent += 1
        time.sleep(0.02)  # so that the bag was made whole a few times before it is full
    assert recorder.status == 1, recorder.output()
    assert "Traceback" not in recorder.output()
    last = recorder.output().strip().splitlines()[-1]
    assert last.startswith(f"eel record: {tmp_path / 'bag'}: File too large: the bag ends with the ")
    kept = contents(tmp_path / "bag")["/backbone"]
    assert f"the {len(kept)} messages before" in last
    assert [message.header.stamp.sec for _, message in kept] == list(range(len(kept)))
    assert len(kept) > 10
    assert (tmp_path / "bag" / "bag.mcap").stat().st_size <= 600 * 1024


def test_named_topics_of_a_namespace_others_qualities_and_a_duration(start, network, tmp_path):
    from geometry_msgs.msg import Vector3
    from rclpy.qos import QoSProfile, ReliabilityPolicy

    recorder = start(
        "record", "head_pose", "extra", "-o", str(tmp_path / "bag"), "--namespace", "/second", "--duration", "600"
    )
    recorder.wait_for_output("recording to")
    best_effort = QoSProfile(depth=100, reliability=ReliabilityPolicy.BEST_EFFORT)
    pose = network.create_publisher(TOPICS["head_pose"], "/second/head_pose", best_effort)  # not as the suite has it
    extra = network.create_publisher(Vector3, "/second/extra", 10)
    unasked = network.create_publisher(TOPICS["energy"], "/second/energy", 10)
    found(pose, extra)
    for k in range(5):
        extra.publish(Vector3(x=float(k)))
    sent, deadline = 0, time.monotonic() + 90
    while len(so_far(tmp_path / "bag").get("/second/head_pose", [])) < 5:  # some may be lost on their way
        assert time.monotonic() < deadline, recorder.output()
        pose.publish(messages(made_up.Swimmer(5), sent * 10**8)["head_pose"])
        unasked.publish(messages(made_up.Swimmer(5), sent * 10**8)["energy"])
        sent += 1
        time.sleep(0.1)
    assert recorder.interrupt() == 0, recorder.output()
    bag = contents(tmp_path / "bag")
    assert set(bag) == {"/second/head_pose", "/second/extra"}
    assert [message.x for _, message in bag["/second/extra"]] == [0.0, 1.0, 2.0, 3.0, 4.0]
    assert set(map(stamp_of, (message for _, message in bag["/second/head_pose"]))) <= {k * 10**8 for k in range(sent)}


def test_a_folder_that_is_there_is_refused(start, tmp_path):
    (tmp_path / "bag").mkdir()
    recorder = start("record", "-o", str(tmp_path / "bag"))
    assert recorder.wait(90.0) == 2
    said = [line for line in recorder.output().splitlines() if line.strip()]
    assert len(said) == 1
    assert "exists already" in said[0]


@pytest.mark.fault("parameters", "a duration or a timeout of 0, below 0 or nan", "one line, status 2; nothing is made")
def test_a_time_that_cannot_be_is_refused_in_one_line(start_in_turn, tmp_path, monkeypatch):
    folder = tmp_path / "empty"
    folder.mkdir()
    monkeypatch.chdir(folder)
    for module, words, given in (
        ("record", ("-o", "bag", "--duration"), ("nan", "-1")),
        ("echo", ("x", "--timeout"), ("nan", "0")),
    ):
        lines = [[*words, each] for each in given]
        for each, answer in zip(given, start_in_turn(f"eel_viz.ros.{module}", lines), strict=True):
            assert answer == (2, f"eel {module}: {words[-1]} must be > 0 s, got {each}\n")
    assert list(folder.iterdir()) == []


def test_a_recording_without_messages_is_a_bag_too(start, tmp_path):
    recorder = start("record", "-o", str(tmp_path / "bag"), "--duration", "0.5", "head_pose")
    assert recorder.wait(90.0) == 0, recorder.output()
    assert contents(tmp_path / "bag") == {}
    assert "no message" in recorder.output()


def test_echo_prints_one_message_as_yaml(start, network):
    publisher = network.create_publisher(TOPICS["backbone"], "backbone", 10)
    whole = start(*ECHO, "backbone", "--once", "--timeout", "90")
    part = start(*ECHO, "/backbone", "--once", "--field", "header.stamp.nanosec", "--timeout", "90")
    message = messages(made_up.Swimmer(51), 2_500_000_000)["backbone"]
    deadline = time.monotonic() + 100
    while (whole.status is None or part.status is None) and time.monotonic() < deadline:
        publisher.publish(message)
        time.sleep(0.05)
    assert (whole.status, part.status) == (0, 0), whole.output() + part.output()
    text, _, rest = whole.output().partition("---\n")
    assert rest == ""
    printed = yaml.safe_load(text)
    assert printed["header"] == {"stamp": {"sec": 2, "nanosec": 500_000_000}, "frame_id": "odom"}
    np.testing.assert_array_equal(printed["x"], message.x)
    assert len(printed["position"]) == 129
    assert printed["position"][-1] == "..."
    np.testing.assert_array_equal(printed["position"][:-1], message.position[:128])
    assert part.output() == "500000000\n---\n"


def test_echo_hears_what_was_published_before_it(start, network):
    from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

    from eel_msgs.msg import BodyGeometry

    latched = QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    network.create_publisher(BodyGeometry, "body", latched).publish(BodyGeometry(mass=1.5))
    echo = start(*ECHO, "body", "--once", "--field", "mass", "--timeout", "90")
    assert echo.wait(100.0) == 0, echo.output()
    assert echo.output() == "1.5\n---\n"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("nothing", "--timeout", "1"), "no message on /nothing within 1 s"),
        (("head_pose", "--field", "pose.size", "--timeout", "90"), "field 'pose.size' is not in PoseStamped"),
    ],
)
def test_echo_fails_with_status_1_and_one_line(start, network, arguments, words):
    publisher = network.create_publisher(TOPICS["head_pose"], "head_pose", 10)
    echo = start(*ECHO, *arguments)
    deadline = time.monotonic() + 100
    while echo.status is None and time.monotonic() < deadline:
        publisher.publish(TOPICS["head_pose"]())
        time.sleep(0.05)
    assert echo.status == 1, echo.output()
    assert words in echo.output()
    assert len(echo.output().strip().splitlines()) == 1


def test_yaml_of_nested_messages_and_fields():
    message = diagnostics(1_500_000_000)
    assert yaml.safe_load(as_yaml(message)) == {
        "header": {"stamp": {"sec": 1, "nanosec": 500_000_000}, "frame_id": ""},
        "status": [
            {
                "level": 0,
                "name": "/dynamics",
                "message": "running",
                "hardware_id": "simulation",
                "values": [{"key": "law", "value": "falling"}, {"key": "real_time_factor", "value": "0"}],
            }
        ],
    }
    assert picked(message, "status.0.values.1.key") == "real_time_factor"
    assert picked(message, None) is message
    with pytest.raises(ValueError, match=r"field 'status.3' is not in DiagnosticArray"):
        picked(message, "status.3.name")
    assert math.isnan(yaml.safe_load(as_yaml(math.nan)))
