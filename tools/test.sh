#!/usr/bin/env bash
# All tests but the long ones. Without arguments as two pytest processes side by side, each in ROS domains of its own: they
# wait most of the time. What the mechanics measured comes last. Arguments go to one pytest.
set -uo pipefail
if [ $# -gt 0 ]; then exec python -m pytest -m "not soak" "$@"; fi

mkdir -p out
log=out/test-dynamics.log
python -m pytest -m "not soak" test/eel_dynamics > "$log" 2>&1 &
dynamics=$!
trap 'kill -INT "$dynamics" 2> /dev/null; wait "$dynamics"; exit 130' INT TERM
echo "[test] test/eel_gaits, test/eel_viz and test/system here; test/eel_dynamics beside them, shown when it is done"
python -m pytest -m "not soak" test/eel_gaits test/eel_viz test/system
here=$?
wait "$dynamics"
beside=$?
cat "$log"
[ "$here" -eq 0 ] && [ "$beside" -eq 0 ]
