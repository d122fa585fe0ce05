# SPDX-License-Identifier: Apache-2.0
"""Filmed swimmers: the beat that went in comes out, whatever the form of the file; bad data are told."""

import numpy as np
import pytest
from eel_gaits.film.beat import beat_of
from eel_gaits.film.film import Film, read_film
from eel_gaits.film.forms import read_tracks
from eel_gaits.film.kinematics import kinematics
from filmed import TIMES, TWICE, WAVE, swimming, write_deeplabcut, write_long, write_sleap, write_wide

X = np.linspace(0.05, 0.95, 37)
PIXELS = {"units": "px", "scale": 1e-3, "rate": 50.0}


def film(points, times=TIMES):
    return Film("fish.csv", times, points, ())


def missed(beat, law, scale=1.0):
    """RMS difference of the curvature of a beat from that of the true law, by the RMS of the latter.

    The phase of the beat counts from the middle of the film.
    """
    start = 0.5 * TIMES[-1]
    found, true = beat.law(1.0), []
    for time in np.linspace(0.0, 0.26, 14):
        true.append((found.curvature(time, X)[0][:, 2], scale * law.curvature(start + time, X)[0][:, 2]))
    one, other = np.moveaxis(np.array(true), 1, 0)
    return float(np.sqrt(np.mean((one - other) ** 2) / np.mean(other**2)))


def test_the_beat_that_went_in_comes_out_of_noise_that_lasts_over_frames():
    beat = beat_of(film(swimming(noise=5e-3)))
    assert beat.harmonics == 1 and beat.period == pytest.approx(0.26, rel=0.01)
    assert missed(beat, WAVE) < 0.15  # errors of a tenth of the points' distance
    assert 3e-3 < beat.residual < 8e-3  # m: of both components, less what rigid motion and length take
    assert 0.0 < beat.band < 0.3


def test_a_clean_film_gives_the_law_itself():
    beat = beat_of(film(swimming()))
    assert missed(beat, WAVE) < 0.02 and beat.share > 0.999 and beat.period == pytest.approx(0.26, rel=1e-4)


def test_a_second_harmonic_is_kept_where_each_beat_has_it_and_not_where_none_has():
    assert beat_of(film(swimming(TWICE, noise=2e-3))).harmonics == 2
    assert beat_of(film(swimming(WAVE, noise=2e-3))).harmonics == 1


def test_the_band_holds_the_true_curvature_in_most_places():
    beat = beat_of(film(swimming(noise=3e-3)))
    place = X * (beat.curvature.shape[1] - 1)
    found = np.hypot(*beat.curvature[1:3])[place.round().astype(int)]
    true = np.max([np.abs(WAVE.curvature(t, X)[0][:, 2]) for t in np.linspace(0.0, 0.26, 40)], axis=0)
    others = np.array([np.hypot(*each.curvature[1:3])[place.round().astype(int)] for each in beat.others])
    assert np.mean(np.abs(found - true) < 4.0 * np.std(others, axis=0) * np.sqrt(len(others))) > 0.6


def test_a_beat_on_a_body_of_another_length_bends_by_the_same_angles():
    beat = beat_of(film(0.154 * swimming()))
    whole = np.linspace(0.0, 1.0, 201)
    small, large = beat.law(0.154).curvature(0.1, 0.154 * whole)[0], beat.law(1.0).curvature(0.1, whole)[0]
    assert np.allclose(0.154 * small, large, atol=1e-9) and np.max(np.abs(large)) > 1.0


def test_of_many_beats_some_are_left_out_together():
    times = 0.02 * np.arange(900)
    beat = beat_of(film(swimming(noise=2e-3, times=times, arc=np.linspace(0.0, 1.0, 6)), times))
    assert len(beat.others) == 40 and any("s (95 %), 69 beats," in text for _, text in beat.about())


def test_a_rigid_head_does_not_bend():
    law = beat_of(film(swimming(noise=1e-3)), rigid=0.5).law(1.0)
    bend = np.abs([law.curvature(t, np.linspace(0.0, 1.0, 101))[0][:, 2] for t in np.linspace(0.0, 0.26, 9)])
    assert bend[:, :45].max() < 1e-2 * bend.max()


def test_all_forms_of_files_give_the_same_points(tmp_path):
    points = swimming(noise=1e-3)
    pixels = {"units": "px", "scale": 1e-3, "rate": 50.0}
    films = [
        read_film(write_long(tmp_path / "long.csv", points)),
        read_film(write_long(tmp_path / "bare.csv", points, unit="", factor=1e2, numbered=False), units="cm"),
        read_film(write_wide(tmp_path / "wide.csv", points)),
        read_film(write_deeplabcut(tmp_path / "dlc.csv", {"": 1e3 * points}), **pixels),
        read_film(write_deeplabcut(tmp_path / "two.csv", {"a": points, "b": 1e3 * points}), **pixels, animal="b"),
        read_film(write_sleap(tmp_path / "sleap.csv", {"track_0": 1e3 * points}), **pixels),
    ]
    for each in films:
        assert np.allclose(each.points, points, atol=1e-9) and np.allclose(np.diff(each.time), 0.02)


def test_gaps_missing_points_and_jumps_are_repaired_and_told(tmp_path):
    points, draw = swimming(noise=1e-3), np.random.default_rng(0)
    points[:2] = np.nan  # empty
    points[30, -1] = np.nan  # no tail
    points[40, 3:12] = np.nan  # half of the body
    for frame in draw.choice(np.arange(45, 80), 10, replace=False):
        points[frame, draw.integers(2, 18)] = np.nan
    points[20, 7] += 0.4  # a tracker's jump
    found = read_film(write_long(tmp_path / "fish.csv", points))
    told = "; ".join(found.notes)
    for words in ("2 of 80 frames left out: empty", "an end of the body is missing", "more than a quarter", "filled"):
        assert words in told
    assert "1 points have jumped" in told and len(found.time) == 76
    beat = beat_of(found)
    clean = beat_of(film(swimming(noise=1e-3)))
    middle = slice(30, 230)
    size = np.max(np.hypot(*clean.curvature[1:3]))
    assert np.max(np.abs(np.hypot(*beat.curvature[1:3]) - np.hypot(*clean.curvature[1:3]))[middle]) < 0.05 * size


def test_points_that_stand_tail_first_are_reversed_and_told():
    growing = WAVE
    turned = film(swimming(growing)[:, ::-1])
    head, tail = kinematics(TIMES, turned.points, 0.26).excursion[[0, -1]]
    assert head > tail
    beat = beat_of(turned)
    assert any("points reversed" in note for note in beat.film.notes)
    assert missed(beat, growing) < 0.02


def two_in_one(points):
    return np.concatenate((points, points), axis=1)


@pytest.mark.parametrize(
    ("change", "options", "words"),
    [
        (lambda points: points, {"units": "m"}, "its columns are in mm, the units given are m"),
        (
            lambda points: points,
            {"units": "ft"},
            "units must be one of m, cm, mm, um, km, inch, px, got 'ft'",
        ),
        (lambda points: points, {"rate": 50.0}, "it has times: a rate"),
        (lambda points: points, {"animal": "b"}, "there is no animal 'b'"),
        (lambda points: points[:10], {}, "5 points in 16 frames or more, got 20 in 10"),
        (lambda points: points[:, :4], {}, "5 points in 16 frames or more, got 4 in 80"),
        (lambda points: np.full_like(points, np.nan), {}, "all its points are missing"),
        (lambda points: points + 3.0 * (TIMES > 1.0)[:, None, None], {}, "the swimmer jumps by 4.2"),
        (lambda points: points * 1e6, {}, "9.994e+05 m long: give its units"),
    ],
)
def test_a_film_that_does_not_fit_is_refused_in_a_sentence(tmp_path, change, options, words):
    points = change(swimming())
    path = write_long(tmp_path / "fish.csv", points, times=TIMES[: len(points)])
    with pytest.raises(ValueError) as error:
        read_film(path, **options)
    assert words in str(error.value) and "fish.csv" in str(error.value) and "\n" not in str(error.value)


def test_pixels_need_a_scale_and_frames_a_rate(tmp_path):
    path = write_deeplabcut(tmp_path / "dlc.csv", {"": 1e3 * swimming()})
    with pytest.raises(ValueError, match="in pixels, which have no length: give the scale"):
        read_film(path, rate=50.0)
    with pytest.raises(ValueError, match="it counts frames: give the rate"):
        read_film(path, scale=1e-3)
    bare = write_long(tmp_path / "bare.csv", swimming(), unit="")
    with pytest.raises(ValueError, match="do not tell their unit of length: give units"):
        read_film(bare)


def test_two_animals_are_refused_with_what_to_do(tmp_path):
    points = swimming()
    both = {"one": points, "two": points + 2.0}
    for path in (write_deeplabcut(tmp_path / "dlc.csv", both), write_sleap(tmp_path / "sleap.csv", both)):
        with pytest.raises(ValueError, match="it has 2 animals, 'one', 'two': say which one"):
            read_film(path, scale=1.0, rate=50.0)
    rows = write_long(tmp_path / "one.csv", points).read_text().splitlines()
    twice = tmp_path / "twice.csv"
    twice.write_text("\n".join([rows[0], *(row for row in rows[1:] for _ in range(2))]))
    with pytest.raises(ValueError, match="lines 2 to 3: a point stands twice in one frame: two animals"):
        read_film(twice)
    (tmp_path / "after.csv").write_text("\n".join(rows + rows[1:]))
    with pytest.raises(
        ValueError, match=r"lines 1582 to 1602: the time of a point must rise, got 0 s after 1.58 s: two animals"
    ):
        read_film(tmp_path / "after.csv")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "it is empty"),
        ("time_s,x_m,y_m\n", "a header and no row"),
        ("time_s,x_m,y_m\n0,1,two\n", "line 2: y_m must be a number, got 'two'"),
        ("time_s,x_m,y_m\n0,1\n", "line 2: a row must have 3 fields"),
        ("time_s,x_m,y_m\n,1,2\n", "line 2: time_s must be a time, got ''"),
        ("time_s,x_m,y_mm\n0,1,2\n", "one unit of length"),
        ("time_s,x_m,y_m\n0,1e200,2\n", "x_m must be at most 1e+100"),
        ("when,x,y\n0,1,2\n", "its time is not plain from ['when', 'x', 'y']"),
        ("scorer,net\nbodyparts,nose\n0,1\n", "scorer, bodyparts and coords"),
        ("frame_idx,a\n0,1\n", "nose.x, nose.y"),
    ],
)
def test_a_bad_table_is_refused_in_one_line(tmp_path, text, words):
    path = tmp_path / "fish.csv"
    path.write_text(text)
    with pytest.raises(ValueError) as error:
        read_film(path, units="m")
    assert words in str(error.value) and "fish.csv" in str(error.value) and "\n" not in str(error.value)


def test_motions_without_a_beat_are_refused():
    still = np.broadcast_to(swimming()[0], (80, 20, 2)).copy()
    with pytest.raises(ValueError, match=r"the body does not bend|does not repeat"):
        beat_of(film(still))
    wandering = np.cumsum(np.cumsum(np.random.default_rng(1).normal(size=(80, 20)), axis=0), axis=1)
    angles = 0.01 * wandering
    points = np.cumsum(0.05 * np.stack((np.cos(angles), np.sin(angles)), axis=-1), axis=1)
    with pytest.raises(ValueError, match=r"does not repeat|3 beats or more"):
        beat_of(film(points))
    with pytest.raises(ValueError, match=r"harmonics must be 1 to 5 with this film, got 9"):
        beat_of(film(swimming()), harmonics=9)
    with pytest.raises(ValueError, match=r"rigid up to 0.9 of the length leaves 1 points to bend, too few"):
        beat_of(film(swimming(arc=np.linspace(0.0, 1.0, 6))), rigid=0.9)
    assert beat_of(film(swimming(arc=np.linspace(0.0, 1.0, 6))), rigid=0.7).knots == 2
    with pytest.raises(ValueError, match=r"^fish.csv: its frames are too few for a beat, 4"):
        beat_of(film(swimming()[:4], TIMES[:4]))
    with pytest.raises(ValueError, match=r"rigid must be"):
        beat_of(film(swimming()), rigid=1.5)


def test_the_figures_of_a_swimmer_are_those_of_its_wave():
    x, times = np.linspace(0.0, 1.0, 41), np.arange(200) / 50.0
    side = 0.05 * np.exp(x - 1.0) * np.sin(2.0 * np.pi * (x[None] / 0.6 - times[:, None] / 0.5))
    along = x[None] - 0.4 * times[:, None]
    turn = np.array([[0.6, -0.8], [0.8, 0.6]])
    found = kinematics(times, np.stack((along, side), axis=-1) @ turn.T, 0.5)
    assert found.speed == pytest.approx(0.4, rel=1e-3) and found.ahead
    assert found.excursion[-1] * found.length == pytest.approx(0.1, rel=1e-2)
    assert found.wavelength * found.length == pytest.approx(0.6, rel=4e-2)  # along the arc, which is 2 % longer
    assert found.slip == pytest.approx(0.4 * 0.5 / 0.6, rel=4e-2)
    assert found.strouhal == pytest.approx(0.1 / 0.5 / 0.4, rel=2e-2)


def test_names_of_columns_may_end_with_their_unit_without_a_line(tmp_path):
    points = swimming(noise=1e-3)
    path = write_long(tmp_path / "long.csv", points)
    head, *rows = path.read_text().splitlines()
    assert "x_mm" in head
    path.write_text("\n".join([head.replace("x_mm", "mxmm").replace("y_mm", "mymm").replace("time_s", "t"), *rows]))
    assert np.allclose(read_film(path).points, points, atol=1e-9)


def test_points_of_a_row_may_have_names(tmp_path):
    points = swimming()
    whole = read_film(write_wide(tmp_path / "wide.csv", points))
    rows = (tmp_path / "wide.csv").read_text().splitlines()[1:]
    for name in ("{0}_{1}_m", "{1}_{0} [m]", "{0}.{1}_m"):
        named = [name.format(f"spine{place}", axis) for place in range(20) for axis in "xy"]
        (tmp_path / "named.csv").write_text("\n".join([",".join(["time_s", *named]), *rows]))
        found = read_film(tmp_path / "named.csv")
        assert np.array_equal(found.points, whole.points) and found.names[:2] == ("spine0", "spine1")


def test_rows_of_points_may_be_left_out_or_stand_point_by_point(tmp_path):
    points = swimming()
    head, *rows = write_long(tmp_path / "whole.csv", points).read_text().splitlines()
    whole, path = read_film(tmp_path / "whole.csv"), tmp_path / "some.csv"
    path.write_text("\n".join([head, *sorted(rows, key=lambda row: int(row.split(",")[1]))]))
    found = read_film(path)
    assert np.array_equal(found.points, whole.points) and found.names == whole.names
    path.write_text("\n".join([head, *(row for place, row in enumerate(rows) if place not in (407, 408, 1225))]))
    found, out = read_tracks(path), [(20, 7), (20, 8), (61, 5)]
    missing = np.isnan(found.animals[""]).any(axis=2)
    assert [tuple(each) for each in np.argwhere(missing)] == out and np.array_equal(found.time, whole.time)
    assert np.array_equal(found.animals[""][~missing], read_tracks(tmp_path / "whole.csv").animals[""][~missing])
    assert any("3 of 1600 points filled" in note for note in read_film(path).notes)


def test_a_coordinate_in_two_columns_is_refused_by_name(tmp_path):
    points = swimming()
    head, *rows = write_wide(tmp_path / "wide.csv", points).read_text().splitlines()
    path = tmp_path / "two.csv"
    path.write_text("\n".join([f"{head},x7_mm,y7_mm", *(f"{row},1,2" for row in rows)]))
    with pytest.raises(ValueError, match=r"two.csv.*must stand in one column, got \['[xy]7_m', '[xy]7_mm'\]"):
        read_film(path)
    path.write_text("\n".join([f"{head},error_x,error_y,error_x", *(f"{row},1,2,3" for row in rows)]))
    assert np.allclose(read_film(path).points, points)  # no point of the body
    names = ["part0", *(f"part{place}" for place in range(19))]
    with pytest.raises(ValueError, match=r"sleap.csv.*a point must stand in the columns once, got 'part0' twice"):
        read_film(write_sleap(tmp_path / "sleap.csv", {"": 1e3 * points}, names), **PIXELS)
    text = write_deeplabcut(tmp_path / "dlc.csv", {"": 1e3 * points}).read_text()
    (tmp_path / "dlc.csv").write_text(text.replace("part1,part1,part1,", "part0,part0,part0,", 1))
    with pytest.raises(ValueError, match=r"dlc.csv.*must stand in one column, got 'part0/x' twice"):
        read_film(tmp_path / "dlc.csv", **PIXELS)


@pytest.mark.parametrize("write", [write_deeplabcut, write_sleap])
def test_a_trackers_frame_needs_a_number_and_a_column_of_times_has_no_place(tmp_path, write):
    path = write(tmp_path / "fish.csv", {"": 1e3 * swimming()})
    with pytest.raises(ValueError, match=r"fish.csv.*counts frames: a column of times has no place, got 'foo'"):
        read_film(path, **PIXELS, time="foo")
    rows = path.read_text().splitlines()
    place = 1 if write is write_sleap else 0
    for cell, got in (("", "must be a number, got ''"), ("nan", "must be finite, got nan")):
        cells = rows[20].split(",")
        path.write_text("\n".join([*rows[:20], ",".join([*cells[:place], cell, *cells[place + 1 :]]), *rows[21:]]))
        with pytest.raises(ValueError, match=rf"fish.csv', line 21: .*{got}"):
            read_film(path, **PIXELS)


def test_a_stray_frame_far_behind_the_others_is_refused_by_its_time():
    times = np.append(TIMES[:-1], 2e5)
    with pytest.raises(ValueError, match=r"80 frames are too far apart .* none from 1.56 s to 200000 s"):
        beat_of(film(swimming(), times))


@pytest.mark.parametrize(("unit", "metres"), [("inch", 0.0254), ("um", 1e-6), ("km", 1e3)])
def test_lengths_have_the_units_of_all_tables(tmp_path, unit, metres):
    points = swimming()
    told = read_film(write_long(tmp_path / "told.csv", points, unit=unit, factor=1.0 / metres))
    given = read_film(write_long(tmp_path / "bare.csv", points, unit="", factor=1.0 / metres), units=unit)
    assert np.allclose(told.points, points) and np.allclose(given.points, points)


def test_pixels_by_any_of_their_names_need_a_scale(tmp_path):
    path = write_long(tmp_path / "fish.csv", swimming(), unit="pixels")
    assert np.allclose(read_film(path, units="px", scale=1e-3).points, swimming())
    with pytest.raises(ValueError, match="in pixels, which have no length"):
        read_film(path)
