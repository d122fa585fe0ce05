# SPDX-License-Identifier: Apache-2.0
"""Contents of runs and batches as labelled arrays (xarray) and tables (pandas, .csv).

Only the functions for xarray and pandas need these packages.
"""

import csv
from collections.abc import Iterable, Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
from eel_common.files.output_file import replacing

from eel_dynamics.runs.storage.netcdf import attributes_of
from eel_dynamics.runs.storage.variables import LABELS, LEDGER, Contents, variable_of

COLUMNS = {"position": "xyz", "orientation": "xyzw", "center_of_mass": "xyz"}


def needed(name: str, by: str) -> Any:
    """The module `name`, which `by` needs. `ImportError` tells how to install it."""
    try:
        return import_module(name)
    except ImportError as error:
        raise ImportError(f"{by} needs {name} ({error}); install it with: pip install {name}") from None


def dataset_of(contents: Contents) -> Any:
    """An `xarray.Dataset` of all arrays, with units, and the file's attributes."""
    xarray = needed("xarray", "to_xarray")
    variables = {}
    for name, values in contents.arrays.items():
        about = variable_of(contents.kind, name)
        variables[name] = about.dimensions, values, {"units": about.unit, "long_name": about.description}
    used = {dimension for dimensions, *_ in variables.values() for dimension in dimensions}
    coordinates: dict[str, Any] = {name: variables.pop(name) for name in ("time", "x")}
    coordinates |= {name: list(labels) for name, labels in LABELS.items() if name in used}
    return xarray.Dataset(variables, coordinates, attributes_of(contents))


def columns_of(run: Any) -> dict[str, np.ndarray]:
    """The columns (T,) of a run's table by name: time, head, centre of mass, and the ledger if there is one."""
    columns = {"time": run.time}
    columns |= {
        f"{name}_{axis}": getattr(run, name)[:, k] for name, axes in COLUMNS.items() for k, axis in enumerate(axes)
    }
    columns |= {name: run.twist[:, k] for k, name in enumerate(LABELS["component"])}
    return columns | ({} if run.energy is None else {name: run.energy[name] for name in LEDGER})


def write_columns(columns: Mapping[str, Any], path: Path) -> None:
    """Write `columns`, (n,) each by name, as a table (.csv). `NotWritten` if it cannot be completed."""
    with replacing(path) as draft, draft.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows(zip(*(np.asarray(values).tolist() for values in columns.values()), strict=True))


def frame_of(run: Any) -> Any:
    """A `pandas.DataFrame` of `columns_of` a run, by time."""
    frame = needed("pandas", "to_dataframe").DataFrame(columns_of(run)).set_index("time")
    frame.attrs["axes"] = run.axes
    return frame


def frame_of_all(runs: Iterable[Any]) -> Any:
    """The frames of several runs, one below the other, by swimmer and time."""
    pandas = needed("pandas", "to_dataframe")
    return pandas.concat({index: frame_of(run) for index, run in enumerate(runs)}, names=["swimmer"])
