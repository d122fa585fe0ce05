# SPDX-License-Identifier: Apache-2.0
"""The start: the node, or the reason why there is none, and rclpy as it was before."""

import contextlib
import os
import resource
import subprocess
import sys

import pytest
import rclpy
from eel_common.ros.start import REPAIR, start
from rclpy.node import Node
from rosidl_generator_py.import_type_support_impl import UnsupportedTypeSupport


@pytest.fixture
def tried(monkeypatch):
    """tried(make, words): the node, and what was printed, as pairs of name and text."""

    def try_to_start(make, words=("tank",)):
        lines = []
        monkeypatch.setattr("eel_common.ros.start.print_to_stderr", lambda *line: lines.append(line))
        return start("tank", list(words), make), lines

    return try_to_start


def test_the_node_is_made_with_the_ros_arguments_given(tried):
    node, lines = tried(lambda: Node("tank"), ("tank", "--ros-args", "-r", "__node:=pool"))
    assert node.get_name() == "pool" and lines == []
    node.destroy_node()
    rclpy.shutdown()


@pytest.mark.parametrize("error", [ValueError("depth must be > 0 m"), OSError("disk full"), RuntimeError("no network")])
def test_the_reason_is_told_and_rclpy_is_shut_down(tried, error):
    def make():
        raise error

    assert tried(make) == (None, [("tank", error)])
    assert not rclpy.ok()


@pytest.mark.parametrize(
    "error", [UnsupportedTypeSupport("eel_msgs"), RuntimeError("Could not import 'rosidl_typesupport_c': Type Support")]
)
def test_a_damaged_build_is_told_with_its_repair(tried, error):
    def make():
        raise error

    node, ((_, text),) = tried(make)
    assert node is None and text == f"{REPAIR}: {error}"


def test_where_no_more_files_can_be_opened_that_is_the_reason(tried):
    before, held = resource.getrlimit(resource.RLIMIT_NOFILE), []

    def make():
        resource.setrlimit(resource.RLIMIT_NOFILE, (200, before[1]))
        with contextlib.suppress(OSError):
            while True:
                held.append(os.dup(0))
        raise UnsupportedTypeSupport("eel_msgs")

    try:
        node, lines = tried(make)
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, before)
        for number in held:
            os.close(number)
    assert node is None and lines == [("tank", "Too many open files (ulimit -n raises the limit)")]


def test_bad_ros_arguments_are_a_reason(tried):
    node, lines = tried(lambda: Node("tank"), ("tank", "--ros-args", "-p", "depth"))
    assert node is None and len(lines) == 1 and not rclpy.ok()


def test_an_error_of_the_program_itself_is_not_hidden(tried):
    def make():
        raise AttributeError("a mistake")

    with pytest.raises(AttributeError, match="a mistake"):
        tried(make)
    rclpy.shutdown()


def test_a_node_does_not_import_the_generator_of_message_code():
    """What it parses with takes a sixth of a node's start."""
    code = "import sys, eel_common.ros; from std_msgs.msg import Header; Header.__import_type_support__(); "
    code += "assert Header._TYPE_SUPPORT; print(*{'em', 'lark'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stdout.strip()) == (0, ""), done.stdout + done.stderr
