# SPDX-License-Identifier: Apache-2.0
"""The compiled module, whichever level of the processor it is for.

Arrays are contiguous and of doubles, unless another type is named; they go through the buffer protocol. SI units and
radians. The state (13,) of a swimmer is the head's position [m], its orientation (x y z w, world from head), and the
angular and linear momentum [N m s, N s] of body and water about the head; all of them in the world's axes. A twist (6,)
is (Omega, V) [rad/s, m/s] of the head in its own axes, relative to the water unless it says otherwise. A wrench (6,) is
(torque, force) [N m, N] about the head, in its axes. T instants, M stations, n nodes, m rows of a law.
"""

from collections.abc import Iterable, Sequence
from typing import Any, Protocol, Self

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

def layout(
    samples: int, stations: int, wrench: bool, load: bool, fins: int = 0
) -> dict[str, tuple[int, int, int, int]]:
    """Where each quantity of so many samples lies in one array of numbers.

    By its name: (begin, instants, numbers, of). A quantity takes instants * numbers of the array from begin on, or
    instants * stations * numbers where it is given along the body (of 1), or instants * fins * numbers of fins (of 2),
    the last index running fastest. One that is not asked for has no instants.
    wrench: the internal wrench; load: what the water does along the body.
    """

class _Points(Protocol):
    """Rows that integrate from the start of a panel to each of some points."""

    @property
    def matrix(self) -> Buffer: ...  # (points, p_max) [m]
    @property
    def first(self) -> Buffer: ...  # (points,) unsigned 64 bits, first node of the point's panel
    @property
    def count(self) -> Buffer: ...  # (points,) unsigned 64 bits, nodes of that panel
    @property
    def fraction(self) -> Buffer: ...  # (points,) of the panel, in its own variable

class _Grid(_Points, Protocol):
    """n nodes along the body, a multiple of 8; the points are the nodes."""

    @property
    def weight(self) -> Buffer: ...  # (n,) [m], of the integral over the body
    @property
    def barycentric(self) -> Buffer: ...  # (n,) weights of the interpolation within the node's panel
    @property
    def series(
        self,
    ) -> Buffer: ...  # (p_max, n) [m], coefficients of Legendre polynomials, whose integrals give rows anywhere

class _Sections(Protocol):
    """Section data at some points, (points,) each; eq. (37) and section 7.2.1."""

    @property
    def mass(self) -> Buffer: ...  # [kg/m], of the body
    @property
    def added2(self) -> Buffer: ...  # [kg/m], added mass along E2
    @property
    def added3(self) -> Buffer: ...  # [kg/m], along E3
    @property
    def inertia1(self) -> Buffer: ...  # [kg m], of body and water about E1
    @property
    def inertia2(self) -> Buffer: ...  # [kg m], about E2
    @property
    def inertia3(self) -> Buffer: ...  # [kg m], about E3
    @property
    def added_roll(self) -> Buffer: ...  # [kg m], of the water about E1
    @property
    def lever(self) -> Buffer: ...  # [kg], m h of the weight, h below the axis
    @property
    def net(self) -> Buffer: ...  # [kg/m], of the displaced water less the body, where bodies weigh
    @property
    def displaced(self) -> Buffer: ...  # [kg/m], of the water that the section displaces
    @property
    def drag2(self) -> Buffer: ...  # [kg/m^2], 1/2 rho_f k2
    @property
    def drag3(self) -> Buffer: ...  # [kg/m^2], 1/2 rho_f k3
    @property
    def drag_roll(self) -> Buffer: ...  # [kg], 1/2 rho_f k4
    @property
    def laminar(self) -> Buffer: ...  # friction force per length = -laminar |V1|^(1/2) V1
    @property
    def turbulent(self) -> Buffer: ...  # friction force per length = -turbulent (Re/8e4)^(4/5) V1
    @property
    def by_critical_speed(self) -> Buffer: ...  # [s/m], Re/8e4 per |V1|

class _Stations(Protocol):
    """M places along the body where profiles are given."""

    @property
    def sections(self) -> _Sections: ...
    @property
    def points(self) -> _Points: ...
    @property
    def nodes_before(self) -> Buffer: ...  # (M,) unsigned 64 bits, how many nodes lie at or before the station
    @property
    def added2_slope(self) -> Buffer: ...  # (M,) [kg/m^2], derivative of added2 by X
    @property
    def added3_slope(self) -> Buffer: ...  # (M,) [kg/m^2]
    @property
    def added_roll_slope(self) -> Buffer: ...  # (M,) [kg]
    @property
    def missed(self) -> Iterable[Buffer]: ...
    # (M, p_max) each, times m: what the rows of `points` miss of the integrals of mass, added2 and 3, lever, net,
    # inertia1 to 3, displaced, drag2 and 3, drag_roll, laminar and turbulent; none where the sections are smooth

class _Shared:
    """Never changes: copies are the object itself."""

    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: dict[int, Any]) -> Self: ...

class Swimmer(_Shared):
    """Body and water on a grid, and which physics is on. It is copied from Python and never changes."""

    def __init__(
        self,
        grid: _Grid,
        sections: _Sections,
        stations: _Stations,
        *,
        friction: str,
        resistive: bool,
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
        servos: list[tuple[float, float, float, float, int]] = ...,
    ) -> None:
        """sections: at the nodes. friction: of `FRICTION_LAWS`. resistive: drag along the body.
        first_watched: first of the speeds (0 V1, 1 V2, 2 V3, 3 Omega1, 4 Re/8e4 - 1) whose changes of sign within a
        panel are integrated exactly; 5 for none. inertia_of_water: the nodes' sections have that of the water.
        tail_water: (3,) added masses [kg/m], [kg m] that are swept off at the tail. flow_gradient: its forces.
        nose_mass: m_o [kg]; nose_drag: 1/2 rho_f k_o [kg/m].
        distributed_pressure: along the body in place of at the tail. offset: the centre of mass is off the axis.
        righting, gravity [m/s^2]: g where `lever` gives a moment of weight, and where `net` gives a force; else 0.
        missed_drag: (K, n) [m] for V2, V3 and Omega1: of each node, what the drag's integral from the start of its
        panel misses, by the drag at the node, at K fractions (1 - cos(pi k / (K - 1))) / 2 of the panel; none where the
        sections are smooth. fins: (node at the end of a panel, normal (3,), centre of pressure (3,) [m], 1/2 rho_f
        area [kg/m], lift slope, 1 / (pi e AR), drag across and along, added mass [kg], servo, sign of its angle by the
        servo's, first station there or behind); servos: (time constant [s],
        limit [rad], roll gain, rate gain [s], node). `ValueError` names what does not fit."""

class Flow(_Shared):
    """How the water moves by itself: the sum of its sources."""

    def __init__(self, sources: list[tuple[Any, ...]]) -> None:
        """Each source is a tuple, in the world's axes and SI units:
        ("ramped", velocity (3,), ramps as those of a law's envelope, whose sum multiplies the velocity; none: 1);
        ("spline", knots (n,), coefficients (n - 1, 4, 3) of cubics from the constant on); ("shear", velocity (3,) far
        to one side, unit normal (3,) of the layer, place of its middle along that, width, whether it is linear);
        ("vortices", rows (n, 3) of x, y and circulation, radius of the cores, drift (3,)); ("wave", amplitude,
        wavenumber, angular frequency, height of the surface, phase, horizontal unit direction (3,)); ("grid",
        axes t, x, y and z, velocities (t, x, y, z, 3)); ("function",
        function(time, rows (n, 18))), which fills in rows as those of `at`. `ValueError` for another kind."""

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

    def __init__(
        self,
        *,
        tolerance: float,
        longest: float,
        smallest: float,
        length: float,
        momentum_floor: float,
        part_of_span: float,
        most_steps: float,
        spare_steps: float,
    ) -> None: ...
    @property
    def tolerance(self) -> float:
        """Relative error of a step."""
    @property
    def longest(self) -> float:
        """[s], of a time step; a fixed method takes all as long, or a little shorter."""
    @property
    def smallest(self) -> float:
        """[s]."""
    @property
    def length(self) -> float:
        """[m], the scale of positions."""
    @property
    def momentum_floor(self) -> float:
        """[kg m/s], below which momentum counts as none."""
    @property
    def part_of_span(self) -> float:
        """Part of the time between two breakpoints that a step may take."""
    @property
    def most_steps(self) -> float:
        """Steps per simulated second."""
    @property
    def spare_steps(self) -> float:
        """Steps beyond these, to be spent at any time."""

class _Modes(Protocol):
    """M modes that bend by themselves, and C coordinates: those of the modes, then motors' behind series springs."""

    @property
    def axis(self) -> Buffer: ...  # (M,) unsigned 64 bits, 0 pitch, 1 yaw
    @property
    def first(self) -> Buffer: ...  # (M,) unsigned 64 bits, first node of the support
    @property
    def last(self) -> Buffer: ...  # (M,) unsigned 64 bits, the node behind its last
    @property
    def continuous(self) -> Buffer: ...  # (M,) unsigned 64 bits, 1 where it is one of several on its support
    @property
    def span(self) -> Buffer: ...  # (M,) integral of the mode's size along the body
    @property
    def moment(self) -> Buffer: ...  # (M,) internal torque for a unit of the mode's force
    @property
    def inertia(self) -> Buffer: ...  # (C,) [kg m^2], armature or rotor
    @property
    def rest(self) -> Buffer: ...  # (C,) where the springs rest
    @property
    def stiffness(self) -> Buffer: ...  # (C, C) of the springs
    @property
    def damping(self) -> Buffer: ...  # (C, C)
    @property
    def servos(
        self,
    ) -> Iterable[tuple[int, float, float, float, float]]: ...  # coordinate, kp, kd, torque limit, speed limit
    @property
    def stops(self) -> Iterable[tuple[int, float, float, float, float]]: ...  # mode, low, high, stiffness, damping
    @property
    def torques(self) -> Iterable[tuple[Any, ...]]: ...
    # coordinate and function(time [s]); or coordinate, knots (k,) [s], cubics (k - 1, 4) from the constant on

class Modes(_Shared):
    """The modes of a robot on a grid. It is copied from Python and never changes."""

    def __init__(self, modes: _Modes) -> None:
        """`ValueError` for arrays that do not fit together."""

class BentMarch:
    """A swimmer with modes on its way: as `March`, where not said otherwise."""

    def __init__(self, swimmer: Swimmer, modes: Modes, planar: bool) -> None:
        """`ValueError` for modes on another grid."""

    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: dict[int, Any]) -> Self: ...
    def change(self, swimmer: Swimmer, modes: Modes, planar: bool) -> None:
        """Goes on in another grid, with the same coordinates at the same rates; a law on the new grid must follow."""

    def follow(
        self,
        law: LawOnGrid,
        reference: Buffer,
        drive: LawOnGrid | None,
        push: Buffer,
        breakpoints: Sequence[float],
        bounds: StepBounds,
        torque_floor: float,
        ledger: bool,
        current: Buffer,
        flow: Flow | None,
        smoothly: bool,
        fin_angles: list[tuple[Buffer, Buffer]] = ...,
    ) -> None:
        """law: of R rows that are imposed and M of the modes. reference (S, R): what the servos follow, by the factors
        of the imposed rows. drive: its factors, by push (C, its rows), are the muscles' forces on the coordinates.
        bounds: an infinite tolerance gives steps of one length. torque_floor [N m]: smaller torques count as none."""

    def start(self, position: Buffer, orientation: Buffer, twist: Buffer, x: Buffer, rate: Buffer) -> float:
        """Stands at time 0 with coordinates x (C,) and their rates (C,) too. All energy [J]."""

    def set_state(self, position: Buffer, orientation: Buffer, twist: Buffer) -> float: ...
    def set_twist(self, twist: Buffer) -> float: ...
    def twist(self) -> list[float]: ...
    def set_slice(self, nodes: int) -> int: ...
    def advance(self, time: float) -> int: ...
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
        """rows (T, size): writable, the coordinates' numbers as `row` has them."""

    def observe(self, whole: Buffer, row: Buffer, wrench: bool, load: bool) -> bool: ...
    def command(self, servo: int, kind: str, value: float) -> None:
        """Have a servo do so from now on. kind: angle [rad], rate [rad/s], torque [N m]; law: what the law asks."""

    def singular_mode(self) -> int | None:
        """The first mode that makes the mass matrix singular in the present state; None where it is definite."""

    @property
    def time(self) -> float: ...
    @property
    def state(self) -> list[float]: ...
    @property
    def memory(self) -> int: ...
    @property
    def hardest(self) -> int:
        """The coordinate with the greatest error in the last step."""
    @property
    def coordinates(self) -> list[float]:
        """(C,)."""
    @property
    def rates(self) -> list[float]:
        """(C,)."""
    @property
    def works(self) -> list[float]: ...
    @property
    def outside(self) -> tuple[float, float, float, float] | None: ...
    @property
    def row(self) -> dict[str, tuple[int, int]]:
        """Where the numbers of an instant lie in a row, from and up to: x, rate, acceleration (C,) each; moment (M,),
        the internal moment on each mode; torque (S,) of the servos; pushing (C,) of muscles and given torques; elastic
        [J], rotors [J], motor_power [W], damping_power [W], damping_work [J]."""
    @property
    def counts(self) -> tuple[int, int, int]: ...

class March:
    """A swimmer on its way. Its law comes first (`follow`), then the start; one thread at a time may call it.

    Python's lock is free while it marches. `RuntimeError` where it follows no law on its grid yet, or another thread is
    in it.
    """

    def __init__(self, swimmer: Swimmer, method: str, order: int, planar: bool) -> None:
        """method: "adams" (orders 1 to 6), "dormand_prince" or "classical". planar: three degrees of freedom."""

    def __copy__(self) -> Self:
        """A march of its own in the same state; it shares the swimmer and the law."""

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        """As `copy.copy`."""

    def change(self, swimmer: Swimmer, method: str, order: int, planar: bool) -> None:
        """Goes on with another grid or method. The state keeps its momentum; a law on the new grid must follow."""

    def follow(
        self,
        law: LawOnGrid,
        breakpoints: Sequence[float],
        bounds: StepBounds,
        ledger: bool,
        current: Buffer,
        flow: Flow | None,
        smoothly: bool,
        fin_angles: list[tuple[Buffer, Buffer]] = ...,
    ) -> None:
        """What drives the body from now on. breakpoints: ascending times [s] at which a derivative of the shape or of
        the flow jumps. ledger: the works are integrated too. current (3,) [m/s]: of the water, world. flow: how the
        water moves besides. smoothly: the motion goes on as
        before, so that the next step need not begin anew. fin_angles: what each
        servo is given, knots (n,) [s] and coefficients (n - 1, 4) of cubics [rad]. `ValueError` for a law on another
        grid."""

    def start(self, position: Buffer, orientation: Buffer, twist: Buffer) -> float:
        """Stands at time 0 at a position (3,) [m] with an orientation (4,) (x y z w, world from head) and the head's
        twist (6,). The kinetic and potential energy [J]."""

    def set_state(self, position: Buffer, orientation: Buffer, twist: Buffer) -> float:
        """Puts the head of the present shape at a position (3,) [m] with an orientation (4,) (x y z w, world from head)
        and its twist (6,). The kinetic and potential energy [J]."""

    def set_twist(self, twist: Buffer) -> float:
        """Gives the present state the momentum of the twist (6,). The kinetic and potential energy [J]."""

    def twist(self) -> list[float]:
        """Twist (6,) in the present state. `ValueError` where the inertia is not positive definite."""

    def set_slice(self, nodes: int) -> int:
        """Sets how many nodes are evaluated before a march comes back unfinished; what it was."""

    def advance(self, time: float) -> int:
        """Marches to a time [s]; the number of a status. "unfinished" comes at the end of a step, when a slice has been
        evaluated: call again. At the others but "marched" the state stays the last good one."""

    def record(
        self, times: Buffer, first: int, whole: Buffer, works: Buffer, wrench: bool, load: bool, until: float
    ) -> tuple[int, int]:
        """Marches through the times (T,) [s] from number `first` on, up to `until` [s], and observes each. whole:
        writable, as `layout` has it; works (T, 5) [J]: writable, of actuators, wake, nose, drag and flow since the
        start. How many of the instants are complete, and the number of a status; as in `advance`."""

    def observe(self, whole: Buffer, wrench: bool, load: bool) -> bool:
        """Writes what the present shows into `whole`, as `layout` has it for one sample. False where the inertia is not
        positive definite."""

    @property
    def memory(self) -> int:
        """Bytes that an evaluation reads and writes."""
    @property
    def time(self) -> float:
        """[s]."""
    @property
    def state(self) -> list[float]:
        """(13,)."""
    @property
    def works(self) -> list[float]:
        """(5,) [J] of actuators, wake, nose, drag and flow since the start."""
    @property
    def outside(self) -> tuple[float, float, float, float] | None:
        """Time [s] and place [m], world, outside the grid of the flow, where the last evaluation was there."""
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

    def present(self, index: int) -> tuple[float, list[float], tuple[int, int, int]]:
        """Time [s], works and counts of a swimmer, as of `March`."""

class PlanarInstant:
    """Single instants of a motion in the plane: three degrees of freedom (yaw, along, across)."""

    def __init__(self, swimmer: Swimmer) -> None: ...
    def rate(
        self, law: LawOnGrid, current: Buffer, time: float, state: Buffer, flow: Flow | None = None
    ) -> list[float] | None:
        """Rate (13,) of a state (13,) at a time [s], in a current (3,) [m/s], world. None where the inertia is not
        positive definite."""

    def repeat_rate(self, law: LawOnGrid, time: float, state: Buffer, count: int, flow: Flow | None = None) -> None:
        """Finds the rate of a state (13,) `count` times, with no current, without Python's lock: for benchmarks."""

    def powers(self, law: LawOnGrid) -> list[float]:
        """Powers (5,) [W] of actuators, wake, nose, drag and flow in the motion whose rate was found last."""

    def inertia(self, law: LawOnGrid, time: float) -> list[list[float]]:
        """Inertia (3, 3) of body, water and nose about the head, in the paper's axes, rotation first, as the law bends
        the body at a time [s]."""

class Instant:
    """Single instants of a motion in space."""

    def __init__(self, swimmer: Swimmer) -> None: ...
    def rate(
        self, law: LawOnGrid, current: Buffer, time: float, state: Buffer, flow: Flow | None = None
    ) -> list[float] | None:
        """As in `PlanarInstant`."""

    def repeat_rate(self, law: LawOnGrid, time: float, state: Buffer, count: int, flow: Flow | None = None) -> None:
        """As in `PlanarInstant`."""

    def powers(self, law: LawOnGrid) -> list[float]:
        """As in `PlanarInstant`."""

    def inertia(self, law: LawOnGrid, time: float) -> list[list[float]]:
        """As in `PlanarInstant`, (6, 6)."""

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
    ) -> None:
        """Writes powers (T, 4) [W] on the body: of the axial friction, the lateral, the vertical and the roll drag.

        times (T,) [s]; twists (T, 6) of the head; current and flow as in `March.follow`; poses (T, 7) of the head:
        position [m] and orientation.
        """

    def momentum_rate(self, law: LawOnGrid, time: float, twist: Buffer, acceleration: Buffer) -> list[float]:
        """Rate (6,) of the momentum along the body, [N m, N] about the head in its axes, for a twist (6,) and a true
        acceleration (6,) [rad/s^2, m/s^2] of the head, its axes."""
