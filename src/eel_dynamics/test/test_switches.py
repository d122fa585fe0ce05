# SPDX-License-Identifier: Apache-2.0
"""Terms that can be left out by a switch: momentum of the added mass, gradient of a flow, added mass of fins."""

from dataclasses import replace

import numpy as np
import pytest
from cases import random_law, random_twist
from library_state import Reference, distance, expected, library_body, snapshot
from reference import boyer_body
from reference import scene as reference_scene

from eel_dynamics import Fin, Gust, Scene, Shear, VortexStreet, Wave, simulate
from eel_gaits import falling, straight

FLOWS = {
    "still water": None,
    "a gust": Gust(velocity=(0.1, 0.2, 0.0)),
    "a shear layer": Shear(velocity=(0.3, 0.0, 0.0), across=(0.0, 1.0, 1.0), width=0.4),
    "a street": VortexStreet(),
    "a wave": Wave(surface=2.0),
}
OFF = {"added_inertia": False}, {"flow_gradient": False}, {"added_inertia": False, "tail_pressure": "distributed"}


def swum(flow, fins=(), **scene):
    law = straight() if isinstance(flow, VortexStreet) else falling()
    return simulate(law, 3.0, flow=flow, fins=fins, scene=Scene(**scene), accuracy=1e-5)


@pytest.mark.parametrize("off", OFF, ids=str)
@pytest.mark.parametrize("flow", FLOWS)
def test_ledger_and_wrench_close_without_a_term(flow, off):
    run, whole = swum(FLOWS[flow], **off), swum(FLOWS[flow])
    turned = np.abs(run.energy.actuator_work).max()
    assert np.abs(run.energy.residual).max() < 1e-6 * turned  # some 1e-9
    assert np.all(run.closure_force < 1e-11) and np.all(run.closure_torque < 1e-11)  # N, N m; round-off
    same = np.array_equal(run.position, whole.position)
    assert same is (off == {"flow_gradient": False} and flow in ("still water", "a gust"))


def test_the_head_moves_as_in_the_reference_whose_sections_have_no_water():
    rng = np.random.default_rng(3)
    law, twist, q = random_law(rng), random_twist(rng), (0.0, 0.0, 0.0, 1.0)
    settings = {"resistive": False, "nose": False}
    got = snapshot(library_body(boyer_body()), law, 0.6, twist, q, {**settings, "added_inertia": False})
    reference = Reference(boyer_body(), reference_scene(**settings), panels_per_span=4, nodes_per_panel=24)
    reference.inertia_fluid[:] = 0.0  # the tail's stays
    *_, acceleration = expected(reference, law, 0.6, twist, q)
    assert distance(got.head_acceleration[:3], acceleration[:3]) < 1e-6  # the roll is stiff: 444 rad/s^2
    assert distance(got.head_acceleration[3:], acceleration[3:]) < 1e-6
    assert got.energy.kinetic_fluid == 0.0


def test_fins_without_added_mass_are_lighter():
    pair = Fin.pair(0.3, 2e-3, 2.0, angle=([0.0, 0.5, 1.0], [0.0, 0.5, 0.0]))
    bare = tuple(replace(fin, added_mass=0.0) for fin in pair)
    run, other = swum(None, pair), swum(None, bare)
    assert np.abs(run.position - other.position).max() > 1e-4
    dry = {"added_inertia": False}
    np.testing.assert_array_equal(swum(None, pair, **dry).position, swum(None, bare, **dry).position)
    with pytest.raises(ValueError, match="fin added_mass must be >= 0, got -1"):
        replace(pair[0], added_mass=-1.0)
