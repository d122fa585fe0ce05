# SPDX-License-Identifier: Apache-2.0
"""What must not be in the repository: addresses of package indices, paths of a developer's machine, large files."""

import re
import subprocess
from fnmatch import fnmatch
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
REQUIREMENTS = ("requirements.txt", "requirements-ros.txt", "requirements-dev.txt", "requirements-uv.txt")
OTHERS = (
    "docs/requirements.txt",
    "docs/examples/ppo/requirements.txt",
    "test/numpy1.txt",
    "tools/wheels/requirements.txt",
)
PEERS = tuple(f"evidence/peers/{name}.txt" for name in ("mujoco", "numba", "pyelastica"))


@pytest.fixture(scope="module")
def tracked() -> list[Path]:
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-z"], capture_output=True, text=True)
    if listed.returncode:
        pytest.skip("not a git checkout: nothing tells the project's files from what was built")
    return [ROOT / name for name in listed.stdout.split("\0") if name and (ROOT / name).is_file()]


def test_no_index_address(tracked):
    pattern = re.compile(r"(index-url|find-links|trusted-host|pypi\.org|pythonhosted|--registry)", re.IGNORECASE)
    names = ("tools/lock.sh", "tools/install/uv_with_pip_settings.py", "test/test_uv_with_pip_settings.py")
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


def test_every_extra_that_is_named_is_in_its_package(tracked):
    """In pages and messages alike; a path, since the packages are on no index."""
    has = {
        path.parent.name: set(re.findall(r'"(\w+)": \[', path.read_text()))
        for path in (ROOT / "src").glob("*/setup.py")
    }
    pattern = re.compile(r"(\S*)\b(eel_\w+)\[(\w+)\][\"'`]")
    found = {
        (str(path.relative_to(ROOT)), *words)
        for path in tracked
        if path.suffix in (".md", ".py") and path.name != "CHANGELOG.md" and path != Path(__file__)
        for words in pattern.findall(path.read_text())
    }
    assert {extra for *_, extra in found} >= {"data", "cluster", "cma"}
    assert [each for each in sorted(found) if each[3] not in has[each[2]]] == []
    assert [each for each in sorted(found) if "pip" in each[1] and "./src/" not in each[1]] == []


def test_no_large_file(tracked):
    """Only the film at the head of the README may be larger than 1 MB."""
    film = ROOT / "docs/images/falling.webp"
    assert [str(path) for path in tracked if path.stat().st_size > (2_000_000 if path == film else 1_000_000)] == []


@pytest.mark.parametrize("name", (*REQUIREMENTS, *OTHERS, *PEERS))
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
    for folder in ("test", "benchmarks", "evidence"):
        if (ROOT / folder).exists():
            assert (ROOT / folder / "COLCON_IGNORE").exists(), folder


def test_every_peer_is_pinned():
    files = sorted((ROOT / "evidence" / "peers").glob("*.txt"))
    assert files == [ROOT / name for name in PEERS]
    for path in files:
        assert f"\n{path.stem}==" in path.read_text()


def test_every_list_of_pins_is_written_by_the_same_script(tracked):
    """And so has hashes."""
    lists = {path for path in tracked if path.suffix == ".txt" and "==" in path.read_text()}
    script = (ROOT / "tools/lock.sh").read_text()
    assert {ROOT / name for name in (*REQUIREMENTS, *OTHERS, *PEERS)} == lists
    assert all(path.stem in script for path in lists)


def test_the_workflow_may_only_read_and_names_its_actions_by_commit():
    text = (ROOT / ".github/workflows/ci.yml").read_text()
    assert "\npermissions:\n  contents: read\n" in text
    actions = re.findall(r"uses: (\S+)", text)
    assert actions and all(re.fullmatch(r"[\w./-]+@[0-9a-f]{40}", action) for action in actions), actions


def test_pip_is_never_told_to_fetch_our_packages_by_name(tracked):
    """On PyPI the names are free, or others'."""
    texts = [path for path in tracked if path.suffix in (".py", ".md", ".sh", ".yml") or path.name == "Dockerfile"]
    found = [
        f"{path.name}: {match[0]}"
        for path in texts
        if path.name not in ("CHANGELOG.md", "SECURITY.md")
        for match in re.finditer(r"pip install [^\n`|]*?(?<![./\w])eel_\w+", path.read_text())
    ]
    assert found == []


def test_every_file_of_measured_data_has_one_licence():
    rows = re.findall(r"^\| (`.*`) \| (.+) \|$", (ROOT / "docs/data/README.md").read_text(), re.MULTILINE)
    patterns = [pattern for files, _ in rows for pattern in re.findall(r"`(.+?)`", files)]
    for path in (ROOT / "docs/data").glob("*.csv"):
        names = [pattern for pattern in patterns if fnmatch(path.name, pattern)]
        assert len(names) == 1, f"{path.name} is named by {names}"
