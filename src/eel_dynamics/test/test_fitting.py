"""Settings fitted to many swimmers, whose errors are given here."""

from concurrent.futures import ThreadPoolExecutor

import pytest
from eel_dynamics.studies.calibration.fitting import Fitting

from eel_dynamics import Accuracy

GRIDS = (9.0, 15.0, 22.0, 30.0, 40.0)
START = Accuracy(name="start", resolution=15.0, tolerance=1e-5, kinks="jumps")


@pytest.fixture(scope="module")
def pool():
    with ThreadPoolExecutor(2) as pool:
        yield pool


def error(swimmer, setting: Accuracy) -> float:
    """Of a swimmer (in space, in time): its share of each falls with the points and the tolerance."""
    space, time = swimmer
    kinks = {"all": 0.0, "jumps": 1e-6, "none": 1e-4}[setting.kinks]
    return space * (10.0 / setting.resolution) ** 6 + time * setting.tolerance + kinks


@pytest.mark.parametrize("allowed", [1e-2, 1e-4, 1e-7])
def test_the_worst_keeps_within_what_is_allowed_and_no_looser_setting_would(pool, allowed):
    swimmers = [(1e-3 * k, 0.1 + k) for k in range(20)]
    found = Fitting(list(swimmers), error, GRIDS, pool).fitted(START, allowed)
    if allowed == 1e-7:  # 40 points are too few
        assert found is None
        return
    worst = lambda setting: max(error(swimmer, setting) for swimmer in swimmers)  # noqa: E731
    assert worst(found) <= allowed
    coarser = [each for each in GRIDS if each < found.resolution]
    looser = [Accuracy(name="", resolution=each, tolerance=found.tolerance, kinks=found.kinks) for each in coarser[-1:]]
    if found.tolerance < 6e-5:  # the loosest that the pair gets is 1e-4
        looser += [Accuracy(name="", resolution=found.resolution, tolerance=1.5 * found.tolerance, kinks=found.kinks)]
    assert all(worst(setting) > allowed for setting in looser)


def test_those_who_are_waived_do_not_count(pool):
    swimmers = [(1e-3, 1.0)] * 30 + [(1.0, 1e3)] * 2
    assert Fitting(list(swimmers), error, GRIDS, pool).fitted(START, 1e-4) is None
    few = Fitting(list(swimmers), error, GRIDS, pool, waived=2).fitted(START, 1e-4)
    alone = Fitting(swimmers[:30], error, GRIDS, pool).fitted(START, 1e-4)
    assert few == alone
    firm = Fitting(list(swimmers), error, GRIDS, pool, waived=2, may_miss=lambda swimmer: swimmer[0] < 1.0)
    assert firm.fitted(START, 1e-4) is None
    near = Fitting(list(swimmers), error, GRIDS, pool, waived=2, at_most=2.0).fitted(START, 1e-2)
    assert max(error(swimmer, near) for swimmer in swimmers) <= 2e-2
    assert near != Fitting(list(swimmers), error, GRIDS, pool, waived=2).fitted(START, 1e-2)


METHODS = ("adams", 5), ("dormand_prince", 5)


def price(setting: Accuracy) -> float:
    """Adams' steps cost one evaluation in place of six."""
    return (20.0 + setting.resolution) * setting.tolerance**-0.2 * (1.0 if setting.method == "adams" else 6.0)


def test_what_is_cheaper_and_holds_takes_the_place_of_what_was_fitted(pool):
    swimmers = [(1e-3 * k, 0.1 + k) for k in range(20)]

    def by_method(swimmer, setting):  # Adams' steps err by twice as much in time
        space, time = swimmer
        return error((space, time * (2.0 if setting.method == "adams" else 1.0)), setting)

    fitting = Fitting(list(swimmers), by_method, GRIDS, pool)
    fitted = fitting.fitted(Accuracy(name="fitted", resolution=40.0, tolerance=1e-6), 1e-4)
    assert fitted.method == "dormand_prince"
    found = fitting.cheapest(fitted, 1e-4, price, METHODS)
    assert found.method == "adams" and price(found) < 0.3 * price(fitted)
    assert max(by_method(swimmer, found) for swimmer in swimmers) <= 1e-4
    assert fitting.cheapest(found, 1e-4, price, METHODS) == found
    assert fitting.cheapest(fitted, 1e-4, lambda setting: 1.0, METHODS) == fitted  # nothing is cheaper


def test_a_lucky_tolerance_does_not_count(pool):
    """One that holds while the next below it does not."""
    lucky = 4.64e-5

    def luck(swimmer, setting):
        near = abs(setting.tolerance / lucky - 1.0) < 0.05
        return 1e-5 if near or setting.tolerance < 1.1e-5 else 1e-3

    setting = Accuracy(name="fitted", resolution=15.0, tolerance=1e-6)
    found = Fitting([0], luck, GRIDS, pool).cheapest(setting, 1e-4, price, METHODS[1:])
    assert 3e-6 < found.tolerance < 1.1e-5


def test_a_tolerance_that_leaves_the_steps_at_their_longest_is_passed_over(pool):
    """From 1e-4 down to 1e-6 the steps, and so the error, stay; points do not help, or next to nothing."""

    def capped(swimmer, setting):
        return 1e-3 * (1.0 - 1e-9 * setting.resolution) if setting.tolerance > 1.1e-6 else 1e-5

    found = Fitting([0], capped, GRIDS, pool).fitted(START, 1e-4)
    assert found is not None and found.tolerance <= 1.1e-6 and found.resolution == GRIDS[0]


def test_the_fewest_fixed_steps_that_hold(pool):
    def of_steps(swimmer, setting):
        return swimmer * setting.fixed**-4.0

    fitting = Fitting([1.0, 5.0, 2.0], of_steps, GRIDS, pool)
    assert fitting.fewest(START, (8.0, 16.0, 32.0), 1e-4) == 16.0
    assert fitting.fewest(START, (8.0,), 1e-4) is None and fitting.fewest(START, (), 1e-4) is None
