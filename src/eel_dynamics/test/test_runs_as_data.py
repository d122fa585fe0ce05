# SPDX-License-Identifier: Apache-2.0
"""Runs and batches as data: files, pickles, labelled arrays and tables hold them whole."""

import json
import pickle
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest
from eel_common.version import software
from eel_dynamics.analysis.measures import measures_of
from eel_dynamics.commands import simulate as command
from eel_dynamics.model.equality import same
from eel_dynamics.runs.storage import netcdf

from eel_dynamics import (
    Accuracy,
    Batch,
    Body,
    Fin,
    Robot,
    Run,
    Scene,
    Simulation,
    SimulationStopped,
    simulate,
    simulate_batch,
)
from eel_gaits import Law, Ramp, Term, falling, kern_fast, straight, turning

DATA = Path(__file__).parent / "data"
SHORT = {"accuracy": 1e-2, "sample_period": 0.1, "stations": 7}


def by_functions() -> Body:
    """A body whose half-axes are functions of the user's own, of which no file can hold the code."""
    return Body(
        length=0.8,
        half_width=lambda x: 0.04 * np.sqrt(np.sin(np.pi * np.minimum(x, 0.8) / 0.82)),
        half_height=lambda x: 0.09 * np.sqrt(x * (0.9 - x)),
        density=950.0,
        name="mine",
    )


def by_arrays() -> Body:
    x = np.linspace(0.0, 1.2, 40)
    return Body(
        x=x, half_width=0.05 * np.sqrt(x * (1.3 - x)), half_height=0.06 * np.sqrt(x), kinks=(0.3,), nose_drag=0.1
    )


@pytest.fixture(scope="module")
def run() -> Run:
    scene = Scene(friction="laminar", current=(0.1, 0.0, -0.2), density=990.0)
    return simulate(
        falling(period=0.7), 2.0, scene=scene, body=by_arrays(), load=True, twist=(0, 0, 0, 0.2, 0, 0), **SHORT
    )


@pytest.fixture(scope="module")
def batch() -> Batch:
    scenes = [Scene(), Scene(internal_wrench=False), Scene(ledger=False), Scene(density=10.0, reactive=False)]
    settings = [*["draft"] * 3, Accuracy(name="long steps", resolution=10.0, step=0.05)]
    laws = [straight(), turning(), kern_fast(), straight()]
    return simulate_batch(laws, 2.0, scenes=scenes, accuracy=settings, sample_period=0.1, stations=5)


def test_a_saved_run_is_loaded_equal(run, tmp_path):
    run.save(tmp_path / "run.nc")
    again = Run.load(tmp_path / "run.nc")
    assert again == run and hash(again) == hash(run) and again.warnings == run.warnings
    assert all(type(getattr(again, item.name)) is type(getattr(run, item.name)) for item in fields(Run))
    assert again.summary() == run.summary() and again.refined == run.refined
    assert again.refined.fluid_force.shape == run.fluid_force.shape  # asked for again
    changed = run.position.copy()
    changed[-1, 2] = np.nextafter(changed[-1, 2], 1.0)
    assert replace(run, position=changed) != run and replace(run, steps=run.steps + 1) != run


@pytest.mark.parametrize(
    "scene, stations",
    [(Scene(internal_wrench=False, ledger=False, planar=True), 2), (Scene(friction="none"), [0.2, 0.7])],
)
def test_what_a_run_lacks_stays_away(scene, stations, tmp_path):
    run = simulate(straight(), 0.5, scene=scene, stations=stations, accuracy=1e-2, estimate=False)
    run.save(tmp_path / "run.nc")
    assert Run.load(tmp_path / "run.nc") == run and run.error_estimate is None and run.fluid_force is None


def test_a_body_of_functions_is_saved_as_polynomials(tmp_path):
    run = simulate(straight(), 0.5, body=by_functions(), **SHORT)
    run.save(tmp_path / "run.nc")
    again = Run.load(tmp_path / "run.nc")
    x = np.linspace(0.0, 0.8, 301)
    assert again.body.half_width(x) == pytest.approx(run.body.half_width(x), abs=1e-12)
    assert again.body.half_height(x) == pytest.approx(run.body.half_height(x), abs=1e-12)
    swum = simulate(straight(), 0.5, body=again.body, **SHORT)
    assert np.abs(swum.position - run.position).max() < 1e-9
    swum.save(tmp_path / "again.nc")
    assert Run.load(tmp_path / "again.nc") == swum
    kinked = Body(length=1.0, half_width=lambda x: 0.05 * np.minimum(np.sqrt(x), 0.4), half_height=np.sqrt)
    with pytest.warns(UserWarning, match="body half_width is saved as a polynomial that misses it by up to .* kinks"):
        simulate(straight(), 0.1, body=kinked, **SHORT).save(tmp_path / "kinked.nc")


@pytest.mark.parametrize(
    "thing",
    [
        *(
            Body.boyer2010(),
            Body.kern2006(0.7),
            by_arrays(),
            Scene(friction="none", planar=True),
            falling(),
            kern_fast(),
        ),
        Accuracy.of("fine"),
        Law(Term(amplitude=(1.0,), envelope=(Ramp(0.0, 1.0, 1.0),)), name="mine", transition=2.0),
    ],
    ids=str,
)
def test_a_pickle_is_equal(thing):
    again = pickle.loads(pickle.dumps(thing))
    assert again == thing and hash(again) == hash(thing) and len(repr(thing)) < 300


def test_what_holds_arrays_is_shown_in_a_line(run, batch):
    assert repr(run) == "Run('falling', 'body', 2 s, 21 samples, 7 stations, accuracy '0.01')"
    assert repr(batch) == "Batch(4 swimmers, 21 samples, 5 stations, 1 stopped)"
    assert repr(run.energy) == "EnergyLedger(21 samples)" and repr(run.law) == "Law('falling', 2 terms)"
    assert repr(Scene()) == "Scene()" and repr(Scene(planar=True)) == "Scene(planar=True)"
    assert eval(repr(Accuracy.of("fine"))) == Accuracy.of("fine")


def test_pickled_runs_and_batches_are_equal(run, batch):
    assert pickle.loads(pickle.dumps(run)) == run
    again = pickle.loads(pickle.dumps(batch))
    assert again == batch and all(again[index] == batch[index] for index in range(len(batch)))
    stopped = pickle.loads(pickle.dumps(batch.error[3]))
    assert isinstance(stopped, SimulationStopped) and str(stopped) == str(batch.error[3]) and stopped.time > 0.0


def test_not_a_number_is_equal_to_itself_alone():
    nan = float("nan")
    assert same(nan, float("nan")) and not same(nan, 1.0) and not same(1.0, nan)
    assert same([np.array([nan])], [np.array([nan])]) and not same([np.array([nan])], [np.array([1.0])])


def test_bodies_are_equal_by_value_alone():
    assert by_arrays() == by_arrays() and by_arrays() != by_arrays().changed(nose_drag=0.2)
    assert Body.boyer2010() != Body.boyer2010().changed(name="other") and by_functions() != by_functions()
    assert Body.boyer2010().changed(lateral_drag=1.0).lateral_drag == 1.0
    with pytest.raises(ValueError, match="body has no 'colour', it has: half_width"):
        Body.boyer2010().changed(colour="red")


def test_a_saved_batch_is_loaded_equal(batch, tmp_path):
    batch.save(tmp_path / "batch.nc")
    again = Batch.load(tmp_path / "batch.nc")
    assert again == batch and again.stopped.tolist() == [False, False, False, True]
    assert [again[index] for index in range(4)] == [batch[index] for index in range(4)]
    motion = simulate_batch([straight(), turning()], 0.4, accuracy=1e-2)
    motion.save(tmp_path / "motion.nc")
    assert Batch.load(tmp_path / "motion.nc") == motion and motion.backbone is None


def test_a_batch_is_a_table(batch):
    pytest.importorskip("pandas")
    table = batch.analysis()
    for index in range(3):
        wanted, row = measures_of(batch[index]), table.loc[index]
        assert all(np.array_equal(row[name], value, equal_nan=True) for name, value in wanted.items())
        assert row["error"] == ""
    assert np.isnan(table.head_x[3]) and table.error[3] == str(batch.error[3])
    frame = batch.to_dataframe()
    assert frame.loc[1].index.tolist() == batch.time.tolist() and len(frame.loc[3]) == batch.samples[3] < len(
        batch.time
    )


def test_labelled_arrays_and_columns(run, batch):
    pytest.importorskip("xarray")
    data = run.to_xarray()
    assert np.array_equal(data.position.sel(world="z", time=run.time[-1]), run.position[-1, 2])
    assert np.array_equal(data.torque.sel(section="3").isel(station=2), run.torque[:, 2, 2])
    assert data.torque.attrs["units"] == "N m" and data.attrs["software"] == software()
    assert json.loads(data.attrs["eel"])["law"]["name"] == "falling"
    assert np.array_equal(batch.to_xarray().backbone[1], batch.backbone[1])
    frame = run.to_dataframe()
    assert np.array_equal(frame.v_x, run.twist[:, 3]) and np.array_equal(frame.wake_work, run.energy.wake_work)


def test_xarray_opens_what_was_saved(run, tmp_path):
    xarray = pytest.importorskip("xarray")
    run.save(tmp_path / "run.nc")
    with xarray.open_dataset(tmp_path / "run.nc", engine="scipy") as data:
        assert np.array_equal(data.fluid_force, run.fluid_force) and data.fluid_force.attrs["units"] == "N/m"


@pytest.mark.parametrize("name, method", [("xarray", "to_xarray"), ("pandas", "to_dataframe")])
def test_a_missing_package_is_one_line(run, name, method, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, name, None)
    with pytest.raises(ImportError, match=rf"{method} needs {name} .* pip install {name}$"):
        getattr(run, method)()


def cut(data: bytes, part: float) -> bytes:
    return data[: int(part * len(data))]


@pytest.mark.fault(
    "names",
    "a file of a run that is truncated, of another kind or another version",
    "refused in one line that names it",
)
def test_files_that_are_no_runs_are_refused_in_one_line(run, batch, tmp_path, monkeypatch):
    path = tmp_path / "run.nc"

    def refused(words):
        with pytest.raises(ValueError, match=words) as error:
            Run.load(path)
        assert str(error.value).count("\n") == 0 and str(path)[:20] in str(error.value)

    refused("there is no such file")
    path.mkdir()
    refused("it is a folder")
    path.rmdir()
    run.save(path)
    whole = path.read_bytes()
    for part in (0.0, 0.001, 0.01, 0.1, 0.5, 0.999):
        path.write_bytes(cut(whole, part))
        refused("cannot be read")
    path.write_bytes(b"CDF\x02" + np.random.default_rng(5).bytes(4000))
    refused("cannot be read")
    path.write_text("time,position\n")
    refused("cannot be read")
    path.write_bytes(whole.replace(b'"friction": "laminar"', b'"friction": "syrupy!"'))
    refused("cannot be read: it is damaged, or was changed since it was saved: its content does not fit its digest")
    older = whole.replace(b"digest", b"Digest")
    path.write_bytes(older.replace(b'"friction": "laminar"', b'"friction": "syrupy!"'))
    with pytest.warns(UserWarning, match="has no digest"):
        refused("friction must be one of")
    path.write_bytes(older.replace(b'"nodes"', b'"modes"'))
    with pytest.warns(UserWarning, match="has no digest"):
        refused("cannot be read: it is damaged or foreign .KeyError: 'nodes'")
    path.unlink()
    batch.save(path)
    refused("holds a batch, not a run")
    monkeypatch.setattr(netcdf, "FORMAT", 7)
    run.save(path)
    monkeypatch.undo()
    refused("has format 7, of eel-swimmer .* reads up to 2")
    with pytest.raises(ValueError, match=r"path must be that of a \.nc file, got 3"):
        Run.load(3)


def test_an_older_file_without_a_digest_is_loaded_with_a_line_that_says_so(run, tmp_path):
    run.save(tmp_path / "run.nc")
    (tmp_path / "run.nc").write_bytes((tmp_path / "run.nc").read_bytes().replace(b"digest", b"Digest"))
    with pytest.warns(
        UserWarning, match=r"^run file '.*run\.nc' has no digest, as older ones: damage .*not be seen$"
    ) as told:
        assert Run.load(tmp_path / "run.nc") == run
    assert len(told) == 1


def test_files_that_name_no_axes_have_the_paper_s_and_are_converted_with_one_line():
    """The files are of the software before its world had REP-103 axes."""
    twist, current = (-0.1, -0.2, 0.3, 0.4, -0.1, 0.05), (-0.2, -0.1, 0.0)
    with pytest.warns(UserWarning, match=r"^run file .*run\.nc' has the paper's axes, which are converted") as told:
        run = Run.load(DATA / "paper_axes_run.nc")
    again = simulate(run.law, 0.6, scene=run.scene, stations=4, sample_period=0.1, position=(-1, -2, 3), twist=twist)
    assert len(told) == 1 and run.scene.current == current and run.axes == "rep103"
    assert run.error_estimate.torque > 0.0 and run.error_estimate.twist is None  # which it did not know
    for name in ("position", "orientation", "twist", "head_acceleration", "backbone", "section_orientation", "torque"):
        assert getattr(run, name) == pytest.approx(getattr(again, name), abs=1e-9), name
    with pytest.warns(UserWarning, match=r"^batch file .*batch\.nc' has the paper's axes, which are converted") as told:
        batch = Batch.load(DATA / "paper_axes_batch.nc")
    options = {"twists": [twist, (0,) * 6], "sample_period": 0.1, "accuracy": 1e-2}
    again = simulate_batch(batch.laws, 0.3, scenes=batch.scenes, **options)
    assert len(told) == 1 and batch.scenes[0].current == current
    for name in ("position", "orientation", "twist"):
        assert getattr(batch, name) == pytest.approx(getattr(again, name), abs=1e-9), name


def test_files_and_tables_say_which_axes_they_have(run, batch, tmp_path):
    pytest.importorskip("xarray")
    pytest.importorskip("pandas")
    for each in (run, batch):
        assert each.to_xarray().attrs["axes"] == "rep103" == each.to_dataframe().attrs["axes"]
    run.in_axes("paper").save(tmp_path / "run.nc")
    with pytest.warns(UserWarning, match="has the paper's axes, which are converted to those of REP-103$"):
        assert Run.load(tmp_path / "run.nc") == run
    content = (tmp_path / "run.nc").read_bytes().replace(b"paper", b"papal").replace(b"digest", b"Digest")
    (tmp_path / "run.nc").write_bytes(content)
    with (
        pytest.warns(UserWarning, match="no digest"),
        pytest.raises(ValueError, match="its axes must be rep103 or paper, got 'papal'"),
    ):
        Run.load(tmp_path / "run.nc")


def test_paths_that_do_not_fit_are_refused(run, tmp_path):
    for path, words in (
        (tmp_path / "run.txt", "must be a path that ends in .nc"),
        (tmp_path / "no" / "run.nc", "no folder"),
    ):
        with pytest.raises(ValueError, match=words):
            run.save(path)
    (tmp_path / "other.nc").write_text("a diary")
    with pytest.raises(ValueError, match="a file of another kind"):
        run.save(tmp_path / "other.nc")
    empty = replace(run, **{item.name: getattr(run, item.name)[:0] for item in fields(Run) if item.name == "time"})
    with pytest.raises(ValueError, match="without samples"):
        empty.save(tmp_path / "empty.nc")


def test_the_command_saves_a_run(tmp_path, capsys):
    out = tmp_path / "run.nc"
    assert command.main(f"straight --duration 1 --accuracy 1e-2 --stations 5 --out {out}".split()) == 0
    assert Run.load(out) == simulate(straight(), 1.0, accuracy="1e-2", stations=5)
    assert command.main(f"--out {tmp_path}/run.nv".split()) == 2
    assert "must end in .nc, .npz, .csv or .rrd" in capsys.readouterr().err


def test_the_default_sampling_suits_any_gait():
    for period, sample in ((0.05, 0.0025), (0.2, 0.01), (1.0, 0.05), (3.0, 0.05)):
        run = simulate(straight(period=period), 2.0 * period, accuracy=1e-2, stations=5, estimate=False)
        assert run.time[1] == pytest.approx(sample) and run.time[-1] == pytest.approx(2.0 * period)
        assert run.mean_speed == run.analysis().mean_speed > 0.0
    assert len(simulate(Law(), 0.1, stations=2).time) == 3
    odd = simulate(straight(period=0.3), 1.0, accuracy=1e-2, stations=5, estimate=False)
    assert odd.time[-1] == pytest.approx(1.0) and odd.time[1] <= 0.015
    both = simulate_batch([straight(period=0.2), straight()], 1.0, accuracy=1e-2, stations=5)
    assert both.time[1] == pytest.approx(0.01)
    long = simulate(straight(period=1e-2), 0.06, accuracy=0.1, stations=2, estimate=False, sample_period=0.05)
    with pytest.raises(ValueError, match="8 samples or more"):
        _ = long.mean_speed


def test_a_gait_that_has_not_settled_is_told():
    run = simulate(straight(), 12.0, accuracy=1e-2, stations=5)
    early, late = replace_time(run, 4.0).analysis(), run.analysis(2)
    assert (
        not early.settled
        and early.speed_change > 0.05
        and "NOT settled: the mean speed changes by" in early.run.summary()
    )
    assert late.speed_change < early.speed_change and late.settled == (late.speed_change <= 0.01)
    centre = run.center_of_mass
    change = np.linalg.norm(centre[240] - centre[220]) - np.linalg.norm(centre[220] - centre[200])
    assert late.speed_change == pytest.approx(abs(change) / late.mean_speed, rel=1e-6)
    one = replace_time(run, 1.0)
    assert one.analysis().speed_change is None and not one.analysis().settled
    assert "NOT settled: it takes 3 periods to tell, got 1" in one.summary()


def replace_time(run: Run, end: float) -> Run:
    """The run until `end` [s]."""
    return simulate(run.law, end, accuracy=1e-2, stations=5)


def test_a_run_that_begins_later_is_not_simulated_again():
    """The start of its motion is not known."""
    run = simulate(straight(), 1.0, accuracy="draft", estimate=False, stations=3)
    assert run.refined.fluid_force is None  # as the run
    later = replace(run, time=run.time + 3.0)
    with pytest.raises(ValueError, match="run must begin at t = 0 to be simulated again, got 3 s"):
        later.refined  # noqa: B018


@pytest.mark.parametrize(
    "parts", [{"fins": Fin.pair(0.2, 1e-3, 2.5)}, {"robot": Robot.named("eight_servos")}], ids=list
)
def test_a_run_of_snapshots_is_the_run_that_is_simulated(parts):
    run = simulate(straight(), 0.3, sample_period=0.1, stations=11, load=True, estimate=False, **parts)
    simulation, snapshots = Simulation(law=straight(), stations=11, **parts), []
    for time in run.time:
        simulation.advance(time)
        snapshots.append(simulation.observe())
    told = Run.of_snapshots(snapshots, simulation, simulation.law)
    for name, expected in ((item.name, getattr(run, item.name)) for item in fields(run)):
        found = getattr(told, name)
        if isinstance(expected, np.ndarray):  # a robot's are normalised at another place: round-off
            assert np.allclose(found, expected, rtol=0.0, atol=1e-14), name
        elif name not in ("steps", "evaluations", "nodes", "energy"):
            assert found == expected, name
    assert np.array_equal(told.energy.residual, run.energy.residual)
    assert told.energy.actuator_work[-1] != 0.0 and (told.fin_force is None) != (told.joint_torque is None)
