# SPDX-License-Identifier: Apache-2.0
"""The command `stability`: studies hold what was simulated, the page what was measured, bad input is one line."""

from dataclasses import replace

import numpy as np
import pytest
from eel_dynamics.model.inertia import condition_of, straight_inertia
from eel_dynamics.model.section_data import nose_of
from eel_studies.stability import command, condition, drift, plane
from eel_studies.stability.explicit import inertias, treat
from eel_studies.stability.extremes import maps_of
from eel_studies.stability.maps import ACCURATE, INACCURATE, STOPPED, Axis, measure
from eel_studies.stability.report import STUDIES, report

from eel_dynamics import Body, Scene, Simulation
from eel_gaits import falling

PART = "<!-- {0}: written by `stability` -->\n{1}<!-- end of {0} -->"  # of a page


EMPTY = "stability_gait", "a map", lambda figure: figure.subplots(), (2.0, 2.0), ("svg",)


def test_maps_keep_the_target_and_tell_what_stops():
    items = {item.name: item for item in maps_of(2)}
    coarse = replace(items.pop("method"), across=Axis("tolerance of a step", 1e-2, 1.0))
    items.pop("preset")  # seconds for what test_accuracy shows
    measured = {name: measure(item) for name, item in items.items()}
    for name in ("gait", "wave", "water", "viscosity", "velocity", "body"):
        assert measured[name].worst < 1.0 and not (measured[name].outcome == STOPPED).any(), name
    step = measured["step"]
    assert (step.outcome[:, 0] == ACCURATE).all()  # a hundredth of a period
    assert set(step.outcome[:, 1]) <= {STOPPED, INACCURATE} and STOPPED in step.outcome[:, 1]  # a whole period
    method = measured["method"] = measure(coarse)
    poor = method.outcome == INACCURATE
    assert (
        poor.any() and ((method.cells["estimate"][poor] > 1.0) | method.cells["warned"][poor]).all()
    )  # none of them silently
    assert measured["water"].cells["limits"][1].all()  # Reynolds numbers below 1000
    text = report(list(measured.values()))
    assert "energy from nowhere" in text


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


def test_a_long_run_gathers_nothing():
    for name, (law, scene) in drift.swimmers().items():
        found = drift.drift_of(name, law, scene, decades=2, compared=1)
        assert (found.ledger < 1e-2).all() and (found.norm < 1e-14).all() and (found.phase < 1e-11).all(), name
        assert (found.path[:2] < 1e-2).all() and np.isnan(found.path[2])
        assert found.way[2] > 5.0 * found.way[1] and f"| {name} | 100 |" in drift.table([found])


def test_a_push_out_of_the_plane_grows_by_the_model_not_by_its_numbers():
    assert not plane.out_of_plane(np.arange(60)).any()  # exact zeros stay
    rates = [plane.growth(accuracy=accuracy).rate for accuracy in (1e-2, 1e-4)]
    rates.append(plane.growth(push=0.0, orientation=plane.TURNED).rate)
    assert rates == pytest.approx([1.455] * 3, abs=0.03)  # as at 1e-6
    assert np.argmax(np.abs(plane.growth().mode)) == 0  # roll
    assert abs(plane.growth(reactive=False).rate) < 0.01
    assert plane.growth(**plane.variants()["sections wider than high"]).rate < -0.1


def test_the_condition_of_the_matrix_is_that_of_the_inertia_that_is_solved():
    swimmer = Simulation(Body.boyer2010(), Scene(), 1e-4, law=falling())
    at_rest = condition.inertia_at(swimmer, 0.0)  # the gait starts from the straight shape
    table, nose_mass = swimmer.discretisation, nose_of(swimmer.body, swimmer.scene)[0]
    straight = straight_inertia(table.grid, table.sections, nose_mass, 1.0)
    assert at_rest == pytest.approx(straight, rel=1e-9, abs=1e-12)
    bent = condition.inertia_at(swimmer, 5.0)
    assert np.linalg.eigvalsh(bent).min() > 0.0 and not np.allclose(bent, at_rest, rtol=1e-2)
    assert condition_of(bent) == pytest.approx(np.linalg.cond(bent), rel=1e-6)
    thin, thick = (condition.of_body(condition.needle(size), 1.0) for size in (1e-4, 1e-2))
    assert thin == pytest.approx(1e4 * thick, rel=0.1)  # inertia in roll goes like the mass by the square of the radius
    maps = condition.maps_of(2)
    assert all(np.isfinite(each.values()).all() and each.values().min() >= 1.0 for each in maps)
    assert "refused: body has no inertia in roll" in condition.needles()


def test_an_explicit_added_mass_blows_up_where_water_outweighs_the_body():
    own, water = inertias(Body.boyer2010(), 1000.0, 1000.0)
    assert own[4, 4] == pytest.approx(1.944, rel=1e-3)  # kg
    assert water[4, 4] == pytest.approx(4.998, rel=1e-3)
    assert np.allclose(own, own.T) and np.linalg.eigvalsh(own + water).min() > 0.0
    assert treat(1.0).growth > 1.0 and treat(1.0).explicit > 1e6
    heavy = treat(10.0)
    assert heavy.growth < 1.0 and heavy.explicit == pytest.approx(1.0, abs=1e-3)
    assert all(treat(ratio).condition < 1e4 for ratio in (1e-3, 1.0, 1e3))


def test_inertias_of_a_body_from_data_are_those_of_its_spline():
    x = np.array([0.0, 0.07, 0.2, 0.33, 0.41, 0.6, 0.78, 0.9, 1.0])
    width = np.array([0.0, 0.03, 0.02, 0.035, 0.03, 0.04, 0.02, 0.025, 0.01])
    body = Body(x=x, half_width=width, half_height=1.5 * width[[0, 2, 1, 3, 5, 4, 6, 8, 7]])
    cut = Body(half_width=body.half_width, half_height=body.half_height, length=1.0, kinks=x[1:-1])
    for ours, theirs in zip(inertias(body, 900.0, 1000.0), inertias(cut, 900.0, 1000.0), strict=True):
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
