# SPDX-License-Identifier: Apache-2.0
"""Flows as texts, for commands and nodes: a name with numbers, or a netCDF file; several are joined by " + ".

shear velocity=0.1,0,0 width=0.5
vortex_street core=0.3 + gust velocity=0,0.1,0 start=3
tank.nc
"""

from functools import reduce
from operator import add
from typing import Any

from eel_common.files.input_file import reading
from eel_common.quantity import checked_choice
from eel_common.texts import JOINED, named_fields, parts_of_text, value_of

from eel_dynamics.model.flow.flow import Flow, parts_of
from eel_dynamics.model.flow.gridded import GriddedFlow
from eel_dynamics.model.flow.plain import KINDS, flow_of, plain_of_flow

NAMES = {"".join(f"_{c.lower()}" if c.isupper() else c for c in kind).strip("_"): kind for kind in KINDS}
GRIDS = ".nc"  # how the names of files end


def flow_from_text(text: str) -> Flow | None:
    """The flow of a `text`; None for an empty one. `ValueError` names the fault."""
    with reading("flow"):
        return reduce(add, map(_part, parts_of_text(text))) if text.strip() else None


def text_of_flow(flow: Flow) -> str:
    """The text of a `flow`. `ValueError` for one of functions or a grid."""
    names, texts = {kind: name for name, kind in NAMES.items()}, []
    for part, plain in zip(parts_of(flow), plain_of_flow(flow) or [], strict=True):
        kind = plain.pop("kind")
        if kind not in names:
            raise ValueError(f"flow {part!r} has no text: give its file")
        given = (f"{name}={_written(value)}" for name, value in plain.items() if value not in (None, ()))
        texts.append(" ".join((names[kind], *given)))
    return JOINED.join(texts)


def _part(text: str) -> Flow:
    given = named_fields("flow", "kind", text)
    name = given["kind"]
    if name.endswith(GRIDS) and len(given) == 1:
        return GriddedFlow.of(name)
    checked_choice("flow", name, NAMES, f"a file that ends in {GRIDS}")
    flow = flow_of([{field: value_of(value) for field, value in given.items()} | {"kind": NAMES[name]}])
    assert flow is not None
    return flow


def _written(value: Any) -> str:
    if not isinstance(value, (tuple, list)):
        return str(value)
    return (";" if value and isinstance(value[0], (tuple, list)) else ",").join(map(_written, value))
