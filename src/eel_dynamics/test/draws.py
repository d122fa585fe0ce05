# SPDX-License-Identifier: Apache-2.0
"""Laws, bodies, states and scenes for hypothesis: of sizes that a swimmer could have, plain where it can shrink.

`few(n)` is the profile: n examples, the same ones in every run, as they hang on the test's own source alone.
"""

from types import SimpleNamespace

import numpy as np
from cases import HALF_PI, kern_body
from hypothesis import settings
from hypothesis import strategies as st
from reference import boyer_body

from eel_gaits import Law, Ramp, Term

RAMPS = (Ramp(0.1, 1.3, 1.0), Ramp(0.4, 2.0, -0.7))


def few(examples):
    return settings(derandomize=True, max_examples=examples, deadline=None, database=None)


def numbers(low, high):
    return st.floats(low, high, allow_nan=False, allow_subnormal=False)


@st.composite
def waves(draw, axis="yaw", size=1.0, length=1.0):
    """A wave of up to `size` times some rad over the body, either way or standing."""
    coefficients = [draw(numbers(0.3, 1.5)), *draw(st.lists(numbers(-2.0, 2.0), max_size=2))]
    return Term(
        axis=axis,
        amplitude=tuple(size * c / length ** (k + 1) for k, c in enumerate(coefficients)),
        wavelength=length * draw(st.one_of(numbers(0.7, 2.0), st.just(0.0), numbers(-2.0, -0.7))),
        period=draw(numbers(0.6, 2.0)),
        phase=draw(numbers(0.0, 6.0)),
    )


@st.composite
def laws(draw, planar=False, size=1.0, length=1.0, ramps=False):
    """One or two waves, pitch too unless `planar`, and a constant bend; `ramps`: the bend comes and goes."""
    terms = [draw(waves("yaw", size, length))]
    if not planar:
        terms.append(draw(waves("pitch", size, length)))
    if ramps or draw(st.booleans()):
        bend = size * draw(numbers(-1.0, 1.0)) / length
        terms.append(Term(axis="yaw", amplitude=(bend,), phase=HALF_PI, envelope=RAMPS if ramps else ()))
    return Law(*terms, name="drawn")


@st.composite
def spindles(draw):
    """A round nose and a straight taper to a blunt tail, of any length and two different half-axes."""
    length, nose = draw(numbers(0.4, 2.5)), draw(numbers(0.04, 0.1))
    height, width = draw(numbers(0.03, 0.08)), draw(numbers(0.015, 0.04))
    height_taper, width_taper = draw(numbers(0.0, 0.7)), draw(numbers(0.0, 0.7))

    def axis(size, taper):
        def half(x):
            s = np.asarray(x, float) / length
            cap = np.sqrt(np.maximum(0.0, 1.0 - np.maximum(0.0, 1.0 - s / nose) ** 2))
            return length * size * cap * (1.0 - taper * s)

        return half

    return SimpleNamespace(
        half_width=axis(width, width_taper),
        half_height=axis(height, height_taper),
        kinks=(0.0, length * nose, length),
        nose=(length * width, length * height, length * nose),
        density=draw(numbers(500.0, 1500.0)),
    )


def bodies():
    """The paper's robot, the swimmer of Kern and Koumoutsakos, any spindle."""
    return st.one_of(st.builds(boyer_body), st.builds(kern_body), spindles())


@st.composite
def swimmers(draw, **options):
    """(body, law): a law of waves that fit on that body."""
    body = draw(bodies())
    return body, draw(laws(length=body.kinks[-1], **options))


@st.composite
def twists(draw, planar=False, size=0.5):
    """(Omega, V) of a head that goes forwards, turning and drifting."""
    drift = [draw(numbers(-size, size)) for _ in range(5)]
    twist = np.array([*drift[:3], -draw(numbers(0.2, 1.0)), *drift[3:]])
    return twist * (0, 0, 1, 1, 1, 0) if planar else twist


@st.composite
def quaternions(draw):
    q = np.array([draw(numbers(-1.0, 1.0)) for _ in range(3)] + [draw(numbers(0.1, 1.0))])
    return q / np.linalg.norm(q)


@st.composite
def scenes(draw, drag=False, planar=False, **fixed):
    """Switches and numbers of the scene, as keywords; `drag`: with the smooth laws of friction, else without any."""
    plain = {
        "reactive": draw(st.sampled_from((True, True, True, False))),
        "nose": draw(st.booleans()),
        "added_mass": draw(st.sampled_from(("corrected", "corrected", "printed"))),
        "tail_pressure": draw(st.sampled_from(("lumped", "distributed"))),
        "fluid_density": draw(numbers(700.0, 1300.0)),
        "current": draw(st.tuples(*[numbers(-0.3, 0.3)] * 2, st.just(0.0) if planar else numbers(-0.3, 0.3))),
        "resistive": drag,
    }
    if drag:
        plain["friction"] = draw(st.sampled_from(("laminar", "none", "blended")))
        plain["perimeter"] = draw(st.sampled_from(("ellipse", "printed")))
    return {**plain, **fixed}
