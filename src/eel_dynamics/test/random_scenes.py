# SPDX-License-Identifier: Apache-2.0
"""Random scenes over more than any swimmer has: bodies, waters, laws, ramps, settings, throws."""

import numpy as np
from random_bodies import drawn_hull

from eel_dynamics import Accuracy, Body, Fin, Gust, RollHold, Scene, Shear, Uniform, VortexStreet, Wave
from eel_gaits import Law, Ramp, Term, falling, straight

SUDDEN = 0.1  # s, when ramps of a microsecond begin


def fixed(step):
    return Accuracy(name="fixed", resolution=26.0, step=step)


def pointed(half_width, half_height, length=1.0):
    """A body of `length` [m] whose half-axes [m] are given at the middle, pointed at nose and tail."""

    def along(x):
        return 2.0 * np.sqrt(np.maximum(x / length * (1.0 - x / length), 0.0))

    return Body(length=length, half_width=lambda x: half_width * along(x), half_height=lambda x: half_height * along(x))


def shapes(count, rng):
    """`count` bodies of 1 cm to 100 m: the paper's robot, spindles of slenderness 5 to 500, blunt ones and pointed."""

    def body():
        length = 10.0 ** rng.uniform(-2.0, 2.0)
        most = 500.0 if rng.random() < 0.1 else 50.0  # needles are stiff, and take most of the time
        slenderness = 10.0 ** rng.uniform(np.log10(5.0), np.log10(most))
        if rng.random() < 0.5:
            return Body.spindle(length, slenderness)
        half = 0.5 * length / slenderness
        return pointed(half * rng.uniform(0.2, 1.0), half, length)

    return [Body.boyer2010(), *(body() for _ in range(count - 1))]


def sudden(rng, start):
    """Ramps that begin a swim: one, two that overlap, or some of a microsecond."""
    kind = rng.integers(3)
    if kind == 0:
        return (Ramp(0.0, start, 1.0),)
    if kind == 1:
        return Ramp(0.0, start, 1.0), Ramp(0.3 * start, 2.0 * start, -0.5)
    return Ramp(0.0, start, 0.5), Ramp(SUDDEN, SUDDEN + 1e-6, 0.5), Ramp(SUDDEN + 5e-7, SUDDEN + 2e-6, -0.3)


def anywhere(count, seed):
    """`count` swimmers, their numbers spread evenly in the logarithm over more than any swimmer has."""
    rng = np.random.default_rng(seed)
    bodies = shapes(count // 50, rng)

    def between(low, high):
        return float(10.0 ** rng.uniform(np.log10(low), np.log10(high)))

    def wave(axis, length, period):
        size = between(1e-12, 12.0)
        return Term(
            axis=axis,
            amplitude=(
                size / length,
                size * rng.uniform(-1.0, 1.0) / length**2,
                size * rng.uniform(-2.0, 2.0) / length**3,
            ),
            wavelength=length * between(0.2, 100.0) * rng.choice((-1.0, 1.0)),
            period=period,
            phase=rng.uniform(0.0, 6.0),
            envelope=sudden(rng, period * between(0.01, 10.0)),
        )

    def settings(period):
        kind = rng.random()
        if kind < 0.1:
            return fixed(period * between(3e-3, 1.0))
        if kind < 0.15:
            return "draft, fixed steps"
        return 1e-2 if kind < 0.9 else "draft" if kind < 0.96 else "standard" if kind < 0.99 else "fine"

    def swimmer(index):
        body, period, planar = bodies[index % len(bodies)], between(0.02, 50.0), index % 4 == 3
        axes = ("yaw",) if planar or index % 2 else ("yaw", "pitch")
        scene = Scene(
            planar=planar,
            density=between(1.0, 1e6),
            viscosity=float(rng.choice([0.0, between(1e-9, 1.0)])),
            friction=str(rng.choice(["printed", "laminar", "blended", "none"])),
            added_mass=str(rng.choice(["corrected", "printed"])),
        )
        fast = index % 3 == 0
        twist = np.r_[rng.normal(size=3) * between(1e-3, 100.0), rng.normal(size=3) * between(1e-3, 50.0)] * fast
        law = Law(*(wave(axis, body.length, period) for axis in axes))
        return law, body, scene, settings(period), twist * (0, 0, 1, 1, 1, 0) if planar else twist

    names = "laws", "bodies", "scenes", "accuracy", "twists"
    drawn = dict(zip(names, zip(*(swimmer(index) for index in range(count)), strict=True), strict=True))
    return {**drawn, "twists": np.array(drawn["twists"])}


def robots_anywhere(count, seed):
    """`count` of the paper's robots, their numbers spread evenly in the logarithm over more than any swimmer has."""
    rng = np.random.default_rng(seed)

    def between(low, high):
        return float(10.0 ** rng.uniform(np.log10(low), np.log10(high)))

    def swimmer(index):
        size = between(1e-12, 12.0)
        law = (falling, straight)[index % 2](
            period=between(0.02, 50.0),
            wavelength=between(0.2, 100.0),
            amplitude_0=size,
            amplitude_1=size * rng.uniform(-1.0, 1.0),
            amplitude_2=size * rng.uniform(-2.0, 2.0),
            start_periods=between(0.01, 10.0),
        )
        scene = Scene(
            density=between(1.0, 1e6),
            viscosity=float(rng.choice([0.0, between(1e-9, 1.0)])),
            friction=str(rng.choice(["printed", "laminar", "blended", "none"])),
            added_mass=str(rng.choice(["corrected", "printed"])),
        )
        fast = index % 3 == 0
        twist = np.r_[rng.normal(size=3) * between(1e-3, 100.0), rng.normal(size=3) * between(1e-3, 50.0)]
        return law, scene, twist * fast

    laws, scenes, twists = zip(*(swimmer(index) for index in range(count)), strict=True)
    return {"laws": laws, "scenes": scenes, "twists": np.array(twists)}


def weighed(body, rng):
    """The body with up to a third more or less mass than its water, unevenly along it, off its axis."""
    length, extra, slope = body.length, rng.uniform(-0.3, 0.3), rng.uniform(-0.4, 0.4)
    x = np.linspace(0.0, length, 65)
    low = rng.uniform(-0.2, 0.3) * float(body.half_height(x).max())

    def mass(x):
        area = np.pi * body.half_width(x) * body.half_height(x)
        return 1000.0 * area * (1.0 + extra + slope * (np.asarray(x) / length - 0.5))

    return body.changed(mass_per_length=mass, centre_of_mass_offset=low)


def finned(length, rng):
    """One to three places of fins, given angles, servos or a hold of the roll among them."""
    stations = np.sort(rng.uniform(0.15, 0.85, size=rng.integers(1, 4))) * length
    found = []
    for station in stations:
        area, ratio = length**2 * 10.0 ** rng.uniform(-3.7, -2.7), rng.uniform(1.5, 5.0)
        kind = rng.integers(4)
        times = np.sort(rng.uniform(0.0, 1.0, size=4)) + np.arange(4) * 0.05
        angle = (rng.uniform(-0.6, 0.6), (times, rng.uniform(-0.6, 0.6, size=4)), RollHold(2.0, 0.15), 0.4)[kind]
        lag = {"time_constant": float(rng.uniform(0.03, 0.3))} if kind >= 2 else {}
        made = Fin.pair(float(station), area, ratio, dihedral=rng.uniform(-0.3, 0.6), angle=angle, **lag)
        found += list(made) if rng.random() < 0.7 else [made[0]]
    return found


def moving_water(length):
    """Still water, and flows on the scale of a body of `length` [m]."""
    return (
        None,
        Gust(velocity=(0.1 * length, -0.2 * length, 0.1 * length)),
        Shear(velocity=(0.2 * length, 0.0, 0.0), across=(0.0, 1.0, 2.0), width=length),
        VortexStreet(circulation=0.2 * length**2, core=0.3 * length, spacing=1.5 * length, width=0.5 * length, count=6),
        Wave(amplitude=0.05 * length, wavelength=5.0 * length, surface=2.0 * length),
    )


def with_weight_and_fins(count, seed):
    """Arguments of `simulate` of `count` swimmers that weigh, have fins, or both, in still or moving water; every
    eighth is planar: neutral, without fins. The gait is in full swing from the start on."""
    rng = np.random.default_rng(seed)
    for index in range(count):
        body = shapes(2, rng)[index % 2]
        planar, period = index % 8 == 7, float(rng.uniform(0.6, 2.0))
        size = rng.uniform(0.2, 1.5) / body.length
        axes = ("yaw",) if planar or index % 2 else ("yaw", "pitch")
        wave = {"wavelength": body.length * rng.uniform(0.6, 2.0), "period": period}
        start = -period * rng.uniform(1.0, 2.0)
        ramps = (Ramp(start, start + period, 1.0),)
        law = Law(
            *(Term(axis=axis, amplitude=(size,), phase=rng.uniform(0.0, 6.0), envelope=ramps, **wave) for axis in axes)
        )
        heavy, steered = not planar and index % 3 != 1, not planar and index % 3 != 0
        water = Uniform((0.1, 0.1, 0.0)) if planar else moving_water(body.length)[index % 5]
        speed = body.length * rng.uniform(0.2, 0.8)
        yield {
            "law": law,
            "body": weighed(body, rng) if heavy else body,
            "scene": Scene(planar=planar, weight=heavy or planar, friction=str(rng.choice(["laminar", "printed"]))),
            "flow": water,
            "fins": finned(body.length, rng) if steered else None,
            "twist": (0.0, 0.0, 0.1, speed, 0.0, 0.0),
        }


def with_hulls(count, seed):
    """The same of bodies of blunt links with appendages: their numbers at random."""
    rng = np.random.default_rng(seed)
    for arguments in with_weight_and_fins(count, seed):
        body = arguments["body"]
        yield arguments | {"body": body.changed(**drawn_hull(rng, body.length))}
