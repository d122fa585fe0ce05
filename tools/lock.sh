#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Pins requirements*.txt anew from requirements*.in: one resolution for Python 3.11 to 3.13, every file with its hash.
# Run it after `make build`, which brings uv, when a line of a requirements*.in changes; then `make test`.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
unset PIP_FIND_LINKS PIP_INDEX_URL PIP_EXTRA_INDEX_URL UV_INDEX_URL UV_DEFAULT_INDEX UV_FIND_LINKS
for name in requirements requirements-ros requirements-dev requirements-uv docs/requirements docs/examples/ppo/requirements test/numpy1 tools/wheels/requirements evidence/peers/{mujoco,numba,pyelastica}; do
    echo "pinning $name.txt"
    .venv/bin/uv pip compile --quiet --universal --python-version 3.11 --fork-strategy fewest --generate-hashes \
        --no-emit-index-url --no-emit-find-links --custom-compile-command tools/lock.sh "$name.in" -o "$name.txt"
done
