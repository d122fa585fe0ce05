# SPDX-License-Identifier: Apache-2.0
"""Properties of a whole run in its recording, so that many recordings can be queried like a table."""

import json
from dataclasses import asdict
from typing import Any

import numpy as np
from eel_gaits.laws.law import Law
from eel_gaits.sources.sampled_law import SampledLaw

from eel_dynamics.analysis.measures import MEASURES, OF_ESTIMATE, measures_of
from eel_dynamics.runs.run_data import RunData
from eel_dynamics.runs.storage.plain import plain_of
from eel_dynamics.simulation.energy import WORKS

DEAR = ("greatest_torque",)  # a measure that simulates again; replaced by the greatest sample
Properties = dict[str, dict[str, Any]]  # numbers, texts and truths, by group and name


def properties_of_run(run: RunData) -> Properties:
    """Groups of a run's numbers in SI units: swim, law, body, scene, accuracy, error_estimate, ledger, measures.

    A group without data is left out; a measure that is not defined is NaN.
    """
    measured = [name for name in MEASURES if name not in (*OF_ESTIMATE, *DEAR)]
    found: Properties = {
        "swim": {
            "gait": run.law.name,
            "duration": float(run.time[-1]),
            "samples": len(run.time),
            "stations": len(run.x),
            "axes": "rep103",
        },
        "law": _law(run.law),
        "body": {
            "name": run.body.name,
            "length": float(run.body.length),
            "mass": float(run.body_mass),
            "json": json.dumps(plain_of(run.body)),
        },
        "scene": _flat(asdict(run.in_axes("rep103").scene)),
        "accuracy": _flat(asdict(run.accuracy)),
        "measures": measures_of(run, measured),
    }
    if run.torque is not None:
        found["measures"]["greatest_sampled_torque"] = float(np.linalg.norm(run.torque, axis=2).max())
    if run.error_estimate is not None:
        found["error_estimate"] = _flat(asdict(run.error_estimate))
    if run.energy is not None:
        works = {f"{part}_work": float(run.energy[f"{part}_work"][-1]) for part in WORKS}
        found["ledger"] = works | {"residual": float(np.max(np.abs(run.energy.residual)))}
    return found


def _law(law: Law | SampledLaw) -> dict[str, Any]:
    """Name, longest period and wavelength of a law's waves, and the law as JSON; for measured rows only the name."""
    if not isinstance(law, Law):
        return {"name": law.name}
    found: dict[str, Any] = {"name": law.name, "json": json.dumps(plain_of(law))}
    for name in ("period", "wavelength"):
        values = [getattr(term, name) for term in law.terms]
        found[name] = max(values, key=abs, default=0.0)
    return found


def _flat(values: dict[str, Any]) -> dict[str, Any]:
    """Numbers, texts, booleans and rows of numbers unchanged, other values as text; None is left out."""
    plain = (bool, int, float, str, tuple)
    return {name: each if isinstance(each, plain) else str(each) for name, each in values.items() if each is not None}
