# SPDX-License-Identifier: Apache-2.0
"""An ellipse in exact plane potential flow: the water's force and torque, by its pressure alone.

The undisturbed flow is u = conj(f(z, t)), f a polynomial of z = x + i y: a uniform flow, a strain, and so on. The
ellipse disturbs it by a potential

    phi = Re sum_n c_n zeta^-n,    z = zeta + k / zeta  in the axes of the ellipse,

whose coefficients meet the motion of its edge. With the potential of both the pressure is - rho (d Phi/dt + 1/2 u^2);
the rate of the coefficients is a difference of the eighth order.
"""

import numpy as np

POINTS, HIGHEST = 64, 8
SHIFTS, STEP = np.array([-4, -3, -2, -1, 1, 2, 3, 4]), 2e-3  # s
EIGHTH = np.array([1 / 280, -4 / 105, 1 / 5, -4 / 5, 4 / 5, -1 / 5, 4 / 105, -1 / 280]) / STEP


class EllipseInStrain:
    """A moving ellipse in an unsteady flow.

    Args:
        half_axes: (2,) [m].
        centre, angle: functions of time [s]: [m] as complex, [rad].
        rates: velocity [m/s] as complex, spin [rad/s] as functions of time.
        flow: the coefficients of f at a time, from the constant one on.
    """

    def __init__(self, half_axes, centre, angle, rates, flow, density=1000.0):
        self.a, self.b = half_axes
        self.centre, self.angle, self.rates, self.flow = centre, angle, rates, flow
        self.density = density
        radius, self.k = (self.a + self.b) / 2, (self.a**2 - self.b**2) / 4
        self.theta = 2 * np.pi * np.arange(POINTS) / POINTS
        self.zeta = radius * np.exp(1j * self.theta)
        self.edge = self.zeta + self.k / self.zeta  # in the axes of the ellipse
        self.step = 1j * (self.zeta - self.k / self.zeta)  # d edge / d theta
        self.orders = np.arange(1, HIGHEST + 1)

    def undisturbed(self, time, place):
        return np.conj(np.polyval(self.flow(time)[::-1], place))

    def coefficients(self, time):
        """c_n: the water's velocity across the edge is that of the edge."""
        turn = np.exp(1j * self.angle(time))
        place = self.centre(time) + turn * self.edge
        velocity, spin = self.rates[0](time), self.rates[1](time)
        lacking = (velocity + 1j * spin * turn * self.edge - self.undisturbed(time, place)) * np.conj(turn)
        across = np.real(lacking * np.conj(-1j * self.step))  # times the length of the step: d phi / dn ds
        # d phi / dn ds = d psi along the edge with phi + i psi = sum c_n zeta^-n: across = Re(-(n c_n zeta^-n))
        spectrum = np.fft.fft(across) / POINTS
        return -2 * np.conj(spectrum[1 : HIGHEST + 1]) * np.abs(self.zeta[0]) ** self.orders / self.orders

    def load(self, time):
        """Force [N/m] as complex, and torque [N] about the centre."""
        turn, c = np.exp(1j * self.angle(time)), self.coefficients(time)
        later = np.array([self.coefficients(time + STEP * shift) for shift in SHIFTS])
        c_rate = EIGHTH @ later
        powers = self.zeta[:, None] ** -self.orders
        slope = -(powers * self.orders) @ c / self.zeta / (1 - self.k / self.zeta**2)  # d / dz in the ellipse's axes
        arm = turn * self.edge
        place = self.centre(time) + arm
        disturbance = np.conj(slope) * turn
        carried = self.rates[0](time) + 1j * self.rates[1](time) * arm
        rate = np.real(powers @ c_rate) - np.real(carried * np.conj(disturbance))
        rate = rate + self._undisturbed_rate(time, place)
        speed = np.abs(self.undisturbed(time, place) + disturbance)
        pressure = -self.density * (rate + speed**2 / 2)
        normal = -1j * self.step * turn * (2 * np.pi / POINTS)  # outwards, times its length
        force = -pressure * normal
        return force.sum(), np.imag(np.conj(arm) * force).sum()

    def _undisturbed_rate(self, time, place):
        """d Phi/dt of the undisturbed flow at fixed places: Phi = Re integral f dz."""
        rates = EIGHTH @ np.array([self.flow(time + STEP * shift) for shift in SHIFTS])
        orders = np.arange(1, len(rates) + 1)
        return np.real(place[:, None] ** orders @ (rates / orders))
