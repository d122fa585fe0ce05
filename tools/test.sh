#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# All tests but the long ones. The mechanics run in one process, which keeps account of what they measure. Beside them,
# the files whose tests start processes and wait most of the time are dealt out to four workers, each in a ROS domain of
# its own. Arguments go to one pytest.
set -uo pipefail
if [ $# -gt 0 ]; then exec python -m pytest "$@"; fi

# A test that hangs where Python's own time-out cannot reach, in compiled code, ends its pytest with all threads' stacks.
pytest=(python -m pytest -c pyproject.toml -o faulthandler_timeout=420 -o faulthandler_exit_on_timeout=true)
nodes=(src/eel_dynamics/test/test_node_[!r]*.py)
mkdir -p out
declare -A beside
stop() {
    kill -INT "${beside[@]}" 2> /dev/null
    wait "${beside[@]}"
    exit 130
}
trap stop INT TERM
# a job in the background would ignore SIGINT, and so would pytest
env --default-signal=INT "${pytest[@]}" --numprocesses=4 --dist=loadfile \
    "${nodes[@]}" src/eel_ros/test src/eel_gaits/test src/eel_core/test src/eel_viz/test test > out/test-processes.log 2>&1 &
beside[processes]=$!
tools/core_tests.sh tests > out/test-core.log 2>&1 &
beside[core]=$!
echo "[test] mechanics here; beside, shown when done: the tests that start processes, and the C++ tests"
"${pytest[@]}" src/eel_dynamics/test "${nodes[@]/#/--ignore=}"
status=$?
for name in core processes; do
    wait "${beside[$name]}" || status=1
    cat "out/test-$name.log"
done
exit "$status"
