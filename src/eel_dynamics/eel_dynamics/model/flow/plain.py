# SPDX-License-Identifier: Apache-2.0
"""Flows as values that JSON can hold, and back."""

from base64 import b64decode, b64encode
from dataclasses import fields
from typing import Any

import numpy as np
from eel_common.quantity import checked_choice
from eel_common.texts import made

from eel_dynamics.model.flow.flow import Flow, FlowSum, parts_of
from eel_dynamics.model.flow.functions import FlowField, LostFunction
from eel_dynamics.model.flow.gridded import AXES, GriddedFlow
from eel_dynamics.model.flow.sources import Gust, Shear, Uniform, Vortex, VortexStreet, Wave

KINDS: dict[str, Any] = {kind.__name__: kind for kind in (Uniform, Gust, Shear, Vortex, VortexStreet, Wave)}
OF_FUNCTION = "name", "step", "time_step", "period", "wave"  # fields of a `FlowField` in a file


def plain_of_flow(flow: Flow | None) -> list[dict[str, Any]] | None:
    """`flow` as plain values; None as it is. Of a `FlowField` without its functions."""
    if flow is None:
        return None
    return [_plain(part) for part in parts_of(flow)]


def flow_of(plain: list[dict[str, Any]] | None) -> Flow | None:
    """The flow that has become plain values."""
    if plain is None:
        return None
    parts = tuple(_made(dict(each)) for each in plain)
    return parts[0] if len(parts) == 1 else FlowSum(parts)


def _plain(flow: Flow) -> dict[str, Any]:
    if isinstance(flow, FlowField):
        return {"kind": "FlowField"} | {name: getattr(flow, name) for name in OF_FUNCTION}
    if isinstance(flow, GriddedFlow):
        arrays = {name: b64encode(getattr(flow, name).astype("<f8")).decode() for name in ("velocity", *AXES)}
        return {"kind": "GriddedFlow", "arrays": arrays, "period": flow.period, "wave": flow.wave}
    return {"kind": type(flow).__name__} | {item.name: getattr(flow, item.name) for item in fields(flow)}  # type: ignore[arg-type]


def _made(plain: dict[str, Any]) -> Flow:
    kind = plain.pop("kind", None)
    if kind == "FlowField":
        return FlowField(LostFunction(name=plain["name"]), **plain)
    if kind == "GriddedFlow":
        arrays = {name: np.frombuffer(b64decode(text), "<f8") for name, text in plain.pop("arrays").items()}
        shape = [len(arrays[name]) for name in AXES]
        return GriddedFlow(**arrays | {"velocity": arrays["velocity"].reshape(*shape, 3)}, **plain)
    checked_choice("flow kind", kind, KINDS, "FlowField", "GriddedFlow")
    flow: Flow = made(KINDS[kind], plain, f"flow {kind}")
    return flow
