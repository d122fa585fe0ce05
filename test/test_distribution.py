# SPDX-License-Identifier: Apache-2.0
"""The distribution eel-swimmer by its lists in pyproject.toml: all of the library is in it, and one version everywhere.

`make wheels ARGS=test` builds it and installs it on a bare machine.
"""

import os
import re
import subprocess
import sys
import tomllib
from importlib.metadata import PackageNotFoundError, distributions
from pathlib import Path

import pytest
from eel_common.command import suite
from test_packages import PYTHON_PACKAGES, imported_modules, manifest

from eel_common import version

ROOT = Path(__file__).resolve().parents[1]
LIBRARY = (*PYTHON_PACKAGES, "eel_core")
BROUGHT_BY = {  # imported name: what pip installs, or what of the extras brings it
    "yaml": "PyYAML",
    "PIL": "pillow",
    "rerun": "rerun-sdk",
    "rerun_bindings": "rerun-sdk",
    "pyarrow": "rerun-sdk",
    "zstandard": "mcap",
    "lz4": "mcap",
}
OF_NO_EXTRA = {"argcomplete", "rich_argparse", "stable_baselines3"}  # who wants them installs them
OF_ROS = {"ament_index_python"}  # for bags without definitions, where ROS is
with (ROOT / "pyproject.toml").open("rb") as settings:
    TABLES = tomllib.load(settings)
PROJECT, BUILD = TABLES["project"], TABLES["tool"]["scikit-build"]


def names_of(requirements: list[str]) -> set[str]:
    return {re.match(r"[\w.-]+", each)[0] for each in requirements}


def library_imports(package: str) -> set[str]:
    """What a package of the library imports of others, but for its nodes."""
    return imported_modules(package, but="ros")


def test_wheels_have_every_package_of_the_library():
    files = {Path(path) for path in BUILD["wheel"]["packages"]}
    assert files == {Path("src", name, name) for name in LIBRARY} | {Path("src/eel_common/eel_command.py")}
    assert all((ROOT / path).exists() for path in files)
    tops = {path.name for path in ROOT.glob("src/*/*.py")} - {"setup.py"}
    assert tops == {"eel_command.py"}, "a module beside a package is in no wheel"


def test_entry_points_are_those_of_the_packages():
    """But for what needs ROS, and for the executables: `eel` has their commands."""
    declared: dict[str, dict[str, str]] = {}
    for each in distributions():
        if each.name in PYTHON_PACKAGES:
            for entry in each.entry_points:
                if entry.group != "console_scripts" and ".ros." not in entry.value:
                    declared.setdefault(entry.group, {})[entry.name] = entry.value
    assert len(declared) > 5
    assert PROJECT["entry-points"] == declared
    assert PROJECT["scripts"] == {"eel": "eel_command:main_of.eel_common.command.suite"}


def test_dependencies_and_extras_bring_all_that_is_imported():
    imported = set().union(*map(library_imports, LIBRARY)) - set(LIBRARY) - {"eel_command"} - OF_NO_EXTRA - OF_ROS
    extras = PROJECT["optional-dependencies"]
    brought = names_of(PROJECT["dependencies"]).union(*map(names_of, extras.values()))
    assert {BROUGHT_BY.get(name, name) for name in imported} - {"pytest"} <= brought
    assert {"viz", "gym", "films"} <= set(extras)
    pinned = re.search(r"^rerun-sdk==.*$", (ROOT / "requirements.in").read_text(), re.MULTILINE)[0]
    assert pinned in extras["viz"]


def test_extras_that_errors_name_exist():
    named = {
        extra
        for path in (ROOT / "src").glob("*/eel_*/**/*.py")
        for extra in re.findall(r"eel-swimmer\[(\w+)\]", path.read_text())
    }
    assert named and named <= set(PROJECT["optional-dependencies"])


def test_one_version_is_everywhere():
    assert re.fullmatch(r"\d+\.\d+\.\d+", version.VERSION)
    (metadata,) = TABLES["tool"]["dynamic-metadata"]
    found = re.search(metadata["regex"], (ROOT / metadata["input"]).read_text())["value"]
    cited = re.search(r"^version: (.*)$", (ROOT / "CITATION.cff").read_text(), re.MULTILINE)[1]
    manifests = {manifest(package).findtext("version") for package in (*PYTHON_PACKAGES, "eel_core", "eel_msgs")}
    installed = {each.version for each in distributions() if each.name in PYTHON_PACKAGES}
    assert {found, cited} | manifests | installed == {version.VERSION}
    assert f"eel_swimmer-{version.VERSION}-" in (ROOT / "docs/howto/install.md").read_text()
    for package in (*PYTHON_PACKAGES, "eel_core", "eel_msgs"):
        assert f"\n{version.VERSION} (" in (ROOT / "src" / package / "CHANGELOG.rst").read_text()
    assert f"## {version.VERSION}" in (ROOT / "CHANGELOG.md").read_text()


def test_an_archive_knows_its_commit():
    """`git archive` writes it, and what is built of the archive has it."""
    path = Path(version.__file__).resolve().relative_to(ROOT)
    done = subprocess.run(["git", "-C", ROOT, "archive", "--format=tar", "HEAD", path], capture_output=True)
    if done.returncode:
        pytest.skip("not a git checkout")
    head = subprocess.run(["git", "-C", ROOT, "rev-parse", "HEAD"], capture_output=True, text=True).stdout.strip()
    (archived,) = re.findall(rb'ARCHIVED = "(\w+)"', done.stdout)
    assert len(archived) > 6 and head.startswith(archived.decode())


def test_a_copy_without_git_tells_no_commit_of_the_repository_around_it(tmp_path):
    """As an environment in a checkout of somebody's own."""
    subprocess.run(["git", "init", "--quiet", tmp_path], check=True)
    folder = tmp_path / "env/lib/python3/site-packages/eel_common"
    folder.mkdir(parents=True)
    (folder / "version.py").write_bytes(Path(version.__file__).read_bytes())
    code = "import version; print(version.commit())"
    done = subprocess.run([sys.executable, "-c", code], cwd=folder, capture_output=True, text=True, timeout=60)
    assert done.stdout.strip() == version.UNKNOWN, done.stderr


def test_the_version_is_told(capsys, monkeypatch):
    monkeypatch.setenv("ROS_DISTRO", "jazzy")
    assert suite.main(["--version"]) == 0
    first, core, python, ros = capsys.readouterr().out.splitlines()
    assert first == version.software() and first.startswith(f"eel-swimmer {version.VERSION} (")
    assert re.match(r"core: (x86-64-v[234]|aarch64), (GCC|Clang) ", core)
    assert python.startswith(f"Python 3.{sys.version_info.minor}.") and ros == "ROS 2 jazzy"


@pytest.mark.skipif(os.uname().machine != "x86_64", reason="levels are those of x86-64")
def test_the_version_is_told_where_the_mechanics_cannot_be_loaded(monkeypatch, capsys):
    monkeypatch.setattr("eel_core.build_info", lambda: (_ for _ in ()).throw(ImportError("this processor\nis too old")))
    assert suite.main(["--version"]) == 0
    assert "core: this processor is too old" in " ".join(capsys.readouterr().out.split("\n")[1].split())


@pytest.mark.parametrize("installed", [False, True])
def test_a_command_that_cannot_be_imported_is_one_line(installed, monkeypatch, capsys):
    """A hint names eel-swimmer only where it is installed: pip would not find it elsewhere."""
    known = {"eel-swimmer": version.VERSION} if installed else {}

    def version_of(name):
        if name not in known:
            raise PackageNotFoundError(name)
        return known[name]

    monkeypatch.setattr("eel_common.wording.version", version_of)
    monkeypatch.setitem(sys.modules, "rosbags.rosbag2", None)
    monkeypatch.delitem(sys.modules, "eel_viz.bags.bag", raising=False)
    monkeypatch.delitem(sys.modules, "eel_viz.bags.replay", raising=False)
    assert suite.main(["replay", "bag"]) == 2
    said = capsys.readouterr().err
    assert said.startswith("eel replay: ") and said.count("\n") == 1
    brings = "'eel-swimmer[viz]'" if installed else "-r requirements.txt (of this project)"
    assert "rosbags" in said and said.rstrip().endswith(f"; pip install {brings} brings it")
