# SPDX-License-Identifier: Apache-2.0
"""The made-up swimmer through the loggers into a file, without ROS."""

from dataclasses import replace
from pathlib import Path

import made_up
import numpy as np
from eel_viz.batched_stream import Rates
from eel_viz.recording.loggers import Loggers
from eel_viz.recording.recording_file import FileDestination
from eel_viz.settings import Settings

from eel_viz import messages


def sample(swimmer: made_up.Swimmer, stamp: int) -> dict:
    """What `Loggers` is given at `stamp` [ns]: method name to arguments."""
    t = stamp * 1e-9
    head, curvature, wrench, load = swimmer.head(t), swimmer.curvature(t), swimmer.wrench(t), swimmer.load(t)
    backbone = swimmer.backbone(t)
    pose = messages.Pose(position=head["position"], orientation=head["orientation"])
    twist = messages.Twist(linear=head["linear"], angular=head["angular"])
    return {
        "head_pose": (pose,),
        "head_twist": (twist,),
        "odom": (pose, twist),
        "backbone": (messages.Backbone(**backbone),),
        "curvature": (profiles(curvature, messages.CURVATURE_FIELDS),),
        "internal_wrench": (profiles(wrench, messages.WRENCH_FIELDS),),
        "hydrodynamic_load": (
            messages.Load(
                profiles=profiles(load, messages.LOAD_FIELDS),
                tail=load["tail_force"],
                nose=load["nose_force"],
                wake=load["wake_momentum_rate"],
                fins=load["fin_force"],
            ),
        ),
        "flow_vectors": (backbone["position"], swimmer.water(t)),
        "energy": (swimmer.energy(t),),
    }


def profiles(fields: dict, names: tuple[str, ...]) -> messages.Profiles:
    return messages.Profiles(x=fields["x"], values={name: fields[name] for name in names})


def body() -> messages.Body:
    return messages.Body(**made_up.body())


def record(
    path: Path, seconds: float, rate: float, *, stations: int = 51, plain: bool = False, **settings
) -> dict[int, dict]:
    """Log everything; returns what was logged, by stamp [ns]. plain: of a swim without fins, flow, weight, springs."""
    chosen = Settings(recording=str(path), **settings)
    said: list[str] = []
    destination = FileDestination(chosen, said.append, said.append)
    delivery = destination.open(1, "made up")
    loggers = Loggers(delivery.stream, chosen, Rates(numbers=0.0, drawings=chosen.skin_rate))
    loggers.log("curvature_law", 0, "made up")
    sides = [False, True] if chosen.compare else [False]  # the same again, as the compared run
    for compared in sides:
        loggers.log("body", 0, body(), compared=compared)
    swimmer = made_up.Swimmer(stations)
    logged = {}
    for k in range(round(seconds * rate) + 1):
        stamp = round(k * 1e9 / rate)
        logged[stamp] = sample(swimmer, stamp)
        if plain:
            ((energy,), (load,)) = (logged[stamp].pop(name) for name in ("energy", "hydrodynamic_load"))
            logged[stamp].pop("flow_vectors")
            nothing = dict.fromkeys(
                (
                    "flow_power",
                    "fins_power",
                    "damping_power",
                    "appendages_power",
                    "external_power",
                    "potential",
                    "elastic",
                ),
                0.0,
            )
            logged[stamp] |= {"energy": (energy | nothing,), "hydrodynamic_load": (replace(load, fins=np.zeros(0)),)}
        for method, arguments in logged[stamp].items():
            for compared in sides:
                loggers.log(method, stamp, *arguments, compared=compared)
    loggers.flush()
    delivery.close()
    return logged
