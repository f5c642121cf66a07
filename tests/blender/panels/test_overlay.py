# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the overlay draws, as arrays: where it is, how large, in which form. tests/window looks at its pixels."""

from dataclasses import replace

import bpy
import numpy as np
import pytest

from tests.blender import objects
from tests.close import close


@pytest.fixture
def view(registered):
    """A perspective of 60° from (3, -4, 5) at an odd size, rolled."""
    from body_moments.panels.overlay.view import View

    rotation = np.linalg.qr(np.random.default_rng(3).standard_normal((3, 3)))[0]
    rotation *= np.sign(np.linalg.det(rotation))
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rotation, -rotation @ (3.0, -4.0, 5.0)
    near, far, width, height = 0.1, 100.0, 641.0, 357.0
    slope = np.tan(np.radians(30.0))
    projection = np.diag([1.0 / slope, width / height / slope, -(far + near) / (far - near), 0.0])
    projection[2, 3], projection[3, 2] = -2.0 * far * near / (far - near), -1.0
    return View(matrix, projection, np.array([width, height]))


def in_front(view, count=5):
    """(count, 3) points that the view shows."""
    random = np.random.default_rng(5)
    seen = np.stack([*(random.uniform(-0.4, 0.4, (2, count)) * 8.0), -random.uniform(6.0, 12.0, count)], axis=1)
    return (seen - view.view[:3, 3]) @ view.view[:3, :3]


def test_shapes_have_their_size_in_pixels_wherever_they_are(view):
    anchors = in_front(view)
    offsets = np.random.default_rng(7).uniform(-20.0, 20.0, (len(anchors), 6, 2))
    placed = view.place(anchors, offsets)
    on_screen = view.pixels(placed.reshape(-1, 3)).reshape(offsets.shape)
    assert close(on_screen - view.pixels(anchors)[:, None], offsets, 1e-9)
    assert close(
        view.depths(placed.reshape(-1, 3)).reshape(-1, 6), view.depths(anchors)[:, None].repeat(6, axis=1), 1e-12
    )


def test_an_equal_box_has_the_inertia_of_the_body(registered):
    from body_moments.panels.overlay import solids

    sides = np.array([1.0, 2.0, 5.0])
    inertia = (sides @ sides - sides**2) / 12.0  # of a box of mass 1
    centers, axes = np.array([[10.0, 20.0, 30.0]]), np.eye(3)[None]
    corners = solids.box_lines(centers, axes, np.sqrt(inertia)[None]).reshape(-1, 3)
    assert close(np.ptp(corners, axis=0), sides, 1e-12)
    assert close(corners.mean(axis=0), centers[0], 1e-12)


def test_an_equal_ellipsoid_has_the_inertia_of_the_body(registered):
    from body_moments.panels.overlay import solids

    half = np.array([1.0, 2.0, 5.0])
    inertia = (half @ half - half**2) / 5.0
    turn = np.linalg.qr(np.random.default_rng(1).standard_normal((3, 3)))[0]
    points = solids.ellipsoid_lines(np.zeros((1, 3)), turn[None], np.sqrt(inertia)[None]).reshape(-1, 3)
    assert close(((points @ turn / half) ** 2).sum(axis=1), 1.0, 1e-12)
    assert close(np.abs(points @ turn).max(axis=0), half, 1e-12)


def test_axes_are_as_long_as_the_radii_of_gyration(registered):
    from body_moments.panels.overlay import solids

    gyration = np.array([[1.0, 2.0, 3.0]])
    turn = np.linalg.qr(np.random.default_rng(2).standard_normal((3, 3)))[0]
    segments = solids.axis_lines(np.ones((1, 3)), turn[None], gyration)[0]
    assert close(segments.mean(axis=1), 1.0, 1e-12)
    assert close(segments[:, 1] - segments[:, 0], 2.0 * (turn * gyration).T, 1e-12)


def test_verdicts_differ_in_form_where_colors_are_not_seen(registered):
    from body_moments.panels.overlay import appearance, glyphs

    discs = glyphs.discs()
    forms = [np.round(shape, 3).tobytes() for shape in discs.corners]
    assert len(set(forms)) == len(appearance.VERDICTS)
    for verdict, color in enumerate(appearance.COLORS):
        assert (discs.colors[:, verdict] == color).all(axis=2).any(axis=1).all()


def test_the_body_is_drawn_where_it_is_in_the_world(scene):
    from body_moments.operators.session.shown import shown_body

    scene.unit_settings.scale_length = 0.001
    obj = objects.add(objects.mesh_body(), location=(7, -3, 2), rotation=(0.3, 1.1, -0.4), scale=(2, 2, 2))
    bpy.ops.object.body_moments_measure()
    measurement = objects.measured(obj)
    body = shown_body(obj)
    assert close(body.center, measurement.mass_properties.center / 0.001, 1e-6)
    assert close(body.gyration, measurement.mass_properties.radii_of_gyration / 0.001, 1e-6)
    assert close(np.abs((body.axes * measurement.mass_properties.principal.axes).sum(axis=0)), 1.0, 1e-6)
    assert body.verdict == "exact"


def test_what_is_not_measured_is_not_drawn(scene):
    from body_moments.operators.session.shown import shown_body

    assert shown_body(objects.add(objects.mesh_body())) is None


def test_an_open_body_is_doubtful_and_an_edited_one_out_of_date(scene):
    from body_moments.operators.session.shown import shown_body

    strip = objects.add(objects.strip_mesh())
    bpy.ops.object.body_moments_measure()
    assert shown_body(strip) is None or shown_body(strip).verdict == "doubtful"
    body = objects.add(objects.mesh_body())
    bpy.ops.object.body_moments_measure()
    body.data.vertices[0].co.z -= 0.5
    body.data.update()
    bpy.context.view_layer.update()
    assert shown_body(body).verdict == "out of date"


def test_nothing_is_registered_to_draw_in_background_mode(registered):
    from body_moments.panels.overlay import draw

    assert bpy.app.background and draw._state.handle is None


def test_discs_are_made_where_they_are_seen_and_named_where_axes_are_long(view):
    from body_moments.panels.overlay.bodies import Bodies
    from body_moments.panels.overlay.glyphs import digits, discs
    from body_moments.panels.overlay.lines import disc_triangles

    places = np.array([(0.0, 0.0, -8.0), (1.0, 1.0, -8.0), (-1.0, 0.5, -7.0), (0.0, 0.0, 8.0), (50.0, 0.0, -8.0)])
    centers = (places - view.view[:3, 3]) @ view.view[:3, :3]  # three before the eye, one behind it, one beside
    axes, verdicts = np.tile(np.eye(3), (5, 1, 1)), np.zeros(5, np.intp)
    short, long = (
        disc_triangles(Bodies(centers, axes, np.full((5, 3), gyration), verdicts), view, 1.0, True)
        for gyration in (1e-3, 1.0)
    )
    disc, digit = discs().corners.shape[1], digits().corners.shape[1]
    assert len(short[0]) == short[1].shape[1] == 3 * disc
    assert len(long[0]) == 3 * (disc + 3 * digit)
    for points, _, triangles in (short, long):
        assert triangles.dtype == np.int32 and points.dtype == np.float32  # as the GPU takes them
        assert triangles.min() == 0 and triangles.max() < len(points)
        assert np.isfinite(points).all()
        assert np.abs(view.pixels(points.astype(float)) - view.size / 2.0).max() < view.size.max() + 500.0


@pytest.mark.parametrize("scale", [1.0, 2.0])
def test_discs_are_made_up_to_a_margin_around_the_view_and_named_from_a_length_on(view, scale):
    """Both in pixels of the screen; a body that reaches farther is made farther away too."""
    from body_moments.panels.overlay.bodies import Bodies
    from body_moments.panels.overlay.glyphs import digits, discs
    from body_moments.panels.overlay.lines import MARGIN, MIN_NAMED, disc_triangles

    view = replace(view, view=np.eye(4))
    pixel = view.pixel_sizes(np.array([[0.0, 0.0, -8.0]]))[0]  # the view's middle is in the middle

    def count(away, reach):
        center = np.array([[(view.size[0] / 2.0 + away) * pixel[0], 0.0, -8.0]])
        gyration = np.full((1, 3), reach * pixel.max())
        body = Bodies(center, np.eye(3)[None], gyration, np.zeros(1, np.intp))
        return len(disc_triangles(body, view, scale, True)[0])

    disc = discs().corners.shape[1]
    for reach, named in ((0.0, 0), (scale * MIN_NAMED - 0.1, 0), (scale * MIN_NAMED + 0.1, 3), (300.0, 3)):
        wanted = disc + named * digits().corners.shape[1]
        edge = reach + scale * MARGIN
        assert [count(away, reach) for away in (-100.0, edge - 0.1, edge + 0.1)] == [wanted, wanted, 0]


def test_each_disc_is_that_of_its_body_alone_the_named_ones_last(view):
    """The nearest of each kind above the others, and of those that are as far away the last one."""
    from body_moments.panels.overlay.bodies import Bodies
    from body_moments.panels.overlay.lines import disc_triangles

    count = 40
    number = np.arange(count)
    places = np.stack([np.linspace(-1.0, 1.0, count), np.linspace(0.5, -0.5, count), -8.0 + number % 2], axis=1)
    view = replace(view, view=np.eye(4))
    is_named = number % 3 == 0
    gyration = np.where(is_named, 1.0, 1e-3)[:, None].repeat(3, axis=1)
    bodies = Bodies(places, np.tile(np.eye(3), (count, 1, 1)), gyration, number % 5)
    order = np.lexsort((number, places[:, 2], is_named))
    alone = [disc_triangles(bodies.chosen(np.arange(count) == body), view, 1.0, True) for body in order]
    points, colors, triangles = disc_triangles(bodies, view, 1.0, True)
    starts = np.cumsum([0, *(len(one) for one, _, _ in alone)])
    assert (points == np.concatenate([one for one, _, _ in alone])).all()
    assert (colors == np.concatenate([tints for _, tints, _ in alone], axis=1)).all()
    assert (triangles == np.concatenate([one + start for (_, _, one), start in zip(alone, starts)])).all()


def test_only_what_has_moved_is_looked_at_again(scene, monkeypatch):
    from body_moments.operators.session import handlers
    from body_moments.panels.overlay import bodies

    parts = [objects.add(objects.mesh_body(), name) for name in ("First", "Second", "Third")]
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.body_moments_measure()
    bpy.context.view_layer.update()
    monkeypatch.setattr(bodies, "drawn_objects", lambda *_: parts)  # there is no viewport
    before, generation = bodies.collect(bpy.context), handlers.generation()
    assert len(before.bodies) == len(before.alone) == 3
    parts[1].location, parts[1].rotation_euler = (1.0, -2.0, 3.0), (0.1, 0.2, 0.3)
    bpy.context.view_layer.update()
    moved = handlers.moved_since(generation)
    assert moved == {parts[1].session_uid} and handlers.generation() > generation
    after, whole = bodies.collect_moved(bpy.context, before, moved), bodies.collect(bpy.context)
    assert not after.bodies.differ_from(whole.bodies).any()
    assert after.bodies.differ_from(before.bodies).tolist() == [False, True, False]
    assert before.bodies.differ_from(before.bodies).any() == np.False_
    of_others = [(obj.session_uid, parts[1].name) for obj in parts]  # as linked objects may have
    assert bodies.collect_moved(bpy.context, replace(before, objects=of_others), moved) is not None
    assert bodies.collect_moved(bpy.context, replace(before, objects=of_others), {parts[0].session_uid}) is None
    parts[0].data.vertices[0].co.z -= 0.5
    parts[0].data.update()
    bpy.context.view_layer.update()
    assert handlers.moved_since(generation) is None and handlers.moved_since(handlers.generation()) == set()
    parts[2].body_moments.kind = "SHELL"
    bpy.context.view_layer.update()
    assert handlers.moved_since(generation) is None


def test_what_depends_on_another_object_is_looked_at_again_when_that_moves(scene, monkeypatch, tmp_path):
    from body_moments.operators.session import handlers
    from body_moments.operators.session.trust import Trust
    from body_moments.panels.overlay import bodies
    from body_moments.panels.overlay.appearance import VERDICTS

    from tests.blender.grids import vdb_grid, volume_object

    cloud = volume_object(tmp_path / "a.vdb", vdb_grid(np.ones((6, 6, 6), np.float32), offset=(-1, -1, -1)))
    plain, filled = objects.add(objects.mesh_body(), "Plain", (9, 0, 0)), objects.add(objects.mesh_body(), "Filled")
    filled.body_moments.density_from, filled.body_moments.density_volume = "VOLUME", cloud
    objects.only(plain, filled)
    bpy.ops.object.body_moments_measure()
    bpy.context.view_layer.update()
    monkeypatch.setattr(bodies, "drawn_objects", lambda *_: [plain, filled])  # there is no viewport
    before, generation = bodies.collect(bpy.context), handlers.generation()
    assert before.alone == {plain.session_uid: 0}
    cloud.location.x += 1.0
    bpy.context.view_layer.update()
    moved = handlers.moved_since(generation)
    assert moved == {cloud.session_uid}
    after = bodies.collect_moved(bpy.context, before, moved)
    assert [VERDICTS[verdict] for verdict in after.bodies.verdicts] == [Trust.EXACT, Trust.OUT_OF_DATE]
    assert not after.bodies.differ_from(bodies.collect(bpy.context).bodies).any()
    assert before.bodies.verdicts.tolist() == [0, 0]


@pytest.mark.parametrize("inside", [None, [True, True, False, False, True]])
def test_a_path_is_another_color_where_the_center_leaves_the_support_polygon(inside, registered):
    from body_moments.operators.session.balance_groups import Path
    from body_moments.panels.overlay import appearance as look
    from body_moments.panels.overlay.details import _path

    centers = np.array([[0, 0, 0], [1, 2, 0], [3, 2, 1], [4, 0, 5], [20, 1, 1]], float)
    drawn = _path(Path(np.arange(5.0), centers, None if inside is None else np.array(inside)))
    segments, colors = drawn.segments
    lines, ticks = segments[:4], segments[4:]
    assert (lines[:, 0] == centers[:-1]).all() and (lines[:, 1] == centers[1:]).all()
    assert (ticks[:, 0] == centers).all() and (ticks[:, 1] == centers + [0.0, 0.0, 0.2]).all()
    leaves = [False] * 9 if inside is None else [False, True, True, True, False, False, True, True, False]
    wanted = [look.TIPS if tips else look.PATH for tips in leaves]
    assert (colors == np.array(wanted, np.float32)).all() and len(drawn.triangles[0]) == 0
