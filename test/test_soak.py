# SPDX-License-Identifier: Apache-2.0
"""Long runs as fast as possible, a subscriber on every topic: nothing is lost, and memory does not grow.

`make soak` swims for an hour of simulation and leaves out/soak.csv and out/soak.png, which `make robustness` brings
into docs/images.
"""

from pathlib import Path

import pytest
from soak import NODES, RATE, soak

OUT = Path(__file__).parents[1] / "out"
HOUR, TEN_MINUTES, FOUR_MINUTES = 3600.0, 600.0, 240.0  # s of simulation
ROBOT = (
    "robot:=eight_servos",
    "fins:=pair station=0.5 area=0.0015 aspect_ratio=2",
    "flow:=shear velocity=0.1,0,0 width=0.5",
)
FILLED = 0.5  # of the hour, by which every history is as full as it gets
GROWTH = 0.01  # of the median, what the memory may vary by afterwards
MOST = 600.0  # MB of any node: histories of 5,000 samples on both sides, libraries, Rerun


@pytest.mark.fault(
    "load",
    "an hour of simulation as fast as possible, a subscriber on every topic (`make soak`)",
    "no sample lost, memory constant to 1 % over the last half hour (medians of 5 min)",
)
@pytest.mark.soak
@pytest.mark.timeout(3 * 3600)
def test_an_hour(start, fresh_domain):
    result = soak(start, HOUR, limit=3 * 3600.0)
    result.write(OUT / "soak.csv")
    draw(result, OUT / "soak.png")
    assert set(result.counts.values()) == {round(HOUR * RATE) + 1}, result.counts
    for node in NODES:
        assert result.memory[node].max() < MOST, node
        assert result.spread(node, after=FILLED * HOUR) < GROWTH, (node, result.spread(node, after=FILLED * HOUR))


@pytest.mark.fault(
    "load",
    "ten minutes of a robot with fins in a flow, as fast as possible (`make soak`)",
    "no sample lost, memory of the visualiser constant to 2 % after four minutes (medians of a minute)",
)
@pytest.mark.soak
@pytest.mark.timeout(3 * 3600)
def test_ten_minutes_of_a_robot_with_fins_in_a_flow(start, fresh_domain):
    result = soak(start, TEN_MINUTES, limit=3 * 3600.0, swimmer=ROBOT)
    result.write(OUT / "soak_robot.csv")
    assert set(result.counts.values()) == {round(TEN_MINUTES * RATE) + 1}, result.counts
    spread = result.spread("visualiser", after=FOUR_MINUTES)
    assert result.memory["visualiser"].max() < MOST and spread < 0.02, spread


def draw(result, path: Path) -> None:
    """The memory of each node over simulation time."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 4.5), layout="constrained")
    axes = figure.subplots()
    for node in NODES:
        spread = 100.0 * result.spread(node, after=FILLED * result.time[-1])
        axes.plot(result.time / 60.0, result.memory[node], label=f"{node}: {spread:.2g} % in the last half")
    axes.set(
        xlabel="simulation time [min]",
        ylabel="memory [MB]",
        title=f"{result.time[-1] / 60.0:.0f} min of simulation in {result.wall / 60.0:.0f} min, all topics received",
    )
    axes.set_ylim(bottom=0.0)
    axes.set_xlim(left=0.0)
    axes.grid(alpha=0.3)
    axes.legend()
    figure.savefig(path, dpi=120)
