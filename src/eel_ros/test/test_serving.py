# SPDX-License-Identifier: Apache-2.0
"""Callbacks that raise do not end the node; what is left to the node is left alone by the executor."""

import pytest
from eel_ros.serving import PolledGroup, log_dropped, serve_once
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node


class Log:
    def __init__(self):
        self.lines = []

    def error(self, text, throttle_duration_sec=None):
        self.lines.append(text)


@pytest.fixture
def served(ros_domain, monkeypatch):
    """A node, its executor and the errors it logs."""
    context = Context()
    context.init(args=[], domain_id=ros_domain)
    node = Node("tank", context=context, start_parameter_services=False)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    log = Log()
    monkeypatch.setattr(node, "get_logger", lambda: log)
    yield node, executor, log.lines
    executor.shutdown()
    node.destroy_node()
    context.try_shutdown()


def test_after_a_callback_that_raises_the_next_is_served(served):
    node, executor, errors = served
    done = []

    def fail():
        raise KeyError("no such\n  pump")

    executor.create_task(fail)
    executor.create_task(done.append, 1)
    for _ in range(4):
        serve_once(executor, node, 0.0)
    assert done == [1]
    assert errors == ["a message cannot be taken and is left out: KeyError: 'no such\\n pump'"]


def test_what_is_left_out_is_told_in_one_short_line(served):
    node, _, errors = served
    log_dropped(node, ValueError("x\n" * 1000), "a message on /clock")
    (line,) = errors
    assert line.startswith("a message on /clock cannot be taken and is left out: ValueError: x x") and len(line) < 400


def test_the_executor_runs_nothing_of_an_unattended_group(served):
    node, executor, _ = served
    ran = {"unattended": 0, "attended": 0}

    def count(name):
        ran[name] += 1

    node.create_timer(0.001, lambda: count("unattended"), callback_group=PolledGroup())
    node.create_timer(0.001, lambda: count("attended"))
    while ran["attended"] < 20:
        serve_once(executor, node, 10.0)
    assert ran["unattended"] == 0
