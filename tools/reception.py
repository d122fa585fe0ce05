# SPDX-License-Identifier: Apache-2.0
"""Every message of a run, as a subscriber on the network receives it: KEEP_ALL, in a thread of its own.

Of the messages that repeat sample 0 before the run begins, the last is kept.
"""

import contextlib
import threading
from collections import defaultdict
from functools import partial

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from eel_ros.fastdds_profile import use_profile
from geometry_msgs.msg import PoseStamped, TwistStamped
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

from eel_msgs.msg import CurvatureLaw, EnergyLedger, InternalWrench

EVERY = QoSProfile(history=HistoryPolicy.KEEP_ALL, depth=1, reliability=ReliabilityPolicy.RELIABLE)
LATCHED = QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL)
TOPICS = {
    "head_pose": (PoseStamped, EVERY),
    "head_twist": (TwistStamped, EVERY),
    "internal_wrench": (InternalWrench, EVERY),
    "energy": (EnergyLedger, EVERY),
    "curvature_law": (CurvatureLaw, LATCHED),
    "/diagnostics": (DiagnosticArray, EVERY),
}


class Reception:
    """Listens from construction to `close`; `messages[topic]` is the list of what came, in order."""

    def __init__(self, domain: int) -> None:
        self.messages: dict[str, list] = defaultdict(list)
        use_profile()
        self._context = rclpy.Context()
        rclpy.init(context=self._context, domain_id=domain)
        self._node = rclpy.create_node("reception", context=self._context)
        for topic, (kind, qos) in TOPICS.items():
            self._node.create_subscription(kind, topic, partial(_keep, self.messages[topic]), qos)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._thread = threading.Thread(target=self._spin, name="reception", daemon=True)
        self._thread.start()

    def _spin(self) -> None:
        with contextlib.suppress(ExternalShutdownException):
            self._executor.spin()

    def close(self) -> None:
        """Stop listening; the messages stay."""
        rclpy.try_shutdown(context=self._context)
        self._thread.join(timeout=5.0)
        self._node.destroy_node()


def _keep(messages: list, message) -> None:
    """Append `message`, in place of the last one where both are sample 0."""
    stamped = hasattr(message, "header") and not isinstance(message, (CurvatureLaw, DiagnosticArray))
    if stamped and messages and message.header.stamp == messages[-1].header.stamp:
        messages.pop()
    messages.append(message)
