# SPDX-License-Identifier: Apache-2.0
"""Plots against X, the heat map, colours and summary: what is drawn, read back from a recording."""

from itertools import combinations
from types import SimpleNamespace

import numpy as np
import pytest
import rerun as rr
from contrast import contrast, linear
from eel_viz.batched_stream import BatchedStream, Rates
from eel_viz.limit import Limit
from eel_viz.plots import heat_map, profile_plot, series
from eel_viz.plots.heat_map import HeatMap
from eel_viz.plots.profile_plot import ProfilePlot
from eel_viz.plots.series import Attitude
from eel_viz.plots.state_text import Summary, number, quantity
from eel_viz.recording.reading import read
from eel_viz.robots import motor_plots
from eel_viz.scene3d import colours, legend
from eel_viz.scene3d.arrows import RADII, Arrows
from eel_viz.scene3d.lettering import strokes_of
from eel_viz.settings import Settings
from hypothesis import given
from hypothesis import strategies as st

from eel_viz import entities

X = np.linspace(0.0, 2.0, 21)


class Drawn(BatchedStream):
    """A batched stream to the file `path`, which `disconnect` completes."""

    def __init__(self, path):
        self.path, self.recording = path, rr.RecordingStream("eel_test")
        self.recording.set_log_time_enabled(False)
        self.recording.save(path)
        super().__init__(self.recording, Rates(tick=1.0))

    def disconnect(self):
        self.flush()
        self.recording.disconnect()


@pytest.fixture
def stream(tmp_path):
    return Drawn(tmp_path / "drawn.rrd")


@given(limit=st.floats(1e-3, 1e3), value=st.floats(1e-6, 1e6))
def test_a_limit_grows_to_a_round_value_that_holds(limit, value):
    scale = Limit(limit)
    scale.recent.include(0, value)
    grown = scale.value
    assert grown >= value * (1 - 1e-9)
    if value <= limit:
        assert grown == limit
    else:
        mantissa = grown / 10 ** np.floor(np.log10(grown) + 1e-12)
        assert min(abs(mantissa - step) for step in (1, 1.5, 2, 3, 4, 5, 6, 8, 10)) < 1e-9
        assert grown <= 1.5 * value * (1 + 1e-9)


def test_a_limit_that_nobody_set_fits_the_first_values():
    scale = Limit(0.0)
    assert scale.value == 1.0  # all values so far are zero
    scale.recent.include(0, 3.2e-6)
    assert scale.value == pytest.approx(4e-6)


def test_a_limit_fits_the_last_seconds_alone_and_a_set_one_may_stay():
    recent, least, fixed = Limit(0.0), Limit(0.5), Limit(0.25, grows=False)
    assert recent.value == 1.0 and least.value == 0.5 and fixed.value == 0.25
    limits = {}
    for second, value in enumerate((0.0, 0.51, 0.2, 0.28, 0.21, 0.19, 0.0, 0.0, 0.0)):
        for scale in (recent, least, fixed):
            scale.recent.include(second * 10**9, value)
        limits[second] = recent.value
        assert least.value == max(0.5, recent.value if second else 0.0) and fixed.value == 0.25
    assert limits == pytest.approx({0: 1.0, 1: 0.6, 2: 0.6, 3: 0.6, 4: 0.6, 5: 0.3, 6: 0.3, 7: 0.3, 8: 0.2})


@pytest.mark.parametrize(
    ("metres", "text"),
    [
        (0.0, "0 m"),
        (1.7449, "1.74 m"),
        (1740.4, "1,740 m"),
        (0.0174, "17.4 mm"),
        (9.19e-4, "919 µm"),
        (2e-8, "0.0200 µm"),
    ],
)
def test_lengths_are_read_without_powers_of_ten(metres, text):
    assert quantity(metres, "m") == text


def test_torques_have_a_prefix_too():
    assert [quantity(value, "N m") for value in (5.82e-5, 0.0, -0.25)] == ["58.2 µN m", "0 N m", "-250 mN m"]


def test_numbers_are_read_without_powers_of_ten_where_that_can_be():
    assert [number(value) for value in (130.4, 0.0339, 999.7, 1e-7, -2.5)] == [
        "130",
        "0.0339",
        "1,000",
        "1e-07",
        "-2.50",
    ]


def test_heading_and_roll_go_on_over_whole_turns():
    attitude, turned = Attitude(), []
    for degrees in range(0, 1000, 30):
        wrapped = (np.radians(degrees) + np.pi) % (2 * np.pi) - np.pi
        turned.append(attitude.continued((wrapped, 0.1, -wrapped)))
    np.testing.assert_allclose(np.array(turned)[:, 0], np.arange(0, 1000, 30), atol=1e-9)
    np.testing.assert_allclose(np.array(turned)[:, 2], -np.arange(0, 1000, 30), atol=1e-9)
    np.testing.assert_allclose(np.array(turned)[:, 1], np.degrees(0.1))


def test_curves_are_drawn_in_the_frame_s_units(stream):
    plot = ProfilePlot(stream, entities.TORQUE, names=("C1", "C2"), unit="N m", limit=2.0)
    values = np.stack([np.linspace(-2.0, 2.0, 21), 0 * X], axis=1)
    plot.include(0, X, values)
    plot.draw(500_000_000, X, values)
    stream.disconnect()
    curves = read(stream.path, f"{entities.TORQUE}/{entities.CURVES}")
    np.testing.assert_array_equal(curves.stamps, [500_000_000])
    strips = curves["strips"][0]
    np.testing.assert_allclose(strips[0, :, 0], profile_plot.WIDTH * X / 2.0, atol=1e-6)
    np.testing.assert_allclose(strips[0, :, 1], np.linspace(0.5, -0.5, 21), atol=1e-7)  # y points down
    np.testing.assert_array_equal(strips[1, :, 1], 0.0)
    ticks = read(stream.path, f"{entities.TORQUE}/{entities.TICKS}")["labels"][0]
    assert list(ticks) == ["+2", "0", "-2", "0", "0.4", "0.8", "1.2", "1.6", "2", "[N m] over X [m]"]


def test_nothing_leaves_the_frame_and_ticks_follow(stream):
    plot = ProfilePlot(stream, entities.FORCE, names=("N1",), unit="N", limit=1.0)
    for k, size in enumerate((0.9, 1.2, 7.0, 0.1)):
        values = np.full((21, 1), size)
        plot.include(0, X, values)
        plot.draw(k * 10**9, X, values)
    stream.disconnect()
    curves = read(stream.path, f"{entities.FORCE}/{entities.CURVES}")
    drawn = np.array([row[0][0][1] for row in curves["strips"]])
    np.testing.assert_allclose(drawn, [-0.45, -0.4, -0.4375, -0.00625], atol=1e-7)
    ticks = read(stream.path, f"{entities.FORCE}/{entities.TICKS}")
    np.testing.assert_array_equal(ticks.stamps, [0, 1_000_000_000, 2_000_000_000])
    assert [row[0] for row in ticks["labels"]] == ["+1", "+1.5", "+8"]


def test_the_envelope_is_the_least_and_the_greatest_so_far(stream):
    plot = ProfilePlot(stream, entities.FORCE, names=("N1",), unit="N", limit=4.0)
    for k, phase in enumerate((0.0, 1.0, 2.0)):
        plot.include(0, X, np.sin(X + phase)[:, None])
        plot.draw_envelope(k * 10**9)
    stream.disconnect()
    low, high = read(stream.path, f"{entities.FORCE}/{entities.ENVELOPE}")["strips"][-1]
    seen = np.stack([np.sin(X + phase) for phase in (0.0, 1.0, 2.0)])
    np.testing.assert_allclose(np.array(low)[:, 1], -seen.min(axis=0) / 8, atol=1e-7)
    np.testing.assert_allclose(np.array(high)[:, 1], -seen.max(axis=0) / 8, atol=1e-7)


def test_the_envelope_starts_anew_with_other_stations(stream):
    plot = ProfilePlot(stream, entities.FORCE, names=("N1",), unit="N", limit=4.0)
    plot.include(0, X, np.full((21, 1), 3.0))
    shorter = np.linspace(0.0, 2.0, 5)
    plot.include(0, shorter, np.full((5, 1), 1.0))
    plot.draw_envelope(0)
    stream.disconnect()
    low, high = read(stream.path, f"{entities.FORCE}/{entities.ENVELOPE}")["strips"][-1]
    assert len(low) == len(high) == 5
    np.testing.assert_allclose(np.array(high)[:, 1], -1.0 / 8, atol=1e-7)


def image(path):
    rows = read(path, entities.HEAT_MAP_IMAGE)["buffer"]
    return np.frombuffer(np.array(rows[-1]).astype(np.uint8).tobytes(), np.uint8).reshape(
        heat_map.ROWS, heat_map.COLUMNS
    )


def test_the_heat_map_rolls_and_shows_gaps_by_the_next_value(stream):
    drawing = HeatMap(stream, limit=Limit(1.0))
    step = round(heat_map.STEP * 1e9)
    drawing.include(0, X, np.full(21, -1.0))
    drawing.include(step // 2, X, np.full(21, 0.7))  # the same column: left as it is
    drawing.include(3 * step, X, X / 2.0)
    drawing.draw(10**9)
    stream.disconnect()
    shown = image(stream.path)
    assert np.all(shown[:, :-4] == heat_map.NO_DATA)
    assert np.all(shown[:, -4] == 1)  # the deepest blue; 0 is kept for no data
    rows = np.linspace(0.0, 1.0, heat_map.ROWS)  # the head at the top
    np.testing.assert_array_equal(shown[:, -1], colours.diverging_index(rows, 1.0))
    np.testing.assert_array_equal(shown[:, -3], shown[:, -1])


def test_the_heat_map_forgets_what_is_older_than_its_length(stream):
    drawing = HeatMap(stream, limit=Limit(1.0))
    drawing.include(0, X, np.full(21, 1.0))
    drawing.include(10**12, X, np.full(21, 0.0))
    drawing.draw(10**9)
    stream.disconnect()
    assert set(np.unique(image(stream.path))) == {colours.diverging_index(np.zeros(1), 1.0)[0]}


GROUNDS = {  # the brightest ground of letters: its colour, and those of the letters
    "plots": (colours.PLOT_BACKGROUND, (colours.LABEL, colours.OTHER, *colours.AXIS)),
    "the legend's band": (
        colours.WATER_BACKGROUND,
        (colours.LABEL, colours.FORCE, colours.ENDS, colours.WAKE),
    ),
    "the walls of the water": (colours.WATER_SHALLOW, (colours.WATER_LABEL, colours.NOTE)),
    "the floor": (colours.WATER_FLOOR, (colours.NOTE,)),
}


@pytest.mark.parametrize("name", GROUNDS)
def test_letters_have_a_contrast_of_4_5_on_their_ground_in_every_theme(name):
    ground, letters = GROUNDS[name]
    assert min(contrast(letter, ground) for letter in letters) >= 4.5


@pytest.mark.parametrize("ground", [colours.WATER_DEEP, colours.WATER_SHALLOW, colours.WATER_FLOOR])
def test_grids_have_a_contrast_of_3_on_our_grounds(ground):
    assert contrast(colours.WATER_LINE_MAJOR, ground) >= 3.0
    assert contrast(colours.TICK, colours.PLOT_BACKGROUND) >= 3.0 and contrast(colours.FRAME, colours.TICK) > 1.2


@pytest.mark.parametrize("ground", [(255, 255, 255), (13, 16, 17)])
def test_curves_have_a_contrast_of_3_on_the_ground_of_either_theme(ground):
    """WCAG 2.2 asks this of lines; the viewer's own grounds are these."""
    lines = [line for each in (series.SERIES, motor_plots.SERIES) for lines in each.values() for line in lines]
    found = {name: contrast(colours.curve(colour), ground) for name, colour in lines}
    assert len(found) > 20 and min(found.values()) >= 3.0, found


EYES = {  # linear sRGB as seen by eyes without red, without green (Machado, Oliveira and Fernandes 2009, severity 1)
    "all": np.eye(3),
    "protanopia": np.array(
        ((0.152286, 1.052583, -0.204868), (0.114503, 0.786281, 0.099216), (-0.003882, -0.048116, 1.051998))
    ),
    "deuteranopia": np.array(
        ((0.367322, 0.860646, -0.227968), (0.280085, 0.672501, 0.047413), (-0.011820, 0.042940, 0.968881))
    ),
}
XYZ = np.array(((0.4124, 0.3576, 0.1805), (0.2126, 0.7152, 0.0722), (0.0193, 0.1192, 0.9505)))  # of linear sRGB


def cielab(colour, eyes="all") -> np.ndarray:
    """CIELAB 1976 of a colour (..., 3) as seen by these `eyes`."""
    light = np.clip(linear(np.asarray(colour) / 255.0) @ EYES[eyes].T, 0.0, 1.0)
    x, y, z = np.moveaxis(np.cbrt(light @ XYZ.T / (0.9505, 1.0, 1.089)), -1, 0)
    return np.stack([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)], axis=-1)


@pytest.mark.parametrize("eyes", EYES)
def test_the_curves_of_power_differ_for_eyes_without_red_or_green(eyes):
    """A distance of 10 in CIELAB is seen at a glance. The four that are always there are further apart, and so are
    actuators and dampers."""
    always, besides = (series.SERIES[path] for path in (entities.POWER, entities.POWER_BESIDES))
    seen = {name: cielab(colours.curve(colour), eyes) for name, colour in always + besides}
    apart = {pair: np.linalg.norm(seen[pair[0]] - seen[pair[1]]) for pair in combinations(seen, 2)}
    assert len(apart) == 36 and min(apart.values()) > 10.0, apart
    assert min(apart[pair] for pair in combinations(dict(always), 2)) > 18.0
    assert apart["actuators", "dampers"] > 20.0


def test_contrast_is_that_of_the_web_s_guidelines():
    assert contrast((0, 0, 0), (255, 255, 255)) == pytest.approx(21.0)
    assert contrast((119, 119, 119), (255, 255, 255)) == pytest.approx(4.48, abs=0.005)


def test_space_drawings_and_maps_have_our_ground_and_letters_and_all_else_the_theme_s(stream):
    """The viewer draws its own labels on plates of its theme: none may be shown on a ground of ours."""
    from eel_viz.recording.loggers import Loggers
    from eel_viz.views.blueprint import ARRANGEMENTS
    from eel_viz.views.views import PLAIN
    from made_up import Swimmer
    from made_up_recording import body, sample
    from rerun.chunk import RrdReader

    loggers = Loggers(stream.recording, Settings(compare="other"), Rates(), "this")
    loggers.log("body", 0, body())
    for k in range(10):
        for method, arguments in sample(Swimmer(), k * 10**8).items():
            loggers.log(method, k * 10**8, *arguments)
    loggers.flush()
    stream.disconnect()
    texts = 0
    for chunk in RrdReader(str(stream.path)).stream():
        batch = chunk.to_record_batch()
        names = [name for name in batch.schema.names if name.endswith(":labels")]
        for name in names:
            texts += 1
            shown = batch.column(name.replace(":labels", ":show_labels")).to_pylist()
            assert not any(any(row) for row in shown), chunk.entity_path
    assert texts > 10

    def views(part):
        if hasattr(part, "origin"):
            return [part]
        return [view for each in part.contents for view in views(each)]

    for make in ARRANGEMENTS.values():
        for view in views(make(PLAIN)):
            ours = any("ackground" in name for name in view.properties)
            assert ours == (view.class_identifier in ("2D", "3D")), view.name


def test_letters_are_as_high_and_stand_where_they_are_told():
    low, high = (np.concatenate(strokes_of("H"))[:, 1].min(), np.concatenate(strokes_of("H"))[:, 1].max())
    assert (low, high) == pytest.approx((-0.5, 0.5))
    for align in (0.0, 0.5, 1.0):
        x = np.concatenate(strokes_of("XX", align))[:, 0]
        assert (x.min() + x.max()) / 2 == pytest.approx((0.5 - align) * 2 * 20 / 21, abs=0.01)
    assert len(strokes_of("ä")) == len(strokes_of("?"))


def test_arrows_are_as_thick_as_fits_the_body(stream):
    arrows = Arrows(stream, Settings())
    arrows.body(0, SimpleNamespace(length=0.1))
    stream.disconnect()
    for path, thickness in RADII.items():
        assert read(stream.path, path, static=True)["radii"][-1] == pytest.approx([0.1 * thickness])


def test_the_legend_tells_small_torques_in_thousandths(stream):
    legend.log_limit(stream, 0, limit=0.0015, unit="N m", name="C3")
    legend.log_limit(stream, 1, limit=0.3, unit="N m", name="C3")
    stream.disconnect()
    told = read(stream.path, f"{entities.LEGEND}/labels").values["labels"]
    assert told == [["-1.5", "C3 [mN m]", "+1.5"], ["-0.3", "C3 [N m]", "+0.3"]]


def test_diverging_colours_are_ordered_and_differ_in_hue_from_the_middle():
    values = np.linspace(-1.5, 1.5, 301)
    shades = colours.diverging(values, 1.0).astype(int)
    np.testing.assert_array_equal(shades[0], colours.DIVERGING[0])
    np.testing.assert_array_equal(shades[-1], colours.DIVERGING[-1])
    middle = colours.diverging(np.array([0.0]), 1.0)[0].astype(int)
    np.testing.assert_allclose(middle, colours.BACK, atol=2)
    warmth = shades[:, 0] - shades[:, 2]  # red less blue
    assert np.all(np.diff(warmth[60:240]) >= -6)
    assert warmth[75] < -60
    assert warmth[225] > 60
    lightness = cielab(colours.DIVERGING)[:, 0]  # rises evenly to both sides
    assert np.all(np.diff(lightness[127::-1]) > 0.0) and np.all(np.diff(lightness[128:]) > 0.0)
    assert np.abs(lightness - lightness[::-1]).max() < 1.0
    assert np.ptp(lightness) > 39.0


def test_the_summary_counts_path_speed_and_greatest_torque():
    summary = Summary()
    summary.curvature_law(0, "falling")
    summary.add_status(9 * 10**9, "finished", {"accuracy": "fine"})  # later than the head is
    summary.add_status(
        10**9, "waiting", {"accuracy": "standard", "closure_torque_relative": "1.23456e-14", "real_time_factor": "0.0"}
    )
    for k in range(5):
        summary.add_position(k * 10**9, np.array([0.5 * k, 0.0, 0.0]))
        if k == 2:
            assert "law **falling**  \n" in summary.text()  # it has begun since it said that it waits
            assert "pace" not in summary.text() and "estimated error" not in summary.text()  # 0: not known so far
    assert summary.add_status(25 * 10**8, "swimming", {"real_time_factor": "0.98", "error_position": "0.0"})
    assert "pace [times real time] 0.980" in summary.text() and "estimated error" not in summary.text()
    assert summary.add_status(3 * 10**9, "swimming", {})  # late
    summary.add_torque(2 * 10**9, np.array([0.0, 0.5, 1.0]), np.array([0.1, -0.7, 0.2]))
    summary.add_torque(3 * 10**9, np.array([0.0, 0.5, 1.0]), np.array([0.6, 0.1, 0.2]))
    text = summary.text()
    assert "law **falling**, swimming" in text
    assert "until 3.00 s: mean speed **0.500 m/s**, path 1.50 m" in text  # the torque of 4 s has not come
    assert "now +0.6 N m at X = 0.00 m" in text
    assert "greatest torque |C3| in 3 s **0.7 N m** at X = 0.50 m" in text
    assert "since the start **-0.7 N m** at X = 0.50 m, 2.00 s" in text
    assert not summary.add_torque(6 * 10**9, np.array([0.0, 0.5, 1.0]), np.array([0.5, 0.1, 0.2]))
    assert summary.text() == text
    assert summary.add_position(6 * 10**9, np.array([3.0, 0.0, 0.0]))
    assert "until 6.00 s: mean speed **0.500 m/s**, path 3.00 m" in summary.text()
    assert "in 3 s **0.6 N m** at X = 0.00 m" in summary.text()  # that of 2 s is forgotten
    assert "accuracy standard, pace [times real time] 0.980, closure 1.23e-14" in text
    assert "warnings" not in text
