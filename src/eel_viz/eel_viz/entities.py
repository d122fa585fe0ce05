# SPDX-License-Identifier: Apache-2.0
"""The entity paths of a recording, shared by loggers and blueprints.

A new curve begins here with its path. Then it needs name, colour and values (`SERIES`, and the method of its topic, in
plots/series.py; for motors robots/motor_plots.py, for fins and joints robots/parts.py, for sensors plots/sensors.py),
and a place in an arrangement (views/blueprint.py). `TIME_SERIES` in test/test_viz_loggers.py lists the curves.

There are three trees: `/world` (three-dimensional, metres, the world frame of the messages, z up), `/profiles` and
`/heat_map` (two-dimensional drawings against the abscissa X), `/plots` (scalars over time). `/numbers` holds the
profiles of the messages unchanged, in double precision; no view draws them.
"""

TIMELINE = "sim_time"  # duration since the start of the simulation, from header.stamp

# --- three dimensions, world frame [m] ---------------------------------------------------------------------------
WORLD = "/world"
WORLD_FRAME, HEAD_FRAME = "odom", "base_link"  # names of the world's and the head's frame, for other programs' entities
FOLLOW = "/world/follow"  # a frame that moves with the swimmer without turning; radius and centre: see scene3d.camera
WHOLE_PATH = "/world/whole_path"  # the frame around the whole path so far
BOTH = "/world/both"  # the frame that moves with two swimmers
LEGEND = "/world/follow/legend"
FLOW_LEGEND = "/world/follow/legend/flow"
WAKE_LEGEND = "/world/follow/legend/wake"
WATER = "/world/water/near"  # around each frame; below each of them: grid, labels, walls
PATH_WATER = "/world/water/path"
BOTH_WATER = "/world/water/both"
SHADOW = "/world/water/near/shadow"
SKIN = "/world/eel/skin"  # its flanks coloured by C3
EYES = "/world/eel/eyes"
FINS = "/world/eel/fins"
APPENDAGES = "/world/eel/appendages"  # balls as wide as their drag areas
JOINTS = "/world/eel/joints"  # rings, coloured by the motors' torque / limit
BACKBONE = "/world/eel/backbone"
HEAD = "/world/eel/head"
TAIL = "/world/eel/tail"
TRACK = "/world/track"  # the whole path of the head, piece by piece
STROBES = "/world/strobes"  # the midline, once a second
COURSE = "/world/course/legs"  # between the way points of a goal
TUBE = "/world/course/tube"  # around the legs, as wide as the spheres
WAY_POINTS = "/world/course/points"  # spheres in which they count as reached
NOTES = "/world/notes"
HEADING = "/world/notes/heading"  # an arrow ahead of the head
SPEED_NOTE = "/world/notes/speed"  # words beside it
TRAIL = "/world/trail"  # its last seconds, fading
LOAD = "/world/load/distributed"
LOAD_ENDS = "/world/load/ends"
FLOW = "/world/flow"  # arrows: motion of the undisturbed water
WAKE = "/world/wake"  # a ribbon: momentum per time given to the wake, in the last seconds

# --- drawings against X ------------------------------------------------------------------------------------------
PROFILES = "/profiles"
TORQUE = "/profiles/torque"
FORCE = "/profiles/force"
CURVATURE = "/profiles/curvature"
# below each of the three:
CURVES = "curves"
ENVELOPE = "envelope"
FRAME = "frame"
TICKS = "ticks"
KEY = "key"

HEAT_MAP = "/heat_map"
LOAD_MAP = "/load_map"  # of motors over time
# below each of the two, beside a frame:
IMAGE = "image"
HEAT_MAP_IMAGE, HEAT_MAP_FRAME = f"{HEAT_MAP}/{IMAGE}", f"{HEAT_MAP}/{FRAME}"

# --- scalars over time -------------------------------------------------------------------------------------------
PLOTS = "/plots"
POSITION = "/plots/position"  # x, y, z of the head [m]
ORIENTATION = "/plots/orientation"  # x, y, z, w of the head
ATTITUDE = "/plots/attitude"  # heading, pitch, roll [deg]
LINEAR = "/plots/linear_velocity"  # of the head, in base_link [m/s]
ANGULAR = "/plots/angular_velocity"  # of the head, in base_link [rad/s]
SPEED = "/plots/speed"
DEPTH = "/plots/depth"
POWER = "/plots/power"  # actuator, wake, nose, drag [W]
POWER_BESIDES = "/plots/power_besides"  # flow, fins, dampers, appendages, outside [W]: from the first non-zero value on
KINETIC = "/plots/kinetic"  # body, fluid [J]
STORED = "/plots/stored"  # of weight, and of springs [J]: likewise
RESIDUAL = "/plots/residual"  # [J]
FIN_ANGLES = "/plots/fin_angles"  # [deg]
HARDEST_MOTOR = "/plots/hardest_motor"  # torque of the motor closest to its limit, and the limit [N m]
SATURATED = "/plots/saturated_motors"  # number of motors at their limits
MOTOR_POWER = "/plots/motor_power"  # of all motors [W]
FORCE_READ = "/plots/imu/specific_force"  # of published sensors, in their axes [m/s^2]
TURNING_READ = "/plots/imu/angular_velocity"  # [rad/s]
PRESSURE_READ = "/plots/pressure"  # [Pa]
DEPTH_READ = "/plots/depth_read"  # [m]
VELOCITY_READ = "/plots/velocity_read"  # [m/s]
MOTOR_WORK = "/plots/motor_work"  # of all motors since the start [J]

# --- the profiles of the messages, in double precision -------------------------------------------------------------
NUMBERS = "/numbers"
WRENCH_NUMBERS = "/numbers/internal_wrench"
CURVATURE_NUMBERS = "/numbers/curvature"
LOAD_NUMBERS = "/numbers/hydrodynamic_load"
BODY_NUMBERS = "/numbers/body"
ODOMETRY_NUMBERS = "/numbers/odom"
FIN_NUMBERS = "/numbers/fin_states"
JOINT_NUMBERS = "/numbers/joint_states"
MOTOR_NUMBERS = "/numbers/motor_states"

# --- text --------------------------------------------------------------------------------------------------------
LOOK = "/run/look"  # what to look at
RUN = "/run/summary"
LOG = "/run/log"

# --- another run, laid over this one -----------------------------------------------------------------------------
OTHER = "/world/other"
OTHER_HOOPS = "/world/other/hoops"
OTHER_BACKBONE = "/world/other/backbone"
COMPARED_TORQUE = "/compare/torque"
TORQUE_DIFFERENCE = "/compare/torque_difference"
OTHER_SPEED = "/compare/speed"  # of the other
DISTANCE = "/compare/distance"  # between the heads [m]
TORQUE_DIFFERENCE_MOST = "/compare/torque_difference_most"  # over X and the axes [N m]
COMPARE_TEXT = "/compare/summary"
