# SPDX-License-Identifier: Apache-2.0
"""Output files are complete under their name, or not there; nothing else is replaced."""

import errno
import os
import signal
import socket
import subprocess
import sys
import threading
import time

import pytest
from eel_common.files import output_file
from eel_common.files.output_file import (
    Draft,
    NotWritten,
    check_output,
    command_begins,
    replacing,
    written_as,
)
from eel_common.wording import shown

OLD = b"PK\x03\x04 of yesterday"


def test_a_file_has_its_name_only_once_it_is_complete(tmp_path):
    name = tmp_path / "run.npz"
    name.write_bytes(OLD)
    with replacing(name) as path:
        path.write_bytes(b"PK half")
        assert path == tmp_path / "run.part.npz" and name.read_bytes() == OLD
        path.write_bytes(b"PK whole")
    assert name.read_bytes() == b"PK whole" and os.listdir(tmp_path) == ["run.npz"]
    assert name.stat().st_mode & 0o777 == 0o666 & ~_umask()


@pytest.mark.parametrize("name", ["n" * 251 + ".npz", "\u00fc" * 125 + ".npz"])
def test_a_name_may_be_as_long_as_the_file_system_allows(tmp_path, name):
    check_output("--out", tmp_path / name)
    with command_begins():
        for expected in (1, 1, 2):
            with replacing(tmp_path / name) as path:
                path.write_bytes(b"PK")
                assert len(os.fsencode(path.name)) <= 255
                if expected == 2:
                    (tmp_path / name).write_bytes(OLD)
            assert len(os.listdir(tmp_path)) == expected
    assert name in os.listdir(tmp_path)


def test_an_error_leaves_the_older_file_and_nothing_else(tmp_path, limit_of_files):
    name = tmp_path / "run.npz"
    name.write_bytes(OLD)
    refused = pytest.raises(NotWritten, match=r"'.*/run\.npz' cannot be written: File too large")
    with limit_of_files(1000), refused, replacing(name) as path:
        path.write_bytes(bytes(2000))
    with pytest.raises(ZeroDivisionError), replacing(name) as path:
        path.write_bytes(b"PK half")
        raise ZeroDivisionError
    assert name.read_bytes() == OLD and os.listdir(tmp_path) == ["run.npz"]


def test_a_full_disk_leaves_the_older_file(small_disk):
    name = small_disk / "run.npz"
    name.write_bytes(OLD)
    with pytest.raises(NotWritten, match="No space left on device"), replacing(name) as path:
        path.write_bytes(bytes(2_000_000))
    assert name.read_bytes() == OLD and os.listdir(small_disk) == ["run.npz"]


@pytest.mark.fault(
    "names",
    "an output that is a symbolic link, a FIFO, a device, a folder, a file of another kind, or in a folder that is not",
    "refused at once: one line, status 2; nothing hangs, nothing is made",
)
def test_only_a_regular_file_of_the_same_kind_is_replaced(tmp_path):
    (tmp_path / "text.npz").write_text("my notes")
    (tmp_path / "link.npz").symlink_to(tmp_path / "text.npz")
    (tmp_path / "broken.npz").symlink_to(tmp_path / "nowhere")
    (tmp_path / "folder.npz").mkdir()
    os.mkfifo(tmp_path / "fifo.npz")
    with socket.socket(socket.AF_UNIX) as bound:
        bound.bind(str(tmp_path / "socket.npz"))
    before = sorted(os.listdir(tmp_path))
    for name, reason in {
        "text.npz": "it is a file of another kind than .npz",
        "link.npz": "it is a symbolic link",
        "broken.npz": "it is a symbolic link",
        "folder.npz": "it is a folder",
        "fifo.npz": "it is a FIFO",
        "socket.npz": "it is a socket",
        "/dev/null": "it is a device",
        "mistyped/run.npz": f"there is no folder {shown(str(tmp_path / 'mistyped'))}",
    }.items():
        with pytest.raises(ValueError, match=r"--out .* cannot be written: ") as refused:
            check_output("--out", tmp_path / name)
        assert str(refused.value).endswith(reason)
        with pytest.raises(NotWritten), replacing(tmp_path / name):
            pytest.fail("nothing may be written there")
    assert sorted(os.listdir(tmp_path)) == before and (tmp_path / "text.npz").read_text() == "my notes"


def test_what_can_be_written_is_not_touched_by_asking(tmp_path):
    (tmp_path / "old.npz").write_bytes(OLD)
    (tmp_path / "empty.npz").touch()
    for name in ("old.npz", "empty.npz", "new.npz", "new.csv"):
        check_output("--out", tmp_path / name)
    assert sorted(os.listdir(tmp_path)) == ["empty.npz", "old.npz"]


@pytest.mark.fault(
    "names",
    "a file that appears under the name of an output after the start",
    "it stays; the output gets a number, and one line says so",
)
def test_a_file_that_has_appeared_since_the_start_stays(tmp_path):
    name = tmp_path / "run.npz"
    words = r"run\.npz' has appeared since the start, and stays: the output is '.*run-2\.npz'$"
    with command_begins():
        time.sleep(0.02)  # the file system's clock has coarse ticks
        name.write_bytes(b"PK of another")
        with pytest.warns(UserWarning, match=words) as told, replacing(name) as path:
            path.write_bytes(b"PK mine")
        assert len(told) == 1 and written_as(name) == tmp_path / "run-2.npz"
        assert name.read_bytes() == b"PK of another" and (tmp_path / "run-2.npz").read_bytes() == b"PK mine"
        for text in (b"PK once", b"PK twice"):  # what this process wrote is replaced
            with replacing(tmp_path / "page.npz") as path:
                path.write_bytes(text)
        assert (tmp_path / "page.npz").read_bytes() == b"PK twice"
        (tmp_path / "page.npz").unlink()
    with command_begins(), replacing(name) as path:  # now it is there at the start
        path.write_bytes(b"PK again")
    assert name.read_bytes() == b"PK again" and written_as(name) == name
    assert sorted(os.listdir(tmp_path)) == ["run-2.npz", "run.npz"]


def test_an_older_file_that_has_changed_since_the_start_stays(tmp_path):
    name = tmp_path / "run.npz"
    name.write_bytes(OLD)
    with pytest.warns(UserWarning, match="has appeared since the start"), replacing(name) as path:
        path.write_bytes(b"PK mine")
        with replacing(tmp_path / "other.npz") as other:
            other.write_bytes(b"PK of another")
        (tmp_path / "other.npz").replace(name)
    assert name.read_bytes() == b"PK of another" and (tmp_path / "run-2.npz").read_bytes() == b"PK mine"


def test_a_file_newer_than_a_given_start_stays(tmp_path):
    name, start = tmp_path / "run.rrd", time.time_ns()
    name.write_bytes(b"RRF of another")
    os.utime(name, ns=(0, 0))  # a copy may bring an old date
    draft = Draft(name, start - 10**9)
    assert not draft.replaces and draft.complete() == tmp_path / "run-2.rrd"
    assert name.read_bytes() == b"RRF of another" and Draft(name, time.time_ns()).replaces


def test_without_hard_links_a_file_that_has_appeared_stays_too(tmp_path, monkeypatch):
    def refuse(*names):
        raise PermissionError(errno.EPERM, os.strerror(errno.EPERM))

    monkeypatch.setattr(os, "link", refuse)
    first, second = Draft(tmp_path / "run.rrd"), Draft(tmp_path / "run.rrd")
    assert first.complete() == tmp_path / "run.rrd" and second.complete() == tmp_path / "run-2.rrd"
    assert sorted(os.listdir(tmp_path)) == ["run-2.rrd", "run.rrd"]


def test_two_drafts_of_one_name_are_two_files(tmp_path):
    first, second = Draft(tmp_path / "run.rrd"), Draft(tmp_path / "run.rrd")
    assert [draft.path.name for draft in (first, second)] == ["run.part.rrd", "run.part-2.rrd"]
    first.path.write_bytes(b"RRF first")
    second.path.write_bytes(b"RRF second")
    assert second.complete() == tmp_path / "run.rrd" and first.complete() == tmp_path / "run-2.rrd"
    assert (tmp_path / "run.rrd").read_bytes() == b"RRF second" and (
        tmp_path / "run-2.rrd"
    ).read_bytes() == b"RRF first"
    assert len(os.listdir(tmp_path)) == 2


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL])
def test_a_killed_process_leaves_the_older_file_and_no_part(number, tmp_path):
    name = tmp_path / "run.npz"
    name.write_bytes(OLD)
    code = "import os, signal, sys\nsignal.signal(signal.SIGINT, signal.SIG_DFL)  # as a command has it\n"
    code += "from eel_common.files.output_file import Draft, replacing\nrecording = Draft('run.rrd', kept=True)\n"
    code += "with replacing('run.npz') as path, replacing('run.csv'):\n    path.write_bytes(b'PK half')\n"
    code += "    if not os.fork():  # a worker inherits the drafts, and does not own them\n"
    code += "        os.kill(os.getpid(), signal.SIGTERM)\n    os.wait()\n    assert path.exists()\n"
    code += "    print('half', flush=True)\n    sys.stdin.read()\n"
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True, "cwd": tmp_path}
    with subprocess.Popen([sys.executable, "-c", code], **pipes) as process:
        watchdog = threading.Timer(100.0, process.kill)
        watchdog.start()
        assert process.stdout.readline() == "half\n"
        watchdog.cancel()
        process.send_signal(number)
    assert process.returncode == -number and name.read_bytes() == OLD
    left = {"run.part.npz", "run.part.csv"} if number == signal.SIGKILL else set()
    assert {*os.listdir(tmp_path)} == {"run.npz", "run.part.rrd", *left}


def test_signals_are_as_before_when_no_draft_is_left(tmp_path, monkeypatch):
    monkeypatch.setattr(output_file, "_unfinished", {})
    signal.signal(signal.SIGHUP, signal.SIG_DFL)
    with replacing(tmp_path / "run.npz") as path:
        path.write_bytes(b"PK")
        assert callable(signal.getsignal(signal.SIGHUP))
    assert signal.getsignal(signal.SIGHUP) is signal.SIG_DFL


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
