# SPDX-License-Identifier: Apache-2.0
"""Swims until the gait has settled, and what is told of means of a gait that has not."""

import pickle
import re
import warnings

import numpy as np
import pytest
from eel_dynamics.analysis.measures import measures_of
from eel_dynamics.analysis.settling import FEWEST, SETTLED, Settling, settling_of
from eel_dynamics.commands import simulate as command
from eel_dynamics.runs.settled_duration import MOST_PERIODS

from eel_dynamics import Scene, Unsettled, simulate, simulate_batch
from eel_gaits import Law, Ramp, Term, gait, straight

COARSE = {"accuracy": 1e-2, "stations": 5}


def test_what_is_left_of_a_geometric_change_is_its_sum():
    """The window alone has changed by less: a slow relaxation is not taken for a settled mean."""
    count = np.arange(3)
    for ratio in (0.5, 0.9, 0.99):
        means = 1.0 - 0.5 * ratio ** (count + 30)
        assert settling_of(means).change == pytest.approx(max(np.ptp(means), 1.0 - means[-1]) / means[-1], rel=1e-6)
    slow = 1.0 - 0.1 * 0.99**count
    assert np.ptp(slow) < SETTLED < settling_of(slow).change


def test_a_coast_down_never_settles():
    """A speed U / (1 + k t) falls by ever less a period, and to nothing."""
    for begin in (10, 100, 1000):
        assert settling_of(1.0 / (begin + np.arange(6.0))).change > 0.4


@pytest.mark.parametrize(
    "means, wanted",
    [
        ([1.0, 1.002, 1.0], 0.002),  # back again
        ([1.0, 1.002, 1.004], np.inf),  # on and on
        ([1.0, 1.00002, 1.00004], 0.00004),  # below its own error
        ([0.9985, 0.9999, 1.0, 1.00002, 1.00004], 0.00154),  # likewise, after greater changes
        ([0.0, 0.0, 0.0], np.inf),
        ([1.0, 1.0], np.inf),  # two do not tell how the changes fall
    ],
)
def test_changes_that_do_not_fall(means, wanted):
    assert settling_of(means).change == pytest.approx(wanted, rel=1e-2)


def test_the_figures_told_agree_with_the_judgement():
    """Whatever the change: rounded, it stays on its own side of the bound."""
    for within in (0.0, 0.99 * SETTLED, SETTLED, SETTLED * (1.0 + 1e-6), 0.01004, np.nextafter(SETTLED, 1.0), 3.0):
        found = Settling(FEWEST, within, 0.0)
        told = re.match(
            r"the mean speed changes by (?:less than )?([\d.]+)% over 3 periods, and less than 0.01% is", str(found)
        )
        assert found.settled == (within <= SETTLED) == (float(told.group(1)) <= 100.0 * SETTLED)
    assert (
        str(Settling(4, 0.002, np.inf)) == "the mean speed changes by 0.20% over 4 periods, and its changes do not fall"
    )
    assert str(settling_of([1.0, 1.0])) == "it takes 3 periods to tell, got 2"


def test_summary_warning_and_measure_tell_one_judgement():
    """Of any periods: the summary's line has the figures of the warning, and the verdict of the measure."""
    swum = simulate(straight(), 12.0, **COARSE)
    for periods in (None, 1, 2, 5, 11):
        run = pickle.loads(pickle.dumps(swum))
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            found = run.analysis(periods)
        verdict, _, figures = line_of(run.summary(periods)).partition(": ")
        assert verdict == ("settled" if found.settled else "NOT settled")
        assert measures_of(run, ("settled",), periods)["settled"] == found.settled == (not told)
        assert not told or f": {figures};" in str(told[0].message)
    assert line_of(simulate(straight(), 2.0, **COARSE).summary()).startswith("NOT settled: it takes 3 periods to tell")


def line_of(summary: str) -> str:
    """What a summary says of the gait."""
    return next(line.partition(" ")[2].strip() for line in summary.splitlines() if line.startswith("gait "))


@pytest.mark.parametrize("name, numbers", [("straight", {"period": 0.7}), ("turning", {}), ("c_start", {})])
def test_a_settled_swim_has_the_means_of_a_long_one(name, numbers):
    run = simulate(gait(name, **numbers), "settled", **COARSE)
    with warnings.catch_warnings():
        warnings.simplefilter("error", Unsettled)
        found = run.analysis()
    later = simulate(gait(name, **numbers), 3.0 * run.time[-1], **COARSE).analysis(2)
    assert found.settled and found.mean_speed == pytest.approx(later.mean_speed, rel=2.0 * SETTLED)
    assert found.actuator_power == pytest.approx(later.actuator_power, rel=2.0 * SETTLED)


def test_it_begins_to_count_after_the_last_ramp():
    turn = Term(axis="yaw", amplitude=(0.5,), envelope=(Ramp(25.0, 26.0, 1.0),))
    run = simulate(Law(*straight().terms, turn), "settled", **COARSE)
    assert run.analysis().window.start >= 26.0 - 0.05 and run.analysis().settled


def test_a_current_does_not_count():
    still_water = simulate(straight(period=0.8), "settled", **COARSE)
    drifting = {"scene": Scene(current=(0.3, 0.1, 0.0)), "twist": (0.0, 0.0, 0.0, 0.3, 0.1, 0.0)}  # with the water
    assert simulate(straight(period=0.8), "settled", **drifting, **COARSE).time[-1] == still_water.time[-1]


def test_a_body_at_rest_has_settled():
    wave = Term(axis="yaw", amplitude=(0.0,), wavelength=1.0, period=1.0)
    run = simulate(Law(wave, name="rest"), "settled", **COARSE)
    assert run.time[-1] < 0.2 * MOST_PERIODS and run.mean_speed == 0.0


def test_what_does_not_settle_ends_at_the_limit():
    """A wave that ends leaves a body that coasts, ever more slowly."""
    ends = Term(
        axis="yaw",
        amplitude=(2.0,),
        wavelength=0.9,
        period=1.0,
        envelope=(Ramp(0.0, 1.0, 1.0), Ramp(5.0, 6.0, -1.0)),
    )
    run = simulate(Law(ends, name="coasting"), "settled", scene=Scene(ledger=False), **COARSE)
    assert run.time[-1] == pytest.approx(MOST_PERIODS)
    with pytest.warns(
        Unsettled, match=r"coasting: the gait has not settled: the mean speed changes by [\d.]+% over 50 p"
    ):
        run.analysis()


@pytest.mark.parametrize(
    "law, said",
    [
        (gait("still"), "duration 'settled' needs a gait that repeats: law 'still' has no periodic term"),
        (lambda time, x: 0.0 * x, "duration 'settled' needs a Law, whose terms tell its period, got"),
        (
            Law(*straight().terms, Term(axis="pitch", amplitude=(0.5,), period=np.pi), name="x"),
            "duration 'settled' needs a gait that repeats: law 'x' does not repeat within 12 periods",
        ),
    ],
)
def test_a_law_without_a_period_is_refused(law, said):
    with pytest.raises(ValueError, match=said):
        simulate(law, "settled")


def test_a_reader_of_a_mean_is_told_once():
    run = simulate(straight(), 3.0, **COARSE)
    with pytest.warns(Unsettled, match="straight: the gait has not settled") as told:
        assert run.mean_speed == run.analysis().mean_speed == run.mean_speed
    assert len(told) == 1 and told[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert "NOT settled" in run.summary() and run.warnings == ()
        assert "_told_unsettled" not in pickle.loads(pickle.dumps(run)).__dict__


def test_a_batch_swims_until_the_slowest_has_settled():
    laws = [straight(), gait("rolling")]
    alone = [simulate(law, "settled", **COARSE).time[-1] for law in laws]
    batch = simulate_batch(laws, "settled", **COARSE)
    assert batch.time[-1] == pytest.approx(max(alone)) and batch[0].analysis().settled and batch[1].analysis().settled


def test_a_table_of_a_batch_tells_what_has_not_settled():
    batch = simulate_batch([straight(), gait("rolling")], 20.0, **COARSE)
    with pytest.warns(Unsettled, match="1 of 2 swimmers have not settled"):
        assert batch.analysis().settled.tolist() == [1.0, 0.0]


def test_the_command_swims_until_it_has_settled(capsys):
    assert command.main(["straight", "--accuracy", "1e-2", "--duration", "settled"]) == 0
    assert "gait                settled" in capsys.readouterr().out
    with pytest.raises(SystemExit):
        command.main(["straight", "--duration", "soon"])
    assert "must be a number of seconds, or settled, got 'soon'" in capsys.readouterr().err
