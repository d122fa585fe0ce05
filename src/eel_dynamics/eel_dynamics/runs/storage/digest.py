# SPDX-License-Identifier: Apache-2.0
"""The digest of a netCDF file: SHA-256 of its whole content, as a text in its attribute `digest`.

A file whose content has changed since it was saved does not match its digest. Nor does a file that xarray or another
program has rewritten; without the attribute `digest` it can be read, with a warning.
"""

import hashlib
import warnings
from typing import Any

import numpy as np

ATTRIBUTE = "digest"


def add_digest(file: Any) -> None:
    """Add its digest to an open `scipy.io.netcdf_file` that is otherwise complete."""
    setattr(file, ATTRIBUTE, digest_of(file).encode())


def check_digest(file: Any, named: str) -> None:
    """`ValueError` if the open file does not match its digest; a warning, in which it is `named`, without a digest."""
    written = getattr(file, ATTRIBUTE, None)
    if written is None:
        warnings.warn(f"{named} has no digest, as older ones: damage to it would not be seen", stacklevel=5)
    elif written != digest_of(file).encode():
        raise ValueError("it is damaged, or was changed since it was saved: its content does not fit its digest")


def digest_of(file: Any) -> str:
    """The digest, 64 hexadecimal digits, of the dimensions, attributes and variables of an open file."""
    content = hashlib.sha256(repr((list(file.dimensions.items()), _attributes(file))).encode())
    for name, variable in sorted(file.variables.items()):
        data = np.ascontiguousarray(variable.data)
        content.update(repr((name, variable.dimensions, data.dtype.str, data.shape, _attributes(variable))).encode())
        content.update(data.data)
    return content.hexdigest()


def _attributes(held: Any) -> list[Any]:
    """Attributes of a file or a variable, without the digest, as plain values: equal after writing and reading."""
    return sorted((name, _plain(value)) for name, value in held._attributes.items() if name != ATTRIBUTE)


def _plain(value: Any) -> Any:
    if isinstance(value, str):
        value = value.encode()
    return value if isinstance(value, bytes) else np.asarray(value).tolist()
