# SPDX-License-Identifier: Apache-2.0
"""Random curvature laws for hypothesis, of magnitudes that a swimmer could follow."""

from hypothesis import strategies as st

from eel_gaits import Law, Ramp, Term


def numbers(low, high):
    return st.floats(low, high, allow_nan=False, allow_subnormal=False)


@st.composite
def ramps(draw):
    start = draw(numbers(-5.0, 5.0))
    return Ramp(start, start + draw(numbers(0.05, 3.0)), draw(numbers(-2.0, 2.0)), draw(st.integers(0, 2)))


@st.composite
def terms(draw):
    knots = ()
    amplitude = draw(st.lists(numbers(-5.0, 5.0), min_size=1, max_size=5))
    if len(amplitude) >= 2 and draw(st.booleans()):
        gaps = draw(st.lists(numbers(0.05, 1.0), min_size=len(amplitude), max_size=len(amplitude)))
        knots = [sum(gaps[: index + 1]) - 0.5 for index in range(len(gaps))]
    return Term(
        axis=draw(st.sampled_from(("yaw", "pitch"))),
        amplitude=amplitude,
        knots=knots,
        wavelength=draw(st.one_of(st.just(0.0), numbers(0.2, 3.0), numbers(-3.0, -0.2))),
        period=draw(st.one_of(st.just(0.0), numbers(0.2, 5.0))),
        phase=draw(numbers(-7.0, 7.0)),
        envelope=draw(st.lists(ramps(), max_size=4)),
    )


@st.composite
def laws(draw):
    listed = draw(st.lists(terms(), max_size=5))
    name = draw(st.text(st.characters(codec="utf-8", exclude_characters="\0"), max_size=20))  # DDS ends a text at a 0
    return Law(*listed, name=name, transition=draw(numbers(0.0, 10.0)))
