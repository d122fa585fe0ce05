# SPDX-License-Identifier: Apache-2.0
"""The reference with a body that bends by itself: Lagrange's equations of its modes, from the kinetic energy alone.

    K = imposed + sum_m q_m B_m,    d/dt dT/dqdot_m - dT/dq_m = loads on the motion of mode m - Q_m

dT/dqdot and the whole matrix by polarisation of T, d/dt and dT/dq by complex steps; Q_m of springs, dampers, stops,
motors and muscles as their classes say. Nothing of the core or of `mode_table` is used: B_m and Q_m are written anew
from the parts of a `Robot`. All q are bends in section axes: the library's angles have the opposite sign for "yaw" and
"pitch".
"""

from itertools import pairwise
from types import SimpleNamespace

import numpy as np
from numpy.polynomial import Legendre
from reference import STEP, Reference, rotation
from scipy.integrate import solve_ivp

from eel_dynamics import Joint, Muscle, Servo

COLUMN = {"pitch": 1, "yaw": 2}


class BentReference(Reference):
    """One body with the parts of a `robot` in one scene.

    law: the desired curvature, any object with `curvature(time, x)`. State of the modes: q, qdot (M,), and th, thdot
    (S,) of the motors behind series springs, all as bends.
    """

    def __init__(self, body, robot, settings=None, law=None, splits=(), **space):
        self.length = body.kinks[-1]
        self.parts = [self._with_support(part, robot) for part in robot.parts]
        edges = {place for _, start, end in self.parts for place in (start, end)}
        super().__init__(
            body, settings, splits={*splits, *(place for place in edges if 0.0 < place < self.length)}, **space
        )
        self.law, self._kept = law, {}
        self.owner, self.shapes = [], []  # of each mode its part, and B_m (N, 3)
        x = self.space.x
        for part, start, end in self.parts:
            inside = ((x > start) & (x < end)).astype(float)
            degrees = [None] if isinstance(part, Joint) else range(part.modes)
            for degree in degrees:
                values = 1 / (end - start) if degree is None else Legendre.basis(degree, [start, end])(x)
                shape = np.zeros((len(x), 3))
                shape[:, COLUMN[part.axis.strip("-")]] = inside * values
                self.owner.append(part)
                self.shapes.append(shape)
        self.shapes = np.array(self.shapes).reshape(-1, len(x), 3)
        self.series = [m for m, part in enumerate(self.owner) if _servo(part) and _servo(part).series_stiffness]
        self.armature = np.array(
            [
                part.armature + (_servo(part).reflected_inertia if _servo(part) and m not in self.series else 0.0)
                if isinstance(part, Joint)
                else 0.0
                for m, part in enumerate(self.owner)
            ]
        )

    def _with_support(self, part, robot):
        if isinstance(part, Joint):
            axis = part.axis.strip("-")
            others = [j.position for j in robot.joints if j is not part and j.axis.strip("-") == axis]
            width = part.width or 0.5 * min((abs(x - part.position) for x in others), default=0.1 * self.length)
            return part, part.position - width / 2, part.position + width / 2
        return part, part.start, part.end or self.length

    # -- what the law does ------------------------------------------------------------------------------------------
    def imposed(self, time):
        """The imposed curvature and its two rates (N, 3): that of the law where no motor and no part is."""
        fields = [np.array(each) for each in self.law.curvature(time, self.space.x)]
        for axis, column in COLUMN.items():
            here = [(part, start, end) for part, start, end in self.parts if part.axis.strip("-") == axis]
            driven = any(isinstance(part, Joint) and part.actuator for part, _, _ in here)
            for _, start, end in [(None, 0.0, self.length)] if driven else here:
                for each in fields:
                    each[(self.space.x >= start) & (self.space.x <= end), column] = 0.0
        return fields

    def references(self, time):
        """Reference and rate (M,) of servos: the law's bend over the part of the body that each joint stands for."""
        result = np.zeros((2, len(self.owner)))
        gauss, weights = np.polynomial.legendre.leggauss(40)
        for axis, column in COLUMN.items():
            motors = [m for m, p in enumerate(self.owner) if _motor(p) and p.axis.strip("-") == axis]
            soft = [(s, e) for p, s, e in self.parts if not isinstance(p, Joint) and p.axis == axis]
            places = [self.owner[m].position for m in motors]
            bounds = [0.0, *(0.5 * (one + two) for one, two in pairwise(places)), self.length]
            for index, m in enumerate(motors):
                start = max([bounds[index], *(e for _, e in soft if e <= places[index])])
                end = min([bounds[index + 1], *(s for s, _ in soft if s >= places[index])])
                x = start + (end - start) * (gauss + 1) / 2
                value, rate, _ = self.law.curvature(time, x)
                result[:, m] = [(end - start) / 2 * weights @ each[:, column] for each in (value, rate)]
        return result

    # -- generalised forces of springs, dampers, stops, motors, muscles ---------------------------------------------
    def forces(self, time, q, qdot, th, thdot):
        """Q (M,), the rates thdd (S,) of the motors; what the motors give and lose, and the energy of the springs."""
        Q, thdd, ledger = np.zeros(len(q)), np.zeros(len(th)), SimpleNamespace(motor=0.0, lost=0.0, elastic=0.0)
        reference, reference_rate = self.references(time)
        done = set()
        for m, part in enumerate(self.owner):
            if isinstance(part, Joint):
                sign = 1.0 if part.axis.startswith("-") else -1.0
                angle, rate = sign * q[m], sign * qdot[m]
                torque = part.stiffness * (angle - part.rest_angle) + part.damping * rate
                ledger.elastic += part.stiffness * (angle - part.rest_angle) ** 2 / 2
                ledger.lost += part.damping * rate**2
                for limit, beyond in zip(
                    part.limits or (),
                    (angle < (part.limits or (0,))[0], angle > (part.limits or (0, 0))[1]),
                    strict=False,
                ):
                    if beyond:
                        spring = part.stop_stiffness * (angle - limit)
                        damper = part.stop_damping * abs(angle - limit) / 0.01 * rate  # by the depth over 0.01 rad
                        stop = spring + damper if (spring + damper) * spring > 0.0 else 0.0  # it does not pull
                        torque += stop
                        ledger.elastic += part.stop_stiffness * (angle - limit) ** 2 / 2
                        ledger.lost += (stop - spring) * rate
                servo = _servo(part)
                if servo and m in self.series:
                    s = self.series.index(m)
                    motor, motor_rate = sign * th[s], sign * thdot[s]
                    joint = servo.series_stiffness * (motor - angle) + servo.series_damping * (motor_rate - rate)
                    tau = _servo_torque(servo, sign * reference[m], sign * reference_rate[m], motor, motor_rate)
                    thdd[s] = sign * (tau - joint - servo.friction * motor_rate) / servo.reflected_inertia
                    torque -= joint
                    ledger.motor += tau * motor_rate
                    ledger.lost += servo.friction * motor_rate**2 + servo.series_damping * (motor_rate - rate) ** 2
                    ledger.elastic += servo.series_stiffness * (motor - angle) ** 2 / 2
                elif servo:
                    tau = _servo_torque(servo, sign * reference[m], sign * reference_rate[m], angle, rate)
                    torque += servo.friction * rate - tau
                    ledger.motor += tau * rate
                    ledger.lost += servo.friction * rate**2
                elif part.actuator:
                    tau = float(part.actuator.at(time))
                    torque -= tau
                    ledger.motor += tau * rate
                Q[m] = sign * torque
            elif id(part) not in done:
                done.add(id(part))
                own = [n for n, each in enumerate(self.owner) if each is part]
                shapes = self.shapes[own].sum(axis=2)
                bend, bend_rate = q[own] @ shapes, qdot[own] @ shapes
                inside = np.abs(shapes).max(axis=0) > 0
                EI, eta = (_profile(each, self.space.x) * inside for each in (part.bending_stiffness, part.damping))
                moment = EI * bend + eta * bend_rate
                w = self.space.weights
                ledger.elastic += w @ (EI * bend**2) / 2
                ledger.lost += w @ (eta * bend_rate**2)
                if isinstance(part, Muscle):
                    active = part.moment.curvature(time, self.space.x)[0].sum(axis=1) * inside
                    moment -= active
                    ledger.motor += w @ (active * bend_rate)
                Q[own] = shapes @ (w * moment)
        return Q, thdd, ledger

    def configuration(self, K):
        """As of the base; kept for the last shapes, since a matrix needs it once for each pair of its columns."""
        key = K.tobytes()
        if key not in self._kept:
            self._kept = {key: super().configuration(K), **dict(list(self._kept.items())[:3])}
        return self._kept[key]

    # -- dynamics ---------------------------------------------------------------------------------------------------
    def shape(self, fields, q, qdot):
        """Curvature and rate (N, 3): imposed `fields`, and the modes."""
        K, K_rate = fields[:2]
        return K + np.einsum("m,mxi->xi", q, self.shapes), K_rate + np.einsum("m,mxi->xi", qdot, self.shapes)

    def mode_momenta(self, K, K_rate, mu):
        """pi = dT/dqdot (M,) without armatures; exact central differences of a quadratic form."""
        differences = [
            sum(self.energies(K, K_rate + shape, mu)) - sum(self.energies(K, K_rate - shape, mu))
            for shape in self.shapes
        ]
        return np.array(differences) / 2

    def whole_matrix(self, K):
        """d2T/d(mu, qdot)2 (6 + M, 6 + M) by polarisation, with armatures and the nose's added mass."""
        rest, size = np.zeros_like(K), 6 + len(self.owner)
        flow, self.flow = self.flow, None  # it adds terms that are linear
        basis = [(mu, rest) for mu in np.eye(6)] + [(np.zeros(6), shape) for shape in self.shapes]
        energy = lambda mu, rate: sum(self.energies(K, rate, mu))  # noqa: E731
        single = np.array([energy(*each) for each in basis])
        matrix = np.empty((size, size))
        for a in range(size):
            for b in range(a + 1):
                pair = energy(basis[a][0] + basis[b][0], basis[a][1] + basis[b][1]) - single[a] - single[b]
                matrix[a, b] = matrix[b, a] = pair
        self.flow = flow
        matrix[6:, 6:] += np.diag(self.armature)
        matrix[3, 3] += self.nose_mass
        return matrix

    def mode_loads(self, K, K_rate, mu):
        """What drag, weight, wake and the undisturbed pressure of a flow do on the motion of each mode (M,)."""
        R, r = self.configuration(K)
        eta = self.twists(K, K_rate, mu)
        hung, pushed = self.weight(R, r)
        if self.flow is not None:
            pushed = pushed + self.displaced[:, None] * self.flow_acceleration(r)
        drag = self.resistive(self.through_water(eta, R, r, turning=True))
        others = (np.einsum("xji,xj->xi", R, each) for each in (hung, pushed))
        torque, force = (one + other for one, other in zip(drag, others, strict=True))
        tail_eta = self.at_tail(self.through_water(eta, R, r))
        shed = self.scene.wake * self.tail_added
        wake = tail_eta[3] * shed * tail_eta
        wake[3] -= shed @ tail_eta**2 / 2
        loads, points = [], self.point_forces(K, K_rate, mu)
        for shape in self.shapes:
            moved = self.twists(K, shape, np.zeros(6))
            work = self.space.weights @ np.sum(np.concatenate([torque, force], axis=1) * moved, axis=1)
            work += sum(
                moved_point.velocity @ point.force
                for point, moved_point in zip(points, self.point_forces(K, shape, np.zeros(6)), strict=True)
            )
            if self.wrenches:
                work += self.external_power(K, shape, np.zeros(6))
            loads.append(work + wake @ self.at_tail(moved))
        return np.array(loads)

    def fin_rows(self, *motion):
        """What the fins do on the head's motions and on the modes' (6 + M,), with the accelerations of `motion`."""
        K, rows = motion[0], np.zeros(6 + len(self.owner))
        for (fin, _), (place, _, _, force) in zip(self.fins, self.fin_forces(*motion), strict=True):
            rows[:6] += np.concatenate([np.cross(place, force), force])
            rows[6:] += [self.fin_velocity(fin, K, shape, np.zeros(6))[1].real @ force for shape in self.shapes]
        return rows

    def bent_accelerations(self, time, mu, q, qdot, th=(), thdot=()):
        """Rates of the head's twist (6,), of qdot (M,) and of thdot (S,)."""
        fields = self.imposed(time)
        K, K_rate = self.shape(fields, q, qdot)
        Q, thdd, _ = self.forces(time, q, qdot, np.asarray(th, float), np.asarray(thdot, float))
        still, step = np.zeros(6), 1j * STEP
        head = self.loads(K, K_rate, mu)
        head[3] += self.nose_force(mu, still)
        R, r = self.configuration(K)
        hung, net = self.weight(R, r)
        head += self.space.weights @ np.concatenate([hung + np.cross(r, net), net], axis=1)
        if self.flow is not None:
            head += self.flow_force(K, K_rate, mu)
        if self.wrenches:
            head = head + [self.external_power(K, 0 * K, unit) for unit in np.eye(6)]
        head = head - self.momentum_rate(K, K_rate, fields[2], mu, still)
        pose = self.moved(step * np.asarray(mu), step)
        moved = self.mode_momenta(K + step * K_rate, K_rate + step * fields[2], mu.astype(complex)).imag / STEP
        self.pose = pose
        slope = [sum(self.energies(K + step * shape, K_rate, mu)).imag / STEP for shape in self.shapes]
        modes = np.array(slope) + self.mode_loads(K, K_rate, mu) - Q - moved
        matrix, rows = self.whole_matrix(K), np.concatenate([head, modes])
        if self.fins:  # their forces are linear in the accelerations
            of_rest = self.fin_rows(K, K_rate, fields[2], mu, still)
            rows += of_rest
            by_rate = [self.fin_rows(K, K_rate, fields[2], mu, unit) for unit in np.eye(6)]
            by_rate += [self.fin_rows(K, K_rate, fields[2] + shape, mu, still) for shape in self.shapes]
            matrix -= np.stack(by_rate, axis=1) - of_rest[:, None]
        found = np.linalg.solve(matrix, rows)
        return found[:6], found[6:], thdd

    def bent_motion(self, time, mu, q, qdot, th=(), thdot=()):
        """K and its two rates (N, 3), and the rate of the head's twist: what `fields` takes for the internal wrench."""
        mu_rate, qddot, _ = self.bent_accelerations(time, mu, q, qdot, th, thdot)
        fields = self.imposed(time)
        K, K_rate = self.shape(fields, q, qdot)
        return K, K_rate, fields[2] + np.einsum("m,mxi->xi", qddot, self.shapes), mu, mu_rate

    def bent_march(
        self, times, q, qdot, th=None, thdot=None, twist=(0,) * 6, rtol=1e-10, method="DOP853", max_step=0.05
    ):
        """Head position (T, 3), quaternion (T, 4), twist (T, 6), q, qdot (T, M), th, thdot (T, S) at `times`."""
        modes, motors = len(self.owner), len(self.series)
        th = q[self.series] if th is None else th
        thdot = qdot[self.series] if thdot is None else thdot
        cuts = np.cumsum([3, 4, 6, modes, modes, motors])

        def rates(time, state):
            _, quaternion, mu, q, qdot, th, thdot = np.split(state, cuts)
            quaternion = quaternion / np.linalg.norm(quaternion)
            world = rotation(quaternion)
            self.up, self.height = world[2], state[2]
            self.pose = SimpleNamespace(position=state[:3], axes=world, time=time)
            mu_rate, qddot, thdd = self.bent_accelerations(time, mu, q, qdot, th, thdot)
            vector = quaternion[3] * mu[:3] + np.cross(quaternion[:3], mu[:3])
            turn = [*(vector / 2), -quaternion[:3] @ mu[:3] / 2]
            return np.concatenate([world @ mu[3:], turn, mu_rate, qdot, qddot, thdot, thdd])

        start = np.concatenate([np.zeros(3), [0, 0, 0, 1.0], twist, q, qdot, th, thdot]).astype(float)
        run = solve_ivp(
            rates, (times[0], times[-1]), start, method, t_eval=times, rtol=rtol, atol=rtol / 10, max_step=max_step
        )
        return np.split(run.y.T, cuts, axis=1)


def _motor(part):
    return isinstance(part, Joint) and part.actuator is not None


def _servo(part):
    return part.actuator if isinstance(part, Joint) and isinstance(part.actuator, Servo) else None


def _servo_torque(servo, reference, reference_rate, angle, rate):
    wanted = servo.kp * (reference - angle) + servo.kd * (reference_rate - rate)
    limit, speed = servo.torque_limit or np.inf, servo.speed_limit or np.inf
    if not np.isfinite(limit):
        return wanted
    return np.clip(wanted, -limit * np.clip(1 + rate / speed, 0, 1), limit * np.clip(1 - rate / speed, 0, 1))


def _profile(value, x):
    return value(x) if callable(value) else np.full(len(x), value)
