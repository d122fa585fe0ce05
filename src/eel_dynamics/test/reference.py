# SPDX-License-Identifier: Apache-2.0
"""The swimmer's mechanics a second time, slow and plain: the independent check of the package's kernel.

It starts from the kinetic energy of body and fluid (eqs 16, 36 of Boyer, Porez & Leroyer 2010),

    T(K, dK/dt, mu) = 1/2 integral eta . (J_b + J_f) eta dX,        eta(X) = twist of the section X, mu = eta(0),

(that of the body with the velocity of its centre of mass, h below the axis, where `offset` gives one)

and never writes an acceleration field. The momentum of the whole is dT/dmu and its matrix d2T/dmu2, both by
polarisation (exact, as T is quadratic in mu); time derivatives are complex steps along the motion
(K + i h dK/dt, ...). The head's acceleration is eq. (60); the internal wrench is eq. (50) integrated in the strong
form from the nose to the tail, so that the tail's boundary condition (51) is left over as a check.

Water that moves by itself is a function u(x, t), `flow`. The energy of the fluid is that of the motion through it, so
momentum and the force - grad u . p follow from T, by complex steps of place and time; only the force of the undisturbed
pressure, rho_f A Du/Dt, is added.

Fins are point forces on their sections, `fins`: of each the `Fin` of the library, for its numbers, and its angle as a
function of time. The force of their added mass takes the true acceleration, a complex step of the velocity.

A body may have a `hull`, numbers in place of those of `HULL`, by the names of the library's `Body`: coefficients as
numbers, as functions of X, or by the roundness s of the section, s = min(a, b) / max(a, b):

    k = 2 max(a, b) (1.98 - 0.78 s) broadside, 2 min(a, b) (1.0 + 0.2 s) along the long axis
    M_f times 1 - (1 - C_a) s^2 on both axes;  n_1 = -1/2 rho_f k5 |V| V1 of the links, k5 = c_s pi a b / p

Wrenches from outside, `wrenches`, do virtual work on the twist of their section: their generalised forces are the
derivatives of that power.

The base of the tail, -1/2 rho_f c_b A(l) V1|V1| at X = l, and the appendages are point forces by their velocity.

Frames: the axes of the head at the instant, about the head, unless a name says `section` or `world`. Velocities are
relative to the water. Arrays over X have shape (N, 3). Semi-axes as in the paper: `a` along E3, `b` along E2.
"""

import itertools
from types import SimpleNamespace

import numpy as np
from reference_space import Space
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

STEP = 1e-30  # of the complex steps
PARTS = ("real", 1.0), ("imag", 1j)
GRAVITY = 9.80665  # m/s^2
E1 = np.array([1.0, 0.0, 0.0])
BY_SHAPE = "by shape"
HULL = {
    "roll_drag": 1.0,
    "lateral_drag": 1.98,
    "vertical_drag": 1.0,
    "friction_factor": 1.0,
    "lateral_added_mass": 1.0,
    "round_added_mass": 1.0,
    "joint_drag": 0.0,
    "link_length": 1.0,
    "base_drag": 0.0,
    "nose_added_mass": 0.32,
    "nose_drag": 0.036,
    "appendages": (),
}


def scene(**changes):
    """The switches with their defaults; any object with these attributes does."""
    defaults = {
        "reactive": True,
        "wake": True,
        "resistive": True,
        "friction": "printed",
        "nose": True,
        "perimeter": "ellipse",
        "added_mass": "corrected",
        "tail_pressure": "lumped",
        "metacentric_height": 0.0,
        "weight": False,
        "current": (0.0, 0.0, 0.0),
        "density": None,
        "fluid_density": 1000.0,
        "viscosity": 1e-6,
    }
    return SimpleNamespace(**{**defaults, **changes})


def boyer_body():
    """The robot of section 7.2.1."""

    def cap(x):  # radius of the cylinder and of the half-ellipsoid that covers it
        return np.where(x < 0.05, np.sqrt(np.maximum(x * (0.1 - x), 0.0)), 0.05)

    def width_factor(x):
        return -(np.sin(np.pi * x - np.pi / 2) + 1) / 6 - x**2 / 8 + 0.5

    def height_factor(x):
        middle = 1 - (np.sin(np.pi * (20 * x - 4) / 11 - np.pi / 2) + 1) / 5
        return np.where(x < 0.2, 1.0, np.where(x < 0.75, middle, 0.6))

    return SimpleNamespace(
        half_width=lambda x: cap(x) * width_factor(x),
        half_height=lambda x: cap(x) * height_factor(x),
        kinks=(0.0, 0.05, 0.2, 0.75, 1.0),
        nose=(0.025, 0.05, 0.05),
        density=1000.0,
    )


class Reference:
    """One body in one scene. `motion` below is (K, dK/dt, d2K/dt2, mu): curvature fields (N, 3) and head twist (6,)."""

    def __init__(self, body, settings=None, splits=(), **space):
        self.body, self.scene = body, settings or scene()
        settings = self.scene
        self.hull = hull = SimpleNamespace(**HULL | getattr(body, "hull", {}))
        places = {each.x for each in hull.appendages if 0.0 < each.x < body.kinks[-1]}
        if BY_SHAPE in (hull.lateral_drag, hull.vertical_drag) or hull.round_added_mass != 1.0:
            places |= set(_roots(lambda x: body.half_height(x) - body.half_width(x), body.kinks))
        self.space = Space(sorted({*body.kinks, *splits, *places}), **space)  # `splits`: kinks of the law
        self.length, self.up = body.kinks[-1], np.array([0.0, 0.0, 1.0])  # up in the axes of the head: set it anew
        at_tail = np.array([self.length])
        self.a, self.b = body.half_height(self.space.x), body.half_width(self.space.x)
        density = body.density if settings.density is None else settings.density
        self.water = settings.fluid_density
        area = np.pi * self.a * self.b
        J2, J3 = self.a**2 / 4, self.b**2 / 4
        mass = getattr(body, "mass", lambda x: density * area)(self.space.x)  # kg/m
        unit = np.ones_like(mass)
        # diagonal of J_b, (N, 6), about the centre of mass, which lies h below the axis
        self.inertia_body = mass[:, None] * np.stack([J2 + J3, J2, J3, unit, unit, unit], axis=1)
        self.offset = getattr(body, "offset", lambda x: 0 * x)(self.space.x)  # m
        self.inertia_fluid = self._added(self.space.x)
        self.tail_added = self._added(at_tail)[0]
        nose = np.prod(body.nose), body.nose[0] * body.nose[1]
        self.nose_mass = self.water * np.pi * hull.nose_added_mass * nose[0] * (settings.reactive and settings.nose)
        self.displaced = self.water * area  # kg/m
        self.net = (self.displaced - mass) * settings.weight  # kg/m
        self.height = 0.0  # m, of the head
        self.fins = ()  # (fin, angle [rad] of a time [s])
        self.wrenches = ()  # (X [m], whether in axes of the world, torque and force (6,) of a time [s])
        self.flow = None  # u (N, 3) [m/s] of places (N, 3) [m] and a time [s], world; both may be complex
        self.pose = SimpleNamespace(position=np.zeros(3), axes=np.eye(3), time=0.0)  # of the head in the world
        base = np.pi * float(body.half_height(at_tail)[0] * body.half_width(at_tail)[0]) * hull.base_drag  # m^2
        none = {"y": 0.0, "z": 0.0, "drag2": 0.0, "drag3": 0.0}
        self.points = SimpleNamespace(x=self.length, drag1=base, law="axis", **none), *hull.appendages
        self.nose_drag = np.pi * hull.nose_drag * nose[1] * (settings.resistive and settings.nose)

    def _added(self, x):
        """Diagonal of J_f at x, eq. (37): the semi-axis across the motion counts (as printed: the one along it)."""
        a, b = self.body.half_height(x), self.body.half_width(x)
        lateral, vertical = (a, b) if self.scene.added_mass == "corrected" else (b, a)
        zero = np.zeros_like(a)
        left = 1 - (1 - self.hull.round_added_mass) * roundness(a, b) ** 2  # by flow that separates
        sideways = left * _along(self.hull.lateral_added_mass, x)
        columns = (a**2 - b**2) ** 2 / 8, zero, zero, zero, sideways * lateral**2, left * vertical**2
        return self.scene.reactive * self.water * np.pi * np.stack(columns, axis=1)

    # -- kinematics -------------------------------------------------------------------------------------------------
    def configuration(self, K):
        """Rotations (N, 3, 3) and positions (N, 3): R' = R hat(K) by Picard's iteration, r' = R E1, eq. (25)."""
        hat = _hat(K)
        R = increment = np.broadcast_to(np.eye(3), hat.shape)
        for _ in range(200):
            increment = self.space.cumulate(increment @ hat)
            R = R + increment
            if np.max(np.abs(increment)) < 1e-20:
                break
        return R, self.space.cumulate(R[:, :, 0])

    def shape_velocity(self, R, K_rate):
        """Angular and linear velocities (N, 3) of the sections while the head is held."""
        omega = self.space.cumulate(np.einsum("xij,xj->xi", R, K_rate))
        return omega, self.space.cumulate(np.cross(omega, R[:, :, 0]))

    def twists(self, K, K_rate, mu):
        """Section twists eta(X), (..., N, 6), for head twists mu (..., 6)."""
        (R, r), mu = self.configuration(K), np.asarray(mu)
        omega, velocity = self.shape_velocity(R, K_rate)
        turn, push = mu[..., None, :3], mu[..., None, 3:]
        fields = omega + turn, velocity + push + np.cross(turn, r)
        return np.concatenate([np.einsum("xji,...xj->...xi", R, field) for field in fields], axis=-1)

    # -- water that moves by itself ---------------------------------------------------------------------------------
    def flow_at(self, r):
        """u (N, 3) at places r (N, 3), about the head; in its axes."""
        pose = self.pose
        return self.flow(pose.position + r @ pose.axes.T, pose.time) @ pose.axes

    def flow_jacobian(self, r):
        """du_i/dx_j (N, 3, 3), likewise."""
        return np.stack([self.flow_at(r + 1j * STEP * axis).imag / STEP for axis in np.eye(3)], axis=-1)

    def flow_acceleration(self, r):
        """Du/Dt (N, 3), likewise: along the water's own way."""
        pose, step = self.pose, 1j * STEP
        x = pose.position + r @ pose.axes.T
        return self.flow(x + step * self.flow(x, pose.time), pose.time + step).imag / STEP @ pose.axes

    def moved(self, twist, time=0.0):
        """Has the head's pose moved by a `twist` (6,) in its axes and a `time`, to first order; the former pose."""
        pose = self.pose
        axes = pose.axes @ (np.eye(3) + _hat(np.asarray(twist)[None, :3])[0])
        position = pose.position + pose.axes @ np.asarray(twist)[3:]
        self.pose = SimpleNamespace(position=position, axes=axes, time=pose.time + time)
        return pose

    def through_water(self, eta, R, r, turning=False):
        """Section twists (..., N, 6) through the water; `turning`: Omega1 less half its curl, as drag sees it."""
        if self.flow is None:
            return eta
        U = np.zeros((len(r), 6), dtype=complex if np.iscomplexobj(self.flow_at(r) + R[:, 0]) else float)
        U[:, 3:] = np.einsum("xji,xj->xi", R, self.flow_at(r))
        if turning:
            g = self.flow_jacobian(r)
            curl = np.stack([g[:, 2, 1] - g[:, 1, 2], g[:, 0, 2] - g[:, 2, 0], g[:, 1, 0] - g[:, 0, 1]], axis=1)
            U[:, 0] = 0.5 * np.sum(R[:, :, 0] * curl, axis=1)
        return eta - U

    def flow_force(self, K, K_rate, mu):
        """What the flow adds to the balance of the head, (6,): dT/d(pose), and the undisturbed pressure."""
        _, r = self.configuration(K)
        force = self.displaced[:, None] * self.flow_acceleration(r)
        wrench = self.space.weights @ np.concatenate([np.cross(r, force), force], axis=1)
        for component, unit in enumerate(np.eye(6)):
            pose = self.moved(1j * STEP * unit)
            wrench[component] += sum(self.energies(K, K_rate, mu)).imag / STEP
            self.pose = pose
        return wrench

    def of_mass(self, eta):
        """Twists (..., N, 6) of the sections at their centres of mass, V + Omega x e, from those at their centres."""
        e = -self.offset[:, None] * np.array([0.0, 0.0, 1.0])
        return np.concatenate([eta[..., :3], eta[..., 3:] + np.cross(eta[..., :3], e)], axis=-1)

    # -- fins -------------------------------------------------------------------------------------------------------
    def fin_velocity(self, fin, K, K_rate, mu):
        """Place (3,) about the head and velocity (3,) of the centre of pressure, and the section's axes (3, 3)."""
        R, r = self.configuration(K)
        omega, velocity = self.shape_velocity(R, K_rate)
        fields = R.reshape(-1, 9), r, omega, velocity
        at = [sum(unit * self.space.evaluate(getattr(f, name), fin.station)[0] for name, unit in PARTS) for f in fields]
        span = np.sqrt(fin.aspect_ratio * fin.area / 2)
        arm = at[0].reshape(3, 3) @ (fin.root(self.body) + 4 * span / (3 * np.pi) * fin.axis)
        place = at[1] + arm
        spin = at[2] + mu[:3]
        return place, at[3] + mu[3:] + np.cross(mu[:3], at[1]) + np.cross(spin, arm), at[0].reshape(3, 3)

    def fin_forces(self, K, K_rate, K_acceleration, mu, mu_rate):
        """Of each fin: place, velocity (3,), section's axes (3, 3), and the force (3,) of the water on it."""
        found, step = [], 1j * STEP
        for fin, angle in self.fins:
            place, v, R = self.fin_velocity(fin, K, K_rate, mu)
            place, v, R = place.real, v.real, R.real
            moved = self.fin_velocity(fin, K + step * K_rate, K_rate + step * K_acceleration, mu + step * mu_rate)[1]
            a = moved.imag / STEP + np.cross(mu[:3], v)
            s, c = np.sin(angle(self.pose.time)), np.cos(angle(self.pose.time))
            e_n, e_c = R @ (c * fin.normal + s * E1), R @ (s * fin.normal - c * E1)
            w = v if self.flow is None else v - self.flow_at(place[None])[0]
            a_u = 0 * v if self.flow is None else self.flow_acceleration(place[None])[0]
            chord = fin.area / np.sqrt(fin.aspect_ratio * fin.area / 2)
            added = self.scene.reactive * self.water * np.pi / 4 * chord * fin.area
            found.append(
                (place, v, R, fin_steady(fin, self.water, w @ e_n, w @ e_c, e_n, e_c) - added * e_n * (e_n @ (a - a_u)))
            )
        return found

    def fin_wrench(self, *motion):
        """Wrench (6,) of all fins about the head."""
        sums = [np.concatenate([np.cross(place, force), force]) for place, _, _, force in self.fin_forces(*motion)]
        return np.sum(sums, axis=0) if sums else np.zeros(6)

    # -- appendages, and the base of the tail -----------------------------------------------------------------------
    def point_forces(self, K, K_rate, mu):
        """Of the base and of each appendage: arm from its section's centre, place about the head, velocity over ground,
        force of the water, (3,) each, and the section's axes (3, 3)."""
        R, r = self.configuration(K)
        fields, found = (R.reshape(-1, 9), r, *self.shape_velocity(R, K_rate)), []
        for point in self.points:
            axes, centre, spin, v = (self.space.evaluate(field, point.x)[0] for field in fields)
            axes, spin, v = axes.reshape(3, 3), spin + mu[:3], v + mu[3:] + np.cross(mu[:3], centre)
            arm = axes @ [0.0, point.y, point.z]
            water = np.zeros(3) if self.flow is None else self.flow_at(centre[None])[0]
            w = axes.T @ (v - water + np.cross(spin, arm))
            speed = np.abs(w) if point.law == "axis" else np.sqrt(w @ w)
            areas = self.scene.resistive * np.array([point.drag1, point.drag2, point.drag3])
            force = axes @ (-0.5 * self.water * areas * speed * w)
            found.append(
                SimpleNamespace(
                    x=point.x, arm=arm, place=centre + arm, velocity=v + np.cross(spin, arm), force=force, axes=axes
                )
            )
        return found

    # -- wrenches from outside --------------------------------------------------------------------------------------
    def external_wrenches(self, K):
        """Of each wrench its X and its torque and force (6,), axes of its section."""
        R, _ = self.configuration(K)
        found = []
        for x, in_world, given in self.wrenches:
            own = np.reshape(given(self.pose.time), (2, 3))
            if in_world:
                own = own @ self.pose.axes @ self.space.evaluate(R.reshape(-1, 9), x)[0].reshape(3, 3)
            found.append((x, own.ravel()))
        return found

    def external_power(self, K, K_rate, mu):
        """Their power (W) on the twists of their sections, which are linear in K_rate and mu."""
        eta = self.twists(K, K_rate, np.asarray(mu, float))
        return sum(self.space.evaluate(eta, x)[0] @ own for x, own in self.external_wrenches(K))

    # -- energy, momentum, balance ----------------------------------------------------------------------------------
    def energies(self, K, K_rate, mu):
        """Kinetic energy of body and of fluid, eqs (16), (36), for each head twist of mu (..., 6)."""
        eta, (R, r) = self.twists(K, K_rate, mu), self.configuration(K)
        twists = self.of_mass(eta), self.through_water(eta, R, r)
        return tuple(
            np.einsum("x,xk,...xk->...", self.space.weights / 2, inertia, each**2)
            for inertia, each in zip((self.inertia_body, self.inertia_fluid), twists, strict=True)
        )

    def momentum(self, K, K_rate, mu, part=slice(None)):
        """dT/dmu = (L, P), (6,), of body and fluid, or of one; exact central differences of a quadratic form."""
        shifted = np.concatenate([mu + np.eye(6), mu - np.eye(6)])
        energy = sum(self.energies(K, K_rate, shifted)[part])
        return (energy[:6] - energy[6:]) / 2

    def momentum_rate(self, K, K_rate, K_acceleration, mu, mu_rate, part=slice(None)):
        """Time derivative of the momentum in axes that rest, about a point that rests and coincides with the head."""
        step = 1j * STEP
        L, P = np.split(self.momentum(K, K_rate, mu, part), 2)
        pose = self.moved(step * mu, step)
        moved = self.momentum(K + step * K_rate, K_rate + step * K_acceleration, mu + step * mu_rate, part)
        self.pose = pose
        return moved.imag / STEP + np.concatenate([np.cross(mu[:3], L) + np.cross(mu[3:], P), np.cross(mu[:3], P)])

    def mass_matrix(self, K):
        """d2T/dmu2 (6, 6) by polarisation, without the nose's added mass."""
        rest, basis = np.zeros_like(K), np.eye(6)
        flow, self.flow = self.flow, None  # it adds terms that are linear
        pairs = sum(self.energies(K, rest, (basis[:, None] + basis[None, :]).reshape(36, 6))).reshape(6, 6)
        single = sum(self.energies(K, rest, basis))
        self.flow = flow
        return pairs - single[:, None] - single[None, :]

    def tail_wrench(self, R, r, eta):
        """What the tail gives to the wake, right-hand side of eq. (60): wrench about the head; and T_f at the tail."""
        shed = self.scene.wake * self.tail_added
        energy = shed @ eta**2 / 2
        section = eta[3] * shed * eta - energy * np.concatenate([np.zeros(3), E1])
        torque, force = R @ section[:3], R @ section[3:]
        return np.concatenate([torque + np.cross(r, force), force]), energy

    def resistive(self, eta, x=None):
        """Resistive torque and force per length (N, 3), section axes, of section 7.2.1; at the nodes or at `x`."""
        x, settings = self.space.x if x is None else x, self.scene
        a, b = self.body.half_height(x), self.body.half_width(x)
        perimeter = np.pi * (1.5 * (a + b) - np.sqrt(a * b)) * (0.5 if settings.perimeter == "printed" else 1.0)
        square = eta * np.abs(eta)
        if settings.friction == "taylor":  # c_f by the squares of the plate's and the oblique cylinder's
            ahead, across = np.abs(eta[:, 3]), np.hypot(eta[:, 4], eta[:, 5])
            rub = (0.664 * perimeter) ** 2 * settings.viscosity / x * ahead
            rub += 5.4**2 * settings.viscosity * perimeter / np.pi * across
            friction = np.sqrt(rub) / (perimeter * np.maximum(ahead, 1e-300))
        else:
            friction = skin_friction(np.abs(eta[:, 3]) * x / settings.viscosity, settings.friction)
        factors = -0.5 * self.water * settings.resistive
        hull, shape = self.hull, cross_flow_by_shape(a, b)
        roll = hull.roll_drag * np.pi * (a**2 - b**2) ** 2 * square[:, 0]
        k2, k3 = (
            of_shape if given == BY_SHAPE else 2 * _along(given, x) * half
            for of_shape, given, half in zip(shape, (hull.lateral_drag, hull.vertical_drag), (a, b), strict=True)
        )
        forces = np.stack([hull.friction_factor * friction * perimeter, k2, k3], axis=1) * square[:, 3:]
        links = hull.joint_drag * np.pi * a * b / hull.link_length * np.linalg.norm(eta[:, 3:], axis=1) * eta[:, 3]
        return factors * np.outer(roll, E1), factors * (forces + np.outer(links, E1))

    def potential_density(self, R, r):
        """Potential energy (N,) [J/m] of weight and buoyancy: the weight hangs below each section's axis."""
        hung = self.scene.metacentric_height + self.offset * self.scene.weight
        weight = GRAVITY * hung * self.inertia_body[:, 3]
        return weight * (1.0 - R[:, :, 2] @ self.up) - GRAVITY * self.net * (self.height + r @ self.up)

    def weight(self, R, r):
        """Torque about the section and force (N, 3) per length of weight and buoyancy: how the potential falls as each
        section turns and moves."""
        step = 1j * STEP
        turned = [self.potential_density((np.eye(3) + step * _hat(axis[None])[0]) @ R, r) for axis in np.eye(3)]
        moved = [self.potential_density(R, r + step * axis) for axis in np.eye(3)]
        return tuple(-np.stack(rows, axis=1).imag / STEP for rows in (turned, moved))

    def nose_force(self, mu, mu_rate):
        """Axial force (N) on the nose: added mass times the true acceleration, and pressure drag."""
        acceleration, speed = mu_rate[3] + np.cross(mu[:3], mu[3:])[0], mu[3]
        if self.flow is not None:
            nose = np.zeros((1, 3))
            acceleration -= self.flow_acceleration(nose)[0, 0]
            speed -= self.flow_at(nose)[0, 0]
        return -self.nose_mass * acceleration - 0.5 * self.water * self.nose_drag * speed * abs(speed)

    def loads(self, K, K_rate, mu):
        """Everything on the right of eq. (60) but the nose: wrench (6,) about the head."""
        R, r = self.configuration(K)
        eta = self.twists(K, K_rate, mu)
        drag = self.resistive(self.through_water(eta, R, r, turning=True))
        torque, force = (np.einsum("xij,xj->xi", R, load) for load in drag)
        resistive = self.space.weights @ np.concatenate([torque + np.cross(r, force), force], axis=1)
        ends = (self.at_tail(field) for field in (R.reshape(-1, 9), r, self.through_water(eta, R, r)))
        tail_R, tail_r, tail_eta = ends
        for point in self.point_forces(K, K_rate, mu):
            resistive = resistive + np.concatenate([np.cross(point.place, point.force), point.force])
        return resistive + self.tail_wrench(tail_R.reshape(3, 3), tail_r, tail_eta)[0]

    def at_tail(self, field):
        return self.space.evaluate(field, self.length)[0]

    def acceleration(self, K, K_rate, K_acceleration, mu):
        """Rate of the head's twist (6,): eq. (60), in which the unknown enters linearly."""
        matrix, load = self.mass_matrix(K), self.loads(K, K_rate, mu)
        still = np.zeros(6)
        matrix[3, 3] += self.nose_mass
        load[3] += self.nose_force(mu, still)
        R, r = self.configuration(K)
        torque, force = self.weight(R, r)
        load += self.space.weights @ np.concatenate([torque + np.cross(r, force), force], axis=1)
        if self.flow is not None:
            load += self.flow_force(K, K_rate, mu)
        if self.wrenches:
            load += [self.external_power(K, 0 * K, unit) for unit in np.eye(6)]
        if self.fins:
            by_rate = [self.fin_wrench(K, K_rate, K_acceleration, mu, unit) for unit in (still, *np.eye(6))]
            load += by_rate[0]
            matrix -= np.stack(by_rate[1:], axis=1) - by_rate[0][:, None]
        return np.linalg.solve(matrix, load - self.momentum_rate(K, K_rate, K_acceleration, mu, still))

    def fluid_wrench(self, K, K_rate, K_acceleration, mu, mu_rate):
        """All of the fluid's action on the body (6,), about the head: eq. (61), resistive loads and nose."""
        wrench = self.loads(K, K_rate, mu)
        wrench[3] += self.nose_force(mu, mu_rate)
        return wrench - self.momentum_rate(K, K_rate, K_acceleration, mu, mu_rate, slice(1, 2))

    # -- internal wrench: strong form (50), from the nose to the tail ------------------------------------------------
    def fields(self, K, K_rate, K_acceleration, mu, mu_rate):
        """Internal torque and force, loads, energies, at the nodes; and what is left of the tail's condition (51)."""

        def density(K, K_rate, mu, turn):  # of sigma_b, p_b, sigma_f, p_f in resting axes, (4, N, 3)
            (R, r), eta = self.configuration(K), self.twists(K, K_rate, mu)
            of_fluid = self.inertia_fluid * self.through_water(eta, R, r)
            of_body = self.inertia_body * self.of_mass(eta)
            e = -self.offset[:, None] * np.array([0.0, 0.0, 1.0])
            of_body[:, :3] += np.cross(e, of_body[:, 3:])  # about the section's centre
            kinetic = np.concatenate([of_body, of_fluid], axis=1).reshape(-1, 4, 3)
            return np.einsum("xij,xpj->pxi", turn @ R, kinetic)

        step, integrate = 1j * STEP, self.space.cumulate
        _sigma_b, p_b, sigma_f, p_f = density(K, K_rate, mu, np.eye(3))
        pose = self.moved(step * mu, step)
        rates = (
            density(
                K + step * K_rate,
                K_rate + step * K_acceleration,
                mu + step * mu_rate,
                np.eye(3) + step * _hat(mu[None, :3])[0],
            ).imag
            / STEP
        )
        self.pose = pose
        (R, r), true = self.configuration(K), self.twists(K, K_rate, mu)
        eta, water_force = self.through_water(true, R, r), np.zeros_like(r)
        if self.flow is not None:
            water_force = self.displaced[:, None] * self.flow_acceleration(r)
            water_force -= np.einsum("xji,xj->xi", self.flow_jacobian(r), p_f)
        to_axes, to_section = (lambda f: np.einsum("xij,xj->xi", R, f)), (lambda f: np.einsum("xji,xj->xi", R, f))
        resistive_torque, resistive_force = self.resistive(self.through_water(true, R, r, turning=True))
        wake = float(self.scene.wake)  # 0: no water is swept past the sections
        t1, V1, energy = R[:, :, 0], wake * eta[:, 3:4], wake * np.sum(self.inertia_fluid * eta**2, axis=1) / 2
        nose = self.nose_force(mu, mu_rate)
        hung, net = self.weight(R, r)
        n_sum = -nose * E1 + integrate(rates[1] + rates[3] - to_axes(resistive_force) - water_force - net)  # n + V1 p_f
        v = to_axes(eta[:, 3:]), to_axes(true[:, 3:])  # through the water, and over ground
        passed, points = [], self.point_forces(K, K_rate, mu)  # fins and appendages: their moments about the section
        for point in points:
            behind = (self.space.x > point.x)[:, None]
            n_sum = n_sum - behind * point.force
            passed.append(behind * np.cross(point.arm, point.force))
        for (fin, _), (place, _, _, fin_force) in zip(
            self.fins, self.fin_forces(K, K_rate, K_acceleration, mu, mu_rate), strict=True
        ):
            arm = place - self.space.evaluate(r, fin.station)[0]
            behind = (self.space.x > fin.station)[:, None]
            n_sum = n_sum - behind * fin_force
            passed.append(behind * np.cross(arm, fin_force))
        for x, own in self.external_wrenches(K):
            axes = self.space.evaluate(R.reshape(-1, 9), x)[0].reshape(3, 3)
            behind = (self.space.x > x)[:, None]
            n_sum = n_sum - behind * (axes @ own[3:])
            passed.append(behind * (axes @ own[:3]))
        c_slope = rates[0] + rates[2] + np.cross(v[0], p_f) + np.cross(v[1], p_b) - np.cross(t1, n_sum)
        c_sum = integrate(c_slope - to_axes(resistive_torque) - hung) - sum(passed)  # c + V1 sigma_f
        force, torque = to_section(n_sum - V1 * p_f), to_section(c_sum - V1 * sigma_f)
        tail_energy = wake * self.tail_added @ self.at_tail(eta) ** 2 / 2
        tail_residual = np.concatenate([self.at_tail(torque), self.at_tail(force) + tail_energy * E1])
        for point in points:
            if point.x == self.length:
                tail_residual -= np.concatenate(
                    [(np.cross(point.arm, point.force)) @ point.axes, point.force @ point.axes]
                )
        tail_residual -= sum((own for x, own in self.external_wrenches(K) if x == self.length), np.zeros(6))
        flux = V1 * p_f
        if self.scene.tail_pressure == "distributed":
            force, flux, tail_energy = force + energy[:, None] * E1, flux - energy[:, None] * t1, 0.0
        return SimpleNamespace(
            torque=torque,
            force=force,
            tail_residual=tail_residual,
            resistive_force=resistive_force,
            fluid_force=to_section(self.space.evaluate(flux, self.space.x, derivative=True) - rates[3] + water_force)
            + resistive_force,
            tail_force=-tail_energy * E1,
            nose_force=nose * E1,
            fluid_energy_density=energy,
            actuator_power=-self.space.weights @ np.sum(torque * K_rate, axis=1),
            potential=self.space.weights @ self.potential_density(R, r),
            wake_power=self.wake_power(eta, true),
            flow_power=self.flow_power(true, R, r, p_f) if self.flow is not None else 0.0,
            kinetic_fluid=self.energies(K, K_rate, mu)[1]
            + self.space.weights @ np.sum(to_axes((true - eta)[:, 3:]) * p_f, axis=1),
            nose_power=nose * mu[3],
            fins_power=sum(v @ force for _, v, _, force in self.fin_forces(K, K_rate, K_acceleration, mu, mu_rate)),
            fin_force=np.array([R.T @ f for *_, R, f in self.fin_forces(K, K_rate, K_acceleration, mu, mu_rate)]),
            drag_power=self.space.weights
            @ np.sum(resistive_torque * true[:, :3] + resistive_force * true[:, 3:], axis=1)
            + points[0].velocity @ points[0].force,
            appendages_power=sum(point.velocity @ point.force for point in points[1:]),
            external_power=self.external_power(K, K_rate, mu),
            point_wrench=np.array(
                [[*(np.cross(each.arm, each.force) @ each.axes), *(each.force @ each.axes)] for each in points]
            ),
        )

    def wake_power(self, eta, true):
        """Power (W) of what the tail gives to the wake; section twists through the water, and over ground."""
        eta, moved = self.at_tail(eta), self.at_tail(true)
        shed = self.scene.wake * self.tail_added
        energy = shed @ eta**2 / 2
        return eta[3] * energy + (eta[3] * shed * eta)[3:] @ (moved - eta)[3:] - energy * (moved - eta)[3]

    def flow_power(self, true, R, r, p_f):
        """Power (W) of the water's own motion: p . du/dt at a fixed place, and the undisturbed pressure."""
        pose = self.moved(np.zeros(6), 1j * STEP)
        rate = self.flow_at(r).imag / STEP
        self.pose = pose
        force = self.displaced[:, None] * self.flow_acceleration(r)
        velocity = np.einsum("xij,xj->xi", R, true[:, 3:])
        return self.space.weights @ np.sum(p_f * rate + force * velocity, axis=1)

    # -- motion in time ---------------------------------------------------------------------------------------------
    def march(self, law, times, position=(0, 0, 0), orientation=(0, 0, 0, 1), twist=(0,) * 6, rtol=1e-10, breaks=()):
        """Head position (T, 3), quaternion xyzw (T, 4), twist (T, 6) at the times: DOP853 restarted at `breaks`."""
        current = np.asarray(self.scene.current, float)

        def rates(time, state):
            q, mu = state[3:7] / np.linalg.norm(state[3:7]), state[7:].copy()
            world = rotation(q)
            drift = world.T @ current
            mu[3:] -= drift  # relative to the water
            self.up, self.height = world[2], state[2]
            if self.flow is not None or self.fins or self.wrenches:
                self.pose = SimpleNamespace(position=state[:3], axes=world, time=time)
            mu_rate = self.acceleration(*law.curvature(time, self.space.x), mu)
            mu_rate[3:] -= np.cross(mu[:3], drift)
            vector, scalar = q[3] * mu[:3] + np.cross(q[:3], mu[:3]), -q[:3] @ mu[:3]
            return np.concatenate([world @ state[10:13], vector / 2, [scalar / 2], mu_rate])

        state, out = np.concatenate([position, orientation, twist]).astype(float), []
        knots = sorted({*times, *(b for b in breaks if times[0] < b < times[-1])})
        for start, end in zip([knots[0], *knots[:-1]], knots, strict=False):
            if end > start:
                run = solve_ivp(rates, (start, end), state, "DOP853", rtol=rtol, atol=rtol / 10, max_step=0.05)
                state = run.y[:, -1]
            if end in times:
                out.append(state)
        out = np.array(out)
        return out[:, :3], out[:, 3:7] / np.linalg.norm(out[:, 3:7], axis=1)[:, None], out[:, 7:]


def fin_steady(fin, water, across, along, e_n, e_c):
    """Lift and drag (3,) [N] of a fin that moves through the water with these components along e_n and e_c."""
    q = np.hypot(across, along)
    if q == 0.0:
        return np.zeros(3)
    incidence, AR = np.arctan2(-across, along), fin.aspect_ratio
    s, c = np.sin(incidence), np.cos(incidence)
    part = np.clip((abs(s) - np.sin(0.3)) / (np.sin(0.6) - np.sin(0.3)), 0, 1)
    stalled = part - np.sin(2 * np.pi * part) / (2 * np.pi)
    slope = 0.9 * 2 * np.pi * AR / (np.sqrt(AR**2 + 4) + 1.8) if fin.lift_slope is None else fin.lift_slope
    attached = slope * s * c
    lift = attached + stalled * (fin.normal_drag * s * c - attached)
    drag = fin.friction_drag + fin.normal_drag * stalled * s**2
    drag += (1 - stalled) * attached**2 / (np.pi * fin.efficiency * AR)
    ahead, aside = c * e_c - s * e_n, s * e_c + c * e_n  # along the motion, and across it
    return 0.5 * water * fin.area * q**2 * (lift * aside - drag * ahead)


def roundness(a, b):
    """s of sections, 1 for a circle and 0 for a plate; 0 where there is no section."""
    most = np.maximum(a, b)
    return np.minimum(a, b) / np.where(most > 0, most, 1.0)


def cross_flow_by_shape(a, b):
    """k2 and k3 [m] of sections by their roundness."""
    s = roundness(a, b)
    broadside, along = 2 * np.maximum(a, b) * (1.98 - 0.78 * s), 2 * np.minimum(a, b) * (1.0 + 0.2 * s)
    return np.where(a > b, broadside, along), np.where(a > b, along, broadside)


def _along(given, x):
    """A number, or a function of X, at x."""
    return given(x) if callable(given) else np.full(np.shape(x), float(given))


def _roots(function, bounds):
    """Where a function of X changes its sign, between the bounds."""
    x = np.unique(np.concatenate([np.linspace(*ends, 400)[1:-1] for ends in itertools.pairwise(bounds)]))
    values = function(x)
    changes = np.flatnonzero(values[:-1] * values[1:] < 0)
    return [float(brentq(lambda at: float(function(np.array([at]))[0]), x[i], x[i + 1], xtol=1e-15)) for i in changes]


def skin_friction(reynolds, law):
    """c_f of section 7.2.1 against the local Reynolds number; zero at rest."""
    safe = np.where(reynolds > 0, reynolds, 1.0)
    laminar, turbulent = 0.664 / np.sqrt(safe), 0.059 / safe**0.2
    if law == "none":
        return np.zeros_like(safe)
    if law == "laminar":
        share = np.zeros_like(safe)
    elif law == "printed":
        share = (safe > 8e4).astype(float)
    else:
        s = np.clip(np.log(safe / 4e4) / np.log(4.0), 0.0, 1.0)
        share = s - np.sin(2 * np.pi * s) / (2 * np.pi)
    return np.where(reynolds > 0, (1 - share) * laminar + share * turbulent, 0.0)


def rotation(q):
    """Rotation matrix (3, 3) of a unit quaternion x y z w."""
    skew = _hat(np.asarray(q, float)[None, :3])[0]
    return np.eye(3) + 2 * q[3] * skew + 2 * skew @ skew


def _hat(vectors):
    """Cross-product matrices (N, 3, 3)."""
    return np.cross(vectors[:, None, :], np.eye(3)[None, :, :]).transpose(0, 2, 1)
