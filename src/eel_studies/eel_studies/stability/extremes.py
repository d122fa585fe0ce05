# SPDX-License-Identifier: Apache-2.0
"""The maps of `eel stability` without a scene: far beyond the range of any swimmer. `ROWS` lists them."""

from typing import Any

from eel_dynamics.accuracy.accuracy import ORDERS, PRESETS, Accuracy
from eel_dynamics.runs.scene_file import swim_of

from eel_dynamics import Body, Swim
from eel_studies.stability.maps import TARGET, Axis, Map
from eel_studies.varied import varied

METHODS = (*(("adams", order) for order in ORDERS["adams"]), ("dormand_prince", 5))
PERIOD = Axis("period (s)", "period", 0.02, 50.0)
DENSITY = Axis("density of the body, by water's", "density_ratio", 1e-3, 1e6)
VISCOSITY = Axis("viscosity (m²/s)", "scene.viscosity", 1e-9, 1.0)
SLENDERNESS = Axis("slenderness l / (2 max(a, b))", "slenderness", 5.0, 500.0)
SPEED = Axis("speed (m/s)", "flow_speed", 1e-3, 10.0)
PLANE: dict[str, Any] = {"scene": {"planar": True}}
ROLLING = {"initial_angular_velocity": [0.1, 0.0, 0.0]}
SERVOS = {"robot": "eight_servos", "duration": 0.5, **PLANE}
FINS = {"fins": "pair station=0.3 area=0.001 aspect_ratio=3 k_p=2 time_constant=0.05", "duration": 1.0, **ROLLING}
VORTEX = {"flow": "vortex centre=0,0.3,0", **PLANE}


def amplitudes(low: float, high: float) -> Axis:
    """The amplitude of the wave as an axis."""
    return Axis("amplitude, by the paper's", "amplitude", low, high)


def spindle(length: float, slenderness: float) -> Swim:
    """A spindle of `length` [m] that swims with the paper's wave scaled to it."""
    wave = {"wavelength": length, "amplitude_0": 1.0 / length, "amplitude_1": 0.5 / length**2}
    swim = varied(swim_with({}), {**wave, "amplitude_2": 2.0 / length**3})
    return swim.changed(body=Body.spindle(length, slenderness))


def swim_with(words: dict[str, Any]) -> Swim:
    """Four periods of the paper's robot, or the swim that these `words` of a scene describe."""
    return swim_of({"gait": "straight", "duration": 4.0, **words}).changed(accuracy=Accuracy.of(TARGET))


ROWS: dict[str, tuple[str, Axis, Axis, dict[str, Any]]] = {  # name: title, axes, words of the scene
    "gait": ("period and amplitude: 4 periods", PERIOD, amplitudes(1e-12, 4.0), {}),
    "wave": ("wavelength and amplitude: 4 periods", Axis("wavelength (body lengths)", "wavelength", 0.2, 100.0),
             amplitudes(1e-3, 12.0), {}),
    "water": ("density and viscosity: 4 periods", DENSITY, VISCOSITY, {}),
    "viscosity": ("period and viscosity: 4 periods", PERIOD, VISCOSITY._replace(low=1e-10), {}),
    "velocity": ("initial velocity, and spin about three axes: 0.2 s", Axis("speed (m/s)", "initial.v_x", 1e-2, 100.0),
                 Axis("spin (turns/s)", "spin", 1e-2, 100.0), {"duration": 0.2}),
    "body": ("length and slenderness: 4 periods", Axis("length (m)", "length", 0.01, 100.0), SLENDERNESS, {}),
    "step": ("a fixed step (classical Runge-Kutta): 4 periods", Axis("step (periods)", "step", 1e-2, 1.0), DENSITY, {}),
    "preset": ("the presets, each by its own target: 4 periods", PERIOD,
               Axis("preset", "accuracy", choices=tuple(PRESETS)), {}),
    "method": ("every adaptive method: 4 periods", Axis("tolerance of a step", "tolerance", 1e-8, 1.0),
               Axis("method", "method", choices=METHODS), {}),
    "gust": ("a gust from the side, and how fast it rises: 4 s", Axis("rise (s)", "flow.rise", 1e-3, 10.0), SPEED,
             {"flow": "gust velocity=0,0.1,0 start=1"}),
    "vortex": ("core and circulation of a vortex: 4 s", Axis("core (m)", "flow.core", 1e-2, 10.0),
               Axis("circulation (m²/s)", "flow.circulation", 1e-4, 1.0), VORTEX),
    "shear": ("width and speed of a shear layer: 4 s", Axis("width (m)", "flow.width", 1e-2, 10.0), SPEED,
              {"flow": "shear", **PLANE}),
    "servos": ("stiffness and damping of eight servos: 0.5 s", Axis("kp (N m/rad)", "robot.kp", 0.1, 1e6),
               Axis("kd (N m s/rad)", "robot.kd", 1e-4, 1e2), SERVOS),
    "dampers": ("damping of eight servos, and density: 0.5 s", Axis("kd (N m s/rad)", "robot.kd", 1e-2, 1e4), DENSITY,
                SERVOS),
    "fins": ("area of fins that hold the roll, and their servo: 1 s", Axis("area (m²)", "fins.area", 1e-5, 1.0),
             Axis("time constant (s)", "fins.time_constant", 1e-2, 10.0), FINS),
}  # fmt: skip


def maps_of(points: int) -> tuple[Map, ...]:
    """The maps, of `points` by `points` runs each. Maps over presets or methods have one row for each."""
    how = {name: {"at": spindle} if name == "body" else {"swim": swim_with(row[3])} for name, row in ROWS.items()}
    return tuple(Map(name, *row[:3], points, **how[name]) for name, row in ROWS.items())
