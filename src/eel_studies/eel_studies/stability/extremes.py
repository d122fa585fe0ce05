# SPDX-License-Identifier: Apache-2.0
"""The maps of `eel stability` without a scene: far beyond the range of any swimmer."""

from eel_dynamics.accuracy.accuracy import ORDERS, PRESETS, Accuracy
from eel_dynamics.runs.scene_file import swim_of
from eel_dynamics.runs.swim import Swim
from eel_model.body.body import Body
from eel_model.fins.fins import Fin, RollHold
from eel_model.flow.sources import Gust, Shear, Vortex
from eel_model.scene import Scene

from eel_studies.stability.maps import TARGET, Axis, Map
from eel_studies.varied import varied

METHODS = (*(("adams", order) for order in ORDERS["adams"]), ("dormand_prince", 5))
PERIOD = Axis("period (s)", "period", 0.02, 50.0)
DENSITY = Axis("density of the body, by water's", "density_ratio", 1e-3, 1e3)
VISCOSITY = Axis("viscosity (m²/s)", "scene.viscosity", 1e-9, 1.0)
SLENDERNESS = Axis("slenderness l / (2 max(a, b))", "slenderness", 5.0, 500.0)
SPEED = Axis("speed (m/s)", "flow_speed", 1e-3, 10.0)


def sized(low: float, high: float) -> Axis:
    """The amplitude of the wave as an axis."""
    return Axis("amplitude, by the paper's", "amplitude", low, high)


def spindle(length: float, slenderness: float) -> Swim:
    """A spindle of `length` [m] that swims by the paper's wave at its size."""
    wave = {"wavelength": length, "amplitude_0": 1.0 / length, "amplitude_1": 0.5 / length**2}
    swim = varied(wave_swim(), {**wave, "amplitude_2": 2.0 / length**3})
    return swim._replace(body=Body.spindle(length, slenderness))


def wave_swim() -> Swim:
    """Four periods of the paper's robot."""
    return swim_of({"gait": "straight", "duration": 4.0})._replace(accuracy=Accuracy.of(TARGET))


def servos() -> Swim:
    """Half a period of a robot with eight servos, in the plane."""
    words = {"gait": "straight", "robot": "eight_servos", "scene": {"planar": True}, "duration": 0.5}
    return swim_of(words)._replace(accuracy=Accuracy.of(TARGET))


def finned() -> Swim:
    """A period of the paper's robot, which rolls a little, with a pair of fins that hold the roll."""
    fins = Fin.pair(0.3, 1e-3, 3.0, angle=RollHold(), time_constant=0.05)
    return varied(wave_swim()._replace(fins=fins, duration=1.0), {"initial.omega_x": 0.1})


def maps_of(points: int = 13) -> tuple[Map, ...]:
    """The maps, of `points` by `points` runs each. Maps over presets or methods have one row for each of them."""
    swim = wave_swim()
    swept = swim._replace(flow=Vortex(centre=(0.0, 0.3, 0.0)), scene=Scene(planar=True))
    rows = (
        ("gait", "period and amplitude: 4 periods", PERIOD, sized(1e-12, 4.0), swim),
        ("wave", "wavelength and amplitude: 4 periods", Axis("wavelength (body lengths)", "wavelength", 0.2, 100.0),
         sized(1e-3, 12.0), swim),
        ("water", "density and viscosity: 4 periods", DENSITY, VISCOSITY, swim),
        ("viscosity", "period and viscosity: 4 periods", PERIOD, VISCOSITY._replace(low=1e-10), swim),
        ("velocity", "initial velocity, and spin about three axes: 0.2 s",
         Axis("speed (m/s)", "initial.v_x", 1e-2, 100.0), Axis("spin (turns/s)", "spin", 1e-2, 100.0),
         swim._replace(duration=0.2)),
        ("body", "length and slenderness: 4 periods", Axis("length (m)", "length", 0.01, 100.0), SLENDERNESS, None,
         spindle),
        ("step", "a fixed step (classical Runge-Kutta): 4 periods", Axis("step (periods)", "step", 1e-2, 1.0), DENSITY,
         swim),
        ("preset", "the presets, each by its own target: 4 periods", PERIOD,
         Axis("preset", "accuracy", choices=tuple(PRESETS)), swim),
        ("method", "every adaptive method: 4 periods", Axis("tolerance of a step", "tolerance", 1e-8, 1.0),
         Axis("method", "method", choices=METHODS), swim),
        ("gust", "a gust from the side, and how fast it rises: 4 s", Axis("rise (s)", "flow.rise", 1e-3, 10.0), SPEED,
         swim._replace(flow=Gust(velocity=(0.0, 0.1, 0.0), start=1.0))),
        ("vortex", "core and circulation of a vortex: 4 s", Axis("core (m)", "flow.core", 1e-2, 10.0),
         Axis("circulation (m²/s)", "flow.circulation", 1e-4, 1.0), swept),
        ("shear", "width and speed of a shear layer: 4 s", Axis("width (m)", "flow.width", 1e-2, 10.0), SPEED,
         swim._replace(flow=Shear(), scene=Scene(planar=True))),
        ("servos", "stiffness and damping of eight servos: 0.5 s", Axis("kp (N m/rad)", "robot.kp", 0.1, 1e6),
         Axis("kd (N m s/rad)", "robot.kd", 1e-4, 1e2), servos()),
        ("fins", "area of fins that hold the roll, and their servo: 1 s", Axis("area (m²)", "fins.area", 1e-5, 0.3),
         Axis("time constant (s)", "fins.time_constant", 1e-2, 10.0), finned()),
    )  # fmt: skip
    return tuple(Map(name, title, across, up, points, *at) for name, title, across, up, *at in rows)
