# SPDX-License-Identifier: Apache-2.0
"""Bad input anywhere in the library: one `ValueError` in one short line that names the argument."""

import re
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest
from eel_common.wording import LONGEST, LONGEST_LINE, one_line, shown

from eel_dynamics import Accuracy, Body, Scene, Simulation, hydrodynamic_wrench, simulate, simulate_batch
from eel_gaits import Law, Ramp, Term, falling, gait, natural_spline, straight
from eel_studies import sweep


class Unshowable:
    def __repr__(self):
        raise RuntimeError("this object cannot be shown")


HUGE = 10**400  # an int beyond all floats
TOO_LONG = 10**5000  # one that Python does not even write
TEXT = "one line\nand another " * 2_000  # 42 kB
BAD = {
    "huge": HUGE,
    "negative huge": -HUGE,
    "too long": TOO_LONG,
    "text": TEXT,
    "list of huge": [HUGE] * 1000,
    "list of texts": [TEXT] * 3,
    "unshowable": Unshowable(),
    "not a number": float("nan"),
}
AXIS = np.linspace(0.0, 1.0, 9)
BODY = {"x": AXIS, "half_width": 0.1 * np.sqrt(AXIS), "half_height": 0.1 * np.sqrt(AXIS)}


def simulation(**arguments):
    return Simulation(law=straight(), **arguments)


def calls():
    """(what, a function of one bad value) of every argument of the library."""
    yield "gait name", lambda bad: gait(bad)
    for name in ("period", "wavelength", "amplitude_0", "transition"):
        yield f"gait {name}", lambda bad, name=name: straight(**{name: bad})
    for name in ("start", "end", "delta"):
        yield f"Ramp {name}", lambda bad, name=name: Ramp(**{"start": 0.0, "end": 1.0, "delta": 1.0, name: bad})
    for name in ("axis", "amplitude", "knots", "wavelength", "period", "phase", "envelope"):
        yield f"Term {name}", lambda bad, name=name: Term(**{"amplitude": (1.0,), name: bad})
    yield "Law terms", lambda bad: Law(bad)
    yield "Law name", lambda bad: Law(name=bad)
    yield "Law transition", lambda bad: Law(transition=bad)
    yield "Law curvature time", lambda bad: straight().curvature(bad, [0.5])
    yield "Law curvature x", lambda bad: straight().curvature(0.0, [bad])
    yield "spline knots", lambda bad: natural_spline([0.0, bad], [1.0, 2.0], [0.5])
    yield "spline values", lambda bad: natural_spline([0.0, 1.0], [1.0, bad], [0.5])
    yield "spline x", lambda bad: natural_spline([0.0, 1.0], [1.0, 2.0], [bad])
    for name in (item.name for item in fields(Scene)):
        yield f"Scene {name}", lambda bad, name=name: Scene(**{name: bad})
    for name in ("x", "half_width", "half_height", "kinks", "nose", "density", "length", "roll_drag", "name"):
        yield f"Body {name}", lambda bad, name=name: Body(**{**BODY, name: bad})
    yield "Body half_width of X", lambda bad: Body(length=1.0, half_width=bad, half_height=lambda x: 0.1 * np.sqrt(x))
    yield "Body file", lambda bad: Body.from_file(bad)
    yield "Body of kern2006", lambda bad: Body.kern2006(bad)
    yield "Body named", lambda bad: Body.named(bad)
    for name in ("resolution", "tolerance", "step", "method", "order", "fixed", "kinks"):
        yield f"Accuracy {name}", lambda bad, name=name: Accuracy(**{"name": "own", "resolution": 8.0, name: bad})
    for name in (
        "duration",
        "sample_period",
        "stations",
        "position",
        "orientation",
        "twist",
        "accuracy",
        "body",
        "scene",
    ):
        yield f"simulate {name}", lambda bad, name=name: simulate(straight(), **{"duration": 0.1, name: bad})
    yield "simulate law", lambda bad: simulate(bad)
    for name in ("duration", "sample_period", "stations", "positions", "orientations", "twists", "accuracy", "bodies"):
        yield f"batch {name}", lambda bad, name=name: simulate_batch([straight()], **{"duration": 0.1, name: bad})
    yield "batch laws", lambda bad: simulate_batch(bad, 0.1)
    yield "batch threads", lambda bad: simulate_batch([straight()] * 3, 0.1, threads=bad)
    for name in ("default_transition", "stations", "position", "twist", "accuracy"):
        yield f"Simulation {name}", lambda bad, name=name: simulation(**{name: bad})
    yield "Simulation advance", lambda bad: simulation().advance(bad)
    yield "Simulation adopt origin", lambda bad: simulation().adopt(falling(), origin=bad)
    yield "Simulation adopt transition", lambda bad: simulation().adopt(falling(), transition=bad)
    yield "Simulation samples time", lambda bad: samples(time=bad)
    yield "Simulation samples x", lambda bad: samples(x=[0.0, bad])
    yield "Simulation samples yaw", lambda bad: samples(yaw=[0.0, bad])
    for name in ("time", "twist", "twist_rate"):
        given = {"body": Body.boyer2010(), "law": straight(), "time": 0.0, "twist": [0.0] * 6, "twist_rate": [0.0] * 6}
        yield (
            f"hydrodynamic_wrench {name}",
            lambda bad, name=name, given=given: hydrodynamic_wrench(**{**given, name: bad}),
        )
    yield "sweep grid", lambda bad: sweep({"period": [1.0, bad]}, duration=0.1)
    yield "sweep grid of the scene", lambda bad: sweep({"scene.viscosity": [1e-6, bad]}, duration=0.1)
    yield "sweep duration", lambda bad: sweep({"period": [1.0]}, duration=bad)
    yield "sweep accuracy", lambda bad: sweep({"period": [1.0]}, accuracy=bad)
    yield "analysis periods", lambda bad: simulate(straight(), 3.0).analysis(bad)
    yield "actuators joints", lambda bad: simulate(straight(), 1.0).actuators(bad)


def samples(**changed):
    row = [0.0, 0.0]
    given = {"time": 0.1, "x": [0.0, 0.4], "yaw": row, "yaw_rate": row, "yaw_accel": row}
    given |= {"pitch": row, "pitch_rate": row, "pitch_accel": row}
    Simulation().add_samples(**{**given, **changed})


CALLS = dict(calls())
TAKEN = {  # what is no error there, or nothing that can be named
    "Body name": {"text"},
    "Body file": {"text"},
    "spline values": {"not a number"},
    "spline x": {"not a number"},
    "sweep grid": {"unshowable"},
    "sweep grid of the scene": {"unshowable"},
}
NAMED = {"gait name": "gait", "Body of kern2006": "length", "Body named": "body", "Simulation advance": "time"}
NAMED |= {"sweep grid": "period"}


@pytest.mark.fault(
    "parameters",
    "10**400, 10**5000 or a text of 1 MB, anywhere in the library",
    "one `ValueError` of one line; of a value at most 80 characters are shown",
)
@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("what", CALLS)
def test_bad_input_is_one_short_line(what):
    for kind in BAD.keys() - TAKEN.get(what, set()):
        with pytest.raises(ValueError) as refused:
            CALLS[what](BAD[kind])
        message = str(refused.value)
        assert "\n" not in message and len(message) <= 500, (kind, len(message), message[:1000])
        name = NAMED.get(what, what.split()[-1].removesuffix("s"))
        assert re.search(rf"\b{name}s?\b.*\bgot |unknown {name} ", message), (name, message)
        assert "int too large" not in message and "integer string conversion" not in message, (kind, message)


def test_a_value_is_shown_in_one_line_of_eighty_characters():
    for value in (*BAD.values(), np.arange(10**6), {"a": [TEXT]}, b"x" * 10**6, object()):
        text = shown(value)
        assert 0 < len(text) <= LONGEST and "\n" not in text


def test_what_is_short_is_shown_as_it_is():
    for value in (None, 1.5, -3, "laminar", (1.0, 2.0, 3.0), [0.0] * 7, True):
        assert shown(value) == repr(value)
    long = shown("head" + "x" * 100 + "tail")
    assert long.startswith("'headx") and "x...x" in long and long.endswith("xtail'") and len(long) == LONGEST


def test_an_error_is_told_in_one_line():
    assert one_line(ValueError("one\n  two")) == "one two" and LONGEST_LINE == 300
    assert one_line("red \x1b[31m, a bell \a, \u202e and \udc80") == r"red \x1b[31m, a bell \x07, \u202e and \udc80"
    assert one_line(ValueError("a " * 10**6)).startswith("a a") and len(one_line("a " * 10**6)) <= LONGEST_LINE
    with pytest.raises(OSError) as missing:
        Path("x" * 200).read_bytes()
    assert one_line(missing.value) == f"No such file or directory: {shown('x' * 200)}"
