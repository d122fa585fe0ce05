# SPDX-License-Identifier: Apache-2.0
"""Velocities on a grid, from data sets of xarray and from netCDF files.

Variables are broadcast over all dimensions, and an HDF5 file may declare any shape, so the points are
counted before a value is read. HDF5 (netCDF-4) is read by h5py.
"""

import contextlib
import math
import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from eel_common.files.hdf5 import attribute_text, members, numbers_of, opened_hdf5
from eel_common.files.input_file import InputFile, reading
from eel_common.wording import shown

AXES = "time", "x", "y", "z"
SECONDS = {"s": 1.0, "sec": 1.0, "second": 1.0, "min": 60.0, "minute": 60.0, "h": 3.6e3, "hour": 3.6e3, "day": 86.4e3,
           "millisecond": 1e-3, "microsecond": 1e-6, "nanosecond": 1e-9}  # fmt: skip
MOST_POINTS = 3_000_000  # of the grid in a file: 72 MB, twice while it is checked
MISSING = "_FillValue", "missing_value"
ATTRIBUTES = "units", "positive", "scale_factor", "add_offset", *MISSING  # the ones read
WITHOUT_VALUES = b"This is a netCDF dimension but not a netCDF variable"
SPEEDS = "", "m/s", "m s-1", "m.s-1", "m s^-1", "m s**-1", "meter second-1"


def read_grid(source: Any, velocity: tuple[str, str, str | None]) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Velocities (T, X, Y, Z, 3) [m/s], and the points [s, m] of the axes present.

    source, velocity: as in `GriddedFlow.of`. `ValueError` for bad input, and for more points than
    `MOST_POINTS`, unless a data set of xarray has as many itself.
    """
    if isinstance(source, (str, os.PathLike)):
        path = os.fspath(source)
        with reading(f"flow file {path}"), _opened(path) as variables:
            return _grid(variables, velocity, MOST_POINTS)
    if not hasattr(source, "data_vars"):
        raise ValueError(f"flow source must be an xarray.Dataset or a path, got {shown(source)}")
    with reading("flow"):
        variables = _of_xarray(source)
        return _grid(variables, velocity, max(MOST_POINTS, *(math.prod(each.shape) for each in variables.values())))


def _grid(
    source: dict[str, "_Variable"], velocity: tuple[str, str, str | None], most: int
) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    if missing := [name for name in velocity[:2] if name not in source]:
        raise ValueError(f"flow file must have a variable {shown(missing[0])}, got {sorted(source)}")
    parts = [source[name] for name in velocity if name in source]
    for name, part in zip(velocity, parts, strict=False):
        if len(set(part.dims)) < len(part.dims):
            raise ValueError(f"flow {shown(name)} must have each of its dimensions once, got {shown(part.dims)}")
    sizes = {dim: size for part in parts for dim, size in zip(part.dims, part.shape, strict=True)}
    if odd := set(sizes).difference(AXES):
        raise ValueError(f"flow dimensions must be some of {AXES}, got {shown(sorted(odd)[0])}")
    used = [name for name in AXES if name in sizes]
    if absent := [name for name in used if name not in source or source[name].dims != (name,)]:
        raise ValueError(f"flow file must have the coordinate {shown(absent[0])}")
    shape = [sizes[name] for name in used]
    if (points := math.prod(shape)) > most:
        listed = ", ".join(f"{name} {sizes[name]}" for name in used)
        raise ValueError(f"flow must have at most {most} points, got {points} ({listed}): take fewer, or give arrays")
    axes = {name: source[name].seconds() if name == "time" else source[name].metres(name) for name in used}
    rows = np.zeros((*shape, 3))
    for column, part in enumerate(parts):
        rows[..., column] = part.along(used)
    return rows, axes


@dataclass(frozen=True)
class _Variable:
    """A variable of a data set: shape, dimensions and attributes; and `read`, which gives its values."""

    shape: tuple[int, ...]
    dims: tuple[str, ...]
    attributes: dict[str, Any]
    read: Callable[[], np.ndarray]

    def seconds(self) -> np.ndarray:
        values = self.read()
        if values.dtype.kind in "mM":
            return np.asarray((values - values[0]) / np.timedelta64(1, "s"))
        unit, *since = self._units.split(" since ")
        if (scale := SECONDS.get(unit.strip().removesuffix("s") or "s")) is None:
            raise ValueError(f"flow time must be in seconds, minutes, hours or days, got units {shown(self._units)}")
        return np.asarray(scale * (values - values[0] if since else values).astype(float))

    def metres(self, name: str) -> np.ndarray:
        if self._units not in ("", "m", "meter", "metre", "meters", "metres"):
            raise ValueError(f"flow {name} must be in m, got units {shown(self._units)}")
        if self._text("positive").lower() == "down":
            raise ValueError(f"flow {name} must rise upwards, got a depth: change its sign, and that of its velocity")
        return self.read().astype(float)

    def along(self, axes: list[str]) -> np.ndarray:
        """The values with these axes, of size one where the variable has none."""
        if self._units not in SPEEDS:
            raise ValueError(f"flow velocity must be in m/s, got units {shown(self._units)}")
        order = [self.dims.index(name) for name in axes if name in self.dims]
        values = self.read().transpose(order)
        return np.expand_dims(values, [axis for axis, name in enumerate(axes) if name not in self.dims])

    @property
    def _units(self) -> str:
        return self._text("units")

    def _text(self, name: str) -> str:
        """An attribute as text; empty if absent. Bytes that are not UTF-8 are escaped."""
        value = self.attributes.get(name, "")
        return (value.decode(errors="backslashreplace") if isinstance(value, bytes) else str(value)).strip()


@contextlib.contextmanager
def _opened(path: str) -> Iterator[dict[str, _Variable]]:
    """The variables of a netCDF file, whose values can be read while it is open."""
    from scipy.io import netcdf_file

    with contextlib.ExitStack() as stack:
        content = stack.enter_context(InputFile(path))
        if content.read(3) == b"CDF":
            content.seek(0)
            file = stack.enter_context(netcdf_file(content, "r", mmap=False, maskandscale=True))
            yield {
                name: _Variable(each.shape, each.dimensions, dict(each._attributes), partial(_masked, each))
                for name, each in file.variables.items()
            }
        else:
            yield _of_hdf5(stack.enter_context(opened_hdf5(path)))


def _masked(variable: Any) -> np.ndarray:
    return np.ma.filled(variable[:].astype(float), np.nan)


def _of_hdf5(file: Any) -> dict[str, _Variable]:
    """The data sets of a netCDF-4 file, whose axes are its dimension scales."""
    variables = {}
    for name, each in members(file).items():
        if not hasattr(each, "shape") or attribute_text(each, "NAME").startswith(WITHOUT_VALUES):
            continue
        scales = [dim[0].name.lstrip("/") if len(dim) else "" for dim in each.dims]
        dims = (name,) if scales == [""] else tuple(scales)
        attributes = {key: _plain(each.attrs[key]) for key in ATTRIBUTES if key in each.attrs}
        variables[name] = _Variable(each.shape, dims, attributes, partial(_scaled, each, attributes))
    return variables


def _plain(value: Any) -> Any:
    """An attribute's text, or its one number."""
    return value if isinstance(value, (str, bytes)) else float(np.ravel(value)[0])


def _scaled(data: Any, attributes: dict[str, Any]) -> np.ndarray:
    values = numbers_of(data, MOST_POINTS).astype(float)
    for name in MISSING:
        if name in attributes:
            values[values == attributes[name]] = np.nan
    return np.asarray(values * attributes.get("scale_factor", 1.0) + attributes.get("add_offset", 0.0))


def _of_xarray(dataset: Any) -> dict[str, _Variable]:
    return {
        str(name): _Variable(each.shape, tuple(map(str, each.dims)), dict(each.attrs), partial(np.asarray, each))
        for name, each in dataset.variables.items()
    }
