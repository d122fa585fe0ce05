# SPDX-License-Identifier: Apache-2.0
"""Functions, measured midlines, curvature and joint angles as laws of rows."""

import math
import pickle
import re

import numpy as np
import pytest
from eel_gaits.sources.lateral import LateralMidline
from eel_gaits.sources.midlines import curvature_of
from eel_gaits.sources.sampled_law import quintic
from eel_gaits.sources.smoothing import smoothed_in_time, trace_of_quotient
from measured import midline_of, write, write_midlines
from scipy.linalg import cholesky_banded

from eel_gaits import Law, SampledLaw, Term, falling, read_motion, sampled, save_law

X = np.linspace(0.0, 1.0, 41)
WAVE = Law(Term(amplitude=(2.0, 1.0, 3.0), wavelength=1.0, period=0.8))


def apart(law, other, times):
    """Greatest differences of value, rate and acceleration, each relative to the greatest of `other`."""
    found = [(law.curvature(time, X), other.curvature(time, X)) for time in times]
    return [
        max(np.max(np.abs(a[order] - b[order])) for a, b in found) / max(np.max(np.abs(b[order])) for _, b in found)
        for order in range(3)
    ]


def apart_on_average(law, other, times):
    """Root mean squares of the differences of value, rate and acceleration, relative to that of `other`."""
    found = [(np.array(law.curvature(time, X)), np.array(other.curvature(time, X))) for time in times]
    size = np.mean([b**2 for _, b in found], axis=(0, 2, 3))
    return np.sqrt(np.mean([(a - b) ** 2 for a, b in found], axis=(0, 2, 3)) / size)


def test_a_function_becomes_rows_that_meet_it():
    law = sampled(lambda t, x: falling().curvature(t, x)[0][:, 1:].T, 2.5)
    value, rate, acceleration = apart(law, falling(), np.linspace(0.0, 2.5, 87))
    assert value < 2e-5 and rate < 2e-4 and acceleration < 2e-2
    assert law.duration == 2.5 and law.name == "<lambda>" and "rows" in law.about


def test_derivatives_that_a_function_gives_are_taken():
    law = sampled(falling().curvature, 2.5, name="mine")
    value, rate, acceleration = apart(law, falling(), np.linspace(0.0, 2.5, 87))
    assert value < 2e-5 and rate < 2e-4 and acceleration < 2e-3 and law.name == "mine"
    assert len(law.time) < len(sampled(lambda t, x: falling().curvature(t, x)[0][:, 1:].T, 2.5).time)


def test_yaw_alone_is_enough():
    law = sampled(lambda t, x: np.sin(2.0 * math.pi * (x - t)), 2.0)
    assert law.in_plane and law.waves[0].axis == "yaw"
    assert law.waves[0].period == pytest.approx(1.0, rel=1e-3)
    assert law.waves[0].wavelength == pytest.approx(1.0, rel=1e-2)


def test_a_motion_that_does_not_repeat_has_no_wave():
    assert sampled(lambda t, x: t * x, 2.0).waves == ()


@pytest.mark.parametrize(
    ("function", "words"),
    [
        (lambda t, x: np.zeros(5), ["shape (5,)", "at t = 0 s"]),
        (lambda t, x: "bent", ["'bent'", "at t = 0 s"]),
        (lambda t, x: np.where((t > 0.5) & (x > 0.3), np.nan, x), ["nan in yaw at t = 0.5", "X = 0.3"]),
        (lambda t, x: np.full(len(x), float(t > 0.5)), ["smooth in time", "at t = 0.5"]),
        (lambda t, x: 1.0 * (x > 0.4), ["smooth along the body", "at X = 0.4"]),
    ],
)
def test_a_function_that_does_not_fit_is_named_with_time_and_place(function, words):
    with pytest.raises(ValueError) as error:
        sampled(function, 1.0)
    assert all(word in str(error.value) for word in words) and "\n" not in str(error.value)


def test_rows_are_joined_with_two_continuous_derivatives():
    draw = np.random.default_rng(3)
    start, end = draw.normal(size=(2, 3, 4))
    assert np.allclose(quintic(start, end, 0.3, 0.0), start) and np.allclose(quintic(start, end, 0.3, 1.0), end)
    near = [quintic(start, end, 0.3, 0.4 + step / 0.3)[0] for step in (-1e-5, 0.0, 1e-5)]
    assert np.allclose((near[2] - near[0]) / 2e-5, quintic(start, end, 0.3, 0.4)[1], atol=1e-5)


def test_cross_validation_removes_noise():
    draw, time = np.random.default_rng(1), np.arange(300) / 50.0
    clean = np.sin(2.0 * math.pi * time)[:, None] * np.linspace(0.2, 1.0, 15)
    noise = 0.02 * draw.normal(size=clean.shape)
    found = smoothed_in_time(time, clean + noise)
    left = found.spline(time) - clean
    assert np.sqrt(np.mean(left**2)) < 0.2 * 0.02  # most of the noise is gone
    inner = slice(15, -15)
    acceleration = found.spline(time, 2)[inner] + (2.0 * math.pi) ** 2 * clean[inner]
    assert np.max(np.abs(acceleration)) < 0.15 * (2.0 * math.pi) ** 2


def test_the_trace_by_bands_is_the_trace():
    bands = np.zeros((6, 30))
    bands[0], bands[1:] = 9.0, np.random.default_rng(4).uniform(-0.8, 0.8, (5, 30))
    for offset in range(1, 6):
        bands[offset, 30 - offset :] = 0.0
    full = sum(np.diag(bands[k, : 30 - k], -k) for k in range(6))
    full = full + np.tril(full, -1).T
    gram = np.minimum(bands, 0.5)
    other = sum(np.diag(gram[k, : 30 - k], -k) for k in range(6))
    other = other + np.tril(other, -1).T
    assert trace_of_quotient(cholesky_banded(bands, lower=True), gram) == pytest.approx(
        np.trace(np.linalg.solve(full, other)), rel=1e-10
    )


def test_midlines_give_their_curvature_whatever_the_head_does(tmp_path):
    law = read_motion(write_midlines(tmp_path / "wave.csv", lambda t, s: midline_of(WAVE, t, s), end=2.4))
    inside = np.linspace(0.3, 2.1, 37)
    assert max(apart_on_average(law, WAVE, inside)) < 0.08  # most of it at the tail, where the curvature is greatest
    assert law.in_plane and law.waves[0].period == pytest.approx(0.8, rel=1e-3) and law.name == "wave"
    assert "generalised cross-validation" in law.about and "21 points" in law.about


def test_smoothing_makes_measured_accelerations_useful(tmp_path):
    path = write_midlines(tmp_path / "noisy.csv", lambda t, s: midline_of(WAVE, t, s), end=2.4, noise=5e-4)
    inside = np.linspace(0.3, 2.1, 37)
    smooth = apart_on_average(read_motion(path), WAVE, inside)
    raw = apart_on_average(read_motion(path, smooth=False), WAVE, inside)
    assert max(smooth) < 0.2 and raw[2] > 10.0 * smooth[2]
    assert re.search(r"instants, not smoothed$", read_motion(path, smooth=False).about)


def test_a_helix_has_its_curvature_and_no_twist():
    radius, rise, place = 0.1, 0.05, np.linspace(0.0, 1.0, 401)
    turn = place / math.hypot(radius, rise)
    first = np.stack((-radius * np.sin(turn), radius * np.cos(turn), np.full_like(turn, rise)), axis=-1)
    second = np.stack((-radius * np.cos(turn), -radius * np.sin(turn), np.zeros_like(turn)), axis=-1)
    scale = math.hypot(radius, rise)
    pitch, yaw = curvature_of(first[None] / scale, second[None] / scale**2)[0]
    assert np.allclose(np.hypot(pitch, yaw), radius / scale**2, rtol=1e-6)
    angle = np.unwrap(np.arctan2(-pitch, yaw))  # of the normal against the section: it turns with the torsion
    assert np.allclose(np.diff(angle), np.diff(place) * rise / scale**2, rtol=1e-3)


def test_a_bend_to_the_left_of_who_looks_to_the_tail_is_positive():
    angle = 0.7 * X
    first, second = np.stack((np.cos(angle), np.sin(angle)), -1), 0.7 * np.stack((-np.sin(angle), np.cos(angle)), -1)
    assert np.allclose(curvature_of(first[None], second[None])[0], [[0.0] * 41, [0.7] * 41])


def test_joint_angles_give_the_curvature_whose_integrals_they_are(tmp_path):
    ends, times = np.linspace(0.0, 1.0, 13), np.arange(121) / 50.0
    fine = np.linspace(0.0, 1.0, 2401)
    rows = []
    for time in times:
        bend = WAVE.curvature(time, fine)[0][:, 2]
        total = np.concatenate(([0.0], np.cumsum(0.5 * (bend[1:] + bend[:-1]) * np.diff(fine))))
        rows.append((time, *np.diff(np.interp(ends, fine, total))))
    law = read_motion(write(tmp_path / "joints.csv", ("time", *(f"yaw_{joint + 1}" for joint in range(12))), rows))
    assert max(apart(law, WAVE, np.linspace(0.3, 2.1, 19))) < 0.03
    assert law.in_plane and "12 joints" in law.about


def test_curvature_that_was_measured_is_read(tmp_path):
    arc = np.linspace(0.0, 1.0, 15)
    rows = [
        (time, x, 0.5 * bend, bend)
        for time in np.arange(101) / 50.0
        for x, bend in zip(arc, WAVE.curvature(time, arc)[0][:, 2], strict=True)
    ]
    law = read_motion(write(tmp_path / "bends.csv", ("time", "arc_length", "pitch", "yaw"), rows))
    value, rate, _ = law.curvature(1.0, X)
    wanted = WAVE.curvature(1.0, X)
    assert np.allclose(value[:, 2], wanted[0][:, 2], atol=0.05) and np.allclose(
        value[:, 1], 0.5 * value[:, 2], atol=0.05
    )
    assert np.allclose(rate[:, 2], wanted[1][:, 2], atol=0.5)
    left = float(re.search(r"residual \(RMS\) .*?([0-9.e-]+) rad/m in time", law.about)[1])
    assert 0.0 < left < 0.01  # there is no noise


def test_a_lateral_displacement_becomes_the_curvature_of_its_midline():
    fish = LateralMidline(lambda x, t: (0.02 + 0.1 * x**2) * np.sin(2.0 * math.pi * (x - t)))
    fine = np.linspace(0.0, 1.0, 4001)
    place = fish.position(0.3, fine)
    steps = np.diff(place, axis=0)
    assert np.allclose(np.linalg.norm(steps, axis=1), np.diff(fine), rtol=1e-5)  # X is the arc length
    turn = np.diff(np.arctan2(steps[:, 1], steps[:, 0])) / np.diff(fine)[1:]
    assert np.allclose(fish.curvature(0.3, fine[1:-1]), turn, atol=2e-3)
    with pytest.raises(ValueError, match=r"less steep than 0.99.*t = 0 s, X = "):
        LateralMidline(lambda x, t: 0.5 * np.sin(9.0 * x)).curvature(0.0, X)


def test_a_law_of_rows_is_saved_read_and_pickled(tmp_path):
    law = sampled(WAVE.curvature, 1.0, name="wave")
    save_law(law, tmp_path / "wave.npz")
    assert read_motion(tmp_path / "wave.npz") == law == pickle.loads(pickle.dumps(law))
    assert hash(law) == hash(pickle.loads(pickle.dumps(law))) and law != sampled(WAVE.curvature, 1.0, name="other")
    with pytest.raises(ValueError, match=r"wave.npz.*the body's length, 2 m, got 1 m"):
        read_motion(tmp_path / "wave.npz", length=2.0)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({}, []),
        ({"time": (lambda t: np.where(t == 0.4, 0.1, t))}, ["line 422", "time must rise, got 0.1 s after 0.38 s"]),
        ({"time": (lambda t: np.where(t > 1.0, t + 0.5, t))}, ["lines 1052 to 1093", "a gap of 0.52 s", "quarter"]),
        *(
            (
                {name: (lambda each, by=by: by * each) for name in "xy"},
                ["lines 2 to ", f"body, 1 m, got {by:.4g}", "scale"],
            )
            for by in (0.67, 0.94, 1.06)
        ),
        ({"x": (lambda x: np.where(np.arange(len(x)) // 21 == 30, 1.5 * x, x))}, ["a midline of 1.", "others have 1"]),
        ({"x": (lambda x: np.where(np.arange(len(x)) == 30, np.nan, x))}, ["line 32", "x must be finite, got nan"]),
        ({"arc_length": (lambda s: np.where(np.arange(len(s)) == 30, 0.4, s))}, ["line 32", "arc_length must rise"]),
        (
            {"arc_length": (lambda s: np.where(np.arange(len(s)) // 21 == 30, 1.2 * s, s))},
            ["line 652", "arc_length of point 21 must stay the same, got 1.2, on average 1.0"],
        ),
    ],
)
def test_bad_rows_of_midlines_are_named(tmp_path, change, words):
    path = write_midlines(tmp_path / "fish.csv", lambda t, s: midline_of(WAVE, t, s), end=2.4)
    names, rows = path.read_text().splitlines()[0].split(","), np.loadtxt(path, delimiter=",", skiprows=1)
    for name, function in change.items():
        rows[:, names.index(name)] = function(rows[:, names.index(name)])
    write(path, names, rows.tolist())
    if not words:
        assert isinstance(read_motion(path), SampledLaw)
        return
    with pytest.raises(ValueError) as error:
        read_motion(path)
    assert all(word in str(error.value) for word in ["fish.csv", *words]) and "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", ["it is empty"]),
        ("time,x,y\n", ["a header and no row"]),
        ("time,x,y\n0,1,two\n", ["line 2", "y must be a number, got 'two'"]),
        ("time,x,y\n0,1\n", ["line 2", "3 fields", "got 2"]),
        ("time,x,x\n0,1,2\n", ["its columns must be time and", "got ['time', 'x', 'x']"]),
        ("when,x,y\n0,1,2\n", ["its time is not plain from ['when', 'x', 'y']"]),
        ("time,x,y\n" + "0,0,0\n" * 7 + "1,0,0\n" * 6, ["lines 9 to 14", "a frame of 6 points, the first frame has 7"]),
        ("time,yaw_1,yaw_3\n0,0,0\n", ["joints of yaw", "without gaps"]),
        (
            "time,yaw_1,yaw_2,yaw_3\n" + "".join(f"{n / 50},0,28.6,0\n" for n in range(20)),
            ["yaw_2 must be at most 3.2"],
        ),
        ("time,yaw_1,yaw_2,yaw_3\n" + "".join(f"{20 * n},0,0.1,0\n" for n in range(20)), ["20 s apart", "time in s?"]),
        ("time,yaw_1,yaw_2,yaw_3\n0,0,0,0\n0,0,0,0\n", ["line 3", "time must rise"]),
        ("time,yaw_1_deg,yaw_2_deg,yaw_3\n0,0,0,0\n1,0,0,0\n", ["yaw_3 must have a unit in its name, as yaw_1_deg"]),
        ("time,x_mm,y\n0,0,0\n1,0,0\n", ["y must have a unit in its name, as x_mm has"]),
    ],
)
def test_a_bad_file_is_refused_in_one_line(tmp_path, text, words):
    path = tmp_path / "motion.csv"
    path.write_text(text)
    with pytest.raises(ValueError) as error:
        read_motion(path)
    assert all(word in str(error.value) for word in ["motion.csv", *words]) and "\n" not in str(error.value)


def test_other_files_are_refused(tmp_path):
    (tmp_path / "motion.npz").write_text("no archive")
    for name, words in (
        ("motion.npz", "not a zip file"),
        ("motion.bin", "must be in a table .*or an .npz file"),
        ("none.csv", "no such file"),
    ):
        with pytest.raises(ValueError, match=f"{name}.*{words}"):
            read_motion(tmp_path / name)
