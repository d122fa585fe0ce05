# SPDX-License-Identifier: Apache-2.0
"""How the water takes a section by its shape: coefficients, added mass, their slopes, edges of panels; bad input."""

import numpy as np
import pytest
from eel_dynamics.model.body.appendages import Appendage
from eel_dynamics.model.body.body import Body
from eel_dynamics.model.body.grid import Grid
from eel_dynamics.model.body.panels import panels_of

BY_SHAPE = {"lateral_drag": "by shape", "vertical_drag": "by shape"}


def prism(half_height: float, half_width: float, **others) -> Body:
    """One section all along, 1 m long."""
    return Body(
        length=1.0,
        half_width=lambda x: half_width + 0.0 * np.asarray(x),
        half_height=lambda x: half_height + 0.0 * np.asarray(x),
        blunt_nose=True,
        **BY_SHAPE | others,
    )


@pytest.mark.parametrize(
    ("height", "width", "lateral", "vertical", "beta"),
    [
        (0.05, 0.05, 1.20, 1.20, 0.2),  # a circle
        (0.05, 0.025, 1.59, 1.10, 0.8),  # high: broadside is axis 2
        (0.025, 0.05, 1.10, 1.59, 0.8),  # wide
        (0.1, 1e-6, 1.98, 1.00, 1.0),  # a plate
        (0.055, 0.05, 1.270909, 1.1818182, 0.338843),
    ],
)
def test_coefficients_of_a_section(height, width, lateral, vertical, beta):
    """Six digits of the formulas; a plate of 1e-6 m is one to 1e-5."""
    body, x = prism(height, width, round_added_mass=0.2), np.linspace(0.0, 1.0, 5)
    for got, wanted in zip(body.cross_flow(x), (lateral, vertical), strict=True):
        assert got == pytest.approx(np.full(5, wanted), abs=1e-5)
    for got in body.added_mass_factors(x):
        assert got == pytest.approx(np.full(5, beta), abs=1e-6)


def changing() -> Body:
    """High at the nose, wide at the tail: round at X = 0.4 m."""
    return Body(
        length=1.0,
        half_width=lambda x: 0.03 + 0.02 * np.asarray(x),
        half_height=lambda x: 0.05 - 0.03 * np.asarray(x),
        blunt_nose=True,
        round_added_mass=0.2,
        lateral_added_mass=lambda x: 1.2 - 0.4 * np.asarray(x) ** 2,
        **BY_SHAPE,
    )


@pytest.mark.parametrize("swapped", [False, True])
def test_slopes_of_the_added_mass_are_its_derivatives(swapped):
    """By central differences of 1e-5 m, whose error is 1e-10 of some 0.01 m and its round-off 1e-14 / 1e-5."""
    body, x, step = changing(), np.array([0.0103, 0.2, 0.39, 0.41, 0.7, 0.99]), 1e-5

    def added(at):
        squares = body.half_height(at) ** 2, body.half_width(at) ** 2
        return [
            each * factor
            for each, factor in zip(squares[:: -1 if swapped else 1], body.added_mass_factors(at), strict=True)
        ]

    slopes = body.added_mass_slopes(x, body.squares(x), swapped)
    for got, ahead, behind in zip(slopes, added(x + step), added(x - step), strict=True):
        assert got == pytest.approx((ahead - behind) / (2.0 * step), abs=1e-9)


def test_a_panel_ends_where_a_section_is_round_and_where_an_appendage_is():
    body = changing().changed(
        appendages=[Appendage(0.63, drag1=1e-3), Appendage(0.0, drag1=1e-3), Appendage(1.0, drag1=1e-3)]
    )
    ends = Grid.of(panels_of(body, resolution=20)).x
    assert np.abs(ends - 0.4).min() < 1e-12 and np.abs(ends - 0.63).min() < 1e-12
    smooth = changing().changed(round_added_mass=1.0, lateral_drag=1.98, vertical_drag=1.0)
    assert np.abs(Grid.of(panels_of(smooth, resolution=20)).x - 0.4).min() > 1e-12


def test_limits_at_pointed_ends():
    """Half-axes that go like sqrt(X) have a ratio there: a coefficient is its limit, and nothing is NaN."""
    body = Body(
        length=1.0,
        half_width=lambda x: 0.02 * np.sqrt(np.maximum(np.asarray(x) * (1.0 - np.asarray(x)), 0.0)),
        half_height=lambda x: 0.04 * np.sqrt(np.maximum(np.asarray(x) * (1.0 - np.asarray(x)), 0.0)),
        round_added_mass=0.2,
        **BY_SHAPE,
    )
    x = np.array([0.0, 1e-12, 1e-6, 0.5, 1.0 - 1e-6])
    assert body.cross_flow(x)[0] == pytest.approx(np.full(5, 1.59), abs=1e-9)
    assert body.added_mass_factors(x)[0] == pytest.approx(np.full(5, 0.8), abs=1e-9)
    at_tail = np.array([1.0])
    assert np.isfinite([*body.cross_flow(at_tail), *body.added_mass_factors(at_tail)]).all()


ROBOT = Body.boyer2010()
X = np.linspace(0.0, 1.0, 5)
HALF = np.array([0.0, 0.03, 0.03, 0.03, 0.02])


def bar(**others) -> Appendage:
    return Appendage(**{"x": 0.3, "drag1": 1e-3} | others)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        *(
            (lambda n=n: ROBOT.changed(**{n: -0.1}), f"body {n} must be .*got -0.1")
            for n in (
                "joint_drag",
                "base_drag",
                "round_added_mass",
                "nose_drag",
                "lateral_drag",
                "vertical_drag",
                "lateral_added_mass",
                "friction_factor",
            )
        ),
        *(
            (lambda n=n: ROBOT.changed(**{n: float("nan")}), f"body {n} must be .*got nan")
            for n in ("joint_drag", "base_drag", "round_added_mass", "nose_drag", "link_length")
        ),
        *(
            (lambda n=n: ROBOT.changed(**{n: float("inf")}), f"body {n} must be .*got inf")
            for n in ("joint_drag", "base_drag", "nose_drag", "lateral_drag", "vertical_drag", "lateral_added_mass")
        ),
        (lambda: ROBOT.changed(round_added_mass=1.1), "body round_added_mass must be .*got 1.1"),
        (lambda: ROBOT.changed(joint_drag=0.65), "body joint_drag needs a link_length, in m, got 0.65 and none"),
        (lambda: ROBOT.changed(joint_drag=0.65, link_length=0.0), "body link_length must be > 0 m, got 0"),
        (lambda: ROBOT.changed(joint_drag="by shape"), "body joint_drag must be a number, got 'by shape'"),
        (lambda: ROBOT.changed(lateral_drag="by_shape"), "body lateral_drag must be .*got 'by_shape'"),
        (lambda: ROBOT.changed(vertical_drag="plate"), "body vertical_drag must be .*got 'plate'"),
        (
            lambda: ROBOT.changed(lateral_added_mass="by shape"),
            "body lateral_added_mass must be numbers, got 'by shape'",
        ),
        (lambda: ROBOT.changed(lateral_drag=lambda x: 1.0 - 2.0 * x), "body lateral_drag must be >= 0.*got -"),
        (
            lambda: ROBOT.changed(lateral_drag=np.ones(5)),
            "body lateral_drag must be a number or a function of X, or an array with x=,",
        ),
        (
            lambda: Body(x=X, half_width=HALF, half_height=HALF, lateral_drag=np.ones(4)),
            "body lateral_drag must have as many values as x, 5, got 4",
        ),
        (
            lambda: Body(x=X, half_width=HALF, half_height=HALF, lateral_added_mass=[1, 1, -1, 1, 1]),
            "body lateral_added_mass must be >= 0 .*got -1 at X = 0.5 m",
        ),
        (
            lambda: Body(x=X, half_width=HALF, half_height=HALF, vertical_drag=[1, 1, np.nan, 1, 1]),
            "body vertical_drag must be .*nan",
        ),
        (lambda: ROBOT.changed(blunt_nose=True), "body half_width must be > 0 m at a blunt nose .X = 0., got 0"),
        (
            lambda: Body(x=X, half_width=HALF + 0.01, half_height=HALF, blunt_nose=True),
            "body half_height must be > 0 m at a blunt nose .X = 0., got 0",
        ),
        (lambda: ROBOT.changed(blunt_nose="yes"), "body blunt_nose must be a bool.*got 'yes'"),
        (lambda: ROBOT.changed(appendages=[bar(x=1.2)]), "appendage x must lie on the body, 0 to 1 m, got 1.2 m"),
        (lambda: bar(x=-0.1), "appendage x must be >= 0 m, got -0.1"),
        (lambda: bar(x=float("nan")), "appendage x must be .*got nan"),
        (lambda: bar(y=float("inf")), "appendage y must be .*got inf"),
        *(
            (lambda n=n: bar(**{n: -1e-3}), f"appendage {n} must be >= 0 m.2, got -0.001")
            for n in ("drag1", "drag2", "drag3")
        ),
        (lambda: bar(drag1=float("nan")), "appendage drag1 must be .*got nan"),
        (lambda: bar(drag2=float("inf")), "appendage drag2 must be .*got inf"),
        (lambda: bar(law="speeds"), "appendage law must be .*axis.*speed.*got 'speeds'"),
        (
            lambda: ROBOT.changed(appendages=[bar(drag2=1.5)]),
            "appendage drag areas must be in m.2, below the square of the body's length 1 m.2, got 1.5 m.2 at X",
        ),
        (
            lambda: ROBOT.changed(appendages=[bar(z=-35.0)]),
            "appendage y and z must be in m, within the body's length 1 m, got 0 and -35 m at X = 0.3 m",
        ),
        (lambda: ROBOT.changed(appendages=bar()), "body appendages must be a list of Appendage, got"),
        (
            lambda: ROBOT.changed(appendages=[0.2]),
            "body appendage must be a Appendage, got 0.2|body appendage must be an Appendage, got 0.2",
        ),
        (lambda: ROBOT.changed(appendages="bars.csv"), "body appendage.* must be a"),
        (lambda: ROBOT.changed(joint_drags=0.2), "body has no 'joint_drags', it has: .*joint_drag"),
    ],
)
def test_bad_input_names_the_argument(make, message):
    with pytest.raises(ValueError, match=message):
        make()


def test_bodies_that_differ_in_a_number_are_not_equal():
    changes = {
        "joint_drag": 0.3,
        "base_drag": 0.1,
        "round_added_mass": 0.5,
        "lateral_drag": "by shape",
        "appendages": [bar()],
    }
    others = [ROBOT.changed(link_length=0.1, **{name: value}) for name, value in changes.items()]
    same = ROBOT.changed(link_length=0.1)
    assert same == ROBOT.changed(link_length=0.1) and all(each != same for each in others)
    assert len({same, *others}) == 1 + len(others)
    again = others[-1].changed(appendages=[bar()])
    assert again == others[-1] and hash(again) == hash(others[-1])
