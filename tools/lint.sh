#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Every check of the sources that runs nothing of them. All are made, whatever fails; the last line says which did.
set -uo pipefail

failed=()
check() {   # NAME COMMAND...: the command's output is shown where it fails
    local output
    if output="$("${@:2}" 2>&1)"; then
        echo "[lint] $1: good"
    else
        printf '%s\n[lint] %s: failed\n' "$output" "$1"
        failed+=("$1")
    fi
}

shopt -s nullglob
sources=(src/eel_core/{src,test}/*.cpp)
headers=(src/eel_core/{src,include/eel_core,include/eel_core/*}/*.hpp)
tidy() {
    (cd src/eel_core && cmake --preset lint) && printf '%s\0' "${sources[@]}" |
        xargs -0 -n 1 -P "$(nproc)" clang-tidy --quiet -p build/eel_core_lint
}

check "rules (ruff)" ruff check .
check "format (ruff)" ruff format --check .
check "types (mypy)" mypy
check "imports (import-linter)" lint-imports --no-cache --no-logo
check "spelling (codespell)" codespell -D- -Dtools/british.txt
check "C++ format (clang-format)" clang-format --dry-run -Werror "${sources[@]}" "${headers[@]}"
check "C++ rules (clang-tidy)" tidy
[ ${#failed[@]} = 0 ] || { printf '[lint] failed:'; printf ' %s;' "${failed[@]}"; echo; exit 1; }
