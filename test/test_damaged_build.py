# SPDX-License-Identifier: Apache-2.0
"""A damaged library of the messages is one line that names it and the command that repairs it."""

import os
import shutil
from pathlib import Path

import pytest
from ament_index_python.packages import get_package_prefix


@pytest.mark.fault(
    "names",
    "a damaged or missing library of the messages in the build",
    "the node does not start (status 2): one line that names the command that repairs it",
)
@pytest.mark.parametrize(
    ("name", "variable"),
    [
        ("libeel_msgs__rosidl_typesupport_fastrtps_c.so", "LD_LIBRARY_PATH"),
        ("eel_msgs_s__rosidl_typesupport_c.so", "PYTHONPATH"),
    ],
)
def test_a_damaged_library_is_named_with_what_repairs_it(name, variable, start, tmp_path, monkeypatch):
    (library,) = Path(get_package_prefix("eel_msgs")).rglob(name)
    package = tmp_path / "copy" / library.parent.name
    shutil.copytree(library.parent, package)
    (package / name).write_bytes(b"no library")
    first = package if variable == "LD_LIBRARY_PATH" else package.parent
    monkeypatch.setenv(variable, f"{first}:{os.environ[variable]}")
    for executable in ("gait_generator", "dynamics"):
        node = start(executable)
        assert node.wait(90.0) == 2
        line = node.output().splitlines()[-1]
        assert line.startswith(f"{executable}: a library of the messages is damaged") and "make clean build" in line
