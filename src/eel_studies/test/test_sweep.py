# SPDX-License-Identifier: Apache-2.0
"""Sweeps over grids of parameters, in threads or on Dask: labelled, equal to single runs, whole after a lost worker."""

import errno
import json
import os
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest
from eel_common.wording import shown
from eel_dynamics.analysis.measures import measures_of
from eel_dynamics.batches.simulate_batch import swum
from eel_dynamics.runs.swim import Swim
from eel_studies.points import base_of, point_at
from eel_studies.sweeps import command as sweep_command
from eel_studies.sweeps.command import main
from eel_studies.sweeps.sweep_key import key_of
from eel_studies.sweeps.sweep_picture import draw_sweep

from eel_dynamics import (
    Accuracy,
    Batch,
    Body,
    Fin,
    FlowField,
    Gust,
    RollHold,
    Run,
    Scene,
    Shear,
    VortexStreet,
    load_scene,
    simulate,
)
from eel_gaits import Law, Term, sampled, straight
from eel_studies import sweep

xarray = pytest.importorskip("xarray")
distributed = pytest.importorskip("distributed")

SHORT = {"duration": 1.2, "accuracy": 1e-2, "stations": 11}


@pytest.fixture(scope="module")
def client():
    """Two worker processes, which are started again when they die."""
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address="127.0.0.1:0") as cluster,
        distributed.Client(cluster) as client,
    ):
        yield client


def test_labelled_and_equal_to_single_runs(client, tmp_path):
    grid = {"period": np.array([0.5, 0.8]), "scene.friction": ["laminar", "none"], "body": ["boyer2010", "kern2006"]}
    out = tmp_path / "periods.nc"
    data = sweep(grid, scheduler=client, out=out, **SHORT)
    assert dict(data.sizes) == {"period": 2, "scene.friction": 2, "body": 2}
    point = data.sel({"period": 0.8, "scene.friction": "none", "body": "kern2006"})
    run = simulate(straight(period=0.8), body=Body.kern2006(), scene=Scene(friction="none"), **SHORT)
    alone = measures_of(run)
    assert alone["mean_speed"] == run.analysis().mean_speed and alone["greatest_torque"] > 0.0
    for name, value in alone.items():
        assert np.array_equal(float(point[name]), value, equal_nan=True), name
    assert data.mean_speed.attrs["units"] == "m/s" and data.attrs["gait"] == "straight"
    assert not data.stopped.any()
    kept = xarray.load_dataset(out, engine="scipy")
    assert kept.attrs["sweep"] == data.attrs["sweep"] and kept.head_x.equals(data.head_x)
    assert list(kept["scene.friction"].values) == ["laminar", "none"]
    assert not out.with_name("periods.nc.parts").exists()
    # what is complete is not simulated again
    assert sweep(grid, scheduler="tcp://127.0.0.1:1", out=out, **SHORT).head_x.equals(data.head_x)


SCENE = """
gait: straight
period: 0.8
duration: 1.2
accuracy: 1e-2
stations: 11
scene: {planar: true}
initial_linear_velocity: [0.2, 0, 0]
flow: gust velocity=0.1,0,0
"""


def test_a_scene_of_a_file_is_swept(tmp_path, capsys):
    scene, out = tmp_path / "scene.yaml", tmp_path / "out.nc"
    scene.write_text(SCENE)
    swim = load_scene(scene)
    words = "--vary period=0.6,0.8 --vary flow.rise=0.5,1 --measures mean_speed,greatest_torque"
    assert main([str(scene), *words.split(), "--scene", "friction=laminar", "--out", str(out)]) == 0
    kept = xarray.load_dataset(out, engine="scipy")
    assert kept.attrs["gait"] == "straight" and kept.attrs["duration"] == 1.2
    laminar = swim.with_gait(period=0.6).changed(scene=Scene(planar=True, friction="laminar"))
    alone = measures_of(laminar.changed(flow=Gust(velocity=(0.1, 0.0, 0.0), rise=0.5)).run())
    for name in ("mean_speed", "greatest_torque"):
        assert float(kept[name].sel({"period": 0.6, "flow.rise": 0.5})) == alone[name]
    data = sweep({"period": [0.6]}, gait=swim, accuracy=1e-3, measure=("mean_speed",))  # what is given comes first
    assert float(data.mean_speed[0]) == swim.with_gait(period=0.6).run(accuracy=1e-3).mean_speed
    assert main([str(scene), "--vary", "periode=1,2", "--out", str(tmp_path / "no.nc")]) == 2
    assert "did you mean 'period'?" in capsys.readouterr().err


def test_a_gait_may_return_rows(tmp_path):
    def rows(period, wavelength=1.0):
        return sampled(straight(period=period, wavelength=wavelength).curvature, 1.2)

    out = tmp_path / "rows.nc"
    data = sweep({"period": [0.5, 0.8]}, gait=rows, out=out, **SHORT)
    alone = measures_of(simulate(rows(0.8), **SHORT))
    assert not data.stopped.any() and float(data.head_x.sel(period=0.8)) == alone["head_x"]
    assert sweep({"period": [0.5, 0.8]}, gait=rows, out=out, **SHORT).equals(data)
    with pytest.raises(ValueError, match="not of this sweep"):
        sweep({"period": [0.5, 0.8]}, gait=rows, numbers={"wavelength": 0.9}, out=out, **SHORT)


def test_the_limit_of_evaluations_can_be_raised_and_lowered(client, tmp_path):
    def final_time(run):  # by value to the workers, which do not know this file
        return {"final_time": float(run.time[-1])}

    grid, out = {"period": [0.8]}, tmp_path / "sweep.nc"
    lowered = sweep(grid, scheduler=client, out=out, most_evaluations=5.0, **SHORT)
    assert "most_evaluations is 5" in str(lowered.error.values[0])
    with pytest.raises(ValueError, match="not of this sweep"):  # other results, so another sweep
        sweep(grid, scheduler=client, out=out, **SHORT)
    with pytest.raises(ValueError, match="most_evaluations must be"):
        sweep(grid, scheduler=client, most_evaluations=0.0, **SHORT)

    def quick(period):
        return Law(Term(amplitude=(5.0, 1.0), wavelength=1.0, period=period), name="quick")

    short = {"duration": 1e-4, "sample_period": 1e-5, "accuracy": 1e-2, "stations": 5}
    sudden = {"grid": {"period": [1e-5]}, "gait": quick, "measure": final_time, "scheduler": client, **short}
    assert sweep(**sudden).stopped.all()
    raised = sweep(**sudden, most_evaluations=1e8)
    assert not raised.stopped.any() and float(raised.final_time[0]) == pytest.approx(1e-4)


def test_a_lost_worker_costs_time_only(client):
    grid = {"period": np.linspace(0.5, 1.0, 12)}
    whole = sweep(grid, scheduler=client, chunk=1, **SHORT)
    victims = list(client.run(os.getpid).values())
    told = []

    def kill_one(done, points):
        told.append(done)
        if done == 1:
            os.kill(victims[0], signal.SIGKILL)

    again = sweep(grid, scheduler=client, chunk=1, progress=kill_one, **SHORT)
    assert "sweep" not in again.attrs  # its key costs time, and serves the output alone
    assert told == list(range(13))
    assert victims[0] not in client.run(os.getpid).values()
    assert again.identical(whole)


def test_goes_on_where_it_was_broken_off(client, tmp_path):
    grid, out = {"period": [0.5, 0.6, 0.7, 0.8]}, tmp_path / "sweep.nc"
    whole = sweep(grid, scheduler=client, **SHORT)

    class BrokenOff(Exception):
        pass

    def break_off(done, points):
        if done == 2:
            raise BrokenOff

    with pytest.raises(BrokenOff):
        sweep(grid, scheduler=client, out=out, chunk=1, progress=break_off, **SHORT)
    assert not out.exists()
    with pytest.raises(ValueError, match="another sweep"):
        sweep({"period": [0.5, 0.6]}, scheduler=client, out=out, **SHORT)
    told = []
    data = sweep(grid, scheduler=client, out=out, chunk=1, progress=lambda *pair: told.append(pair), **SHORT)
    assert told == [(2, 4), (3, 4), (4, 4)]
    assert data.equals(whole)
    with pytest.raises(ValueError, match="another out"):
        sweep({"period": [0.5, 0.6]}, scheduler=client, out=out, **SHORT)


@pytest.mark.fault(
    "names",
    "parts of a sweep that hold text, NaN or half of what they held, or nothing",
    "said in one line; their points are simulated again, the others are kept",
)
def test_damaged_parts_are_done_again(client, tmp_path, capsys):
    grid, out = {"period": [0.5, 0.6, 0.7, 0.8, 0.9]}, tmp_path / "sweep.nc"
    whole = sweep(grid, scheduler=client, **SHORT)

    def interrupt(done, points):
        if done == points:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sweep(grid, scheduler=client, out=out, chunk=1, progress=interrupt, **SHORT)
    parts = sorted((tmp_path / "sweep.nc.parts").glob("part-*.json"))
    texts = [part.read_text() for part in parts]
    (point,) = json.loads(texts[0])["points"].values()
    damaged = [texts[0].replace(f'"head_x": {point["head_x"]}', text) for text in ('"head_x": "far"', '"head_x": NaN')]
    digit = texts[2].index(".") + 5
    damaged += [
        texts[2][:digit] + chr(ord(texts[2][digit]) ^ 1) + texts[2][digit + 1 :],
        texts[3][: len(texts[3]) // 2],
    ]
    assert len(parts) == 5 and texts[0] not in damaged
    for part, text in zip(parts, damaged, strict=False):
        part.write_text(text)
    told = []
    with pytest.warns(UserWarning, match="is damaged .* its points are done again") as warned:
        again = sweep(grid, scheduler=client, out=out, progress=lambda *pair: told.append(pair), **SHORT)
    assert told[0] == (1, 5) and again.equals(whole)
    said = [str(each.message) for each in warned]
    reasons = "measure 'head_x' must be a real number, got 'far'", "NaN", "fit its digest", ""
    for part, reason in zip(parts, reasons, strict=False):
        assert sum(shown(str(part)) in line and reason in line for line in said) == 1


def test_what_a_sweep_is_of_is_known_or_it_is_refused(client, tmp_path):
    grid, out, folder = {"period": [0.5, 0.6]}, tmp_path / "sweep.nc", tmp_path / "sweep.nc.parts"
    folder.mkdir()
    (folder / "part-0-1-0.json").write_text("{}")
    (folder / "notes.txt").write_text("mine")
    for about in (None, "", '{"sweep"'):
        if about is not None:
            (folder / "sweep.json").write_text(about)
        with pytest.raises(ValueError, match=r"sweep\.nc\.parts holds parts of another sweep"):
            sweep(grid, scheduler=client, out=out, **SHORT)
    sweep(grid, scheduler=client, out=out, overwrite=True, **SHORT)
    assert out.exists() and os.listdir(folder) == ["notes.txt"]


def test_an_output_that_is_overwritten_stays_until_the_new_one_is_complete(client, tmp_path, monkeypatch):
    out = tmp_path / "sweep.nc"
    sweep({"period": [0.5]}, scheduler=client, out=out, **SHORT)
    older = out.read_bytes()

    def full(self, path, **_):
        assert path.parent == tmp_path
        path.write_bytes(b"CDF half")
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with monkeypatch.context() as patch:
        patch.setattr(xarray.Dataset, "to_netcdf", full)
        with pytest.raises(OSError, match=r"sweep\.nc' cannot be written: No space left on device"):
            sweep({"period": [0.6]}, scheduler=client, out=out, overwrite=True, **SHORT)
    assert out.read_bytes() == older and not list(tmp_path.glob("*.part.*"))
    told = []  # what was simulated before is kept
    sweep(
        {"period": [0.6]}, scheduler=client, out=out, overwrite=True, progress=lambda *pair: told.append(pair), **SHORT
    )
    assert told == [(1, 1)] and xarray.load_dataset(out, engine="scipy").period.item() == 0.6


@pytest.mark.fault(
    "names",
    "a sweep whose measure has other code or another closure, or whose body has other arrays, than the one on disk",
    "another sweep: refused, or replaced with `overwrite`",
)
def test_the_key_changes_with_whatever_the_results_depend_on():
    def measure_of(limit):
        return lambda run: {"far": float(run.path_length > limit)}

    x = np.linspace(0.0, 1.0, 4001)
    width = 0.05 * np.sqrt(np.sin(np.pi * x * 0.98))
    between = width.copy()
    between[1003] *= 1.01  # 201 points do not see it
    bodies = [Body(x=x, half_width=each, half_height=2.0 * width) for each in (width, between)]
    bodies += [Body(length=1.0, half_width=lambda x, k=k: k * np.sqrt(x), half_height=np.sqrt) for k in (0.01, 0.02)]

    def key(measure=measures_of, body=bodies[0]):
        return key_of([Swim(straight(), body, Scene(), Accuracy.of("draft"))], measure)

    keys = [key(body=body) for body in bodies]
    keys += [key(measure) for measure in (measure_of(1.0), measure_of(2.0), lambda run: {"far": 1.0})]
    assert len(set(keys)) == len(keys)
    assert key(measure_of(1.0)) == keys[4] and key(body=Body(x=x, half_width=width, half_height=2.0 * width)) == keys[0]
    lock = threading.Lock()
    with pytest.raises(ValueError, match="measure must be a function that worker processes can be given"):
        key(lambda run: {"locked": lock.locked()})


def test_the_key_is_the_same_in_another_process(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(
        "from eel_dynamics import Accuracy, Body, Scene\nfrom eel_studies.sweeps.sweep_key import key_of\n"
        "from eel_dynamics.runs.swim import Swim\n"
        "from eel_gaits import straight\nLIMIT = 0.3\n"
        "def measure(run):\n    return {'far': run.path_length > LIMIT, 'near': run.path_length < LIMIT}\n"
        "point = Swim(straight(), Body.kern2006(), Scene(), Accuracy.of('draft'))\n"
        "print(key_of([point], measure))\n"
    )

    def key():
        done = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=300, check=True)
        return done.stdout

    one, two = key(), key()
    assert one == two != ""
    script.write_text(script.read_text().replace("LIMIT = 0.3", "LIMIT = 0.4"))
    assert key() != one


@pytest.mark.parametrize("value", [0.5 + 1j, "far", [1.0], np.ones(2), None])
def test_a_measure_that_is_no_number_is_refused_by_name(client, value):
    def measure(run):
        return {"way": value}

    with pytest.raises(ValueError, match="measure 'way' must be a real number, got"):
        sweep({"period": [0.5]}, scheduler=client, measure=measure, **SHORT)


def test_a_sample_period_above_the_duration_is_refused():
    with pytest.raises(ValueError, match=r"^sample_period must be at most the duration of 0.1 s, got 0.3 s$"):
        sweep({"period": [0.5]}, duration=0.1, sample_period=0.3)


def test_a_law_in_place_of_a_gait_is_refused():
    with pytest.raises(
        ValueError, match=r"gait must be the name of a gait, a function that returns a law, or a Swim, got Law"
    ):
        sweep({"period": [0.5]}, gait=straight(), **SHORT)


@pytest.mark.parametrize("given", [{"workers": 0}, {"workers": -1}, {"chunk": -1}, {"chunk": "a"}, {"chunk": 0}])
def test_counts_that_cannot_be_are_refused_by_name(given):
    ((name, value),) = given.items()
    with pytest.raises(ValueError, match=f"{name} must be a whole number >= 1, got {value!r}"):
        sweep({"period": [0.5]}, **given, **SHORT)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"grid": {3: [0.5]}}, "grid name must be a str, got 3"),
        ({"out": True}, "out must be a str or a PathLike, got True"),
        ({"recordings": 1}, "recordings must be a str or a PathLike, got 1"),
        ({"measure": 1}, "measure must be one of .*, got 1"),
        ({"gait": Swim(None, Body.boyer2010(), Scene(), "draft")}, "law None has no numbers: no gait gave it"),
    ],
)
def test_what_is_no_argument_of_a_sweep_is_refused_by_name(given, message):
    with pytest.raises(ValueError, match=message):
        sweep(**{"grid": {"period": [0.5]}} | given, **SHORT)


def test_a_swim_of_a_function_has_the_default_body_and_scene():
    def wave(t, x):
        return 0.0 * x, np.sin(3.0 * t) * x

    data = sweep({"initial.v_x": [0.1]}, gait=Swim(wave, None, None, "draft", stations=3), duration=0.2)
    run = simulate(wave, 0.2, accuracy="draft", stations=3, twist=(0.0, 0.0, 0.0, 0.1, 0.0, 0.0))
    assert float(data.head_x[0]) == run.position[-1, 0] and "wave" in data.attrs["gait"]


def test_a_point_that_stops_is_told_and_the_others_stay(client):
    def law(size):
        return straight(amplitude_0=size)

    grid = {"scene.density": [10.0, 1000.0], "scene.reactive": [False]}
    long_steps = Accuracy(name="long steps", resolution=10.0, step=0.05)
    address = client.scheduler.address
    data = sweep(grid, gait=law, numbers={"size": 1.0}, scheduler=address, duration=1.2, accuracy=long_steps)
    assert data.stopped.values.ravel().tolist() == [True, False]
    assert "energy from nowhere" in str(data.error.values[0, 0]) and data.error.values[1, 0] == ""
    assert np.isnan(data.head_x.values[0, 0]) and np.isfinite(data.head_x.values[1, 0])


def test_points_that_cannot_be_computed_are_told_and_the_rest_is_kept(client, tmp_path):
    def measure(run):
        if run.law.terms[0].period == 0.7:
            raise ZeroDivisionError("no measure of that")
        return {"way": run.path_length}

    out = tmp_path / "ways.nc"
    with pytest.raises(RuntimeError, match=r"(?s)1 of 3 points.*ZeroDivisionError.*ways.nc.parts"):
        sweep({"period": [0.6, 0.7, 0.8]}, scheduler=client, chunk=1, measure=measure, out=out, **SHORT)
    assert len(list((tmp_path / "ways.nc.parts").glob("part-*.json"))) == 2


def test_command_with_a_cluster_of_its_own(tmp_path, capsys):
    out = tmp_path / "command.nc"
    words = (
        f"straight --vary period=0.5:1:3 --duration 1.2 --accuracy 1e-2 --scheduler processes --workers 1 --out {out}"
    )
    assert main(words.split()) == 0
    assert "3, of which 0 stopped" in capsys.readouterr().out
    data = xarray.load_dataset(out, engine="scipy")
    assert data.period.values.tolist() == [0.5, 0.75, 1.0]
    run = simulate(straight(period=0.75), 1.2, accuracy=1e-2)
    assert float(data.head_x[1]) == run.position[-1, 0]


@pytest.mark.parametrize(
    "options, words",
    [
        (["--vary", "period"], "--vary must be NAME=VALUE, got 'period'"),
        (["--vary", "period=1:2:x"], "start:end:count"),
        (["--vary", "period=1:2:-1"], "start:end:count"),
        (["--vary", "period=0.5:2:100000000000"], "period must have at most 1000000 points, got 100000000000"),
        (["--vary", "period=1:2:1001", "--vary", "wavelength=1:2:1000"], "at most 1000000 points, got 1001000"),
        (["--vary", "period=1,2", "--vary", "period=3"], "period must be given once, got it 2 times"),
        (["--vary", "period=1,2", "--set", "period=3"], "period must be given once"),
        (["--vary", "period=1,2", "--set", "wavelength=1,2"], "--set must be NAME=NUMBER, got 'wavelength=1,2'"),
        (["--vary", "period=1", "--duration", "1e9"], "2e+10 samples"),
        (["--vary", "tail=1"], "tail"),
        (["--vary", "period=-1,1"], "period=-1.0"),
        (["--vary", "scene.colour=red"], "scene has no field 'colour'"),
        (["--vary", "body.colour=1"], "body has no field 'colour', it has: density"),
        (["--vary", "initial.x=1"], "initial has no field 'x', it has: position_x"),
        (["--vary", "scene.friction=sticky"], "sticky"),
        (["--vary", "period=1,1"], "twice"),
        (["--vary", "period=1", "--scheduler", "nowhere"], "nowhere"),
        (["--vary", "period=1", "--workers", "0"], "workers must be a whole number >= 1, got 0"),
        (["--vary", "period=1", "--workers", "-1"], "workers must be a whole number >= 1, got -1"),
    ],
)
def test_bad_input_of_the_command(options, words, tmp_path, capsys):
    assert main([*options, "--out", str(tmp_path / "out.nc")]) == 2
    said = capsys.readouterr().err
    assert words in said and said.startswith("eel sweep: ") and said.count("\n") == 1


def test_out_of_memory_is_one_line(tmp_path, monkeypatch, capsys):
    def swum(*_, **__):
        raise MemoryError("72 GiB")

    monkeypatch.setattr(sweep_command, "sweep", swum)
    assert main(["--vary", "period=1", "--out", str(tmp_path / "out.nc")]) == 2
    assert capsys.readouterr().err == "eel sweep: it does not fit into memory: 72 GiB\n"


@pytest.mark.parametrize("name, given", [("xarray", {}), ("distributed", {"scheduler": "processes"})])
def test_missing_extra_is_one_clear_error(name, given, monkeypatch):
    monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(ImportError, match=rf"needs {name} .* pip install {name}$"):
        sweep({"period": [1.0]}, **given)


def test_threads_serve_a_script_without_a_main_guard(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(
        "import sys\nfrom eel_studies import sweep\n"
        "data = sweep({'period': [0.5 + 0.1 * k for k in range(15)]}, accuracy=1e-2, duration=2.0,\n"
        "             measure=lambda run: {'way': run.path_length})\n"
        "print(float(data.way.min()) > 0.0, data.sizes['period'], 'distributed' in sys.modules)\n"
    )
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=200, check=True)
    assert done.stdout == "True 15 False\n"


def test_threads_give_what_processes_give(client, tmp_path):
    grid = {"period": [0.3, 0.8], "body.lateral_drag": [1.0, 1.98], "initial.v_x": [0.2]}
    told = []
    here = sweep(grid, progress=lambda *pair: told.append(pair), out=tmp_path / "here.nc", chunk=1, **SHORT)
    assert told[0] == (0, 4) and told[-1] == (4, 4)
    assert here.equals(sweep(grid, scheduler=client, progress=False, **SHORT))
    run = simulate(
        straight(period=0.3), body=Body.boyer2010().changed(lateral_drag=1.0), twist=(0, 0, 0, 0.2, 0, 0), **SHORT
    )
    assert float(here.mean_speed[0, 0, 0]) == run.mean_speed  # sampled for its own period
    assert sweep(grid, out=tmp_path / "here.nc", **SHORT).equals(here)  # read, not swum
    with pytest.raises(ValueError, match="not of this sweep"):
        sweep(grid, out=tmp_path / "here.nc", estimate=False, **SHORT)


def test_an_interrupted_sweep_in_threads_begins_nothing_more(tmp_path):
    def interrupt(done, points):
        if done:
            raise KeyboardInterrupt

    before = threading.active_count()
    with pytest.raises(KeyboardInterrupt):
        sweep({"period": np.linspace(0.5, 1.0, 40)}, progress=interrupt, chunk=1, out=tmp_path / "a.nc", **SHORT)
    assert threading.active_count() == before
    assert len(list((tmp_path / "a.nc.parts").glob("part-*.json"))) == 1


def test_runs_without_an_error_estimate(tmp_path, capsys):
    bare = sweep({"period": [0.5]}, estimate=False, **SHORT)
    assert "error_position" not in bare and "mean_speed" in bare
    assert float(bare.evaluations[0]) == simulate(straight(period=0.5), estimate=False, **SHORT).evaluations
    both = sweep({"period": [0.5]}, estimate=False, measure=("mean_speed", "greatest_torque"), **SHORT)
    assert set(both) == {"mean_speed", "greatest_torque", "settled", "stopped", "error"}
    for name in ("error_position", "error_torque", "error_growth_rate"):
        with pytest.raises(ValueError, match=f"measure {name} needs the error estimate, which is off"):
            sweep({"period": [0.5]}, estimate=False, measure=(name,), **SHORT)
    words = [
        "--vary",
        "period=0.5",
        "--duration",
        "0.5",
        "--accuracy",
        "1e-2",
        "--out",
        str(tmp_path / "out.nc"),
        "--bare",
    ]
    assert main([*words, "--measures", "head_x,error_torque"]) == 2
    assert "measure error_torque needs the error estimate" in capsys.readouterr().err
    assert main([*words, "--measures", "head_x,tail"]) == 2
    assert "measure must be one of head_x," in capsys.readouterr().err
    assert main([*words, "--measures", "head_x"]) == 0
    assert "head_x" in capsys.readouterr().out


def test_each_point_has_a_recording_with_its_values_and_measures(tmp_path):
    reading = pytest.importorskip("eel_viz.recording.reading")
    folder = tmp_path / "swims"
    grid = {"period": [0.5, 0.25], "scene.friction": ["printed", "laminar"], "accuracy": ["draft"]}
    data = sweep(grid, duration=1.0, estimate=False, recordings=folder)
    assert sorted(path.name for path in folder.iterdir()) == [f"00000{k}.rrd" for k in range(4)]

    def told(index, group):
        found = reading.read(folder / f"00000{index}.rrd", f"/__properties/{group}", static=True)
        return {name: rows[-1][0] for name, rows in found.values.items()}

    assert told(2, "numbers") == {"period": 0.25, "scene.friction": "printed", "accuracy": "draft"}
    speeds = [told(k, "measures")["mean_speed"] for k in range(4)]
    np.testing.assert_array_equal(speeds, data.mean_speed.values.ravel())
    with pytest.raises(ValueError, match=r"recordings .* cannot be written"):
        sweep(grid, duration=1.0, recordings=tmp_path / "nowhere" / "swims")


@pytest.mark.parametrize("kind", [Run, Batch])
def test_a_file_of_a_sweep_says_what_opens_it(kind, tmp_path):
    xarray = pytest.importorskip("xarray")
    path = tmp_path / "periods.nc"
    sweep({"period": [0.5]}, duration=1.0, accuracy=1e-2, stations=5, out=path)
    with pytest.raises(ValueError, match=f"holds a sweep, not a {kind.__name__.lower()}: xarray.open_dataset opens it"):
        kind.load(path)
    assert xarray.open_dataset(path).sizes["period"] == 1


def test_fins_and_mass_are_swept(tmp_path):
    """Area and gain of fins, mass and offset of the body; each point is the swim of its own arguments."""
    fins = "pair station=0.2 area=0.001 aspect_ratio=2.5 k_p=2 time_constant=0.05"
    grid = {"fins.area": [5e-4, 2e-3], "fins.k_p": [1.0, 4.0], "fins.dihedral": [0.1], "body.density": [900.0]}
    numbers = {"fins": fins, "body.centre_of_mass_offset": 0.005, "scene.weight": True, "initial.omega_x": 0.3}
    data = sweep(grid, numbers=numbers, measure=lambda run: {"lean": run.orientation[-1, 0]}, **SHORT)
    hold = RollHold(4.0, 0.15)
    pair = Fin.pair(0.2, 2e-3, 2.5, dihedral=0.1, angle=hold, time_constant=0.05)
    body = Body.boyer2010().changed(density=900.0, centre_of_mass_offset=0.005)
    alone = simulate(straight(), fins=[pair], body=body, scene=Scene(weight=True), twist=(0.3, 0, 0, 0, 0, 0), **SHORT)
    chosen = {"fins.area": 2e-3, "fins.k_p": 4.0, "fins.dihedral": 0.1, "body.density": 900.0}
    assert float(data.lean.sel(chosen)) == alone.orientation[-1, 0]
    assert len(np.unique(data.lean)) == 4
    out = tmp_path / "fins.nc"
    words = ["straight", "--fins", fins, "--vary", "fins.k_d=0.1,0.2", "--duration", "1", "--accuracy", "1e-2"]
    assert main([*words, "--measures", "mean_speed", "--out", str(out)]) == 0
    assert xarray.load_dataset(out, engine="scipy").sizes["fins.k_d"] == 2


@pytest.mark.parametrize(
    ("name", "numbers", "message"),
    [
        ("fins.area", {}, "fins have no field 'area': the scene has no fins"),
        ("fins.k_p", {"fins": "left station=0.2 area=0.001 aspect_ratio=2"}, "fins have no gain 'k_p': none of them"),
        ("fins.aera", {"fins": "left station=0.2 area=0.001 aspect_ratio=2"}, "fins has no field 'aera'.*area"),
    ],
)
def test_a_field_that_fins_do_not_have_is_named(name, numbers, message):
    with pytest.raises(ValueError, match=message):
        sweep({name: [1.0]}, numbers=numbers, **SHORT)


def test_a_flow_of_a_function_is_swept_and_known_by_its_code(tmp_path):
    """In threads one swimmer after the other; results of another function are not taken for its own."""
    shear, out = Shear(), tmp_path / "flows.nc"
    whole, half = (FlowField(lambda x, t, k=k: k * shear.sample(x, t).velocity, name=str(k)) for k in (1.0, 0.5))
    options = {"measure": lambda run: {"far": run.position[-1, 0]}, **SHORT}
    data = sweep({"flow": [whole, half, shear]}, workers=2, **options)
    far = [simulate(straight(), flow=flow, **SHORT).position[-1, 0] for flow in (whole, half, shear)]
    np.testing.assert_array_equal(data.far, far)
    assert far[0] != far[1] and far[0] == pytest.approx(far[2], abs=1e-6)
    assert "0x" not in str(data.flow.values)
    sweep({"flow": [whole]}, out=out, **options)
    with pytest.raises(ValueError, match="is not of this sweep"):
        sweep({"flow": [FlowField(half.function, name=whole.name)]}, out=out, **options)


def test_a_sweep_varies_the_numbers_of_a_flow():
    base = base_of("straight", accuracy="draft", estimate=False)
    flow = "vortex_street core=0.3"
    point = point_at({"flow.spacing": 2.0, "period": 0.9}, "straight", {"flow": flow}, base)
    assert point.flow == VortexStreet(core=0.3, spacing=2.0)
    with pytest.raises(ValueError, match="flow has no field 'width_'"):
        point_at({"flow.width_": 2.0}, "straight", {"flow": flow}, base)
    with pytest.raises(ValueError, match="flow must be one built-in flow for spacing to change, got"):
        point_at({"flow.spacing": 2.0}, "straight", {}, base)
    point = point.changed(duration=1.0, sample_period=0.25, stations=2)
    swims = swum([point, point.changed(flow=None)])
    assert not np.allclose(swims.position[0], swims.position[1])


WORDS = "straight --duration 1.2 --accuracy 1e-2 --bare --measures mean_speed,head_x --vary period=0.5,0.8"


@pytest.mark.parametrize(
    "words, drawn",
    [
        ("--vary scene.friction=laminar", {"period [s]": "x"}),
        ("--vary scene.friction=laminar,none", {"period [s]": "x", "scene.friction": "y"}),
        ("--vary wavelength=0.2,1,2", {"period [s]": "x", "wavelength [m]": "y"}),
    ],
)
def test_the_picture_names_axes_and_extremes(words, drawn, tmp_path, monkeypatch, capsys):
    figures = []

    def kept(figure, *arguments):
        draw_sweep(figure, *arguments)
        figures.append((figure, *arguments))

    monkeypatch.setattr(sweep_command, "draw_sweep", kept)
    outs = ["--out", str(tmp_path / "out.nc"), "--plot", str(tmp_path / "out.png")]
    assert main([*WORDS.split(), *words.split(), *outs]) == 0
    assert (tmp_path / "out.png").stat().st_size > 5000
    ((figure, data, *_),) = figures
    panels = [axes for axes in figure.axes if axes.get_title()]
    assert [axes.get_title() for axes in panels] == ["mean speed [m/s]", "head x [m]"]
    for axes, name in zip(panels, ("mean_speed", "head_x"), strict=True):
        assert {axes.get_xlabel(): "x"} | ({axes.get_ylabel(): "y"} if axes.get_ylabel() else {}) == drawn
        told = {f"least {float(data[name].min()):.3g}", f"most {float(data[name].max()):.3g}"}
        assert {text.get_text() for text in axes.texts} == told
        at = data[name].values.max()
        (most,) = [line for line in axes.lines if line.get_marker() == "^"]
        period = float(data.period[np.argwhere(data[name].values == at)[0][list(data[name].dims).index("period")]])
        assert most.get_xdata()[0] == period
    assert "mean_speed" in (said := capsys.readouterr().out) and "(period 0.5" in said


@pytest.mark.parametrize(
    "words, message",
    [
        ("--vary period=1", "--plot needs one or two --vary with several values, got 0"),
        ("--vary period=1,2 --vary wavelength=1,2 --vary body=boyer2010,kern2006", "several values, got 3"),
    ],
)
def test_a_picture_needs_one_or_two_axes(words, message, tmp_path, capsys):
    outs = ["--out", str(tmp_path / "out.nc"), "--plot", str(tmp_path / "out.png")]
    assert main([*words.split(), *outs]) == 2 and message in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
