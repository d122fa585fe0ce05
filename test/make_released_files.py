# SPDX-License-Identifier: Apache-2.0
"""Writes a file of each kind that this version saves into test/released/VERSION, for `test_released_files`.

Run it once a version, at its release: `tools/run.sh python test/make_released_files.py`.
"""

import json
import shutil
from pathlib import Path

import numpy as np
from eel_common.version import VERSION
from eel_dynamics.runs.storage.tables import columns_of, write_columns
from test_run_from_bag import write_bag

from eel_dynamics import Scene, simulate, simulate_batch
from eel_gaits import falling, straight

RELEASED = Path(__file__).parent / "released"
MOST_BYTES = 200_000  # of all files of a version


def main() -> None:
    folder = RELEASED / VERSION
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    scene = Scene(friction="laminar")
    run = simulate(falling(), 1.0, sample_period=0.1, stations=9, scene=scene, load=True, accuracy=1e-3)
    run.save(folder / "run.nc")
    write_bag(folder / "bag", run)
    write_columns(columns_of(run), folder / "run.csv")
    batch = simulate_batch([straight(period=0.8), falling()], 0.5, sample_period=0.1, accuracy=1e-2)
    batch.save(folder / "batch.nc")
    told = {"position": run.position[-1].tolist(), "greatest_torque": float(np.abs(run.torque).max())}
    told |= {"period": 0.8, "batch": batch.position[:, -1].tolist(), "friction": scene.friction}
    (folder / "expected.json").write_text(json.dumps(told, indent=1) + "\n")
    size = sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())
    print(f"{folder}: {size} bytes")
    if size > MOST_BYTES:
        raise SystemExit(f"more than {MOST_BYTES} bytes")


if __name__ == "__main__":
    main()
