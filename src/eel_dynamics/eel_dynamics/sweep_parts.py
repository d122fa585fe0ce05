"""What is done of a sweep, on disk beside its output, so that it can go on after an end that was not planned."""

import hashlib
import itertools
import json
import os
import shutil
from pathlib import Path

import numpy as np

from . import compiled


class Parts:
    """Results by index of a sweep `key` of `count` points, in the folder `out`.parts; of no sweep where `out` is None.

    `ValueError` where the output, or the folder, is of another sweep, unless `overwrite`.
    """

    def __init__(self, out, key: str, count: int, overwrite: bool):
        self.out, self._key, self._count = None if out is None else Path(out), key, count
        self.folder = None if out is None else self.out.with_name(self.out.name + ".parts")
        self._number = itertools.count()
        if out is None:
            return
        if self.out.suffix != ".nc":
            raise ValueError(f"out must end in .nc, got {str(out)!r}")
        if not self.out.parent.is_dir():
            raise ValueError(f"out must lie in a folder that exists, got {str(out)!r}")
        if overwrite:
            self.out.unlink(missing_ok=True)
            shutil.rmtree(self.folder, ignore_errors=True)
        name = self.folder / "sweep.json"
        if name.exists() and json.loads(name.read_text())["sweep"] != key:
            raise ValueError(f"{self.folder} holds parts of another sweep: remove it, choose another out, or overwrite")

    def complete(self):
        """The finished sweep, or None. `ValueError` for a file that is not of this sweep."""
        if self.out is None or not self.out.exists():
            return None
        import xarray

        try:
            data = xarray.load_dataset(self.out, engine="scipy")
        except (OSError, ValueError):
            data = None
        if data is None or data.attrs.get("sweep") != self._key:
            raise ValueError(f"{self.out} exists and is not of this sweep: choose another out, or overwrite")
        return data

    def load(self) -> dict[int, dict]:
        """What is there already; makes the folder."""
        done = {}
        if self.folder is not None:
            self.folder.mkdir(exist_ok=True)
            (self.folder / "sweep.json").write_text(json.dumps({"sweep": self._key, "points": self._count}))
            for path in sorted(self.folder.glob("part-*.json")):
                done |= {int(index): measures for index, measures in json.loads(path.read_text()).items()}
        return done

    def keep(self, result: dict[int, dict]):
        """Write one task's results; whole or not at all."""
        if self.folder is None:
            return
        path = self.folder / f"part-{min(result)}-{os.getpid()}-{next(self._number)}.json"
        draft = path.with_suffix(".draft")
        draft.write_text(json.dumps(result))
        draft.replace(path)

    def finish(self, data):
        """Write the whole, and drop the parts."""
        if self.out is None:
            return
        draft = self.folder / "whole.nc"
        data.to_netcdf(draft, engine="scipy")
        draft.replace(self.out)
        shutil.rmtree(self.folder)


def key_of(points, duration, sample_period, stations, measure) -> str:
    """A name that changes with anything that the results depend on, the compiled loops included."""
    measured_by = getattr(measure, "__module__", ""), getattr(measure, "__qualname__", repr(measure))
    content = hashlib.sha256(repr((compiled.STAMP, duration, sample_period, measured_by)).encode())
    content.update(np.asarray(stations, dtype=float).tobytes())
    bodies = {}
    for point in points:
        if id(point.body) not in bodies:
            bodies[id(point.body)] = _content_of(point.body)
        content.update(bodies[id(point.body)])
        content.update(repr((point.law, point.scene, point.accuracy)).encode())
    return content.hexdigest()[:32]


def _content_of(body) -> bytes:
    x = np.linspace(0.0, body.length, 201)
    numbers = body.length, body.density, *body.nose, body.nose_added_mass, body.nose_drag
    drags = body.roll_drag, body.lateral_drag, body.vertical_drag
    shape = np.concatenate((body.half_width(x), body.half_height(x), body.kinks, numbers, drags))
    return shape.tobytes()
