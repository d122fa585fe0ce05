# SPDX-License-Identifier: Apache-2.0
"""What must not be in the repository: addresses of package indices, paths of a developer's machine, large files."""

import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
REQUIREMENTS = ("requirements.txt", "requirements-ros.txt", "requirements-dev.txt", "requirements-uv.txt")


@pytest.fixture(scope="module")
def tracked() -> list[Path]:
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-z"], capture_output=True, text=True)
    if listed.returncode:
        pytest.skip("not a git checkout: nothing tells the project's files from what was built")
    return [ROOT / name for name in listed.stdout.split("\0") if name and (ROOT / name).is_file()]


def test_no_index_address(tracked):
    pattern = re.compile(r"(index-url|find-links|trusted-host|pypi\.org|pythonhosted|--registry)", re.IGNORECASE)
    names = ("tools/lock.sh", "tools/uv_with_pip_settings.py", "test/test_uv_with_pip_settings.py")
    allowed = {*(ROOT / name for name in names), Path(__file__)}  # the settings' names alone, and this list
    assert [
        str(path)
        for path in tracked
        if path not in allowed and pattern.search(path.read_bytes().decode(errors="ignore"))
    ] == []


def test_no_path_of_a_developers_machine(tracked):
    # in two halves, so that this file is not a finding
    pattern = re.compile(
        "|".join(("/ro" + "ot/", "/wo" + "rk/", "/ho" + r"me/\w", "/Use" + "rs/", r"\.\./sha" + "red"))
    )
    found = []
    for path in tracked:
        if path.suffix not in (".png", ".npz", ".rrd"):
            found += [
                f"{path.relative_to(ROOT)}:{number}"
                for number, line in enumerate(path.read_text(errors="ignore").splitlines(), 1)
                if pattern.search(line)
            ]
    assert found == []


def test_every_source_file_names_its_licence(tracked):
    sources = [path for path in tracked if path.suffix in (".py", ".pyi", ".hpp", ".cpp", ".sh", ".cmake")]
    assert len(sources) > 300
    beginnings = {path: path.read_text().splitlines()[:2] for path in sources}
    assert [
        str(path) for path, lines in beginnings.items() if "SPDX-License-Identifier: Apache-2.0" not in str(lines)
    ] == []


def test_no_large_file(tracked):
    """Only the film at the head of the README may be larger than 1 MB."""
    film = ROOT / "docs/images/falling.webp"
    assert [str(path) for path in tracked if path.stat().st_size > (2_000_000 if path == film else 1_000_000)] == []


@pytest.mark.parametrize("name", (*REQUIREMENTS, "docs/requirements.txt", "test/numpy1.txt"))
def test_every_requirement_is_pinned_with_hashes(name):
    entries = (ROOT / name).read_text().replace("\\\n", " ").splitlines()
    packages = [line for line in entries if line.strip() and not line.lstrip().startswith("#")]
    assert packages
    for line in packages:
        assert re.match(r"^[a-z0-9-]+(\[[a-z,]+\])?==\S+", line), line
        assert "--hash=sha256:" in line, line


def test_requirements_agree_with_one_another():
    pins: dict[str, str] = {}
    for name in REQUIREMENTS:
        for package, version in re.findall(
            r"^([a-z0-9-]+)(?:\[[a-z,]+\])?==(\S+)", (ROOT / name).read_text(), re.MULTILINE
        ):
            assert pins.setdefault(package, version) == version, f"{package} in {name}"


def test_colcon_looks_only_at_the_packages():
    for folder in ("test", "benchmarks"):
        if (ROOT / folder).exists():
            assert (ROOT / folder / "COLCON_IGNORE").exists(), folder


def test_every_peer_of_the_benchmarks_is_pinned():
    files = sorted((ROOT / "benchmarks" / "peers").glob("*.txt"))
    assert [path.stem for path in files] == ["mujoco", "numba", "pyelastica"]
    for path in files:
        lines = path.read_text().splitlines()
        assert any(line.startswith(f"{path.stem}==") for line in lines)
        assert all(re.fullmatch(r"[A-Za-z0-9_.-]+==[0-9][^;\s]*", line) for line in lines)
