# SPDX-License-Identifier: Apache-2.0
"""`eel replay`: a bag becomes the recording that the visualiser makes of the same messages, whatever the bag's form."""

import sqlite3
import subprocess
import sys
from types import SimpleNamespace

import made_up
import numpy as np
import pytest
from compared import contents, differences
from eel_viz.bags.bag import Bag
from eel_viz.bags.replay import main
from eel_viz.recording.merged_messages import merged_by_time
from eel_viz.recording.reading import read
from made_up_bag import write_bag
from made_up_recording import record
from mcap.reader import make_reader
from mcap.writer import IndexType, Writer
from rosbags.rosbag2 import CompressionMode, StoragePlugin

from eel_viz import entities

ABOUT = "rosbag2_bagfile_information: {version: 9}"
STAMPS = [k * 10**7 for k in range(101)]


@pytest.fixture(scope="module")
def bag(tmp_path_factory):
    """1 s at 100 Hz, finished well."""
    return write_bag(tmp_path_factory.mktemp("bag") / "bag")


@pytest.fixture(scope="module")
def logged(tmp_path_factory):
    """What the loggers make of the same numbers."""
    path = tmp_path_factory.mktemp("logged") / "logged.rrd"
    record(path, 1.0, 100.0, stations=21)
    return path


def said_in_one_line(capsys, *arguments) -> str:
    """What `eel replay` says when it refuses, with status 2."""
    assert main([str(word) for word in arguments]) == 2
    said = capsys.readouterr().err
    assert len(said.splitlines()) == 1, said
    return said


def same_numbers(path, logged):
    found = [line for line in differences(path, logged) if "TextLog" not in line and "TextDocument" not in line]
    assert found == []


@pytest.mark.parametrize(
    ("storage", "compression"),
    [
        (StoragePlugin.MCAP, CompressionMode.NONE),
        (StoragePlugin.MCAP, CompressionMode.STORAGE),
        (StoragePlugin.SQLITE3, CompressionMode.NONE),
        (StoragePlugin.SQLITE3, CompressionMode.FILE),
        (StoragePlugin.MCAP, CompressionMode.MESSAGE),
    ],
    ids=lambda value: value.name.lower(),
)
def test_every_number_is_that_of_the_visualisers_loggers(tmp_path, logged, storage, compression):
    folder = write_bag(tmp_path / "bag", storage=storage, compression=compression)
    assert main([str(folder), "-o", str(tmp_path / "run.rrd")]) == 0
    same_numbers(tmp_path / "run.rrd", logged)
    assert len(contents(tmp_path / "run.rrd")) > 150
    assert read(tmp_path / "run.rrd", entities.LOG)["text"][0][0] == "law 'made up' published"


@pytest.mark.parametrize("runs", [1, 2])
def test_a_sample_0_that_was_repeated_before_the_run_is_shown_and_counted_once(tmp_path, capsys, runs):
    folder = write_bag(tmp_path / "bag", 0.4, waiting=3, runs=runs)
    assert main([str(folder), "-o", str(tmp_path / "run.rrd")]) == 0
    assert f"backbone {41 * runs}" in capsys.readouterr().out
    for name in ("run.rrd", "run-2.rrd")[:runs]:
        torque = read(tmp_path / name, entities.WRENCH_NUMBERS)
        np.testing.assert_array_equal(torque.stamps_of["torque_3"], STAMPS[:41])
        np.testing.assert_array_equal(torque["torque_3"][0], made_up.Swimmer(21).wrench(0.0)["torque_3"])


def test_it_needs_no_ros_at_all(tmp_path, bag, logged):
    blocked = ["rclpy", "eel_msgs", "std_msgs", "geometry_msgs", "rcl_interfaces", "builtin_interfaces", "nav_msgs"]
    code = f"import sys\nfor name in {blocked!r}: sys.modules[name] = None\nfrom eel_viz.bags.replay import main\n"
    code += f"sys.exit(main([{str(bag)!r}, '-o', {str(tmp_path / 'run.rrd')!r}]))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    assert "replayed in" in done.stdout
    same_numbers(tmp_path / "run.rrd", logged)


def test_a_reset_begins_a_second_file_and_settings_are_taken(tmp_path, capsys):
    folder = write_bag(tmp_path / "bag", 0.4, runs=2)
    assert main([str(folder), "-o", str(tmp_path / "run.rrd"), "--skin-rate", "50", "--blueprint", "torques"]) == 0
    assert "went back from 0.4 s to 0 s" in capsys.readouterr().err
    for name in ("run.rrd", "run-2.rrd"):
        np.testing.assert_array_equal(read(tmp_path / name, entities.POSITION).stamps, STAMPS[:41])
        assert len(read(tmp_path / name, entities.SKIN)["vertex_positions"]) == 21  # 50 Hz
    expected = [made_up.Swimmer(21).wrench(stamp * 1e-9)["torque_3"] for stamp in STAMPS[:41]]
    np.testing.assert_array_equal(read(tmp_path / "run-2.rrd", entities.WRENCH_NUMBERS)["torque_3"], expected)


def test_one_of_several_swimmers_is_chosen(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_bag(tmp_path / "two", 0.1, namespaces=("/left", "/deep/right"))
    assert "choose one with --namespace: /deep/right, /left" in said_in_one_line(capsys, "two")
    words = "no swimmer in namespace 'middle' of the bag; there is: /deep/right, /left"
    assert words in said_in_one_line(capsys, "two", "--namespace", "middle")
    assert main(["two", "--namespace", "deep/right/"]) == 0
    np.testing.assert_array_equal(read(tmp_path / "two.rrd", entities.SPEED).stamps, STAMPS[:11])
    write_bag(tmp_path / "one", 0.1, namespaces=("/somewhere/else",))
    assert main(["one"]) == 0  # the only one needs no name
    np.testing.assert_array_equal(read(tmp_path / "one.rrd", entities.SPEED).stamps, STAMPS[:11])


@pytest.mark.fault(
    "names",
    "`eel replay` of a bag without metadata, without its end, of half a file, torn in the middle, with a journal",
    "one line with the tool that repairs it, status 2",
)
@pytest.mark.parametrize("cut", ["no metadata of two files", "half a file", "no end", "torn"])
def test_a_bag_that_is_not_whole_is_refused_with_what_repairs_it(tmp_path, capsys, cut):
    folder = write_bag(tmp_path / "bag", 0.5, stations=51, compression=CompressionMode.STORAGE)
    file = folder / "bag.mcap"
    whole = file.read_bytes()
    middle = whole.find(b"\x28\xb5\x2f\xfd")  # zstd's first frame
    parts = {
        "half a file": whole[: len(whole) // 2],
        "no end": whole[:-20],
        "torn": whole[:middle] + bytes(4) + whole[middle + 4 :],
    }
    if cut == "no metadata of two files":
        (folder / "metadata.yaml").unlink()
        (folder / "more.mcap").write_bytes(whole)
    else:
        file.write_bytes(parts[cut])
    said = said_in_one_line(capsys, folder, "-o", str(tmp_path / "run.rrd"))
    assert ("`ros2 bag reindex` makes it" if cut.startswith("no metadata") else "`mcap recover` repairs it") in said
    assert not (tmp_path / "run.rrd").exists()


def test_a_file_of_a_bag_will_do_but_for_sqlites_journal(tmp_path, capsys):
    folder = write_bag(tmp_path / "bag", 0.2, storage=StoragePlugin.SQLITE3)
    for path in (folder, folder / "bag.db3"):
        assert main([str(path), "-o", str(tmp_path / "run.rrd")]) == 0
        np.testing.assert_array_equal(read(tmp_path / "run.rrd", entities.SPEED).stamps, STAMPS[:21])
    capsys.readouterr()
    connection = sqlite3.connect(folder / "bag.db3")
    connection.execute("PRAGMA journal_mode=WAL")
    connection.execute("UPDATE messages SET timestamp = timestamp + 0")
    connection.commit()  # a recorder that is killed leaves it like this: all is in the journal
    said = said_in_one_line(capsys, folder, "-o", str(tmp_path / "run.rrd"))
    assert "bag.db3-wal is not yet in its file" in said
    connection.close()


@pytest.mark.parametrize("storage", [StoragePlugin.MCAP, StoragePlugin.SQLITE3])
@pytest.mark.parametrize("compression", [CompressionMode.NONE, CompressionMode.MESSAGE])
def test_a_whole_file_is_read_without_its_metadata(tmp_path, storage, compression):
    folder = write_bag(tmp_path / "bag", 0.2, storage=storage, compression=compression)
    (folder / "metadata.yaml").unlink()
    (file,) = folder.iterdir()
    for path in (folder, file):
        assert main([str(path), "-o", str(tmp_path / "run.rrd")]) == 0
        np.testing.assert_array_equal(read(tmp_path / "run.rrd", entities.SPEED).stamps, STAMPS[:21])


def test_a_file_of_mcap_without_an_index_is_whole(tmp_path):
    """As writers leave it that keep none: no summary, and nothing in the footer to compare with."""
    path, whole = tmp_path / "plain.mcap", write_bag(tmp_path / "bag", 0.1) / "bag.mcap"
    with path.open("wb") as file, whole.open("rb") as source:
        plain = {"repeat_channels": False, "repeat_schemas": False, "use_statistics": False}
        writer = Writer(file, index_types=IndexType.NONE, use_summary_offsets=False, **plain)
        writer.start("ros2")
        channels = {}
        for schema, channel, message in make_reader(source).iter_messages():
            if channel.id not in channels:
                kind = writer.register_schema(schema.name, schema.encoding, schema.data)
                channels[channel.id] = writer.register_channel(channel.topic, "cdr", kind, channel.metadata)
            writer.add_message(channels[channel.id], message.log_time, message.data, message.publish_time)
        writer.finish()
    assert main([str(path), "-o", str(tmp_path / "run.rrd")]) == 0
    np.testing.assert_array_equal(read(tmp_path / "run.rrd", entities.SPEED).stamps, STAMPS[:11])


@pytest.mark.fault(
    "names",
    "`eel replay` of a file that is packed, empty or of another kind, of metadata without content or with lost files",
    "one line that says what to do, status 2",
)
def test_what_is_packed_empty_or_lost_is_told_with_what_to_do(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    packed = write_bag(tmp_path / "packed", 0.1, compression=CompressionMode.FILE)
    (packed / "packed.mcap.zstd").rename(tmp_path / "a.mcap.zstd")
    (tmp_path / "b.db3.gz").write_bytes(b"x")
    (tmp_path / "empty.mcap").touch()
    (tmp_path / "other.mcap").write_bytes(b"\x28\xb5\x2f\xfd" * 9)
    (tmp_path / "half.db3").write_bytes(b"SQLite format 3\0" * 9)
    for name, text in {"blank": "", "list": "[1]", "none": "rosbag2_bagfile_information:", "few": ABOUT}.items():
        (tmp_path / name).mkdir()
        (tmp_path / name / "metadata.yaml").write_text(text)
    for path, words in {
        "a.mcap.zstd": "or it lies in a folder with its metadata.yaml: `zstd -d < a.mcap.zstd > a.mcap` unpacks it",
        "b.db3.gz": "`gzip -d < b.db3.gz > b.db3` unpacks it",
        "packed": "metadata.yaml (`ros2 bag reindex` makes it anew): it names 'packed.mcap.zstd', which is no file",
        "empty.mcap": "empty.mcap is empty",
        "other.mcap": "other.mcap is no MCAP file",
        "half.db3": "(`sqlite3 FILE .recover` saves what it still holds)",
        "blank": "metadata.yaml (`ros2 bag reindex` makes it anew): its content must be a dict, got None",
        "list": "metadata.yaml (`ros2 bag reindex` makes it anew): its content must be a dict, got [1]",
        "none": "(`ros2 bag reindex` makes it anew): rosbag2_bagfile_information must be a dict, got None",
        "few": "(`ros2 bag reindex` makes it anew): it must have topics_with_message_count",
    }.items():
        assert words in said_in_one_line(capsys, path, "-o", "run.rrd")


def test_a_bag_without_definitions_is_read_with_the_types_installed_here(tmp_path):
    folder = write_bag(tmp_path / "bag", 0.1, storage=StoragePlugin.SQLITE3)
    with sqlite3.connect(folder / "bag.db3") as connection:  # as Humble wrote them
        connection.execute("DELETE FROM message_definitions")
    with Bag(folder) as opened:
        assert {topic.definition for topic in opened.topics.values()} == {""}
    assert main([str(folder), "-o", str(tmp_path / "run.rrd")]) == 0
    np.testing.assert_array_equal(read(tmp_path / "run.rrd", entities.SPEED).stamps, STAMPS[:11])


def test_bad_messages_and_foreign_types_are_said_once_and_left_out(tmp_path, capsys):
    from geometry_msgs.msg import Point, PoseStamped

    def spoil(topic, message):
        if topic == "/energy":
            message.residual = float("nan")
        return {"/curvature_law": PoseStamped(), "/odom": Point()}.get(topic, message)

    kinds = {"/curvature_law": "geometry_msgs/msg/PoseStamped", "/head_twist": "geometry_msgs/msg/PoseStamped"}
    folder = write_bag(tmp_path / "bag", 0.1, spoil=spoil, kinds=kinds)
    assert main([str(folder), "-o", str(tmp_path / "run.rrd")]) == 0
    said = capsys.readouterr().err
    for words in (
        "energy: residual is nan: left out, and those like it",
        "/curvature_law is left out: it is geometry_msgs/msg/PoseStamped, not eel_msgs/msg/CurvatureLaw",
        "/head_twist is left out: it is geometry_msgs/msg/PoseStamped, not geometry_msgs/msg/TwistStamped",
        "/odom: ",  # bytes that are no Odometry
    ):
        assert said.count(words) == 1, said
    assert len(said.splitlines()) == 4
    np.testing.assert_array_equal(read(tmp_path / "run.rrd", entities.POSITION).stamps, STAMPS[:11])


def test_the_course_of_a_goal_is_shown(tmp_path):
    from geometry_msgs.msg import PoseStamped
    from nav_msgs.msg import Path

    goal = Path(poses=[PoseStamped(), PoseStamped()])
    goal.poses[1].pose.position.x = 4.0

    folder = write_bag(tmp_path / "bag", 0.1, goal=goal)
    assert main([str(folder), "-o", str(tmp_path / "run.rrd")]) == 0
    legs = read(tmp_path / "run.rrd", entities.COURSE, static=True)["strips"][-1][0]
    np.testing.assert_array_equal(legs, [(0.0, 0.0, 0.0), (4.0, 0.0, 0.0)])


@pytest.mark.fault("names", "`eel replay` of messages of another version", "said once, left out; the rest is shown")
def test_messages_of_another_version_are_said_once_and_left_out(tmp_path, capsys):
    folder = write_bag(tmp_path / "bag", 0.1)
    for file in folder.iterdir():  # as if the field had another name then; as long, so that the file's index holds
        file.write_bytes(file.read_bytes().replace(b"nose_power", b"snub_power"))
    from rosbags.rosbag2 import Reader

    with Reader(folder) as reader:
        assert any("snub_power" in connection.msgdef.data for connection in reader.connections)
    assert main([str(folder), "-o", str(tmp_path / "run.rrd")]) == 0
    said = capsys.readouterr().err
    assert "energy: type is another version's: " in said
    assert "nose_power" in said
    assert len(said.splitlines()) == 1
    np.testing.assert_array_equal(read(tmp_path / "run.rrd", entities.POSITION).stamps, STAMPS[:11])


@pytest.mark.fault("names", "`eel replay` of what is no bag, or has no swimmer", "one line, status 2")
def test_what_is_no_bag_is_said_in_one_line(tmp_path, capsys, bag, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    (tmp_path / "empty").mkdir()
    (tmp_path / "garbage.mcap").write_bytes(b"garbage" * 100)
    (tmp_path / "text.txt").write_text("hello")
    (tmp_path / "torn").mkdir()
    (tmp_path / "torn" / "metadata.yaml").write_text("rosbag2_bagfile_information:\n  version: 9\n")
    write_bag(tmp_path / "foreign", 0.0, spoil=lambda topic, message: message if topic == "/diagnostics" else None)
    for path, words in {
        "none": "bag 'none' does not exist",
        "empty": "bag 'empty' cannot be read: no metadata.yaml",
        "garbage.mcap": "bag 'garbage.mcap' cannot be read: ",
        "text.txt": "'text.txt' is no bag: ",
        "torn": "bag 'torn' cannot be read: ",
        "foreign": "the bag has no topic of a swimmer; its topics: /diagnostics",
    }.items():
        assert words in said_in_one_line(capsys, path, "-o", "run.rrd")
    assert "'/proc/none.rrd' cannot be written" in said_in_one_line(capsys, bag, "-o", "/proc/none.rrd")
    assert "blueprint must be one of overview" in said_in_one_line(capsys, bag, "--blueprint", "mine")
    assert "skin_rate must be >= 0.1 Hz" in said_in_one_line(capsys, bag, "--skin-rate", "0")
    assert "--spawn needs a display" in said_in_one_line(capsys, bag, "--spawn")


def test_two_bags_or_two_namespaces_are_laid_over_each_other(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_bag(tmp_path / "fine", 0.3)
    write_bag(tmp_path / "coarse", 0.3, 50.0, stations=11)
    assert main(["fine", "-o", "both.rrd", "--compare", "coarse", "--blueprint", "compare"]) == 0
    distance = read(tmp_path / "both.rrd", entities.DISTANCE)
    np.testing.assert_array_equal(distance.stamps, STAMPS[:31])
    at_other = distance["scalars"][::2, 0]  # where both have a sample
    np.testing.assert_allclose(at_other, 0.0, atol=1e-9)
    assert "| fine | coarse |" in read(tmp_path / "both.rrd", entities.COMPARE_TEXT)["text"][-1][0]
    (tmp_path / "deep").mkdir()
    (tmp_path / "coarse").rename(tmp_path / "deep" / "fine")
    assert main(["fine", "-o", "same.rrd", "--compare", "deep/fine"]) == 0
    assert "| fine | deep/fine |" in read(tmp_path / "same.rrd", entities.COMPARE_TEXT)["text"][-1][0]
    write_bag(tmp_path / "two", 0.1, namespaces=("/left", "/right"))
    assert main(["two", "--namespace", "/left", "--compare", "/right"]) == 0
    np.testing.assert_array_equal(read(tmp_path / "two.rrd", entities.DISTANCE).stamps, STAMPS[:11])
    write_bag(tmp_path / "three", 0.1, namespaces=("/left", ""))
    assert main(["three", "--namespace", "/left", "--compare", "/"]) == 0
    np.testing.assert_array_equal(read(tmp_path / "three.rrd", entities.DISTANCE).stamps, STAMPS[:11])
    assert "no swimmer in namespace '/none'" in said_in_one_line(
        capsys, "two", "--namespace", "/left", "--compare", "/none"
    )
    assert "blueprint compare" in said_in_one_line(capsys, "fine", "--blueprint", "compare")


def test_the_one_who_is_behind_in_time_comes_next():
    def message(nanoseconds):
        stamp = SimpleNamespace(sec=0, nanosec=nanoseconds)
        return SimpleNamespace(header=SimpleNamespace(stamp=stamp))

    first = [("body", "a"), ("energy", message(0)), ("energy", message(20)), ("body", "b"), ("energy", message(0))]
    second = [("energy", message(5)), ("energy", message(30)), ("odom", message(30))]
    order = [(which, topic) for which, topic, _ in merged_by_time([first, second])]
    assert order == [
        (0, "body"), (0, "energy"), (1, "energy"), (0, "energy"), (0, "body"), (0, "energy"), (1, "energy"), (1, "odom")
    ]  # fmt: skip
    assert list(merged_by_time([[], []])) == []
