# SPDX-License-Identifier: Apache-2.0
"""The compiled module is chosen for the processor before it is imported; where none suits, one line says so."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from eel_core.levels import suitable_levels

import eel_core
from eel_core import built, processor

PACKAGE = Path(eel_core.__file__).parent
V2 = frozenset(processor.FEATURES["v2"])
V3 = V2 | processor.FEATURES["v3"]
V4 = V3 | processor.FEATURES["v4"]
x86_64_only = pytest.mark.skipif(not processor.is_x86_64(), reason="levels are those of x86-64")


@pytest.mark.parametrize(
    ("features", "levels"),
    [
        (V4, ["v4", "v3", "v2"]),
        (V3, ["v3", "v2"]),
        (V4 - {"fma"}, ["v2"]),
        (V2 - {"popcnt"}, []),
        (frozenset(), ["v2"]),  # /proc/cpuinfo does not tell
    ],
)
def test_level_needs_all_features_of_the_levels_below(features, levels):
    assert processor.levels(features | {"sse2"} if features else features) == levels


@pytest.mark.parametrize(
    ("built_levels", "features", "chosen"),
    [
        (["v2", "v3", "v4"], V4, ["v4", "v3", "v2"]),
        (["v2", "v3", "v4"], V3, ["v3", "v2"]),
        (["v3"], V4, ["v3"]),
        (["v4"], V3, []),
    ],
)
def test_highest_level_that_is_built_and_runs_comes_first(built_levels, features, chosen):
    assert suitable_levels(built_levels, features, frozenset()) == chosen


def test_native_module_is_chosen_only_on_a_processor_with_all_features_of_its_own():
    assert suitable_levels(["native", "v2"], V3 | {"vaes"}, V3) == ["native", "v2"]
    assert suitable_levels(["native", "v2"], V3, V3 | {"vaes"}) == ["v2"]


@x86_64_only
def test_module_is_of_the_level_that_the_processor_reaches():
    highest = processor.levels(processor.features())[0]
    assert (highest,) == built.LEVELS
    assert eel_core.build_info()["level"] == f"x86-64-{highest}"


def test_names_in_the_module_do_not_tell_its_level():
    assert eel_core.build_info.__module__ == "eel_core._core"
    assert sys.modules["eel_core._core"] is eel_core._core


@pytest.fixture
def copy(tmp_path):
    """copy(**environment) imports a copy of the package. A test may change the files in copy.folder."""
    folder = tmp_path / "eel_core"
    shutil.copytree(PACKAGE, folder, ignore=shutil.ignore_patterns("__pycache__"))

    def import_copy(**environment):
        code = f"import sys; sys.path.insert(0, {str(tmp_path)!r}); import eel_core; print(eel_core.__file__)"
        return subprocess.run(
            [sys.executable, "-I", "-c", code], env=environment, capture_output=True, text=True, timeout=60
        )

    import_copy.folder = folder
    return import_copy


def last_line(done: subprocess.CompletedProcess) -> str:
    assert done.returncode == 1
    return done.stderr.splitlines()[-1]


def with_processor(folder: Path, features: frozenset[str]) -> None:
    """Let a copy of the package, or a script, find a /proc/cpuinfo of a processor with these `features`."""
    (folder / "cpuinfo").write_text(f"processor\t: 0\nflags\t\t: {' '.join(sorted(features))}\n")
    source = folder / "processor.py"
    source.write_text(source.read_text().replace('"/proc/cpuinfo"', repr(str(folder / "cpuinfo"))))


@x86_64_only
def test_module_for_another_processor_names_the_option(copy):
    with_processor(copy.folder, V2)
    copy.folder.joinpath("built.py").write_text('LEVELS = ("v4",)\nNATIVE_FEATURES = frozenset()\n')
    line = last_line(copy())
    assert line.startswith("ImportError: eel_core was built for v4, this processor is x86-64 v2")
    assert '-DEEL_CORE_LEVELS="v2;v3;v4"' in line


@x86_64_only
def test_processor_below_all_levels_is_told_what_it_lacks(copy):
    """By the module, and by the build, in one line."""
    with_processor(copy.folder, V2 - {"popcnt", "sse4_2"} | {"sse2"})
    line = last_line(copy())
    assert line.startswith("ImportError: eel_core needs a processor of level x86-64-v2 or above")
    assert "lacks popcnt, sse4_2: take a machine" in line
    script = [sys.executable, "-I", copy.folder / "processor.py"]
    assert last_line(subprocess.run(script, capture_output=True, text=True, timeout=60)) in line


@x86_64_only
def test_level_from_the_environment_must_be_built_and_run_here(copy):
    level = built.LEVELS[0]
    assert str(copy.folder) in copy(EEL_CORE_LEVEL=level).stdout
    assert last_line(copy(EEL_CORE_LEVEL="v9")) == f"ImportError: EEL_CORE_LEVEL must be one of {level} here, got 'v9'"


@x86_64_only
def test_module_of_another_architecture_is_refused(copy):
    copy.folder.joinpath("built.py").write_text("LEVELS = ()\nNATIVE_FEATURES = frozenset()\n")
    assert "eel_core was built for another processor than x86-64" in last_line(copy())


@pytest.mark.parametrize("content", [None, b"", b"\x7fELF and no more"])
def test_damaged_module_is_named_with_what_repairs_it(copy, content):
    (module,) = copy.folder.glob("_core*.so")
    module.unlink()
    if content is not None:
        module.write_bytes(content)
    line = last_line(copy())
    assert f"eel_core.{module.name.split('.')[0]} is missing or damaged" in line and "build eel_core again" in line
