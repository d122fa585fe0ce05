# SPDX-License-Identifier: Apache-2.0
"""The loop of a run, without ROS: requests, sample 0, ticks of the clock."""

import threading
from types import SimpleNamespace

import numpy as np
import pytest
from eel_common.ros.loop.clock_ticks import ClockTicks
from eel_common.ros.loop.diagnostics import ERROR, OK, WARN, Report
from eel_common.ros.loop.requests import Answer
from eel_common.ros.testing.log import Log
from eel_dynamics.ros.loop.limits_monitor import LimitsMonitor
from fake_publishers import FakeInbox, fake_publishers, run_loop
from sensor_msgs.msg import JointState

from eel_dynamics import Robot, Simulation
from eel_gaits import Law, falling, straight


@pytest.mark.parametrize(
    ("wanted", "done_at"),
    [(lambda run: run.requests.put(run.reset, urgent=True), 0.0), (lambda run: run.requests.put(int), 0.25)],
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
    run = run_loop(simulation, publishers, Report(Log()), real_time_factor=0.0, duration=1.0)
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
            monkeypatch.setattr("eel_dynamics.simulation.simulation.March", refuse)
            run.requests.put(run.reset, urgent=True)

    publishers = fake_publishers(publish)
    simulation = Simulation(law=falling(), accuracy=1e-2)
    run = run_loop(simulation, publishers, Report(log), real_time_factor=0.0, duration=1.0)
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
            run.laws.add_samples({"time": 0.01, "x": x, **rows})

    publishers = fake_publishers(publish)
    run = run_loop(Simulation(accuracy=1e-2), publishers, Report(Log()), real_time_factor=1000.0, duration=0.05)
    run.run()
    assert stamps == [0, 0, 0, *(10_000_000 * k for k in range(1, 6))] and run.samples_published == 6


def clock_of(run_for, **parameters):
    """What a run publishes, in order: ("tick", simulation time [ns]) of /clock, and ("sample", its stamp [ns])."""
    told = []
    publishers = fake_publishers(lambda snapshot, stamp: told.append(("sample", stamp)))
    publishers.tick = lambda stamp: told.append(("tick", stamp))
    simulation = Simulation(accuracy=1e-2, law=falling())
    run_loop(simulation, publishers, Report(Log()), duration=run_for, **parameters).run()
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
    clock.restart(100.0)
    clock.reach(0)
    assert told[-1] == 0


def test_steps_of_a_paused_run_end_with_the_last_of_them_or_say_why():
    stamps, steps = [], []

    def publish(snapshot, nanoseconds):
        stamps.append(nanoseconds)

    simulation = Simulation(accuracy=1e-2, law=falling())
    run = run_loop(simulation, fake_publishers(publish), Report(Log()), real_time_factor=0.0, duration=1.0)
    thread = threading.Thread(target=run.run)
    run.requests.put(run.pause, True)
    thread.start()
    for count in (3, 2):
        steps.append(Answer(FakeInbox()))
        run.requests.put(run.step, count, steps[-1])
        assert steps[-1].done.wait(60.0) and not steps[-1].failure
    assert [each.time for each in steps] == [0.03, 0.05]
    assert [stamp for stamp in stamps if stamp] == [10_000_000 * k for k in range(1, 6)]
    run.requests.put(run.pause, False)
    thread.join()
    late = Answer(FakeInbox())
    run.requests.put(run.step, 1, late)
    run.requests.put(run.requests.stop)
    run.run()
    assert "refused at t = 1 s: the run is not paused" in late.failure or not late.done.is_set()


def test_the_greatest_torque_above_the_limit_is_in_the_log(monkeypatch):
    """The first excess at once, and of all later ones the greatest, at the end of the run, which takes no second."""
    log, torques = Log(), []
    publishers = fake_publishers(lambda snapshot, stamp: torques.append(float(abs(snapshot.torque).max())))
    values = {"real_time_factor": 0.0, "duration": 1.0, "torque_limit": 0.1}
    monkeypatch.setattr("eel_dynamics.ros.loop.limits_monitor.REPEAT", 1000.0)
    run_loop(Simulation(accuracy=1e-2, law=straight()), publishers, Report(log), **values).run()
    above = [torque for torque in torques if torque > 0.1]
    assert len(above) > 2 and max(above) > 2.0 * above[0]
    first, last = (text for level, text in log.lines if level == "warning")
    assert f"of {above[0]:.3g} N m exceeds torque_limit 0.1 N m at X = " in first
    assert f"of {max(above):.3g} N m exceeds" in last
    assert last.endswith(
        f"t = {torques.index(max(above)) / 100:.4g} s (the greatest of {len(above) - 1} samples above it)"
    )


def test_a_torque_above_the_limit_is_reported_a_second_later_though_it_has_fallen(monkeypatch):
    now, log = [0.0], Log()
    monkeypatch.setattr("eel_dynamics.ros.loop.limits_monitor.monotonic", lambda: now[0])
    monitor = LimitsMonitor(Simulation(), Report(log))
    for wall, torque in ((0.0, 2.0), (0.4, 5.0), (0.8, 3.0), (1.2, 0.0), (2.4, 0.0)):
        now[0] = wall
        monitor.check_torque(SimpleNamespace(torque=np.array([[0.0, 0.0, -torque]]), x=[0.5], time=wall), 1.0)
    at = "exceeds torque_limit 1 N m at X = 0.5 m"
    assert [text for _, text in log.lines] == [
        f"torque_3 of 2 N m {at}, t = 0 s",
        f"torque_3 of 5 N m {at}, t = 0.4 s (the greatest of 2 samples above it)",
    ]


def test_a_controller_that_answers_less_than_a_sample_ahead_is_told_so():
    """It answers each sample of 50 Hz for 0.01 s later, at most; the run waits for 0.02 s."""
    log, x = Log(), np.array([0.0, 1.0])

    def publish(snapshot, nanoseconds):
        instant = 1e-9 * nanoseconds + 0.01 if nanoseconds < 100_000_000 else 0.03
        rows = {f"{axis}{of}": np.zeros(2) for axis in ("pitch", "yaw") for of in ("", "_rate", "_accel")}
        run.laws.add_samples({"time": instant, "x": x, **rows})

    values = {"real_time_factor": 0.0, "rate": 50.0, "duration": 0.2, "subscriber_timeout": 0.2}
    report = Report(log, now=lambda: 0.0)  # else what is said once a second would be said more often by a slow machine
    run = run_loop(Simulation(accuracy=1e-2), fake_publishers(publish), report, **values)
    run.run()
    missing, refused = (text for level, text in log.lines if level != "info" and "run out" not in text)
    assert missing == (
        "no curvature sample for t >= 0.02 s within 0.2 s, the newest is for t = 0.01 s: at real_time_factor 0 a "
        "controller's samples must lie at least 1/rate = 0.02 s ahead of the simulation"
    )
    assert refused == (
        "curvature samples refused: header.stamp must lie ahead of the simulation (0.1 s), got 0.03 s: send them "
        "further ahead"
    )


def samples_at(time, bend=0.0):
    rows = {f"{axis}{of}": np.zeros(2) for axis in ("pitch", "yaw") for of in ("", "_rate", "_accel")}
    return {"time": time, "x": np.array([0.0, 1.0]), **rows, "yaw": np.full(2, bend)}


@pytest.mark.parametrize("rate", [60.0, 70.0, 100.0])
def test_a_controller_whose_stamps_are_rounded_down_is_not_waited_for_in_vain(rate):
    """It answers each sample of time t with t + 1/rate, in whole nanoseconds, and commands joints at t."""
    log, inbox, period = Log(), FakeInbox(), int(1e9 / rate)
    waiting = [samples_at(0.0), samples_at(1e-9 * period)]

    def take(now):
        while waiting:
            yield waiting.pop(0)

    def publish(snapshot, nanoseconds):
        seconds, rest = divmod(nanoseconds + period, 1_000_000_000)
        waiting.append(samples_at(seconds + 1e-9 * rest))
        command = JointState(name=["joint_1"], position=[0.1])
        command.header.stamp.sec, command.header.stamp.nanosec = divmod(nanoseconds, 1_000_000_000)
        run.requests.put(run.take_command, run.inputs.joints, command)

    inbox.take = take
    values = {"real_time_factor": 0.0, "rate": rate, "duration": 2.0, "subscriber_timeout": 0.02}
    swimmer = Simulation(accuracy=1e-2, robot=Robot.named("eight_servos"))
    run = run_loop(swimmer, fake_publishers(publish), Report(log), inbox, **values)
    run.run()
    assert [text for level, text in log.lines if level != "info"] == [] and run.time == 2.0


@pytest.mark.fault("samples", "one sample of several that is late", "a warning; ERROR is for control that is lost")
def test_one_late_sample_is_a_warning_and_lost_control_is_an_error_until_it_is_back():
    log, states = Log(), {}

    def publish(snapshot, nanoseconds):
        k = nanoseconds // 10_000_000
        if not 30 <= k < 60:
            run.laws.add_samples(samples_at(0.01 * (k + 2)))
        if k == 10:
            run.laws.add_samples(samples_at(0.05, bend=1.0))
        states[k] = report.state()

    report = Report(log, now=lambda: 0.0)  # the run takes less than 2 s, whatever the machine
    values = {"real_time_factor": 0.0, "duration": 1.0, "subscriber_timeout": 0.1}
    run = run_loop(Simulation(accuracy=1e-2), fake_publishers(publish), report, **values)
    run.laws.add_samples(samples_at(0.0))
    run.laws.add_samples(samples_at(0.01))
    run.run()
    assert states[9] == (OK, [])
    level, (text,) = states[12]
    assert level == WARN and text.endswith("(0.1 s), got 0.05 s: send them further ahead"), text
    assert states[40][0] == ERROR and states[40][1][0] == "curvature samples have run out at t = 0.32 s: coming to rest"
    assert states[99][0] == WARN, "what is over and less than 2 s ago"
    said = [text for level, text in log.lines if level == "info"]
    assert said == [
        "curvature samples adopted at t = 0.01 s",
        "curvature samples are back at t = 0.63 s",
        "finished at t = 1 s",
    ]


class MadeUpTime(FakeInbox):
    """A steady clock that goes on while the run loop waits on it; it is the loop's inbox, too, without samples."""

    def __init__(self, monkeypatch):
        super().__init__()
        self.now = 100.0
        for module in (
            "eel_dynamics.ros.loop.run_loop",
            "eel_common.ros.loop.clock_ticks",
            "eel_common.ros.loop.requests",
        ):
            monkeypatch.setattr(f"{module}.time", SimpleNamespace(monotonic=lambda: self.now))

    def wait(self, seconds):
        self.now += seconds
        return False


def test_a_run_that_stood_still_for_half_a_second_regains_it_within_five_and_a_half(monkeypatch):
    time, log, shown = MadeUpTime(monkeypatch), Log(), []

    def publish(snapshot, nanoseconds):
        if nanoseconds == 500_000_000:
            time.now += 0.5
        shown.append(time.now - 100.0)

    simulation = Simulation(accuracy=1e-2, law=falling())
    report = Report(log, now=lambda: time.now)
    run = run_loop(simulation, fake_publishers(publish), report, time, duration=10.0)
    run.run()
    punctual = 0.01 * np.arange(1001)
    late = np.array(shown) - punctual
    assert np.allclose(late[:50], 0.0) and late[50] == pytest.approx(0.5) and np.allclose(late[601:], 0.0, atol=1e-9)
    assert np.allclose(np.diff(shown)[50:599], 0.01 / 1.1)
    warnings = [text for level, text in log.lines if level == "warning"]
    assert warnings == ["late by 0.5 s at t = 0.5 s: accuracy is kept, not the pace"]
    assert ("info", "no longer late at t = 9 s: it was for 4.99 s, by 0.5 s at most") in log.lines
    assert run.pace.lost(1001) == 0.0


def test_repeated_answers_to_sample_0_change_nothing_though_they_come_late():
    """A controller answers sample 0 with several samples, and a repeated one likewise."""
    log = Log()

    def publish(snapshot, nanoseconds):
        k = nanoseconds // 10_000_000
        run.laws.add_samples(samples_at(0.01 * (k + 6)))
        if k == 3:
            for each in range(6):
                run.laws.add_samples(samples_at(0.01 * each))
            run.laws.add_samples(samples_at(0.01, bend=1.0))

    values = {"real_time_factor": 0.0, "duration": 0.2}
    run = run_loop(Simulation(accuracy=1e-2), fake_publishers(publish), Report(log), **values)
    for each in range(6):
        run.laws.add_samples(samples_at(0.01 * each))
    run.run()
    refused = [text for level, text in log.lines if level != "info"]
    assert len(refused) == 1 and "got 0.01 s" in refused[0], "only the one with other values"


def joint_command(stamp, **angles):
    """A message with the stamp [s]."""
    message = JointState(name=[*angles], position=[*angles.values()])
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(round(1e9 * stamp), 1_000_000_000)
    return message


@pytest.mark.fault(
    "samples",
    "commands at 700 Hz during a pause of 20 s",
    "the last of each joint acts; the others take no room and no time; each call is answered",
)
def test_of_the_commands_of_a_pause_the_last_of_each_joint_acts():
    given, log = [], Log()
    simulation = Simulation(accuracy=1e-2, robot=Robot.named("eight_servos"), law=straight())
    simulation.command = lambda joint, **value: given.append((joint, value))
    run = run_loop(simulation, fake_publishers(lambda *_: None), Report(log), real_time_factor=0.0, duration=0.03)
    for k in range(14_000):
        run.take_command(run.inputs.joints, joint_command(0.0, joint_1=1e-5 * k))
    for k in range(100):
        run.take_command(run.inputs.joints, joint_command(0.015, joint_1=0.2, joint_2=0.01 * k))
    run.run()
    assert given == [
        ("joint_1", {"position": -0.13999}),  # the library's sign of yaw
        ("joint_1", {"position": -0.2}),
        ("joint_2", {"position": -0.99}),
    ]
    for k in range(20_000):
        run.take_command(run.inputs.joints, joint_command(run.time + 1e-4 + 2e-4 * k, joint_1=0.0))
    refused = {text for level, text in log.lines if level == "error"}
    assert "joint command refused: at most 10000 of different stamps can wait ahead of t = 0.03 s" in refused


@pytest.mark.fault(
    "ending", "an error in the run loop that nobody foresaw", "the run stops, said once, and a reset starts it again"
)
def test_an_unforeseen_error_ends_no_node():
    log, stamps, broken = Log(), [], threading.Event()

    def publish(snapshot, nanoseconds):
        if nanoseconds == 50_000_000 and not broken.is_set():
            broken.set()
            raise KeyError("nobody foresaw it")
        stamps.append(nanoseconds)

    run = run_loop(Simulation(accuracy=1e-2, law=straight()), fake_publishers(publish), Report(log), duration=0.1)
    thread = threading.Thread(target=run.run)
    thread.start()
    assert broken.wait(60.0)
    assert run.requests.put(run.reset).done.wait(60.0)
    thread.join(60.0)
    told = [text for level, text in log.lines if level == "error"]
    assert told == ["the run stopped at t = 0.04 s: KeyError: 'nobody foresaw it'; reset starts it again"]
    assert stamps[-11:] == [10_000_000 * k for k in range(11)]


def test_a_command_that_fits_no_more_when_it_acts_is_told_and_left_out():
    log, simulation = Log(), Simulation(accuracy=1e-2, robot=Robot.named("eight_servos"), law=straight())

    def refuse(joint, **value):
        raise ValueError(f"joint {joint} has gone")

    run = run_loop(simulation, fake_publishers(lambda *_: None), Report(log), real_time_factor=0.0, duration=0.05)
    run.take_command(run.inputs.joints, joint_command(0.015, joint_1=0.2))
    simulation.command = refuse
    run.run()
    assert run.time == 0.05
    assert [text for level, text in log.lines if level == "error"] == ["joint command refused: joint joint_1 has gone"]


def test_a_run_begins_once_the_publishers_are_there_that_wait_for_names(monkeypatch):
    """However long that takes; then it gives timers half a second to see the clock at 0, and waits for messages."""
    time, log, begun = MadeUpTime(monkeypatch), Log(), []
    monkeypatch.setattr("eel_dynamics.ros.inputs.awaited.wall", SimpleNamespace(monotonic=lambda: time.now))
    values = {"real_time_factor": 0.0, "duration": 0.05, "subscriber_timeout": 2.0}
    values["wait_for"] = ("joint_commands/joint_2 0.02", "curvature_law")
    simulation = Simulation(accuracy=1e-2, robot=Robot.named("eight_servos"))

    def publish(snapshot, nanoseconds):
        if time.now > 160.0:
            run.inputs.awaited.offered.add("joint_commands")
        if time.now > 150.0 and not begun:
            begun.append(time.now)
            run.inputs.awaited.offered.add("curvature_law")
            run.take_law(straight(), 0.0)
        if nanoseconds == 20_000_000:
            begun.append(time.now)
            run.take_command(run.inputs.joints, joint_command(0.02, joint_2=0.1))

    report = Report(log, now=lambda: time.now)
    run = run_loop(simulation, fake_publishers(publish), report, time, **values)
    run.inputs.awaited.offered = set()
    run.run()
    assert begun == pytest.approx([150.0, 160.5], abs=0.3)
    assert log.lines[0] == ("info", "waiting for joint_commands (joint_2), curvature_law")
    assert [text for level, text in log.lines if level == "warning"] == [
        "no joint command for joint_2 for 2 s of wall time before t = 0.05 s, the newest is of t = 0.02 s: it holds, "
        "and the run does not wait until they are back"
    ]


@pytest.mark.fault(
    "samples",
    "commands out of order, of one stamp with two values, and for one joint from two publishers",
    "the newest acts; each is told once",
)
def test_of_commands_in_disorder_the_newest_acts_and_it_is_told_once():
    given, log = [], Log()
    simulation = Simulation(accuracy=1e-2, robot=Robot.named("eight_servos"), law=straight())
    simulation.command = lambda joint, **value: given.append((round(simulation.time, 3), value["position"]))

    def publish(snapshot, nanoseconds):
        if nanoseconds == 50_000_000:
            for stamp, angle in ((0.05, 0.1), (0.03, 0.2), (0.04, 0.3), (0.05, 0.4), (0.06, 0.5), (0.05, 0.6)):
                run.take_command(run.inputs.joints, joint_command(stamp, joint_1=angle))
        if nanoseconds in (70_000_000, 80_000_000):
            for stamp in (0.04, 0.05):
                run.take_command(run.inputs.joints, joint_command(stamp, joint_1=0.9))

    run = run_loop(simulation, fake_publishers(publish), Report(log), real_time_factor=1000.0, duration=0.1)
    run.run()
    assert given == [(0.05, -0.6), (0.06, -0.5)]  # the library's sign of yaw
    assert [text for level, text in log.lines if level == "warning" and "joint command" in text] == [
        "a joint command of t = 0.05 s for joint_1 came with another value: the newest is taken",
        "a joint command of t = 0.04 s is older than that of t = 0.06 s for joint_1: left out, as are further ones",
    ]


def test_set_points_that_come_now_and_then_make_no_line():
    """Each brings its servo to the limit for a moment, and holds for longer than command_timeout."""
    log = Log()

    def publish(snapshot, nanoseconds):
        if nanoseconds % 1_000_000_000 == 500_000_000:
            for angle in (0.5, -0.5):
                run.take_command(run.inputs.joints, joint_command(0.0, joint_3=angle * (1 + nanoseconds // 10**9)))

    simulation = Simulation(accuracy=1e-2, robot=Robot.named("eight_servos"), law=Law())
    run = run_loop(simulation, fake_publishers(publish), Report(log), real_time_factor=0.0, duration=3.4, rate=20.0)
    run.run()
    assert run.output.saturation.values()["at_torque_limit"].startswith("joint_3 ")
    assert log.lines == [("info", "finished at t = 3.4 s")]
