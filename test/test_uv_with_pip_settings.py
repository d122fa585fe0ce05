# SPDX-License-Identifier: Apache-2.0
"""What pip is told of indexes, certificates and proxies, uv is told too."""

import os
import subprocess
import sys
import venv
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
MIRROR = "https://mirror.example/simple"


@pytest.fixture
def run_uv(tmp_path):
    """run_uv(pip_conf, **variables) -> (arguments, environment) that uv gets."""
    venv.create(tmp_path / "venv", with_pip=False, symlinks=True)
    pip = next((Path(sys.prefix) / "lib").glob("python3.*/site-packages"))
    uv = tmp_path / "venv/bin/uv"
    uv.write_text('#!/bin/sh\necho "$@"\nenv\n')
    uv.chmod(0o755)

    def run(pip_conf: str = "", **variables: str):
        (tmp_path / "pip.conf").write_text(pip_conf)
        environment = {
            "HOME": os.fspath(tmp_path),
            "PATH": "/usr/bin:/bin",
            "PYTHONPATH": os.fspath(pip),
            "_ROS_WHEELS_BOOTSTRAP_COMPLETE": "1",
            "PIP_CONFIG_FILE": os.fspath(tmp_path / "pip.conf"),
            **variables,
        }
        command = [tmp_path / "venv/bin/python", ROOT / "tools/install/uv_with_pip_settings.py", "pip", "install"]
        done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=120)
        assert done.returncode == 0, done.stderr
        arguments, *lines = done.stdout.splitlines()
        return arguments.split(), dict(line.split("=", 1) for line in lines if "=" in line)

    return run


def test_settings_of_the_file(run_uv):
    _, uv = run_uv(
        f"[global]\nindex-url = {MIRROR}\ncert = /some/authority.pem\nproxy = http://proxy.example:8080\ntimeout = 99\n"
        "[install]\ntrusted-host = one.example\n  two.example\nfind-links = /wheels\n  /more/wheels\n"
    )
    assert uv["UV_DEFAULT_INDEX"] == MIRROR
    assert uv["SSL_CERT_FILE"] == "/some/authority.pem"
    assert uv["ALL_PROXY"] == "http://proxy.example:8080"
    assert uv["UV_HTTP_TIMEOUT"] == "99"
    assert uv["UV_INSECURE_HOST"] == "one.example two.example"
    assert uv["UV_FIND_LINKS"] == "/wheels,/more/wheels"


def test_variables_go_before_the_file_and_those_of_uv_before_both(run_uv):
    conf = "[global]\nindex-url = https://other.example\nextra-index-url = https://third.example\n"
    _, uv = run_uv(conf, PIP_INDEX_URL=MIRROR, UV_INDEX="https://mine.example")
    assert uv["UV_DEFAULT_INDEX"] == MIRROR
    assert uv["UV_INDEX"] == "https://mine.example"


@pytest.mark.parametrize(("value", "arguments"), [("1", ["--no-index"]), ("true", ["--no-index"]), ("0", [])])
def test_no_index(run_uv, value, arguments):
    assert run_uv(PIP_NO_INDEX=value)[0] == ["pip", "install", *arguments]


def test_without_settings_uv_has_its_own_defaults(run_uv):
    arguments, uv = run_uv()
    assert arguments == ["pip", "install"]
    assert not {"UV_DEFAULT_INDEX", "UV_INDEX"} & set(uv)
