# SPDX-License-Identifier: Apache-2.0
"""A ROS node: a learned policy steers the dynamics node, in lockstep, by the curvature or by the joints of a robot.

dynamics --ros-args -p real_time_factor:=0 -p rate:=10 -p duration:=20 -p scene.planar:=true
python docs/examples/policy_controller.py --ros-args -p heading:=0.6

The policy is a file of train_policy.py, or one that ppo/train.py writes. With `-p robot:=eight_servos`, as of the
dynamics node, it is one for HeadingEnv(action=JointAction("eight_servos")).
"""

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
from eel_common.ros.headers import seconds_of
from eel_common.ros.parameter_node import ParameterNode
from eel_common.ros.qos import keep_all
from eel_common.ros.run_node import run_node
from eel_dynamics.model.robot.joint_signs import message_signs
from eel_gaits.ros.lead import Lead
from eel_gaits.ros.messages import samples_to_message
from eel_gaits.ros.pilot_messages import head_motion
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState

from eel_gym import HeadingEnv, JointAction, LawAction
from eel_msgs.msg import CurvatureSamples

NAME, STEP = "policy_controller", 0.1  # s, control period
OWN = Path(__file__).with_name("policy_heading.json")


class Policy:
    """A network of layers with tanh between them: `action = policy(observation)`, (A,) of (D,).

    file: .json of train_policy.py, one layer with tanh behind it; or .npz with weight_0, bias_0, weight_1 and so on, as
    ppo/train.py writes it. `ValueError` for another file, or a network for other observations or actions than `env`'s.
    """

    def __init__(self, file, env):
        try:
            self.layers, self.bounded = self.read(Path(file))
            found = self.layers[0][0].shape[1], self.layers[-1][0].shape[0]
        except (ValueError, LookupError, TypeError) as error:
            raise ValueError(
                f"policy must be a file of train_policy.py or ppo/train.py, got {file} ({error})"
            ) from None
        wanted = *env.observation_space.shape, *env.action_space.shape
        if found != wanted:
            rule = f"{wanted[0]} observed numbers and {wanted[1]} of an action"
            raise ValueError(f"policy must be for {rule}, got one for {found[0]} and {found[1]}: {file}")

    @staticmethod
    def read(path) -> tuple[Any, Any]:
        """The layers of a file, each of weights and biases, and what bounds the last one."""
        if path.suffix == ".json":
            weights = np.array(json.loads(path.read_text())["weights"])
            return [(weights[:, :-1], weights[:, -1])], np.tanh
        with np.load(path) as found:
            layers = [(found[f"weight_{k}"], found[f"bias_{k}"]) for k in range(len(found) // 2)]
        return layers, lambda values: np.clip(values, -1.0, 1.0)

    def __call__(self, observation):
        values = observation.astype(float)
        for weight, bias in self.layers[:-1]:
            values = np.tanh(weight.astype(float) @ values + bias)
        weight, bias = self.layers[-1]
        return self.bounded(weight.astype(float) @ values + bias)


class PolicyController(ParameterNode):
    """Answers each sample. The rate of the run is that of training.

    A curvature is answered one control step ahead; commands of joints act at once, until the next.
    """

    def __init__(self):
        super().__init__(NAME, automatically_declare_parameters_from_overrides=False)  # they are declared below
        file, robot = self.declare_parameter("policy", str(OWN)).value, self.declare_parameter("robot", "").value
        self.declare_parameter("heading", 0.0)
        self.env = HeadingEnv(control_period=STEP, action=JointAction(robot) if robot else None)
        self.policy = Policy(file, self.env)
        self.action: Any = self.env.action
        self.lead, self.last, self.answers = Lead(STEP, STEP), np.inf, []
        self.odometry: Any = None
        self.joints: Any = None
        kind, topic = (JointState, "joint_commands") if robot else (CurvatureSamples, "curvature_samples")
        self.publisher = self.create_publisher(kind, topic, keep_all())
        self.create_subscription(Odometry, "odom", self.receive_odometry, keep_all())
        if robot:
            self.create_subscription(JointState, "joint_states", self.receive_joints, keep_all())

    def receive_odometry(self, odometry):
        """The head's motion; with a robot it waits for that of the joints."""
        self.odometry = odometry
        if isinstance(self.action, LawAction) or (self.joints and self.joints.header.stamp == odometry.header.stamp):
            self.answer()

    def receive_joints(self, joints):
        """The motion of the joints; it waits for that of the head."""
        self.joints = joints
        if self.odometry and self.odometry.header.stamp == joints.header.stamp:
            self.answer()

    def answer(self):
        """Answer one sample. In a run that is under way the first answer lies ahead too; a stamp that is repeated gets
        the same answers."""
        now = seconds_of(self.odometry.header.stamp)
        if now != self.last:
            self.last, self.answers = now, []
            if self.lead.begins(now):
                first, rows = self.lead.begin(now), self.env.restart()
                if isinstance(self.action, LawAction):
                    self.answers.append(samples_to_message(first, self.action.x, rows))
            if isinstance(self.action, JointAction):
                self.action.see(self.motion_of_joints())
            self.env.target = self.get_parameter("heading").value
            action = self.policy(self.env.see(head_motion(self.odometry)))
            for time in self.lead.after(now):
                rows = self.action.advance(action, STEP)
                if isinstance(self.action, LawAction):
                    self.answers.append(samples_to_message(time, self.action.x, rows))
                else:
                    self.answers.append(self.commands(rows))
        for answer in self.answers:
            self.publisher.publish(answer)

    def motion_of_joints(self):
        """Angles [rad] and rates [rad/s] of the joints (2, J), in the library's signs and order."""
        places = [self.joints.name.index(joint.name) for joint in self.action.robot.joints]
        return message_signs(self.action.robot) * np.array((self.joints.position, self.joints.velocity))[:, places]

    def commands(self, angles):
        """The message that commands these `angles` [rad] of the joints with servos, in the library's signs."""
        signs = dict(
            zip((joint.name for joint in self.action.robot.joints), message_signs(self.action.robot), strict=True)
        )
        angles = [signs[name] * angle for name, angle in zip(self.action.names, angles.tolist(), strict=True)]
        return JointState(header=self.odometry.header, name=[*self.action.names], position=angles)


def main() -> int:
    """Run until a signal comes. Status 2 for a policy that cannot be read."""
    return run_node(NAME, sys.argv, PolicyController, lambda node: True)


if __name__ == "__main__":
    sys.exit(main())
