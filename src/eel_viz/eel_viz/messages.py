# SPDX-License-Identifier: Apache-2.0
"""The content of the swimmer's messages as arrays, with the frames and units of the messages."""

from dataclasses import dataclass, field

import numpy as np

AT_LIMIT = 1.0 - 1e-9  # of a motor's greatest torque: above this it counts as at its limit


class BadMessage(ValueError):
    """A message that cannot be shown; `field` is the faulty field, so that each fault is reported once."""

    def __init__(self, field: str, problem: str) -> None:
        super().__init__(f"{field} {problem}")
        self.field = field


@dataclass(frozen=True, kw_only=True, slots=True)
class Pose:
    """`position` (3,) [m] and `orientation` (4,), x y z w, in the world frame."""

    position: np.ndarray
    orientation: np.ndarray


@dataclass(frozen=True, kw_only=True, slots=True)
class Twist:
    """`linear` (3,) [m/s] and `angular` (3,) [rad/s] in base_link."""

    linear: np.ndarray
    angular: np.ndarray


@dataclass(frozen=True, kw_only=True, slots=True)
class Fin:
    """A plate with its root on the body's side at X = `station` [m]; `side` along section axis 2: 1 right, -1 left.

    `area` [m^2], `span` [m], `dihedral` [rad].
    """

    name: str
    station: float
    side: int
    area: float
    span: float
    dihedral: float


@dataclass(frozen=True, kw_only=True, slots=True)
class Joint:
    """A joint at X = `station` [m] that bends about the section's `axis`, 2 or 3."""

    name: str
    station: float
    axis: int


@dataclass(frozen=True, kw_only=True, slots=True)
class Body:
    """`length` [m], `mass` [kg], half axes [m] (B,) at `x` [m] (B,), and fins, joints, appendages.

    appendages (A, 4): X, offsets along section axes 2 and 3 [m], drag area [m^2].
    """

    length: float
    mass: float
    x: np.ndarray
    half_width: np.ndarray
    half_height: np.ndarray
    fins: tuple[Fin, ...] = ()
    joints: tuple[Joint, ...] = ()
    appendages: np.ndarray = field(default_factory=lambda: np.zeros((0, 4)))


@dataclass(frozen=True, kw_only=True, slots=True)
class Backbone:
    """`position` (M, 3) [m] and `orientation` (M, 4) in the world frame at stations `x` (M,) [m]."""

    x: np.ndarray
    position: np.ndarray
    orientation: np.ndarray


@dataclass(frozen=True, kw_only=True, slots=True)
class Profiles:
    """Named profiles in section axes, each (M,), at stations `x` (M,) [m], with the message's names and units."""

    x: np.ndarray
    values: dict[str, np.ndarray]

    def together(self, *names: str) -> np.ndarray:
        """The profiles `names` side by side, (M, len(names))."""
        return np.array([self.values[name] for name in names]).T


@dataclass(frozen=True, kw_only=True, slots=True)
class Load:
    """The fluid's load: `profiles` [N/m], and the forces at `tail` and `nose`, (3,) [N], all in section axes.

    `wake` (3,) [N]: momentum per time that the tail gives to the wake, in the tail's axes; None in an older bag.
    `fins` (3 F,) [N]: the forces on F fins, in the axes of their sections.
    """

    profiles: Profiles
    tail: np.ndarray
    nose: np.ndarray
    wake: np.ndarray | None = None
    fins: np.ndarray = field(default_factory=lambda: np.zeros(0))


@dataclass(frozen=True, kw_only=True, slots=True)
class JointStates:
    """Angles (n,) [rad] by `names`; rates [rad/s] and torques [N m] if known, else None."""

    names: tuple[str, ...]
    angle: np.ndarray
    rate: np.ndarray | None
    torque: np.ndarray | None

    def angles_of(self, names: tuple[str, ...]) -> np.ndarray:
        """The angles [rad] of the joints `names`, which must exist."""
        angles = dict(zip(self.names, self.angle.tolist(), strict=True))
        return np.array([angles[name] for name in names])


@dataclass(frozen=True, kw_only=True, slots=True)
class Motors:
    """Torque, greatest torque at the present speed (infinite without a limit) [N m], and power [W] of J motors.

    names: of their joints; of an older bag none.
    """

    names: tuple[str, ...] = ()
    torque: np.ndarray
    limit: np.ndarray
    power: np.ndarray

    @property
    def loads(self) -> np.ndarray:
        """The load (J,) of each motor: torque / greatest torque, 0 to 1; NaN for motors without a limit."""
        torque, limited = np.abs(self.torque), np.isfinite(self.limit)
        none = np.where(limited, (torque > 0.0).astype(float), np.nan)  # at a speed without any torque left
        return np.asarray(np.divide(torque, self.limit, out=none, where=limited & (self.limit > 0.0)))


@dataclass(frozen=True, kw_only=True, slots=True)
class Status:
    """One status of a DiagnosticArray: `level` 0 OK, 1 WARN, 2 ERROR, 3 STALE."""

    name: str
    level: int
    message: str
    values: dict[str, str]


WRENCH_FIELDS = ("torque_1", "torque_2", "torque_3", "force_1", "force_2", "force_3")
CURVATURE_FIELDS = ("pitch", "pitch_rate", "yaw", "yaw_rate")
LOAD_FIELDS = ("force_1", "force_2", "force_3", "resistive_1", "resistive_2", "resistive_3")


def same(x: np.ndarray, other: np.ndarray) -> bool:
    """Whether two arrays of stations, (M,) [m], are equal; fast if they are the same object."""
    return x is other or np.array_equal(x, other)
