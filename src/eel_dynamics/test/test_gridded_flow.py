# SPDX-License-Identifier: Apache-2.0
"""Flows between the points of a grid: their cubics, their files, and what a swimmer meets in them."""

import tracemalloc
from pathlib import Path

import h5py
import numpy as np
import pytest
from eel_dynamics.model.robot.robot import robot_of
from flow_files import write_flow
from scipy.io import netcdf_file

from eel_dynamics import (
    Batch,
    GriddedFlow,
    Run,
    Scene,
    Simulation,
    SimulationStopped,
    Uniform,
    Vortex,
    VortexStreet,
    simulate,
    simulate_batch,
)
from eel_gaits import falling, straight

QUICK = {"accuracy": 1e-2, "estimate": False, "sample_period": 0.25}
LAMINAR = Scene(friction="laminar")


def cubic(x, y, z, t):
    """A parabola along each axis, with all products: Catmull and Rom's cubics meet it exactly."""
    return np.stack([(1 + x - 0.3 * x**2) * (2 - t * t), (y**2 - y + 0.1 * z) * (1 + t), x * y * z**2 + t], axis=-1)


def grid_of(function, time, x, y, z, **options):
    t, *place = np.meshgrid(time, x, y, z, indexing="ij")
    return GriddedFlow(function(*place, t), time, x, y, z, **options)


def of_flow(flow, x, y, time=(0.0,), z=(0.0,), **options):
    """The grid of another flow."""

    def function(x, y, z, t):
        places = np.stack([x, y, z], axis=-1)
        return np.stack([flow.sample(places[k].reshape(-1, 3), t[k].flat[0]).velocity for k in range(len(t))]).reshape(
            places.shape
        )

    return grid_of(function, np.asarray(time), np.asarray(x), np.asarray(y), np.asarray(z), **options)


AXES = (np.array([0.0, 0.3, 1.0, 1.4]), np.linspace(-1.0, 2.0, 7), np.array([-1.0, 0.1, 0.7]), np.arange(-2.0, 3.0))


def test_parabolas_are_met_exactly_with_their_derivatives_on_uneven_axes():
    flow = grid_of(cubic, *AXES)
    rng, h = np.random.default_rng(1), 1e-30
    for time in (0.0, 0.2, 0.9, 1.4):
        places = np.stack([rng.uniform(axis[0], axis[-1], 50) for axis in AXES[1:]], axis=-1)
        got = flow.sample(places, time)
        complex_step = [
            cubic(*(places + 1j * h * np.eye(3)[axis]).T, time).imag / h
            if axis < 3
            else cubic(*places.T.astype(complex), time + 1j * h).imag / h
            for axis in range(4)
        ]
        assert np.allclose(got.velocity, cubic(*places.T, time), rtol=1e-12, atol=1e-12)
        assert np.allclose(got.jacobian, np.stack(complex_step[:3], axis=-1), rtol=1e-11, atol=1e-11)
        assert np.allclose(got.rate, complex_step[3], rtol=1e-11, atol=1e-11)


def test_velocity_jacobian_and_rate_are_continuous_and_match_differences():
    rng = np.random.default_rng(2)
    flow = GriddedFlow(rng.normal(size=(5, 6, 4, 3, 3)), np.arange(5) / 2, np.arange(6), np.arange(4), np.arange(3))
    rows = flow.velocity
    assert np.allclose(flow.sample([2.0, 1.0, 2.0], 1.5).velocity, rows[3, 2, 1, 2], atol=1e-14)
    step = 1e-7
    for axis, place in ((0, [2.0, 1.3, 0.7]), (1, [1.4, 2.0, 0.7]), (2, [1.4, 1.3, 1.0])):
        shift = step * np.eye(3)[axis]
        before, here, after = (flow.sample(np.array(place) + k * shift, 0.8) for k in (-1, 0, 1))
        for one, other in ((before.jacobian, after.jacobian), (before.rate, after.rate)):
            assert np.abs(one - other).max() < 1e-4
        assert np.allclose((after.velocity - before.velocity) / (2 * step), here.jacobian[:, axis], atol=1e-5)
    before, here, after = (flow.sample([1.4, 1.3, 0.7], 1.0 + k * step) for k in (-1, 0, 1))
    assert np.abs(before.rate - after.rate).max() < 1e-4
    assert np.allclose((after.velocity - before.velocity) / (2 * step), here.rate, atol=1e-5)


@pytest.mark.parametrize(
    ("robot", "arrays"), [(None, ("position",)), ("eight_servos", ("position", "joint_angle", "joint_torque"))]
)
def test_a_swimmer_on_a_finer_grid_of_a_vortex_swims_as_in_the_vortex(robot, arrays):
    """The Jacobian of the cubics misses by the second power of the cell: a sixteenth for a quarter of it. What is left
    of a swim of half a metre is some 1e-5 [m, rad, N m]."""
    vortex = Vortex(circulation=0.3, core=0.3, centre=(-0.5, 0.2, 0.0))
    options = {
        "accuracy": 1e-5,
        "scene": LAMINAR,
        "sample_period": 0.5,
        "estimate": False,
        "robot": robot_of(robot or ""),
    }
    exact, still = (simulate(straight(), 2.0, flow=flow, **options) for flow in (vortex, None))
    missed = []
    for cells in (40, 160):
        x = np.linspace(-2.0, 2.0, cells + 1)
        run = simulate(straight(), 2.0, flow=of_flow(vortex, x, x, wave=1.0), **options)
        missed.append([np.abs(getattr(run, name) - getattr(exact, name)).max() for name in arrays])
    assert max(missed[1]) < 2e-5 and np.min(np.divide(*missed)) > 12.0
    for name, error in zip(arrays, missed[1], strict=True):  # the vortex is felt: without it all is quite another swim
        assert np.abs(getattr(still, name) - getattr(exact, name)).max() > 100.0 * error


def test_the_ledger_closes_on_a_grid_that_changes_in_time():
    street = VortexStreet(circulation=0.2, core=0.25, count=3, start=(-1.0, 0.0, 0.0), drift=(0.3, 0.1, 0.0))
    x = np.linspace(-2.5, 1.5, 33)
    flow = of_flow(street, x, x, np.linspace(0.0, 1.5, 16)) + Uniform((0.05, 0.0, 0.02))
    run = simulate(falling(), 1.5, scene=LAMINAR, accuracy=1e-6, flow=flow, estimate=False, sample_period=0.25)
    assert np.abs(run.energy.residual).max() < 1e-6
    assert np.abs(run.energy.flow_work[-1]) > 1e-2
    assert run.closure_force.max() < 1e-11


def test_a_planar_scene_swims_on_a_grid_as_space_does():
    x = np.linspace(-2.0, 1.0, 25)
    flow = of_flow(Vortex(circulation=0.3, core=0.3), x, x)
    plane, space = (
        simulate(straight(), 1.0, scene=Scene(planar=planar), flow=flow, **QUICK) for planar in (True, False)
    )
    assert np.abs(plane.position - space.position).max() < 1e-3


def test_threads_change_nothing():
    x = np.linspace(-3.0, 3.0, 25)
    flows = [of_flow(Vortex(core=core), x, x) for core in (0.3, 0.4, 0.5)]
    one, two = (simulate_batch(straight(), 0.5, flows=flows, threads=threads, **QUICK) for threads in (1, 3))
    assert np.array_equal(one.position, two.position)


STILL = np.zeros((2, 2, 2, 3))
SMALL = {"x": (-1.2, 0.3), "y": (-1.0, 1.0), "z": (-1.0, 1.0)}


def towards(speed):
    return GriddedFlow(STILL + np.array([speed, 0.0, 0.0]), **SMALL)


def test_a_swimmer_that_leaves_the_grid_stops_with_place_and_time():
    with pytest.raises(SimulationStopped, match=r"stopped at t = 1\.\d+ s: the swimmer has left the grid") as caught:
        simulate(straight(), 5.0, flow=towards(0.2), **QUICK)
    stopped = caught.value
    assert "beyond x -1.2 to 0.3 m" in stopped.quantity and 0.3 <= stopped.value < 0.301
    assert stopped.run.time[-1] == pytest.approx(0.25 * (len(stopped.run.time) - 1)) and len(stopped.run.time) > 3
    assert stopped.time == pytest.approx(stopped.run.time[-1], abs=0.25) and stopped.run.position[-1, 0] < 0.3


def test_the_others_of_a_batch_go_on():
    batch = simulate_batch(straight(), 2.0, flows=[towards(0.3), None], **QUICK)
    assert batch.stopped.tolist() == [True, False]
    assert "left the grid" in str(batch.error[0])


def test_a_simulation_that_would_leave_the_grid_stands_where_it_was_and_goes_on():
    simulation = Simulation(law=straight(), flow=towards(0.3), accuracy=1e-3)
    with pytest.raises(SimulationStopped, match="left the grid"):
        simulation.advance(5.0)
    assert simulation.time < 5.0 and simulation.head.position[0] < 0.3
    simulation.set_state((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0), np.zeros(6))
    simulation.advance(simulation.time + 0.2)
    assert np.isfinite(simulation.observe().force).all()


def test_a_run_longer_than_the_grid_s_times_is_refused_and_a_march_stops_there():
    flow = GriddedFlow(np.zeros((3, 3)), time=(0.0, 0.5, 1.0))
    with pytest.raises(ValueError, match="flow time must cover the run, 0 to 2 s, got 0 to 1 s"):
        simulate(straight(), 2.0, flow=flow)
    with pytest.raises(ValueError, match="flow time must cover the run"):
        simulate_batch(straight(), 2.0, flows=flow)
    with pytest.raises(ValueError, match="flow time must cover the run, 0 to 0 s, got 1 to 2 s"):
        Simulation(flow=GriddedFlow(np.zeros((2, 3)), time=(1.0, 2.0)))
    simulate(straight(), 1.0, flow=flow, **QUICK)
    simulation = Simulation(law=straight(), flow=flow, accuracy=1e-2)
    with pytest.raises(SimulationStopped, match=r"stopped at t = 1 s: .* beyond time 0 to 1 s"):
        simulation.advance(2.0)
    assert simulation.time == 0.0


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: GriddedFlow(STILL, x=(1, 0), y=(0, 1), z=(0, 1)), r"flow x must rise, got \[1.0, 0.0\]"),
        (lambda: GriddedFlow(STILL, x=(0, 1), y=(0, 0), z=(0, 1)), "flow y must rise"),
        (lambda: GriddedFlow(STILL, x=(0, 1), y=(0, 1)), r"flow velocity must have shape \(2, 2, 3\)"),
        (
            lambda: GriddedFlow(STILL * np.nan, **SMALL),
            r"finite, got \[nan nan nan\]|finite, got nan at \(-1.2, -1, -1\)",
        ),
        (lambda: GriddedFlow(STILL, **SMALL, wave=0.0), "flow wave must be > 0 m"),
        (lambda: GriddedFlow.of(3.0), "flow source must be an xarray.Dataset or a path"),
        (lambda: Simulation(scene=Scene(planar=True), flow=GriddedFlow(STILL + 1.0, **SMALL)), "stay in the plane"),
        (
            lambda: Simulation(position=(0.5, 0, 0), flow=towards(0.0)),
            "position must lie in the grid of the flow, x -1.2",
        ),
        (lambda: Simulation(flow=GriddedFlow(STILL, x=(-0.5, 1), y=(-1, 1), z=(-1, 1))), "left the grid .*-0.5 to 1 m"),
        (lambda: towards(0.0).sample([0.0, 2.0, 0.0]), "places must lie in the grid of the flow, y -1 to 1 m"),
    ],
)
def test_what_does_not_fit_is_named(make, message):
    with pytest.raises((ValueError, SimulationStopped), match=message):
        make()


def written(
    path: Path,
    units="m/s",
    time_units="seconds since 2020-01-01",
    names=("u", "v", "w"),
    positive="up",
    along=("z", "y", "time", "x"),
):
    """A file of the classic format with dimensions in another order."""
    t, x, y, z = np.array([10.0, 10.5, 11.0]), np.arange(3.0), np.arange(4.0), np.arange(2.0)
    with netcdf_file(path, "w") as file:
        for name, axis in (("z", z), ("y", y), ("time", t), ("x", x)):
            file.createDimension(name, len(axis))
            file.createVariable(name, "d", (name,))[:] = axis
        file.variables["time"].units = time_units
        file.variables["z"].positive = positive
        values = np.arange(72.0).reshape(2, 4, 3, 3)
        for k, name in enumerate(names):
            variable = file.createVariable(name, "f", along if k < 2 else ("y", "x"))
            variable.units = units
            variable[:] = np.resize(values + k, variable.shape) if k < 2 else values[0, :, 0]
    return values


def test_a_file_is_read_by_dimensions_as_xarray_reads_it(tmp_path):
    xarray = pytest.importorskip("xarray")
    path = tmp_path / "pool.nc"
    values = written(path)
    flow = GriddedFlow.of(path)
    assert flow.time.tolist() == [0.0, 0.5, 1.0] and flow.velocity.shape == (3, 3, 4, 2, 3)
    assert np.array_equal(flow.velocity[..., 0], values.transpose(2, 3, 1, 0))
    assert np.array_equal(flow.velocity[1, :, :, 1, 2], values[0, :, 0].T)
    with xarray.open_dataset(path) as data:
        assert GriddedFlow.of(data) == flow
    assert hash(GriddedFlow.of(path)) == hash(flow) and flow != GriddedFlow.of(path, wave=1.0)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"units": "cm/s"}, "flow velocity must be in m/s, got units 'cm/s'"),
        ({"time_units": "fortnights"}, "flow time must be in seconds, minutes, hours or days, got units 'fortnights'"),
        ({"names": ("vx", "v", "w")}, "flow file must have a variable 'u'"),
        ({"positive": "down"}, "flow z must rise upwards"),
        ({"positive": "Down"}, "flow z must rise upwards"),
        ({"positive": 1.0, "units": b"m\xb7s-1"}, r"flow velocity must be in m/s, got units .*xb7s-1"),
        ({"time_units": b"\xb5s"}, r"flow time must be in seconds, .*got units .*xb5s"),
        ({"along": ("y", "y", "time", "x")}, r"flow 'u' must have each of its dimensions once, got \('y', 'y', 't"),
    ],
)
def test_a_file_that_does_not_fit_is_named(tmp_path, options, message):
    written(tmp_path / "pool.nc", **options)
    with pytest.raises(ValueError, match=message):
        GriddedFlow.of(tmp_path / "pool.nc")


def test_a_damaged_file_is_named(tmp_path):
    written(tmp_path / "pool.nc")
    content = (tmp_path / "pool.nc").read_bytes()
    for part in (b"", content[:40], content[: len(content) // 2], b"no flow"):
        (tmp_path / "pool.nc").write_bytes(part)
        with pytest.raises(ValueError, match=r"flow file .*pool\.nc"):
            GriddedFlow.of(tmp_path / "pool.nc")


@pytest.mark.parametrize("suffix", [".nc", ".h5"])
def test_the_points_of_a_file_are_counted_before_any_is_made(tmp_path, suffix):
    path = tmp_path / f"small{suffix}"
    write_flow(path, 12)
    assert GriddedFlow.of(path).velocity.shape == (12, 12, 12, 12, 3)
    write_flow(path, 60)
    tracemalloc.start()
    with pytest.raises(ValueError, match=r"small.*: flow must have at most 3000000 points, got 12960000 \(time 60, x"):
        GriddedFlow.of(path)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert path.stat().st_size < 100_000 and most < 5e6  # the points would take 3e8


def test_a_netcdf_4_file_that_states_more_than_it_holds_is_refused(tmp_path):
    path = tmp_path / "empty.nc"
    with h5py.File(path, "w") as file:
        for name in ("u", "v", "x"):
            file.create_dataset(name, (10**12,), "f8", chunks=(1000,))
        file["x"].make_scale("x")
        for name in "uv":
            file[name].dims[0].attach_scale(file["x"])
    with pytest.raises(ValueError, match="flow must have at most 3000000 points, got 1000000000000"):
        GriddedFlow.of(path)
    with h5py.File(path, "w") as file:  # the velocity fits, its coordinate does not
        file.create_dataset("x", (10**12,), "f8", chunks=(1000,)).make_scale("x")
        for name in "uv":
            file[name] = np.zeros(8)
            file[name].dims[0].attach_scale(file["x"])
    with pytest.raises(ValueError, match="'/x' must have at most 24000000 bytes"):
        GriddedFlow.of(path)


def test_a_netcdf_4_file_is_read_with_its_scale_and_its_missing_values(tmp_path):
    path = tmp_path / "tank.nc"
    with h5py.File(path, "w") as file:
        file["time"], file["x"] = np.arange(3) * 500, np.array([0.0, 1.0])
        file["time"].attrs["units"] = "milliseconds since 2020-01-01"
        for name in ("time", "x"):
            file[name].make_scale(name)
        for name in "uv":
            file.create_dataset(name, data=np.array([[1, 2, 3], [4, 5, 6]], "i2"), compression="gzip", shuffle=True)
            file[name].attrs.update(
                {"scale_factor": 0.5, "add_offset": 1.0, "_FillValue": np.int16(-9), "units": "m/s"}
            )
            for place, axis in enumerate(("x", "time")):
                file[name].dims[place].attach_scale(file[axis])
    flow = GriddedFlow.of(path)
    assert flow.time.tolist() == [0.0, 0.5, 1.0] and flow.velocity.shape == (3, 2, 1, 1, 3)
    assert flow.velocity[:, 1, 0, 0, 0].tolist() == [3.0, 3.5, 4.0]
    with h5py.File(path, "a") as file:
        file["u"][0, 1] = -9
    with pytest.raises(ValueError, match=r"flow velocity must be finite, got nan at \(0, 0, 0\) m and 0.5 s"):
        GriddedFlow.of(path)


def test_runs_and_batches_are_saved_with_their_grid(tmp_path):
    x = np.linspace(-2.0, 1.0, 13)
    flow = of_flow(Vortex(), x, x) + Uniform((0.1, 0.0, 0.0))
    run = simulate(straight(), 0.5, flow=flow, **QUICK)
    run.save(tmp_path / "run.nc")
    loaded = Run.load(tmp_path / "run.nc")
    assert loaded == run and loaded.refined.flow == flow
    batch = simulate_batch(straight(), 0.5, flows=[flow, None], **QUICK)
    batch.save(tmp_path / "batch.nc")
    assert Batch.load(tmp_path / "batch.nc") == batch
