# SPDX-License-Identifier: Apache-2.0
"""Films in HDF5 swim as their .csv do, and nothing in them is run."""

import pickle
import zlib

import h5py
import numpy as np
import pytest
from eel_gaits.film.film import read_film
from filmed import swimming, write_deeplabcut_h5, write_sleap_h5

PIXELS = {"units": "px", "scale": 1e-3, "rate": 50.0}
PARTS = [f"part{place}" for place in range(20)]
FORMS = ["table", "blocks"]


class Runs:
    """Its pickle makes the file "ran" where it is unpickled."""

    def __init__(self, folder):
        self.folder = folder

    def __reduce__(self):
        return exec, (f"open({str(self.folder / 'ran')!r}, 'w').close()",)


@pytest.mark.parametrize("form", FORMS)
def test_deeplabcuts_tables_are_read_of_one_animal_and_of_several(tmp_path, form):
    points = swimming(noise=1e-3)
    one = read_film(write_deeplabcut_h5(tmp_path / "one.h5", {"": 1e3 * points}, form), **PIXELS)
    path = write_deeplabcut_h5(tmp_path / "two.h5", {"a": points, "b": 1e3 * points}, form)
    for found in (one, read_film(path, **PIXELS, animal="b")):
        assert np.allclose(found.points, points, atol=1e-9) and np.allclose(np.diff(found.time), 0.02)
        assert found.names == tuple(PARTS)
    with pytest.raises(ValueError, match="it has 2 animals, 'a', 'b': say which one"):
        read_film(path, **PIXELS)


@pytest.mark.parametrize("dims", [None, ("frame", "track", "node", "xy")])
def test_sleaps_analysis_is_read_whatever_its_axes(tmp_path, dims):
    points = swimming(noise=1e-3)
    path = write_sleap_h5(tmp_path / "fish.h5", {"one": points + 9.0, "two": 1e3 * points}, PARTS, dims)
    found = read_film(path, **PIXELS, animal="two")
    assert np.allclose(found.points, points, atol=1e-9) and found.names == tuple(PARTS)


@pytest.mark.parametrize("form", FORMS)
def test_no_pickle_in_an_attribute_is_run(tmp_path, form):
    path = write_deeplabcut_h5(tmp_path / "fish.h5", {"": 1e3 * swimming()}, form)
    harm = np.bytes_(pickle.dumps(Runs(tmp_path), 0))
    with h5py.File(path, "a") as file:
        for holder in (file, file["df_with_missing"], *file["df_with_missing"].values()):
            for name in ("info", "non_index_axes", "FILTERS", "TITLE", "name", "values_block_0_meta"):
                holder.attrs[name] = harm
    assert len(read_film(path, **PIXELS).names) == 20
    if form == "table":
        for nested in (Runs(tmp_path), [("net", "nose", Runs(tmp_path))]):
            with h5py.File(path, "a") as file:
                file["df_with_missing/table"].attrs["values_block_0_kind"] = np.bytes_(pickle.dumps(nested, 0))
            with pytest.raises(ValueError, match=r"fish.h5.*not unpickled: the instruction GLOBAL"):
                read_film(path, **PIXELS)
    assert not (tmp_path / "ran").exists()
    pickle.loads(harm)  # what would have happened
    assert (tmp_path / "ran").exists()


def test_a_pickle_in_place_of_numbers_is_not_run(tmp_path):
    path = write_sleap_h5(tmp_path / "fish.h5", {"one": swimming()}, PARTS)
    with h5py.File(path, "a") as file:
        del file["tracks"]
        data = file.create_dataset("tracks", (1,), dtype=h5py.vlen_dtype(np.uint8))
        data[0] = np.frombuffer(pickle.dumps(Runs(tmp_path)), np.uint8)  # as PyTables writes objects
    with pytest.raises(ValueError, match="'/tracks' must hold real numbers, got 'object'"):
        read_film(path, **PIXELS)
    assert not (tmp_path / "ran").exists()


def bomb(file):
    """A chunk that inflates to 100 times what it should hold."""
    data = file.create_dataset("tracks", (1, 2, 20, 80), "f8", chunks=(1, 2, 20, 80), compression="gzip")
    data.id.write_direct_chunk((0, 0, 0, 0), zlib.compress(bytes(100 * 8 * 2 * 20 * 80)))


def elsewhere(file):
    plan = h5py.VirtualLayout((1, 2, 20, 80), dtype="f8")
    plan[:] = h5py.VirtualSource("other.h5", "tracks", shape=(1, 2, 20, 80))
    file.create_virtual_dataset("tracks", plan)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda file: file.create_dataset("tracks", (1, 2, 20, 10**9), "f8", chunks=(1, 2, 20, 80)), "at most 4000000"),
        (lambda file: file.create_dataset("tracks", (1, 2, 20, 80), "f8", chunks=True, maxshape=(None,) * 4)
         .resize((10**6, 2, 20, 10**6)), "at most 40000000 bytes"),
        (lambda file: file.create_dataset("tracks", (1, 2, 20, 80), "f8", chunks=(1, 2, 20, 10**7),
                                          maxshape=(1, 2, 20, None)), "chunks of at most 64000000 bytes"),
        (bomb, "inflates to more than its 25600 bytes"),
        (elsewhere, "'/tracks' lies in another file"),
        (lambda file: file.create_dataset("tracks", (1, 2, 20, 80), "f8", external=[("/dev/zero", 0, 25600)]),
         "'/tracks' lies in another file"),
        (lambda file: file.create_dataset("tracks", (1, 2, 20, 80), "f8", compression="lzf"), "compressed by gzip"),
        (lambda file: file.__setitem__("tracks", h5py.ExternalLink("other.h5", "tracks")), "it must hold a table of"),
        (lambda file: file.__setitem__("tracks", h5py.SoftLink("/node_names")), "it must hold a table of"),
        (lambda file: file.create_dataset("tracks", data=np.full((1, 2, 20, 80), 1e200)), "at most 1e+100"),
        (lambda file: file.create_dataset("tracks", data=np.zeros((1, 2, 20), complex)), "must hold real numbers"),
        (lambda file: file.create_dataset("tracks", data=np.zeros((1, 3, 20, 80))), "of x and y of 20 nodes"),
        (lambda file: file.create_dataset("tracks", data=np.zeros((2, 2, 20, 80))), "got 2 tracks and"),
        (lambda file: file.create_group("tracks"), "damaged or foreign"),
    ],
)  # fmt: skip
def test_a_file_that_asks_for_more_than_it_holds_is_refused(tmp_path, make, words):
    path = write_sleap_h5(tmp_path / "fish.h5", {"one": swimming()}, PARTS)
    write_sleap_h5(tmp_path / "other.h5", {"one": swimming()}, PARTS)
    with h5py.File(path, "a") as file:
        del file["tracks"]
        make(file)
    with pytest.raises(ValueError) as error:
        read_film(path, **PIXELS)
    assert words in str(error.value) and "fish.h5" in str(error.value) and "\n" not in str(error.value)


@pytest.mark.parametrize("form", FORMS)
def test_names_that_do_not_fit_the_numbers_are_refused(tmp_path, form):
    path = write_deeplabcut_h5(tmp_path / "fish.h5", {"": 1e3 * swimming()}, form)
    with h5py.File(path, "a") as file:
        group = file["df_with_missing"]
        if form == "table":
            group["table"].attrs["values_block_0_kind"] = np.bytes_(pickle.dumps([("net", "nose", "x")], 0))
        else:
            group["block0_items_label1"][0] = 100
    with pytest.raises(ValueError, match=r"export it as \.csv"):
        read_film(path, **PIXELS)


def test_what_is_no_hdf5_and_what_needs_h5py_is_told(tmp_path, monkeypatch):
    (tmp_path / "fish.h5").write_bytes(b"no HDF")
    with pytest.raises(ValueError, match=r"fish.h5.*cannot be read as HDF5"):
        read_film(tmp_path / "fish.h5", **PIXELS)
    monkeypatch.setitem(__import__("sys").modules, "h5py", None)
    with pytest.raises(ValueError, match=r"fish.h5.*HDF5 needs h5py \(pip install h5py\)"):
        read_film(tmp_path / "fish.h5", **PIXELS)


def test_a_frame_without_a_number_and_a_column_of_times_are_refused(tmp_path):
    path = write_deeplabcut_h5(tmp_path / "fish.h5", {"": 1e3 * swimming()}, "table")
    with pytest.raises(ValueError, match=r"fish.h5.*a column of times has no place, got 'foo'"):
        read_film(path, **PIXELS, time="foo")
    with h5py.File(path, "a") as file:
        table = file["df_with_missing/table"]
        rows, attributes = table[:], dict(table.attrs)
        rows = rows.astype([("index", "<f8"), *rows.dtype.descr[1:]])
        rows["index"][4] = np.nan
        del file["df_with_missing/table"]
        file["df_with_missing/table"] = rows
        for name, value in attributes.items():
            file["df_with_missing/table"].attrs[name] = value
    with pytest.raises(ValueError, match=r"fish.h5.*each frame must have a number, got nan in row 5"):
        read_film(path, **PIXELS)
