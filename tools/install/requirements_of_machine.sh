# SPDX-License-Identifier: Apache-2.0
# Sourced by build.sh: what must be on the machine already. Each shortage ends the build with one line that names it and
# the command that brings it; nothing is installed from here.

missing() {   # WHAT PACKAGE...
    local what="$1"
    shift
    echo "[build] missing: $what. On Debian or Ubuntu: sudo apt-get install $*" >&2
    exit 1
}

# Whether a Python is the one that PYTHON=... asks for (any, if it asks for none).
wanted_python() {
    [ -n "${PYTHON-}" ] || return 0
    local version="import sys; print(sys.version_info[:3])"
    [ "$("$1" -I -S -c "$version" 2> /dev/null)" = "$("$PYTHON" -I -S -c "$version" 2> /dev/null)" ]
}

# Sets $python to one that runs (a version manager's shim may not), is 3.11 to 3.13, and has venv, pip and its C headers.
find_python() {
    local candidate version without_venv="" without_headers="" others=""
    local candidates=(python3.13 python3.12 python3.11 python3 /usr/bin/python3.13 /usr/bin/python3.12 /usr/bin/python3.11 /usr/bin/python3)
    [ -z "${PYTHON-}" ] || candidates=("$PYTHON")
    [ "$(uname -s)-$(uname -m)" = Linux-x86_64 ] || {
        echo "[build] missing: x86-64 Linux (this is $(uname -s) on $(uname -m)); the ROS 2 wheels exist for nothing else" >&2
        exit 1
    }
    for candidate in "${candidates[@]}"; do
        version="$("$candidate" -I -c 'import sys; print("%d.%d" % sys.version_info[:2])' 2> /dev/null)" || continue
        case "$version" in 3.11 | 3.12 | 3.13) ;; *) others="$others $candidate ($version)"; continue ;; esac
        "$candidate" -I -c 'import ensurepip, venv' 2> /dev/null || { without_venv="${without_venv:-$version}"; continue; }
        "$candidate" -I -c 'import os, sysconfig, sys; sys.exit(not os.path.exists(sysconfig.get_paths()["include"] + "/Python.h"))' ||
            { without_headers="${without_headers:-$version}"; continue; }
        python="$candidate"
        need_compiler
        return
    done
    [ -z "$without_headers" ] || missing "the C headers of Python $without_headers" "python$without_headers-dev"
    [ -z "$without_venv" ] || missing "the venv module of Python $without_venv" "python$without_venv-venv" "python$without_venv-dev"
    [ -z "${PYTHON-}" ] || { echo "[build] PYTHON=$PYTHON is not a Python from 3.11 to 3.13 that runs${others:+, found:$others}" >&2; exit 1; }
    missing "a Python from 3.11 to 3.13${others:+ (found:$others)}" "python3 python3-venv python3-dev   (where that is older: python3.11 python3.11-venv python3.11-dev)"
}

need_compiler() {
    local lacks="" CC="${CC:-cc}" CXX="${CXX:-c++}"
    command -v "${CC%% *}" > /dev/null 2>&1 || lacks="a C compiler ($CC)"
    command -v "${CXX%% *}" > /dev/null 2>&1 || lacks="${lacks:+$lacks and }a C++ compiler ($CXX)"
    command -v make > /dev/null 2>&1 || lacks="${lacks:+$lacks and }make"
    [ -z "$lacks" ] || missing "$lacks" "build-essential"
}
