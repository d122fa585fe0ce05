# SPDX-License-Identifier: Apache-2.0
"""The compiled module, whichever level of the processor it is for.

Arrays are contiguous, in the byte order of this machine, and of doubles, unless another type is named; they go through
the buffer protocol. What does not fit raises `ValueError`, `TypeError` or `IndexError`. SI units and radians.
The state (13,) of a swimmer is the head's position [m], its orientation (x y z w, world from head), and the
angular and linear momentum [N m s, N s] of body and water about the head; all of them in the world's axes. A twist (6,)
is (Omega, V) [rad/s, m/s] of the head in its own axes, relative to the water unless it says otherwise. A wrench (6,) is
(torque, force) [N m, N] about the head, in its axes. T instants, M stations, n nodes, m rows of a law.
"""

from collections.abc import Callable, Iterable, Sequence
from typing import Any, Self

import numpy as np
from typing_extensions import Buffer as _Buffer

Buffer = _Buffer | np.ndarray  # numpy's stubs call an array a buffer from Python 3.12 on

FRICTION_LAWS: tuple[str, ...]  # of the axial friction
STATUSES: tuple[str, ...]
"""Names of the numbers by which a march tells how it ended: "marched", "not_finite", "step_too_small", "singular",
"too_many_steps", "unfinished"."""

def build_info() -> dict[str, str]:
    """How this module was compiled: level, compiler, flags, sanitizers, pybind11."""

MOST_SERVOS: int  # of fins, whose angles are states
FILLED: int  # stations of a stretch: those of sensors begin one

def layout(
    samples: int, stations: int, wrench: bool, load: bool, fins: int = 0, sensors: int = 0
) -> dict[str, tuple[int, int, int, int]]:
    """Where each quantity of so many samples lies in one array of numbers.

    By its name: (begin, instants, numbers, of). A quantity takes instants * numbers of the array from begin on, times
    the stations where it is given along the body (of 1), times the fins (of 2) or the sensors (of 3), the last index
    running fastest. One that is not asked for has no instants.
    wrench: the internal wrench; load: what the water does along the body.
    """

class _Shared:
    """Never changes: copies are the object itself."""

    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: dict[int, Any]) -> Self: ...

class Swimmer(_Shared):
    """Body and water on a grid, and which physics is on. It is copied from Python and never changes."""

    def __init__(
        self,
        grid: Any,
        sections: Any,
        stations: Any,
        *,
        shown: int,
        friction: str,
        resistive: bool,
        segmented: bool,
        first_watched: int,
        wake: bool,
        inertia_of_water: bool,
        tail_water: Buffer,
        flow_gradient: bool,
        nose_mass: float,
        nose_drag: float,
        distributed_pressure: bool,
        offset: bool,
        righting: float,
        gravity: float,
        missed_drag: Iterable[Buffer] = (),
        fins: list[tuple[Any, ...]] = ...,
        servos: list[tuple[float, float, float, float, int, float]] = ...,
        appendages: list[tuple[int | None, list[float], list[float], bool, bool, int]] = ...,
    ) -> None:
        """grid: with the attributes of `Grid` (eel_dynamics/model/body/grid.py). sections, at its nodes, and stations:
        of `SectionData` and `StationData` (eel_dynamics/model/section_data.py). shown: stations of the profiles;
        those of sensors follow, from a multiple of `FILLED` on. friction: of `FRICTION_LAWS`.
        resistive: drag along the body. segmented: its links have one of their own. first_watched: first of the speeds
        (0 V1, 1 V2, 2 V3, 3 Omega1, 4 Re/8e4 - 1) whose changes of sign within a panel are integrated exactly; 5 for
        none. inertia_of_water: the nodes' sections have that of the water. tail_water: (3,) added masses [kg/m], [kg m]
        that are swept off at the tail. flow_gradient: its forces. nose_mass: m_o [kg]; nose_drag: 1/2 rho_f k_o [kg/m].
        distributed_pressure: along the body in place of at the tail. offset: the centre of mass is off the axis.
        righting, gravity [m/s^2]: g where `lever` gives a moment of weight, and where `net` gives a force; else 0.
        missed_drag: (K, n) [m] for V2, V3 and Omega1: of each node, what the drag's integral from the start of its
        panel misses, by the drag at the node, at K fractions (1 - cos(pi k / (K - 1))) / 2 of the panel; none where the
        sections are smooth. fins: (node at the end of a panel, normal (3,), centre of pressure (3,) [m], 1/2 rho_f area
        [kg/m], lift slope, 1 / (pi e AR), drag across and along, added mass [kg], servo, sign of its angle by the
        servo's, first station there or behind); servos: (time constant [s], limit [rad], roll gain, rate gain [s],
        node, initial angle [rad]). appendages: (node at the end of a panel, None at X = 0; place (3,) [m] and 1/2 rho_f
        drag areas (3,) [kg/m] in section axes; whether by the law of the speed; whether it is the base of the tail;
        first station there or behind, none of them at the end of the tail). `ValueError` names what does not fit."""

class RampedFlow:
    """The velocity (3,) [m/s], times the sum of ramps as those of a law's envelope; without ramps, times 1. All flows
    are in the world's axes."""

    def __init__(self, velocity: Buffer, ramps: list[tuple[float, float, float]]) -> None: ...

class SplineFlow:
    """A velocity [m/s] over time: knots (n,) [s], coefficients (n - 1, 4, 3) of cubics, from the constant one on."""

    def __init__(self, knots: Buffer, coefficients: Buffer) -> None: ...

class ShearFlow:
    """A layer: the velocity (3,) [m/s] far to one side, the layer's unit normal (3,) `across`, the place of its
    middle along that [m], its width [m], and whether its profile is linear."""

    def __init__(self, velocity: Buffer, across: Buffer, middle: float, width: float, linear: bool) -> None: ...

class VortexFlow:
    """Upright vortices: rows (n, 3) of x [m], y [m] and circulation [m^2/s], the radius of their cores [m], and the
    velocity (3,) [m/s] of their drift."""

    def __init__(self, vortices: Buffer, core: float, drift: Buffer) -> None: ...

class WaveFlow:
    """A wave on deep water: amplitude [m], wavenumber [1/m], angular frequency [rad/s], height of the surface [m],
    phase [rad], horizontal unit direction (3,)."""

    def __init__(
        self, amplitude: float, wavenumber: float, frequency: float, surface: float, phase: float, direction: Buffer
    ) -> None: ...

class GriddedFlow:
    """Velocities (t, x, y, z, 3) [m/s] at the points of the axes t [s], x, y and z [m], which rise."""

    def __init__(self, axes: tuple[Buffer, ...], velocity: Buffer) -> None: ...

class FunctionFlow:
    """function(time [s], rows (n, 18)) completes rows as those of `Flow.at`."""

    def __init__(self, function: Callable[[float, memoryview], None]) -> None: ...

Source = RampedFlow | SplineFlow | ShearFlow | VortexFlow | WaveFlow | GriddedFlow | FunctionFlow

class Flow(_Shared):
    """How the water moves by itself: the sum of its sources."""

    def __init__(self, sources: Sequence[Source]) -> None:
        """`ValueError` for what is no source."""

    def at(self, time: float, rows: Buffer) -> None:
        """Completes the rows (n, 18) at a time [s]: of the place (3,) [m], which stands first, the velocity (3,) [m/s],
        its rate (3,) [m/s^2] at the fixed place, and the Jacobian (3, 3) [1/s], row by row."""

class LawTables(_Shared):
    """The m rows of a curvature law, each a field of X for one axis, on the nodes and stations of a swimmer."""

    def __init__(self, axis: Sequence[int], rows: Buffer, nodes: int, stations: int) -> None:
        """axis: of each row, 0 pitch, 1 yaw. rows (m, 4 (n + s)) for n nodes and s stations. Each holds the field at
        the nodes [rad/m]; its three Magnus moments [rad] over the interval that ends at each node, (3, n); the field at
        the stations; and its moments from the node before each station, (3, s). `ValueError` for another size."""

class LawOnGrid(_Shared):
    """The curvature K(t, X): the sum of rows times factors of time, with two time derivatives."""

    def __init__(
        self,
        tables: LawTables,
        origin: float,
        waves: list[tuple[float, Sequence[Sequence[tuple[float, float, float]]], int, int]],
        segment: tuple[int, float, float] | None,
        blend: tuple[int, float, float] | None,
    ) -> None:
        """origin [s]: simulation time of the law's own t = 0. waves: (period [s], envelope, row of the sine, row of
        the cosine); period 0: constant in time; envelope: factors that multiply, each a row of ramps (start [s], end
        [s], delta) that add up from 0; no factor: 1. segment:
        (first of its twelve rows, start [s], end [s]) of a quintic between two instants of a controller: for each axis
        value, rate and acceleration at both. blend: (first of its six rows, start [s], end [s]) of a difference that
        dies out. `ValueError` for a row that the tables do not have."""

    def factors(self, time: float) -> list[list[float]]:
        """Factors of the rows at a time [s] of the simulation, their rates and accelerations: (3, m)."""

class StepBounds(_Shared):
    """What bounds the time steps of a march."""

    tolerance: float  # relative error of a step
    longest: float  # [s], of a time step; a fixed method takes all as long, or a little shorter
    smallest: float  # [s]
    length: float  # [m], the scale of positions
    momentum_floor: float  # [kg m/s], below which momentum counts as none
    part_of_span: float  # of the time between two breakpoints, that a step may take
    most_steps: float  # per simulated second
    spare_steps: float  # beyond these, to be spent at any time
    torque_floor: float  # [N m], of a robot: smaller torques count as none

    def __init__(self, **bounds: float) -> None:
        """All of these, by their names."""

class Modes(_Shared):
    """The modes of a robot on a grid. It is copied from Python and never changes."""

    def __init__(
        self, table: Any, x: Buffer, torques: list[tuple[Any, ...]], drive: LawOnGrid | None, push: Buffer
    ) -> None:
        """table: with the attributes of `ModeTable` (eel_dynamics/model/robot/compiled.py), of M modes and C
        coordinates. x: of the nodes [m]. torques: (coordinate, function of the time [s]), or (coordinate, knots [s],
        cubics). drive, push: the law of the muscles' moments, and (C, its rows) what it does to the coordinates.
        `ValueError` for arrays that do not fit together."""

class March:
    """A swimmer on its way. Its law comes first (`follow`), then the start; one thread at a time may call it.

    With the M modes of a robot it bends by itself: C coordinates, S servos. Python's lock is free while it marches.
    `RuntimeError` where it follows no law on its grid yet, or another thread is in it.
    """

    def __init__(self, swimmer: Swimmer, method: str, order: int, planar: bool, modes: Modes | None = None) -> None:
        """method: "adams" (orders 1 to 6), "dormand_prince" or "classical"; with modes their own. planar: three degrees
        of freedom. `ValueError` for modes on another grid."""

    def __copy__(self) -> Self:
        """A march of its own in the same state; it shares the swimmer, the modes and the law."""

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        """As `copy.copy`."""

    def state_as_bytes(self) -> bytes:
        """All that goes on, without what drives the body."""

    def set_state_from_bytes(self, state: bytes) -> None:
        """Goes on from the state of another march of the same swimmer by the same method, which followed what this one
        follows; to the same bit. `ValueError` for other bytes: nothing has changed then."""

    def change(self, swimmer: Swimmer, method: str, order: int, planar: bool, modes: Modes | None = None) -> None:
        """Goes on with another grid or method, with the same momentum, and the same coordinates at the same rates; a
        law on the new grid must follow."""

    def follow(
        self,
        law: LawOnGrid,
        breakpoints: Sequence[float],
        bounds: StepBounds,
        ledger: bool,
        current: Buffer,
        flow: Flow | None,
        smoothly: bool,
        fin_angles: Sequence[tuple[Buffer, Buffer]] = ...,
        reference: Buffer | None = None,
        wrenches: Sequence[tuple[Any, ...]] = ...,
    ) -> None:
        """What drives the body from now on. law: of R rows that are imposed, and M of the modes. breakpoints: ascending
        times [s] at which a derivative of the shape or of the flow jumps. ledger: the works are integrated too.
        current (3,) [m/s]: of the water, world. flow: how the water moves besides. smoothly: the motion goes on as
        before, so that the next step need not begin anew. fin_angles: what each servo of the fins is given, knots (n,)
        [s] and coefficients (n - 1, 4) of cubics [rad]. reference (S, R): what the servos of a robot follow, by the
        factors of the imposed rows. wrenches, from outside: of each (node or None at X = 0, first station there or
        behind, whether in the axes of the world, not of the section as base_link is turned, and torque [N m] and force
        [N] as a function of the time that gives six numbers, or knots (n,) [s] and coefficients (n - 1, 4, 6)).
        `ValueError` for a law on another grid."""

    def start(
        self, position: Buffer, orientation: Buffer, twist: Buffer, x: Buffer | None = None, rate: Buffer | None = None
    ) -> float:
        """Stands at time 0 at a position (3,) [m] with an orientation (4,) (x y z w, world from head), the head's twist
        (6,), coordinates x (C,) and their rates (C,), or none. Kinetic, potential and elastic energy [J]."""

    def set_state(self, position: Buffer, orientation: Buffer, twist: Buffer) -> float:
        """Puts the head of the present shape at a position (3,) [m] with an orientation (4,) (x y z w, world from head)
        and its twist (6,). The energy [J] as of `start`."""

    def set_twist(self, twist: Buffer) -> float:
        """Gives the present state the momentum of the twist (6,). The energy [J] as of `start`."""

    def twist(self) -> list[float]:
        """Twist (6,) in the present state. `ValueError` where the inertia is not positive definite."""

    def set_slice(self, nodes: int) -> int:
        """Sets how many nodes are evaluated before a march comes back unfinished; what it was."""

    def advance(self, time: float) -> int:
        """Marches to a time [s]; the number of a status. "unfinished" comes at the end of a step, when a slice has been
        evaluated: call again. At the others but "marched" the state stays the last good one."""

    def record(
        self,
        times: Buffer,
        first: int,
        whole: Buffer,
        works: Buffer,
        rows: Buffer,
        wrench: bool,
        load: bool,
        until: float,
    ) -> tuple[int, int]:
        """Marches through the times (T,) [s] from number `first` on, up to `until` [s], and observes each. whole:
        writable, as `layout` has it; works (T, 6) [J]: writable, as `works`; rows (T, size): writable, of the
        coordinates as `row` has them. How many of the instants are complete, and the number of a status; as in
        `advance`."""

    def observe(self, whole: Buffer, row: Buffer, wrench: bool, load: bool) -> bool:
        """Writes what the present shows into `whole`, as `layout` has it for one sample, and the coordinates' numbers
        into the row. False where the inertia is not positive definite."""

    def command(
        self,
        servo: int,
        kind: str,
        angle: float = ...,
        rate: float = ...,
        torque: float = ...,
        low: float = ...,
        high: float = ...,
    ) -> None:
        """Have a servo do so from now on. kind: position (angle [rad], with a rate [rad/s]), velocity (rate), effort
        (torque [N m] alone), or law: what the law asks. To the feedback on position or velocity the torque is added. A
        velocity moves the reference from low to high [rad] at most."""

    def to_blame(self, singular: bool) -> int:
        """The coordinate with the greatest error in the last step. singular: the first mode that makes the mass matrix
        singular in the present state, if one does."""

    @property
    def time(self) -> float:
        """[s]."""
    @property
    def state(self) -> list[float]:
        """(13,)."""
    @property
    def works(self) -> list[float]:
        """(7,) [J] of actuators, wake, nose, drag, flow, fins and appendages since the start."""
    @property
    def outside(self) -> tuple[float, float, float, float] | None:
        """Time [s] and place [m], world, outside the grid of the flow, where the last evaluation was there."""
    @property
    def row(self) -> dict[str, tuple[int, int]]:
        """Where the numbers of an instant lie in a row, from and up to: x, rate, acceleration (C,) each; moment (M,),
        the internal moment on each mode; torque (S,) of the servos; pushing (C,) of muscles and given torques; elastic
        [J], rotors [J], motor_power [W], damping_power [W], damping_work [J]. Without modes all are empty."""
    @property
    def counts(self) -> tuple[int, int, int]:
        """Steps, rejected steps and evaluations of the head's dynamics so far."""

def tabulate(weights: Buffer, values: Buffer, rows: Buffer) -> None:
    """Tabulates a controller's sample: rows (6, k) of its values (6, n) at n points, by the weights (n, k)."""

class SampledMarches:
    """N swimmers of one kind, each under a controller's samples of its own: values (6, n) at n points, pitch, its rate
    and its acceleration, then yaw. One thread of Python at a time; `RuntimeError` for another.

    weights (n, 4 (nodes + M)): take values at the points to the columns of a `LawTables`. transition: [s], in which the
    difference between the straight body and the first sample dies out. threads: that march; they change no result.
    The other arguments are those of `March`.
    """

    def __init__(
        self,
        swimmer: Swimmer,
        *,
        method: str,
        order: int,
        planar: bool,
        ledger: bool,
        current: Buffer,
        weights: Buffer,
        transition: float,
        count: int,
        threads: int,
    ) -> None: ...
    def start(
        self,
        index: int,
        bounds: StepBounds,
        position: Buffer,
        orientation: Buffer,
        twist: Buffer,
        values: Buffer,
        flow: Flow | None = None,
    ) -> float:
        """Has a swimmer stand at its start, straight, at time 0, where its sample has the values (6, n). Kinetic and
        potential energy [J]. flow: how its water moves, no function of Python."""

    def wake(self) -> None:
        """Wakes the threads, as `advance` will be called soon."""

    def advance(self, times: Buffer, values: Buffer, status: Buffer, heads: Buffer) -> bool:
        """Marches each to its own of the times (N,) [s], where its sample has its values (N, 6, n). Whether all marched
        that are not left out.

        status (N,), signed 64 bits: swimmers below 0 are left out; then how each came back, an index of `STATUSES`. One
        that is unfinished goes on with the same time and values. heads (13, N): position [m], orientation, and twist
        over ground [rad/s, m/s] of each that marched. In the plane the twist is that of the steps: `observe` shows the
        one in space, where the rate of bending is integrated over the nodes.
        """

    def put_head(self, index: int, heads: Buffer) -> bool:
        """Writes the head of a swimmer into its column of the heads (13, N). False where the inertia is not positive
        definite."""

    def observe(self, index: int, whole: Buffer, wrench: bool, load: bool) -> bool:
        """As `March.observe`."""

    def state_as_bytes(self) -> bytes:
        """All that goes on."""

    def set_state_from_bytes(self, state: bytes, flows: Sequence[Flow | None]) -> None:
        """Goes on from the state of other marches of the same kind, to the same bit. flows: of each, as of `start`.
        `ValueError` for other bytes: nothing has changed then."""

    def present(self, index: int) -> tuple[float, list[float], tuple[int, int, int]]:
        """Time [s], works and counts of a swimmer, as of `March`."""

def repeat_rate(
    swimmer: Swimmer, planar: bool, law: LawOnGrid, time: float, state: Buffer, count: int, flow: Flow | None = None
) -> None:
    """Finds the rate of a state (13,) `count` times (a million at most) at a time [s], with no current, without
    Python's lock: for benchmarks. planar: in three degrees of freedom."""

class Instant:
    """Single instants of a motion in space."""

    def __init__(self, swimmer: Swimmer) -> None: ...
    def inertia(self, law: LawOnGrid, time: float) -> list[list[float]]:
        """Inertia (6, 6) of body, water and nose about the head, in the paper's axes, rotation first, as the law bends
        the body at a time [s]."""

    def loads(self, law: LawOnGrid, time: float, twist: Buffer) -> tuple[list[float], list[float]]:
        """Wrenches (6,) of the wake and of the drag along the body, for a twist (6,) of the head at a time [s]."""

    def drag_powers(
        self,
        law: LawOnGrid,
        times: Buffer,
        twists: np.ndarray,
        powers: Buffer,
        current: Buffer,
        flow: Flow | None,
        poses: Buffer,
        modes: Buffer,
    ) -> None:
        """Writes powers (T, 6) [W] on the body: of the axial friction, the lateral, the vertical and the roll drag, the
        drag of the links, and that of the base of the tail.

        times (T,) [s]; twists (T, 6) of the head; current and flow as in `March.follow`; poses (T, 7) of the head:
        position [m] and orientation. modes (T, 2, M): factors of the law's last M rows, a robot's, and their rates.
        """

    def momentum_rate(self, law: LawOnGrid, time: float, twist: Buffer, acceleration: Buffer) -> list[float]:
        """Rate (6,) of the momentum along the body, [N m, N] about the head in its axes, for a twist (6,) and a true
        acceleration (6,) [rad/s^2, m/s^2] of the head, its axes."""
