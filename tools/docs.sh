#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The site of docs/ in out/docs, with the recordings of its gallery, or (docs.sh notebook) the notebook run anew in out/notebook.
# Sphinx and Jupyter lie in an environment of their own, .venv-docs, pinned by docs/requirements.txt; it sees this
# folder's packages. A warning is an error: a link that leads nowhere, a name that autodoc does not find.
set -euo pipefail
env=.venv-docs
if ! cmp -s docs/requirements.txt "$env/stamp"; then
    echo "[docs] virtual environment $env"
    rm -rf "$env"
    .venv/bin/python -m venv "$env"
    touch "$env/COLCON_IGNORE"
    .venv/bin/python tools/install/uv_with_pip_settings.py pip install --quiet --require-hashes --only-binary :all: \
        -r docs/requirements.txt --python "$env/bin/python" --system-certs
    printf '%s\n' .venv/lib/python3.*/site-packages | sed "s#^#$PWD/#" > "$(echo "$env"/lib/python3.*/site-packages)/eel.pth"
    cp docs/requirements.txt "$env/stamp"
fi

if [ "${1-}" = notebook ]; then
    mkdir -p out/notebook   # where its recordings stay
    cp docs/tutorials/swim.ipynb out/notebook/
    MPLBACKEND=module://matplotlib_inline.backend_inline "$env/bin/jupyter-execute" --inplace out/notebook/swim.ipynb
    echo "[docs] out/notebook/swim.ipynb; a copy of it in docs/tutorials renews the page"
    exit
fi
.venv/bin/python tools/reference_pages.py
"$env/bin/python" -m sphinx --builder html --fail-on-warning --keep-going --quiet docs out/docs
.venv/bin/python tools/gallery.py site out/docs
echo "[docs] out/docs/index.html"
