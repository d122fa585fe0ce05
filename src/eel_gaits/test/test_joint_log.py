# SPDX-License-Identifier: Apache-2.0
"""Logs of robots' joints: whatever the form of the file, the angles that went in come out; bad data are told."""

import numpy as np
import pytest
from eel_gaits.sources.joint_log import law_of_links, read_joint_log

TIME = np.arange(0.0, 6.0, 0.02)
ANGLES = 0.4 * np.sin(2.0 * np.pi * (TIME[:, None] - 0.15 * np.arange(5)))  # rad, (N, 5)
PLACES = np.array([0.3, 0.4, 0.55, 0.7, 0.8])


def write(path, head, columns, before=()):
    rows = [",".join(f"{value:.6f}" for value in row) for row in np.column_stack(columns)]
    path.write_text("\n".join([*before, *([",".join(head)] if head else []), *rows]) + "\n")
    return path


def test_all_forms_of_logs_give_the_same_angles(tmp_path):
    degrees, set_points = np.degrees(ANGLES), np.zeros_like(ANGLES)
    names = [f"joint_{place}" for place in range(1, 6)]
    back = [f"{place}FbckPosition[rad]" for place in range(5)]
    logs = [
        read_joint_log(write(tmp_path / "a.csv", ["time", *names], (TIME, ANGLES))),
        read_joint_log(write(tmp_path / "b.csv", ["t", *names], (TIME, degrees)), unit="deg"),
        read_joint_log(write(tmp_path / "c.csv", ["time_s", *(f"{name}_deg" for name in names)], (TIME, degrees))),
        read_joint_log(write(tmp_path / "d.csv", [], (TIME, set_points, degrees)), columns="7-11", unit="deg"),
        read_joint_log(write(tmp_path / "e.csv", ["time", *names], (TIME, ANGLES[:, ::-1])), tail_first=True),
        read_joint_log(
            write(
                tmp_path / "f.csv",
                ["stamp_ts[s]", "stamp_ts[us]", *(f"{name}Goal" for name in names), *back],
                (100.0 + np.floor(TIME), 1e6 * (TIME % 1.0), set_points, ANGLES),
                before=["motors,frequency", "5,1.0"],
            )
        ),
        read_joint_log(
            write(tmp_path / "g.csv", ["header.stamp", *(f"position[{j}]" for j in range(5))], (7.0 + TIME, ANGLES))
        ),
    ]
    for log in logs:
        assert np.allclose(log.angles, ANGLES, atol=2e-6) and np.allclose(log.time, TIME, atol=2e-6), log.name
        assert not log.notes


def test_rows_that_do_not_fit_and_readings_that_jump_are_told(tmp_path):
    jumped = ANGLES.copy()
    jumped[[40, 90, 200], [1, 3, 0]] += 0.5
    path = write(tmp_path / "log.csv", ["time", *(f"q{j}" for j in range(5))], (TIME, jumped))
    lines = path.read_text().splitlines()
    lines[60] = lines[60].rpartition(",")[0]  # a column short
    lines.insert(121, lines[120])  # a row twice
    path.write_text("\n".join(lines))
    log = read_joint_log(path)
    told = "; ".join(log.notes)
    assert "1 rows left out, the first in line 61: they have another number of cells" in told
    assert "1 rows left out, the first in line 122: they stand there twice" in told
    assert f"3 of {log.angles.size} readings have jumped" in told
    assert np.allclose(log.angles, np.delete(ANGLES, 59, axis=0), atol=2e-3)


STAMPS = {
    "a clock set back": (np.where(TIME < 3.0, TIME, TIME - 2.5), 0, "the clock is set back by 2.48 s in line 152"),
    "a clock that wraps": (TIME % 3.0, 0, "the clock is set back by 2.98 s in line 152"),
    "one stamp ahead": (np.where(np.arange(300) == 150, 1e9, TIME), 1, "1 rows left out, the first in line 152"),
    "one stamp behind": (np.where(np.arange(300) == 150, 0.0, TIME), 1, "1 rows left out, the first in line 152"),
    "one that is missing": (
        np.where(np.arange(300) == 150, np.nan, TIME),
        1,
        "line 152: a time or an angle is missing",
    ),
    "one that comes twice": (np.where(np.arange(300) == 150, 2.98, TIME), 1, "1 rows left out, the first in line 152"),
}


@pytest.mark.parametrize("what", STAMPS)
def test_bad_stamps_are_mended_and_told(tmp_path, what):
    time, lost, words = STAMPS[what]
    log = read_joint_log(write(tmp_path / "log.csv", ["time", *(f"q{j}" for j in range(5))], (time, ANGLES)))
    kept = np.delete(np.arange(300), 150) if lost else np.arange(300)
    assert np.allclose(log.time, TIME[kept]) and np.allclose(log.angles, ANGLES[kept], atol=2e-6)
    assert len(log.notes) == 1 and words in log.notes[0]
    assert ("clock" in what) == ("if these are two logs" in log.notes[0])  # which look the same


@pytest.mark.parametrize(
    ("time", "angles", "words"),
    [
        (
            np.where(TIME < 3.0, TIME, TIME - 3.0),
            np.where(TIME[:, None] < 3.0, 1.0, -1.0) * ANGLES,
            "two logs in one file",
        ),
        (np.floor(5.0 * TIME) / 5.0, ANGLES, "only 30 of its 300 rows can be read: 270 rows left out"),
        (TIME, np.where(TIME[:, None] < 5.0, ANGLES, np.nan), "only 250 of its 300 rows can be read"),
        (np.where(TIME < 5.0, TIME, np.nan), ANGLES, "only 250 of its 300 rows can be read"),
        (1e3 * TIME, ANGLES, r"rad/s \(RMS\) in steps of 20 s: time in s\?.*--clock 0.001"),
        (1e-3 * TIME, ANGLES, r"rad/s \(RMS\) in steps of 2e-05 s: time in s\?.*--clock 1000"),
    ],
)
def test_half_a_log_or_another_clock_is_refused(tmp_path, time, angles, words):
    path = write(tmp_path / "log.csv", ["time", *(f"q{j}" for j in range(5))], (time, angles + 0.1 * TIME[:, None]))
    with pytest.raises(ValueError, match=words):
        read_joint_log(path)
    if "--clock" in words:
        assert read_joint_log(path, clock=float(words.split()[-1])).time[-1] == pytest.approx(TIME[-1], rel=1e-3)


def test_joints_of_one_topic_are_found_among_others(tmp_path):
    head = [
        "__time",
        *(f"/{topic}/joint_{j}/position" for topic in ("joint_commands", "joint_states") for j in range(5)),
    ]
    rows = []
    for time, row in zip(TIME, ANGLES, strict=True):
        cells = ",".join(f"{value:.6f}" for value in row)
        rows += [f"{1.7e9 + time:.3f},{cells},,,,,", f"{1.7e9 + time + 0.003:.3f},,,,,,{cells}"]
    path = tmp_path / "log.csv"
    path.write_text("\n".join([",".join(head), *rows]))
    for columns in ("", "*states*", "7-11"):
        log = read_joint_log(path, columns=columns)
        assert np.allclose(log.angles, ANGLES, atol=2e-6) and np.allclose(log.time, TIME, atol=2e-6)
        assert "joints /joint_states/joint_0/position to" in log.read and "300 rows of other topics" in log.read
    path.write_text(path.read_text().replace("commands", "others"))
    with pytest.raises(ValueError, match=r"may be any of .*give --columns '/joint_others/joint_\*/position'"):
        read_joint_log(path)


def test_joints_of_two_topics_are_brought_to_one_time(tmp_path):
    head = ["__time", *(f"/front/joint_{j}/position" for j in range(3)), *(f"/rear/joint_{j}/position" for j in (3, 4))]
    rows = []
    for time, row in zip(TIME, ANGLES, strict=True):
        later = 0.4 * np.sin(2.0 * np.pi * (time + 0.004 - 0.15 * np.arange(5)))
        rows.append(f"{time:.3f}," + ",".join(f"{value:.6f}" for value in row[:3]) + ",,")
        rows.append(f"{time + 0.004:.3f},,,," + ",".join(f"{value:.6f}" for value in later[3:]))
    path = tmp_path / "log.csv"
    path.write_text("\n".join([",".join(head), *rows]))
    log = read_joint_log(path)
    assert np.allclose(log.angles, ANGLES[1:], atol=1e-5) and np.allclose(log.time, TIME[:-1])
    assert "joints of several topics" in log.read and "1 rows left out, the first in line 2" in log.notes[0]


def test_the_law_of_links_keeps_each_angle_where_its_joint_lies(tmp_path):
    log = read_joint_log(write(tmp_path / "log.csv", ["time", *(f"q{j}" for j in range(5))], (TIME, ANGLES)))
    law = law_of_links(log, PLACES, 1.0)
    bend, x = law.values[150, 1, 0], law.x
    ends = 0.5 * (PLACES[1:] + PLACES[:-1])
    assert np.allclose(bend[x < 0.19], 0.0) and np.allclose(bend[x > 0.91], 0.0)  # rigid links
    total = np.trapezoid(bend, x)
    assert total == pytest.approx(ANGLES[150].sum(), abs=1e-4)
    before = np.trapezoid(np.where(x <= ends[1], bend, 0.0), x)
    assert before == pytest.approx(ANGLES[150, :2].sum(), abs=0.15)  # some of the neighbours reaches over


@pytest.mark.parametrize(
    ("head", "factor", "options", "words"),
    [
        (["time", *(f"q{j}" for j in range(5))], 57.3, {}, "at most 3.2 rad, got 22.9.*give --units deg"),
        (["time", *"abcde"], 1.0, {}, "give --columns"),
        (["time", *"abcde"], 1.0, {"columns": "4-9"}, "among the 6 of the file, each once, got '4-9'"),
        (["time", *"abcde"], 1.0, {"columns": "a"}, "2 joints in 16 rows or more, got 1 in 300"),
        (["time", *(f"q{j}" for j in range(5))], 1.0, {"unit": "turns"}, "rad or deg, got 'turns'"),
        (["time", *(f"q{j}" for j in range(5))], 1.0, {"clock": 0}, "clock must be > 0, got 0"),
        (
            ["time", "q0 [deg]", *(f"q{j}" for j in range(1, 5))],
            1.0,
            {"columns": "2-6"},
            "q1 must have a unit in its name, as q0 .deg. has",
        ),
        (["time", *(f"q{j}_deg" for j in range(5))], 600.0, {}, "at most 3.2 rad, got 4.18.*: is it in deg"),
        (["time", *(f"q{j} [turns]" for j in range(5))], 1.0, {}, "q0 .turns. must have a known unit in brackets"),
    ],
)
def test_a_log_that_does_not_fit_is_refused_in_a_sentence(tmp_path, head, factor, options, words):
    with pytest.raises(ValueError, match=words):
        read_joint_log(write(tmp_path / "log.csv", head, (TIME, factor * ANGLES)), **options)


def test_joints_must_lie_within_the_body_and_gaps_are_told(tmp_path):
    log = read_joint_log(write(tmp_path / "log.csv", ["time", *(f"q{j}" for j in range(5))], (TIME, ANGLES)))
    for places, words in ((PLACES[:4], "joints must be 5 places"), (PLACES + 0.3, "between 0 and the length 1 m")):
        with pytest.raises(ValueError, match=words):
            law_of_links(log, places, 1.0)
    kept = (TIME < 2.0) | (TIME > 2.4)
    with pytest.raises(ValueError, match=r"log.csv: .*a gap of 0.4\d* s at"):
        law_of_links(log._replace(time=TIME[kept], angles=ANGLES[kept]), PLACES, 1.0)
