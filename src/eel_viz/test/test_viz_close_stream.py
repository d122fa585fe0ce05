# SPDX-License-Identifier: Apache-2.0
"""A stream whose file can no longer be written is closed within a time limit, and does not keep the process alive."""

import threading
import time

import rerun as rr
from eel_viz.recording import destination


class StuckStream:
    """As a Rerun stream whose file thread has ended: `disconnect` never returns."""

    def __init__(self):
        self.asked = threading.Event()

    def flush(self, timeout_sec):
        raise RuntimeError("timed out")

    def disconnect(self):
        self.asked.set()
        threading.Event().wait()


def test_a_stream_that_cannot_be_closed_is_abandoned(monkeypatch):
    unregistered = []
    monkeypatch.setattr(destination, "CLOSE_TIMEOUT", 0.2)
    monkeypatch.setattr(rr, "unregister_shutdown", lambda: unregistered.append(True))
    stream, start = StuckStream(), time.monotonic()
    destination.close_stream(stream)
    assert stream.asked.is_set() and unregistered == [True]
    assert time.monotonic() - start < 60.0


def test_a_stream_that_closes_leaves_the_shutdown_of_rerun_alone(monkeypatch, tmp_path):
    unregistered = []
    monkeypatch.setattr(rr, "unregister_shutdown", lambda: unregistered.append(True))
    stream = rr.RecordingStream("closed")
    stream.save(tmp_path / "closed.rrd")
    stream.log("/note", rr.TextLog("here"), static=True)
    destination.close_stream(stream)
    assert not unregistered
    assert (tmp_path / "closed.rrd").stat().st_size > 0
