# SPDX-License-Identifier: Apache-2.0
"""The command `simulate`: bad input is one line with exit status 2, said before anything swims."""

import numpy as np
import pytest
from eel_dynamics.commands import simulate as command


def said_of(words, capsys) -> str:
    assert command.main(words.split()) == 2
    said = capsys.readouterr().err
    assert said.startswith("eel simulate: ") and said.count("\n") == 1
    return said


@pytest.mark.parametrize(
    "words, named",
    [
        ("--sample-period 1e-12", "1e+13 samples"),
        ("--duration 1e9", "2e+10 samples"),
        ("--duration 1e300", "duration must be 1e-30 to 1e+30 in size, got 1e+300"),
        ("--sample-period 1e-8 --duration 100", "1e+10 samples"),
        ("--actuators 0", "--actuators must be 1 to 1000, got 0"),
        ("--actuators 100000", "--actuators must be 1 to 1000, got 100000"),
        ("--actuators 4 --scene internal_wrench=off", "internal_wrench=on"),
        ("--actuators 4 --stations 3", "4 --stations or more, got 3"),
        ("straight --set period=1 --set period=2", "period must be given once, got it 2 times"),
    ],
)
def test_bad_input_is_refused_before_the_swim(words, named, monkeypatch, capsys):
    monkeypatch.setattr("eel_dynamics.runs.observed_swim.ObservedSwim.swim", lambda *_: pytest.fail("it swims"))
    assert named in said_of(words, capsys)


def test_a_plain_array_is_no_body(tmp_path, capsys):
    with open(tmp_path / "arr.npz", "wb") as file:
        np.save(file, [1, 2])
    told = "arr.npz': it is damaged or foreign (BadZipFile: File is not a zip file)"
    assert told in said_of(f"--body {tmp_path}/arr.npz", capsys)


def test_out_of_memory_is_one_line(monkeypatch, capsys):
    def swum(*_, **__):
        raise MemoryError("72 GiB")

    monkeypatch.setattr("eel_dynamics.runs.observed_swim.ObservedSwim.swim", swum)
    assert said_of("straight", capsys) == "eel simulate: it does not fit into memory: 72 GiB\n"
