# SPDX-License-Identifier: Apache-2.0
"""Velocities on a grid, from data sets of xarray and from netCDF files."""

import os
from dataclasses import dataclass
from typing import Any

import numpy as np
from eel_base.files.input_file import InputFile, reading
from eel_base.wording import shown

AXES = "time", "x", "y", "z"
SECONDS = {"s": 1.0, "sec": 1.0, "second": 1.0, "min": 60.0, "minute": 60.0, "h": 3.6e3, "hour": 3.6e3, "day": 86.4e3}
SPEEDS = "", "m/s", "m s-1", "m.s-1", "m s^-1", "m s**-1", "meter second-1"


def read_grid(source: Any, velocity: tuple[str, str, str | None]) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Velocities (T, X, Y, Z, 3) [m/s], and the points [s, m] of those axes that there are.

    source, velocity: as in `GriddedFlow.of`. `ValueError` for what does not fit.
    """
    if isinstance(source, (str, os.PathLike)):
        with reading(f"flow file {os.fspath(source)}"), InputFile(source) as content:
            start = content.read(4)
        source = _dataset(os.fspath(source)) if start[:3] != b"CDF" else _classic(os.fspath(source))
    elif hasattr(source, "data_vars"):
        source = {name: _Variable.of(each) for name, each in source.variables.items()}
    else:
        raise ValueError(f"flow source must be an xarray.Dataset or a path, got {shown(source)}")
    if missing := [name for name in velocity[:2] if name not in source]:
        raise ValueError(f"flow file must have a variable {shown(missing[0])}, got {sorted(source)}")
    parts = [source[name] for name in velocity if name in source]
    dims = {dim for part in parts for dim in part.dims}
    if odd := dims.difference(AXES):
        raise ValueError(f"flow dimensions must be some of {AXES}, got {shown(sorted(odd)[0])}")
    used = [name for name in AXES if name in dims]
    if absent := [name for name in used if name not in source]:
        raise ValueError(f"flow file must have the coordinate {shown(absent[0])}")
    axes = {name: source[name].seconds() if name == "time" else source[name].metres(name) for name in used}
    shape = [len(axes[name]) for name in used]
    rows = np.zeros((*shape, 3))
    for column, part in enumerate(parts):
        rows[..., column] = np.broadcast_to(part.along(used), shape)
    return rows, axes


@dataclass(frozen=True)
class _Variable:
    """A variable of a data set: values, dimensions and attributes."""

    values: np.ndarray
    dims: tuple[str, ...]
    attributes: dict[str, Any]

    @staticmethod
    def of(variable: Any) -> "_Variable":
        return _Variable(np.asarray(variable.values), tuple(map(str, variable.dims)), dict(variable.attrs))

    def seconds(self) -> np.ndarray:
        values = self.values
        if values.dtype.kind in "mM":
            return np.asarray((values - values[0]) / np.timedelta64(1, "s"))
        unit, *since = self._units.split(" since ")
        if (scale := SECONDS.get(unit.strip().removesuffix("s") or "s")) is None:
            raise ValueError(f"flow time must be in seconds, minutes, hours or days, got units {shown(self._units)}")
        return np.asarray(scale * (values - values[0] if since else values).astype(float))

    def metres(self, name: str) -> np.ndarray:
        if self._units not in ("", "m", "meter", "metre", "meters", "metres"):
            raise ValueError(f"flow {name} must be in m, got units {shown(self._units)}")
        if self.attributes.get("positive", "up") in ("down", b"down"):
            raise ValueError(f"flow {name} must rise upwards, got a depth: change its sign, and that of its velocity")
        return self.values.astype(float)

    def along(self, axes: list[str]) -> np.ndarray:
        """The values with these axes, of size one where the variable has none."""
        if self._units not in SPEEDS:
            raise ValueError(f"flow velocity must be in m/s, got units {shown(self._units)}")
        order = [self.dims.index(name) for name in axes if name in self.dims]
        values = self.values.transpose(order).astype(float)
        return np.expand_dims(values, [axis for axis, name in enumerate(axes) if name not in self.dims])

    @property
    def _units(self) -> str:
        units = self.attributes.get("units", "")
        return (units.decode() if isinstance(units, bytes) else str(units)).strip()


def _classic(path: str) -> dict[str, _Variable]:
    from scipy.io import netcdf_file

    with reading(f"flow file {path}"), netcdf_file(path, "r", mmap=False, maskandscale=True) as file:
        return {
            name: _Variable(np.ma.filled(each[:].astype(float), np.nan), each.dimensions, dict(each._attributes))
            for name, each in file.variables.items()
        }


def _dataset(path: str) -> dict[str, _Variable]:
    try:
        import xarray
    except ImportError as error:
        raise ValueError(
            f"flow file {path} must be netCDF of the classic format, or xarray must be installed"
        ) from error
    with reading(f"flow file {path}"), xarray.open_dataset(path) as opened:
        return {str(name): _Variable.of(each) for name, each in opened.variables.items()}
