# SPDX-License-Identifier: Apache-2.0
"""What is left of a recording when the disk is full, the process is killed, or a viewer stops reading."""

import math
import os
import signal
import sys
import time

import numpy as np
import pytest
from eel_common.topics import SAMPLED, WHERE_ASKED_FOR
from eel_viz.recording.reading import read
from eel_viz.viewer import free_port
from rosbags.highlevel import AnyReader
from soak import Clock
from swim_client import LIMIT

from eel_viz import entities


@pytest.mark.fault(
    "ending",
    "SIGINT of `eel record` as soon as a run as fast as possible has ended",
    "the bag has every sample; status 0",
)
@pytest.mark.parametrize("times", [1, pytest.param(10, marks=pytest.mark.soak)])
def test_a_recorder_that_is_ended_with_the_run_has_every_sample(start, fresh_domain, tmp_path, times):
    duration, count = 10, 1001
    start("gait_generator")
    for turn in range(times):
        recorder = start("record", "-o", str(tmp_path / f"bag{turn}"))
        recorder.wait_for_output("recording to")
        settings = (
            "real_time_factor:=0",
            f"duration:={duration}",
            "wait_for_subscribers:=1",
            "stations:=201",
            "estimate_error:=false",
        )
        dynamics = start("dynamics", "--ros-args", *[word for setting in settings for word in ("-p", setting)])
        assert dynamics.wait(LIMIT) == 0 and "stuck" not in dynamics.output(), dynamics.output()
        assert recorder.interrupt() == 0, recorder.output()
        assert "unequal" not in recorder.output(), recorder.output()
        with AnyReader([tmp_path / f"bag{turn}"]) as bag:
            counts = {topic: about.msgcount for topic, about in bag.topics.items()}
        for topic in set(SAMPLED) - set(WHERE_ASKED_FOR):
            assert counts[f"/{topic}"] == count, (turn, counts, recorder.output())


def visualise(start, *settings, limit_of_files=None):
    """The visualiser, each of whose files may take `limit_of_files` [kB] at most."""
    arguments = ["visualiser", "--ros-args", *[word for setting in settings for word in ("-p", setting)]]
    if limit_of_files:
        return start("bash", "-c", f'ulimit -f {limit_of_files}; exec "$@"', "-", *arguments)
    return start(*arguments)


def swim(start, *settings):
    start("gait_generator")
    settings = (*settings, "estimate_error:=false")
    return start("dynamics", "--ros-args", *[word for setting in settings for word in ("-p", setting)])


@pytest.mark.fault(
    "ending",
    "the disk is full while the visualiser records",
    "one warning with the reason; `run.part.rrd` is cut to what is whole and opens; an older `run.rrd` stays; the run "
    "goes on; status 1 at the end",
)
def test_a_disk_that_is_full(start, fresh_domain, tmp_path):
    """A limit on the size of files stands in for it: the operating system refuses to write in the same way."""
    (tmp_path / "run.rrd").write_bytes(b"RRF2 of yesterday")
    node = visualise(start, "sink:=[save]", f"recording:={tmp_path / 'run.rrd'}", limit_of_files=2000)
    node.wait_for_output("saving to")
    dynamics = swim(start, "real_time_factor:=0", "duration:=8", "wait_for_subscribers:=1")
    node.wait_for_output("cannot be written any more: File too large; it ends here", LIMIT)
    assert dynamics.wait(LIMIT) == 0 and "stuck" not in dynamics.output(), dynamics.output()
    assert node.interrupt() == 1 and "Traceback" not in node.output(), node.output()
    assert node.output().count("cannot be written") == 1
    assert (tmp_path / "run.rrd").read_bytes() == b"RRF2 of yesterday"
    stamps = read(tmp_path / "run.part.rrd", entities.POSITION).stamps
    assert len(stamps) > 20 and np.array_equal(stamps, 10_000_000 * np.arange(len(stamps)))


@pytest.mark.fault(
    "ending",
    "SIGKILL while the visualiser and `eel record` record",
    "what was recorded up to about a second before opens, the recording as `run.part.rrd`; the run goes on",
)
@pytest.mark.soak
def test_what_is_killed_leaves_what_it_had(start_to_kill, fresh_domain, tmp_path):
    start = start_to_kill
    node = visualise(start, "sink:=[save]", f"recording:={tmp_path / 'run.rrd'}")
    recorder = start("record", "-o", str(tmp_path / "bag"))
    node.wait_for_output("saving to")
    recorder.wait_for_output("recording to")
    dynamics = swim(start, "real_time_factor:=1", "wait_for_subscribers:=2")
    dynamics.wait_for_output("adopted")
    clock = Clock()

    def newest_in_the_bag():
        with AnyReader([tmp_path / "bag"]) as bag:
            wanted = [connection for connection in bag.connections if connection.topic == "/internal_wrench"]
            connection, _, raw = list(bag.messages(wanted))[-1]
            stamp = bag.deserialize(raw, connection.msgtype).header.stamp
        return stamp.sec + 1e-9 * stamp.nanosec

    def newest_in_the_recording():
        return read(tmp_path / "run.part.rrd", entities.POSITION).time[-1]

    def seen(newest):
        try:
            return newest()
        except Exception:  # there is nothing yet, or it has changed while it was read: then rosbags finds anything
            return -math.inf

    while clock.time < 2.0:
        clock.receive(0.5)
    passed = clock.time
    while clock.time < passed + 1.0:
        clock.receive(0.5)
    for newest in (newest_in_the_bag, newest_in_the_recording):  # a machine that is busy may need some looks
        deadline = time.monotonic() + LIMIT
        while seen(newest) < passed:
            assert time.monotonic() < deadline, (passed, seen(newest))
            clock.receive(1.0)
    for each in (node, recorder):
        each.process.kill()
        each.process.wait()
    clock.close()
    assert newest_in_the_bag() >= passed and newest_in_the_recording() >= passed
    assert dynamics.status is None


STAND_IN = """
import sys, time
import rerun as rr
host = rr.RecordingStream("viewer", send_properties=False)
host.set_sinks(rr.GrpcServerSink(bind_ip="127.0.0.1", port=int(sys.argv[1]), server_memory_limit="16MiB"))
print("listening", flush=True)
time.sleep(1000)
"""


@pytest.mark.fault(
    "subscribers",
    "a viewer that has stopped reading",
    "said after 2 s; it misses data, nobody waits, the file is complete, a signal ends the visualiser as ever; "
    "the viewer gets data again once it reads",
)
@pytest.mark.fault("nodes", "a viewer that is killed and started again", "said; the visualiser finds the new one")
@pytest.mark.soak
def test_a_viewer_that_stops_reading_or_is_killed(start, fresh_domain, tmp_path):
    """A server in the viewer's place, which takes what a viewer would, without drawing it."""
    port = free_port()
    stand_in = start(sys.executable, "-c", STAND_IN, str(port))
    stand_in.wait_for_output("listening")
    address = f"viewer:=rerun+http://127.0.0.1:{port}/proxy"
    node = visualise(start, "sink:=[connect, save]", f"recording:={tmp_path / 'run.rrd'}", address, "rate:=1000")
    brief = visualise(start, "sink:=[connect]", address, "rate:=1000")
    for each in (node, brief):
        each.wait_for_output("connected to the viewer")
    os.kill(stand_in.process.pid, signal.SIGSTOP)
    late = visualise(start, "sink:=[connect]", address)
    late.wait_for_output("does not answer: it is tried again while running")
    assert late.interrupt() == 0 and "Traceback" not in late.output(), late.output()
    dynamics = swim(start, "real_time_factor:=0", "duration:=10", "wait_for_subscribers:=2")
    for each in (node, brief):
        each.wait_for_output("the viewer has not read for 2 s", LIMIT)
    assert brief.interrupt() == 0, brief.output()
    assert dynamics.wait(LIMIT) == 0 and "stuck" not in dynamics.output(), dynamics.output()
    os.kill(stand_in.process.pid, signal.SIGCONT)
    node.wait_for_output("the viewer reads again")
    stand_in.process.kill()
    node.wait_for_output("has gone: it is tried again while running")
    start(sys.executable, "-c", STAND_IN, str(port)).wait_for_output("listening")
    deadline = time.monotonic() + LIMIT
    while node.output().count("connected to the viewer") < 2:
        assert time.monotonic() < deadline, node.output()
        time.sleep(0.05)
    assert node.interrupt() == 0 and "Traceback" not in node.output() + brief.output(), node.output()
    stamps = read(tmp_path / "run.rrd", entities.LOAD_NUMBERS).stamps
    assert len(stamps) > 100  # what it had read by then
    np.testing.assert_array_equal(stamps, 10_000_000 * np.arange(len(stamps)))
