# SPDX-License-Identifier: Apache-2.0
"""Environments of other codes, with pinned packages (`.venv-peers`), and what their scripts say."""

import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
PEERS = ROOT / "evidence" / "peers"


def environment(name: str) -> Path | None:
    """Python of the environment that `peers/NAME.txt` pins, made on the first call; None where it cannot be
    installed."""
    folder, pins = ROOT / ".venv-peers" / name, PEERS / f"{name}.txt"
    python, stamp = folder / "bin" / "python", folder / "pins.txt"
    if stamp.is_file() and stamp.read_text() == pins.read_text():
        return python
    try:
        subprocess.run([sys.executable, "-m", "venv", folder], check=True, capture_output=True)
        (folder.parent / "COLCON_IGNORE").touch()
        install = [
            str(python),
            "-m",
            "pip",
            "install",
            "--quiet",
            "--require-hashes",
            "--only-binary",
            ":all:",
            "-r",
            str(pins),
        ]
        subprocess.run(install, check=True, capture_output=True)
    except (OSError, subprocess.CalledProcessError):
        return None
    stamp.write_text(pins.read_text())
    return python


def measured(python: Path, script: str, **task: Any) -> dict[str, Any]:
    """What `script` of the folder `peers` says about the `task`."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "task.npz"
        np.savez(path, **task)
        command = [python, PEERS / script, path]
        done = subprocess.run(command, check=True, cwd=folder, capture_output=True, text=True, timeout=900)
    found: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return found
