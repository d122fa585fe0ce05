# SPDX-License-Identifier: Apache-2.0
"""Similar bodies at equal Reynolds number swim alike."""

import dataclasses
from types import SimpleNamespace

import pytest
from draws import few, numbers, swimmers
from hypothesis import given
from library_state import Accuracy, Scene, distance, library_body, simulate

from eel_gaits import Law, Ramp

pytestmark = pytest.mark.identity("Scaling")


def scaled_body(body, size, density=1.0):
    return SimpleNamespace(
        half_width=lambda x: size * body.half_width(x / size),
        half_height=lambda x: size * body.half_height(x / size),
        kinks=tuple(size * k for k in body.kinks),
        nose=tuple(size * n for n in body.nose),
        density=density * body.density,
    )


def scaled_law(law, size, duration):
    def ramp(r):
        return Ramp(r.start * duration, r.end * duration, r.delta)

    def term(t):
        amplitude = tuple(a / size ** (k + 1) for k, a in enumerate(t.amplitude))
        return dataclasses.replace(
            t,
            amplitude=amplitude,
            wavelength=t.wavelength * size,
            period=t.period * duration,
            envelope=tuple(ramp(r) for r in t.envelope),
        )

    return Law(*(term(t) for t in law.terms))


@few(6)
@given(swimmers(ramps=True), numbers(0.3, 4.0), numbers(0.2, 4.0), numbers(0.5, 2.0))
def test_similar_swimmers(measured, swimmer, size, duration, density):
    """Lengths times `size`, times times `duration`, densities times `density`, at equal Re = length^2/(time viscosity).

    Nodes and chosen steps scale along, so that the two runs differ by round-off and what the motion makes of it.
    """
    body, law = swimmer
    length = body.kinks[-1]
    scene = Scene(viscosity=1e-6 * size**2 / duration, fluid_density=1000 * density)
    options = {"accuracy": Accuracy(name="similar", resolution=60.0, tolerance=1e-8), "stations": 11}
    small = simulate(law, duration=1.0, body=library_body(body), sample_period=0.1, **options)
    big = simulate(
        scaled_law(law, size, duration),
        duration=duration,
        body=library_body(scaled_body(body, size, density)),
        scene=scene,
        sample_period=0.1 * duration,
        **options,
    )
    assert big.time == pytest.approx(small.time * duration, rel=1e-12)
    pairs = {
        "path, by the length": (big.position / size, small.position, length),
        "angular velocity": (big.twist[:, :3] * duration, small.twist[:, :3], None),
        "torque": (big.torque * duration**2 / size**5 / density, small.torque, None),
        "actuators' power": (
            big.energy.actuator_power * duration**3 / size**5 / density,
            small.energy.actuator_power,
            None,
        ),
    }
    for name, (got, wanted, scale) in pairs.items():
        measured(f"{name}, similar swimmer", distance(got, wanted, scale), 1e-10)
