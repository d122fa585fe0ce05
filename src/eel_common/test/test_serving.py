# SPDX-License-Identifier: Apache-2.0
"""Callbacks that raise do not end the node; what is left to the node is left alone by the executor."""

import time

import pytest
from eel_common.ros.serving import PolledGroup, ServedNode, log_dropped, serve_once
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import Header


class Log:
    def __init__(self):
        self.lines = []

    def error(self, text):
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


def test_what_is_left_out_is_told_at_most_once_a_second_for_each_topic_with_its_count(served, monkeypatch):
    node, executor, errors = served
    clock = [100.0]
    monkeypatch.setattr("eel_common.ros.serving.time.monotonic", lambda: clock[0])
    for _ in range(30):
        for topic in ("/odom", "/goal"):
            log_dropped(node, ValueError("no message"), f"a message of {topic}")
        clock[0] += 0.01
    assert errors == [
        f"a message of {topic} cannot be taken and is left out: ValueError: no message" for topic in ("/odom", "/goal")
    ]
    errors.clear()
    clock[0] += 1.0
    for _ in range(2):  # the second has nothing to tell
        serve_once(executor, node, 0.0)
    assert errors == [
        f"a message of {topic} cannot be taken and is left out (30 so far): ValueError: no message"
        for topic in ("/odom", "/goal")
    ]


def test_bytes_that_are_no_message_are_one_line_and_the_next_message_is_taken(served, capfd):
    """rclpy's own way would leave lines of the C libraries on stderr."""
    plain, _, _ = served
    node = ServedNode("pool", context=plain.context, start_parameter_services=False)
    executor = SingleThreadedExecutor(context=plain.context)
    executor.add_node(node)
    log, received = Log(), []
    node.get_logger = lambda: log
    node.create_subscription(Header, "level", received.append, 10)
    publisher = plain.create_publisher(Header, "level", 10)
    deadline = time.monotonic() + 60.0
    while not (received and log.lines) and time.monotonic() < deadline:
        publisher.publish(b"\x00\x01\x00\x00" + b"\xff" * 5)
        publisher.publish(Header(frame_id="water"))
        serve_once(executor, node, 0.1)
        serve_once(executor, node, 0.1)
    executor.shutdown()
    node.destroy_node()
    assert received[0].frame_id == "water"
    assert log.lines[0].startswith("a message of /level cannot be taken and is left out: RMWError: ")
    assert capfd.readouterr().err == ""


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


def test_a_raw_callback_that_raises_names_its_topic(served):
    plain, _, _ = served
    node = ServedNode("pool", context=plain.context, start_parameter_services=False)
    executor, log, received = SingleThreadedExecutor(context=plain.context), Log(), []
    executor.add_node(node)
    node.get_logger = lambda: log

    def refuse(data, about):
        received.append(about["source_timestamp"])
        raise EOFError("it ends before its fields")

    node.create_subscription(Header, "level", refuse, 10, raw=True)
    publisher = plain.create_publisher(Header, "level", 10)
    deadline = time.monotonic() + 60.0
    while not received and time.monotonic() < deadline:
        publisher.publish(Header())
        serve_once(executor, node, 0.1)
    executor.shutdown()
    node.destroy_node()
    assert received
    assert log.lines[0] == "a message of /level cannot be taken and is left out: EOFError: it ends before its fields"
