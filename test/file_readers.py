# SPDX-License-Identifier: Apache-2.0
"""Reads files in a process of its own, whose memory is limited, and tells what became of each.

    python file_readers.py FOLDER LIMIT      # FOLDER/READER/good* is read first, then all else in FOLDER/READER

Prints one line of JSON per file: reader, file, what was raised ("" for nothing), its text, whether the file holds the
same as the good one, CPU time [s].
"""

import json
import pickle
import resource
import signal
import sys
import time
import warnings
from pathlib import Path

from eel_common.ros.parameters import shared_names
from eel_gaits.film.film import read_film
from eel_gaits.gaits.settings import Settings
from eel_studies.identification.measured_file import read_measured
from eel_studies.sweeps.sweep_parts import Parts

from eel_dynamics import Batch, Body, GriddedFlow, Run
from eel_gaits import read_midlines, read_motion, sequence_from_file

MEGABYTE, LONGEST = 2**20, 60  # s of wall time, for a file
KEY = "a sweep"


def body_of(path: Path) -> Body:
    """A body without its name, which is the file's."""
    return Body.from_file(path).changed(name="body")


def rows_of(path: Path) -> tuple:
    """A measured motion."""
    law = read_motion(path)
    return law.time, law.x, law.values


def frames_of(path: Path) -> tuple:
    """Measured midlines."""
    midlines = read_midlines(path)
    return midlines.time, midlines.arc, midlines.position


def terms_of_file(path: Path) -> tuple:
    """What the node makes of its parameter `file`."""
    return Settings(gait="file", file=str(path)).law().terms


def film_of(path: Path) -> tuple:
    """A film without its name, which is the file's."""
    film = read_film(path, units="px", scale=1.0, rate=None if path.parent.name == "film.csv" else 50.0)
    return film.time, film.points, film.names


def flow_of(path: Path) -> int:
    """The hash of a flow, which may take nearly all memory that there is."""
    return hash(GriddedFlow.of(path))


def part_of_sweep(path: Path) -> dict:
    """The points in a part of a sweep. The library warns of a damaged part, and does its points again."""
    parts = Parts(path.with_name("sweep.nc"), KEY, 10, True)
    parts.folder.mkdir(exist_ok=True)
    (parts.folder / "part-0-1-0.json").write_bytes(path.read_bytes())
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            return parts.load()
        except UserWarning as told:
            raise ValueError(str(told)) from None


READERS = {
    "body.csv": body_of,
    "body.npz": body_of,
    "midlines.csv": rows_of,
    "midlines.npz": frames_of,
    "joints.csv": rows_of,
    "rows.npz": rows_of,
    "path.csv": lambda path: read_measured(str(path)),
    "speeds.npz": lambda path: read_measured(str(path)),
    "sequence.yaml": lambda path: sequence_from_file(path).terms,
    "file.yaml": terms_of_file,
    "parameters.yaml": lambda path: shared_names(["--params-file", str(path)]),
    "film.csv": film_of,
    "sleap.csv": film_of,
    "table.h5": film_of,
    "blocks.h5": film_of,
    "sleap.h5": film_of,
    "flow.nc": flow_of,
    "flow.h5": flow_of,
    "run.nc": Run.load,
    "batch.nc": Batch.load,
    "measured.nc": lambda path: read_measured(str(path)),
    "sweep.nc": lambda path: Parts(path, KEY, 10, False).complete().to_dict(),
    "part.json": part_of_sweep,
}


def read(reader: str, path: Path) -> tuple[str, str, bytes, float]:
    """What was raised, its text, what was read, and the CPU time [s]."""
    start, raised, text, found = time.process_time(), "", "", None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found = READERS[reader](path)
    except Exception as error:
        raised, text = type(error).__name__, str(error)
    seconds = time.process_time() - start
    return raised, text, pickle.dumps(found), seconds


def main(folder: Path, limit: int) -> None:
    """Read all files in `folder`, within `limit` [MB] above what reading the good ones takes."""
    good = {}
    for path in sorted(folder.glob("*/good*")):
        raised, text, good[path.parent.name], _ = read(path.parent.name, path)
        if raised:
            raise SystemExit(f"{path}: {raised}: {text}")
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    most = pages * resource.getpagesize() + limit * MEGABYTE
    resource.setrlimit(resource.RLIMIT_AS, (most, most))
    for reader, content in good.items():
        for path in sorted((folder / reader).iterdir()):
            if path.is_file() and not path.name.startswith("good"):
                signal.alarm(LONGEST)  # ends the process
                raised, text, found, seconds = read(reader, path)
                signal.alarm(0)
                print(json.dumps([reader, path.name, raised, text, found == content, round(seconds, 3)]), flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]))
