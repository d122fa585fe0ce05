# SPDX-License-Identifier: Apache-2.0
"""Bad input of the library: one ValueError that names the argument and what it got."""

import io
import re
from dataclasses import fields

import numpy as np
import pytest
from cases import falling_law, random_law

from eel_dynamics import Accuracy, Body, Scene, Simulation, SimulationStopped, hydrodynamic_wrench, simulate
from eel_gaits import Law, Term, straight

X = np.linspace(0, 1, 21)
ROUND = 0.05 * np.sqrt(X * (1.2 - X))


def refused(*words):
    """The error must hold every word."""
    return pytest.raises(ValueError, match="(?s)" + "".join(f"(?=.*{word})" for word in words))


def arrays(**changes):
    return {"x": X, "half_width": ROUND, "half_height": ROUND, **changes}


def changed(values, index, value):
    values = np.array(values)
    values[index] = value
    return values


@pytest.mark.parametrize(
    "given, words",
    [
        (arrays(half_width=changed(ROUND, 5, -0.01)), ("half_width", "-0.01")),
        (arrays(half_height=changed(ROUND, 5, np.nan)), ("half_height", "nan")),
        (arrays(half_height=changed(ROUND, 5, np.inf)), ("half_height", "inf")),
        (arrays(half_height=changed(ROUND, 0, 0.02)), ("half_height", "nose", "0.02")),
        (arrays(half_width=ROUND[:-1]), ("half_width", "20")),
        (arrays(half_width=np.zeros(21)), ("half_width",)),
        (arrays(half_width="wide"), ("half_width", "wide")),
        (arrays(x=X[::-1]), ("x ",)),
        (arrays(x=changed(X, 5, X[4])), ("x ",)),
        (arrays(x=X + 0.1), ("x ",)),
        (arrays(x=changed(X, 5, np.nan)), ("x ", "nan")),
        ({"x": [0, 1], "half_width": [0, 1], "half_height": [0, 1]}, ("x ", "2")),
        (arrays(length=2.0), ("x ", "length", "2.0")),
        (arrays(density=-1.0), ("density", "-1.0")),
        (arrays(density=np.nan), ("density", "nan")),
        (arrays(kinks=(0.5, 0.3)), ("kinks", "0.3")),
        (arrays(kinks=(0.5, 1.3)), ("kinks", "1.3")),
        (arrays(nose=(0.1, 0.1)), ("nose", "0.1")),
        (arrays(nose=(0.1, -0.1, 0.1)), ("nose", "-0.1")),
    ],
)
def test_body_of_arrays(given, words):
    with refused("body", *words):
        Body(**given)


@pytest.mark.parametrize(
    "given, words",
    [
        ({"length": -1.0}, ("length", "-1.0")),
        ({"length": 0.0}, ("length", "0.0")),
        ({"length": None}, ("length",)),
        ({"half_width": lambda x: 0.0 * x - 0.1}, ("half_width", "-0.1")),
        ({"half_width": lambda x: 0.0 * x + 0.1}, ("half_width", "nose", "0.1")),
        ({"half_height": lambda x: np.where(x > 0.5, np.nan, x)}, ("half_height", "nan")),
        ({"half_height": 3.0}, ("half_height", "3.0")),
    ],
)
def test_body_of_functions(given, words):
    def half(x):
        return 0.05 * np.sqrt(x * (1.2 - x))

    with refused("body", *words):
        Body(**{"length": 1.0, "half_width": half, "half_height": half, **given})


def test_body_by_name_and_file(tmp_path):
    with refused("body", "dolphin", "boyer2010"):
        Body.named("dolphin")
    with refused("missing.csv"):
        Body.from_file(tmp_path / "missing.csv")
    columns = tmp_path / "columns.csv"
    columns.write_text("x,half_width\n0,0\n1,0.1\n")
    with refused("columns.csv", "half_height"):
        Body.from_file(columns)
    words = tmp_path / "words.csv"
    words.write_text("x,half_width,half_height\n0,0,none\n")
    with refused("words.csv", "none"):
        Body.from_file(words)


def test_body_of_what_is_no_archive(tmp_path):
    path, packed = tmp_path / "arr.npz", io.BytesIO()
    np.savez(packed, x=X, half_width=ROUND, half_height=ROUND)
    plain = io.BytesIO()
    np.save(plain, X)
    whole = packed.getvalue()
    for content in (plain.getvalue(), b"x,half_width\n", b"", whole[:-30], whole[:200] + b"###" + whole[203:]):
        path.write_bytes(content)
        with refused("arr.npz", "it is damaged or foreign"):
            Body.from_file(path)


def test_body_from_files(tmp_path):
    table = np.stack([X, ROUND, 2 * ROUND], axis=1)
    np.savetxt(tmp_path / "body.csv", table, delimiter=",", header="x,half_width,half_height", comments="")
    np.savez(tmp_path / "body.npz", x=X, half_width=ROUND, half_height=2 * ROUND)
    for name in ("body.csv", "body.npz"):
        body = Body.from_file(tmp_path / name)
        assert body.length == 1.0
        assert np.allclose(body.half_height(X), 2 * ROUND, atol=1e-12)


@pytest.mark.parametrize(
    "given, words",
    [
        ({"friction": "rough"}, ("friction", "rough", "laminar")),
        ({"perimeter": "square"}, ("perimeter", "square")),
        ({"added_mass": "none"}, ("added_mass", "none")),
        ({"tail_pressure": 1}, ("tail_pressure", "1")),
        ({"planar": "yes"}, ("planar", "yes")),
        ({"current": (1, 2)}, ("current", r"\(1, 2\)")),
        ({"current": (1, np.nan, 0)}, ("current", "nan")),
        ({"planar": True, "current": (0, 0, 1)}, ("current", "plane")),
        ({"density": 0.0}, ("density", "0")),
        ({"fluid_density": -1.0}, ("fluid_density", "-1")),
        ({"viscosity": np.inf}, ("viscosity", "inf")),
        ({"metacentric_height": np.nan}, ("metacentric_height", "nan")),
        ({"metacentric_height": "low"}, ("metacentric_height", "low")),
        ({"metacentric_height": True}, ("metacentric_height", "True")),
    ],
)
def test_scene(given, words):
    with refused("scene", *words):
        Scene(**given)


def test_unknown_field_of_the_scene_is_named():
    with pytest.raises(TypeError, match="gravity"):
        Scene(gravity=9.81)


@pytest.mark.parametrize("given", ["best", 0.0, -1e-3, np.nan, np.inf, None])
def test_accuracy(given):
    with refused("accuracy", str(given)):
        Accuracy.of(given)


@pytest.mark.parametrize(
    "given, words",
    [
        ({"accuracy": "best"}, ("accuracy", "best")),
        ({"orientation": (0, 0, 0, 1.1)}, ("orientation", "1.1")),
        ({"orientation": (0, 0, 0, 0)}, ("orientation", "0")),
        ({"orientation": (0, 0, 1)}, ("orientation",)),
        ({"orientation": (0, 0, np.nan, 1)}, ("orientation", "nan")),
        ({"position": (0, 0, np.inf)}, ("position", "inf")),
        ({"position": (0, 0)}, ("position",)),
        ({"twist": (0, 0, 0, 0, 0)}, ("twist",)),
        ({"twist": (0, 0, 0, 0, 0, np.nan)}, ("twist", "nan")),
        ({"stations": 1}, ("stations", "1")),
        ({"stations": (0.5, 0.2)}, ("stations",)),
        ({"stations": (0.0, 1.5)}, ("stations", "1.5")),
        ({"scene": "calm"}, ("scene", "calm")),
        ({"body": "boyer2010"}, ("body", "boyer2010")),
        ({"scene": Scene(planar=True), "twist": (0, 0, 0, 0, 0, 1)}, ("planar|plane", "twist")),
        ({"scene": Scene(planar=True), "orientation": (1, 0, 0, 0)}, ("planar|plane", "orientation")),
    ],
)
def test_simulation(given, words):
    with refused(*words):
        Simulation(**given)


def test_pitch_in_a_planar_scene():
    simulation = Simulation(scene=Scene(planar=True))
    with refused("planar", "pitch"):
        simulation.adopt(falling_law())
    simulation.adopt(random_law(np.random.default_rng(0), pitch=False))
    with refused("planar", "pitch"):
        simulation.add_samples(1.0, [0.0, 1.0], [1.0, 1.0], *[[0.0, 0.0]] * 5)


@pytest.mark.parametrize(
    "given, words",
    [
        ({"duration": -1.0}, ("duration", "-1.0")),
        ({"duration": np.nan}, ("duration", "nan")),
        ({"duration": 1.0, "sample_period": 0.0}, ("sample_period", "0")),
        ({"duration": 1.0, "sample_period": -0.1}, ("sample_period", "-0.1")),
        ({"duration": "10"}, ("duration must be a number, got '10'",)),
        ({"duration": None}, ("duration must be a number, got None",)),
        ({"duration": [1.0, 2.0]}, ("duration", "2.0")),
        ({"duration": np.array([1.0])}, ("duration", "array")),
        ({"duration": 10**400}, ("duration",)),
        ({"duration": 1.0, "sample_period": "0.1"}, ("sample_period must be a number, got '0.1'",)),
        ({"duration": 5.0, "sample_period": 10}, ("sample_period must be at most the duration of 5 s, got 10 s",)),
        ({"duration": 1e9}, ("duration", "sample_period", r"2e\+10 samples")),
        ({"duration": 1e300}, (r"duration must be 0 to 1e\+30 in size, got 1e\+300",)),
        ({"duration": 1e29, "sample_period": 1e-29}, ("duration", "sample_period", r"1e\+58 samples")),
        ({"duration": 1.0, "sample_period": 1e-12}, ("duration", "sample_period", r"1e\+12 samples")),
        ({"duration": 100.0, "sample_period": 1e-8}, ("duration", "sample_period", r"1e\+10 samples")),
        ({"duration": 9.0, "sample_period": 1e-6, "stations": 10_000}, ("stations", "1 swimmer of", "GB")),
    ],
)
def test_simulate(given, words):
    with refused(*words):
        simulate(falling_law(), **given)


def test_a_short_run_has_a_sample_at_its_end_by_default():
    assert simulate(falling_law(), 0.02).time.tolist() == [0.0, 0.02]


@pytest.mark.parametrize("call", [simulate, lambda law, **given: Simulation(law=law, **given)])
def test_a_file_or_a_name_in_place_of_a_body_is_told_how(call):
    with refused(r"body must be a Body, got 'nobody\.csv'", r"Body\.from_file\(", r"Body\.kern2006\(\)$"):
        call(straight(), body="nobody.csv")


@pytest.mark.parametrize(
    "law, end",
    [
        (straight, r"call it, straight\(\)"),
        ("straight", r"write gait\('straight'\)"),
        (lambda t: t, r"which does not take \(t, X\)"),
    ],
)
def test_what_is_nearly_a_law_is_told_how(law, end):
    with refused(rf"law must be a Law, .*, got .*{end}$"):
        simulate(law, 5.0)


def test_law_of_the_wrong_kind():
    for call in (
        lambda: simulate("falling", duration=1.0),
        lambda: Simulation().adopt("falling"),
        lambda: hydrodynamic_wrench(Body.boyer2010(), "falling", 0.0, np.zeros(6), np.zeros(6), Scene()),
    ):
        with refused("law", "falling"):
            call()


def test_prescribed_motion():
    for twist, rate, word in ((np.zeros(5), np.zeros(6), "twist"), (np.zeros(6), [np.nan] * 6, "twist_rate")):
        with refused(word):
            hydrodynamic_wrench(Body.boyer2010(), Law(), 0.0, twist, rate, Scene())


def test_advance_without_a_law_and_backwards():
    simulation = Simulation()
    with pytest.raises(RuntimeError, match="law"):
        simulation.advance(0.1)
    with refused("law must be a Law or a SampledLaw, got None"):
        simulation.adopt(None)
    simulation.adopt(Law())
    simulation.advance(0.5)
    for time in (0.2, "1", None, np.nan, [1.0]):
        with refused("time must be finite", re.escape(repr(time))):
            simulation.advance(time)


@pytest.mark.parametrize(
    "time, x, pitch, word",
    [
        (-0.1, [0.0, 1.0], [0.0, 0.0], "time"),
        (np.nan, [0.0, 1.0], [0.0, 0.0], "time"),
        (1.0, [1.0, 0.9], [0.0, 0.0], r"x must rise, got 0\.9 after 1 at index 1$"),
        (1.0, [0.0], [0.0], "x must have 2 points or more, got 1$"),
        (1.0, [0.0, 1.0], [0.0], r"pitch must be 2 numbers, got 1: \[0.0\]$"),
        (1.0, [0.0, 1.0], np.array([]), "pitch must be 2 numbers, got 0$"),
        (1.0, [0.0, 1.0], [0.0, np.nan], "pitch"),
    ],
)
def test_samples(time, x, pitch, word):
    simulation = Simulation()
    with refused(word):
        simulation.add_samples(time, x, pitch, *[[0.0, 0.0]] * 5)


@pytest.mark.parametrize("amplitude", [1e3, 1e4, 1e6, 1e20, 1e29])
def test_a_law_beyond_all_numbers(amplitude):
    """A body wound up a thousand times and more: refused, or stopped with a hint, or it goes on; NaN it never gives."""
    simulation = Simulation(accuracy="draft", most_evaluations=1e4)
    try:
        simulation.adopt(Law(Term(axis="yaw", amplitude=(amplitude,), period=1.0)))
    except ValueError as refusal:
        assert "bends the body into" in str(refusal) and simulation.law is None and not simulation.ready
        return
    try:
        simulation.advance(0.01)
    except SimulationStopped as stop:
        assert stop.hint
        assert stop.quantity
        assert np.isfinite(stop.time)
    state = simulation.observe(wrench=False, load=False)
    assert np.all(np.isfinite(np.concatenate([state.position, state.orientation, state.twist])))


def test_help_on_a_scene_tells_each_field():
    for item in fields(Scene):
        assert f"{item.name} = {item.default!r}: {item.metadata['description']}" in Scene.__doc__
    assert "kinematic viscosity of the water [m^2/s]; >= 0 m^2/s" in Scene.__doc__
    assert "c_f(Re); one of printed, laminar, blended, taylor, none" in Scene.__doc__
