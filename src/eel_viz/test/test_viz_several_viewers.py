# SPDX-License-Identifier: Apache-2.0
"""A viewer of served data that does not read is disconnected: nobody else misses anything, now or later."""

import http.client
import subprocess
import time

import made_up
import numpy as np
import pytest
from eel_viz.recording import sinks
from eel_viz.recording.recordings import Recordings
from eel_viz.recording.rrd_frames import HEADER_SIZE, complete_file
from eel_viz.settings import Settings
from eel_viz.viewer import free_port, native_viewer
from made_up_recording import body, sample
from rerun.chunk import RrdReader

from eel_viz import entities

STEP = 10**7  # ns
LIMIT = 120.0  # s


@pytest.fixture
def look_on(tmp_path):
    """look_on(name, port) -> the file to which a viewer of that server writes what it is given."""
    viewers = []

    def begin(name, port):
        words = ["--port", str(free_port()), "--bind", "127.0.0.1", "--save", str(tmp_path / name)]
        command = [native_viewer(), *words, f"rerun+http://127.0.0.1:{port}/proxy"]
        viewers.append(subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))
        return tmp_path / name

    yield begin
    for viewer in viewers:
        viewer.kill()
        viewer.wait()


def begin_to_read(port) -> http.client.HTTPResponse:
    """What a browser asks the server for, of which only the beginning is read."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=LIMIT)
    kind = "application/grpc-web+proto"
    path = "/rerun.sdk_comms.v1alpha1.MessageProxyService/ReadMessages"
    connection.request("POST", path, body=bytes(5), headers={"content-type": kind, "accept": kind, "x-grpc-web": "1"})
    response = connection.getresponse()
    assert response.status == 200 and len(response.read(100_000)) == 100_000
    return response


def stamps_in(path) -> np.ndarray:
    """Those [ns] of the head's positions so far, in order, of all recordings that the file at `path` holds."""
    if not path.exists():
        return np.zeros(0, int)
    stamps = []
    with complete_file(path) as readable:
        if readable.stat().st_size <= HEADER_SIZE:
            return np.zeros(0, int)
        reader = RrdReader(str(readable))
        for store in reader.recordings():
            for chunk in reader.stream(store=store).filter(content=entities.POSITION):
                if not chunk.is_static:
                    stamps += chunk.to_record_batch().column(entities.TIMELINE).cast("int64").to_pylist()
    return np.sort(np.array(stamps, dtype=int))


@pytest.mark.filterwarnings("ignore:RRD file has no footer")  # it is still being written
@pytest.mark.fault(
    "subscribers",
    "one of several viewers of served data, a browser, stops reading",
    "it is disconnected once it has held up the server for 2 s, and said; those that look on, and those that come "
    "later, have everything, as the file",
)
def test_others_get_everything_while_one_does_not_read(look_on, tmp_path, monkeypatch):
    monkeypatch.setattr(sinks, "LIVE_TICK", 0.02)  # more messages, so that it is soon behind by as many as are kept
    port, said = free_port(), []
    settings = Settings(
        sink=("save", "serve"), recording=str(tmp_path / "run.rrd"), rate=1000.0, port=port, web_port=free_port()
    )
    made = Recordings(sinks.destinations(settings, said.append, said.append, live=True), "eel", said.append)
    made.log_lasting("body", body())
    swimmer, count, end = made_up.Swimmer(11), 0, time.monotonic() + LIMIT

    def swim(steps):
        nonlocal count
        for _ in range(steps):
            for topic, values in sample(swimmer, count * STEP).items():
                made.log_sample(topic, count * STEP, values)
            count += 1
            made.poll()
            time.sleep(0.001)

    def has_all(path):
        while time.monotonic() < end:
            swim(1)  # it must hear of it by what comes
            sent, seen = np.arange(count) * STEP, stamps_in(path)
            if len(seen) > 0.9 * count:
                return np.array_equal(seen, sent[: len(seen)])
            time.sleep(0.2)
        return False

    swim(20)
    present = look_on("present.rrd", port)
    while not len(stamps_in(present)):
        assert time.monotonic() < end, "it does not look on"
        swim(1)
    stuck = begin_to_read(port)
    while not any("does not keep up" in line for line in said):
        assert time.monotonic() < end, said
        swim(10)
    swim(50)
    assert has_all(present)
    assert has_all(look_on("later.rrd", port))
    made.close()
    stuck.close()
    assert sum("does not keep up" in line for line in said) == 1 and not any("misses" in line for line in said), said
    np.testing.assert_array_equal(stamps_in(tmp_path / "run.rrd"), np.arange(count) * STEP)
