# SPDX-License-Identifier: Apache-2.0
"""Files of flows, whose velocities are spread over the dimensions that they do not have."""

import h5py
import numpy as np
from scipy.io import netcdf_file

DIMS = {"u": ("time", "x"), "v": ("y", "z")}
AXES = "time", "x", "y", "z"


def write_flow(path, count):
    """A small file of `count` points along each of four axes: netCDF of the classic format (.nc), or HDF5."""
    if path.suffix == ".nc":
        with netcdf_file(path, "w") as file:
            for name in AXES:
                file.createDimension(name, count)
                file.createVariable(name, "f", (name,))[:] = np.arange(count)
            for name, along in DIMS.items():
                file.createVariable(name, "f", along)[:] = 0.1
        return
    with h5py.File(path, "w") as file:
        for name in AXES:
            file[name] = np.arange(float(count))
            file[name].make_scale(name)
        for name, along in DIMS.items():
            file[name] = np.full((count, count), 0.1)
            for place, axis in enumerate(along):
                file[name].dims[place].attach_scale(file[axis])
