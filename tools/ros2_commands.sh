#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The nodes used from a shell by ROS 2's own command, as a user does: run, topic, param, service, node, bag.
# A command that fails, or answers otherwise than it should, ends it with status 1. It needs `ros2`, and a workspace that is sourced.
# ros2_commands.sh [SECTION ...]: some of the sections below; without a name all of them.
set -uo pipefail
set -m   # each process in the background in a group of its own, where SIGINT reaches it
LIMIT=60   # s, for any one command
export ROS_DOMAIN_ID="${ROS_DOMAIN_ID:-42}" ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST PYTHONUNBUFFERED=1
cd "$(mktemp -d)" || exit 1
declare -A started
DYNAMICS=(ros2 run eel_dynamics dynamics --ros-args)
GAITS=(ros2 run eel_gaits gait_generator --ros-args)
STATE="{pose: {position: {z: -2.0}, orientation: {w: 1.0}}}"

fail() { echo "failed: $*"; tail -n 5 ./*.log; exit 1; }
trap 'for pid in "${started[@]}"; do kill -TERM -- "-$pid" 2> /dev/null; done; wait; rm -rf "$PWD"' EXIT
start() {   # NAME COMMAND...: in the background, its output in NAME.log
    "${@:2}" > "$1.log" 2>&1 &
    started[$1]=$!
    echo "[ros2] ${*:2} &"
}
await() {   # NAME TEXT: until NAME.log has it
    timeout "$LIMIT" bash -c 'until grep -qi -- "$2" "$1.log"; do sleep 0.1; done' - "$1" "$2" || fail "$1 did not say: $2"
}
end() {   # NAME...: by SIGINT
    local name
    for name; do kill -INT -- "-${started[$name]}"; wait "${started[$name]}"; unset "started[$name]"; done
}
leaves() { wait "${started[$1]}" || fail "$1 ended with status $?"; unset "started[$1]"; }   # NAME: by itself, with status 0
says() {   # TEXT COMMAND...: its status must be 0, and its answer have the text
    answer="$(timeout "$LIMIT" "${@:2}" 2>&1)" || fail "${*:2}: status $?: $answer"
    [[ $answer == *"$1"* ]] || fail "${*:2}: no '$1' in: $answer"
    echo "[ros2] ${*:2}: good"
}
refuses() {   # TEXT COMMAND...: its answer must have the text; its status is `ros2`'s own affair
    answer="$(timeout "$LIMIT" "${@:2}" 2>&1)"
    [[ $answer == *"$1"* ]] || fail "${*:2}: no '$1' in: $answer"
    echo "[ros2] ${*:2}: refused, as it should be"
}
one() { says "$3" ros2 topic echo "$1" --once --field "$2"; }   # TOPIC FIELD TEXT: of one message
set_to() { says "successful" ros2 param set /dynamics "$1" "$2"; }   # PARAMETER VALUE
call() { says "$1" ros2 service call "/dynamics/$2" "$3" "${@:4}"; }   # TEXT SERVICE TYPE [REQUEST]

a_controller_in_the_loop() {
    start dynamics "${DYNAMICS[@]}" -p rate:=50 -p real_time_factor:=0 -p subscriber_timeout:=60 -p duration:=4
    await dynamics "waiting for"
    one /odom header.stamp "sec: 0"
    start controller ros2 run eel_gaits heading_controller --ros-args -p heading:=0.6 -p period:=0.02
    leaves dynamics
    end controller
}

experiments_without_a_restart() {
    start dynamics "${DYNAMICS[@]}"
    start gaits "${GAITS[@]}" -p gait:=turning
    await dynamics adopted
    says "viscosity" ros2 param dump /dynamics
    echo "$answer" > run.yaml
    says "successful" ros2 param load /dynamics run.yaml
    [[ $answer != *failed* ]] || fail "the node refuses its own dump: $answer"
    printf 'x,half_width,half_height\n0,0,0\n0.2,0.02,0.04\n0.6,0.02,0.03\n1.2,0.01,0.01\n' > fish.csv
    set_to body "$PWD/fish.csv"
    set_to rate 50
    set_to stations 21
    set_to accuracy 1e-3
    set_to scene.density 900
    set_to initial_position '[0.0, 0, -1.5]'
    call "success=True" reset std_srvs/srv/Trigger
    one /body length "1.2"
    call "success=True" pause std_srvs/srv/SetBool "{data: true}"
    call "success=True" set_state eel_msgs/srv/SetState "$STATE"
    call "10 samples" step eel_msgs/srv/Step "{samples: 10}"
    end dynamics gaits
}

frames_and_namespaces() {
    start gaits "${GAITS[@]}" -r __ns:=/eel1
    start eel "${DYNAMICS[@]}" -r __ns:=/eel1 -p stations:=4 -p publish_tf_stations:=true -p yaw_joints:=3
    start markers ros2 run eel_viz markers --ros-args -r __ns:=/eel1
    await eel adopted
    says "/eel1/dynamics" ros2 node list
    one /tf transforms "eel1/base_link"
    one /eel1/odom header.frame_id "eel1/odom"
    one /eel1/internal_wrench header.frame_id "eel1/section"
    one /eel1/joint_states name "yaw_3"
    one /eel1/midline header.frame_id "eel1/odom"
    start second "${DYNAMICS[@]}" -r __ns:=/eel1 -r __node:=second
    await second "publishes .* already"
    end gaits eel markers second
}

a_bag() {
    start gaits "${GAITS[@]}"
    start record ros2 bag record -o bag /odom /internal_wrench
    await record recording
    start dynamics "${DYNAMICS[@]}" -p real_time_factor:=0 -p duration:=4 -p wait_for_subscribers:=1
    leaves dynamics
    end gaits record
    says "/internal_wrench" ros2 bag info bag
}

rates() {
    start gaits "${GAITS[@]}"
    start dynamics "${DYNAMICS[@]}" -p clock_rate:=10
    await dynamics adopted
    start hz ros2 topic hz /clock
    await hz "average rate: \(9\|10\|11\)\."
    end hz dynamics gaits
}

bad_input() {
    local wrong
    start dynamics "${DYNAMICS[@]}"
    start gaits "${GAITS[@]}"
    await dynamics adopted
    call "success=False" step eel_msgs/srv/Step "{samples: 1}"
    call "pose.position must be finite" set_state eel_msgs/srv/SetState "{pose: {position: {z: .nan}, orientation: {w: 1.0}}}"
    call "must be a unit quaternion" set_state eel_msgs/srv/SetState "{pose: {orientation: {w: 0.0}}}"
    for wrong in "body whale" "rate 0.0" "stations 1" "accuracy perfect" "scene.friction sticky" "duration 5.0"; do
        refuses "failed" ros2 param set /dynamics ${wrong}
    done
    refuses "failed" ros2 param set /gait_generator period -1.0
    one /odom child_frame_id "base_link"   # and the run goes on
    end dynamics gaits
}

all=(a_controller_in_the_loop experiments_without_a_restart frames_and_namespaces a_bag rates bad_input)
for section in "${@:-${all[@]}}"; do
    echo "[ros2] == ${section//_/ }"
    "$section"
done
echo "[ros2] all good"
