#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Wheels and the source distribution of eel-swimmer in out/wheels, from the last commit, for each Python from 3.11 to 3.13
# that is on this machine. What they need of a system, their sizes and hashes are printed.
#   build.sh         builds
#   build.sh test    builds what is missing, then installs each wheel where there is neither compiler nor ROS (try.sh)
# EEL_WHEEL_PYTHONS chooses the Pythons, EEL_WHEEL_LEVELS the levels of the processor, EEL_WHEEL_MACHINE=aarch64 wheels for
# 64-bit ARM, by the headers of this machine's Pythons (they differ in nothing that is used).
set -euo pipefail
tools="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd -P)"
cd "$tools/../.."
env="$PWD/.venv-wheels" out="$PWD/out/wheels" machine="${EEL_WHEEL_MACHINE:-x86_64}"
source "$tools/pythons.sh"
say() { printf '[wheels] %s\n' "$*"; }

if ! cmp -s tools/wheels/requirements.txt "$env/stamp"; then
    say "virtual environment .venv-wheels"
    rm -rf "$env"
    .venv/bin/python -m venv "$env"
    touch "$env/COLCON_IGNORE"
    .venv/bin/python tools/install/uv_with_pip_settings.py pip install --quiet --require-hashes --only-binary :all: \
        -r tools/wheels/requirements.txt --python "$env/bin/python" --system-certs
    cp tools/wheels/requirements.txt "$env/stamp"
fi
export EEL_ZIG="$(echo "$env"/lib/python3.*/site-packages/ziglang/zig)" EEL_ZIG_TARGET="$machine-linux-gnu.2.17"
export ZIG_GLOBAL_CACHE_DIR="$env/zig" ZIG_LOCAL_CACHE_DIR="$env/zig"
export CXX="$tools/zig-c++" CMAKE_BUILD_PARALLEL_LEVEL="${CMAKE_BUILD_PARALLEL_LEVEL-$(nproc)}"

commit="$(git rev-parse --short HEAD)"
[ "$(cat "$out/commit" 2> /dev/null)" = "$commit" ] || rm -rf "$out"
mkdir -p "$out"
printf '%s\n' "$commit" > "$out/commit"
[ -z "$(git status --porcelain)" ] || say "changes that are not committed are left out"

draft="$(mktemp -d)"
trap 'rm -rf "$draft"' EXIT
git archive --prefix=eel/ HEAD | tar -x -C "$draft"   # which writes the commit into version.py
uv() { .venv/bin/python tools/install/uv_with_pip_settings.py "$@" --quiet --system-certs; }
compgen -G "$out/*.tar.gz" > /dev/null || uv build --sdist --out-dir "$out" "$draft/eel"
while read -r version python; do
    kind="cp${version/./}-*_$machine.whl"
    ! compgen -G "$out/*-$kind" > /dev/null || continue
    say "wheel for Python $version on $machine"
    options=(-C "cmake.define.EEL_CORE_LEVELS=${EEL_WHEEL_LEVELS:-v2;v3;v4}")
    if [ "$machine" != "$(uname -m)" ]; then
        options=(-C cmake.define.CMAKE_SYSTEM_NAME=Linux -C "cmake.define.CMAKE_SYSTEM_PROCESSOR=$machine"
            -C "cmake.define.PYTHON_MODULE_EXTENSION=.cpython-${version/./}-$machine-linux-gnu.so"
            -C "wheel.tags=cp${version/./}-cp${version/./}-linux_$machine")
    fi
    uv build --wheel --python "$python" --out-dir "$out/built" "$out"/*.tar.gz "${options[@]}"
    PATH="$env/bin:$PATH" "$env/bin/auditwheel" repair --only-plat --wheel-dir "$out" "$out"/built/*-$kind 2> "$draft/said" ||
        { cat "$draft/said"; exit 1; }
done < <(pythons_here ${EEL_WHEEL_PYTHONS:-3.11 3.12 3.13})

cd "$out"
for file in *.whl *.tar.gz; do
    printf '%s  %s bytes  sha256 %s\n' "$file" "$(stat -c %s "$file")" "$(sha256sum "$file" | cut -d' ' -f1)"
    [[ "$file" = *.whl ]] || continue
    "$env/bin/auditwheel" show "$file" > "$draft/shown"
    printf '  %s; greatest symbol %s\n' "$(tr '\n' ' ' < "$draft/shown" | grep -oE 'tag: "[^"]+"')" \
        "$(grep -oE 'GLIBC_[0-9.]+' "$draft/shown" | sort -V | tail -n 1)"
done
[ "${1-}" != test ] || exec "$tools/try.sh"
