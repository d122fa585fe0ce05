#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# All tests but the long ones. The files that measure (docs/appendix/validation.csv) run in one process, which keeps
# account of what they found. Beside it, all other files are dealt out to four workers, the longest folders first, each in a
# ROS domain of its own: most of them start processes, and wait for them. Arguments go to one pytest.
set -uo pipefail
if [ $# -gt 0 ]; then exec python -m pytest "$@"; fi

# A test that hangs where Python's own time-out cannot reach, in compiled code, ends its pytest with all threads' stacks.
pytest=(python -m pytest -c pyproject.toml -o faulthandler_timeout=420 -o faulthandler_exit_on_timeout=true)
mapfile -t measuring < <(grep -lE '\((.*, )?(measured|checks)\b' src/eel_dynamics/test/test_*.py)
mkdir -p out
declare -A beside
stop() {
    kill -INT "${beside[@]}" 2> /dev/null
    wait "${beside[@]}"
    exit 130
}
trap stop INT TERM
tools/core_tests.sh tests > out/test-core.log 2>&1 &
beside[core]=$!
# In a fresh folder what is imported is compiled first: once, not by each of the five.
[ -d test/__pycache__ ] || "${pytest[@]}" --collect-only > /dev/null
# a job in the background would ignore SIGINT, and so would pytest
env --default-signal=INT "${pytest[@]}" --numprocesses=4 --dist=loadfile --no-loadscope-reorder "${measuring[@]/#/--ignore=}" \
    test src/eel_{viz,dynamics,studies,gaits,gym,core,common}/test > out/test-others.log 2>&1 &
beside[others]=$!
echo "[test] what is measured, here; beside, shown when done: all other tests, and the C++ tests"
"${pytest[@]}" "${measuring[@]}"
status=$?
for name in core others; do
    wait "${beside[$name]}" || status=1
    cat "out/test-$name.log"
done
exit "$status"
