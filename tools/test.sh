#!/usr/bin/env bash
# All tests but the long ones. Without arguments as two pytest processes side by side, each in ROS domains of its own: they
# wait most of the time. Arguments go to one pytest.
set -uo pipefail
if [ $# -gt 0 ]; then exec python -m pytest -m "not soak" "$@"; fi

mkdir -p out
log=out/test-others.log
python -m pytest -m "not soak" test/eel_gaits test/eel_viz test/system > "$log" 2>&1 &
others=$!
trap 'kill -INT "$others" 2> /dev/null; wait "$others"; exit 130' INT TERM
echo "[test] test/eel_dynamics here; test/eel_gaits, test/eel_viz and test/system beside it, shown when they are done"
python -m pytest -m "not soak" test/eel_dynamics
here=$?
wait "$others"
beside=$?
cat "$log"
[ "$here" -eq 0 ] && [ "$beside" -eq 0 ]
