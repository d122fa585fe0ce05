#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds and tests each package of src (or those named) in a workspace that holds it and the packages it depends on, and
# nothing else of this folder: a line for each, with its tests. The workspace is out/alone; what colcon said is in its log.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
root="$PWD" alone="$PWD/out/alone"
source tools/install/environment.sh
export PATH="$root/.venv/bin:$PATH" AMENT_PREFIX_PATH="$root/.venv" CMAKE_PREFIX_PATH="$root/.venv" MAKEFLAGS="-j$(nproc)"
export LD_LIBRARY_PATH="$root/.venv/lib:$(echo .venv/lib/python3.*/site-packages/ros_*.libs | sed "s#\.venv#$root/.venv#g; s# #:#g")"
export ROS_DISTRO=jazzy ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST _ROS_WHEELS_BOOTSTRAP_COMPLETE=1
colcon() { "$root/.venv/bin/python" -m colcon --log-base "$alone/log" "$@"; }
suite=(--base-paths src tools/tf2_msgs)   # the wheels of ROS lack tf2_msgs; ROS from apt has it

mapfile -t packages < <(colcon list --base-paths src --names-only --topological-order)
[ $# = 0 ] || packages=("$@")
# One copy for all, newer than what earlier calls compiled.
rm -rf "$alone/all"
mkdir -p "$alone"
cp -r src "$alone/all"
cp -r tools/tf2_msgs "$alone/all/tf2_msgs"
find "$alone/all" \( -name '*.egg-info' -o -name __pycache__ \) -prune -exec rm -rf {} +
touch "$alone/all/COLCON_IGNORE"
failed=""
for package in "${packages[@]}"; do
    rm -rf "$alone/src"
    mkdir -p "$alone/src"
    held=()
    while read -r name _; do
        cp -rp "$alone/all/$name" "$alone/src/"
        [ "$name" = tf2_msgs ] || held+=("$name")
    done < <(colcon list "${suite[@]}" --packages-up-to "$package")
    cd "$alone"
    rm -rf "build/$package/test_results" "build/$package/pytest.xml"
    status=ok
    { colcon build --packages-up-to "$package" --cmake-args "-DPython3_EXECUTABLE=$root/.venv/bin/python" &&
        colcon test --packages-select "$package" --return-code-on-test-failure; } > "$package.log" 2>&1 ||
        { status=FAILED; failed="$failed $package"; }
    said="$(colcon test-result --test-result-base "build/$package" 2> /dev/null | tail -n 1 || true)"
    printf '[alone] %s (with %s): %s; %s\n' "$package" "${held[*]}" "$status" "${said:-no tests}"
    cd "$root"
done
[ -z "$failed" ] || { echo "[alone] failed:$failed; see out/alone"; exit 1; }
