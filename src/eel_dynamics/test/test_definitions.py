# SPDX-License-Identifier: Apache-2.0
"""Every figure read off a run, by its definition: on motions and powers made up so that the answer is a formula."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest
from eel_dynamics.simulation.energy import EnergyLedger

from eel_dynamics import Body, Scene, simulate
from eel_gaits import Law, Ramp, Term, gait

pytestmark = pytest.mark.identity("Read off a run")
PERIOD, WAVELENGTH, SAMPLE = 0.8, 1.25, 0.02  # s, m, s
WAVE = Term(axis="yaw", amplitude=(2.0, 1.0), wavelength=WAVELENGTH, period=PERIOD)
TURN = 2 * np.pi / PERIOD
SPLINES = 1e-5  # cubic splines through 40 samples a period: (2 pi / 40)^4 / 384 = 2e-6 of an oscillation
INSTANTS = 1.3e-3  # a greatest value among 64 instants of a period: 1 - cos(pi / 64)


@pytest.fixture(scope="module")
def swum():
    """9 periods and a third: windows of whole periods do not begin at a sample."""
    return simulate(Law(WAVE), (9 + 1 / 3) * PERIOD, sample_period=SAMPLE, stations=201)


def made_up(run, *, centre, tail):
    """`run` with another path of the centre of mass and of the tail, functions of time (T,) to (T, 3) [m]."""
    backbone = run.backbone.copy()
    backbone[:, -1] = tail(run.time)
    return dataclasses.replace(run, center_of_mass=centre(run.time), backbone=backbone)


def line(time, speed, sway, lead=0.0):
    """A way along -x with a sway across it and a lead along it, both with the gait's period."""
    return np.stack([-speed * time + lead * np.cos(TURN * time), sway * np.sin(TURN * time), 0.1 + 0 * time], axis=1)


def test_on_a_straight_path(measured, swum):
    """U: the sway does not count; A: peak to peak across the path, what lies along it does not count."""
    speed, excursion = 0.37, 0.164
    run = made_up(
        swum,
        centre=lambda t: line(t, speed, 0.01, 0.02),
        tail=lambda t: line(t, speed, excursion / 2, 0.05) + np.eye(3)[0],
    )
    length, viscosity = run.body.length, run.scene.viscosity
    for periods in (None, 1, 2, 9):
        got = run.analysis(periods)
        wanted = {
            "mean speed U": (got.mean_speed, speed),
            "stride U T / l": (got.stride, speed * PERIOD / length),
            "slip U T / lambda": (got.slip, speed * PERIOD / WAVELENGTH),
            "tail's excursion A": (got.tail_excursion, excursion),
            "Strouhal number f A / U": (got.strouhal, excursion / PERIOD / speed),
            "swimming number": (got.swimming_number, 2 * np.pi / PERIOD * excursion * length / viscosity),
            "Reynolds number U l / nu": (got.reynolds, speed * length / viscosity),
        }
        for name, (value, formula) in wanted.items():
            measured(f"{name} of a made-up motion against its formula", abs(value / formula - 1), INSTANTS)


def test_swimming_number_takes_the_excursion_from_side_to_side():
    """Re = 0.4 Sw of animals in turbulent flow (Gazzola et al. 2014), within their scatter, over two decades of Re;
    with half of the excursion 2 Sw would stand there."""
    for name in ("straight", "kern_fast"):
        for period in (0.1, 10.0):
            got = simulate(gait(name, period=period), "settled", accuracy=1e-2).analysis()
            assert 0.8 < got.reynolds / (0.4 * got.swimming_number) < 1.6
            assert got.swimming_number / got.reynolds == pytest.approx(2.0 * np.pi * got.strouhal)


def test_on_a_circle(measured, swum):
    """On a circle of radius R at the rate w the period's average goes round at R sin(w T/2) / (w T/2), so that the arc
    length of the averaged path, by the time, is 2 R sin(w T/2) / T; A lies across that path."""
    radius, rate, excursion = 1.3, 0.21, 0.12

    def circle(time, out):
        size = radius + out * np.sin(TURN * time)
        return np.stack([size * np.cos(rate * time), size * np.sin(rate * time), 0 * time], axis=1)

    run = made_up(swum, centre=lambda t: circle(t, 0.0), tail=lambda t: circle(t, excursion / 2))
    got = run.analysis(6)
    wanted = 2 * radius * np.sin(rate * PERIOD / 2) / PERIOD
    measured("mean speed on a circle against its formula", abs(got.mean_speed / wanted - 1), SPLINES)
    # the tail's average over a period is taken out: its own circle, less sinc(w T/2) of it
    measured("tail's excursion across a circular path", abs(got.tail_excursion / excursion - 1), 5e-3)


def test_a_current_is_taken_out(measured, swum):
    current = (0.2, -0.1, 0.05)
    scene = Scene(current=current)
    drift = lambda t: np.outer(t, current)  # noqa: E731
    run = made_up(swum, centre=lambda t: line(t, 0.3, 0.01) + drift(t), tail=lambda t: line(t, 0.3, 0.05) + drift(t))
    got = dataclasses.replace(run, scene=scene).analysis(4)
    measured("mean speed over the water in a current", abs(got.mean_speed / 0.3 - 1), SPLINES)
    measured("tail's excursion in a current", abs(got.tail_excursion / 0.1 - 1), INSTANTS)


MEANS = {"actuator": 0.9, "wake": -0.25, "nose": -0.08, "drag": -0.5}  # W
SWINGS = {"actuator": 1.7, "wake": 0.1, "nose": 0.02, "drag": 0.3}  # W, of a sine with the gait's period


def powers(run, means=MEANS):
    """A ledger of powers mean + swing sin, with their exact works."""
    time, none = run.time, np.zeros_like(run.time)
    fields = {f"{name}_power": means[name] + SWINGS[name] * np.sin(TURN * time) for name in means}
    for name in means:
        fields[f"{name}_work"] = means[name] * time + SWINGS[name] * (1 - np.cos(TURN * time)) / TURN
    return dataclasses.replace(run, steps=0, energy=EnergyLedger(**dict.fromkeys(EnergyLedger.keys(), none) | fields))


@pytest.mark.parametrize("periods", [None, 1, 4])
def test_powers_cost_and_efficiency(measured, swum, periods):
    speed = 0.37
    run = powers(made_up(swum, centre=lambda t: line(t, speed, 0.0), tail=lambda t: line(t, speed, 0.1)))
    got = run.analysis(periods)
    work, mass = MEANS["actuator"], run.body_mass
    wanted = {
        "mean power of the actuators": (got.actuator_power, work),
        "mean power of the wake": (got.wake_power, MEANS["wake"]),
        "mean power of the nose": (got.nose_power, MEANS["nose"]),
        "peak power of the actuators": (got.peak_actuator_power, work + SWINGS["actuator"]),
        "cost of transport P/(m U)": (got.cost_of_transport, work / (mass * speed)),
        "cost of transport P/(m g U)": (got.specific_cost_of_transport, work / (mass * 9.80665 * speed)),
        "hydromechanical efficiency": (got.hydromechanical_efficiency, 1 + MEANS["wake"] / work),
        "propulsive efficiency": (got.propulsive_efficiency, -(got.friction_power + MEANS["nose"]) / work),
    }
    for name, (value, formula) in wanted.items():
        measured(f"{name} of made-up powers against its formula", abs(value / formula - 1), 1e-4)
    assert not got.tail_leads


@pytest.mark.parametrize("means", [{**MEANS, "wake": 0.05}, {**MEANS, "actuator": 0.0}, {**MEANS, "actuator": -0.2}])
def test_efficiencies_are_undefined_where_the_tail_leads_or_nothing_is_driven(swum, means):
    got = powers(swum, means).analysis()
    assert got.hydromechanical_efficiency is None and got.propulsive_efficiency is None
    assert got.tail_leads == (means["wake"] > 0)
    text = got.run.summary()
    assert "hydromechanical undefined, propulsive undefined" in text and ("tail leads" in text) == got.tail_leads


def test_torque_and_positive_power_along_the_body(measured, swum):
    """C3 = c(X) sin, dK3/dt = k(X) sin(. + lag): per length the power -C3 dK3/dt swings about -c k cos(lag)/2 with the
    amplitude c k/2; its positive part has the mean c k/2 (sin b - b cos b)/pi with cos b = cos(lag), b in (0, pi)."""
    x, time, lag = swum.x, swum.time, 2.2
    size, rate = 0.4 * x * (1 - x), 3.0 + x
    torque, curvature_rate = np.zeros_like(swum.torque), np.zeros_like(swum.curvature_rate)
    torque[..., 2] = np.outer(np.sin(TURN * time), size)
    torque[..., 1] = 0.5 * torque[..., 2]
    curvature_rate[..., 2] = np.outer(np.sin(TURN * time + lag), rate)
    got = dataclasses.replace(swum, steps=0, torque=torque, curvature_rate=curvature_rate).analysis(4)
    magnitude = np.sqrt(1.25) * size
    measured("peak torque at each station", np.abs(got.peak_torque - magnitude) / magnitude.max(), 2e-3)  # at samples
    measured("RMS torque at each station", np.abs(got.rms_torque - magnitude / np.sqrt(2)) / magnitude.max(), 1e-5)
    whole = np.trapezoid(size * rate, x) / 2
    b = np.arccos(np.cos(lag))
    positive = whole * (np.sin(b) - b * np.cos(b)) / np.pi
    # max(., 0) has kinks where the power changes sign: trapezoids of 1/64 of a period there
    measured("mean positive power of the actuators", abs(got.positive_actuator_power / positive - 1), 1e-3)
    peak = whole * (1 - np.cos(lag))
    measured("peak positive power of the actuators", abs(got.peak_positive_actuator_power / peak - 1), 1e-2)


def test_net_power_is_what_torque_and_curvature_say(measured, swum):
    """-integral of C . dK/dt by the trapezoidal rule over 201 stations, against the ledger's."""
    density = -np.sum(swum.torque * swum.curvature_rate, axis=2)
    apart = np.abs(np.trapezoid(density, swum.x, axis=1) - swum.energy.actuator_power)
    measured("actuators' power, stations against the ledger", apart / swum.energy.actuator_power.max(), 1e-3)


def exact_motors(run, joints, sample=SAMPLE):
    """Angles and speeds by Gauss's rule over the law itself; torque from a run whose stations are the joints."""
    ends = np.linspace(0.0, run.body.length, joints + 1)
    nodes, weights = np.polynomial.legendre.leggauss(12)
    middle, half = (ends[1:] + ends[:-1]) / 2, (ends[1] - ends[0]) / 2
    x = (middle[:, None] + half * nodes).ravel()
    fields = np.array([run.law.curvature(time, x)[:2] for time in run.time])  # (T, 2, n 12, 3)
    angle, speed = np.moveaxis(
        fields.reshape(len(run.time), 2, joints, 12, 3).transpose(1, 0, 2, 4, 3) @ weights * half, 0, 0
    )
    again = simulate(run.law, run.time[-1], sample_period=sample, stations=middle)
    return SimpleNamespace(x=middle, angle=angle, speed=speed, torque=-again.torque)


def test_demand_on_motors(measured):
    """Every figure of every joint, pitch and yaw apart; splines through 51 stations: their error near the nose, where
    the torque starts like a power of X."""
    joints = 7
    pitch = Term(axis="pitch", amplitude=(0.8,), wavelength=-1.5, period=1.1, envelope=(Ramp(0.1, 0.6, 1.0),))
    run = simulate(Law(WAVE, pitch), 2.0, sample_period=SAMPLE)
    got, wanted = run.actuators(joints), exact_motors(run, joints)
    between = exact_motors(simulate(run.law, 2.0, sample_period=SAMPLE / 8, stations=2), joints, SAMPLE / 8)
    assert got.x == pytest.approx(wanted.x)
    for name, column in (("pitch", 1), ("yaw", 2)):
        motors = getattr(got, name)
        exact = {key: getattr(wanted, key)[..., column] for key in ("angle", "speed", "torque")}
        exact["power"] = exact["torque"] * exact["speed"]
        finer = {key: getattr(between, key)[..., column] for key in ("angle", "speed", "torque")}
        finer["power"] = finer["torque"] * finer["speed"]
        for key, values in exact.items():
            apart = np.abs(getattr(motors, key) - values) / np.abs(values).max()
            measured(f"{key} of each joint", apart, 1e-4)
            assert motors.peak[key] == pytest.approx(
                np.abs(finer[key]).max(axis=0), rel=1e-3, abs=1e-4 * np.abs(values).max()
            )
            assert motors.rms[key] == pytest.approx(
                np.sqrt(np.mean(values**2, axis=0)), rel=1e-3, abs=1e-4 * np.abs(values).max()
            )
    summed = sum(np.sum(wanted.torque[..., k] * wanted.speed[..., k], axis=1) for k in (1, 2))
    measured("joints' summed power", np.abs(got.power - summed) / np.abs(summed).max(), 1e-4)
    assert np.array_equal(got.power_difference, got.power - got.continuous_power)
    apart = np.abs(got.continuous_power - run.energy.actuator_power) / np.abs(run.energy.actuator_power).max()
    measured("continuous power beside it, stations against the ledger", apart, 5e-3)
    table = got.table().splitlines()
    assert len(table) == 2 * joints + 2 and "power of the joints less" in table[-1]


def test_windows_are_whole_periods():
    two = Law(WAVE, Term(axis="pitch", amplitude=(0.5,), period=1.5 * PERIOD))
    run = simulate(two, 6.2 * PERIOD, sample_period=SAMPLE)
    window = run.analysis().window
    assert window.period == pytest.approx(3 * PERIOD) and window.periods == 1
    assert window.end - window.start == pytest.approx(3 * PERIOD)
    assert run.analysis(2).window.start == pytest.approx(0.2 * PERIOD, abs=SAMPLE)
    for periods in (0, 3, 1.5, True):
        with pytest.raises(ValueError, match=r"periods must be a whole number from 1 to 2"):
            run.analysis(periods)
    with pytest.raises(ValueError, match="does not repeat within 12 periods"):
        simulate(Law(WAVE, Term(axis="pitch", amplitude=(0.5,), period=np.pi)), 9.0, sample_period=SAMPLE).analysis()
    with pytest.raises(ValueError, match=r"8 samples or more in a period of 0.8 s"):
        simulate(Law(WAVE), 4.0, sample_period=0.2).analysis()
    with pytest.raises(ValueError, match=r"whole period of 0.8 s, got 0.7"):
        simulate(Law(WAVE), 0.79, sample_period=0.01).analysis()


def test_summary_shows_the_figures(swum):
    got, text = swum.analysis(), swum.summary()
    assert f"over the last       5 x {PERIOD:g} s" in text
    shown = {
        "mean speed U        ": f"{got.mean_speed:.4f} m/s",
        "stride U T/l        ": f"{got.stride:.4g}, slip U T/lambda {got.slip:.4g}",
        "Strouhal f A/U      ": f"{got.strouhal:.4g} with A = {got.tail_excursion:.4f} m",
        "actuator power      ": f"mean {got.actuator_power:.4g} W net, peak {got.peak_actuator_power:.4g} W",
        "cost of transport   ": f"{got.cost_of_transport:.4g} J/(kg m)",
        "efficiency          ": f"hydromechanical {got.hydromechanical_efficiency:.4g}"
        if got.hydromechanical_efficiency
        else "hydromechanical undefined",
    }
    for label, figure in shown.items():
        assert label + figure in text, (label + figure, text)


def test_without_internal_wrench():
    """The ledger's figures stay; those of the torque say what they need."""
    run = simulate(Law(WAVE), 3.0, sample_period=SAMPLE, scene=Scene(internal_wrench=False))
    got = run.analysis()
    assert np.isfinite(got.actuator_power) and np.isfinite(got.strouhal) and got.cost_of_transport > 0
    for name in ("peak_torque", "rms_torque", "positive_actuator_power", "peak_positive_actuator_power"):
        with pytest.raises(ValueError, match="internal_wrench"):
            getattr(got, name)
    text = run.summary()
    assert "cost of transport" in text and "torque" not in text and "nan" not in text


def test_zero_motion_is_undefined_and_never_not_a_number():
    still = simulate(Law(Term(amplitude=(0.0,), wavelength=1.0, period=1.0)), 3.0, sample_period=0.05)
    a = still.analysis()
    undefined = "strouhal", "slip", "cost_of_transport", "specific_cost_of_transport"
    undefined += "hydromechanical_efficiency", "propulsive_efficiency"
    assert all(getattr(a, name) is None for name in undefined)
    zero = "mean_speed", "stride", "tail_excursion", "swimming_number", "reynolds", "actuator_power", "friction_power"
    assert all(getattr(a, name) == 0.0 for name in zero)
    actuators = still.actuators(3)
    assert actuators.relative_difference is None
    for text in (still.summary(), actuators.table()):
        assert "nan" not in text and "inf" not in text and "undefined" in text
    dry = simulate(Law(WAVE), 3.0, sample_period=SAMPLE, scene=Scene(viscosity=0.0))
    assert dry.analysis().reynolds is None and dry.analysis().swimming_number is None and "nan" not in dry.summary()


def test_a_run_that_contains_a_reset_is_refused():
    """A time that goes back: one error, that says where, before any figure is made of it."""
    run = simulate(Law(WAVE), 2.0, sample_period=0.05)
    time = run.time.copy()
    time[20:] -= time[20]
    with pytest.raises(ValueError, match=r"run time must rise, got 0 s after 0.95 s: a reset"):
        dataclasses.replace(run, time=time)
    assert dataclasses.replace(run, body=Body.boyer2010()).analysis().mean_speed == run.analysis().mean_speed
