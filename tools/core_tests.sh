#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds and runs the C++ tests of eel_core, each kind in a build folder of its own (src/eel_core/CMakePresets.json).
#   tests      for this machine
#   sanitize   with AddressSanitizer and UndefinedBehaviorSanitizer, and the Python tests of the mechanics with them
#   threads    those of marches over threads, with ThreadSanitizer
#   sanitizers both, side by side: each is one compiler for most of its time
#   aarch64    for 64-bit ARM, run by qemu; skipped where the tools are missing
#   clang      compiled by Clang; skipped where it is missing
set -euo pipefail
kind="$1"
if [ "$kind" = sanitizers ]; then
    mkdir -p out
    "$0" threads > out/test-threads.log 2>&1 &
    status=0
    "$0" sanitize || status=$?
    wait "$!" || status=$?
    cat out/test-threads.log
    exit "$status"
fi
folder="build/eel_core_$kind"

skip_without() {   # COMMAND PACKAGE
    command -v "$1" > /dev/null || { echo "[core] $kind skipped: no $1. On Debian or Ubuntu: sudo apt-get install $2"; exit 0; }
}
case "$kind" in
    tests | sanitize | threads) ;;
    aarch64) skip_without aarch64-linux-gnu-g++ g++-aarch64-linux-gnu; skip_without qemu-aarch64 qemu-user ;;
    clang) skip_without clang++ clang ;;
    *) echo "core_tests.sh: the kind must be tests, sanitize, threads, sanitizers, aarch64 or clang, got '$kind'" >&2; exit 2 ;;
esac

mkdir -p "$folder"
{ (cd src/eel_core && cmake --preset "$kind") && cmake --build "$folder" --parallel; } > "$folder/build.log" 2>&1 ||
    { cat "$folder/build.log"; echo "[core] $kind: the build failed; its output is in $folder/build.log"; exit 1; }
[ "$kind" != threads ] || export GTEST_FILTER="SampledMarches*:ThreadSanitizer*"
ctest --test-dir "$folder" --output-on-failure --no-tests=error
[ "$kind" = sanitize ] || exit 0

# Python itself is not sanitized: its run time comes first, and what Python leaves at its end is no finding.
cmake --install "$folder" > /dev/null
library() { "${CXX:-c++}" -print-file-name="$1"; }
export LD_PRELOAD="$(library libasan.so) $(library libstdc++.so)" ASAN_OPTIONS=detect_leaks=0
export UBSAN_OPTIONS=print_stacktrace=1 PYTHONPATH="$PWD/$folder/install:$PYTHONPATH"
python -c 'import eel_core; assert eel_core.build_info()["sanitizers"], "the module is not sanitized"'
python -m pytest src/eel_dynamics/test/test_{closure,conservation,kinks,planar,metacentric_height,weight}.py \
    src/eel_dynamics/test/test_body_data.py::test_{torque_within_a_panel,drag_between_kinks}_is_that_of_the_spline \
    src/eel_core/test --ignore=src/eel_core/test/test_levels.py   # these build and copy
