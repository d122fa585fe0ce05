#!/usr/bin/env bash
# All tests but the long ones. Without arguments as four pytest processes side by side, each in ROS domains of its own:
# they wait most of the time. Arguments go to one pytest.
set -uo pipefail
if [ $# -gt 0 ]; then exec python -m pytest -m "not soak" "$@"; fi

# A test that hangs where Python's own time-out cannot reach, in compiled code, ends its pytest with all threads' stacks.
pytest=(python -m pytest -m "not soak" -o faulthandler_timeout=420 -o faulthandler_exit_on_timeout=true)
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

nodes=(test/eel_dynamics/test_node_[!r]*.py)
begin nodes "${nodes[@]}"
begin viz test/eel_viz
tools/core_tests.sh tests > out/test-core.log 2>&1 &
beside[core]=$!
begin system test/system test/eel_ros test/eel_gaits test/eel_core
echo "[test] mechanics here; the dynamics node, test/eel_viz, test/system with test/eel_ros, test/eel_gaits and test/eel_core, and the C++ tests beside, shown when done"
"${pytest[@]}" test/eel_dynamics "${nodes[@]/#/--ignore=}"
status=$?
for name in core nodes viz system; do
    wait "${beside[$name]}" || status=1
    cat "out/test-$name.log"
done
exit "$status"
