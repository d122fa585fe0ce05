# SPDX-License-Identifier: Apache-2.0
"""Everything that is logged, read back and compared number by number with what was given."""

import math
from dataclasses import replace
from types import SimpleNamespace as NS

import made_up
import numpy as np
import pytest
from eel_common.attitude import attitude, world_from_body, world_from_section
from eel_viz.batched_stream import Rates
from eel_viz.limit import RECENT
from eel_viz.messages import WRENCH_FIELDS, Pose
from eel_viz.plots import heat_map
from eel_viz.recording.dispatcher import Dispatcher
from eel_viz.recording.loggers import Loggers
from eel_viz.recording.reading import read
from eel_viz.recording.recording_file import FileDestination
from eel_viz.recording.recordings import Recordings
from eel_viz.scene3d import camera
from eel_viz.scene3d.colours import diverging_index
from eel_viz.scene3d.lettering import strokes_of
from eel_viz.scene3d.skin import Skin
from eel_viz.scene3d.swimmer_scene import in_sight
from eel_viz.scene3d.track import EDGES, LENGTH, PIECES, POINTS, STROBE_PERIOD
from eel_viz.scene3d.water import FLOOR, GRID, LABELS, WALLS
from eel_viz.settings import BLUEPRINTS, Settings
from eel_viz.views.blueprint import arrangement
from made_up_recording import body
from made_up_recording import profiles as profiles_of

from eel_viz import entities

TIME_SERIES = (
    entities.POSITION,
    entities.ORIENTATION,
    entities.ATTITUDE,
    entities.DEPTH,
    entities.LINEAR,
    entities.ANGULAR,
    entities.SPEED,
    entities.POWER,
    entities.POWER_BESIDES,
    entities.KINETIC,
    entities.STORED,
    entities.RESIDUAL,
)
NUMBERS = (
    entities.WRENCH_NUMBERS,
    entities.CURVATURE_NUMBERS,
    entities.LOAD_NUMBERS,
    entities.ODOMETRY_NUMBERS,
)
SINGLE = 1e-6  # Rerun's geometry is single precision


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    from made_up_recording import record

    path = tmp_path_factory.mktemp("made") / "made_up.rrd"
    return path, record(path, 1.0, 100.0, colour_limit=0.25, torque_limit=0.6, force_limit=2.0, curvature_limit=5.0)


def drawn_stamps(samples, rate=25.0):
    """The first stamp of every period."""
    period = 1e9 / rate
    slots = [int((stamp + 1000) // period) for stamp in samples]
    return [stamp for k, stamp in enumerate(samples) if k == 0 or slots[k] != slots[k - 1]]


def given(samples, topic, pick):
    return np.array([pick(*arguments[topic]) for arguments in samples.values()])


def assert_exact(path, entity, component, samples, expected):
    columns = read(path, entity)
    np.testing.assert_array_equal(columns.stamps_of[component], list(samples), err_msg=entity)
    np.testing.assert_array_equal(columns[component], expected, err_msg=f"{entity} {component}")


def test_way_points_of_the_newest_goal_are_drawn_and_a_bad_goal_is_left_out(tmp_path):
    path, said = tmp_path / "goal.rrd", []
    destination = FileDestination(Settings(recording=str(path)), said.append, said.append)
    recordings = Recordings([destination], name="eel", log_warning=said.append, has_several_publishers=lambda _: False)
    dispatcher = Dispatcher(recordings, namespace="", log_warning=said.append)
    points = [(4.0, 1.0, -0.5), (8.0, -1.0, 0.25)]
    for goal in ([], points, [(math.nan, 0.0, 0.0)]):
        poses = [NS(pose=NS(position=NS(x=x, y=y, z=z))) for x, y, z in goal]
        dispatcher.dispatch("goal", NS(poses=poses))
    dispatcher.finish()
    recordings.close()
    spheres = read(path, entities.WAY_POINTS, static=True)
    np.testing.assert_array_equal(spheres["half_sizes"][-1], np.full((2, 3), 0.25))
    np.testing.assert_array_equal(read(path, entities.COURSE, static=True)["strips"][-1][0], points)
    tube = read(path, entities.TUBE, static=True)
    along = np.subtract(points[1], points[0])
    np.testing.assert_allclose(tube["lengths"][-1], [np.linalg.norm(along)], rtol=1e-6)
    axes = world_from_body(np.array(tube["quaternions"][-1]))
    np.testing.assert_allclose(axes[0, :, 2], along / np.linalg.norm(along), atol=1e-6)
    assert [text for text in said if "goal: poses" in text], said


@pytest.mark.parametrize(("given", "reach"), [({}, 0.25), ({"reach": 0.6}, 0.6)])
def test_way_points_that_come_before_the_body_get_its_size(given, reach, tmp_path):
    path, said = tmp_path / "goal.rrd", []
    settings = Settings(recording=str(path), **given)
    destination = FileDestination(settings, said.append, said.append)
    delivery = destination.open(1, "goal")
    loggers = Loggers(delivery.stream, settings, Rates())
    loggers.log("goal", 0, np.array([(4.0, 1.0, -0.5), (8.0, -1.0, 0.25)]))
    loggers.log("body", 0, replace(body(), length=0.4))
    loggers.flush()
    delivery.close()
    spheres = read(path, entities.WAY_POINTS, static=True)
    np.testing.assert_allclose(spheres["half_sizes"][-1], np.full((2, 3), 0.4 * reach), rtol=1e-6)


def test_scalars_are_exact_and_complete(made):
    path, samples = made
    powers = ("actuator_power", "wake_power", "nose_power", "drag_power")
    besides = ("flow_power", "fins_power", "damping_power", "appendages_power", "external_power")
    expected = {
        entities.POSITION: given(samples, "head_pose", lambda pose: pose.position),
        entities.ORIENTATION: given(samples, "head_pose", lambda pose: pose.orientation),
        entities.ATTITUDE: given(samples, "head_pose", lambda pose: np.degrees(attitude(pose.orientation))),
        entities.DEPTH: given(samples, "head_pose", lambda pose: [-pose.position[2]]),
        entities.LINEAR: given(samples, "head_twist", lambda twist: twist.linear),
        entities.ANGULAR: given(samples, "head_twist", lambda twist: twist.angular),
        entities.SPEED: given(samples, "head_twist", lambda twist: [np.linalg.norm(twist.linear)]),
        entities.POWER: given(samples, "energy", lambda energy: [energy[name] for name in powers]),
        entities.POWER_BESIDES: given(samples, "energy", lambda energy: [energy[name] for name in besides]),
        entities.STORED: given(samples, "energy", lambda energy: [energy["potential"], energy["elastic"]]),
        entities.KINETIC: given(samples, "energy", lambda energy: [energy["kinetic_body"], energy["kinetic_fluid"]]),
        entities.RESIDUAL: given(samples, "energy", lambda energy: [energy["residual"]]),
    }
    assert set(expected) == set(TIME_SERIES)
    for entity, values in expected.items():
        assert_exact(path, entity, "scalars", samples, values)


def test_profiles_are_exact_and_complete(made):
    path, samples = made
    for topic, entity, profiles in (
        ("internal_wrench", entities.WRENCH_NUMBERS, lambda wrench: wrench),
        ("curvature", entities.CURVATURE_NUMBERS, lambda curvature: curvature),
        ("hydrodynamic_load", entities.LOAD_NUMBERS, lambda load: load.profiles),
    ):
        first = profiles(*samples[0][topic])
        for name in first.values:
            values = given(samples, topic, lambda message, name=name, profiles=profiles: profiles(message).values[name])
            assert_exact(path, entity, name, samples, values)
        stations = read(path, entity)
        np.testing.assert_array_equal(stations["x"], [first.x])  # once, since it stays
    for name, component in (("tail", "tail_force"), ("nose", "nose_force"), ("fins", "fin_force")):
        values = given(samples, "hydrodynamic_load", lambda load, name=name: getattr(load, name))
        assert_exact(path, entities.LOAD_NUMBERS, component, samples, values)


def test_odometry_is_exact(made):
    path, samples = made
    for name, k in (("position", 0), ("orientation", 0), ("linear", 1), ("angular", 1)):
        values = given(samples, "odom", lambda *both, name=name, k=k: getattr(both[k], name))
        assert_exact(path, entities.ODOMETRY_NUMBERS, name, samples, values)


def test_body_and_law(made):
    path, _ = made
    logged = read(path, entities.BODY_NUMBERS, static=True)
    for name in ("x", "half_width", "half_height"):
        np.testing.assert_array_equal(logged[name][0], getattr(body(), name))
    assert (logged["length"][0][0], logged["mass"][0][0]) == (body().length, body().mass)
    text = read(path, entities.LOG)
    assert text["text"][0][0] == "law 'made up' published"
    assert "law **made up**" in read(path, entities.RUN)["text"][-1][0]


def test_the_backbone_is_there_with_every_sample(made):
    path, samples = made
    columns = read(path, entities.BACKBONE)
    np.testing.assert_array_equal(columns.stamps, list(samples))
    expected = given(samples, "backbone", lambda backbone: backbone.position)
    np.testing.assert_allclose(columns["strips"][:, 0], expected, atol=SINGLE)


def packed(shades):
    """Colours (N, 3) as Rerun keeps them: one number each, opaque."""
    red, green, blue = shades.astype(np.uint32).T
    return (red << 24) + (green << 16) + (blue << 8) + 255


def test_skin_and_frames_at_the_drawing_rate(made):
    path, samples = made
    stamps = drawn_stamps(samples)
    assert len(stamps) == 26
    skin = Skin(body().x, body().half_width, body().half_height)
    logged, eyes = read(path, entities.SKIN), read(path, entities.EYES)
    for name in ("vertex_positions", "vertex_normals"):
        np.testing.assert_array_equal(logged.stamps_of[name], stamps)
    np.testing.assert_array_equal(logged.stamps_of["vertex_colors"], [0, *stamps])  # first those without a torque
    np.testing.assert_array_equal(np.array(logged["vertex_colors"][0], dtype=np.uint32), packed(skin.shades))
    np.testing.assert_array_equal(read(path, entities.SKIN, static=True)["triangle_indices"][0], skin.triangles)
    fixed = read(path, entities.EYES, static=True)
    np.testing.assert_allclose(fixed["half_sizes"][0], skin.eye_sizes, atol=SINGLE)
    heads, tails, follow, whole = (
        read(path, entity) for entity in (entities.HEAD, entities.TAIL, entities.FOLLOW, entities.WHOLE_PATH)
    )
    followed, path_frame = camera.FollowFrame(), camera.PathFrame()
    for k, stamp in enumerate(stamps):
        backbone = samples[stamp]["backbone"][0]
        vertices, normals = skin.place(backbone.x, backbone.position, backbone.orientation)
        np.testing.assert_allclose(logged["vertex_positions"][k], vertices, atol=SINGLE)
        np.testing.assert_allclose(logged["vertex_normals"][k], normals, atol=SINGLE)
        wrench = samples[stamp]["internal_wrench"][0]
        shades = skin.coloured(wrench.x, wrench.values["torque_3"], 0.25)
        np.testing.assert_array_equal(np.array(logged["vertex_colors"][1 + k], dtype=np.uint32), packed(shades))
        np.testing.assert_allclose(eyes["translation"][k][0], backbone.position[0], atol=SINGLE)
        np.testing.assert_allclose(eyes["quaternion"][k][0], backbone.orientation[0], atol=SINGLE)
        pose = samples[stamp]["head_pose"][0]
        np.testing.assert_allclose(heads["translation"][k][0], pose.position, atol=SINGLE)
        np.testing.assert_allclose(heads["quaternion"][k][0], pose.orientation, atol=SINGLE)
        np.testing.assert_allclose(tails["translation"][k][0], backbone.position[-1], atol=SINGLE)
        np.testing.assert_allclose(tails["quaternion"][k][0], backbone.orientation[-1], atol=SINGLE)
        for logged_frame, frame in (
            (follow, followed.follow(stamp, in_sight(backbone.position), 1.0)),
            (whole, path_frame.include(backbone.position, 1.0)),
        ):
            np.testing.assert_allclose(logged_frame["translation"][k][0], frame[0], atol=SINGLE)
            np.testing.assert_allclose(logged_frame["scale"][k][0], np.full(3, frame[1]), rtol=1e-6)


def test_the_track_is_the_path_of_the_head_without_gaps(made):
    path, samples = made
    stamps = drawn_stamps(samples)
    track = read(path, entities.TRACK)
    np.testing.assert_array_equal(track.stamps, stamps[1:])
    heads = np.array([samples[stamp]["head_pose"][0].position for stamp in stamps])
    np.testing.assert_allclose(track["strips"][:, 0, 0], heads[:-1], atol=SINGLE)
    np.testing.assert_allclose(track["strips"][:, 0, 1], heads[1:], atol=SINGLE)


def test_strobes_are_the_midline_once_a_second(made):
    path, samples = made
    strobes = read(path, entities.STROBES)
    stamps = np.array(sorted(stamp for stamp in samples if "backbone" in samples[stamp]))
    firsts = [stamps[stamps // STROBE_PERIOD == number][0] for number in np.unique(stamps // STROBE_PERIOD)]
    np.testing.assert_array_equal(strobes.stamps, firsts)
    midlines = [samples[stamp]["backbone"][0].position for stamp in firsts]
    for strips, midline in zip(strobes["strips"], midlines, strict=True):
        np.testing.assert_allclose(strips[0], midline, atol=SINGLE)


def test_the_trail_is_the_last_of_the_path_and_fades(made):
    path, samples = made
    trail = read(path, entities.TRAIL)
    stamps = drawn_stamps(samples)
    np.testing.assert_array_equal(trail.stamps, stamps)
    heads = np.array([samples[stamp]["head_pose"][0].position for stamp in stamps])
    for k, stamp in enumerate(stamps):
        strips = np.array(trail["strips"][k])
        np.testing.assert_allclose(strips[0, 0], heads[k], atol=SINGLE)
        np.testing.assert_allclose(strips[1:, 0], strips[:-1, -1], atol=SINGLE)  # one after the other
        ages = np.concatenate([np.linspace(0.0, LENGTH / PIECES, POINTS) + n * LENGTH / PIECES for n in range(PIECES)])
        at = np.maximum(stamp / 1e9 - ages, 0.0)
        expected = np.stack([np.interp(at, np.array(stamps) / 1e9, heads[:, axis]) for axis in range(3)], axis=1)
        np.testing.assert_allclose(strips.reshape(-1, 3), expected, atol=SINGLE)
    shades = np.array(read(path, entities.TRAIL, static=True)["colors"][0], dtype=np.uint32)
    red = (shades >> 24) & 255
    assert np.all(np.diff(red.astype(int)) < 0)


@pytest.mark.parametrize(
    ("topic", "names", "entity", "limit"),
    [
        ("internal_wrench", ("torque_1", "torque_2", "torque_3"), entities.TORQUE, 0.6),
        ("internal_wrench", ("force_1", "force_2", "force_3"), entities.FORCE, 2.0),
        ("curvature", ("pitch", "yaw"), entities.CURVATURE, 5.0),
    ],
)
def test_curves_and_envelopes_are_those_of_the_messages(made, topic, names, entity, limit):
    path, samples = made
    values = np.array([samples[stamp][topic][0].together(*names) for stamp in samples])
    assert np.abs(values).max() < limit  # so that the frame does not grow
    order = {stamp: k for k, stamp in enumerate(samples)}
    curves, envelope = read(path, f"{entity}/{entities.CURVES}"), read(path, f"{entity}/{entities.ENVELOPE}")
    np.testing.assert_array_equal(curves.stamps, drawn_stamps(samples))
    for stamp, strips in zip(curves.stamps.tolist(), curves["strips"], strict=True):
        np.testing.assert_allclose(-2 * limit * np.array(strips)[:, :, 1].T, values[order[stamp]], atol=SINGLE * limit)
    for stamp, strips in zip(envelope.stamps.tolist(), envelope["strips"], strict=True):
        seen = values[: order[stamp] + 1]
        extremes = np.concatenate([seen.min(axis=0), seen.max(axis=0)], axis=1)
        np.testing.assert_allclose(-2 * limit * np.array(strips)[:, :, 1].T, extremes, atol=SINGLE * limit)


def test_the_heat_map_is_c3_of_the_messages(made):
    path, samples = made
    maps = read(path, entities.HEAT_MAP_IMAGE)
    for stamp, buffer in zip(maps.stamps.tolist(), maps["buffer"], strict=True):
        image = np.array(buffer, dtype=np.uint8).reshape(heat_map.ROWS, heat_map.COLUMNS)
        step = round(heat_map.STEP * 1e9)
        wrench = samples[stamp // step * step]["internal_wrench"][0]
        rows = np.interp(np.linspace(0.0, 1.0, heat_map.ROWS), wrench.x, wrench.values["torque_3"])
        np.testing.assert_array_equal(image[:, -1], np.maximum(diverging_index(rows, 0.25), 1))


def test_nothing_is_shown_that_no_test_compares_with_the_messages(made):
    from rerun.chunk import RrdReader

    path, _ = made
    chunks = RrdReader(str(path)).stream()
    changing = {str(chunk.entity_path) for chunk in chunks if not chunk.is_static}
    plots = (entities.TORQUE, entities.FORCE, entities.CURVATURE)
    compared = {*TIME_SERIES, *NUMBERS, entities.BACKBONE, entities.SKIN, entities.HEAD, entities.TAIL, entities.FOLLOW}
    compared |= {entities.TRACK, entities.STROBES, entities.TRAIL, entities.HEADING, entities.SPEED_NOTE}
    compared |= {
        f"{entities.SPEED_NOTE}/words",
        entities.FLOW,
        entities.FLOW_LEGEND,
        entities.LOAD,
        entities.LOAD_ENDS,
        entities.WAKE,
        entities.WAKE_LEGEND,
        entities.HEAT_MAP_IMAGE,
    }
    compared |= {f"{root}/{part}" for root in plots for part in (entities.CURVES, entities.ENVELOPE, entities.TICKS)}
    compared |= {
        f"{root}/{part}" for root in (entities.WATER, entities.PATH_WATER) for part in (GRID, LABELS, WALLS, FLOOR)
    }
    compared |= {entities.SHADOW, entities.RUN, entities.LOG, entities.EYES, entities.WHOLE_PATH}
    compared |= {f"{entities.LEGEND}/{part}" for part in ("labels", "arrows")}
    compared.add(f"{entities.HEAT_MAP_FRAME}/labels")
    assert changing - {path for path in changing if path.startswith("/__")} == compared


def test_arrows_are_the_load_in_the_world(record_made_up):
    path, samples = record_made_up(0.4, 100.0, load_scale=0.5, end_force_scale=2.0)
    stamps = drawn_stamps(samples)
    arrows, ends = read(path, entities.LOAD), read(path, entities.LOAD_ENDS)
    np.testing.assert_array_equal(arrows.stamps, stamps)
    for k, stamp in enumerate(stamps):
        backbone, load = samples[stamp]["backbone"][0], samples[stamp]["hydrodynamic_load"][0]
        force = world_from_section(backbone.orientation, load.profiles.together("force_1", "force_2", "force_3"))
        origins = np.array(arrows["origins"][k])
        along = [int(np.argmin(np.linalg.norm(backbone.position - origin, axis=1))) for origin in origins]
        assert len(set(along)) == 24
        np.testing.assert_allclose(origins, backbone.position[along], atol=SINGLE)
        np.testing.assert_allclose(arrows["vectors"][k], 0.5 * force[along], atol=SINGLE * np.abs(force).max())
        both = world_from_section(backbone.orientation[[0, -1]], np.stack([load.nose, load.tail]))
        np.testing.assert_allclose(ends["vectors"][k], 2.0 * both, atol=SINGLE)
        np.testing.assert_allclose(ends["origins"][k], backbone.position[[0, -1]], atol=SINGLE)


def test_arrows_of_the_water_are_its_velocity_and_the_fastest_so_far_has_a_fixed_length(record_made_up):
    path, samples = record_made_up(0.4, 100.0)
    stamps, arrows, fastest = drawn_stamps(samples), read(path, entities.FLOW), 0.0
    np.testing.assert_array_equal(arrows.stamps, stamps)
    for k, stamp in enumerate(stamps):
        position, velocity = samples[stamp]["flow_vectors"]
        fastest = max(fastest, np.linalg.norm(velocity, axis=1).max())
        np.testing.assert_allclose(arrows["origins"][k], position, atol=SINGLE)
        np.testing.assert_allclose(arrows["vectors"][k], 0.16 / fastest * velocity, atol=SINGLE)
    (told,) = read(path, entities.FLOW_LEGEND).values["labels"][-1]
    assert told == f"water without the swimmer, longest {fastest:.2g} m/s"


def test_the_wake_shows_what_the_tail_gave_and_fades(record_made_up):
    path, samples = record_made_up(0.4, 100.0, wake_scale=2.0)
    wake, stamps = read(path, entities.WAKE), drawn_stamps(samples)
    np.testing.assert_array_equal(wake.stamps, stamps)
    lines, loads = ([samples[stamp][topic][0] for stamp in stamps] for topic in ("backbone", "hydrodynamic_load"))
    tails = np.array([line.position[-1] for line in lines])
    given_away = world_from_section(
        np.array([line.orientation[-1] for line in lines]), np.array([load.wake for load in loads])
    )
    ends = np.concatenate([tails, tails + 2.0 * given_away], axis=1)
    for stamp, strips in zip(stamps, wake["vertex_positions"], strict=True):
        at = np.maximum(stamp / 1e9 - np.linspace(0.0, LENGTH, EDGES), 0.0)
        expected = np.stack([np.interp(at, np.array(stamps) / 1e9, column) for column in ends.T], axis=1)
        np.testing.assert_allclose(np.array(strips).reshape(EDGES, 6), expected, atol=3 * SINGLE)
    shades = np.array(read(path, entities.WAKE, static=True)["vertex_colors"][0], dtype=np.uint32)
    assert np.all(np.diff(((shades >> 24) & 255).astype(int)) <= 0)


def test_notes_say_how_fast_the_head_is_and_where_it_goes(long_swim):
    path, samples = long_swim
    arrow = read(path, entities.HEADING)
    assert len(arrow.stamps) > 100
    for stamp, (begin,), (ahead,) in zip(arrow.stamps.tolist(), arrow["origins"], arrow["vectors"], strict=True):
        if stamp > 4 * 10**9:  # it swims towards +x by then
            assert begin[0] > samples[stamp]["backbone"][0].position[0, 0] and ahead[0] > 0.8 * np.linalg.norm(ahead)
    speeds = read(path, f"{entities.SPEED_NOTE}/words")
    for stamp, (words,) in zip(speeds.stamps.tolist(), speeds.values["labels"], strict=True):
        now = np.linalg.norm(samples[stamp]["head_twist"][0].linear)
        head, told, unit = words.split()
        assert (head, unit) == ("head", "m/s") and float(told) == pytest.approx(now, abs=0.006)


@pytest.mark.parametrize("lag", [-9, 0, 9])
def test_the_run_panel_is_true_at_its_time_whatever_comes_first(lag, tmp_path):
    path, said = tmp_path / "panel.rrd", []
    destination = FileDestination(Settings(recording=str(path)), said.append, said.append)
    delivery = destination.open(1, "panel")
    loggers, swimmer = Loggers(delivery.stream, Settings(), Rates()), made_up.Swimmer(21)
    times = [round(k * 20e6) for k in range(201)]
    given = {
        "head_pose": lambda t: Pose(**{name: swimmer.head(t)[name] for name in ("position", "orientation")}),
        "internal_wrench": lambda t: profiles_of(swimmer.wrench(t), WRENCH_FIELDS),
    }
    for k in range(-9, len(times) + 9):  # the torques come so many samples after the heads
        for topic, at in (("head_pose", k), ("internal_wrench", k - lag)):
            if 0 <= at < len(times):
                loggers.log(topic, times[at], given[topic](times[at] / 1e9))
    loggers.flush()
    delivery.close()
    texts, wrench = read(path, entities.RUN), read(path, entities.WRENCH_NUMBERS)
    assert set(texts.stamps.tolist()) == set(drawn_stamps(times))
    at, torque = wrench.stamps, wrench["torque_3"]
    greatest, heads = np.abs(torque).max(axis=1), read(path, entities.POSITION)["scalars"]
    shown = dict(
        zip(texts.stamps_of["text"].tolist(), (text for (text,) in texts["text"]), strict=True)
    )  # the last of a stamp
    for stamp in drawn_stamps(times)[1:]:
        said, k = shown[stamp].replace("*", ""), int(np.searchsorted(at, stamp))
        where = int(np.abs(torque[k]).argmax())
        assert f"now {torque[k, where]:+.2g} N m at X = {swimmer.x[where]:.2f} m" in said
        assert f"in 3 s {greatest[: k + 1][at[: k + 1] >= stamp - RECENT].max():.2g} N m" in said
        peak = int(greatest[: k + 1].argmax())
        assert f"since the start {torque[peak, np.abs(torque[peak]).argmax()]:+.2g} N m" in said
        length = np.linalg.norm(np.diff(heads[: k + 1], axis=0), axis=1).sum()
        assert f"until {stamp / 1e9:.2f} s: mean speed {length / stamp * 1e9:.3f} m/s, path {length:.2f} m" in said


@pytest.fixture(scope="module")
def long_swim(tmp_path_factory):
    from made_up_recording import record

    path = tmp_path_factory.mktemp("long") / "long.rrd"
    return path, record(path, 8.0, 25.0)


@pytest.mark.parametrize(
    ("root", "frame"), [(entities.WATER, entities.FOLLOW), (entities.PATH_WATER, entities.WHOLE_PATH)]
)
def test_the_water_encloses_the_swimmer_and_its_labels_say_where(long_swim, root, frame):
    path, samples = long_swim
    grid, labels, follow = (read(path, entity) for entity in (f"{root}/{GRID}", f"{root}/{LABELS}", frame))
    boxes = dict(zip(grid.stamps.tolist(), grid["strips"], strict=True))
    shown = {}
    for stamp, texts, strips in zip(
        labels.stamps.tolist(), labels.values["labels"], labels.values["strips"], strict=True
    ):
        sizes = [len(strokes_of(text)) for text in texts]
        assert sum(sizes) == len(strips)
        ends = np.cumsum(sizes)
        letters = [np.concatenate(strips[end - size : end]) for size, end in zip(sizes, ends, strict=True)]
        shown[stamp] = [
            (text, (each.min(axis=0) + each.max(axis=0)) / 2) for text, each in zip(texts, letters, strict=True)
        ]
    box, present, counts = None, [], []
    for stamp, scale in zip(follow.stamps.tolist(), follow["scale"], strict=True):
        if stamp in boxes:
            corners = np.array(boxes[stamp]).reshape(-1, 3)
            box = corners.min(axis=0), corners.max(axis=0)
        present = shown.get(stamp, present)
        position = samples[stamp]["backbone"][0].position
        assert np.all(position - box[0] > 0.2) and np.all(box[1] - position > 0.1)
        radius = float(scale[0][0])
        counts.append(len(present))
        for text, point in present:
            kind, value, unit = text.split()
            axis = ("x", "y", "depth").index(kind)
            at = -point[2] if kind == "depth" else point[axis]
            assert unit == "m" and float(value) == pytest.approx(at, abs=0.06 * radius)
            assert np.all(point < box[1] + 1e-6), "letters stand on the walls or before them"
    assert min(counts) >= 2 and np.mean(counts) > 4


def test_stations_may_change_in_mid_run(record_made_up, tmp_path):
    from eel_viz.recording.recording_file import FileDestination
    from eel_viz.settings import Settings
    from made_up_recording import sample

    settings = Settings(recording=str(tmp_path / "changing.rrd"))
    file = FileDestination(settings, print, print)
    delivery = file.open(1, "changing")
    loggers = Loggers(delivery.stream, settings, Rates())
    loggers.log("body", 0, body())
    for k, stations in enumerate((51, 51, 21, 101)):
        for method, arguments in sample(made_up.Swimmer(stations), k * 10**9).items():
            loggers.log(method, k * 10**9, *arguments)
    loggers.flush()
    delivery.close()
    numbers = read(tmp_path / "changing.rrd", entities.WRENCH_NUMBERS)
    assert [len(row) for row in numbers.values["x"]] == [51, 21, 101]
    assert [len(row) for row in numbers.values["torque_3"]] == [51, 51, 21, 101]
    assert len(read(tmp_path / "changing.rrd", entities.SKIN)["vertex_positions"]) == 4


def test_the_order_of_topics_does_not_matter(tmp_path):
    from eel_viz.recording.recording_file import FileDestination
    from eel_viz.settings import Settings
    from made_up_recording import sample

    paths = []
    for name, turn in (("forwards", 1), ("backwards", -1)):
        settings = Settings(recording=str(tmp_path / f"{name}.rrd"))
        file = FileDestination(settings, print, print)
        delivery = file.open(1, name)
        loggers = Loggers(delivery.stream, settings, Rates())
        loggers.log("body", 0, body())
        for k in range(10):
            for method, arguments in list(sample(made_up.Swimmer(), k * 10**8).items())[::turn]:
                loggers.log(method, k * 10**8, *arguments)
        loggers.flush()
        delivery.close()
        paths.append(tmp_path / f"{name}.rrd")
    for entity, component in (
        (entities.LOAD, "vectors"),
        (entities.SKIN, "vertex_colors"),
        (entities.SKIN, "vertex_positions"),
        (entities.SPEED, "scalars"),
        (entities.HEADING, "vectors"),
        (entities.SPEED_NOTE, "translation"),
        (f"{entities.TORQUE}/curves", "strips"),
    ):
        forwards, backwards = (read(path, entity) for path in paths)
        np.testing.assert_array_equal(forwards.stamps, backwards.stamps)
        assert forwards.values[component] == backwards.values[component]


def test_a_lower_rate_for_a_live_viewer(tmp_path):
    from eel_viz.recording.recording_file import FileDestination
    from eel_viz.settings import Settings
    from made_up_recording import sample

    settings = Settings(recording=str(tmp_path / "live.rrd"))
    file = FileDestination(settings, print, print)
    delivery = file.open(1, "live")
    loggers = Loggers(delivery.stream, settings, Rates(numbers=10.0, drawings=10.0))
    for k in range(101):
        for method, arguments in sample(made_up.Swimmer(), k * 10**7).items():
            loggers.log(method, k * 10**7, *arguments)
    loggers.flush()
    delivery.close()
    for entity in (entities.SPEED, entities.WRENCH_NUMBERS, entities.BACKBONE, entities.POWER):
        assert len(read(tmp_path / "live.rrd", entity).stamps) == 11, entity


def test_the_recording_carries_its_blueprint(made):
    from rerun.chunk import RrdReader

    path, _ = made
    assert len(RrdReader(str(path)).blueprints()) == 1
    with pytest.raises(ValueError, match=f"blueprint must be one of {', '.join(BLUEPRINTS)}, got 'best'"):
        arrangement("best")


@pytest.mark.parametrize(("end", "blueprints"), [(0.0, 1), (4.0, 1), (9.0, 2)])
def test_a_recording_gets_another_blueprint_for_its_end_unless_it_is_short(tmp_path, end, blueprints):
    from eel_viz.recording.recording_file import FileDestination
    from eel_viz.settings import Settings
    from rerun.chunk import RrdReader

    said = []
    file = FileDestination(Settings(recording=str(tmp_path / "run.rrd")), said.append, said.append)
    delivery = file.open(1, "made up")
    delivery.close(end)
    assert len(RrdReader(str(tmp_path / "run.rrd")).blueprints()) == blueprints


def test_a_recording_takes_less_than_a_megabyte_a_second_at_50_hz(record_made_up):
    path, _ = record_made_up(3.0, 50.0, plain=True)
    assert path.stat().st_size < 3.0 * 1e6
