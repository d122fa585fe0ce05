"""One leg of a swim, as the compiled loops take it: who swims, driven by what, from where on, through which instants.

A leg is a row of words (`packed`), and `swim` takes the rows of many swimmers at once: the way from Python into the
loops and back costs the same for one as for a hundred.
"""

from functools import cache, lru_cache
from typing import NamedTuple

import numpy as np

from .compiled import compiled, inlined, shared, spliced
from .drive import DRIVE, Drive, factors
from .fields import Fields, fields_of
from .integrator import (
    CONTROL,
    MARCHED,
    NOT_FINITE,
    SINGULAR,
    Control,
    Step,
    begin_at,
    march,
    square_of,
    state_at,
    step_of,
)
from .kernel import add_head_twist, configure
from .methods import METHOD, Method
from .momentum import momentum_of_twist
from .packed import Form, Layout, Packed, Space
from .profiles import PROFILES, Profiles, StationFields, observe, station_fields_of
from .rates import head_axes, settle, to_world
from .sections import STATIONS, SWIMMER, Stations, Swimmer
from .wrench import Balance, balance_of, kinetic_energies

GO_ON, AGAIN, MOVED, FIRST, STILL, KNOWN = range(6)  # how a leg begins: `Order.begin`
# Where the numbers begin that a leg takes and leaves, in `Order.place` (28,): state y (13,), which ends as the last;
# twist (6,) of the head relative to the water, in its axes, rad/s and m/s; current (3,) m/s; then what became of the
# leg: kinetic energy J where the state got a twist; steps, rejected steps and evaluations so far; samples reached;
# status.
Y, TWIST, CURRENT, ENERGY, COUNT, REACHED, STATUS, PLACE = 0, 13, 19, 22, 23, 26, 27, 28


class Scratch(NamedTuple):
    """Work space of an instant: nothing in it is kept from one to the next."""

    fields: Fields
    balance: Balance
    here: StationFields


class Order(NamedTuple):
    """What is wanted of a leg."""

    place: np.ndarray  # (28,) see `PLACE`
    breakpoints: np.ndarray  # (.,) s, of the shape
    distributed: bool  # the tail's pressure
    begin: int  # GO_ON within the step; AGAIN: a step begins at `time` in the state; MOVED: so, with the momentum of
    # the twist; FIRST: so, and nothing has been before; STILL: no step, the state's own twist is found; KNOWN: the
    # states at the samples are in `out` (`note`)
    time: float  # s
    first_step: float  # s, length of the first of all steps
    look: bool  # fill `out`
    wrench: bool  # the internal wrench too
    load: bool  # the water's load along the body too
    times: np.ndarray  # (T,) s, ascending: the samples
    works: np.ndarray  # (T, 4) J, or (1, 4) with no samples


class Leg(NamedTuple):
    """All that the loops take."""

    swimmer: Swimmer
    stations: Stations
    drive: Drive
    scratch: Scratch
    step: Step
    method: Method
    control: Control
    out: Profiles
    order: Order


class ReadyLeg(NamedTuple):
    """A leg for `swim`, and what has to stay in memory until it is over."""

    row: np.ndarray  # (words,)
    order: Order
    swimmer: Packed
    stations: Packed
    tables: Packed
    times: Packed
    scratch: Space
    step: Space
    method: Packed
    control: Packed


class GoingOn:
    """The legs by which a swim goes on to an instant, made once for as long as what they are made of stays: to make one
    takes a node longer than to swim it. A copy makes its own, for its arrays are elsewhere."""

    def __init__(self):
        self._parts, self._legs, self.times = (), {}, np.zeros(1)

    def __reduce__(self):
        return GoingOn, ()

    def rows(self, parts: tuple, key, make) -> np.ndarray:
        """The one row (1, words) of the leg `key`, to `times`, made by `make()` unless it is made of these `parts`."""
        if len(parts) != len(self._parts) or any(a is not b for a, b in zip(parts, self._parts, strict=True)):
            self._parts, self._legs = parts, {}
        if key not in self._legs:
            leg = make()
            self._legs[key] = leg, leg.row[None]
        return self._legs[key][1]


def _any_scratch() -> Scratch:
    return Scratch(fields_of(1, 1, 1), balance_of(1), station_fields_of(1))


def _any_order() -> Order:
    row, two = np.zeros(1), np.zeros((1, 1))
    return Order(row, row, True, 0, 0.0, 0.0, True, True, True, row, two)


SCRATCH, STEP, ORDER = Form(_any_scratch), Form(lambda: step_of(1, 1)), Form(_any_order)
PARTS = SWIMMER, STATIONS, DRIVE, SCRATCH, STEP, METHOD, CONTROL, PROFILES, ORDER
LEG = Form(lambda: Leg(*(form.example for form in PARTS)))


@lru_cache(maxsize=256)
def scratch_layout(nodes: int, widest: int, rows: int, stations: int) -> Layout:
    """For `nodes` nodes in panels of up to `widest`, a law of up to `rows` rows, and so many `stations`."""
    return Layout(SCRATCH, Scratch(fields_of(nodes, rows, widest), balance_of(nodes), station_fields_of(stations)))


@cache
def step_layout(stages: int, past: int) -> Layout:
    """For a method of so many `stages`, that goes back by so many steps."""
    return Layout(STEP, step_of(stages, past))


@shared
def set_in_motion(swimmer, drive, fields, time, twist, y):
    """Give state `y` (13,) at `time` the momentum of the head's `twist` (6,) relative to the water. Returns the kinetic
    energy [J] of body and water (without the nose's)."""
    factors(drive, time, fields.factor)
    configure(swimmer, drive, fields)
    momentum_of_twist(swimmer, fields, twist, y[7:])
    axes = head_axes(y)
    to_world(axes, y, 7)
    to_world(axes, y, 10)
    add_head_twist(swimmer, fields, twist)
    body, water = kinetic_energies(swimmer, fields)
    return body + water


open_swimmer, open_stations, open_drive, open_scratch, open_step, open_method, open_control, open_out, open_order = (
    LEG.opener(field) for field in Leg._fields
)


@compiled
def begin(row):
    """Have the march begin as the leg of the `row` says. Returns a status."""
    order, step, drive, fields = open_order(row), open_step(row), open_drive(row), open_scratch(row).fields
    y, twist, time = order.place[Y:TWIST], order.place[TWIST:CURRENT], order.time
    if order.begin == STILL:
        good = settle(open_swimmer(row), drive, fields, time, y, head_axes(y), step.momentum, twist)
        return MARCHED if good else SINGULAR
    if order.begin >= MOVED:
        energy = set_in_motion(open_swimmer(row), drive, fields, time, twist, y)
        order.place[ENERGY] = energy
        if order.begin == FIRST:
            step.scale[0], step.scale[1] = square_of(y, 7, 10), square_of(y, 10, 13)
            step.budget[0] = open_control(row).spare_steps
            for k in range(3):
                step.time[k], step.count[k] = 0.0, 0
            if not abs(energy) < np.inf:
                return NOT_FINITE
    begin_at(step, time, y, order.works[0], order.first_step)
    return MARCHED


@inlined
def note(out, sample, y):
    """Leave state `y` (13,) in `out` for `recall`."""
    for k in range(3):
        out.position[sample, k] = y[k]
    for k in range(4):
        out.orientation[sample, k] = y[3 + k]
    for k in range(6):
        out.twist[sample, k] = y[7 + k]


@inlined
def recall(out, sample, y):
    """State `y` (13,) of a sample that is not yet observed."""
    for k in range(3):
        y[k] = out.position[sample, k]
    for k in range(4):
        y[3 + k] = out.orientation[sample, k]
    for k in range(6):
        y[7 + k] = out.twist[sample, k]


@compiled
def look(row, sample, time):
    """Fill the `sample` of `out` for the leg of the `row`, which has come to `time`. Returns whether it could be done.
    Not built into `swim`: a call for a sample costs nothing, and to compile it there as well takes half a minute."""
    order = open_order(row)
    fields, balance, here = open_scratch(row)
    return observe(
        *(open_swimmer(row), open_stations(row), open_drive(row), fields, balance, here, open_step(row)),
        *(order.place[CURRENT:ENERGY], order.distributed, order.wrench, order.load, time, order.place[Y:TWIST], sample),
        open_out(row),
    )


@spliced
def go(row, order, step):
    """March through the samples of the leg of the `row`, which has begun. Returns how many were reached, and a
    status."""
    swimmer, drive, method, control = open_swimmer(row), open_drive(row), open_method(row), open_control(row)
    fields, balance, _ = open_scratch(row)
    y, current = order.place[Y:TWIST], order.place[CURRENT:ENERGY]
    for sample in range(len(order.times)):
        time = order.times[sample]
        if order.begin == KNOWN:
            recall(open_out(row), sample, y)
        else:
            status = march(swimmer, drive, fields, balance, current, method, control, order.breakpoints, step, time)
            if status != MARCHED:
                return sample, status
            state_at(method, control, step, time, y, order.works[sample])
        if order.look and not look(row, sample, time):
            return sample, SINGULAR
    return len(order.times), MARCHED


@compiled
def swim(legs):
    """Swim each of the `legs` (B, words), one after the other, and leave in its `place` what became of it.

    The one entry to all loops: what is compiled once for it serves every use.
    """
    for k in range(legs.shape[0]):
        row = legs[k]
        order, step = open_order(row), open_step(row)
        known = order.begin == KNOWN
        reached, status = 0, MARCHED if known or order.begin == GO_ON else begin(row)
        if status == MARCHED:
            reached, status = go(row, order, step)
        order.place[REACHED], order.place[STATUS] = reached, status
        for j in range(0 if known else 3):
            order.place[COUNT + j] = step.count[j]
