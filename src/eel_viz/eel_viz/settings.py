# SPDX-License-Identifier: Apache-2.0
"""The nodes' settings with unit, default, bounds and description. The nodes declare their parameters from them."""

import ipaddress
from dataclasses import dataclass

from eel_common.quantity import Quantities, quantity
from eel_common.wording import shown

SINKS = ("spawn", "connect", "serve", "save")
BLUEPRINTS = ("overview", "torques", "motion", "robot", "sensors", "swimmer", "compare")


@dataclass(frozen=True, kw_only=True)
class Drawing(Quantities):
    """Settings of every node that draws."""

    load_scale: float = quantity(0.06, "m^2/N", "length of the arrow of a load of 1 N/m", minimum=0.0)
    end_force_scale: float = quantity(0.8, "m/N", "length of the arrow of a force of 1 N at nose or tail", minimum=0.0)


@dataclass(frozen=True, kw_only=True)
class MarkerSettings(Drawing):
    """Parameters of the node `markers`, read at start. `ValueError` names an unsuitable one."""

    colour_limit: float = quantity(0.25, "N m", "torque C3 of the deepest colours", minimum=1e-9)
    rate: float = quantity(
        25.0, "Hz", "markers and paths per second of wall time, at most", minimum=0.1, maximum=1000.0
    )


@dataclass(frozen=True, kw_only=True)
class Settings(Drawing):
    """Parameters of the visualiser, read at start. `ValueError` names an unsuitable one."""

    sink: tuple[str, ...] = quantity(
        ("auto",),
        "",
        "where it goes, one or more of: spawn (a viewer window), connect (a viewer that runs, see viewer), serve (gRPC "
        "and web viewer), save (a file, see recording); auto: spawn where there is a display, else save",
    )
    recording: str = quantity(
        "",
        "",
        "file to save, .rrd, in a folder that exists; .part.rrd until it is complete; empty: eel-DATE-TIME-PROCESS.rrd "
        "in the working folder",
    )
    viewer: str = quantity("rerun+http://127.0.0.1:9876/proxy", "", "address of the viewer to connect to")
    address: str = quantity(
        "127.0.0.1",
        "",
        "where data and web viewer are served: 127.0.0.1 for this machine alone; 0.0.0.0 for every network that it is "
        "in, where anybody can read them and send data to the viewers",
    )
    port: int = quantity(9877, "", "port of the served data (gRPC)", minimum=1024, maximum=65535)
    web_port: int = quantity(9090, "", "port of the served web viewer", minimum=1024, maximum=65535)
    blueprint: str = quantity("overview", "", "arrangement shown first", choices=BLUEPRINTS)
    compare: str = quantity(
        "",
        "",
        "namespace of another swimmer (/: the one without), laid over this one in the arrangement compare; empty: none",
    )
    frames: bool = quantity(False, "", "show the axes of head and tail, 0.12 m long: red forward, green left, blue up")
    wake: bool = quantity(
        True,
        "",
        "show what the tail left in the wake in the last 3 s, momentum per time; a scheme: the model has no flow there",
    )
    wake_scale: float = quantity(
        0.4, "m/N", "length that shows 1 N, which is 1 N s of momentum left in the wake per second", minimum=0.0
    )
    reach: float = quantity(
        0.25,
        "lengths",
        "distance to draw about way points: give it here too where the pilot's parameter reach has another value",
        minimum=0.0,
        maximum=10.0,
    )
    rate: float = quantity(
        30.0, "Hz", "samples per second that a live viewer gets; a file gets all", minimum=0.1, maximum=1000.0
    )
    skin_rate: float = quantity(
        25.0, "Hz", "skin, arrows and curves drawn per second of simulation time in a file", minimum=0.1, maximum=1000.0
    )
    index: bool = quantity(
        True,
        "",
        "end a file with an index of what it holds, kept in memory until then: 1 MB for each 4 MB of file; without it "
        "memory stays as it is, and `rerun rrd optimize` adds the index",
    )
    colour_limit: float = quantity(
        0.0,
        "N m",
        "torque C3 from which on colours are deepest; 0: here and below: what fits the last 3 s",
        minimum=0.0,
    )
    torque_limit: float = quantity(
        0.0, "N m", "torque at the plot's edge; grows if need be, like those below", minimum=0.0
    )
    force_limit: float = quantity(0.0, "N", "force at the plot's edge", minimum=0.0)
    curvature_limit: float = quantity(0.0, "rad/m", "curvature at the plot's edge", minimum=0.0)
    memory_limit: str = quantity("1GiB", "", "memory that served data may take before the oldest are dropped")
    stop_with_publisher: bool = quantity(
        False,
        "",
        "leave, with status 0, some time after the publishers of the swimmer have gone; they must have been there",
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.sink:
            raise ValueError(f"sink must name at least one of {', '.join(SINKS)}, got none")
        for name in self.sink:
            if name not in ("auto", *SINKS):
                raise ValueError(f"sink must be some of {', '.join(SINKS)} or auto, got {shown(name)}")
        if self.recording and not self.recording.endswith(".rrd"):
            raise ValueError(f"recording must end in .rrd, got {shown(self.recording)}")
        if self.blueprint == "compare" and not self.compare:
            raise ValueError("compare must be the other swimmer's namespace for the blueprint compare, got none")

        try:
            ipaddress.IPv4Address(self.address)
        except ValueError:
            raise ValueError(f"address must be an IPv4 address such as 127.0.0.1, got {shown(self.address)}") from None
