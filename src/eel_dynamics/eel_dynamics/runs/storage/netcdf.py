# SPDX-License-Identifier: Apache-2.0
"""Contents of runs and batches as netCDF files (classic format, 64-bit offsets), by SciPy alone.

xarray, and whatever else reads netCDF, opens the files too. What no array holds (law, body, scene, settings, ...) is a
JSON text in the attribute `eel`.
"""

import json
import os
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import numpy as np
from eel_gaits.input_output.output_file import check_output, replacing
from eel_gaits.input_output.wording import one_line, shown

from eel_dynamics.runs.storage.digest import add_digest, check_digest
from eel_dynamics.runs.storage.variables import LABELS, Contents

FORMAT = 1  # of the files; another number cannot be read
MOST_BYTES = 2**31 - 4  # of an array in a file
SUFFIX = ".nc"


def software() -> str:
    """Name and version of this package."""
    try:
        return f"eel_dynamics {version('eel_dynamics')}"
    except PackageNotFoundError:
        return "eel_dynamics"


def attributes_of(contents: Contents) -> dict:
    """The attributes of a file, and of labelled arrays."""
    return {"software": software(), "kind": contents.kind, "format": FORMAT, "eel": json.dumps(contents.values)}


def checked_path(argument: str, path) -> Path:
    """`path`, where a file can be written. `ValueError` names the `argument`."""
    if not isinstance(path, (str, os.PathLike)) or Path(path).suffix != SUFFIX:
        raise ValueError(f"{argument} must be a path that ends in {SUFFIX}, got {shown(path)}")
    check_output(argument, path)
    return Path(path)


def write(contents: Contents, path) -> None:
    """Write `contents` to the file `path`, which has its name when it is complete.

    `ValueError` where the path or the contents do not fit; `NotWritten` where the file cannot be completed.
    """
    from scipy.io import netcdf_file

    path, sizes = checked_path("path", path), sizes_of(contents)
    for name, values in contents.arrays.items():
        if values.nbytes > MOST_BYTES:
            raise ValueError(
                f"{name} must have at most {MOST_BYTES / 1e9:.3g} GB to be saved, got {values.nbytes / 1e9:.3g} GB: "
                "take fewer samples or stations"
            )
    with replacing(path) as draft, netcdf_file(draft, "w", version=2, mmap=False) as file:
        for name, value in attributes_of(contents).items():
            setattr(file, name, value.encode() if isinstance(value, str) else value)
        for name, size in sizes.items():
            file.createDimension(name, size)
        for name, values in contents.arrays.items():
            about = contents.variable(name)
            variable = file.createVariable(
                name, "f8" if values.dtype.kind == "f" else _integer(values), about.dimensions
            )
            variable[...] = values
            variable.units, variable.long_name = about.unit.encode(), about.description.encode()
        add_digest(file)


def read(path, kind: str) -> Contents:
    """The contents of a file that `write` made of a `kind` ("run" or "batch").

    `ValueError` in one line for a file that is truncated, damaged, foreign, a sweep, of another version or kind.
    """
    from scipy.io import netcdf_file

    if not isinstance(path, (str, os.PathLike)):
        raise ValueError(f"path must be that of a {SUFFIX} file, got {shown(path)}")
    named = f"{kind} file {shown(os.fspath(path))}"
    try:
        if not Path(path).is_file():
            raise ValueError("it is a folder" if Path(path).is_dir() else "there is no such file")
        with netcdf_file(os.fspath(path), "r", mmap=False) as file:
            about = {name: getattr(file, name, None) for name in ("software", "kind", "format", "eel")}
            of_sweep = about["kind"] is None and hasattr(file, "sweep")
            variables = {} if of_sweep else file.variables
            arrays = {name: _native(np.asarray(each.data)) for name, each in variables.items()}
            if not of_sweep and None not in about.values():
                check_digest(file, named)
    except Exception as error:  # SciPy raises nearly anything for a damaged file
        raise ValueError(f"{named} cannot be read: {_reason(error)}") from None
    if of_sweep:
        raise ValueError(f"{named} holds a sweep, not a {kind}: xarray.open_dataset opens it")
    if None in about.values():
        raise ValueError(f"{named} is no {kind} of eel_dynamics")
    if about["format"] != FORMAT:
        told = about["software"].decode(errors="replace")
        raise ValueError(f"{named} has format {about['format']}, of {told}; {software()} reads format {FORMAT}")
    if about["kind"].decode() != kind:
        raise ValueError(f"{named} holds a {about['kind'].decode()}, not a {kind}")
    try:
        return Contents(kind, json.loads(about["eel"]), arrays)
    except ValueError as error:
        raise ValueError(f"{named} cannot be read: {_reason(error)}") from None


def loaded(path, kind: str, made):
    """`made(contents)` of the file `path`. `ValueError` in one line, as in `read`, where they do not fit together."""
    contents = read(path, kind)
    try:
        return made(contents)
    except (KeyError, TypeError, ValueError, IndexError, AttributeError) as error:
        raise ValueError(f"{kind} file {shown(os.fspath(path))} cannot be read: {_reason(error)}") from None


def sizes_of(contents: Contents) -> dict[str, int]:
    """Length of each dimension."""
    sizes = {}
    for name, values in contents.arrays.items():
        sizes |= dict(zip(contents.variable(name).dimensions, values.shape, strict=True))
    return {name: len(LABELS.get(name, ())) or size for name, size in sizes.items()}


def _integer(values: np.ndarray) -> str:
    return "i4" if values.max(initial=0) < 2**31 else "f8"


def _native(values: np.ndarray) -> np.ndarray:
    return values.astype(float) if values.dtype.kind == "f" else values.astype(int)


def _reason(error: Exception) -> str:
    return one_line(error) or type(error).__name__
