# SPDX-License-Identifier: Apache-2.0
"""The command `stability`: studies hold what was simulated, the page what was measured, bad input is one line."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from eel_dynamics.model.inertia import condition_of, straight_inertia
from eel_dynamics.model.section_data import nose_of
from eel_dynamics.runs.scene_file import swim_of
from eel_studies.outputs import Outputs
from eel_studies.stability import command, inertia, long_runs, maps
from eel_studies.stability.extremes import maps_of
from eel_studies.stability.maps import (
    ACCURATE,
    INACCURATE,
    REFUSED,
    SENSITIVE,
    SILENT,
    STOPPED,
    UNCHECKED,
    Axis,
    measure,
)
from eel_studies.stability.report import STUDIES, report
from eel_studies.varied import varied

from eel_dynamics import Body, Simulation
from eel_gaits import falling, straight

PART = "<!-- {0}: written by `stability` -->\n{1}<!-- end of {0} -->"  # of a page


EMPTY = "stability_gait", "a map", lambda figure: figure.subplots(), (2.0, 2.0), ("svg",)


def test_maps_keep_the_target_and_tell_what_stops(tmp_path):
    items = {item.name: item for item in maps_of(2)}
    coarse = replace(items.pop("method"), across=Axis("tolerance of a step", "tolerance", 1e-2, 1.0))
    dear = "preset", "vortex", "shear", "wave", "velocity", "fins", "servos", "dampers"  # for what other tests show
    items = {name: item for name, item in items.items() if name not in dear}
    measured = {name: measure(item) for name, item in items.items()}
    for name in ("gait", "water", "viscosity", "body", "gust"):
        assert measured[name].count(ACCURATE) == 4 and measured[name].worst < 1.0, name
    step = measured["step"].cells["outcome"]
    assert (step[:, 0] == ACCURATE).all()  # a hundredth of a period
    assert set(step[:, 1]) <= {STOPPED, INACCURATE, SENSITIVE} and STOPPED in step[:, 1]  # a whole period
    measured["method"] = measure(coarse)
    assert measured["method"].count(ACCURATE) < 14 and not any(each.count(SILENT) for each in measured.values())
    assert measured["water"].cells["limits"][1].all()  # Reynolds numbers below 1000
    outputs = Outputs("eel stability", SimpleNamespace(out=tmp_path, page=None))
    text = report(list(measured.values()), outputs)
    assert "Stopped: energy from nowhere" in text and "errors grow by a factor of e in" in text
    assert (tmp_path / "stability_gust.svg").stat().st_size > 1500


def judged(monkeypatch, swim, run, finer):
    """The cell of a `swim` whose runs are these."""
    monkeypatch.setattr(maps, "_swum", lambda each, target: run if each is swim else finer)
    return maps.cell_of(lambda: swim)


def test_each_outcome_is_told_from_the_others(monkeypatch):
    swim = swim_of({"gait": "straight", "duration": 2, "accuracy": 1e-3, "stations": 11})
    good, fine = swim.run(), swim.run(accuracy=1e-4)
    far = replace(good, position=good.position + 0.01)  # ten times the target, by a body length
    honest = replace(far, error_estimate=replace(good.error_estimate, position=0.02, growth_rate=0.0))
    growing = replace(honest, error_estimate=replace(honest.error_estimate, growth_rate=3.0))
    unsure = replace(fine, error_estimate=replace(fine.error_estimate, position=0.02))
    rows = ((good, fine, ACCURATE), (far, fine, SILENT), (honest, fine, INACCURATE), (growing, fine, SENSITIVE))
    for run, finer, outcome in (*rows, (far, unsure, UNCHECKED)):
        cell = judged(monkeypatch, swim, run, finer)
        assert cell["outcome"] == outcome and bool(cell["size"] > 1.0) is (outcome != ACCURATE)
    refused = maps.cell_of(lambda: swim.with_gait(period=-1.0))
    assert refused["outcome"] == REFUSED and "period must be" in str(refused["text"])


DENSITY, WATER = {"density_ratio": (1e-3, 1e6)}, {"scene.viscosity": (1e-9, 1e-1), "scene.fluid_density": (1e-2, 1e4)}
SETTINGS = {"tolerance": (1e-9, 1e-1), "step": (1e-3, 0.2), "resolution": (4.0, 60.0)}
SWIM = {"amplitude": (1e-3, 3.0), "initial.v_x": (1e-2, 10.0), **DENSITY, **WATER}
FIN = {"fins.area": (1e-5, 1.0), "fins.aspect_ratio": (0.3, 30.0)}
ROBOTS = {  # by name: numbers that its maps are drawn over
    "eight_servos": {"robot.kp": (0.1, 1e6), "robot.kd": (1e-4, 1e4), "robot.stiffness": (1e-3, 1e6)},
    "passive_tail": {"robot.bending_stiffness": (1e-2, 1e3)},
}
FLOWS = {
    "gust": {"flow.rise": (1e-3, 3.0), "flow_speed": (1e-3, 3.0)},
    "shear width=0.3": {"flow.width": (1e-3, 10.0), "flow_speed": (1e-3, 3.0)},
    "vortex centre=-0.3,0.3,0": {"flow.core": (3e-3, 3.0), "flow.circulation": (1e-3, 0.5)},
    "vortex_street": {"flow.core": (3e-3, 0.3), "flow.circulation": (1e-3, 0.5), "flow.spacing": (0.05, 2.0)},
    "wave": {"flow.amplitude": (1e-3, 1.0), "flow.wavelength": (0.05, 20.0)},
}
FINS = {
    "left station=0.6 area=0.002 aspect_ratio=2 angle=0.3": {},
    "pair station=0.3 area=0.001 aspect_ratio=3 k_p=2 time_constant=0.05": {"fins.time_constant": (1e-3, 10.0)},
}


def random_scene(rng, robots=True):
    """Words of a scene of random parts, and the numbers that its maps may be drawn over."""

    def one_of(choices):
        name = str(rng.choice(list(choices)))
        return name, choices[name] if isinstance(choices, dict) else {}

    words, numbers = {"gait": "straight", "scene": {"planar": True}}, dict(SWIM)
    if robots and rng.random() < 0.4:
        words["robot"], own = one_of(ROBOTS)
        numbers |= {**own, "robot.damping": (1e-4, 1e3), "period": (0.2, 5.0)}
    else:
        words["gait"], _ = one_of(("straight", "turning", "falling", "helix"))
        words["body"], _ = one_of(("boyer2010", "kern2006"))
        numbers |= SETTINGS
        if rng.random() < 0.7 or words["gait"] in ("falling", "helix"):
            words["scene"] = ({}, {"metacentric_height": 0.01}, {"weight": True, "density": 1050.0})[rng.integers(3)]
            words["initial_angular_velocity"] = [float(rng.uniform(-0.1, 0.1)), 0.0, 0.0]
            if rng.random() < 0.4:
                words["fins"], own = one_of(FINS)
                numbers |= FIN | own
    if rng.random() < 0.5:
        still = "planar" in words["scene"]  # where a wave, which moves up and down, is refused
        words["flow"], own = one_of({name: FLOWS[name] for name in FLOWS if name != "wave" or not still})
        numbers |= own
    return words, numbers


def random_maps(cells, seed, robots=True):
    """Maps of 4 by 4 cells, so many in all, over two numbers of a random scene at a random accuracy."""
    rng = np.random.default_rng(seed)
    for _ in range(cells // 16):
        words, numbers = random_scene(rng, robots)
        axes = [Axis(name, name, *numbers[name]) for name in rng.permutation(list(numbers))[:2]]
        accuracy, longest = float(10.0 ** rng.uniform(-5.0, -2.0)), 1.0 if "robot" in words else 4.0
        swim = swim_of({**words, "duration": float(rng.uniform(0.3, longest)), "accuracy": accuracy})
        yield maps.Map("random", f"{words} {accuracy}", *axes, 4, swim)


def check_in_silence(cells, seed, robots=True):
    unchecked = 0
    for item in random_maps(cells, seed, robots):
        found = measure(item)
        assert found.count(SILENT) == 0, (item.title, item.across, item.up, found.texts(SILENT))
        unchecked += found.count(UNCHECKED)
    assert unchecked <= 0.02 * cells


@pytest.mark.soak
@pytest.mark.timeout(3600)
def test_no_cell_of_2000_is_wrong_in_silence():
    check_in_silence(2000, 2)


def test_numbers_of_a_scene_by_name():
    swim = swim_of({"gait": "straight", "duration": 4, "flow": "gust velocity=0,0.3,0.4"})
    assert varied(swim, {"period": 0.5}).duration == 2.0 and varied(swim, {"period": 0.5}).law == straight(period=0.5)
    assert varied(swim, {"amplitude": 2.0}).law == straight() * 2.0
    assert varied(swim, {"density_ratio": 0.1}).scene.density == 100.0
    assert varied(swim, {"flow_speed": 5.0, "flow.rise": 0.1}).flow.velocity == pytest.approx((0.0, 3.0, 4.0))
    both = varied(swim, {"tolerance": 1e-4, "resolution": 20.0}).accuracy
    assert (both.tolerance, both.resolution, both.target) == (1e-4, 20.0, None)
    assert varied(swim, {"step": 0.1, "body.lateral_drag": 0.5}).body.lateral_drag == 0.5
    assert np.linalg.norm(varied(swim, {"spin": 1.0}).start.twist[:3]) == pytest.approx(2.0 * np.pi)


def test_a_map_of_a_scene_of_the_users(tmp_path, capsys):
    words = "straight --duration 3 --over step=0.01:1 --over density_ratio=0.001:10 --points 3"
    assert command.main([*words.split(), "--out", str(tmp_path), "--page", str(tmp_path / "page.md")]) == 0
    said = capsys.readouterr().out
    assert "straight: step and density_ratio" in said and "stopped: energy from nowhere" in said
    assert (tmp_path / "stability_straight.svg").exists() and "](stability_straight.svg)" in (
        tmp_path / "page.md"
    ).read_text()  # fmt: skip


@pytest.mark.parametrize(
    "words, named",
    [
        ("straight", "--over must be given for two numbers of the scene, got 0"),
        ("straight --over period=1:2", "got 1"),
        ("straight --over period=1 --over step=1:2", "--over must be NAME=LOW:HIGH, 0 < LOW < HIGH, got 'period=1'"),
        ("straight --over period=2:1 --over step=1:2", "got 'period=2:1'"),
        ("straight --over periode=1:2 --over step=1:2", "'periode'"),
        (
            "straight --over flow.core=1:2 --over step=1:2",
            "flow must be one built-in flow for core to change, got None",
        ),
        ("straight --over flow_speed=1:2 --over step=1:2", "flow_speed needs a flow with a velocity"),
        ("straight --over fins.area=1:2 --over step=1:2", "fins have no field 'area': the scene has no fins"),
        (
            "straight --over robot.stiffness=1:2 --over step=1:2",
            "robot must be given for robot.stiffness to change, got none",
        ),
        ("straight --over scene.plane=1:2 --over step=1:2", "scene has no field 'plane'"),
        ("straight --over period=1:2 --over step=1:2 --study drift", "--study goes without a scene, got 'drift'"),
    ],
)
def test_bad_axes_are_refused_before_the_map(words, named, tmp_path, capsys):
    assert command.main([*words.split(), "--out", str(tmp_path)]) == 2
    said = capsys.readouterr().err
    assert named in said and said.startswith("eel stability: ") and said.count("\n") == 1


@pytest.fixture
def one_picture(monkeypatch):
    """In place of the maps a study that draws an empty picture."""
    monkeypatch.setitem(STUDIES, "maps", lambda points, outputs: "| new |\n" + outputs.draw(*EMPTY))


def test_a_page_keeps_what_is_not_the_studys(tmp_path, one_picture):
    page = tmp_path / "page.md"
    page.write_text("a\n" + PART.format("maps", "old\n") + "\nb")
    words = ["--study", "maps", "--page", str(page), "--out", str(tmp_path / "images")]
    assert command.main(words) == 0
    text = page.read_text()
    assert "| new |\n![a map](images/stability_gait.svg)\n" in text and "old" not in text
    assert text.endswith("\nb") and text.startswith("a\n")


def test_a_new_page_has_the_parts_alone(tmp_path, one_picture, monkeypatch):
    monkeypatch.setitem(STUDIES, "drift", lambda points, outputs: "no drift")
    page = tmp_path / "page.md"
    assert command.main(["--study", "maps", "--study", "drift", "--page", str(page), "--out", str(tmp_path)]) == 0
    assert page.read_text().startswith(
        "<!-- maps: written by `eel stability` -->\n| new |\n![a map](stability_gait.svg)"
    )
    assert "<!-- drift: written by `eel stability` -->\nno drift\n<!-- end of drift -->" in page.read_text()


def test_a_long_run_gathers_nothing(monkeypatch):
    for name, swimmer in long_runs.SWIMMERS.items():
        found = long_runs.drift_of(swimmer, decades=2, compared=1)
        assert (found["ledger"] < 1e-2).all() and (found["norm"] < 1e-14).all() and (found["phase"] < 1e-11).all(), name
        assert (found["path"][:2] < 1e-2).all() and np.isnan(found["path"][2])
        assert found["way"][2] > 5.0 * found["way"][1]
    monkeypatch.setattr(long_runs, "drift_of", lambda swimmer: found)
    assert "| helix | 100 |" in long_runs.drifts()


def test_what_grows_out_of_the_plane_is_the_model_s():
    rows = {row.split(" | ")[0][2:]: row.split(" | ")[1:] for row in long_runs.planes().splitlines()[2:]}
    growth = {name: float(row[0]) for name, row in rows.items()}
    assert growth["the paper's robot"] == pytest.approx(growth["the same, with coarser settings"], abs=2e-3)
    assert 4.2 < growth["the paper's robot"] < 4.5 and "roll" in rows["the paper's robot"][1]
    assert growth["without inertia of the water"] == pytest.approx(1.0, abs=1e-3)
    assert growth["sections wider than high"] < 0.9


def test_the_condition_of_the_matrix_is_that_of_the_inertia_that_is_solved():
    swimmer = Simulation(accuracy=1e-4, law=falling())
    at_rest = inertia.inertia_at(swimmer, 0.0)  # the gait starts from the straight shape
    table, nose_mass = swimmer.discretisation, nose_of(swimmer.body, swimmer.scene)[0]
    straight = straight_inertia(table.grid, table.sections, nose_mass, 1.0)
    assert at_rest == pytest.approx(straight, rel=1e-9, abs=1e-12)
    bent = inertia.inertia_at(swimmer, 5.0)
    assert np.linalg.eigvalsh(bent).min() > 0.0 and not np.allclose(bent, at_rest, rtol=1e-2)
    assert condition_of(bent) == pytest.approx(np.linalg.cond(bent), rel=1e-6)
    thin, thick = (inertia.of_straight(1.0, slenderness) for slenderness in (1e4, 1e2))
    assert thin == pytest.approx(1e4 * thick, rel=0.1)  # inertia in roll goes like the mass by the square of the radius
    assert np.isnan(inertia.of_straight(1.0, 1e7))  # refused
    straight_bodies, robot = (item.values() for item in inertia.maps_of(2))
    assert np.nanmin(straight_bodies) >= 1.0 and np.isnan(straight_bodies[1]).all() and robot.min() >= 1.0


def test_an_explicit_added_mass_blows_up_where_water_outweighs_the_body():
    own, water = inertia.inertias(Body.boyer2010(), 1.0)
    assert own[4, 4] == pytest.approx(1.944, rel=1e-3)  # kg
    assert water[4, 4] == pytest.approx(4.998, rel=1e-3)
    assert np.allclose(own, own.T) and np.linalg.eigvalsh(own + water).min() > 0.0
    wrench, present = np.ones(6), np.zeros(6)
    for _ in range(20):
        present = np.linalg.solve(own, wrench - water @ present)
    assert np.linalg.norm(present) > 1e6 * np.linalg.norm(np.linalg.solve(own + water, wrench))
    assert inertia.growth_of_explicit(1.0) == pytest.approx(4.47, abs=0.01) and inertia.growth_of_explicit(10.0) < 1.0


def test_inertias_of_a_body_from_data_are_those_of_its_spline():
    x = np.array([0.0, 0.07, 0.2, 0.33, 0.41, 0.6, 0.78, 0.9, 1.0])
    width = np.array([0.0, 0.03, 0.02, 0.035, 0.03, 0.04, 0.02, 0.025, 0.01])
    body = Body(x=x, half_width=width, half_height=1.5 * width[[0, 2, 1, 3, 5, 4, 6, 8, 7]])
    axes = {"half_width": body.half_width, "half_height": body.half_height}
    cut = Body(**axes, length=1.0, kinks=x[1:-1], nose=body.nose)
    pair = (inertia.inertias(each, 0.9, 1e-7) for each in (body, cut))
    for ours, theirs in zip(*pair, strict=True):
        assert np.abs(ours - theirs).max() < 1e-6 * np.abs(theirs).max()


def test_bad_input_is_one_line(tmp_path, capsys):
    assert command.main(["--points", "1", "--out", str(tmp_path)]) == 2
    assert capsys.readouterr().err == "eel stability: --points must be 2 or more, got 1\n"


def test_a_page_that_cannot_be_is_refused_before_the_studies(tmp_path, monkeypatch, capsys):
    monkeypatch.setitem(STUDIES, "condition", lambda points, outputs: pytest.fail("it has begun"))
    bare, folder = tmp_path / "bare.md", tmp_path / "pictures"
    bare.write_text(PART.format("drift", ""))
    for page, word in ((tmp_path / "no" / "page.md", "no/page.md"), (tmp_path, "it is a folder"), (bare, "condition")):
        assert command.main(["--study", "condition", "--page", str(page), "--out", str(folder)]) == 2
        said = capsys.readouterr().err
        assert word in said and said.startswith("eel stability: ") and said.count("\n") == 1 and not folder.exists()
