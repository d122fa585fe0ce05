#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# All tests but the long ones. Without arguments as four pytest processes side by side, each in ROS domains of its own:
# they wait most of the time. Arguments go to one pytest.
set -uo pipefail
if [ $# -gt 0 ]; then exec python -m pytest "$@"; fi

# A test that hangs where Python's own time-out cannot reach, in compiled code, ends its pytest with all threads' stacks.
pytest=(python -m pytest -c pyproject.toml -o faulthandler_timeout=420 -o faulthandler_exit_on_timeout=true)
mkdir -p out
declare -A beside
stop() {
    kill -INT "${beside[@]}" 2> /dev/null
    wait "${beside[@]}"
    exit 130
}
trap stop INT TERM
begin() {   # NAME TESTS...: into out/test-NAME.log
    # a job in the background would ignore SIGINT, and so would pytest
    env --default-signal=INT "${pytest[@]}" "${@:2}" > "out/test-$1.log" 2>&1 &
    beside[$1]=$!
}

nodes=(src/eel_dynamics/test/test_node_[!r]*.py)
begin nodes "${nodes[@]}" src/eel_ros/test src/eel_gaits/test src/eel_core/test
begin viz src/eel_viz/test
tools/core_tests.sh tests > out/test-core.log 2>&1 &
beside[core]=$!
begin system test
echo "[test] mechanics here; beside, shown when done: the dynamics node with the small packages, eel_viz, the processes together, the C++ tests"
"${pytest[@]}" src/eel_dynamics/test "${nodes[@]/#/--ignore=}"
status=$?
for name in core nodes viz system; do
    wait "${beside[$name]}" || status=1
    cat "out/test-$name.log"
done
exit "$status"
