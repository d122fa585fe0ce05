# SPDX-License-Identifier: Apache-2.0
"""The parts of the dynamics node that need no ROS process: parameters, pace, /clock, reports, laws, run loop."""

import math
import threading
from dataclasses import fields
from types import SimpleNamespace

import pytest
from eel_dynamics.ros import clock_arbiter
from eel_dynamics.ros.clock_arbiter import ClockArbiter, ClockMonitor
from eel_dynamics.ros.diagnostics import ERROR, OK, WARN, Report
from eel_dynamics.ros.loop.clock_ticks import ClockTicks
from eel_dynamics.ros.loop.law_feed import LawAdopter, LawFeed
from eel_dynamics.ros.loop.pacing import Pace
from eel_dynamics.ros.loop.run_loop import RunLoop
from eel_dynamics.ros.parameters import DynamicsParameters, checked, from_values
from eel_dynamics.ros.publishers import Publishers, WaitBudget
from eel_dynamics.ros.swimmer_arbiter import Identity, SwimmerArbiter
from eel_ros.parameters import default_of

from eel_dynamics import Scene, Simulation
from eel_gaits import Law, falling


class Log:
    def __init__(self):
        self.lines = []

    def info(self, text):
        self.lines.append(("info", text))

    def warning(self, text):
        self.lines.append(("warning", text))

    def error(self, text):
        self.lines.append(("error", text))


# parameters


@pytest.mark.parametrize("kind", [DynamicsParameters, Scene])
def test_defaults_pass_their_own_checks(kind):
    values = {item.name: default_of(item) for item in fields(kind)}
    assert from_values(kind, values) == kind()


@pytest.mark.parametrize("kind", [DynamicsParameters, Scene])
def test_every_parameter_is_described(kind):
    for item in fields(kind):
        assert item.metadata["description"] and "unit" in item.metadata, item.name


@pytest.mark.parametrize("kind", [DynamicsParameters, Scene])
def test_every_float_takes_an_integer(kind):
    for item in fields(kind):
        if isinstance(item.default, float) or item.default is None:
            number = checked(item, 1, item.name)
            assert number == 1.0 and isinstance(number, float), item.name
        if isinstance(item.default, tuple):
            assert checked(item, [1] * len(item.default), item.name) == (1.0,) * len(item.default)


@pytest.mark.parametrize(
    ("name", "value", "expected"),
    [
        ("rate", 0, "rate must be > 0 Hz and <= 10000 Hz, got 0"),
        ("rate", -5.0, "rate must be > 0 Hz and <= 10000 Hz, got -5"),
        ("rate", math.nan, "rate must be a finite number, got nan"),
        ("rate", "fast", "rate must be a finite number, got 'fast'"),
        ("rate", True, "rate must be a finite number, got True"),
        ("real_time_factor", -1.0, "real_time_factor must be >= 0 and <= 1e+06, got -1"),
        ("stations", 1, "stations must be >= 2 and <= 10000, got 1"),
        ("stations", 51.0, "stations must be an integer, got 51.0"),
        ("clock", 1, "clock must be true or false, got 1"),
        ("body", 3, "body must be a text, got 3"),
        ("accuracy", [1.0], "accuracy must be a text or a number, got [1.0]"),
        ("initial_position", [0.0, 1.0], "initial_position must be 3 finite numbers, got [0.0, 1.0]"),
        ("initial_position", [0.0, 1.0, math.inf], "initial_position must be 3 finite numbers, got [0.0, 1.0, inf]"),
        ("initial_position", 1.0, "initial_position must be 3 finite numbers, got 1.0"),
        (
            "initial_orientation",
            [0.0, 0.0, 0.0, 2.0],
            "initial_orientation must be a unit quaternion, got [0.0, 0.0, 0.0, 2.0] of norm 2",
        ),
        ("world_frame", "", "world_frame must not be empty"),
    ],
)
def test_bad_parameter_is_named_with_its_value(name, value, expected):
    values = {item.name: default_of(item) for item in fields(DynamicsParameters)} | {name: value}
    with pytest.raises(ValueError) as caught:
        from_values(DynamicsParameters, values)
    assert str(caught.value) == expected


def test_rounded_quaternion_is_made_unit():
    values = DynamicsParameters(initial_orientation=(0.0, 0.0, 0.7071, 0.7071))
    assert math.hypot(*values.initial_orientation) == pytest.approx(1.0, abs=1e-15)


def test_number_of_samples():
    assert DynamicsParameters(duration=10.0, rate=100.0).last_sample == 1000
    assert DynamicsParameters(duration=0.3, rate=10.0).last_sample == 3
    assert DynamicsParameters(duration=0.35, rate=10.0).last_sample == 3
    assert DynamicsParameters().last_sample == math.inf


# pace


def test_pace_gives_due_times():
    pace = Pace(0.01, 2.0)
    pace.restart(5, 100.0)
    assert pace.due(5) == 100.0 and pace.due(9) == pytest.approx(100.02)
    pace.restart(9, 200.0, 0.5)
    assert pace.due(10) == pytest.approx(200.02)


def test_pace_keeps_small_delays_and_gives_up_great_ones():
    pace = Pace(0.01, 1.0)
    pace.restart(0, 0.0)
    assert pace.give_up_delay(1, 0.03) == 0.0 and pace.due(2) == pytest.approx(0.02)  # will be caught up with
    assert pace.give_up_delay(2, 1.02) == pytest.approx(1.0)
    assert pace.lost == pytest.approx(1.0) and pace.due(3) == pytest.approx(1.03)


def test_no_pace_is_never_late():
    pace = Pace(0.01, 0.0)
    pace.restart(0, 50.0)
    assert pace.due(1000) == -math.inf and pace.give_up_delay(1000, 1e9) == 0.0


# the right to /clock


def race(first_age, own, other, leaves):
    """Who publishes in the end, of two that meet; `leaves`: whether the other follows the same rules."""
    ours, theirs = ClockArbiter(), ClockArbiter()
    now, ours_on, theirs_on = 0.0, ours.judge(0.0, (), set()), False
    while now < 40.0:
        now += 0.25
        if now == first_age:
            theirs_on = True if not leaves else theirs.judge(now, (), set())
        seen = now > first_age + 1.0  # discovery takes a second
        ours_on_before = ours_on
        ours_on = ours.judge(now, own if ours_on else (), {other} if theirs_on and seen else set())
        if leaves and now > first_age:
            theirs_on = theirs.judge(now, other if theirs_on else (), {own} if ours_on_before and seen else set())
    return ours_on, theirs_on


@pytest.mark.parametrize("own", [(1,), (3,)])
def test_the_older_of_two_keeps_the_clock(own):
    assert race(20.0, own, (2,), leaves=True) == (True, False)


@pytest.mark.parametrize("own", [(1,), (3,)])
def test_of_two_that_start_together_one_publishes(own):
    assert sorted(race(0.5, own, (2,), leaves=True)) == [False, True]


@pytest.mark.parametrize("own", [(1,), (3,)])
@pytest.mark.parametrize("age", [0.5, 20.0])
def test_a_publisher_that_never_leaves_gets_the_clock(own, age):
    assert race(age, own, (2,), leaves=False) == (False, True)


def test_the_clock_comes_back_when_the_other_is_gone():
    right = ClockArbiter()
    assert not right.judge(0.0, (), {(1,)})
    assert right.judge(1.0, (), set())


def test_a_node_that_stops_publishing_the_clock_logs_it_once(monkeypatch):
    now, publishers, log = [0.0], {}, Log()
    monkeypatch.setattr(clock_arbiter.time, "monotonic", lambda: now[0])
    node = SimpleNamespace(
        get_publishers_info_by_topic=lambda topic: list(publishers.values()),
        get_name=lambda: "dynamics",
        get_namespace=lambda: "/",
    )

    def publisher(number, name):
        return SimpleNamespace(endpoint_gid=(number,), node_namespace="/", node_name=name)

    def offer(publishing):
        publishers.pop(2, None)
        if publishing:
            publishers[2] = publisher(2, "dynamics")

    monitor = ClockMonitor(node, offer, Report(log, lambda: now[0]))
    monitor.look(True)
    publishers[1] = publisher(1, "simulator")
    for _ in range(100):
        now[0] += 0.25
        monitor.look(True)
    stops = [entry for entry in log.lines if "stops" in entry[1]]
    assert stops == [("warning", "this node stops publishing /clock, which /simulator publishes too")]
    assert 2 not in publishers


# swimmers


class Network:
    """Arbiters that get each other's diagnostics, once a second."""

    def __init__(self, *identities):
        self.time = 0.0
        self.logs = [Log() for _ in identities]
        self.held = [[] for _ in identities]
        self.arbiters = [
            SwimmerArbiter(each, "/head_pose", Report(log), held.append, lambda: self.time)
            for each, log, held in zip(identities, self.logs, self.held, strict=True)
        ]

    def run(self, seconds, present):
        for _ in range(seconds):
            self.time += 1.0
            for sender in present:
                for each in self.arbiters:
                    each.receive("/dynamics", self.arbiters[sender].values())
            for each in self.arbiters:
                each.look()


def test_of_two_nodes_with_the_same_topics_the_later_one_waits_until_the_other_has_gone():
    first, second = Identity("2026-01-01T00:00:00", "a", "7"), Identity("2026-01-01T00:00:01", "a", "8")
    network = Network(second, first)
    network.run(3, present=(0, 1))
    later, earlier = network.arbiters
    assert later.waits and not earlier.waits
    assert network.held == [["waiting until /dynamics has gone"], []]
    ((level, text),) = network.logs[0].lines
    assert level == "error" and "process 7" in text and "this node waits" in text
    ((level, text),) = network.logs[1].lines
    assert level == "error" and "/dynamics (host a, process 8, started 2026-01-01T00:00:01)" in text
    network.run(4, present=(0,))
    assert later.waits
    network.run(2, present=(0,))
    assert not later.waits and network.held == [["waiting until /dynamics has gone", ""], []]
    assert network.logs[0].lines[1:] == [("info", "no other node publishes /head_pose any more")]


def test_a_node_ignores_itself_other_swimmers_and_statuses_of_other_kinds():
    arbiter = SwimmerArbiter(Identity("b", "b", "2"), "/head_pose", Report(Log()), lambda reason: None)
    arbiter.receive("/dynamics", arbiter.values())
    arbiter.receive("/eel2/dynamics", {"swimmer": "/eel2/head_pose", "started": "a", "host": "a", "process": "1"})
    arbiter.receive("/camera", {"swimmer": "/head_pose", "started": "a"})
    arbiter.look()
    assert not arbiter.waits


# reports


def test_lasting_condition_is_logged_once_and_shown_while_it_lasts():
    log = Log()
    report = Report(log)
    for _ in range(3):
        report.begin("laws", "two publishers")
    assert log.lines == [("warning", "two publishers")] and report.state() == (WARN, ["two publishers"])
    report.end("laws", "one again")
    report.end("laws", "one again")
    assert log.lines[1:] == [("info", "one again")] and report.state() == (OK, [])


def test_event_is_logged_at_most_once_a_second():
    now = [0.0]
    log = Log()
    report = Report(log, lambda: now[0])
    for step in range(25):
        now[0] = 0.1 * step
        report.event("late", f"late at {step}")
    assert [text for _, text in log.lines] == ["late at 0", "late at 10", "late at 20"]
    assert report.state() == (WARN, ["late at 24"])
    now[0] = 10.0
    assert report.state() == (OK, [])


def test_differing_events_are_all_logged_if_asked():
    log = Log()
    report = Report(log, lambda: 0.0)
    for text in ("one", "one", "two"):
        report.event("law", text, ERROR, differing=True)
    assert log.lines == [("error", "one"), ("error", "two")]
    assert report.state()[0] == ERROR


def test_patience_is_one_account_for_all_topics():
    patience = WaitBudget()
    patience.begin(0.0)
    assert not patience.over(4.9, 5.0) and patience.over(5.0, 5.0)
    patience.begin(5.1)
    assert patience.over(5.2, 5.0)  # the next topic of the same subscriber: no further wait
    patience.begin(100.0)
    assert not patience.over(104.0, 5.0)
    patience.renew()
    patience.begin(104.5)
    assert not patience.over(109.0, 5.0)


# laws as received


class FakeRun:
    def __init__(self, time=0.0):
        self.time, self.laws = time, []

    def take_law(self, law, origin):
        self.laws.append((law, origin))


def message(name="wave", sec=0, nanosec=0):
    return SimpleNamespace(name=name, header=SimpleNamespace(stamp=SimpleNamespace(sec=sec, nanosec=nanosec)))


def feed(run, log, law_of=lambda message: Law(name=message.name)):
    def opened(message):
        return message.name, lambda: message

    return LawFeed(run, Report(log), parse=opened, law_of=law_of, samples_of=None)


def info(number):
    return {"source_timestamp": 1000 + number, "publication_sequence_number": number}


def test_a_law_delivered_twice_is_adopted_once():
    run = FakeRun()
    law_feed = feed(run, Log())
    for number, name in ((1, "a"), (2, "b"), (1, "a"), (2, "b"), (3, "a")):
        law_feed.receive_law(message(name), info(number))
    assert [law.name for law, _ in run.laws] == ["a", "b", "a"]


def test_origin_is_the_stamp():
    run = FakeRun()
    feed(run, Log()).receive_law(message(sec=3, nanosec=500_000_000), info(1))
    assert run.laws[0][1] == 3.5


@pytest.mark.parametrize(
    ("stamp", "words"),
    [
        ({"sec": -1}, ("header.stamp", "-1")),
        ({"nanosec": 2_000_000_000}, ("header.stamp", "2000000000")),
        ({"sec": 1_700_000_000}, ("1700000000", "wall time", "use_sim_time")),
        ({"sec": 3611}, ("3611",)),
    ],
)
def test_bad_stamp_is_refused(stamp, words):
    run, log = FakeRun(time=10.0), Log()
    feed(run, log).receive_law(message(**stamp), info(1))
    assert not run.laws
    ((level, text),) = log.lines
    assert level == "error" and all(word in text for word in words), text


def test_stamp_up_to_an_hour_ahead_is_taken():
    run = FakeRun(time=10.0)
    feed(run, Log()).receive_law(message(sec=3609), info(1))
    assert run.laws[0][1] == 3609.0


def test_bad_law_is_one_error_that_names_the_field():
    def refuse(message):
        raise ValueError("terms[0].period must be >= 0 s, got -1.0")

    run, log = FakeRun(), Log()
    law_feed = feed(run, log, refuse)
    law_feed.receive_law(message("jump"), info(1))
    assert not run.laws
    assert log.lines == [("error", "law 'jump' refused: terms[0].period must be >= 0 s, got -1.0")]


@pytest.mark.fault(
    "samples",
    "a law that arrives while samples drive the body",
    "the law is adopted; one warning names the samples lost",
)
@pytest.mark.parametrize("last", [0.0, 0.5])
def test_a_law_that_replaces_samples_says_which_it_drops(last):
    simulation, log = Simulation(scene=Scene(planar=True)), Log()
    adopter = LawAdopter(simulation, Report(log))
    rows = {name: [0.0, 0.0] for name in ("pitch", "pitch_rate", "pitch_accel", "yaw", "yaw_rate", "yaw_accel")}
    adopter.adopt(falling(pitch_bend=0.0), 0.0)
    for time in (0.1, 0.2, last) if last else ():
        adopter.add_samples({"time": time, "x": [0.0, 1.0], **rows})
    adopter.adopt(Law(name="next"), 0.0)
    warnings = [text for level, text in log.lines if level == "warning"]
    assert warnings == ["curvature samples up to t = 0.5 s are dropped: law 'next' is newer"][: bool(last)]
    assert log.lines[-1 - bool(last)] == ("info", "law 'next' adopted at t = 0 s")


# topics


@pytest.mark.fault(
    "subscribers", "a subscriber of a costly topic that comes while a sample is made", "it gets the next sample"
)
def test_a_subscriber_that_comes_after_the_snapshot_was_taken(monkeypatch):
    """Nobody subscribes when it is asked what to compute; somebody does when it is published."""
    monkeypatch.setattr("eel_dynamics.ros.publishers.COUNT_PERIOD", 0.0)
    received, audience = [], {"internal_wrench": 0, "hydrodynamic_load": 0, "energy": 0}
    sample = SimpleNamespace(
        kinds=dict.fromkeys(audience, str),
        set_time=lambda nanoseconds: None,
        fill=lambda name, snapshot: (name, snapshot.torque, snapshot.fluid_force),
    )

    def create(kind, topic, depth):
        return SimpleNamespace(get_subscription_count=lambda: audience[topic], publish=received.append)

    publishers = Publishers(
        sample, create=create, destroy=None, known=None, received=None, publish_error=RuntimeError,
        values=DynamicsParameters, stopped=lambda: False, report=Report(Log()),
    )  # fmt: skip
    assert publishers.wanted_parts() == {"wrench": False, "load": False}
    audience.update(dict.fromkeys(audience, 1))
    publishers.publish(SimpleNamespace(torque=None, fluid_force=None), 0)
    assert received == []
    assert publishers.wanted_parts() == {"wrench": True, "load": True}
    publishers.publish(SimpleNamespace(torque=1, fluid_force=2), 0)
    assert [name for name, *_ in received] == ["internal_wrench", "hydrodynamic_load", "energy"]


@pytest.mark.parametrize("factor", [0.0, 1.0])
def test_subscribers_that_are_waited_for_are_counted_on_each_topic(factor):
    """At real time too. Those of some topics alone are complete when none has come for a while."""
    audience = dict.fromkeys(("head_pose", "backbone", "swim_state"), 0)
    publishers = Publishers(
        SimpleNamespace(kinds=dict.fromkeys(audience, str)), destroy=None, known=None, received=None,
        create=lambda kind, topic, depth: SimpleNamespace(get_subscription_count=lambda: audience[topic]),
        publish_error=RuntimeError, values=lambda: DynamicsParameters(real_time_factor=factor),
        stopped=lambda: False, report=Report(Log()),
    )  # fmt: skip
    assert not publishers.subscribers_complete(2, 10.0)
    audience["head_pose"] = 5
    assert not publishers.subscribers_complete(2, 11.0)  # five of one topic are not two of each
    audience["backbone"] = 1
    assert not publishers.subscribers_complete(2, 12.9) and not publishers.subscribers_complete(2, 13.8)
    audience["backbone"] = 2
    assert publishers.subscribers_complete(2, 13.9)  # nobody has to plot
    audience["backbone"] = 1
    assert not publishers.subscribers_complete(2, 14.0) and publishers.subscribers_complete(2, 15.1)


def test_who_was_given_up_does_not_cost_the_others_the_end_of_a_run(monkeypatch):
    """Its topic gets a short farewell; on the others a backlog is waited for as long as without it."""
    monkeypatch.setattr("eel_dynamics.ros.publishers.END_TIMEOUT", 0.0)
    asked = []

    def received(publisher, seconds):
        asked.append(publisher)
        return publisher == "head_pose" and asked.count(publisher) == 20

    publishers = Publishers(
        SimpleNamespace(kinds=dict.fromkeys(("backbone", "head_pose"), str)), create=lambda kind, topic, depth: topic,
        destroy=lambda publisher: None, known=None, received=received, publish_error=RuntimeError,
        values=lambda: DynamicsParameters(real_time_factor=0.0), stopped=lambda: False, report=Report(Log()),
    )  # fmt: skip
    publishers._give_up(publishers._channels["backbone"])
    assert not publishers.wait_until_received([], lambda: False)
    assert asked == ["head_pose"] * 20 + ["backbone"]


# the run loop


def fake_publishers(publish):
    return SimpleNamespace(
        wanted_parts=lambda: {"wrench": False, "load": False},
        publish=publish,
        tick=lambda nanoseconds: None,
        audience=tuple,
        lossless=False,
    )


@pytest.mark.parametrize(
    ("wanted", "done_at"), [(lambda run: run.requests.reset(), 0.0), (lambda run: run.requests.put(int), 0.25)]
)
def test_a_request_knows_when_it_was_carried_out(wanted, done_at):
    """However many samples the run has published before the other thread looks: it may be thousands."""
    requests, stamps = [], []

    def publish(snapshot, nanoseconds):
        stamps.append(nanoseconds)
        if nanoseconds == 250_000_000 and not requests:
            requests.append(wanted(run))

    publishers = fake_publishers(publish)
    simulation = Simulation(law=falling(), accuracy=1e-2)
    run = RunLoop(simulation, DynamicsParameters(real_time_factor=0.0, duration=1.0), publishers, Report(Log()))
    run.run()
    assert stamps[-1] == 10**9 and run.time == 1.0
    assert requests[0].done.is_set() and requests[0].time == done_at


def test_a_reset_that_the_law_refuses_leaves_the_run_as_it_is(monkeypatch):
    """No law is known that can be blended into and cannot begin; the march refuses here in its place."""
    stamps, log = [], Log()

    def refuse(*_, **__):
        raise ValueError("law 'x' cannot be begun: kinetic energy")

    def publish(snapshot, nanoseconds):
        stamps.append(nanoseconds)
        if nanoseconds == 250_000_000:
            monkeypatch.setattr("eel_dynamics.simulation.simulation.march_from_start", refuse)
            run.requests.reset()

    publishers = fake_publishers(publish)
    simulation = Simulation(law=falling(), accuracy=1e-2)
    run = RunLoop(simulation, DynamicsParameters(real_time_factor=0.0, duration=1.0), publishers, Report(log))
    run.run()
    assert stamps == sorted(set(stamps)) and stamps[-1] == 10**9 and not run.given_up
    assert ("error", "reset refused: law 'x' cannot be begun: kinetic energy") in log.lines


def test_a_run_that_stands_at_its_start_repeats_sample_0_and_goes_on_with_sample_1(monkeypatch):
    """A controller that answers the third sample 0; nobody publishes a law."""
    monkeypatch.setattr("eel_dynamics.ros.loop.sample_output.START_PERIOD", 0.0)
    stamps, x = [], [0.0, 1.0]

    def publish(snapshot, nanoseconds):
        stamps.append(nanoseconds)
        if len(stamps) == 3:
            rows = {f"{axis}{of}": [0.0, 0.0] for axis in ("pitch", "yaw") for of in ("", "_rate", "_accel")}
            run.requests.take_samples({"time": 0.01, "x": x, **rows})

    run = RunLoop(
        Simulation(accuracy=1e-2),
        DynamicsParameters(real_time_factor=1000.0, duration=0.05),
        fake_publishers(publish),
        Report(Log()),
    )
    run.run()
    assert stamps == [0, 0, 0, *(10_000_000 * k for k in range(1, 6))] and run.samples_published == 6


def clock_of(run_for, **parameters):
    """What a run publishes, in order: ("tick", simulation time [ns]) of /clock, and ("sample", its stamp [ns])."""
    told = []
    publishers = fake_publishers(lambda snapshot, stamp: told.append(("sample", stamp)))
    publishers.tick = lambda stamp: told.append(("tick", stamp))
    values = DynamicsParameters(duration=run_for, **parameters)
    RunLoop(Simulation(accuracy=1e-2, law=falling()), values, publishers, Report(Log())).run()
    return told


@pytest.mark.parametrize("factor", [0.0, 1.0])
def test_the_clock_has_a_rate_of_its_own_and_is_never_behind_a_sample(factor):
    told = clock_of(0.04, rate=50.0, clock_rate=200.0, real_time_factor=factor)
    assert [stamp for what, stamp in told if what == "tick"] == [5_000_000 * k for k in range(9)]
    assert [each for each in told if each[0] == "sample" or each[1] % 20_000_000 == 0] == [
        (what, 20_000_000 * k) for k in range(3) for what in ("tick", "sample")
    ]


def test_a_clock_slower_than_the_samples_comes_with_the_first_sample_at_its_time_or_after():
    told = clock_of(0.5, rate=100.0, clock_rate=8.0, real_time_factor=0.0)
    assert [stamp for what, stamp in told if what == "tick"] == [125_000_000 * k for k in range(5)]
    after = [told[k + 1][1] for k, (what, _) in enumerate(told) if what == "tick"]
    assert after == [0, 130_000_000, 250_000_000, 380_000_000, 500_000_000]


def test_without_a_rate_of_its_own_the_clock_comes_with_each_sample():
    told = clock_of(0.03, rate=100.0, real_time_factor=0.0)
    assert told == [(what, 10_000_000 * k) for k in range(4) for what in ("tick", "sample")]


def test_a_clock_that_stands_does_not_go_back_to_the_last_sample():
    told, now = [], 0.0
    clock = ClockTicks(100.0, SimpleNamespace(tick=told.append))
    clock.reach(0)
    clock.go_on(30_000_000, 0, now)
    for _ in range(3):
        now += 1e9  # s: later than any clock's time
        clock.repeat(0, now)
    assert told == [0, 10_000_000, 20_000_000, 30_000_000, *[30_000_000] * 3]
    clock.restart()
    clock.reach(0)
    assert told[-1] == 0


def test_steps_of_a_paused_run_end_with_the_last_of_them_or_say_why():
    stamps, steps = [], []

    def publish(snapshot, nanoseconds):
        stamps.append(nanoseconds)

    run = RunLoop(
        Simulation(accuracy=1e-2, law=falling()),
        DynamicsParameters(real_time_factor=0.0, duration=1.0),
        fake_publishers(publish),
        Report(Log()),
    )
    thread = threading.Thread(target=run.run)
    run.requests.pause(True)
    thread.start()
    for count in (3, 2):
        steps.append(run.requests.step(count))
        assert steps[-1].done.wait(60.0) and not steps[-1].failure
    assert [each.time for each in steps] == [0.03, 0.05]
    assert [stamp for stamp in stamps if stamp] == [10_000_000 * k for k in range(1, 6)]
    run.requests.pause(False)
    thread.join()
    late = run.requests.step(1)
    run.requests.put(run.requests.stop)
    run.run()
    assert "refused at t = 1 s: the run is not paused" in late.failure or not late.done.is_set()
