# SPDX-License-Identifier: Apache-2.0
"""The entry for files that are read: what is whole comes back, and whatever a parser raises is one line."""

import json

import numpy as np
import pytest
from eel_common.files.archive import read_archive
from eel_common.files.input_file import InputFile, from_json, reading

from eel_gaits import sequence_from_file

ARRAYS = {
    "floats": np.linspace(0.0, 1.0, 7),
    "single": np.arange(6, dtype="<f4").reshape(2, 3),
    "foreign": np.arange(5, dtype=">i2"),
    "switches": np.array([True, False]),
    "columns first": np.asfortranarray(np.arange(24.0).reshape(2, 3, 4)),
    "one": np.array(2.5),
    "none": np.zeros((0, 3)),
}


@pytest.mark.parametrize("save", [np.savez, np.savez_compressed])
def test_an_archive_of_numpy_comes_back(tmp_path, save):
    save(tmp_path / "arrays.npz", **ARRAYS)
    found = read_archive(tmp_path / "arrays.npz")
    assert list(found) == list(ARRAYS)
    for name, values in ARRAYS.items():
        assert found[name].dtype == float and found[name].shape == values.shape and np.array_equal(found[name], values)


@pytest.mark.parametrize(
    ("error", "told"),
    [
        (RecursionError("maximum recursion depth"), "'a.nc': it is nested too deeply"),
        (MemoryError(), "'a.nc': it needs more memory than there is"),
        (KeyError("x"), "'a.nc': it is damaged or foreign (KeyError: 'x')"),
        (ValueError("one\n two \x1b[2J"), r"'a.nc': one two \x1b[2J"),
        (ValueError("'a.nc', line 2: said"), "'a.nc', line 2: said"),
        (FileNotFoundError(2, "No such file", "a.nc"), "'a.nc': No such file: 'a.nc'"),
    ],
)
def test_what_a_parser_raises_is_one_line_that_names_the_file(error, told):
    with pytest.raises(ValueError) as refused, reading("'a.nc'"):
        raise error
    assert str(refused.value) == told
    with pytest.raises(KeyboardInterrupt), reading("'a.nc'"):
        raise KeyboardInterrupt


def test_a_file_is_not_read_past_its_end_nor_over_and_over(tmp_path):
    (tmp_path / "a").write_bytes(bytes(100))
    with InputFile(tmp_path / "a") as file:
        with pytest.raises(ValueError, match="truncated or damaged: 101 bytes at 0 of 100"):
            file.read(101)
        file.seek(0)
        assert file.read() == bytes(100) and file.read() == b""
        file.seek(0)
        assert file.read(100) == bytes(100)
        file.seek(0)
        with pytest.raises(ValueError, match="its parts are more than the whole"):
            file.read(1)
    with pytest.raises(ValueError, match="at most 99 bytes, got 100"):
        InputFile(tmp_path / "a", 99)


def test_json_is_read_up_to_a_bound(monkeypatch):
    monkeypatch.setattr("eel_common.files.input_file.MOST_VALUES", 10)
    assert from_json(json.dumps(list(range(10)))) == list(range(10))
    with pytest.raises(ValueError, match="at most 10 values, got 11"):
        from_json(json.dumps(list(range(11))))


def test_a_step_that_is_named_once_may_be_used_often(tmp_path):
    path = tmp_path / "laps.yaml"
    path.write_text("steps:\n- &lap {gait: straight, duration: 2}\n- *lap\n- *lap\n- gait: still\n")
    plain = tmp_path / "plain.yaml"
    plain.write_text("steps:\n" + "- {gait: straight, duration: 2}\n" * 3 + "- gait: still\n")
    assert sequence_from_file(path).terms == sequence_from_file(plain).terms
