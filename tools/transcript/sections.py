# SPDX-License-Identifier: Apache-2.0
"""What the transcript does, a function for each of its sections: heading, then commands."""

from shell import Shell

DYNAMICS = "ros2 run eel_dynamics dynamics --ros-args"
GAITS = "ros2 run eel_gaits gait_generator --ros-args"
WRITE_FISH = "printf 'x,half_width,half_height\\n0,0,0\\n0.2,0.02,0.04\\n0.6,0.02,0.03\\n1.2,0.01,0.01\\n' > fish.csv"
SAMPLE = (
    "{header: {stamp: {sec: %d}}, x: [0.0, 1.0], yaw: [1.0, 1.0]"
    + "".join(f", {name}: [0.0, 0.0]" for name in ("pitch", "pitch_rate", "pitch_accel", "yaw_rate", "yaw_accel"))
    + "}"
)


def the_loop_closes(shell: Shell) -> None:
    """A controller in the loop"""
    shell.say("the node waits, repeats sample 0, and a controller that answers to /odom starts the run")
    lockstep = f"{DYNAMICS} -p rate:=50 -p real_time_factor:=0 -p subscriber_timeout:=60"
    for run in (1, 2, 3):
        if run == 2:
            shell.say("the same twice more")
        kept = len(shell.lines)
        shell.start("dynamics", f"{lockstep} -p duration:=4")
        shell.wait_for("dynamics", "waiting for")
        if run == 1:
            shell.run("cat dynamics.log")
            shell.run("ros2 topic hz /odom")
            shell.run("ros2 topic echo /odom --once --field header.stamp")
        shell.start("record", f"ros2 bag record -o run{run} /odom")
        shell.wait_for("record", "recording")
        shell.start("controller", "ros2 run eel_gaits heading_controller --ros-args -p heading:=0.6 -p period:=0.02")
        shell.wait_for_end("dynamics")
        shell.end("controller", "record")
        if run > 1:
            del shell.lines[kept:]
    shell.say("three runs are the same to the bit")
    shell.run("python tools/transcript/bag_hash.py /odom run1 run2 run3")

    shell.say("a reset with a running controller: the run goes on")
    shell.start("dynamics", lockstep)
    shell.start("controller", "ros2 run eel_gaits heading_controller --ros-args -p period:=0.02")
    shell.wait_for("dynamics", "waiting for")
    shell.run("for k in 1 2 3; do ros2 service call /dynamics/reset std_srvs/srv/Trigger; done | grep -c success=True")
    shell.run("ros2 topic echo /odom --once --field header.stamp.sec | awk 'NR == 1 {print ($1 > 0)}'")
    shell.run("grep -c 'reset to t = 0 s' dynamics.log; grep -c 'run out' dynamics.log")
    shell.end("dynamics", "controller")

    shell.say(
        "samples from a best-effort publisher, the first of stamp 0; the warning is about the reliable one of two"
    )
    shell.say("subscriptions, the other takes them")
    shell.start("dynamics", f"{lockstep} -p stations:=2 -p default_transition:=0.5")
    shell.wait_for("dynamics", "waiting for")
    shell.start("yaw", "ros2 topic echo /curvature --field yaw")
    for second in (0, 1):
        shell.run(
            "ros2 topic pub --once --qos-reliability best_effort /curvature_samples eel_msgs/msg/CurvatureSamples "
            f'"{SAMPLE % second}"'
        )
    shell.wait_for("yaw", "- 1.0\n- 1.0")
    shell.run("tail -n 3 yaw.log")
    shell.end("dynamics", "yaw")


def experiments_change(shell: Shell) -> None:
    """Experiments change without a restart"""
    shell.start("dynamics", DYNAMICS)
    shell.start("gaits", f"{GAITS} -p gait:=turning")
    shell.wait_for("dynamics", "adopted")
    shell.say("the node takes its own dump, every parameter of it")
    shell.run("ros2 param dump /dynamics > run.yaml; grep viscosity run.yaml")
    shell.run("ros2 param load /dynamics run.yaml > answers; grep -c successful answers; grep failed answers")
    shell.say("settings for the next reset")
    shell.run(WRITE_FISH)
    shell.run('ros2 param set /dynamics body "$PWD/fish.csv"')
    for setting in (
        "rate 50",
        "stations 21",
        "accuracy 1e-3",
        "scene.density 900",
        "initial_position '[0.0, 0, -1.5]'",
    ):
        shell.run(f"ros2 param set /dynamics {setting}")
    shell.run("ros2 topic echo /body --once --field length")
    shell.run("ros2 service call /dynamics/reset std_srvs/srv/Trigger")
    shell.run("ros2 topic echo /body --once --field length")
    shell.run("ros2 topic echo /backbone --once --field x | wc -l")
    shell.say("eleven values of a gait make one law")
    shell.run(
        "ros2 param dump /gait_generator | sed 's/ period: 1.0/ period: 0.8/' > gait.yaml; grep -c '[.]' gait.yaml"
    )
    shell.run("grep -c 'published on' gaits.log")
    shell.run("ros2 param load /gait_generator gait.yaml | grep -vc failed")
    shell.run("grep -c 'published on' gaits.log")
    shell.say("pause, steps, and another state of the head")
    shell.run('ros2 service call /dynamics/pause std_srvs/srv/SetBool "{data: true}"')
    shell.run('ros2 service call /dynamics/step eel_msgs/srv/Step "{samples: 10}"')
    state = "{pose: {position: {z: -2.0}, orientation: {w: 1.0}}, twist: {linear: {x: 0.3}}}"
    shell.start("depth", "ros2 topic echo /swim_state --field depth")
    shell.run(f'ros2 service call /dynamics/set_state eel_msgs/srv/SetState "{state}"')
    shell.run('ros2 service call /dynamics/step eel_msgs/srv/Step "{samples: 1}"')
    shell.run("awk 'NR == 1 {printf \"%.1f\\n\", $1}' depth.log")
    shell.end("dynamics", "gaits", "depth")

    shell.say("one parameter file for all nodes; a name that nobody has gets a hint, those of others none")
    shell.run(
        "printf '/**:\\n  ros__parameters:\\n    gait: turning\\n    stations: 21\\n    heading: 0.3\\n"
        "    ratee: 50.0\\n' > all.yaml"
    )
    for name, command in (("gaits", "eel_gaits gait_generator"), ("dynamics", "eel_dynamics dynamics")):
        shell.start(name, f"ros2 run {command} --ros-args --params-file all.yaml")
    shell.wait_for("dynamics", "adopted")
    shell.run("grep -h WARN gaits.log dynamics.log")
    shell.end("dynamics", "gaits")


def frames_and_tools(shell: Shell) -> None:
    """Frames, and what other tools see"""
    shell.say("two eels in two namespaces")
    shell.start("gaits1", f"{GAITS} -r __ns:=/eel1")
    shell.start("eel1", f"{DYNAMICS} -r __ns:=/eel1 -p stations:=4 -p publish_tf_stations:=true -p yaw_joints:=3")
    shell.start("gaits2", f"{GAITS} -r __ns:=/eel2 -p gait:=turning -p left_bend:=1.0")
    shell.start("eel2", f"{DYNAMICS} -r __ns:=/eel2")
    for name in ("eel1", "eel2"):
        shell.wait_for(name, "adopted")
    shell.run("ros2 node list")
    shell.start("tf", "ros2 topic echo /tf")
    for frame in ("eel1/section_3", "eel2/base_link"):
        shell.wait_for("tf", frame)
    shell.end("tf")
    shell.run("grep frame_id: tf.log | sort -u")
    for topic in ("odom", "internal_wrench", "hydrodynamic_load", "curvature"):
        shell.run(f"ros2 topic echo /eel1/{topic} --once --field header.frame_id")
    shell.say("motors of a robot of three joints, and scalars to plot")
    shell.run("ros2 topic echo /eel1/joint_states --once | sed 's/: [^ ].*//; s/^- [-0-9].*/- .../'", most=30)
    shell.run("ros2 topic echo /eel2/swim_state --once | sed 's/: [^ ].*//'")
    shell.say("the skin, the loads and the midline for RViz and Foxglove")
    shell.start("markers", "ros2 run eel_viz markers --ros-args -r __ns:=/eel2")
    shell.run("ros2 topic echo /eel2/midline --once --field header.frame_id")
    shell.run("ros2 topic echo /eel2/markers --once | grep ' ns:' | sort | uniq -c")
    shell.say("left_bend > 0 turns left: the mean rate about z, up, is positive")
    shell.start("turn", "ros2 topic echo /eel2/odom --field twist.twist.angular.z")
    shell.wait_for_lines("turn", 800)
    shell.end("turn")
    shell.run("awk '/[0-9]/ {sum += $1} END {print (sum > 0)}' turn.log")
    shell.say("a second dynamics node with the same topics")
    shell.start("second", f"{DYNAMICS} -r __ns:=/eel2 -r __node:=second")
    shell.wait_for("second", "ERROR")
    shell.wait_for("eel2", "ERROR")
    shell.run("grep -h ERROR eel2.log second.log")
    shell.end("gaits1", "eel1", "gaits2", "eel2", "second", "markers")
    shell.say("a picture of the markers: paused at the start, then 830 steps to 8.3 s")
    shell.start("dynamics", f"{DYNAMICS} -p real_time_factor:=4.0")
    shell.wait_for("dynamics", "waiting for")
    shell.run('ros2 service call /dynamics/pause std_srvs/srv/SetBool "{data: true}"')
    shell.start("gaits", GAITS)
    shell.start("markers", "ros2 run eel_viz markers")
    shell.start("picture", "python tools/transcript/marker_picture.py 8.3 markers.png")
    shell.wait_for("picture", "waiting for")
    shell.wait_for("dynamics", "adopted")
    shell.run('ros2 service call /dynamics/step eel_msgs/srv/Step "{samples: 830}"')
    shell.wait_for_end("picture")
    shell.end("dynamics", "gaits", "markers")
    shell.say("the sign of a current")
    shell.run("simulate --help | grep -o 'current = .*'")


def flow(shell: Shell) -> None:
    """As fast as possible, and nothing lost"""
    shell.start("gaits", GAITS)
    shell.start("record", "ros2 bag record --stop-with-publisher -o bag /odom /backbone /internal_wrench /energy")
    shell.wait_for("record", "recording")
    shell.start("dynamics", f"{DYNAMICS} -p real_time_factor:=0 -p duration:=8")
    shell.wait_for_end("dynamics")
    shell.wait_for_end("record")
    shell.run("python tools/transcript/bag_hash.py - bag")
    shell.say("a late subscriber")
    shell.start("dynamics", f"{DYNAMICS} -p real_time_factor:=0")
    shell.wait_for("dynamics", "adopted")
    shell.run("ros2 topic echo /odom --once --field child_frame_id")
    shell.wait_for("dynamics", "came late")
    shell.run("grep -m 1 late dynamics.log")
    shell.end("dynamics")
    shell.say("/clock at a rate of its own")
    shell.start("dynamics", f"{DYNAMICS} -p clock_rate:=10")
    shell.wait_for("dynamics", "adopted")
    shell.run("ros2 topic hz /clock")
    shell.end("dynamics", "gaits")


def bad_input(shell: Shell) -> None:
    """Bad input is refused with field and value, and the run goes on"""
    shell.start("dynamics", DYNAMICS)
    shell.start("gaits", GAITS)
    shell.wait_for("dynamics", "adopted")
    shell.run('ros2 service call /dynamics/step eel_msgs/srv/Step "{samples: 1}"')
    shell.run('ros2 service call /dynamics/pause std_srvs/srv/SetBool "{data: true}"')
    for samples in (0, 10**12):
        shell.run(f'ros2 service call /dynamics/step eel_msgs/srv/Step "{{samples: {samples}}}"')
    for state in (
        "{pose: {position: {z: .nan}, orientation: {w: 1.0}}}",
        "{pose: {orientation: {w: 0.0}}}",
        "{pose: {orientation: {w: 1.0}}, twist: {linear: {y: .inf}}}",
    ):
        shell.run(f'ros2 service call /dynamics/set_state eel_msgs/srv/SetState "{state}"')
    for setting in (
        "body whale",
        "rate 0.0",
        "rate nan",
        "rat 50",
        "stations 1",
        "accuracy perfect",
        "scene.friction sticky",
        "scene.planar 1",
        "scene.current '[1.0, .nan, 0.0]'",
        "initial_orientation '[0.0, 0.0, 0.0, 0.0]'",
        "initial_position '[1.0, 2.0]'",
        "duration 5.0",
        "real_time_factor 0.0",
    ):
        shell.run(f"ros2 param set /dynamics {setting}")
    shell.say("a body file that is gone at the next reset")
    shell.run(WRITE_FISH)
    shell.run("ros2 param set /dynamics body fish.csv")
    shell.run("rm fish.csv; ros2 service call /dynamics/reset std_srvs/srv/Trigger")
    for setting in ("gait wurst", "period -1.0", "perod 0.5"):
        shell.run(f"ros2 param set /gait_generator {setting}")
    shell.run('ros2 service call /dynamics/pause std_srvs/srv/SetBool "{data: false}"')
    shell.run("ros2 topic echo /odom --once --field child_frame_id")
    shell.end("dynamics", "gaits")


def packages(shell: Shell) -> None:
    """Packages"""
    shell.run("cp -r tools/../src . && colcon list")
    shell.run(
        'python -c "from catkin_pkg.package import parse_package; import glob; '
        "found = {f: [] for f in sorted(glob.glob('src/*/package.xml'))}; "
        '[print(p.name, p.version, *p.licenses, w) for f, w in found.items() for p in [parse_package(f, warnings=w)]]"'
    )
    shell.run("colcon build --packages-select eel_ros 2>&1 | tail -n 2")
    shell.run(
        "colcon test --packages-select eel_ros --return-code-on-test-failure 2>&1 | tail -n 1; "
        "colcon test-result | tail -n 1"
    )
    shell.say("a test that fails is a failure of colcon")
    shell.run("echo 'def test_no(): assert False' >> src/eel_ros/test/test_qos.py")
    shell.run(
        "colcon test --packages-select eel_ros --return-code-on-test-failure --pytest-args -k test_no > out 2>&1; "
        "echo status $?; colcon test-result | tail -n 1"
    )


SECTIONS = (the_loop_closes, experiments_change, frames_and_tools, flow, packages, bad_input)
