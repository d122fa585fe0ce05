# SPDX-License-Identifier: Apache-2.0
"""The parameters of the dynamics node, without a process."""

import math
from dataclasses import fields

import pytest
from eel_common.quantity import checked
from eel_common.ros.parameters import default_of
from eel_dynamics.ros.parameters import DynamicsParameters

from eel_dynamics import Scene


@pytest.mark.parametrize("kind", [DynamicsParameters, Scene])
def test_defaults_pass_their_own_checks(kind):
    values = {item.name: default_of(item) for item in fields(kind)}
    assert kind(**{item.name: checked(item, values[item.name], item.name) for item in fields(kind)}) == kind()


@pytest.mark.parametrize("kind", [DynamicsParameters, Scene])
def test_every_parameter_is_described(kind):
    for item in fields(kind):
        assert item.metadata["description"] and "unit" in item.metadata, item.name


@pytest.mark.parametrize("kind", [DynamicsParameters, Scene])
def test_every_float_takes_an_integer(kind):
    for item in fields(kind):
        if isinstance(item.default, float) or item.default is None:
            number = checked(item, 1, item.name)
            assert number == 1.0 and isinstance(number, float), item.name
        if isinstance(item.default, tuple) and not isinstance(item.default[0], str):
            assert checked(item, [1] * len(item.default), item.name) == (1.0,) * len(item.default)


@pytest.mark.parametrize(
    ("name", "value", "expected"),
    [
        ("rate", 0, "rate must be > 0 Hz, got 0"),
        ("rate", -5.0, "rate must be > 0 Hz, got -5.0"),
        ("rate", math.nan, "rate must be finite, got nan"),
        ("rate", "fast", "rate must be a number, got 'fast'"),
        ("rate", True, "rate must be a number, got True"),
        ("real_time_factor", -1.0, "real_time_factor must be >= 0, got -1.0"),
        ("stations", 1, "stations must be >= 2, got 1"),
        ("stations", 51.0, "stations must be an integer, got 51.0"),
        ("clock", 1, "clock must be true or false, got 1"),
        ("body", 3, "body must be a text, got 3"),
        ("accuracy", [1.0], "accuracy must be a text or a number, got [1.0]"),
        ("initial_position", [0.0, 1.0], "initial_position must be 3 finite numbers, got [0.0, 1.0]"),
        ("initial_position", [0.0, 1.0, math.inf], "initial_position must be 3 finite numbers, got [0.0, 1.0, inf]"),
        ("initial_position", 1.0, "initial_position must be 3 finite numbers, got 1.0"),
        (
            "initial_orientation",
            [0.0, 0.0, 0.0, 2.0],
            "initial_orientation must be a unit quaternion, got [0.0, 0.0, 0.0, 2.0] of norm 2",
        ),
        ("world_frame", "", "world_frame must not be empty"),
    ],
)
def test_bad_parameter_is_named_with_its_value(name, value, expected):
    with pytest.raises(ValueError) as caught:
        DynamicsParameters(**{name: value})
    assert str(caught.value) == expected


def test_rounded_quaternion_is_made_unit():
    values = DynamicsParameters(initial_orientation=(0.0, 0.0, 0.7071, 0.7071))
    assert math.hypot(*values.initial_orientation) == pytest.approx(1.0, abs=1e-15)


def test_number_of_samples():
    assert DynamicsParameters(duration=10.0, rate=100.0).last_sample == 1000
    assert DynamicsParameters(duration=0.3, rate=10.0).last_sample == 3
    assert DynamicsParameters(duration=0.35, rate=10.0).last_sample == 3
    assert DynamicsParameters().last_sample == math.inf
