# SPDX-License-Identifier: Apache-2.0
"""The bag that is whole at all times: after each `save`, after more of them, and after one that failed."""

import errno
import os
import random
import re
import struct

import lz4.frame
import pytest
import yaml
import zstandard
from eel_common.version import software
from eel_viz.bags.bag import Bag
from eel_viz.bags.bounds import MOST_CHUNK_BYTES, check_mcap, inflated
from eel_viz.bags.definitions import definition, message_class, type_hash
from eel_viz.bags.growing_bag import GrowingBag
from mcap.reader import make_reader
from rosbags.rosbag2 import Reader

JOINTS = "geometry_msgs/msg/Vector3"


def connect(bag, topic="/extra"):
    return bag.add_connection(topic, JOINTS, msgdef=definition(JOINTS), rihs01=type_hash(JOINTS))


def stamps(folder):
    """Of all messages, by rosbags and, file by file, by mcap's own reader."""
    with Reader(folder) as reader:
        found = [stamp for _, stamp, _ in reader.messages()]
        assert reader.message_count == len(found)
    with next(folder.glob("*.mcap")).open("rb") as file:
        other = make_reader(file, validate_crcs=True)
        assert [message.log_time for _, _, message in other.iter_messages()] == found
        assert other.get_summary().statistics.message_count == len(found)
    return found


def test_it_is_whole_after_every_save(tmp_path):
    bag, expected = GrowingBag(tmp_path / "bag"), []
    assert stamps(tmp_path / "bag") == []
    for turn in range(4):
        connection = connect(bag, f"/topic_{turn}")
        for k in range(50 * turn):
            expected.append(1000 * turn + k)
            bag.write(connection, expected[-1], bytes(30_000))  # more than a chunk of 1 MiB a turn
        bag.save()
        assert stamps(tmp_path / "bag") == expected
        bag.save()  # with nothing new
        assert stamps(tmp_path / "bag") == expected
    bag.close()
    assert stamps(tmp_path / "bag") == expected
    about = yaml.safe_load((tmp_path / "bag" / "metadata.yaml").read_text())["rosbag2_bagfile_information"]
    assert about["version"] == 9 and about["custom_data"] == {"software": software()}
    assert about["relative_file_paths"] == ["bag.mcap"]
    assert about["message_count"] == 300


def test_a_save_that_fails_leaves_the_bag_as_it_was(tmp_path, monkeypatch):
    bag = GrowingBag(tmp_path / "bag")
    connection = connect(bag)
    for k in range(20):
        bag.write(connection, k, bytes(1000))
    bag.save()
    before = (tmp_path / "bag" / "bag.mcap").read_bytes()
    for k in range(20, 40):
        bag.write(connection, k, bytes(1000))
    room, write = [7_000], os.pwrite

    def full(descriptor, data, place):
        if room[0] == 0:
            room[0] = -1
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        if room[0] < 0:
            return write(descriptor, data, place)
        done, room[0] = write(descriptor, data[: room[0]], place), 0
        return done

    monkeypatch.setattr(os, "pwrite", full)
    with pytest.raises(OSError, match="No space left on device"):
        bag.save()
    assert room == [-1]
    assert (tmp_path / "bag" / "bag.mcap").read_bytes() == before
    assert stamps(tmp_path / "bag") == list(range(20))


def test_where_it_cannot_be_is_said(tmp_path):
    (tmp_path / "there").mkdir()
    with pytest.raises(ValueError, match="exists already, not overwriting"):
        GrowingBag(tmp_path / "there")
    with pytest.raises(ValueError, match="bag '/proc/none/bag' cannot be made: No such file or directory"):
        GrowingBag("/proc/none/bag")


def contents(folder):
    """Of the whole bag as our reader has it: its messages, and the lines that tell of damage."""
    told = []
    with Bag(folder) as bag:
        messages = [repr(each) for each in bag.messages(*bag.topics, unreadable=lambda _, why: told.append(why))]
    return messages, told


@pytest.mark.fault(
    "names", "one flipped bit in a bag of `eel record`", "said in one line, with the place; or the content is the same"
)
@pytest.mark.parametrize("count", [60, pytest.param(600, marks=pytest.mark.soak)])
def test_no_flipped_bit_of_a_bag_is_silent(tmp_path, count):
    folder, chance = tmp_path / "bag", random.Random(5)
    bag = GrowingBag(folder)
    connections = [connect(bag, topic) for topic in ("/one", "/two")]
    for k in range(90):
        bag.write(connections[k % 2], 10**18 + k, bytes(4) + struct.pack("<3d", *(chance.random() for _ in range(3))))
        if k % 20 == 0:
            bag.save()
    bag.close()
    whole = contents(folder)
    assert len(whole[0]) == 90 and whole[1] == []
    counts = dict.fromkeys(("told", "same"), 0)
    for k in range(count):
        path = folder / ("metadata.yaml" if k % 4 == 0 else "bag.mcap")
        data = path.read_bytes()
        bit = chance.randrange(8 * len(data))
        path.write_bytes(data[: bit // 8] + bytes([data[bit // 8] ^ 1 << bit % 8]) + data[bit // 8 + 1 :])
        try:
            messages, told = contents(folder)
        except ValueError as error:
            messages, told = [], [str(error)]
        assert told or messages == whole[0], f"{path.name}, bit {bit}: other messages, silently"
        assert not any("\n" in line for line in told)
        counts["told" if told else "same"] += 1
        path.write_bytes(data)
    print(counts)
    assert counts["told"] > 0.75 * count  # a file of MCAP has no bit without a checksum


@pytest.mark.fault(
    "names",
    "a bag whose chunks inflate to 500 MB, or to more than they say",
    "one line, and nothing is inflated",
)
@pytest.mark.parametrize("compression", ["zstd", "lz4"])
@pytest.mark.parametrize("told", [500_000_000, 100])
def test_a_chunk_that_inflates_is_refused_before_it_does(tmp_path, compression, told):
    pack = {"zstd": zstandard.compress, "lz4": lz4.frame.compress}[compression]
    data = pack(bytes(100_000))
    chunk = struct.pack("<QQQI", 0, 1, told, 0) + struct.pack("<I", len(compression)) + compression.encode()
    chunk += struct.pack("<Q", len(data)) + data
    path = tmp_path / "bag.mcap"
    path.write_bytes(b"\x89MCAP0\r\n\x06" + struct.pack("<Q", len(chunk)) + chunk)
    with pytest.raises(ValueError, match="a chunk must have"):
        check_mcap(path)
    with pytest.raises(ValueError, match=r"no bag|cannot be read"):
        Bag(path)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("a: " + "[" * 20_000, "too many levels"),
        ("a: &a [1]\nb: &b [*a, *a]\nc: [" + "*b, " * 9000 + "]", "more than 20000 values"),
        ("[" + "1, " * 15_000 + "]", "its content must be a dict"),
    ],
)
def test_metadata_without_bounds_are_not_read(tmp_path, text, told):
    bag = GrowingBag(tmp_path / "bag")
    bag.write(connect(bag, "/one"), 10**18, bytes(28))
    bag.close()
    (tmp_path / "bag" / "metadata.yaml").write_text(text)
    with pytest.raises(ValueError, match=rf"bag .* cannot be read: .*metadata.yaml.*{told}"):
        Bag(tmp_path / "bag")


@pytest.mark.parametrize("name", ["bag", "bag.mcap", "folder/bag.mcap"])
def test_a_bag_that_is_a_fifo_is_refused(tmp_path, name):
    (tmp_path / "folder").mkdir()
    os.mkfifo(tmp_path / name)
    with pytest.raises(ValueError, match=r"no regular file|no metadata.yaml"):
        Bag(tmp_path / name.split("/")[0])


def test_a_folder_s_name_may_be_as_long_as_the_file_system_allows(tmp_path):
    folder = tmp_path / ("b" * 255)
    bag = GrowingBag(folder)
    bag.write(connect(bag, "/one"), 10**18, bytes(28))
    bag.close()
    assert len(contents(folder)[0]) == 1 and max(len(each.name) for each in folder.iterdir()) == 255


def test_the_place_of_damage_is_said(tmp_path):
    bag = GrowingBag(tmp_path / "bag")
    connection = connect(bag)
    for k in range(3):
        bag.write(connection, k, bytes(3000))
        bag.save()
    bag.close()
    path = tmp_path / "bag" / "bag.mcap"
    whole = path.read_bytes()
    second = whole.index(bytes(2000), whole.index(bytes(2000)) + 3000)
    for place in (whole.index(bytes(2000)), second, len(whole) - 60):
        path.write_bytes(whole[:place] + b"\1" + whole[place + 1 :])
        with pytest.raises(ValueError, match=r"bag\.mcap, from byte \d+ on: .*`mcap recover` repairs it") as told:
            Bag(tmp_path / "bag")
        assert abs(place - int(re.search(r"from byte (\d+)", str(told.value))[1])) < 1000


def test_a_type_that_names_no_interface_imports_nothing(tmp_path, monkeypatch):
    (tmp_path / "harmful").mkdir()
    (tmp_path / "harmful" / "__init__.py").write_text(f"open({str(tmp_path / 'ran')!r}, 'w').close()")
    (tmp_path / "harmful" / "msg.py").write_text("Thing = int")
    monkeypatch.syspath_prepend(tmp_path)
    for name in ("harmful/msg/Thing", "/msg/Thing", "os", "eel_msgs/msg/Missing"):
        with pytest.raises(ValueError, match=f"message type '{name}' is not installed here"):
            message_class(name)
    assert not (tmp_path / "ran").exists()
    assert message_class("eel_msgs/msg/Backbone").__name__ == "Backbone"


def test_a_message_that_inflates_is_refused_before_it_does():
    assert inflated(zstandard.compress(b"abc")) == b"abc"
    with pytest.raises(ValueError, match=f"at most {MOST_CHUNK_BYTES} bytes when inflated, got {2 * MOST_CHUNK_BYTES}"):
        inflated(zstandard.compress(bytes(2 * MOST_CHUNK_BYTES)))
