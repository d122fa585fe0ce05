# SPDX-License-Identifier: Apache-2.0
"""The environments for learning: Gymnasium's own check, seeds, threads, actions, and what is refused."""

import math
import subprocess
import sys
import warnings

import gymnasium
import numpy as np
import pytest
from eel_dynamics.model.initial_state import level_orientation
from eel_dynamics.simulation.sampled_swimmers import SampledSwimmers
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode

from eel_dynamics import FlowField, Run, Scene, Shear, Simulation, SimulationStopped, Vortex
from eel_gaits import Law, Term, helix, straight
from eel_gym import DepthEnv, HeadingEnv, KnotAction, LawAction, SwimmerEnv, ThreadedVectorEnv, WayPointsEnv

TASKS = {"Heading": HeadingEnv, "Depth": DepthEnv, "WayPoints": WayPointsEnv}


def swum(env, actions, seed=5):
    """Observations and rewards of an episode, one row for each control step."""
    rows = [np.append(env.reset(seed=seed)[0], 0.0)]
    for action in actions:
        observation, reward, *_ = env.step(action)
        rows.append(np.append(observation, reward))
    return np.array(rows)


def random_actions(env, steps, seed=1):
    return np.random.default_rng(seed).uniform(-1.0, 1.0, (steps, *env.action_space.shape))


@pytest.mark.parametrize("name", TASKS)
def test_gymnasiums_check_finds_nothing(name, tmp_path):
    env = gymnasium.make(f"Eel/{name}-v0", disable_env_checker=True, duration=0.2, recordings=tmp_path).unwrapped
    assert isinstance(env, TASKS[name])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(env)
    assert list(tmp_path.iterdir()) == []  # an episode without a step is not recorded


@pytest.mark.parametrize("task", TASKS.values())
def test_seeds_repeat_to_the_bit(task):
    one, other = task(), task()
    actions = random_actions(one, 20)
    assert np.array_equal(swum(one, actions), swum(other, actions))
    again = swum(one, actions)  # the same environment, used before
    assert np.array_equal(again, swum(other, actions))
    assert not np.array_equal(again, swum(other, actions, seed=6))
    one.reset(seed=6)
    assert one.np_random_seed == 6


@pytest.mark.parametrize("threads", [1, 3])
def test_environments_in_threads_swim_as_each_would_alone(threads):
    envs = gymnasium.make_vec("Eel/Depth-v0", num_envs=4, threads=threads)
    actions = np.random.default_rng(2).uniform(-1.0, 1.0, (15, 4, 2))
    seen, _ = envs.reset(seed=7)
    together = [np.column_stack((seen, np.zeros(4)))]
    for action in actions:
        seen, rewards, *_ = envs.step(action)
        together.append(np.column_stack((seen, rewards)))
    envs.close()
    for index in range(4):
        alone = swum(DepthEnv(), actions[:, index], seed=7 + index)
        assert np.array_equal(np.array(together)[:, index], alone.astype(float))


@pytest.mark.parametrize("mode", AutoresetMode)
def test_an_episode_that_ends_is_followed_by_another_as_declared(mode):
    envs = gymnasium.make_vec("Eel/Heading-v0", num_envs=2, control_period=0.05, duration=0.15, autoreset_mode=mode)
    assert envs.metadata["autoreset_mode"] is mode
    start, _ = envs.reset(seed=1)
    for _ in range(2):
        assert not envs.step(np.zeros((2, 1)))[3].any()
    seen, rewards, _, truncated, infos = envs.step(np.zeros((2, 1)))
    assert truncated.all() and (rewards > 0.0).all()
    if mode is AutoresetMode.SAME_STEP:
        assert not np.allclose(np.stack(infos["final_obs"]), seen)
    elif mode is AutoresetMode.NEXT_STEP:
        begun, rewards, _, truncated, _ = envs.step(np.zeros((2, 1)))
        assert not truncated.any() and not rewards.any() and not np.array_equal(begun, seen)
    else:
        with pytest.raises(gymnasium.error.ResetNeeded):
            envs.step(np.zeros((2, 1)))
        again, _ = envs.reset(seed=[1, 2], options={"reset_mask": np.array([True, False])})
        assert np.array_equal(again[0], start[0]) and np.array_equal(again[1], seen[1])
        with pytest.raises(gymnasium.error.ResetNeeded):
            envs.step(np.zeros((2, 1)))
        envs.reset(options={"reset_mask": np.array([False, True])})
        envs.step(np.zeros((2, 1)))
    envs.close()


def test_vector_environments_take_a_limit_of_steps():
    envs = gymnasium.make_vec("Eel/Heading-v0", num_envs=2, max_episode_steps=2)
    envs.reset(seed=1)
    assert not envs.step(np.zeros((2, 1)))[3].any() and envs.step(np.zeros((2, 1)))[3].all()
    envs.close()


# -- actions


@pytest.mark.parametrize("law", [straight(), helix(), Law(Term(axis="pitch", amplitude=(0.3,), phase=1.0))])
def test_an_action_at_rest_is_the_law_with_its_ramps_complete(law):
    action = LawAction(law, {"left_bend": (-1.0, 1.0), "up_bend": (-1.0, 1.0)})
    action.begin(0.3)
    bare = Law(*(Term(**{**vars(term), "envelope": ()}) for term in law.terms))
    for k in range(1, 4):
        rows = action.advance(np.zeros(2), 0.17).reshape(2, 3, -1)
        for derivative, values in enumerate(bare.curvature(0.3 + 0.17 * k, action.x)):
            assert rows[:, derivative] == pytest.approx(values[:, 1:].T, abs=1e-11 * 40.0)  # rad/m/s^2: 40 times rad/m


def test_numbers_of_a_law_follow_the_action_without_a_jump():
    numbers = {"amplitude": (0.5, 1.5), "tempo": (0.0, 2.0), "left_bend": (-1.0, 1.0), "up_bend": (-0.5, 0.5)}
    fine, coarse = (LawAction(helix(), numbers) for _ in range(2))
    step, values = 1e-4, []
    for target in random_actions_of(4, 3):
        for _ in range(1000):
            values.append(fine.advance(target, step))
        assert values[-1] == pytest.approx(coarse.advance(target, 0.1), rel=1e-9, abs=1e-9)
    values = np.array(values).reshape(-1, 2, 3, values[0].shape[-1])
    for derivative in (1, 2):  # the slope of the value is the rate, that of the rate the acceleration
        slope = (values[2:, :, derivative - 1] - values[:-2, :, derivative - 1]) / (2.0 * step)
        smooth = np.delete(slope - values[1:-1, :, derivative], [998, 999, 1998, 1999], axis=0)  # at new actions
        assert np.abs(smooth).max() < 2e-6 * np.abs(values[:, :, derivative]).max()
    jumps = np.abs(np.diff(values[:, :, :2], axis=0)).max(axis=(0, 1, 3))
    assert (jumps < 2.0 * step * np.abs(values[:, :, 1:]).max(axis=(0, 1, 3))).all()


def random_actions_of(size, count):
    return np.random.default_rng(3).uniform(-1.0, 1.0, (count, size))


def test_rates_at_knots_move_the_body_and_never_beyond_the_greatest_bend():
    action, step = KnotAction(4, ("yaw", "pitch"), greatest_rate=10.0, greatest_bend=2.0), 0.05
    rows = [action.begin().reshape(2, 3, 4)]
    draws = np.random.default_rng(4)
    for k in range(400):
        wanted = np.sign(draws.standard_normal(8)) if k < 200 else np.ones(8)
        rows.append(action.advance(wanted, step).reshape(2, 3, 4))
    rows = np.array(rows)
    value, rate = rows[:, :, 0], rows[:, :, 1]
    assert np.diff(value, axis=0) == pytest.approx(0.5 * step * (rate[1:] + rate[:-1]), abs=1e-12)
    assert np.abs(value).max() <= 2.0 and np.abs(rate).max() <= 10.0
    assert value[-1] == pytest.approx(2.0, abs=1e-6) and rate[-1] == pytest.approx(0.0, abs=1e-5)
    assert action.advance(-np.ones(8), step).reshape(2, 3, 4)[:, 0].max() < 2.0  # and back


@pytest.mark.parametrize(("value", "reached"), [(1.0, 0.6), (-1.0, -0.2), (0.0, 0.2)])
def test_a_number_of_the_law_goes_to_the_bound_that_the_action_says(value, reached):
    action = LawAction(straight(), {"left_bend": (-0.2, 0.6)})
    action.begin()
    for _ in range(400):
        action.advance(np.array([value]), 0.05)
    assert action.state[0] == pytest.approx(reached, abs=1e-6)


def test_knots_of_many_swimmers_are_observed_as_of_one():
    envs, env = ThreadedVectorEnv(3, task=HeadingEnv, action=KnotAction(4)), HeadingEnv(action=KnotAction(4))
    envs.reset(seed=[5, 6, 7])
    env.reset(seed=6)
    for actions in random_actions_of(4, 9).reshape(3, 3, 4):
        assert np.array_equal(envs.step(actions)[0][1], env.step(actions[1])[0])


def test_the_body_bends_as_the_action_says():
    env = HeadingEnv(action=KnotAction(5), scene=Scene(planar=True), greatest_trim=0.0)
    env.reset(seed=1)
    for action in random_actions(env, 60):  # beyond the blend from the straight body
        env.step(action)
    curvature, rate = env.action.state[:5], env.action.state[5:]
    seen = env.swimmers.observe(0)
    assert seen.curvature[(0, -1), 2] == pytest.approx((curvature[0], curvature[-1]), abs=1e-9)
    assert seen.curvature_rate[(0, -1), 2] == pytest.approx((rate[0], rate[-1]), abs=1e-9)


@pytest.mark.parametrize(
    ("scene", "flow"),
    [
        (Scene(planar=True), None),
        (Scene(current=(0.2, -0.1, 0.05)), None),
        (Scene(planar=True), Vortex(circulation=0.2, core=0.8, centre=(-0.5, 0.4, 0.0))),
    ],
)
def test_an_environment_swims_as_a_simulation_with_the_same_samples_to_the_bit(scene, flow):
    env = HeadingEnv(scene=scene, flow=flow, action=LawAction(straight(), {"left_bend": (-0.5, 0.5)}))
    env.reset(seed=3)
    (start,) = env.starts
    twist, orientation = (0.0, 0.0, 0.0, start.speed, 0.0, 0.0), level_orientation(start.heading)
    settings = {"accuracy": env.swimmers.accuracy, "stations": 2}
    simulation = Simulation(scene=env.scene, orientation=orientation, twist=twist, flow=flow, **settings)
    other = LawAction(straight(), {"left_bend": (-0.5, 0.5)})
    rows, trim = other.begin(start.own_time), np.zeros((6, len(other.x)))
    trim[3] = start.left_trim
    simulation.add_samples(0.0, other.x, *(rows - trim))
    for k, action in enumerate(random_actions(env, 40), 1):
        env.step(action)
        simulation.add_samples(k / 10, other.x, *(other.advance(action, 0.1) - trim))
        simulation.advance(k / 10)
        seen = simulation.observe()
        if flow is None:
            assert env.head.position.tolist() == seen.position.tolist()
            assert (*env.head.angular_velocity, *env.head.velocity) == pytest.approx(tuple(seen.twist), abs=1e-13)
        assert np.allclose(env.head.position, seen.position, rtol=0.0, atol=1e-5)


@pytest.mark.parametrize("threads", [1, 3])
def test_each_episode_draws_its_own_flow_from_the_environment_s_random_numbers(threads):
    drawn = []

    def flow(random):
        drawn.append(Shear(velocity=(random.uniform(-0.3, 0.3), 0.0, 0.0), width=1.0, centre=(0.0, 0.5, 0.0)))
        return drawn[-1]

    envs = gymnasium.make_vec("Eel/Heading-v0", num_envs=3, threads=threads, flow=flow)
    envs.reset(seed=11)
    for _ in range(5):
        envs.step(np.zeros((3, 1)))
    envs.close()
    first = list(drawn)
    assert len(set(first)) == 3
    still = swum(HeadingEnv(), np.zeros((20, 1)), seed=11)
    moved = swum(HeadingEnv(flow=flow), np.zeros((20, 1)), seed=11)
    again = swum(HeadingEnv(flow=lambda random: flow(random)), np.zeros((20, 1)), seed=11)
    assert drawn[3] == first[0] and np.array_equal(moved, again) and not np.allclose(moved, still)


def test_a_flow_that_does_not_fit_side_by_side_is_named():
    with pytest.raises(ValueError, match="flow must be a Flow, or a function of random numbers"):
        HeadingEnv(flow=3.0)
    for flow, told in ((FlowField(lambda x, t: 0.0 * x), "no functions"), (Vortex(core=0.05), "at most 2 waves")):
        with pytest.raises(ValueError, match=f"flow must have {told}"):
            HeadingEnv(flow=flow).reset(seed=1)


def test_the_grid_fits_the_waves_of_the_action():
    env = DepthEnv()
    env.reset(seed=1)
    for action in random_actions(env, 3):
        env.step(action)
    assert len(env.swimmers.grid.x) == len(Simulation(scene=env.scene, law=straight()).grid.x)
    assert (
        LawAction(helix(), {"amplitude": (0.0, 5.0)}).waves > LawAction(helix(), {"amplitude": (0.0, 1.0)}).waves >= 1
    )


def test_positive_bends_turn_left_and_climb():
    env = DepthEnv(greatest_roll_rate=0.0, control_period=0.1)
    for row, action in enumerate(([0.6, 0.0], [0.0, 0.6])):
        env.reset(seed=1)
        for _ in range(30):
            env.step(action)
        turned, climbed = env.heading, env.head.climb
        assert (turned, climbed)[row] > 0.3 > abs((turned, climbed)[1 - row])


def test_a_point_that_is_reached_is_rewarded_and_the_last_one_ends_the_episode():
    env = WayPointsEnv(points=1, distance=0.6, greatest_turn=0.0)
    env.reset(seed=1)
    rewards, terminated = [], False
    while not terminated:
        _, reward, terminated, truncated, _ = env.step([0.0])
        rewards.append(reward)
        assert not truncated
    assert sum(rewards) == pytest.approx(1.0 + 0.3, abs=0.06)  # the point, and the way to within 0.3 m of it


# -- what is refused


def test_actions_beyond_the_bounds_are_cut_and_others_refused():
    env, other = HeadingEnv(), HeadingEnv()
    env.reset(seed=1), other.reset(seed=1)
    for bad in ([np.nan], [np.inf], [0.1, 0.2], "left", None, [[0.1]]):
        with pytest.raises(gymnasium.error.InvalidAction, match="action must be 1 finite numbers, got") as error:
            env.step(bad)
        assert "\n" not in str(error.value)
    assert np.array_equal(env.step([3.0])[0], other.step([1.0])[0])  # and nothing has moved before


def test_unknown_and_bad_parameters_are_named_in_one_line():
    for make in (gymnasium.make, gymnasium.make_vec):
        with pytest.raises(ValueError, match=r"task 'Heading' has no parameter 'gain', it has: control_period, dur.*"):
            make("Eel/Heading-v0", gain=3.0)
    with pytest.raises(ValueError, match=r"control_period must be >= 0\.001 s, got 0$"):
        HeadingEnv(control_period=0)
    for name, wanted in (
        ("scene", "a Scene"),
        ("body", "a Body"),
        ("action", "a LawAction, a KnotAction or a JointAction"),
    ):
        with pytest.raises(ValueError, match=f"{name} must be {wanted}, got 'none'"):
            HeadingEnv(**{name: "none"})
    with pytest.raises(ValueError, match="accuracy"):
        HeadingEnv(accuracy="none")
    for bounds, told in (((1.0, 1.0), "must rise"), (3.0, "must be 2 numbers"), ((0.0, np.inf), "must be finite")):
        with pytest.raises(ValueError, match=f"bounds of left_bend {told}, got"):
            LawAction(straight(), {"left_bend": bounds})
    with pytest.raises(ValueError, match="render_mode must be one of rgb_array, rerun, got 'human'"):
        HeadingEnv(render_mode="human")
    with pytest.raises(ValueError, match="a law has no number 'bend', it has: amplitude, tempo, left_bend, up_bend"):
        LawAction(straight(), {"bend": (0.0, 1.0)})
    with pytest.raises(ValueError, match=r"num_envs must be a whole number, got 2\.5"):
        gymnasium.make_vec("Eel/Heading-v0", num_envs=2.5)
    with pytest.raises(ValueError, match=r"threads must be a whole number, got 1\.5"):
        HeadingEnv(threads=1.5)
    with pytest.raises(ValueError, match="swimmers must be > 0, got 0"):
        HeadingEnv(swimmers=0)
    envs = gymnasium.make_vec("Eel/Heading-v0", num_envs=2)
    envs.reset(seed=1)
    with pytest.raises(gymnasium.error.InvalidAction, match="actions must be 2 x 1 finite numbers"):
        envs.step(np.array([[0.1], [np.nan]]))
    envs.close()


def test_episodes_begin_anywhere_in_the_gait_s_period():
    env, times = HeadingEnv(), []
    for seed in range(30):
        env.reset(seed=seed)
        times.append(env.starts[0].own_time / env.action.period)
    assert 0.0 <= min(times) < 0.2 and 0.8 < max(times) <= 1.0


def test_step_and_render_before_reset_are_refused():
    env, envs = HeadingEnv(render_mode="rgb_array"), gymnasium.make_vec("Eel/Heading-v0", num_envs=2)
    for act in (lambda: env.step([0.0]), env.render, lambda: envs.step(np.zeros((2, 1)))):
        with pytest.raises(gymnasium.error.ResetNeeded):
            act()


def test_a_swimmer_that_cannot_go_on_ends_the_episode(monkeypatch):
    # samples that no body can have are refused before they stop a swim
    monkeypatch.setattr("eel_dynamics.curvature.curvature_samples.MOST_TURNS", (np.inf,) * 3)
    env = HeadingEnv(action=KnotAction(3, greatest_rate=1e12, greatest_bend=1e12))
    env.reset(seed=1)
    terminated, info = False, {}
    while not terminated:
        observation, reward, terminated, _, info = env.step([1.0, -1.0, 1.0])
    assert "stopped at t =" in info["stopped"] and reward == 0.0 and observation in env.observation_space
    with pytest.raises(gymnasium.error.ResetNeeded):
        env.step([0.0, 0.0, 0.0])


def test_without_gymnasium_the_library_works_and_the_package_says_what_to_install():
    code = (
        "import sys\nsys.modules['gymnasium'] = None\nimport eel_dynamics\n"
        "try:\n    import eel_gym\nexcept ImportError as error:\n    print(error)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    (line,) = done.stdout.splitlines()
    assert line.startswith("eel_gym needs gymnasium") and "pip install gymnasium" in line


def test_a_task_of_ones_own_needs_a_reward_alone():
    class Fast(SwimmerEnv):
        """Swim fast."""

        name = "Fast"

        def reward(self):
            return float(self.head.velocity[0])

    assert Fast.__doc__.startswith("Swim fast.\n\nObserved, ") and "duration = 20.0" in Fast.__doc__
    env = Fast(scene=Scene(planar=True))
    env.reset(seed=1)
    for _ in range(100):
        observation, reward, *_ = env.step([0.0])
    assert reward > 0.2 and observation.shape == (4,)  # bend, its rate, phase of the wave
    assert "left_bend [rad/m], -0.5 to 0.5" in env.describe()


def test_each_episode_has_a_recording_of_its_own_also_one_that_stops(tmp_path, monkeypatch):
    pytest.importorskip("eel_viz")
    older = tmp_path / "Heading-0.rrd"
    older.write_bytes(b"of another environment")
    env = HeadingEnv(render_mode="rerun", recordings=tmp_path, control_period=0.1)
    assert env.metadata["render_fps"] == 10

    def stop(*_):
        return {0: SimulationStopped(0.1, "momentum is not finite", math.nan, "swim slower")}

    env.reset(seed=1)
    env.step(np.zeros(1))
    with monkeypatch.context() as patch:
        patch.setattr(SampledSwimmers, "advance", stop)
        assert "not finite" in env.step(np.zeros(1))[4]["stopped"]
    env.reset()
    env.step(np.zeros(1))
    with monkeypatch.context() as patch:  # what is not written whole leaves no file
        patch.setattr(Run, "to_rerun", lambda *_: 1 / 0)
        with pytest.raises(ZeroDivisionError):
            env.close()
    env.reset()
    env.step(np.zeros(1))
    env.close()
    assert sorted(path.name for path in tmp_path.iterdir()) == [f"Heading-{number}.rrd" for number in (0, 1, 3)]
    assert older.read_bytes() == b"of another environment"
    assert all((tmp_path / f"Heading-{number}.rrd").read_bytes().startswith(b"RRF") for number in (1, 3))
