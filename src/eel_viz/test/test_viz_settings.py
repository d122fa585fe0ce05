# SPDX-License-Identifier: Apache-2.0
"""Settings: defaults are sound, and what is not is refused by name."""

import subprocess
import sys
from dataclasses import fields

import pytest
from eel_common.quantity import limits
from eel_viz.settings import Settings


def test_every_setting_is_described_and_its_default_lies_within_its_bounds():
    for item in fields(Settings):
        about = item.metadata
        assert len(about["description"]) > 10, item.name
        for key, sign in (("minimum", 1), ("maximum", -1)):
            if about[key] is not None:
                assert sign * item.default >= sign * about[key], item.name


@pytest.mark.parametrize(
    ("given", "field", "taken"),
    [
        ({"rate": 10}, "rate", 10.0),
        ({"torque_limit": 2}, "torque_limit", 2.0),
        ({"sink": "save"}, "sink", ("save",)),
        ({"sink": "save, serve"}, "sink", ("save", "serve")),
        ({"sink": ["spawn", "save"]}, "sink", ("spawn", "save")),
        ({"port": 9999}, "port", 9999),
        ({"stop_with_publisher": True}, "stop_with_publisher", True),
    ],
)
def test_what_is_taken(given, field, taken):
    value = getattr(Settings.among(given), field)
    assert value == taken
    assert type(value) is type(taken)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"sink": ["file"]}, "sink must be some of spawn, connect, serve, save or auto, got 'file'"),
        ({"sink": []}, "sink must name at least one of spawn, connect, serve, save, got none"),
        ({"sink": 3}, "sink must be a list of texts, got 3"),
        (
            {"blueprint": "mine"},
            "blueprint must be one of overview, torques, motion, robot, sensors, swimmer, compare, got 'mine'",
        ),
        ({"rate": 0}, "rate must be >= 0.1 Hz, got 0"),
        ({"rate": float("nan")}, "rate must be finite, got nan"),
        ({"rate": True}, "rate must be a number, got True"),
        ({"rate": "fast"}, "rate must be a number, got 'fast'"),
        ({"port": 80}, "port must be >= 1024, got 80"),
        ({"port": 9876.5}, "port must be an integer, got 9876.5"),
        ({"recording": 5}, "recording must be a text, got 5"),
        ({"stop_with_publisher": 1}, "stop_with_publisher must be true or false, got 1"),
        ({"torque_limit": -1}, "torque_limit must be >= 0 N m, got -1"),
    ],
)
def test_what_is_refused(given, words):
    with pytest.raises(ValueError) as refused:
        Settings.among(given)
    assert words in str(refused.value)


def test_limits_in_words():
    assert limits({"unit": "Hz", "minimum": 0.5, "maximum": None}) == ">= 0.5 Hz"
    assert limits({"unit": "", "minimum": None, "maximum": None}) == ""


def test_everything_but_the_nodes_is_imported_without_ros_and_the_package_brings_nothing():
    code = """
import sys
class Blocked:
    def find_spec(self, name, path=None, target=None):
        blocked = ("rclpy", "eel_msgs", "geometry_msgs", "ament_index_python")
        if name.split(".")[0] in blocked or name.startswith("eel_common.ros"):
            raise ImportError("blocked: " + name)
sys.meta_path.insert(0, Blocked())
import importlib, pkgutil
import eel_viz
assert not {"numpy", "rerun", "pyarrow"} & set(sys.modules), "the package itself must be light"
with_ros = {"node", "inbox", "record", "echo", "definitions"}
for module in pkgutil.iter_modules(eel_viz.__path__):
    if module.name not in with_ros:
        importlib.import_module("eel_viz." + module.name)
"""
    subprocess.run([sys.executable, "-c", code], check=True, timeout=100)
