# SPDX-License-Identifier: Apache-2.0
"""Stores the partial results of a sweep on disk beside its output, so that an interrupted sweep can be resumed."""

import contextlib
import hashlib
import itertools
import json
import math
import os
import time
import warnings
from pathlib import Path
from typing import Any

import numpy as np
from eel_common.files.input_file import InputFile, from_json, reading
from eel_common.files.output_file import beside, check_output, replacing
from eel_common.quantity import checked_instance
from eel_common.wording import one_line, shown
from eel_dynamics.runs.storage.digest import ATTRIBUTE, add_digest, check_digest

Results = dict[int, dict[str, Any]]  # the measures of each point, by its index
ABOUT, OURS = "sweep.json", ("sweep*.json", "part-*.json")


def checked_point(found: dict[str, Any]) -> dict[str, Any]:
    """The measures of a point as plain numbers, and its "error". `ValueError` names a measure that is not a number."""
    if not isinstance(found.get("error"), str):
        raise ValueError(f"'error' must be the point's own, a text, and no measure, got {shown(found.get('error'))}")
    point = {}
    for name, value in found.items():
        number = value.item() if hasattr(value, "item") and np.ndim(value) == 0 else value
        if not isinstance(name, str) or name == "stopped":
            raise ValueError(f"measure must have a name other than 'stopped', got {shown(name)}")
        if name != "error" and not isinstance(number, (bool, int, float)):
            raise ValueError(f"measure {shown(name)} must be a real number, got {shown(value)}")
        point[name] = number
    return point


class Parts:
    """Results by index of the sweep `key` of `count` points, in the folder `out`.parts; not stored if `out` is None.

    `ValueError` if `out` is invalid, or if the file or folder belongs to another sweep, unless `overwrite`.
    """

    def __init__(self, out: str | Path | None, key: str, count: int, overwrite: bool):
        self._key, self._count = key, count
        path = self.out = None if out is None else Path(checked_instance("out", out, (str, os.PathLike)))
        self._overwrite, self._began = overwrite, time.time_ns()
        if path is not None and path.suffix != ".nc":
            raise ValueError(f"out must end in .nc, got {shown(str(out))}")
        self.folder: Any = None if path is None else beside(path, "", ".parts")
        self._number = itertools.count()
        if path is None or self.folder is None:
            return
        check_output("out", path)
        if self.folder.exists() and self._key_of_folder() not in (None, key):
            if not overwrite:
                raise ValueError(
                    f"{self.folder} holds parts of another sweep: remove it, choose another out, or overwrite"
                )
            self._remove()

    def complete(self) -> Any:
        """The finished sweep, or None. `ValueError` for a file that is not of this sweep, unless `overwrite`."""
        if self.out is None or not self.out.exists():
            return None
        import xarray

        data = None
        with contextlib.suppress(ValueError), reading(""), InputFile(self.out) as file:
            _check_digest_of(self.out)
            data = xarray.load_dataset(file, engine="scipy")
        if data is not None and data.attrs.get("sweep") == self._key:
            data.attrs.pop(ATTRIBUTE, None)  # belongs to the file
            return data
        if self._overwrite:
            return None
        raise ValueError(f"{self.out} exists and is not of this sweep, or is damaged: choose another out, or overwrite")

    def load(self) -> Results:
        """Load the stored results by index, and create the folder. A damaged part is removed with a warning."""
        done: dict[int, Any] = {}
        if self.folder is not None:
            self.folder.mkdir(exist_ok=True)
            with replacing(self.folder / ABOUT) as draft:
                draft.write_text(json.dumps({"sweep": self._key, "points": self._count}))
            for path in sorted(self.folder.glob("part-*.json")):
                try:
                    done |= self._part(path)
                except ValueError as error:
                    damage = f"{shown(str(path))} is damaged ({error}): its points are done again"
                    warnings.warn(one_line(damage), stacklevel=3)
                    path.unlink()
        return done

    def keep(self, result: Results) -> None:
        """Write one task's results to a part, atomically."""
        if self.folder is None:
            return
        points = {
            index: {name: None if _undefined(value) else value for name, value in point.items()}
            for index, point in result.items()
        }
        with replacing(self.folder / f"part-{min(result)}-{os.getpid()}-{next(self._number)}.json") as draft:
            draft.write_text(json.dumps({ATTRIBUTE: _digest_of(points), "points": points}))

    def finish(self, data: Any) -> None:
        """Write the complete sweep, and remove the parts."""
        if self.out is None:
            return
        with replacing(self.out, self._began) as draft:
            data.to_netcdf(draft, engine="scipy")
            _add_digest_to(draft)
        self._remove()

    def _part(self, path: Path) -> Results:
        """The points of one part. `ValueError` if `keep` did not write it: text, NaN, a truncated file."""
        with reading(""), InputFile(path) as file:
            found = from_json(file.read(), parse_constant=_infinity)
        held = found.get("points") if isinstance(found, dict) else None
        if not isinstance(held, dict):
            raise ValueError("it holds no points")
        points = {}
        for index, point in held.items():
            if not index.isdecimal() or not int(index) < self._count or not isinstance(point, dict):
                raise ValueError(f"it holds no point of this sweep at {shown(index)}")
            points[int(index)] = checked_point(
                {name: math.nan if value is None else value for name, value in point.items()}
            )
        if found.get(ATTRIBUTE) != _digest_of(held):
            raise ValueError("its content does not fit its digest")
        return points

    def _key_of_folder(self) -> str | None:
        """The key of the sweep in the folder; None if there are no parts, "unknown" if the key cannot be read."""
        if not any(self.folder.glob("part-*.json")):
            return None
        with contextlib.suppress(ValueError), reading(""), InputFile(self.folder / ABOUT) as file:
            return str(from_json(file.read())["sweep"])
        return "unknown"

    def _remove(self) -> None:
        """Remove the parts; other files in the folder stay."""
        for pattern in OURS:
            for path in self.folder.glob(pattern):
                path.unlink()
        with contextlib.suppress(OSError):  # it is not empty
            self.folder.rmdir()


def _undefined(value: object) -> bool:
    return isinstance(value, float) and math.isnan(value)


def _infinity(text: str) -> float:
    """Parse an infinity, which JSON lacks. `ValueError` for NaN, which `keep` never writes."""
    if text == "NaN":
        raise ValueError("it holds NaN in place of a number")
    return float(text)


def _add_digest_to(path: str | os.PathLike[str]) -> None:
    """Add its digest to the complete netCDF file at `path`."""
    from scipy.io import netcdf_file

    with netcdf_file(os.fspath(path), "a", mmap=False) as file:
        add_digest(file)


def _check_digest_of(path: str | os.PathLike[str]) -> None:
    """`check_digest` for the netCDF file at `path`. SciPy raises many kinds of errors for a damaged file."""
    from scipy.io import netcdf_file

    with InputFile(path) as content, netcdf_file(content, "r", mmap=False) as file:
        check_digest(file, os.fspath(path))


def _digest_of(points: dict[Any, Any]) -> str:
    """The digest of the points of a part."""
    return hashlib.sha256(json.dumps(points).encode()).hexdigest()
