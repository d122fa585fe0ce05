#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Brings this folder to the state that the sources ask for: virtual environment, colcon build.
# Each has a stamp with the hash of what it was made from and the folder's own path, so that a second call
# is quick, and an interrupted set-up, a moved folder or a changed source is put right.
# PYTHON=/path/to/python chooses the interpreter. Nothing is installed outside this folder.
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)"
cd "$root"
source tools/install/environment.sh
source tools/install/requirements_of_machine.sh

say() { printf '[build] %s\n' "$*"; }
key_of() { { printf '%s\n' "$@"; cat; } | sha256sum | cut -c1-40; }
stamped() { [ "$(cat "$1" 2> /dev/null)" = "$2" ]; }

# One set-up at a time in this folder; the lock goes with this process.
exec 9> .build.lock
flock -n 9 || { say "another build runs in this folder, waiting for it"; flock 9; }

make_environment() {
    local key setuptools_pin log=.venv/install.log
    key="$(cat requirements*.txt tools/install/relocate_wheels.py | key_of "$root")"
    if stamped .venv/stamp "$key" && .venv/bin/python -V > /dev/null 2>&1 && wanted_python .venv/bin/python; then
        return
    fi
    find_python   # sets $python, or ends with one line
    say "virtual environment .venv with $("$python" -V) and ROS 2 Jazzy (about 180 packages, 2 GB; minutes on a slow line)"
    rm -rf .venv build install log
    "$python" -m venv .venv
    touch .venv/COLCON_IGNORE
    install_requirements
    .venv/bin/python tools/install/relocate_wheels.py | sed 's/^/[build]   /'
    printf '%s' "$key" > .venv/stamp
}

# Everything comes as wheels but one pure-Python source package, which the pinned setuptools builds. pip brings uv, and
# uv the rest in a fraction of pip's time; where uv fails (it may not know how this machine reaches its index), pip does.
install_requirements() {
    local log=.venv/install.log
    local what=(install --require-hashes --only-binary :all: --no-binary empy --no-build-isolation
        -r requirements.txt -r requirements-ros.txt -r requirements-dev.txt)
    export PIP_USER=0 PIP_DISABLE_PIP_VERSION_CHECK=1
    .venv/bin/python -m pip install --quiet --require-hashes --only-binary :all: -r requirements-uv.txt ||
        { say "pip failed, what it said stands above"; exit 1; }
    .venv/bin/python tools/install/uv_with_pip_settings.py pip "${what[@]}" --python .venv/bin/python --system-certs \
        --index-strategy unsafe-best-match 2>&1 | tee "$log" | say_progress && return
    say "uv failed, its output is in $log.uv; pip takes over, which lasts a minute longer"
    mv "$log" "$log.uv"
    .venv/bin/python -m pip "${what[@]}" --progress-bar off 2>&1 | tee "$log" | say_progress ||
        { say "pip failed, its output is in $log"; exit 1; }
}

say_progress() {   # of what uv or pip prints; uv names large packages alone
    local line count=0
    while IFS= read -r line; do
        case "$line" in
            "Collecting "* | " Downloaded "*) count=$((count + 1)); [ $((count % 10)) != 0 ] || say "  $count packages fetched" ;;
            Prepared* | Installing*) say "  unpacking" ;;
            ERROR* | error*) say "  $line" ;;
        esac
    done
}

build_packages() {
    local key
    key="$(find src tools/tf2_msgs -type f ! -path '*/__pycache__/*' ! -path '*.egg-info/*' ! -path 'src/*/test/*' \
        \( ! -name '*.py' -o -name setup.py \) -print0 | sort -z | xargs -0 sha256sum tools/build.sh |
        key_of "$(cat .venv/stamp)" "$(.venv/bin/python -I src/eel_core/eel_core/processor.py)")"
    stamped install/stamp "$key" && return
    need_compiler
    say "colcon build of the packages"
    rm -f install/stamp
    mkdir -p install
    touch install/begun
    # With MAKEFLAGS, or colcon lets make start nothing beside while the machine has other work.
    PATH="$root/.venv/bin:$PATH" AMENT_PREFIX_PATH="$root/.venv" CMAKE_PREFIX_PATH="$root/.venv" MAKEFLAGS="-j$(nproc)" \
        .venv/bin/python .venv/bin/colcon build --base-paths src tools/tf2_msgs --symlink-install --cmake-args -Wno-unused-cli \
        "-DPython3_EXECUTABLE=$root/.venv/bin/python" -DEEL_MSGS_FOR_RCLPY=ON -DBUILD_TESTING=OFF 9>&- ||
        { say "colcon failed; its output is in log/latest_build"; exit 1; }
    link_executables
    printf '%s' "$key" > install/stamp
}

# One folder for setup.bash to put on the PATH: `eel`, which has the other commands, and the nodes. No system has programs
# of these names. What this build has not made bears the name of an earlier one.
link_executables() {
    local executable on_path=" eel gait_generator heading_controller pilot dynamics visualiser markers "
    rm -rf install/bin
    mkdir install/bin
    for executable in install/eel_*/lib/eel_*/*; do
        [ "$executable" -nt install/begun ] || { rm "$executable"; continue; }
        begin_with_sh "$executable"
        [[ "$on_path" != *" ${executable##*/} "* ]] || ln -s "../../$executable" "install/bin/${executable##*/}"
    done
}

# These lines run Python under sh, and are a text to Python. Python begins with SIGINT blocked, where `env` can do that,
# or Ctrl-C would be a traceback until `eel_command` lets it through. And where the path has a space, setuptools begins
# an executable with `#!"/a path/python" -x`, which no system can run.
begin_with_sh() {
    local block="" body
    [[ "$(head -n 1 "$1")" == '#!'*python* ]] || return 0
    ! env --block-signal=INT true 2> /dev/null || block="env --block-signal=INT "
    body="$(tail -n +2 "$1")"
    printf '%s\n' '#!/bin/sh' "'''exec' $block'$root/.venv/bin/python' \"\$0\" \"\$@\"" "' '''" "$body" > "$1"
}

make_environment
build_packages
