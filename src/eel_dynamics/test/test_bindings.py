# SPDX-License-Identifier: Apache-2.0
"""The compiled module refuses what it cannot take; nothing that Python hands over crashes it, or never comes back."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from binding_calls import CLASSES, Changed, recorded

import eel_core
from eel_dynamics import Simulation
from eel_gaits import straight

CALLS = Path(__file__).with_name("binding_calls.py")
AT_REST = np.zeros(3), np.array((0.0, 0.0, 0.0, 1.0)), np.zeros(6)


def child(seed, first, last):
    """Changed calls in a process of their own, which tells each before it is made."""
    made = subprocess.run(
        [sys.executable, str(CALLS), str(seed), str(first), str(last)], capture_output=True, text=True, timeout=1000.0
    )
    lines = made.stdout.splitlines() or [""]
    assert made.returncode == 0, (
        f"call {lines[-1]!r} of seed {seed} ended with {made.returncode}: {made.stderr[-2000:]}"
    )
    return lines


@pytest.mark.parametrize("count", [150, pytest.param(1500, marks=[pytest.mark.soak, pytest.mark.timeout(1200)])])
def test_changed_calls_of_all_bindings_neither_crash_nor_hang(count):
    *told, called = child(1, 0, count)
    assert len(told) == count
    refused = [line for line in told if "Error" in line]
    assert count // 4 < len(refused) < count  # changes that matter, and some that do not
    names = set(called.split()[1:])
    for kind in CLASSES:
        of_bounds = kind == "StepBounds"  # its other names are numbers
        methods = {name for name in vars(getattr(eel_core, kind)) if not name.startswith("_") and not of_bounds}
        assert {f"{kind}.{name}" for name in ("__init__", *methods)} <= names


@pytest.fixture
def simulation():
    made = Simulation(law=straight(), stations=5)
    made.advance(0.1)
    return made


def test_none_in_place_of_an_object_is_refused(simulation):
    law, swimmer = simulation.law_on_grid, simulation.discretisation.swimmer
    for wrong in (
        lambda: eel_core.March(None, "adams", 5, False),
        lambda: eel_core.Instant(None),
        lambda: eel_core.LawOnGrid(None, 0.0, [], None, None),
        lambda: eel_core.repeat_rate(None, False, law, 0.0, np.zeros(13), 1),
        lambda: eel_core.repeat_rate(swimmer, False, None, 0.0, np.zeros(13), 1),
        lambda: eel_core.Instant(swimmer).inertia(None, 0.0),
        lambda: simulation._march.core.follow(None, [], None, True, np.zeros(3), None, True),
        lambda: eel_core.March.twist(None),
        lambda: eel_core.March.counts.fget(None),
    ):
        with pytest.raises(TypeError):
            wrong()
    with pytest.raises(ValueError, match="twist must be an array, got NoneType"):
        simulation._march.core.set_twist(None)


def test_an_object_without_its_constructor_is_refused(simulation):
    bare = eel_core.March.__new__(eel_core.March)
    for wrong in (
        bare.twist,
        lambda: bare.time,
        lambda: eel_core.Instant(eel_core.Swimmer.__new__(eel_core.Swimmer)),
        lambda: eel_core.repeat_rate(
            simulation.discretisation.swimmer,
            False,
            eel_core.LawOnGrid.__new__(eel_core.LawOnGrid),
            0.0,
            np.zeros(13),
            1,
        ),
    ):
        with pytest.raises((RuntimeError, TypeError)):
            wrong()


def test_an_array_in_another_byte_order_or_form_is_refused(simulation):
    core, twist = simulation._march.core, np.arange(6.0)
    before = core.state
    frozen = np.zeros((1, simulation._march._empty_rows(1).shape[1]))
    frozen.flags.writeable = False
    swapped = twist.astype(twist.dtype.newbyteorder("S"))
    for wrong, told in (
        (swapped, "numbers of 64 bits like 'd', got '[<>]d'"),
        (twist.astype(np.float32), "numbers of 64 bits"),
        (twist[::-1], "contiguous"),
        (np.zeros(12)[::2], "contiguous"),
        (np.zeros(5), "have 6 numbers, got 5"),
        (np.zeros(49, dtype=np.uint8)[1:].view(float), "begin at a multiple of 8 bytes"),
        ([0.0] * 6, "be an array, got list"),
    ):
        with pytest.raises(ValueError, match=f"twist must .*{told}"):
            core.set_twist(wrong)
    with pytest.raises(ValueError, match="weights must have more axes than 1"):
        eel_core.tabulate(np.zeros(3), np.zeros((6, 3)), np.zeros((6, 3)))
    with pytest.raises(ValueError, match="rows must be writable"):
        read_only = np.zeros((6, 3))
        read_only.flags.writeable = False
        eel_core.tabulate(np.eye(3), np.zeros((6, 3)), read_only)
    assert core.state == before
    core.set_twist(twist.astype(twist.dtype.newbyteorder("=")))  # the machine's own, by another name


def test_numbers_out_of_range_are_refused(simulation):
    law, swimmer, core = simulation.law_on_grid, simulation.discretisation.swimmer, simulation._march.core
    tables = eel_core.LawTables([0] * 18, np.zeros((18, 4)), 1, 0)
    for row in (2**64 - 1, 2**64 - 12, 7, 18):
        with pytest.raises(ValueError, match="law has 18 rows, and wants 12 from row"):
            eel_core.LawOnGrid(tables, 0.0, [], (row, 0.0, 1.0), None)
        with pytest.raises(ValueError, match="law has 18 rows, and wants 6 from row"):
            eel_core.LawOnGrid(tables, 0.0, [], None, (row + 6 if row < 18 else row, 0.0, 1.0))
    with pytest.raises(ValueError, match="nodes must be 0 to 1000000"):
        eel_core.LawTables([0], np.zeros((1, 0)), 2**62, 0)
    with pytest.raises(ValueError, match="law must be tabulated on the nodes"):
        eel_core.Instant(swimmer).inertia(eel_core.LawOnGrid(tables, 0.0, [], None, None), 0.0)
    with pytest.raises(ValueError, match="count must be 0 to 1000000"):
        eel_core.repeat_rate(swimmer, False, law, 0.0, np.zeros(13), 2**60)
    for time in (np.nan, np.inf):
        with pytest.raises(ValueError, match="time must be finite"):
            core.advance(time)
    with pytest.raises(ValueError, match="nodes must be 1 or more, got 0"):
        core.set_slice(0)


@pytest.mark.parametrize("wrong", [np.nan, 0.0, -1.0, np.inf])
@pytest.mark.parametrize("name", ["longest", "smallest", "part_of_span", "most_steps"])
def test_bounds_by_which_a_march_would_never_come_back_are_refused(simulation, name, wrong):
    bounds = simulation._march._bounds
    names = [each for each in vars(eel_core.StepBounds) if not each.startswith("_")]
    given = {each: getattr(bounds, each) for each in names}
    with pytest.raises(ValueError, match=f"{name} must be finite and > 0"):
        eel_core.StepBounds(**given | {name: wrong})


def test_a_swimmer_with_panels_beyond_its_nodes_is_refused(simulation):
    """Their indices are read without further checks at each step."""
    made = next(call for call in recorded() if call.kind == "Swimmer")
    grid = made.given[0]
    for name, value in (("first", 2**40), ("count", 2**40), ("first", 2**64 - 1)):
        numbers = np.array(getattr(grid, name))
        numbers[3] = value
        with pytest.raises(ValueError, match="first and count must be of"):
            eel_core.Swimmer(Changed(grid, name, numbers), *made.given[1:], **made.named)


def test_swimmers_side_by_side_that_have_no_start_are_told_of():
    made = Simulation(stations=2)
    tabulation, swimmer = made.discretisation.tabulation, made.discretisation.swimmer
    settings = {"method": "dormand_prince", "order": 5, "planar": False, "ledger": False, "current": np.zeros(3)}
    weights = tabulation.weights_of(np.linspace(0.0, 1.0, 5))
    marches = eel_core.SampledMarches(swimmer, **settings, weights=weights, transition=1.0, count=2, threads=1)
    for wrong in (
        lambda: marches.advance(np.ones(2), np.zeros((2, 6, 5)), np.zeros(2, dtype=np.int64), np.zeros((13, 2))),
        lambda: marches.put_head(0, np.zeros((13, 2))),
    ):
        with pytest.raises(RuntimeError, match=r"swimmer \d has no start yet"):
            wrong()
    with pytest.raises(IndexError, match="index must be below 2, got 2"):
        marches.put_head(2, np.zeros((13, 2)))
    for name, value in (("count", 2**40), ("threads", 0)):
        with pytest.raises(ValueError, match=f"{name} must be 1 to"):
            own = {"count": 2, "threads": 1} | {name: value}
            eel_core.SampledMarches(swimmer, **settings, weights=weights, transition=1.0, **own)
