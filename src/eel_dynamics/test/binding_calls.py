# SPDX-License-Identifier: Apache-2.0
"""Calls of the compiled module as the library makes them, and changed ones, as no caller should make them.

    python binding_calls.py SEED FIRST LAST

makes the changed calls FIRST to LAST - 1 of a SEED, each with a use of what came of it. It writes the number of a call
before it: a crash or a hang is that call's.
"""

import copy
import faulthandler
import sys
from typing import Any, NamedTuple

import numpy as np
from eel_dynamics.model.fins.fins import Fin, RollHold
from eel_dynamics.model.flow.functions import FlowField
from eel_dynamics.model.flow.gridded import GriddedFlow
from eel_dynamics.model.flow.sources import Gust, Shear, VortexStreet, Wave
from eel_dynamics.model.robot.robot import Robot
from eel_dynamics.simulation.sampled_swimmers import SampledSwimmers

import eel_core
from eel_dynamics import ExternalWrench, Scene, Simulation
from eel_gaits import falling, straight

HANGS_AFTER = 120.0  # s
MOST_OF_A_KIND = 12  # calls of one function
CLASSES = "Swimmer", "Flow", "LawTables", "LawOnGrid", "StepBounds", "Modes", "March", "SampledMarches", "Instant"


class Call(NamedTuple):
    """A call of `name` of a class, or of the module (None): with an object before its arguments, where it has one."""

    kind: str | None
    name: str
    given: tuple[Any, ...]  # the object first, of a method
    named: dict[str, Any]


def recorded() -> list[Call]:
    """Calls of every function and method, with the arguments that the library gives."""
    calls: list[Call] = []
    known: dict[tuple[str | None, str], int] = {}

    def note(kind: str | None, name: str, given: tuple[Any, ...], named: dict[str, Any]) -> None:
        known[kind, name] = known.get((kind, name), 0) + 1
        if known[kind, name] <= MOST_OF_A_KIND:
            calls.append(Call(kind, name, given, named))

    def recording(kind: str) -> type:
        base = getattr(eel_core, kind)

        def method(name):
            own = getattr(base, name)

            def call(self, *given, **named):
                if name != "__init__":
                    note(kind, name, (self, *given), named)
                else:
                    note(kind, name, given, named)
                return own(self, *given, **named)

            return call

        names = [name for name, each in vars(base).items() if callable(each) and not name.startswith("_")]
        return type(kind, (base,), {name: method(name) for name in ("__init__", *names)})

    plain = {name: getattr(eel_core, name) for name in CLASSES}
    for name in CLASSES:
        setattr(eel_core, name, recording(name))
    own = eel_core.tabulate
    eel_core.tabulate = lambda *given: (note(None, "tabulate", given, {}), own(*given))[1]
    try:
        _swim()
    finally:
        eel_core.tabulate = own
        for name, kind in plain.items():
            setattr(eel_core, name, kind)
    simulation = Simulation(law=straight(), stations=5)
    simulation.advance(0.1)
    law, state, twist = simulation.law_on_grid, np.array(simulation.state), np.array((0.0, 0.0, 0.1, 0.2, 0.0, 0.0))
    swimmer, instants = simulation.discretisation.swimmer, np.linspace(0.0, 1.0, 3)
    note(None, "repeat_rate", (swimmer, False, law, 0.3, state, 2), {})
    note(None, "layout", (3, 5, True, True), {"fins": 2})
    note("March", "state_as_bytes", (simulation._march.core,), {})
    note("March", "set_state_from_bytes", (simulation._march.core, simulation._march.core.state_as_bytes()), {})
    for name in ("__copy__", "twist", "time", "state", "works", "outside", "row", "counts"):
        note("March", name, (simulation._march.core,), {})
    note("March", "set_slice", (simulation._march.core, 1000), {})
    note("March", "set_twist", (simulation._march.core, np.array(twist)), {})
    instant = eel_core.Instant(swimmer)
    note("Instant", "__init__", (swimmer,), {})
    note("Instant", "inertia", (instant, law, 0.3), {})
    note("Instant", "loads", (instant, law, 0.3, twist), {})
    note("Instant", "momentum_rate", (instant, law, 0.3, twist, twist), {})
    poses = np.tile((0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0), (3, 1))
    powers = instants, np.tile(twist, (3, 1)), np.zeros((3, 4)), np.zeros(3), None, poses, np.zeros((3, 2, 0))
    note("Instant", "drag_powers", (instant, law, *powers), {})
    return list(calls)  # objects of the recording classes go on noting theirs


def turning(place: np.ndarray, time: float) -> np.ndarray:
    """A flow that is a function of Python."""
    return np.stack([0.1 * place[..., 1], 0.0 * place[..., 0], 0.0 * place[..., 2]], axis=-1)


def _swim() -> None:
    """Swims that call everything."""
    axis = np.linspace(-3.0, 3.0, 4)
    grid = GriddedFlow(velocity=np.ones((2, 4, 4, 3)), time=np.array([0.0, 5.0]), x=axis, y=axis)
    for flow in (Gust(), Shear(), VortexStreet(), Wave(), grid, FlowField(turning)):
        simulation = Simulation(law=straight(), flow=flow, stations=5, fins=Fin.pair(0.3, 1e-3, 2.5, angle=0.1))
        simulation.advance(0.02)
        simulation.water_at((0.1, 0.1, -0.5))
    held = Fin.pair(0.3, 1e-3, 2.5, angle=RollHold(), time_constant=0.1)
    simulation = Simulation(law=falling(), fins=held, stations=5)
    simulation.record(np.linspace(0.0, 0.1, 3), True, True)
    simulation.adopt(straight(wavelength=0.2), transition=0.2)  # on a finer grid
    simulation.set_state((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0), np.zeros(6))
    simulation.advance(0.12)
    x, none = np.linspace(0.0, 1.0, 5), np.zeros(5)
    for time in (0.2, 0.3, 0.4):
        simulation.add_samples(time, x, none, none, none, x, none, none)
    simulation.advance(0.31)
    for name in ("eight_servos", "passive_tail"):
        robot = Robot.named(name)
        simulation = Simulation(law=straight(), robot=robot, stations=5)
        simulation.record(np.linspace(0.0, 0.02, 3), True, True)
        if robot.joints:
            simulation.command(robot.joints[0].name, position=0.1)
        simulation.advance(0.03)
        simulation._march.core.to_blame(False)
        simulation.observe()
    pulls = (
        ExternalWrench(1.0, ((1, 0, 0), (0, 1, 0)), time=(0.0, 0.1)),
        ExternalWrench(0.3, torque=lambda t: (0, 0, t)),
    )
    simulation = Simulation(law=straight(), wrenches=pulls, stations=5)
    simulation.apply_wrench(0.0, (0.1, 0.0, 0.0), frame="world")
    simulation.advance(0.05)
    swimmer = Simulation(scene=Scene(planar=True, ledger=False), stations=5).swimmer
    swimmers, rows = SampledSwimmers(2, x, None, swimmer, 2), np.zeros((2, 6, 5))
    rows[:, 3] = x
    for index in range(2):
        swimmers.start(index, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0), np.zeros(6), 0.0 * rows[index])
    swimmers.wake()
    swimmers.advance(np.full(2, 0.02), rows, np.zeros(2, dtype=np.int64))
    swimmers.observe(0)
    copy.deepcopy(swimmers)


class Changed:
    """An object with another value of one attribute."""

    def __init__(self, base: Any, name: str, value: Any):
        self._base, self._name, self._value = base, name, value

    def __getattr__(self, name: str) -> Any:
        return self._value if name == self._name else getattr(self._base, name)


ATTRIBUTES = (
    "first",
    "count",
    "weight",
    "matrix",
    "fraction",
    "barycentric",
    "series",
    "mass",
    "drag2",
    "laminar",
    "nodes_before",
    "added2_slope",
    "sections",
    "points",
    "missed",
    "axis",
    "degree",
    "start",
    "end",
    "limits",
    "stop_stiffness",
    "armature",
    "rest",
    "stiffness",
    "damping",
    "motors",
)  # fmt: skip  of tables that are handed over as objects
NUMBERS = (-1, 0, 1, 2**31, 2**63 - 1, 2**63, 2**64 - 1, 2**64, -(2**63), 1.5, -1.0, 0.0, 1e-300, 1e300)
OTHERS = None, float("nan"), float("inf"), -float("inf"), "text", b"bytes", bytearray(8), (), [], {}, True, object()


def changed_array(draw: np.random.Generator, array: np.ndarray) -> Any:
    """Another array, or the same numbers in another form."""

    def filled(*values):
        result = array.copy()
        if result.size:
            result.flat[int(draw.integers(result.size))] = values[int(draw.integers(len(values)))]
        return result

    def misaligned():
        there = np.zeros(array.nbytes + 1, dtype=np.uint8)[1:].view(array.dtype)
        return there.reshape(array.shape)

    def read_only():
        result = array.copy()
        result.flags.writeable = False
        return result

    integers = np.issubdtype(array.dtype, np.integer)
    top = np.iinfo(array.dtype).max if integers else 1e300
    forms = [
        lambda: array.astype(array.dtype.newbyteorder(">")),
        lambda: array.astype(np.float32),
        lambda: array.astype(np.int32),
        lambda: array.astype(complex),
        lambda: array.astype(object),
        lambda: array[::-1],
        lambda: np.repeat(array, 2, axis=-1)[..., ::2] if array.ndim else array,
        lambda: np.asfortranarray(array),
        lambda: array[:0],
        lambda: array[:-1] if array.ndim else array,
        lambda: np.concatenate((array.ravel(), array.ravel())),
        lambda: array.reshape(-1),
        lambda: array[None],
        lambda: np.array(0.0),
        lambda: memoryview(np.ascontiguousarray(array)),
        lambda: np.ascontiguousarray(array).tobytes(),
        lambda: filled(0, 1, top, top - 1) if integers else filled(np.nan, np.inf, -1.0, 0.0, top, -top),
        lambda: np.full_like(array, top if integers else np.nan),
        lambda: np.zeros_like(array),
        misaligned,
        read_only,
    ]
    return forms[int(draw.integers(len(forms)))]()


def changed(draw: np.random.Generator, value: Any) -> Any:
    """Another value in place of `value`, or one with another part."""
    if isinstance(value, np.ndarray) and draw.random() < 0.8:
        return changed_array(draw, value)
    if isinstance(value, (tuple, list)) and len(value) and draw.random() < 0.8:
        parts = list(value)
        index = int(draw.integers(len(parts)))
        if draw.random() < 0.15:
            del parts[index]
        else:
            parts[index] = changed(draw, parts[index])
        return parts if isinstance(value, list) or hasattr(value, "_fields") else tuple(parts)
    if isinstance(value, bytes) and value and draw.random() < 0.8:
        index = int(draw.integers(len(value)))
        return value[:index] + bytes([value[index] ^ 255]) + value[index + 1 - int(draw.integers(2)) :]
    own = [name for name in ATTRIBUTES if not isinstance(value, (str, float, int)) and hasattr(value, name)]
    if own and type(value).__module__.startswith("eel_") and draw.random() < 0.9:
        name = own[int(draw.integers(len(own)))]
        return Changed(value, name, changed(draw, getattr(value, name)))
    if draw.random() < 0.6 and isinstance(value, (int, float)):
        return NUMBERS[int(draw.integers(len(NUMBERS)))]
    kinds = [getattr(eel_core, name) for name in CLASSES]
    others = [*NUMBERS, *OTHERS, *(kind.__new__(kind) for kind in kinds), np.zeros(3), np.zeros(0)]
    return others[int(draw.integers(len(others)))]


def use(call: Call, made: Any, calls: list[Call]) -> None:
    """Use what a call has made, or the object that it was made of."""

    def given(kind, name, fits=lambda call: True):
        found = [each for each in calls if (each.kind, each.name) == (kind, name) and fits(each)]
        return found[0] if found else None

    if call.kind == "Swimmer":
        eel_core.Instant(made)
        march = eel_core.March(made, "adams", 5, False)
        nodes = len(call.given[0].first)
        follow = given("March", "follow", lambda each: _fits(march, each))
        if follow is not None and nodes:
            march.follow(*follow.given[1:], **follow.named)
            march.start(np.zeros(3), np.array((0.0, 0.0, 0.0, 1.0)), np.zeros(6))
            march.advance(0.05)
    elif call.kind == "LawOnGrid":
        (made if call.name == "__init__" else call.given[0]).factors(0.3)
    elif call.kind == "Flow" and call.name == "__init__":
        made.at(0.3, np.zeros((2, 18)))
    elif call.kind == "StepBounds" and call.name == "__init__":
        follow = given("March", "follow")
        march = copy.copy(follow.given[0])
        march.follow(follow.given[1], follow.given[2], made, *follow.given[4:], **follow.named)
        march.advance(march.time + 0.05)
    elif call.kind == "Modes":
        for each in calls:
            if (each.kind, each.name) == ("March", "__init__") and len(each.given) > 4 and each.given[4] is not None:
                eel_core.March(*each.given[:4], made)
    elif call.kind == "March" and call.name not in ("__init__", "change"):
        march = call.given[0]
        march.advance(march.time + 0.01)
    elif call.kind == "SampledMarches" and call.name not in ("__init__", "wake"):
        marches = call.given[0]
        marches.put_head(0, np.zeros((13, 2)))
        marches.present(0)


def _fits(march: Any, call: Call) -> bool:
    try:
        march.follow(*call.given[1:], **call.named)
    except (ValueError, TypeError, RuntimeError):
        return False
    return True


def make_changed(draw: np.random.Generator, calls: list[Call]) -> str:
    """Make one of the `calls` with a changed argument, and use what comes of it; what was raised."""
    call = calls[int(draw.integers(len(calls)))]
    given, named = list(call.given), dict(call.named)
    if call.kind == "March" and call.name != "__init__":
        given[0] = copy.copy(given[0])
    places = [*range(len(given)), *named]
    place = places[int(draw.integers(len(places)))] if places else None
    if isinstance(place, int):
        given[place] = changed(draw, given[place])
    elif place is not None:
        named[place] = changed(draw, named[place])
    try:
        if call.name == "__init__":
            made = getattr(eel_core, call.kind)(*given, **named)
        elif call.kind is None:
            made = getattr(eel_core, call.name)(*given, **named)
        else:
            found = vars(getattr(eel_core, call.kind))[call.name]
            made = (found.fget if isinstance(found, property) else found)(*given, **named)
        use(call._replace(given=tuple(given), named=named), made, calls)
    except Exception as error:
        return f"{call.kind}.{call.name}[{place}]: {type(error).__name__}: {error}"
    return f"{call.kind}.{call.name}[{place}]: taken"


def main() -> None:
    """See above."""
    seed, first, last = map(int, sys.argv[1:4])
    faulthandler.enable()
    calls = recorded()
    for number in range(first, last):
        print(number, end=" ", flush=True)
        faulthandler.dump_traceback_later(HANGS_AFTER, exit=True)
        print(make_changed(np.random.default_rng((seed, number)), calls).replace("\n", " "), flush=True)
        faulthandler.cancel_dump_traceback_later()
    print("called", *sorted({f"{call.kind}.{call.name}" for call in calls}))


if __name__ == "__main__":
    main()
