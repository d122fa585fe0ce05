# SPDX-License-Identifier: Apache-2.0
"""Contents of runs and batches as netCDF files (classic format, 64-bit offsets), with SciPy only.

xarray, and other programs that read netCDF, can open the files too. Data other than arrays (law, body, scene, settings,
...) are a JSON text in the attribute `eel`.
"""

import json
import os
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from eel_common.files.input_file import InputFile, from_json, reading
from eel_common.files.output_file import check_output, replacing
from eel_common.version import software
from eel_common.wording import shown

from eel_dynamics.model.axes import CONVENTIONS, PAPER, REP103
from eel_dynamics.runs.storage.digest import add_digest, check_digest
from eel_dynamics.runs.storage.run_contents import in_rep103_axes
from eel_dynamics.runs.storage.variables import LABELS, OF_SWIMMERS, VARIABLES, Contents, variable_of

FORMAT = 2  # of the files; format 1 has the paper's axes without naming them; later formats cannot be read
MOST_BYTES = 2**31 - 4  # of an array in a file
SUFFIX = ".nc"


def attributes_of(contents: Contents) -> dict[str, Any]:
    """The attributes of a file, and of labelled arrays."""
    return {
        "software": software(),
        "kind": contents.kind,
        "format": FORMAT,
        "axes": contents.axes,
        "eel": json.dumps(contents.values),
    }


def write(contents: Contents, path: Any) -> None:
    """Write `contents` to the file `path`, which gets its name when it is complete.

    `ValueError` for a bad path or contents; `NotWritten` if the file cannot be completed.
    """
    from scipy.io import netcdf_file

    if not isinstance(path, (str, os.PathLike)) or Path(path).suffix != SUFFIX:
        raise ValueError(f"path must be a path that ends in {SUFFIX}, got {shown(path)}")
    check_output("path", path)
    path, sizes, attributes = Path(path), sizes_of(contents), attributes_of(contents)
    from_json(attributes["eel"])  # check that it can be loaded
    for name, values in contents.arrays.items():
        if values.nbytes > MOST_BYTES:
            raise ValueError(
                f"{name} must have at most {MOST_BYTES / 1e9:.3g} GB to be saved, got {values.nbytes / 1e9:.3g} GB: "
                "take fewer samples or stations"
            )
    with replacing(path) as draft, netcdf_file(draft, "w", version=2, mmap=False) as file:
        for name, value in attributes.items():
            setattr(file, name, value.encode() if isinstance(value, str) else value)
        for name, size in sizes.items():
            file.createDimension(name, size)
        for name, values in contents.arrays.items():
            about = variable_of(contents.kind, name)
            whole = values.dtype.kind != "f" and values.max(initial=0) < 2**31
            variable = file.createVariable(name, "i4" if whole else "f8", about.dimensions)
            variable[...] = values
            variable.units, variable.long_name = about.unit.encode(), about.description.encode()
        add_digest(file)


def read(path: Any, kind: str) -> Contents:
    """The contents of a file that `write` made for a `kind` ("run" or "batch").

    `ValueError` in one line for a file that is truncated, damaged, foreign, a sweep, of another version or kind.
    """
    from scipy.io import netcdf_file

    if not isinstance(path, (str, os.PathLike)):
        raise ValueError(f"path must be that of a {SUFFIX} file, got {shown(path)}")
    named = f"{kind} file {shown(os.fspath(path))}"
    problem = f"{named} cannot be read"
    with reading(problem), InputFile(path) as content, netcdf_file(content, "r", mmap=False) as file:
        about: dict[str, Any] = {name: getattr(file, name, None) for name in ("software", "kind", "format", "eel")}
        of_sweep = about["kind"] is None and hasattr(file, "sweep")
        known = () if of_sweep else (*VARIABLES, *OF_SWIMMERS)
        ours = {name: file.variables[name] for name in known if name in file.variables}
        axes = getattr(file, "axes", PAPER.encode())
        arrays = {name: np.asarray(each.data) for name, each in ours.items()}
        arrays = {name: each.astype(float if each.dtype.kind == "f" else int) for name, each in arrays.items()}
        if not of_sweep and None not in about.values():
            check_digest(file, named)
    if of_sweep:
        raise ValueError(f"{named} holds a sweep, not a {kind}: xarray.open_dataset opens it")
    if None in about.values():
        raise ValueError(f"{named} is no {kind} of eel_dynamics")
    with reading(named):
        if about["format"] not in range(1, FORMAT + 1):
            writer = about["software"].decode(errors="replace")
            raise ValueError(f"{named} has format {about['format']}, of {writer}; {software()} reads up to {FORMAT}")
        if about["kind"].decode() != kind:
            raise ValueError(f"{named} holds a {about['kind'].decode()}, not a {kind}")
    with reading(problem):
        contents = Contents(kind, from_json(about["eel"]), arrays, axes.decode())
        sizes_of(contents)
        if contents.axes not in CONVENTIONS:
            raise ValueError(f"its axes must be {' or '.join(CONVENTIONS)}, got {shown(contents.axes)}")
    return contents


def loaded(path: Any, kind: str, made: Callable[[Contents], Any]) -> Any:
    """`made(contents)` of the file `path`. `ValueError` in one line, as in `read`, if they do not fit together."""
    contents, named = read(path, kind), f"{kind} file {shown(os.fspath(path))}"
    if contents.axes != REP103:
        warnings.warn(f"{named} has the paper's axes, which are converted to those of REP-103", stacklevel=3)
    with reading(f"{named} cannot be read"):
        return made(in_rep103_axes(contents))


def sizes_of(contents: Contents) -> dict[str, int]:
    """Length of each dimension. `ValueError` if arrays disagree, or are empty."""
    sizes: dict[str, int] = {}
    for name, values in contents.arrays.items():
        dimensions, shape = variable_of(contents.kind, name).dimensions, values.shape
        fit = len(dimensions) == len(shape) and values.size
        for dimension, size in zip(dimensions, shape, strict=False):
            fit = fit and size == sizes.setdefault(dimension, len(LABELS.get(dimension, ())) or size)
        if not fit:
            raise ValueError(f"{name} must have the shape ({', '.join(dimensions)}), got {values.shape}")
    return sizes
