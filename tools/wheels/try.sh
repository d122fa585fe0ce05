#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# try.sh [FOLDER]: installs the wheels of out/wheels, or of the folder, as a stranger would: in empty virtual environments, in a folder whose path has a space,
# without a compiler, ROS or this folder's packages in sight, not as root where the Python is one for all users. The six
# lines of README and `eel` run; times from the start of pip, and sizes, are printed. Then what may go wrong: an old
# processor, an old Python, a missing extra.
set -euo pipefail
tools="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd -P)"
root="$(cd "$tools/../.." && pwd -P)"
source "$root/tools/install/environment.sh"
source "$tools/pythons.sh"
say() { printf '[wheels] %s\n' "$*"; }
fail() { say "failed: $*"; exit 1; }

draft="$(mktemp -d)"
trap 'rm -rf "$draft"' EXIT
bare="$draft/a new machine"
mkdir -p "$bare/bin"
cp "${1:-$root/out/wheels}"/*.whl "$bare"
for name in sh env uname ldd cat; do ln -s "$(command -v "$name")" "$bare/bin/$name"; done   # all that is on the PATH
"$root/.venv/bin/python" - "$root/README.md" > "$bare/six_lines.py" << 'END'
import re, sys
print(re.search(r"```python\n(.*?)```", open(sys.argv[1], encoding="utf-8").read(), re.DOTALL)[1])
END
cd "$bare"
nobody=(setpriv --reuid=65534 --regid=65534 --clear-groups)
alone() { "${as[@]}" "$(command -v env)" -u CC -u CXX -u LD_LIBRARY_PATH HOME="$bare" PATH="$bare/bin" PYTHONNOUSERSITE=1 "$@"; }
install() { alone env/bin/python -m pip install --quiet --disable-pip-version-check --no-cache-dir --only-binary :all: "$@"; }

try_with() {   # VERSION PYTHON
    local wheel began
    wheel="$(compgen -G "./*-cp${1/./}-*.whl")" || return 0
    as=()
    if [ "$(id -u)" = 0 ] && "${nobody[@]}" "$2" -c "" 2> /dev/null; then as=("${nobody[@]}"); chown -R 65534:65534 "$draft"; fi
    rm -rf env run.* swim.csv
    "${as[@]}" "$2" -m venv env
    say "$(env/bin/python -V) ($2)${as[*]:+, not as root}: the library alone"
    began=$(date +%s)
    install "$wheel"
    say "  pip: $(($(date +%s) - began)) s; ours $(du -ksc env/lib/python*/site-packages/eel_* | tail -1 | cut -f1) kB of" \
        "$(du -ks env/lib/python*/site-packages | cut -f1) kB; $(cd env/lib/python*/site-packages && echo *.dist-info)"
    alone env/bin/eel --version | sed 's/^/    /'
    alone env/bin/eel simulate falling --duration 2 --out swim.csv | tail -n 1 | sed 's/^/    /'
    ! alone env/bin/python six_lines.py > said 2>&1 || fail "to_rerun works without its extra"
    [ -s run.nc ] || fail "$(tail -n 1 said)"
    tail -n 1 said | tee last | sed 's/^/    /'
    grep -qF "pip install 'eel-swimmer[viz]'" last || fail "to_rerun does not name its extra"
    ! alone env/bin/eel replay bag > said 2>&1 || fail "a bag is read without the extra"
    [ "$(wc -l < said)" = 1 ] || fail "more than a line: $(cat said)"
    say "  with viz"
    began=$(date +%s)
    install "${wheel}[viz]"
    alone env/bin/python six_lines.py > said
    say "  pip and the six lines: $(($(date +%s) - began)) s; $(echo run.*)"
    # A processor of 2006, by what the system tells of it.
    echo "flags : fpu sse sse2 ssse3 pni cx16 lahf_lm" > cpuinfo
    sed -i "s#/proc/cpuinfo#$bare/cpuinfo#" env/lib/python*/site-packages/eel_core/processor.py
    ! alone env/bin/eel simulate falling > said 2>&1 || fail "the core is loaded on an old processor"
    [ "$(wc -l < said)" = 1 ] && sed 's/^/    /' said || fail "more than a line: $(cat said)"
}
while read -r version python; do
    try_with "$version" "$python"
done < <(pythons_here 3.11 3.12 3.13)
for version in 3.11 3.12 3.13; do   # the system's, where that is another
    [ -x "/usr/bin/python$version" ] && "/usr/bin/python$version" -c 'import ensurepip, venv' 2> /dev/null || continue
    try_with "$version" "/usr/bin/python$version"
done
while read -r version python; do
    rm -rf env
    "$python" -m venv env
    as=()
    ! install ./*.whl > said 2>&1 || fail "Python $version is taken"
    say "Python $version: $(tail -n 1 said)"
done < <(pythons_here 3.10)
say "all of it works without a compiler"
