# SPDX-License-Identifier: Apache-2.0
"""One flipped bit in a saved run, batch or sweep is told, or changes nothing."""

import warnings

import numpy as np
import pytest

from eel_dynamics import Batch, Run, simulate, simulate_batch
from eel_gaits import falling
from eel_studies import sweep


def flipped(path, count: int, seed: int):
    """`count` times the file at `path` with another one of its bits turned; the whole file again at the end."""
    whole, chance = path.read_bytes(), np.random.default_rng(seed)
    for bit in chance.integers(8 * len(whole), size=count).tolist():
        data = bytearray(whole)
        data[bit // 8] ^= 1 << bit % 8
        path.write_bytes(data)
        yield bit
    path.write_bytes(whole)


@pytest.mark.fault(
    "names", "one flipped bit in a file of a run, a batch or a sweep", "refused in one line, or the content is the same"
)
@pytest.mark.parametrize("count", [40, pytest.param(300, marks=pytest.mark.soak)])
@pytest.mark.parametrize("kind", ["run", "batch", "sweep"])
def test_no_flipped_bit_is_silent(kind, count, tmp_path):
    path = tmp_path / f"{kind}.nc"
    if kind == "sweep":
        pytest.importorskip("xarray")

        def load(path):
            return sweep({"period": [0.5, 0.6]}, duration=1.0, accuracy=1e-2, stations=5, out=path)

        load(path)
        whole = load(path)  # as read from the file
    else:
        swum, load = {"run": (simulate, Run.load), "batch": (simulate_batch, Batch.load)}[kind]
        whole = swum(falling(period=0.7), 2.0, accuracy=1e-2, stations=9, load=True)
        whole.save(path)
    counts = {"told": 0, "same": 0}
    for bit in flipped(path, count, seed=11):
        with warnings.catch_warnings(record=True) as warned:
            warnings.simplefilter("always")
            try:
                again = load(path)
            except ValueError as error:
                assert "\n" not in str(error) and path.name in str(error)
                counts["told"] += 1
                continue
        assert again.identical(whole) if kind == "sweep" else again == whole, f"bit {bit}: another {kind}, silently"
        counts["told" if warned else "same"] += 1
    print(kind, counts)
    assert counts["told"] > 0.9 * count
