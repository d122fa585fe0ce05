# SPDX-License-Identifier: Apache-2.0
"""Names and types of the swimmer's topics, and fields of its energy ledger, as texts: this module imports no ROS.

A new topic needs an entry here. A new message type needs a file in eel_msgs/msg, named in eel_msgs/CMakeLists.txt.
`SampleMessages` (eel_dynamics/ros/messages.py) makes the message. `FIELDS`
(eel_dynamics/runs/exchange/message_fields.py) says which quantity of `Observations` fills each field. Other fields are
filled by `SampleMessages`, and for runs by `_sample` (eel_dynamics/runs/exchange/messages_of_run.py). `PARTS` and
`NOT_AWAITED` (eel_dynamics/ros/publishers.py) name its costly quantities, and topics whose subscribers the start does
not await. A topic of `INPUTS` has its own subscription, as eel_dynamics/ros/current_subscription.py. A topic of
`LATCHED` is published once, as the body is. `READERS` (eel_viz/recording/dispatcher.py) reads it, and methods of its
name in the classes of `Loggers` draw it.
"""

OWN = {  # relative names: below the swimmer's namespace
    "head_pose": "geometry_msgs/msg/PoseStamped",
    "head_twist": "geometry_msgs/msg/TwistStamped",
    "odom": "nav_msgs/msg/Odometry",
    "backbone": "eel_msgs/msg/Backbone",
    "curvature": "eel_msgs/msg/Curvature",
    "internal_wrench": "eel_msgs/msg/InternalWrench",
    "hydrodynamic_load": "eel_msgs/msg/HydrodynamicLoad",
    "energy": "eel_msgs/msg/EnergyLedger",
    "swim_state": "eel_msgs/msg/SwimState",
    "flow_vectors": "eel_msgs/msg/FlowVectors",
    "flow_at_head": "geometry_msgs/msg/Vector3Stamped",
    "joint_states": "sensor_msgs/msg/JointState",
    "joint_commands": "sensor_msgs/msg/JointState",
    "fin_states": "sensor_msgs/msg/JointState",
    "motor_states": "eel_msgs/msg/MotorStates",
    "imu": "sensor_msgs/msg/Imu",
    "pressure": "sensor_msgs/msg/FluidPressure",
    "depth": "geometry_msgs/msg/PoseWithCovarianceStamped",
    "velocity": "geometry_msgs/msg/TwistWithCovarianceStamped",
    "body": "eel_msgs/msg/BodyGeometry",
    "curvature_law": "eel_msgs/msg/CurvatureLaw",
    "curvature_samples": "eel_msgs/msg/CurvatureSamples",
    "current": "geometry_msgs/msg/Vector3Stamped",
    "fin_command": "sensor_msgs/msg/JointState",
    "external_wrench": "geometry_msgs/msg/WrenchStamped",
    "goal": "nav_msgs/msg/Path",
}
DIAGNOSTICS = "/diagnostics"
GLOBAL = {"/clock": "rosgraph_msgs/msg/Clock", DIAGNOSTICS: "diagnostic_msgs/msg/DiagnosticArray"}
LATCHED = ("body", "curvature_law", "goal")  # transient local
# From controllers and sensors.
INPUTS = "curvature_samples", "joint_commands", "current", "fin_command", "external_wrench"
SAMPLED = tuple(name for name in OWN if name not in (*LATCHED, *INPUTS))  # once a sample
SENSORS = ("imu", "pressure", "depth", "velocity")  # of `SAMPLED`: at their own rates
WHERE_ASKED_FOR = (*SENSORS, "joint_states", "fin_states", "motor_states", "flow_vectors")  # of `SAMPLED`: if there
SWIMMER = "head_pose"  # without publishers of this topic the swimmer has gone
LATER_ENERGY_FIELDS = (  # missing in older bags
    *("flow_power", "fins_power", "damping_power", "elastic"),
    *(f"{part}_work" for part in ("actuator", "wake", "nose", "drag", "flow", "fins", "damping")),
    *("appendages_power", "appendages_work", "external_power", "external_work"),
)
ENERGY_FIELDS = (  # of the message EnergyLedger, in its order
    *("kinetic_body", "kinetic_fluid", "potential"),
    *("actuator_power", "wake_power", "nose_power", "drag_power"),
    "residual",
    *LATER_ENERGY_FIELDS,
)
