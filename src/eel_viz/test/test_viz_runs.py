# SPDX-License-Identifier: Apache-2.0
"""Runs and where they go: files, ports, viewers that are absent, and stamps that go back."""

import datetime
import os
import socket
import subprocess
import sys
import time

import made_up
import numpy as np
import pytest
import rerun as rr
from eel_common.wording import shown
from eel_viz.messages import Status
from eel_viz.recording import recordings, sinks
from eel_viz.recording.destination import CHECK_PERIOD
from eel_viz.recording.reading import read
from eel_viz.recording.recording_file import REMINDER, FileDestination
from eel_viz.recording.recordings import Recordings
from eel_viz.recording.sinks import ServerDestination, ViewerDestination, destinations
from eel_viz.settings import Settings
from made_up_recording import body, sample

from eel_viz import entities

SECOND = 10**9
STAND_IN = """
import sys
import rerun as rr

sink = rr.GrpcServerSink(bind_ip="127.0.0.1", port=int(sys.argv[1]), server_memory_limit="10MB")
stream = rr.RecordingStream("stand_in")
stream.set_sinks(sink)
print("ready", flush=True)
sys.stdin.read()
"""


class Console:
    """What was said."""

    def __init__(self):
        self.said, self.warned = [], []


@pytest.fixture
def console():
    return Console()


@pytest.fixture
def file(tmp_path, console):
    return FileDestination(Settings(recording=str(tmp_path / "run.rrd")), console.said.append, console.warned.append)


def send(made, stamp, topics=None):
    for topic, arguments in sample(made_up.Swimmer(11), stamp).items():
        if topics is None or topic in topics:
            made.log_sample(topic, stamp, arguments)


@pytest.mark.fault(
    "time",
    "time that jumps back again and again, at the visualiser",
    "at most 10 recordings a minute, and said; the last of them takes what comes until the minute is over",
)
def test_recordings_are_few_however_often_time_jumps_back(console, tmp_path, monkeypatch):
    now = 1000.0
    monkeypatch.setattr(recordings, "time", type("Clock", (), {"monotonic": lambda: now}))
    file = FileDestination(Settings(recording=str(tmp_path / "run.rrd")), console.said.append, console.warned.append)
    made = Recordings([file], "eel", console.warned.append)
    cycles = 3 * recordings.MAXIMUM_RECORDINGS
    for cycle in range(cycles):
        for stamp in (0, SECOND, 2 * SECOND + cycle):
            send(made, stamp, {"head_pose"})
    assert len(list(tmp_path.iterdir())) == recordings.MAXIMUM_RECORDINGS
    assert sum("goes into the present one" in text for text in console.warned) == 1
    now += recordings.MINUTE + 1.0
    send(made, SECOND, {"head_pose"})
    made.close()
    last, following = (tmp_path / f"run-{recordings.MAXIMUM_RECORDINGS + more}.rrd" for more in (0, 1))
    shown = read(last, entities.POSITION).stamps.tolist()
    assert {2 * SECOND + cycle for cycle in range(recordings.MAXIMUM_RECORDINGS - 1, cycles)} <= set(
        shown
    )  # nothing is lost
    assert read(following, entities.POSITION).stamps.tolist() == [SECOND]


@pytest.mark.fault(
    "time",
    "time that jumps back, at the visualiser",
    "a new recording begins, with a number before its suffix; each is complete",
)
def test_a_stamp_that_goes_back_begins_a_new_recording(file, console, tmp_path):
    made = Recordings([file], "eel", console.warned.append)
    made.log_lasting("body", body())
    made.log_lasting("curvature_law", "falling")
    for stamp in (0, SECOND, 2 * SECOND, 0, SECOND):
        send(made, stamp)
    made.close()
    for name, stamps in (("run.rrd", [0, SECOND, 2 * SECOND]), ("run-2.rrd", [0, SECOND])):
        for entity in (entities.POSITION, entities.WRENCH_NUMBERS, entities.LOAD_NUMBERS, entities.POWER):
            np.testing.assert_array_equal(read(tmp_path / name, entity).stamps, stamps)
        assert read(tmp_path / name, entities.SKIN, static=True)["triangle_indices"].shape[1] > 100
        assert read(tmp_path / name, entities.LOG)["text"][0][0] == "law 'falling' published"
    assert [line for line in console.warned if "went back" in line] == [
        "stamps of head_pose went back from 2 s to 0 s: a new recording begins"
    ]


def test_topics_may_reach_a_reset_at_different_times(file, console, tmp_path):
    made = Recordings([file], "eel", console.warned.append)
    early, late = ("head_pose", "backbone"), ("internal_wrench", "energy")
    send(made, 0, late)
    for stamp in (0, SECOND, 0, SECOND):  # two runs
        send(made, stamp, early)
    for stamp in (SECOND, 2 * SECOND, 0):  # still the first, then the next
        send(made, stamp, late)
    made.close()
    np.testing.assert_array_equal(read(tmp_path / "run.rrd", entities.WRENCH_NUMBERS).stamps, [0, SECOND, 2 * SECOND])
    np.testing.assert_array_equal(read(tmp_path / "run-2.rrd", entities.WRENCH_NUMBERS).stamps, [0])
    np.testing.assert_array_equal(read(tmp_path / "run-2.rrd", entities.POSITION).stamps, [0, SECOND])
    assert not (tmp_path / "run-3.rrd").exists()


@pytest.mark.fault(
    "neighbours", "two simulations on the same topics", "one warning; the visualiser leaves the older stamps out"
)
def test_two_publishers_do_not_begin_a_recording_with_every_message(file, console, tmp_path):
    made = Recordings([file], "eel", console.warned.append, has_several_publishers=lambda topic: True)
    for k in range(50):
        send(made, 100 * SECOND + k, ("head_pose",))
        send(made, k, ("head_pose",))
    made.close()
    assert len(list(tmp_path.iterdir())) <= recordings.RESETS + 1
    assert sum("more than one publisher" in line for line in console.warned) == 1


def test_resets_in_quick_succession_are_taken(file, console, tmp_path):
    made = Recordings([file], "eel", console.warned.append)
    for _ in range(6):
        for stamp in (0, SECOND):
            send(made, stamp, ("head_pose",))
    made.close()
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "run-2.rrd",
        "run-3.rrd",
        "run-4.rrd",
        "run-5.rrd",
        "run-6.rrd",
        "run.rrd",
    ]


def test_diagnostics_at_their_own_time_or_at_the_newest_if_that_is_wall_time(file, console, tmp_path):
    made = Recordings([file], "eel", console.warned.append)
    for stamp in (0, 3 * SECOND):
        send(made, stamp, ("head_pose",))
    for stamp, state in ((2 * SECOND, "swimming"), (1_795_234_285 * SECOND, "elsewhere")):
        made.log_lasting("diagnostics", [Status(name="/dynamics", level=1, message=state, values={})], stamp=stamp)
    made.close()
    log = read(tmp_path / "run.rrd", entities.LOG)
    assert log.stamps.tolist() == [2 * SECOND, 3 * SECOND]
    assert [row[0] for row in log["text"]] == ["/dynamics: swimming", "/dynamics: elsewhere"]
    assert {row[0] for row in log["level"]} == {"WARN"}


def test_a_late_start_shows_the_present(file, console, tmp_path):
    made = Recordings([file], "eel", console.warned.append)
    for stamp in (500 * SECOND, 501 * SECOND):
        send(made, stamp)
    made.close()
    assert not console.warned
    np.testing.assert_array_equal(read(tmp_path / "run.rrd", entities.SPEED).time, [500.0, 501.0])


@pytest.mark.fault(
    "names", "a `recording` that is there already", "said at the start; replaced once the new one is complete"
)
def test_a_file_that_is_there_is_replaced_when_the_new_one_is_complete(console, tmp_path):
    (tmp_path / "run.rrd").write_bytes(b"RRF2 of yesterday")
    settings = Settings(recording=str(tmp_path / "run.rrd"))
    file = FileDestination(settings, console.said.append, console.warned.append)
    made = Recordings([file], "eel", console.warned.append)
    assert console.warned == [
        f"{tmp_path / 'run.rrd'} is there already and is replaced by the new recording when that is complete"
    ]
    assert console.said == [f"saving to {tmp_path / 'run.rrd'}; until it is complete, to run.part.rrd"]
    send(made, SECOND)
    assert (tmp_path / "run.rrd").read_bytes() == b"RRF2 of yesterday"
    made.close()
    assert read(tmp_path / "run.rrd", entities.SPEED).stamps.tolist() == [SECOND]
    assert os.listdir(tmp_path) == ["run.rrd"] and not made.incomplete


@pytest.mark.fault("ending", "a signal before anything has come, where an older recording has the name", "it stays")
def test_an_older_file_stays_where_nothing_comes(console, tmp_path):
    path = tmp_path / "run.rrd"
    path.write_bytes(b"RRF2 as it was")
    file = FileDestination(Settings(recording=str(path)), console.said.append, console.warned.append)
    Recordings([file], "eel", console.warned.append).close()
    assert os.listdir(tmp_path) == ["run.rrd"] and path.read_bytes() == b"RRF2 as it was"
    assert console.said[-1] == f"nothing has come: {path} stays as it was"


@pytest.mark.fault(
    "names",
    "two visualisers with one `recording`",
    "both keep what they recorded, resets too: the second gets a number, and one warning says so",
)
def test_two_recordings_of_one_name_are_both_kept(console, tmp_path):
    settings = Settings(recording=str(tmp_path / "same.rrd"))
    files = [FileDestination(settings, console.said.append, console.warned.append) for _ in range(2)]
    made = [Recordings([file], "eel", console.warned.append) for file in files]
    for k, each in enumerate(made):
        send(each, (10 + k) * SECOND)
        if k == 0:
            send(each, 5 * SECOND)  # a reset: another file
        each.close()
    starts = {name: read(tmp_path / name, entities.SPEED).stamps.tolist() for name in os.listdir(tmp_path)}
    assert starts == {"same.rrd": [10 * SECOND], "same-2.rrd": [5 * SECOND], "same-3.rrd": [11 * SECOND]}
    (line,) = [line for line in console.warned if "has appeared since the start, and stays" in line]
    assert line.endswith("same-3.rrd'")


@pytest.mark.fault(
    "ending",
    "the disk is full when the visualiser completes a recording",
    "one warning with the reason; what there is opens as `run.part.rrd`, an older `run.rrd` stays; status 1",
)
def test_a_recording_that_cannot_be_completed_stays_a_part(console, tmp_path, limit_of_files):
    (tmp_path / "run.rrd").write_bytes(b"RRF2 of yesterday")
    file = FileDestination(
        Settings(recording=str(tmp_path / "run.rrd")), console.said.append, console.warned.append, retry_from=2
    )
    delivery, part = file.open(1, "eel"), tmp_path / "run.part.rrd"
    stream = delivery.stream
    for k in range(3):
        stream.set_time(entities.TIMELINE, duration=float(k))
        stream.log(entities.SPEED, rr.Scalars([1.0]))
    stream.flush()
    with limit_of_files(part.stat().st_size + 100):  # the index does not fit any more
        delivery.close()
    assert file.incomplete and (tmp_path / "run.rrd").read_bytes() == b"RRF2 of yesterday"
    (told,) = (line for line in console.warned if "cannot be written any more" in line)
    assert f"recording {shown(str(part))} cannot be written any more: File too large; it ends here" in told
    assert read(part, entities.SPEED).stamps.tolist() == [0, SECOND, 2 * SECOND]


def test_a_folder_that_is_not_there_is_not_made(tmp_path, console):
    path = tmp_path / "mistyped" / "run.rrd"
    with pytest.raises(ValueError, match=r"run\.rrd' cannot be written: there is no folder '.*/mistyped'"):
        Recordings(
            [FileDestination(Settings(recording=str(path)), console.said.append, console.warned.append)], "eel", print
        )
    assert not os.listdir(tmp_path)


@pytest.mark.fault("names", "a `recording` that does not end in .rrd", "refused at the start: one line, status 2")
def test_a_recording_of_another_kind_is_refused():
    with pytest.raises(ValueError, match=r"recording must end in \.rrd, got 'notes\.txt'"):
        Settings(recording="notes.txt")


@pytest.mark.parametrize("path", ["/proc/none.rrd", "/dev/null/run.rrd", "{folder}/taken.rrd"])
def test_a_path_that_cannot_be_written(path, tmp_path, console):
    (tmp_path / "taken.rrd").mkdir()
    path = path.format(folder=tmp_path)
    file = FileDestination(Settings(recording=path), console.said.append, console.warned.append)
    with pytest.raises(ValueError, match=r"recording .* cannot be written"):
        Recordings([file], "eel", print)


@pytest.mark.fault(
    "parameters",
    "a `recording` that cannot be written, beside other sinks or from a later run on",
    "said at once and every 30 s: nothing is written elsewhere, the others go on, it is tried again; then status 1",
)
def test_a_file_that_cannot_be_written_is_said_again_and_again_and_tried_again(tmp_path, console, monkeypatch):
    path, place = tmp_path / "taken" / "run.rrd", tmp_path / "taken"
    place.write_text("where the folder should be")
    file = FileDestination(Settings(recording=str(path)), console.said.append, console.warned.append, retry_from=1)
    made = Recordings([file], "eel", console.warned.append)
    made.log_lasting("body", body())
    monkeypatch.setattr(recordings, "RETRY", 0.0)
    now = time.monotonic()
    for later in (0.0, 0.4 * REMINDER, 0.8 * REMINDER, 1.2 * REMINDER):
        monkeypatch.setattr(time, "monotonic", lambda later=later: now + later)
        send(made, round(later) * SECOND)
        made.poll()
    told = f"recording {shown(str(path))} cannot be written: there is no folder {shown(str(place))}: "
    told += "nothing of this run is saved; "
    assert console.warned == [told + "it is tried again while running"] * 2
    assert list(tmp_path.iterdir()) == [place]
    place.unlink()
    place.mkdir()
    monkeypatch.setattr(time, "monotonic", lambda: now + 2 * REMINDER)
    made.poll()
    send(made, 99 * SECOND)
    made.close()
    assert made.incomplete and len(console.warned) == 2
    np.testing.assert_array_equal(read(path, entities.SPEED).stamps, [99 * SECOND])
    assert read(path, entities.BODY_NUMBERS, static=True)["mass"].size == 1


def test_a_later_run_that_cannot_be_written_is_not_the_end(tmp_path, console):
    (tmp_path / "run-2.rrd").mkdir()
    file = FileDestination(
        Settings(recording=str(tmp_path / "run.rrd")), console.said.append, console.warned.append, retry_from=2
    )
    made = Recordings([file], "eel", console.warned.append)
    for stamp in (0, SECOND, 0, SECOND):
        send(made, stamp)
    made.close()
    assert (
        made.incomplete and sum("run-2.rrd' cannot be written: it is a folder" in line for line in console.warned) == 1
    )
    assert len(read(tmp_path / "run.rrd", entities.SPEED).stamps) == 2


@pytest.mark.parametrize(("sink", "allowed"), [(("save",), False), (("save", "serve"), True)])
def test_the_only_sink_must_be_writable_at_the_start(sink, allowed, tmp_path, console):
    (tmp_path / "taken.rrd").mkdir()
    settings = Settings(sink=sink, recording=str(tmp_path / "taken.rrd"))
    made = destinations(settings, console.said.append, console.warned.append, live=True)
    if allowed:
        Recordings(made, "eel", console.warned.append).close()
        assert sum("recording" in line for line in console.warned) == 1
    else:
        with pytest.raises(ValueError, match=r"recording .* cannot be written: it is a folder"):
            Recordings(made, "eel", console.warned.append)


@pytest.mark.fault(
    "nodes",
    "a dynamics node killed and started again, found by the visualiser when its time has passed the first one's",
    "another publisher: a new recording begins",
)
def test_a_successor_begins_a_new_recording_whatever_its_stamps(file, console, tmp_path):
    made = Recordings([file], "eel", console.warned.append)
    made.log_lasting("body", body())
    send(made, SECOND)
    for stamp in (2 * SECOND, 3 * SECOND):
        for topic, arguments in sample(made_up.Swimmer(11), stamp).items():
            made.log_sample(topic, stamp, arguments, new_publisher=stamp == 2 * SECOND)
    made.close()
    np.testing.assert_array_equal(read(tmp_path / "run.rrd", entities.POSITION).stamps, [SECOND])
    for entity in (entities.POSITION, entities.WRENCH_NUMBERS, entities.POWER):
        np.testing.assert_array_equal(read(tmp_path / "run-2.rrd", entity).stamps, [2 * SECOND, 3 * SECOND])
    assert read(tmp_path / "run-2.rrd", entities.BODY_NUMBERS, static=True)["mass"].size == 1
    begun = [line for line in console.warned if "a new recording begins" in line]
    assert begun == ["another node publishes head_pose from 2 s on: a new recording begins"]


def test_first_messages_that_come_after_the_others_reset_are_of_the_run_in_which_they_were_sent(
    file, console, tmp_path, monkeypatch
):
    """The network may repeat a topic's first messages so late that all others have passed a whole run; meanwhile the
    process may stand still for ten seconds."""
    now = 1000.0
    monkeypatch.setattr(recordings.time, "monotonic", lambda: now)
    made, swimmer = Recordings([file], "eel", console.warned.append), made_up.Swimmer(11)

    def log(run, samples, late):
        for k in samples:
            for topic, arguments in sample(swimmer, k * SECOND).items():
                if (topic == "curvature") is late:
                    sent = 10**18 + run * SECOND + k * 10**6
                    made.log_sample(topic, k * SECOND, arguments, sent=sent)
        made.poll()

    log(0, range(3), late=False)
    log(1, range(2), late=False)
    now += 10.0
    made.poll()
    log(0, range(2), late=True)
    for _ in range(2 * recordings.LATE):  # now that the topic is known, its run stays open however late it is
        made.poll()
    log(0, range(2, 3), late=True)
    log(1, range(3), late=True)
    log(1, range(2, 3), late=False)
    made.close()
    assert not (tmp_path / "run-3.rrd").exists()
    for name in ("run.rrd", "run-2.rrd"):
        for entity in (entities.POSITION, entities.CURVATURE_NUMBERS):
            np.testing.assert_array_equal(read(tmp_path / name, entity).stamps, [0, SECOND, 2 * SECOND])


def test_succession_is_told_by_counts_pauses_and_who_is_there():
    from eel_viz.ros.polled_subscriptions import PublisherChange

    there, looks = {"one"}, []

    def publishers():
        looks.append(1)
        return set(there)

    topic = PublisherChange(publishers)
    at = iter(range(0, 10**12, 10**7))  # ns
    assert not any(topic.changes(count, next(at)) for count in range(1, 50))
    assert len(looks) == 1  # it costs nothing while all goes on
    assert not topic.changes(60, next(at)) and len(looks) == 2  # ten were lost
    there.add("two")
    assert not topic.changes(61, next(at))  # still the first
    assert topic.changes(500, next(at)) and not topic.changes(501, next(at))
    there.remove("one")
    assert not topic.changes(600, next(at))
    there.add("three")
    assert topic.changes(601, next(at) + 2 * 10**9)  # the count goes on by chance, after a while
    there.add("four")
    topic.note_publishers()
    there.remove("four")
    assert topic.changes(1, 4 * 10**9)  # shown when its publisher has gone
    assert not topic.changes(None, 4 * 10**9)


def test_without_a_name_the_file_is_called_after_the_time(tmp_path, console, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Recordings([FileDestination(Settings(), console.said.append, console.warned.append)], "eel", print).close()
    (made,) = os.listdir(tmp_path)
    assert made.startswith("eel-20")
    assert made.endswith(".rrd")
    assert not console.warned  # the file's place was taken by itself


def test_two_processes_that_begin_in_the_same_second_write_two_files(console, monkeypatch):
    class Clock(datetime.datetime):
        @classmethod
        def now(cls):
            return cls(2026, 1, 2, 3, 4, 5)

    monkeypatch.setattr("eel_viz.recording.recording_file.datetime.datetime", Clock)
    monkeypatch.setattr("eel_viz.recording.recording_file.os.getpid", iter((17, 18)).__next__)
    files = [FileDestination(Settings(), console.said.append, console.warned.append).path(1) for _ in range(2)]
    assert [str(path) for path in files] == ["eel-20260102-030405-17.rrd", "eel-20260102-030405-18.rrd"]


@pytest.fixture
def taken():
    """A port in use."""
    with socket.socket() as holder:
        holder.bind(("127.0.0.1", 0))
        holder.listen()
        yield holder.getsockname()[1]


@pytest.mark.fault("neighbours", "the visualiser's port in use", "another one is taken, and said")
def test_a_port_in_use_is_said_and_another_one_taken(taken, console):
    served = ServerDestination(Settings(port=taken), console.said.append, console.warned.append)
    served.close()
    assert len(console.warned) == 1
    assert f"port {taken} is in use, taking " in console.warned[0]
    assert str(taken) not in served.uri


@pytest.mark.fault(
    "subscribers", "no viewer at the address to connect to", "said once, tried again; the file is complete"
)
def test_a_viewer_that_is_absent_is_said_once_and_found_later(console, tmp_path, monkeypatch):
    from eel_viz.viewer import free_port

    port = free_port()
    settings = Settings(viewer=f"rerun+http://127.0.0.1:{port}/proxy", recording=str(tmp_path / "run.rrd"))
    say, warn = console.said.append, console.warned.append
    file, viewer = FileDestination(settings, say, warn), ViewerDestination(settings, say, warn)
    made = Recordings([file, viewer], "eel", warn)
    monkeypatch.setattr(recordings, "RETRY", 0.0)
    monkeypatch.setattr(sinks, "ANSWER_LIMIT", 60.0)  # a busy machine takes its time
    for k in range(3):
        send(made, k * SECOND)
        made.poll()
    assert len(console.warned) == 1
    assert "no viewer listens at" in console.warned[0]
    host = ServerDestination(
        Settings(port=port), console.said.append, console.warned.append
    )  # stands in for the viewer
    made.poll()
    send(made, 3 * SECOND)
    made.close()
    host.close()
    assert f"connected to the viewer at {settings.viewer}" in console.said
    assert len(read(tmp_path / "run.rrd", entities.SPEED).stamps) == 4


@pytest.mark.fault("subscribers", "a viewer that is closed and opened again", "said once; it gets the present again")
def test_a_viewer_that_is_closed_and_opened_again(console, tmp_path, monkeypatch):
    from eel_viz.viewer import free_port, listening

    port = free_port()
    settings = Settings(viewer=f"rerun+http://127.0.0.1:{port}/proxy", recording=str(tmp_path / "run.rrd"))
    say, warn = console.said.append, console.warned.append
    monkeypatch.setattr(recordings, "RETRY", 0.0)
    monkeypatch.setattr(sinks, "ANSWER_LIMIT", 60.0)  # a busy machine takes its time

    def open_viewer():
        return subprocess.Popen(
            [sys.executable, "-c", STAND_IN, str(port)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )

    def come():
        viewer = open_viewer()
        assert viewer.stdout.readline() == "ready\n"
        return viewer

    viewer = come()
    made = Recordings([FileDestination(settings, say, warn), ViewerDestination(settings, say, warn)], "eel", warn)
    try:
        send(made, 0)
        made.poll()
        viewer.kill()
        viewer.wait()
        assert not listening(port)
        for k in range(1, 4):
            send(made, k * SECOND)
            made.poll()
        viewer = come()
        made.poll()
        send(made, 4 * SECOND)
        made.close()
    finally:
        viewer.kill()
        viewer.wait()
    assert [line for line in console.warned if "viewer" in line] == [
        f"the viewer at {settings.viewer} has gone: it is tried again while running"
    ]
    assert console.said.count(f"connected to the viewer at {settings.viewer}") == 2
    np.testing.assert_array_equal(read(tmp_path / "run.rrd", entities.SPEED).time, range(5))


def test_a_viewer_s_address_that_is_none():
    with pytest.raises(ValueError, match="viewer must look like"):
        ViewerDestination(Settings(viewer="somewhere"), print, print)


def test_auto_saves_without_a_display_and_opens_a_window_with_one(monkeypatch, tmp_path, console):
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    (chosen,) = destinations(Settings(), console.said.append, console.warned.append)
    assert isinstance(chosen, FileDestination)
    monkeypatch.setenv("DISPLAY", ":99")
    opened = []
    monkeypatch.setattr(ServerDestination, "show_in_window", lambda self: opened.append(self.uri))
    (chosen,) = destinations(Settings(), console.said.append, console.warned.append)
    chosen.close()
    assert opened == [chosen.uri]


def test_spawn_without_a_display_warns_and_serves(monkeypatch, console):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    (chosen,) = destinations(Settings(sink=("spawn",)), console.said.append, console.warned.append)
    chosen.close()
    assert "there is no display: no viewer is opened" in console.warned


def test_a_torn_file_is_read_up_to_its_last_whole_message(file, console, tmp_path):
    from eel_viz.recording.rrd_frames import cut_to_whole_messages, end_of_whole_messages

    made = Recordings([file], "eel", console.warned.append)
    send(made, 0)
    made.poll()
    time.sleep(CHECK_PERIOD)
    made.poll()  # what there is goes to the file
    send(made, SECOND)
    made.close()
    path, torn = tmp_path / "run.rrd", tmp_path / "torn.rrd"
    complete = path.read_bytes()
    assert end_of_whole_messages(path) == len(complete)
    for missing in (20, 50, len(complete) // 3):
        torn.write_bytes(complete[:-missing])
        stamps = read(torn, entities.POSITION).stamps.tolist()
        assert stamps in ([0], [0, SECOND]), missing
        assert torn.stat().st_size == len(complete) - missing  # reading changes nothing
    size = cut_to_whole_messages(torn)
    assert size == torn.stat().st_size < len(complete) - missing
    assert end_of_whole_messages(torn) == size


def test_a_file_is_read_while_it_grows(file, console, tmp_path):
    from eel_viz.recording.rrd_frames import complete_file, end_of_whole_messages
    from rerun.chunk import RrdReader

    made = Recordings([file], "eel", console.warned.append)
    send(made, 0)
    made.close()
    complete, growing = (tmp_path / "run.rrd").read_bytes(), tmp_path / "growing.rrd"
    growing.write_bytes(complete[:-50])
    end = end_of_whole_messages(growing)
    growing.write_bytes(complete[:end])
    with complete_file(growing) as readable:
        growing.write_bytes(complete[: end + 20])  # the next message, begun after the look at the file's end
        assert list(RrdReader(str(readable)).stream())
    with complete_file(tmp_path / "run.rrd") as readable:
        assert readable == tmp_path / "run.rrd", "what was completed is not copied"
