# SPDX-License-Identifier: Apache-2.0
"""A node answers every call of a service or of its parameters, whatever its own code raises, and logs it."""

import time

import pytest
from eel_common.ros.parameter_node import ParameterNode
from eel_common.ros.serving import LARGEST_MESSAGE, serve_once
from rcl_interfaces.srv import GetParameters, SetParameters, SetParametersAtomically
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_msgs.msg import String
from std_srvs.srv import SetBool, Trigger

LIMIT = 90.0  # s
UNFORESEEN = (
    RecursionError("too deep"),
    MemoryError(),
    OSError(5, "Input/output error"),
    KeyError("a\nb"),
    SystemError(),
)


class Tank(ParameterNode):
    """Raises `error`, if it is set, in whatever is asked of it. Attributes: heard, texts of messages."""

    def __init__(self, context):
        super().__init__("tank", context=context)
        self.error, self.heard = None, []
        self.declare_parameter("depth", 1.0)
        self.declare_parameter("width", 1.0)
        self.add_on_set_parameters_callback(self.fail)
        self.create_service(Trigger, "~/drain", self.drain)
        self.create_service(SetBool, "~/fill", self.fill)
        self.create_subscription(String, "talk", lambda message: self.heard.append(message.data), 10)

    def fail(self, given):
        raise self.error

    def drain(self, request, response):
        raise self.error

    async def fill(self, request, response):
        raise self.error


class Talk:
    """A tank and somebody who calls it. log: the tank's errors."""

    def __init__(self, domain, monkeypatch):
        self.context = Context()
        self.context.init(args=[], domain_id=domain)
        self.tank = Tank(self.context)
        self.caller = Node("caller", context=self.context, start_parameter_services=False)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.tank)
        self.executor.add_node(self.caller)
        self.log = []
        log = type("Log", (), {"error": lambda _, text, **rest: self.log.append(text)})()
        monkeypatch.setattr(self.tank, "get_logger", lambda: log)

    def until(self, condition):
        deadline = time.monotonic() + LIMIT
        while not condition():
            assert time.monotonic() < deadline
            serve_once(self.executor, self.tank, 0.05)

    def call(self, kind, name, **request):
        client = self.caller.create_client(kind, f"tank/{name}")
        self.until(client.service_is_ready)
        answer = client.call_async(kind.Request(**request))
        self.until(answer.done)
        self.caller.destroy_client(client)
        return answer.result()


@pytest.fixture
def talk(fresh_domain, monkeypatch):
    talk = Talk(fresh_domain, monkeypatch)
    yield talk
    talk.executor.shutdown()
    talk.tank.destroy_node()
    talk.caller.destroy_node()
    talk.context.try_shutdown()


@pytest.mark.parametrize("error", UNFORESEEN, ids=lambda error: type(error).__name__)
def test_whatever_is_raised_the_caller_is_answered_and_it_is_logged(talk, error):
    talk.tank.error = error
    new = [Parameter(name, value=2.0).to_parameter_msg() for name in ("depth", "width")]
    results = talk.call(SetParameters, "set_parameters", parameters=new).results
    together = talk.call(SetParametersAtomically, "set_parameters_atomically", parameters=new).result
    answers = [talk.call(Trigger, "drain"), talk.call(SetBool, "fill", data=True)]
    assert len(results) == 2 and not any(each.successful for each in (*results, together))
    assert not any(each.success for each in answers)
    reasons = {*(each.reason for each in (*results, together)), *(each.message for each in answers)}
    (reason,) = reasons
    assert reason.startswith(type(error).__name__) and "\n" not in reason
    assert [text.partition(" is refused: ")[2] for text in talk.log] == [reason] * 4
    values = talk.call(GetParameters, "get_parameters", names=["depth", "width"]).values
    assert [value.double_value for value in values] == [1.0, 1.0]


def test_a_message_that_is_too_large_is_left_out_and_the_next_one_read(talk):
    publisher = talk.caller.create_publisher(String, "talk", 10)
    talk.until(publisher.get_subscription_count)
    for text in ("x" * LARGEST_MESSAGE, "fish"):
        publisher.publish(String(data=text))
    talk.until(lambda: talk.tank.heard)
    assert talk.tank.heard == ["fish"]
    (said,) = talk.log
    assert f"at most {LARGEST_MESSAGE} bytes, got 2097" in said
