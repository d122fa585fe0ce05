# SPDX-License-Identifier: Apache-2.0
"""Files that were made to hang or to fill a reader, and files with a flipped bit: one line, or what they hold."""

import io
import json
import subprocess
import sys
from collections import Counter
from pathlib import Path
from typing import NamedTuple

import crafted_files
import numpy as np
import pytest
from eel_studies.sweeps.sweep_parts import Parts
from filmed import write_deeplabcut_h5, write_sleap_h5
from flow_files import write_flow

from eel_dynamics import Body, simulate, simulate_batch
from eel_gaits import sampled, save_law, straight

QUICK = "rows.npz", "sequence.yaml", "part.json", "flow.h5"  # one of each format; the soak has all readers
CHECKED = ("body.npz", "midlines.npz", "rows.npz", "speeds.npz")  # with checksums
MEMORY = 200  # MB that a reader may take
SECONDS = 1.0  # of CPU time
LONGEST = 300  # characters of a refusal
SEQUENCE = "steps:\n- {gait: straight, duration: 1}\n- {gait: still}\n"
PARAMETERS = "/**:\n  ros__parameters:\n    rate: 100.0\n    duration: 1\n"
FLIPS, SEED = 300, 2026


def table(columns: dict[str, np.ndarray]) -> str:
    rows = "".join(",".join(map(repr, row)) + "\n" for row in np.transpose(list(columns.values())).tolist())
    return ",".join(columns) + "\n" + rows


def archive(columns: dict[str, np.ndarray]) -> bytes:
    return crafted_files.archive({name: crafted_files.member(each) for name, each in columns.items()})


@pytest.fixture(scope="module")
def good(tmp_path_factory) -> dict[str, bytes]:
    """A good file for each reader."""
    import xarray

    folder = tmp_path_factory.mktemp("good")
    run = simulate(straight(), 1.5, accuracy="draft", stations=7, estimate=False)
    run.save(folder / "run.nc")
    simulate_batch([straight(), straight(period=0.9)], 0.5, accuracy="draft", stations=4).save(folder / "batch.nc")
    save_law(sampled(straight().curvature, 0.5), folder / "rows.npz")
    xarray.Dataset({"speed": ("period", [1.0, 2.0])}, attrs={"sweep": "a sweep"}).to_netcdf(
        folder / "sweep.nc", engine="scipy"
    )
    parts = Parts(folder / "other.nc", "a sweep", 10, False)
    parts.load()
    parts.keep({0: {"mean_speed": 0.3, "head_x": np.nan, "error": ""}, 1: {"mean_speed": 0.4, "error": "late"}})
    (part,) = parts.folder.glob("part-*.json")
    files = {name: (folder / name).read_bytes() for name in ("run.nc", "batch.nc", "rows.npz", "sweep.nc")}
    body = Body.boyer2010()
    x = np.linspace(0.0, 1.0, 9)
    columns = {"x": x, "half_width": body.half_width(x), "half_height": body.half_height(x)}
    time, s = np.repeat(np.arange(40) / 40.0, 9), np.tile(x, 40)
    midlines = {"time": time, "x": s, "y": 0.02 * s * np.sin(2.0 * np.pi * (s - time)), "arc_length": s}
    joints = {"time": np.arange(40) / 40.0}
    joints |= {f"yaw_{n}": 0.1 * np.sin(2.0 * np.pi * (joints["time"] - n / 5)) for n in range(1, 5)}
    film = {"time_s": joints["time"]}
    for place in range(6):
        film |= {f"x{place}": np.full(40, 0.2 * place), f"y{place}": 0.02 * np.sin(9.0 * joints["time"] - place)}
    sleap = {"frame_idx": np.arange(40.0), "track": np.zeros(40)}
    sleap |= {f"p{name[1]}.{name[0]}": each for name, each in list(film.items())[1:]}
    points = np.stack([midlines[name].reshape(40, 9) for name in "xy"], axis=2)
    for form in ("table", "blocks"):
        write_deeplabcut_h5(folder / f"{form}.h5", {"": points}, form)
    write_sleap_h5(folder / "sleap.h5", {"": points}, [f"p{place}" for place in range(9)])
    for name in ("flow.nc", "flow.h5"):
        write_flow(folder / name, 4)
    files |= {
        name: (folder / name).read_bytes() for name in ("table.h5", "blocks.h5", "sleap.h5", "flow.nc", "flow.h5")
    }
    path = {"time": run.time, "x": run.position[:, 0], "y": run.position[:, 1]}
    return files | {
        "body.csv": table(columns).encode(),
        "body.npz": archive(columns),
        "midlines.csv": table(midlines).encode(),
        "midlines.npz": archive(midlines),
        "joints.csv": table(joints).encode(),
        "path.csv": table(path).encode(),
        "film.csv": table(film).encode(),
        "sleap.csv": table(sleap).encode(),
        "speeds.npz": archive({"speed": np.array([0.2, 0.3]), "period": np.array([1.0, 0.8])}),
        "sequence.yaml": SEQUENCE.encode(),
        "file.yaml": SEQUENCE.encode(),
        "parameters.yaml": PARAMETERS.encode(),
        "measured.nc": files["run.nc"],
        "part.json": part.read_bytes(),
    }


class Outcome(NamedTuple):
    """What became of a file: what was raised ("" for nothing), its text, whether the file holds what the good one does,
    CPU time [s]."""

    reader: str
    file: str
    raised: str
    text: str
    same: bool
    seconds: float

    @property
    def fits(self) -> bool:
        """Whether nothing was raised but a short line, for want of anything but memory."""
        short = len(self.text) <= LONGEST and self.text.isprintable() and "more memory than there is" not in self.text
        return short and self.raised in ("", "ValueError")


def crafted(reader: str, content: bytes) -> dict[str, bytes]:
    """The crafted files for a reader."""
    suffix = Path(reader).suffix
    if suffix == ".npz":
        return crafted_files.archives(dict(np.load(io.BytesIO(content))))
    if reader == "flow.nc":
        return crafted_files.flows(content)
    if suffix == ".h5":
        return crafted_files.of_hdf5(content)
    if suffix == ".nc":
        return crafted_files.runs(content) if b"eel\0" in content else crafted_files.heads(content)
    make = {".csv": crafted_files.tables, ".yaml": crafted_files.sequences, ".json": crafted_files.texts_of_json}
    return make[suffix](content.decode())


def flipped(reader: str, content: bytes) -> dict[str, bytes]:
    """The good file, and files with a flipped bit."""
    return {"as it is": content} | crafted_files.flipped(content, FLIPS, SEED)


def outcomes(folder: Path, good: dict[str, bytes], make) -> list[Outcome]:
    """What became of the files that `make` (reader and good file) gives."""
    names = {}
    for reader, content in good.items():
        (folder / reader).mkdir()
        suffix = Path(reader).suffix
        (folder / reader / f"good{suffix}").write_bytes(content)
        for number, (name, changed) in enumerate(make(reader, content).items()):
            names[reader, f"{number}{suffix}"] = name
            (folder / reader / f"{number}{suffix}").write_bytes(changed)
    script = Path(__file__).with_name("file_readers.py")
    done = subprocess.run(
        [sys.executable, script, folder, str(MEMORY)], capture_output=True, text=True, timeout=3600, check=False
    )
    found = [Outcome(*json.loads(line)) for line in done.stdout.splitlines()]
    assert done.returncode == 0, f"{done.returncode} after {found[-1:]}: {done.stderr[-2000:]}"
    assert len(found) == len(names)
    return [each._replace(file=names[each.reader, each.file]) for each in found]


def counted(found: list[Outcome]) -> str:
    """A line for each reader: the files of which it told, those that it read as the good one, and as others."""
    kinds = Counter((each.reader, "told" if each.raised else "same" if each.same else "other") for each in found)
    slowest = {reader: max(each.seconds for each in found if each.reader == reader) for reader, _ in kinds}
    return "\n".join(
        f"{reader}: {', '.join(f'{kinds[reader, kind]} {kind}' for kind in ('told', 'same', 'other'))}, {slow:.2f} s"
        for reader, slow in slowest.items()
    )


@pytest.mark.fault(
    "parameters",
    "files that were made to hang or to fill a reader: aliases of aliases, 20,000 levels, archives that inflate, heads "
    "with 1e30 elements, variables over one another, ...",
    "one line of at most 300 characters, within 200 MB",
)
@pytest.mark.timeout(1200)
def test_a_crafted_file_is_one_line_and_takes_little_memory(good, tmp_path):
    found = outcomes(tmp_path, {reader: good[reader] for reader in QUICK}, crafted)
    assert not [each for each in found if not each.fits]
    assert not [each for each in found if not each.raised and each.reader in ("rows.npz", "sequence.yaml", "part.json")]


@pytest.mark.soak
@pytest.mark.parametrize("make", [crafted, flipped])
def test_every_reader_tells_of_damage_in_a_second(good, tmp_path, make):
    found = outcomes(tmp_path, good, make)
    print(f"\n{make.__name__}\n{counted(found)}")
    assert not [each for each in found if not each.fits or each.seconds > SECONDS]
    if make is flipped:
        assert not [each for each in found if each.reader in CHECKED and not each.raised and not each.same]
        assert [each.same for each in found if each.file == "as it is"] == [True] * len(good)
