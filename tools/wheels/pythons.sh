# SPDX-License-Identifier: Apache-2.0
# Sourced: pythons_here VERSION... prints "VERSION PATH" for each of these Pythons that runs here, of the system or of pyenv.
pythons_here() {
    local version candidate
    for version in "$@"; do
        for candidate in "python$version" "/usr/bin/python$version" "${PYENV_ROOT:-$HOME/.pyenv}/versions/$version".*/bin/python; do
            "$candidate" -I -c 'import ensurepip, venv' 2> /dev/null || continue
            echo "$version $(command -v "$candidate")"
            break
        done
    done
}
