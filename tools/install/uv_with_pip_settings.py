# SPDX-License-Identifier: Apache-2.0
"""Runs uv with pip's settings of indexes, certificates and proxies, which uv does not read itself.

python tools/install/uv_with_pip_settings.py pip install ...

The settings are those that `pip config list` shows: of pip's files and of the PIP_... variables. A variable of uv's own
goes before them.
"""

import ast
import os
import subprocess
import sys
from pathlib import Path

VARIABLES = {  # of uv, by the name of pip's setting, with what stands between several values
    "index-url": ("UV_DEFAULT_INDEX", " "),
    "extra-index-url": ("UV_INDEX", " "),
    "find-links": ("UV_FIND_LINKS", ","),
    "trusted-host": ("UV_INSECURE_HOST", " "),
    "default-timeout": ("UV_HTTP_TIMEOUT", " "),
    "timeout": ("UV_HTTP_TIMEOUT", " "),
    "proxy": ("ALL_PROXY", " "),
    "cert": ("SSL_CERT_FILE", " "),
    "client-cert": ("SSL_CLIENT_CERT", " "),
}
SECTIONS = ("global", "install", ":env:")  # a later one goes before an earlier one
NO = ("", "0", "false", "no", "off")


def pip_settings(listed: str) -> dict[str, str]:
    """Settings that hold for `pip install`, from the output of `pip config list`."""
    settings: dict[str, dict[str, str]] = {section: {} for section in SECTIONS}
    for line in listed.splitlines():
        name, _, value = line.partition("=")
        section, _, setting = name.rpartition(".")
        if section in settings:
            settings[section][setting] = ast.literal_eval(value)
    return {setting: value for section in SECTIONS for setting, value in settings[section].items()}


def main() -> None:
    listed = subprocess.run([sys.executable, "-m", "pip", "config", "list"], stdout=subprocess.PIPE, text=True)
    settings = pip_settings(listed.stdout)
    variables = {
        variable: between.join(settings[setting].split())
        for setting, (variable, between) in VARIABLES.items()
        if settings.get(setting)
    }
    uv = str(Path(sys.executable).parent / "uv")
    offline = [] if settings.get("no-index", "").lower() in NO else ["--no-index"]
    os.execve(uv, [uv, *sys.argv[1:], *offline], {**variables, **os.environ})


if __name__ == "__main__":
    main()
