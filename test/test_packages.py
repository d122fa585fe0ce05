# SPDX-License-Identifier: Apache-2.0
"""The packages as colcon and rosdep see them: manifests name what the sources import, executables in place."""

import ast
import os
import re
import subprocess
import sys
import tomllib
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
from eel_common.topics import GLOBAL, OWN

ROOT = Path(__file__).resolve().parents[1]
PYTHON_PACKAGES = ("eel_common", "eel_gaits", "eel_dynamics", "eel_studies", "eel_gym", "eel_viz")
EXECUTABLES = {
    "eel_common": {"eel"},
    "eel_gaits": {"gait_generator", "heading_controller", "pilot"},
    "eel_dynamics": {"dynamics", "simulate"},
    "eel_studies": {
        "identify",
        "motors",
        "optimise",
        "sweep",
        "stability",
        "terms",
        "tradeoff",
    },
    "eel_viz": {"visualiser", "markers", "record", "eel_echo", "replay", "render"},
}
ROSDEP_KEY = {
    "eel_command": "eel_common",  # lies beside it
    "numpy": "python3-numpy",
    "scipy": "python3-scipy",
    "matplotlib": "python3-matplotlib",
    "yaml": "python3-yaml",
    "PIL": "python3-pil",
    "rosbags": "python3-rosbags-pip",
}
with (ROOT / "pyproject.toml").open("rb") as settings:
    CONTRACTS = tomllib.load(settings)["tool"]["importlinter"]["contracts"]
(MAY_IMPORT_ROS,) = (each["allowed_importers"] for each in CONTRACTS if each["type"] == "protected")
# Used where it is installed:
OPTIONAL = {
    "argcomplete",
    "rich_argparse",
    "pytest",
    "dask",
    "distributed",
    "h5py",
    "eel_viz",
    "gymnasium",
    "stable_baselines3",
    "xarray",
}  # used where it is installed
FROM_REQUIREMENTS = {
    "rerun",
    "rerun_bindings",
    "mcap",
    "pyarrow",
    "zstandard",
    "lz4",
}  # no rosdep key: requirements.txt brings them (pyarrow and rerun_bindings with rerun, zstandard and lz4 with mcap)


def imported_modules(package: str, *, but: str = "") -> set[str]:
    """Top-level names that a package's sources import, without Python's own and its own. but: a folder left out."""
    found = set()
    folder = ROOT / "src" / package / package
    for path in folder.rglob("*.py"):
        if path.relative_to(folder).parts[0] == but:
            continue
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Import):
                found |= {alias.name.split(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.level == 0:
                found.add(node.module.split(".")[0])
    return found - set(sys.stdlib_module_names) - {package}


def manifest(package: str) -> ElementTree.Element:
    return ElementTree.parse(ROOT / "src" / package / "package.xml").getroot()


@pytest.mark.parametrize("package", PYTHON_PACKAGES)
def test_manifest_names_what_the_sources_import(package):
    declared = {node.text for node in manifest(package) if node.tag in ("depend", "exec_depend")}
    needed = {ROSDEP_KEY.get(name, name) for name in imported_modules(package) - FROM_REQUIREMENTS - OPTIONAL} - {
        package
    }
    if package == "eel_viz":  # it finds the types of topics by their names
        needed |= {kind.partition("/")[0] for kind in (*OWN.values(), *GLOBAL.values())}
    assert needed <= declared, f"package.xml of {package} lacks {sorted(needed - declared)}"
    unused = declared - needed
    assert not unused, f"package.xml of {package} names {sorted(unused)}, which nothing imports"


def with_dependencies(package: str, *, tests: bool = False) -> set[str]:
    """The package and those of the suite that it depends on; those of its tests too."""
    tags = ("depend", "exec_depend", "test_depend") if tests else ("depend", "exec_depend")
    named = {node.text for node in manifest(package) if node.tag in tags and node.text.startswith("eel_")}
    return {package}.union(*map(with_dependencies, named))


@pytest.mark.parametrize("package", (*PYTHON_PACKAGES, "eel_core"))
def test_tests_of_a_package_import_it_and_its_dependencies_alone(package):
    """`make alone` runs them."""
    paths = (ROOT / "src" / package / "test").glob("*.py")
    imported = {
        name.split(".")[0]
        for path in paths
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, (ast.Import, ast.ImportFrom))
        for name in ([alias.name for alias in node.names] if isinstance(node, ast.Import) else [node.module or ""])
    }
    others = {name for name in imported if name.startswith("eel_")} - {"eel_command"}
    assert others <= with_dependencies(package, tests=True)


@pytest.mark.parametrize("package", (*PYTHON_PACKAGES, "eel_core", "eel_msgs"))
def test_manifest_is_valid(package):
    from catkin_pkg.package import parse_package

    parsed = parse_package(str(ROOT / "src" / package))
    assert parsed.name == package
    assert parsed.licenses == ["Apache-2.0"]


@pytest.mark.parametrize("package", (*PYTHON_PACKAGES, "eel_core", "eel_msgs"))
def test_package_carries_its_licence_address_and_author(package):
    assert (ROOT / "src" / package / "LICENSE").read_bytes() == (ROOT / "LICENSE").read_bytes()
    root = manifest(package)
    assert root.find("license").get("file") == "LICENSE"
    assert root.find("url").text.startswith("https://") and root.find("author").text == root.find("maintainer").text


@pytest.mark.parametrize("package", EXECUTABLES)
def test_executables_lie_where_ros2_run_looks(package):
    from ament_index_python.packages import get_package_prefix

    folder = Path(get_package_prefix(package)) / "lib" / package
    executables = {path.name for path in folder.iterdir() if os.access(path, os.X_OK)}
    assert executables == EXECUTABLES[package]
    for path in folder.iterdir():
        first, second = path.read_text().splitlines()[:2]
        interpreter = first.removeprefix("#!")
        if first == "#!/bin/sh":  # of `make build`
            interpreter = re.fullmatch(r"'''exec' (?:env --block-signal=INT )?'(.*)' \"\$0\" \"\$@\"", second)[1]
        assert Path(interpreter).samefile(sys.executable)


def test_every_message_field_is_commented_with_its_unit():
    for path in (ROOT / "src/eel_msgs/msg").glob("*.msg"):
        for line in path.read_text().splitlines():
            declaration, _, comment = line.partition("#")
            is_constant = "=" in declaration  # its field says what it counts
            if declaration.strip() and not is_constant and not declaration.startswith((" ", "uint8", "string")):
                assert "[" in comment or declaration.startswith("std_msgs/Header"), f"{path.name}: {line}"


@pytest.mark.parametrize("package", PYTHON_PACKAGES)
def test_library_imports_without_ros(package):
    """Everything but the nodes and the message glue runs where there is no ROS at all."""
    folder = ROOT / "src" / package
    paths = [path.relative_to(folder).with_suffix("") for path in (folder / package).rglob("[!_]*.py")]
    names = {package, *(".".join(path.parts) for path in paths)} - {"eel_gym.stable_baselines"}  # for who has that
    modules = {name for name in names if not any(f"{name}.".startswith(f"{each}.") for each in MAY_IMPORT_ROS)}
    assert len(modules) > 4
    blocked = [
        "rclpy",
        "eel_common.ros",
        "eel_msgs",
        "std_msgs",
        "geometry_msgs",
        "rcl_interfaces",
        "builtin_interfaces",
        "nav_msgs",
    ]
    code = f"import sys\nfor name in {blocked!r}: sys.modules[name] = None\nimport {', '.join(sorted(modules))}"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr


def test_way_points_are_drawn_as_wide_as_the_pilot_takes_them_as_reached():
    from eel_gaits.pilot.settings import PilotSettings
    from eel_viz.settings import Settings

    assert Settings().reach == PilotSettings.reach


def test_a_message_is_parsed_once_in_a_build(tmp_path, monkeypatch):
    from rosidl_parser import parser

    monkeypatch.chdir(tmp_path)
    definition = "module a { module msg { struct B { double x; }; }; };"
    parsed = parser.get_ast_from_idl_string(definition)
    assert list(tmp_path.iterdir()) == []  # not in any folder
    (tmp_path / "CMakeCache.txt").touch()
    assert parser.get_ast_from_idl_string(definition) == parsed
    monkeypatch.setattr(parser, "_parser", "nothing that parses")
    assert parser.get_ast_from_idl_string(definition) == parsed
    with pytest.raises(AttributeError, match="parse"):
        parser.get_ast_from_idl_string(definition.replace("double", "float"))
