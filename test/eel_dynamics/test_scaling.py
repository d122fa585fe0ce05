"""Similar bodies at equal Reynolds number swim alike (model identity 8)."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest
from cases import falling_law
from library_state import Scene, library_body, simulate
from reference import boyer_body

from eel_gaits import Law, Ramp


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


@pytest.mark.parametrize("size, duration, density", [(2.0, 4.0, 1.0), (0.5, 0.125, 1.0), (3.0, 0.7, 1.2)])
def test_similar_swimmers(size, duration, density):
    """Lengths times `size`, times times `duration`, densities times `density`, at equal Re = length^2/(time viscosity).

    The step of an adaptive choice scales with the law, so that the runs agree to round-off or, where a preset's step is
    fixed in seconds, to its error: the tolerance allows for that.
    """
    law, body = falling_law(), boyer_body()
    scene = Scene(viscosity=1e-6 * size**2 / duration, fluid_density=1000 * density)
    options = {"accuracy": "reference", "stations": 11}
    small = simulate(law, duration=2.0, body=library_body(body), sample_period=0.2, **options)
    big = simulate(
        scaled_law(law, size, duration),
        duration=2.0 * duration,
        body=library_body(scaled_body(body, size, density)),
        scene=scene,
        sample_period=0.2 * duration,
        **options,
    )
    assert big.time == pytest.approx(small.time * duration, rel=1e-12)
    assert big.position / size == pytest.approx(small.position, abs=1e-5)
    assert big.twist[:, :3] * duration == pytest.approx(small.twist[:, :3], abs=1e-3)
    torque = big.torque * duration**2 / size**5 / density
    assert torque == pytest.approx(small.torque, abs=1e-4 * np.abs(small.torque).max())
