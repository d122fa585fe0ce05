# SPDX-License-Identifier: Apache-2.0
"""Axes, the line between stations, and the skin: against circles and ellipses that are known exactly."""

import made_up
import numpy as np
import pytest
from eel_common.attitude import world_from_body, world_from_section
from eel_viz.scene3d import camera, colours
from eel_viz.scene3d.centre_line import Resampling
from eel_viz.scene3d.skin import Skin


def about_z(angle):
    zero = np.zeros_like(angle)
    return np.stack([zero, zero, np.sin(angle / 2), np.cos(angle / 2)], axis=-1)


def circle(stations, curvature=2.0):
    """A backbone bent to the right (K3 > 0) in the plane z = 0: x, position, orientation, and the exact line."""
    x = np.linspace(0.0, 1.0, stations)

    def line(s):
        return np.stack([-np.sin(curvature * s), -(1 - np.cos(curvature * s)), 0 * s], axis=-1) / curvature

    # t1 = -ex of the section = (-cos, -sin, 0): turned by +K s about z
    return x, line(x), about_z(curvature * x), line


def test_rotation_matrices_are_those_of_the_quaternions():
    rng = np.random.default_rng(1)
    q = rng.normal(size=(20, 4))
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    matrices = world_from_body(q)
    np.testing.assert_allclose(
        matrices @ np.swapaxes(matrices, 1, 2), np.broadcast_to(np.eye(3), (20, 3, 3)), atol=1e-14
    )
    np.testing.assert_allclose(np.linalg.det(matrices), 1.0, atol=1e-14)
    v = rng.normal(size=(20, 3))
    xyz, w = q[:, :3], q[:, 3:]
    turned = v + 2 * np.cross(xyz, np.cross(xyz, v) + w * v)
    np.testing.assert_allclose(np.einsum("nij,nj->ni", matrices, v), turned, atol=1e-14)


def test_section_axes_are_half_a_turn_from_the_body_axes():
    at_rest = np.array([0.0, 0.0, 0.0, 1.0])
    for section, world in (((1, 0, 0), (-1, 0, 0)), ((0, 1, 0), (0, -1, 0)), ((0, 0, 1), (0, 0, 1))):
        np.testing.assert_array_equal(world_from_section(at_rest, np.array(section)), world)
    left = about_z(np.array(np.pi / 2))  # nose to +y, so the tail is at -y
    np.testing.assert_allclose(world_from_section(left, np.array([1.0, 0, 0])), (0, -1, 0), atol=1e-15)


def test_the_line_between_stations_converges_at_fourth_order():
    target = np.linspace(0.0, 1.0, 97)
    errors = []
    for stations in (11, 21, 41):
        x, position, orientation, line = circle(stations)
        points, _ = Resampling(x, target).centre_line(position, orientation)
        errors.append(np.abs(points - line(target)).max())
    slopes = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(slopes, 4.0, atol=0.2)


def test_the_line_passes_through_the_stations():
    x, position, orientation, _ = circle(7)
    points, axes = Resampling(x, x).centre_line(position, orientation)
    np.testing.assert_allclose(points, position, atol=1e-15)
    np.testing.assert_allclose(axes[:, :, 0], world_from_section(orientation, np.array([1.0, 0, 0])), atol=1e-14)
    np.testing.assert_allclose(np.linalg.det(axes), 1.0, atol=1e-14)


@pytest.fixture
def skin():
    body = made_up.body(201)
    return Skin(body["x"], body["half_width"], body["half_height"])


def straight(stations=51):
    x = np.linspace(0.0, 1.0, stations)
    position = np.stack([-x, 0 * x, 0 * x], axis=1)
    return x, position, about_z(0 * x)


def test_every_ring_is_the_body_s_ellipse(skin):
    vertices, _ = skin.place(*straight())
    rings = vertices.reshape(len(skin.x), -1, 3)
    np.testing.assert_allclose(rings[:, :, 0], -np.broadcast_to(skin.x[:, None], rings.shape[:2]), atol=1e-7)
    given, exact = made_up.body(201), made_up.body(100_001)
    blunt = 1.0 - float(given["half_height"][-1])  # from here on the tail is rounded
    for k, x in enumerate(skin.x[skin.x < blunt][1:], start=1):
        # 1e-5 of the squares between the given points; 3 % of the true ones, where 5 mm are coarse for the nose
        for body, tolerance in ((given, 1e-5), (exact, 3e-2)):
            b2, a2 = (np.interp(x, body["x"], body[name] ** 2) for name in ("half_width", "half_height"))
            np.testing.assert_allclose(rings[k, :, 1] ** 2 / b2 + rings[k, :, 2] ** 2 / a2, 1.0, rtol=tolerance)
    assert np.abs(rings[:, :, 2]).max() == pytest.approx(0.05, rel=1e-2)
    np.testing.assert_array_equal(rings[0], 0.0)


def test_the_tail_is_rounded_within_the_body_and_closed_in_a_point(skin):
    rings = skin.place(*straight())[0].reshape(len(skin.x), -1, 3)
    given = made_up.body(201)
    for k, x in enumerate(skin.x):
        for axis, name in ((1, "half_width"), (2, "half_height")):
            assert np.abs(rings[k, :, axis]).max() <= np.sqrt(np.interp(x, given["x"], given[name] ** 2)) + 1e-5
    height = float(given["half_height"][-1])
    rounded = skin.x > 1.0 - height
    assert rounded.sum() >= 3
    expected = height * np.sqrt(1.0 - ((skin.x[rounded] - 1.0) / height + 1.0) ** 2)  # a half circle from the side
    np.testing.assert_allclose(np.abs(rings[rounded, :, 2]).max(axis=1), expected, atol=2e-3 * height)
    np.testing.assert_allclose(rings[-1], np.broadcast_to((-1.0, 0.0, 0.0), rings[-1].shape), atol=1e-7)


def test_the_eyes_lie_in_the_skin_at_the_head_and_nowhere_beyond_the_widest_section(skin):
    given = made_up.body(201)
    assert np.all(skin.eyes[:, 0] < 0.0) and np.all(skin.eyes[:, 0] > -0.05) and np.all(skin.eyes[:, 2] > 0.0)
    np.testing.assert_allclose(skin.eyes[:2] * (1, -1, 1), skin.eyes[2:])
    b2, a2 = (np.interp(-skin.eyes[0, 0], given["x"], given[name] ** 2) for name in ("half_width", "half_height"))
    assert skin.eyes[0, 1] ** 2 / b2 + skin.eyes[0, 2] ** 2 / a2 < 1.0
    reach = np.abs(skin.eyes[:, 1]) + skin.eye_sizes[:, 1]
    assert np.all(reach > np.sqrt(b2 * (1 - skin.eyes[0, 2] ** 2 / a2))) and reach.max() <= given["half_width"].max()


def test_the_mesh_is_closed_and_faces_outwards(skin):
    x, position, orientation, _ = circle(51)
    vertices, _ = skin.place(x, position, orientation)
    triangles = skin.triangles.astype(int)
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    directed = {tuple(edge) for edge in edges}
    sides = len(vertices) // len(skin.x)
    ends = set(range(sides)), set(range(len(vertices) - sides, len(vertices)))  # points: their edges have no length
    open_edges = [edge for edge in directed if edge[::-1] not in directed and not any(set(edge) <= end for end in ends)]
    assert open_edges == []
    a, b, c = (vertices[triangles[:, k]].astype(float) for k in range(3))
    volume = np.einsum("ni,ni->n", a, np.cross(b, c)).sum() / 6
    body = made_up.body(2001)
    exact = np.trapezoid(np.pi * body["half_width"] * body["half_height"], body["x"])
    assert volume == pytest.approx(exact, rel=0.06)  # a twelve-sided section has 0.955 of its ellipse


def test_normals_are_those_of_the_surface(skin):
    vertices, normals = skin.place(*straight())
    sides = len(vertices) // len(skin.x)
    points, normals = (array.reshape(len(skin.x), sides, 3).astype(float) for array in (vertices, normals))
    np.testing.assert_allclose(np.linalg.norm(normals, axis=2), 1.0, atol=1e-6)
    np.testing.assert_allclose(normals[0], np.broadcast_to((1.0, 0.0, 0.0), (sides, 3)), atol=1e-6)
    along = points[2:] - points[:-2]
    around = np.roll(points, -1, axis=1) - np.roll(points, 1, axis=1)
    for tangent, normal in ((along[2:-1], normals[3:-2]), (around[3:-2], normals[3:-2])):
        cosine = np.einsum("rsi,rsi->rs", tangent, normal) / np.linalg.norm(tangent, axis=2)
        assert np.abs(cosine).max() < 0.05


def test_a_value_for_each_vertex(skin):
    x = np.linspace(0.0, 1.0, 51)
    spread = skin.at_vertices(x, 3.0 * x).reshape(len(skin.x), -1)
    np.testing.assert_allclose(spread, np.broadcast_to(3.0 * skin.x[:, None], spread.shape), atol=1e-14)


def test_the_mesh_stays_when_the_number_of_stations_changes(skin):
    shapes = {skin.place(*straight(stations))[0].shape for stations in (5, 51, 200)}
    assert len(shapes) == 1


def test_the_camera_s_target_is_the_middle_of_the_picture_and_right_is_right():
    np.testing.assert_allclose(camera.in_picture(np.zeros(3)), (0.0, 0.0), atol=1e-15)
    np.testing.assert_allclose(camera.in_picture(camera.before_eye(2.0, 0.4, -0.6)), (0.2, -0.3), atol=1e-14)
    ahead, up = camera.in_picture(np.array([(0.1, 0.0, 0.0), (0.0, 0.0, 0.1)]))
    assert ahead[0] > 0  # swimming to +x is to the right
    assert up[1] > 0
    assert abs(up[0]) < 1e-15


def test_the_least_radius_brings_the_last_point_to_the_edge_of_the_clear_part():
    edges = camera.CLEAR
    for point, axis, edge in (
        ((3.0, -2.0, 0.1), 0, edges["right"]),
        ((0.1, 0.1, 1.0), 1, edges["up"]),
        ((0.1, 0.1, -1.0), 1, -edges["down"]),
    ):
        points = np.array([point, (0.0, 0.1, 0.0)])
        seen = camera.in_picture(points / camera.least_radius(points))
        np.testing.assert_allclose(seen[0, axis], edge, rtol=1e-12)


def test_back_and_belly_differ_and_both_sides_are_alike(skin):
    shades = skin.shades.reshape(len(skin.x), -1, 3).astype(int)
    quarter = shades.shape[1] // 4
    back, belly = shades[:, quarter], shades[:, 3 * quarter]
    assert np.all(belly - back > 100)
    np.testing.assert_array_equal(shades[:, 0], shades[:, 2 * quarter])


def test_a_torque_colours_the_flanks_alone(skin):
    x = np.linspace(0.0, 1.0, 51)
    shades = skin.coloured(x, x - 0.5, 0.5).reshape(len(skin.x), -1, 3)
    bare = skin.shades.reshape(shades.shape)
    quarter = shades.shape[1] // 4
    for angle in (quarter, 3 * quarter):  # back and belly
        np.testing.assert_array_equal(shades[:, angle], bare[:, angle])
    for angle in (0, 2 * quarter):
        np.testing.assert_array_equal(shades[:, angle], colours.diverging(skin.x - 0.5, 0.5))


def test_the_camera_has_no_lag_behind_a_steady_motion_and_leaves_the_wiggle():
    from eel_viz.scene3d.camera import FollowFilter

    steady, speed, sway = FollowFilter(), np.array([0.5, 0.1, -0.2]), np.array([0.0, 0.05, 0.0])
    behind, moved = [], []
    for k in range(1000):
        t = k * 0.04
        target = speed * t + sway * np.sin(2 * np.pi * t)
        place = steady.follow(round(t * 1e9), target)
        if t > 20.0:
            behind.append(place - speed * t)
            moved.append(target - speed * t)
    # a target that stands still between two calls is 0.04 s old at most
    assert np.abs(np.mean(behind, axis=0)).max() < 0.04 * np.linalg.norm(speed)
    assert np.ptp(behind, axis=0)[1] < 0.3 * np.ptp(moved, axis=0)[1]


def test_the_camera_goes_straight_to_a_swimmer_that_was_away():
    from eel_viz.scene3d.camera import FollowFilter

    steady = FollowFilter()
    np.testing.assert_array_equal(steady.follow(0, np.ones(3)), np.ones(3))
    assert np.linalg.norm(steady.follow(40_000_000, np.zeros(3))) > 1.5
    np.testing.assert_array_equal(steady.follow(10**10, np.array([5.0, 0.0, 0.0])), [5.0, 0.0, 0.0])
