# SPDX-License-Identifier: Apache-2.0
"""Flows as values that JSON can hold, and back."""

from dataclasses import fields
from typing import Any

from eel_base.wording import not_one_of

from eel_dynamics.flow.flow import Flow, FlowSum, parts_of
from eel_dynamics.flow.functions import FlowField, LostFunction
from eel_dynamics.flow.sources import Gust, Shear, Uniform, Vortex, VortexStreet, Wave

KINDS: dict[str, Any] = {kind.__name__: kind for kind in (Uniform, Gust, Shear, Vortex, VortexStreet, Wave)}
OF_FUNCTION = "name", "step", "time_step", "period", "wave"  # what a file holds of a `FlowField`


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
    return {"kind": type(flow).__name__} | {item.name: getattr(flow, item.name) for item in fields(flow)}  # type: ignore[arg-type]


def _made(plain: dict[str, Any]) -> Flow:
    kind = plain.pop("kind", None)
    if kind == "FlowField":
        return FlowField(LostFunction(name=plain["name"]), **plain)
    if kind not in KINDS:
        raise ValueError(not_one_of("flow kind", kind, (*KINDS, "FlowField")))
    flow: Flow = KINDS[kind](**plain)
    return flow
