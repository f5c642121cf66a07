# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""All that the overlay asks the GPU for, kept as text, in the order of its calls; tests/window looks at the pixels.

Of arrays there are their shapes and two sums, one of them with weights; batches have numbers, so that one is seen to be
drawn again.
"""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from mathutils import Matrix

from tests.blender.actions.setup.test_remedy_buttons import boxes
from tests.blender.actions.test_stability import wedge
from tests.blender.bodies.test_assembly import box_mesh
from tests.blender.objects import add, only, strip_mesh
from tests.blender.panels.drawing import Context

pytestmark = pytest.mark.usefixtures("scene")
VIEW = Matrix.LocRotScale((0.5, -1.0, -20.0), Matrix.Rotation(0.7, 3, (1.0, 2.0, 3.0)), None)
PERSPECTIVE = Matrix(((2.0, 0, 0, 0), (0, 3.0, 0, 0), (0, 0, -1.2, -2.4), (0, 0, -1, 0)))


class Gpu:
    """Stands for the modules `gpu` and `gpu.state`; writes calls down."""

    def __init__(self):
        self.lines, self.made = [], 0
        self.view, self.projection, self.size = VIEW, PERSPECTIVE, (0, 0, 640, 480)
        self.matrix = SimpleNamespace(
            get_model_view_matrix=lambda: self.view.copy(), get_projection_matrix=lambda: self.projection.copy()
        )
        self.values = {"blend": "NONE", "depth_test": "ALWAYS", "depth_mask": True}
        self.state, self.shaders = SimpleNamespace(viewport_get=lambda: self.size), {}
        for name in self.values:
            setattr(self.state, name + "_get", lambda name=name: self.values[name])
            setattr(self.state, name + "_set", lambda value, name=name: self.set(name, value))
        self.shader = SimpleNamespace(from_builtin=self.from_builtin)

    def set(self, name, value):
        self.values[name] = value
        self.lines.append("{:s} = {!r}".format(name, value))

    def from_builtin(self, name):
        if name not in self.shaders:
            self.shaders[name] = SimpleNamespace(
                name=name,
                bind=lambda: self.lines.append("bind " + name),
                uniform_float=lambda key, value: self.lines.append("{} = {}".format(key, rounded(value))),
            )
        return self.shaders[name]

    def batch_for_shader(self, shader, kind, content, indices=None):
        self.made += 1
        label = "batch {:d}".format(self.made)
        self.lines.append("{:s}: {:s} of {:s}".format(label, kind, shader.name))
        for key, values in [*content.items(), *([] if indices is None else [("indices", indices)])]:
            assert values.dtype == (np.int32 if key == "indices" else np.float32)  # as the GPU takes them
            self.lines.append("    {:s} {} {}".format(key, values.shape, sums(values)))
        draw = lambda shader: self.lines.append("draw {:s} with {:s}".format(label, shader.name))  # noqa: E731
        return SimpleNamespace(draw=draw)

    def taken(self):
        lines, self.lines = self.lines, []
        return "\n".join(lines)


def sums(values):
    """The sum, and that with weights between 0 and 1 that follow no rule which a shape may have."""
    flat = values.astype(float).ravel()
    return rounded([flat.sum(), flat @ (np.arange(1.0, len(flat) + 1.0) * (np.sqrt(1.25) - 0.5) % 1.0)])


def rounded(values):
    return " ".join("{:.6g}".format(round(value, 4) + 0.0) for value in np.ravel(values).tolist())


@pytest.fixture
def gpu(monkeypatch):
    from body_moments.panels.overlay import draw

    areas = [area for screen in bpy.data.screens for area in screen.areas if area.type == "VIEW_3D"]
    area = next(area for area in areas if area.spaces.active.overlay.show_overlays)
    region = next(region for region in area.regions if region.type == "WINDOW")
    made = Gpu()
    made.context = Context(space_data=area.spaces.active, region=region, selected_pose_bones=None)
    monkeypatch.setattr(draw, "bpy", SimpleNamespace(context=made.context, app=bpy.app, types=bpy.types))
    monkeypatch.setattr(draw, "gpu", made)
    monkeypatch.setattr(draw, "batch_for_shader", made.batch_for_shader)
    yield made
    draw._state.regions.clear()


@pytest.fixture
def frame(gpu, kept, request):
    from body_moments.panels.overlay import draw

    pages = []

    def drawn(title):
        bpy.context.view_layer.update()
        draw.draw()
        pages.append("=== {:s}\n{:s}\n".format(title, gpu.taken()))

    yield drawn
    kept(request.node.name.removeprefix("test_") + ".txt", "\n".join(pages))


def overlay():
    return bpy.context.scene.body_moments.overlay


def measure(*objects):
    for obj in objects:
        only(obj)
        bpy.ops.object.body_moments_measure()


def test_looks(kept):
    """Colors and sizes, and the shapes of constant size that are made of them."""
    from body_moments.panels.overlay import appearance, details, glyphs, lines, solids

    text = []
    for module in (appearance, details, glyphs, lines, solids):
        for name, value in vars(module).items():
            if name.isupper() and not callable(value):
                value = np.round(value, 4).tolist() if isinstance(value, np.ndarray) else value
                text.append("{:s} = {!r}".format(name, value))
    for made in (glyphs.discs(), glyphs.digits()):
        for part in (made.corners, made.colors, made.triangles):
            for shape in np.moveaxis(part, 1, 0) if part.ndim == 4 else part:
                text.append("{} {}".format(shape.shape, sums(shape)))
    kept("looks.txt", "\n".join(text))


def test_overlay_of_a_body(frame, gpu):
    obj = add(box_mesh(1, 2, 4), location=(1, 2, 3), rotation=(0.3, 0.2, 0.1))
    frame("Not measured")
    measure(obj)
    frame("Measured")
    frame("Nothing has changed")
    gpu.view = VIEW @ Matrix.Rotation(0.5, 4, "Z")
    frame("The view has turned")
    gpu.size = (0, 0, 800, 480)
    frame("A wider view")
    gpu.context.preferences.system.ui_scale = 2.0
    frame("High resolution")
    gpu.context.preferences.system.ui_scale = 1.0
    for name in ("show_axes", "show_drop_line"):
        setattr(overlay(), name, False)
        frame("Without " + name)
    for equivalent in ("BOX", "ELLIPSOID"):
        overlay().equivalent = equivalent
        frame(equivalent)
    bpy.ops.object.select_all(action="DESELECT")
    frame("Not selected")
    overlay().show_all = True
    frame("All objects")
    obj.location.x = 1e6
    frame("Out of view")
    obj.hide_set(True)
    frame("Hidden")
    obj.hide_set(False)
    overlay().show = False
    frame("Switched off")
    overlay().show, gpu.context.space_data.overlay.show_overlays = True, False
    frame("Without overlays")
    gpu.context.space_data.overlay.show_overlays = True
    gpu.context.__dict__["space_data"] = None
    frame("Without a space")


def test_overlay_of_many(frame):
    exact, capped, doubtful, stale = (
        add(mesh, name, location=(4.0 * place, 0, 0))
        for place, (name, mesh) in enumerate(
            (
                ("Exact", box_mesh(1, 2, 4)),
                ("Repaired", boxes(2.0, reverse=[0])),
                ("Doubtful", strip_mesh()),
                ("Stale", box_mesh(1, 1, 3)),
            )
        )
    )
    measure(exact, capped, doubtful, stale)
    stale.body_moments.density = 5.0
    only(exact, capped, doubtful, stale)
    frame("A body of each verdict")
    overlay().show_sum = True
    frame("And their sum")
    only(exact)
    frame("The sum of one")
    overlay().show_sum = False
    only(exact, capped, stale)
    frame("Three")
    exact.location.z = 1.0
    frame("One has moved")
    exact.location.z = 2.0
    frame("It moves on")
    capped.location.z = 2.0
    frame("Another one moves")
    only(exact, capped)
    frame("Two")


def test_overlay_of_details(frame):
    faulty, leaning = add(boxes(2.0, reverse=[0, 3])), add(wedge(), "Leaning", location=(5, 0, 0))
    measure(faulty, leaning)
    only(faulty, leaning)
    bpy.ops.object.body_moments_stability()
    frame("Support polygons")
    overlay().show_faults = True
    frame("And faults")
    overlay().show_support = False
    frame("Faults alone")
    overlay().show_faults = overlay().show_axes = overlay().show_drop_line = False
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, 4
    only(leaning)
    for at in (1, 4):
        leaning.location.x = float(at)
        leaning.keyframe_insert("location", frame=at)
    bpy.ops.object.body_moments_balance_group()
    bpy.ops.object.select_all(action="DESELECT")
    frame("A path")
    overlay().show_support = True
    frame("And its support polygon")
    leaning.rotation_euler.y = -np.pi / 2
    only(leaning)
    bpy.ops.object.body_moments_balance_group()
    frame("The path of one that stands")
    scene.frame_set(9)
    frame("At a frame that is not of the path")
    overlay().show_support = False
    scene.frame_set(1)
    frame("Without its support polygon")
    (shown,) = (obj for obj in scene.objects if obj.type == "EMPTY")
    shown.hide_set(True)
    frame("Of one that is hidden")
    overlay().show_path = False
    frame("Without it")


def test_overlay_of_bones(frame, gpu):
    from tests.blender.actions.rig.test_rig import character

    armature, _ = character()
    bpy.ops.object.body_moments_measure_bones()
    gpu.context.__dict__["selected_pose_bones"] = list(armature.pose.bones)[:2]
    frame("An armature and two bones")
    armature.location.x = 1.0
    frame("Moved")
    gpu.context.__dict__["selected_pose_bones"] = list(armature.pose.bones)[1:2]
    frame("One bone")


def test_overlay_of_live_numbers(frame):
    """What is not measured and has no numbers is not drawn; an armature in Pose Mode stands for its meshes."""
    from tests.blender.session.test_live import armature_with, with_key

    plain, body = add(box_mesh(1, 2, 4), "Plain"), with_key()
    only(plain, body)
    frame("Not measured")
    only(body)
    bpy.ops.object.body_moments_live()
    only(plain, body)
    frame("Live")
    bpy.context.scene.frame_set(6)
    frame("Deformed")
    only(body)
    bpy.ops.object.body_moments_live()
    frame("Live no more")
    meshes = [add(box_mesh(1, 2, 4), "A"), add(box_mesh(1, 1, 3), "B", (4, 0, 0))]
    armature = armature_with(*meshes)
    measure(*meshes)
    only(armature)
    frame("An armature")
    bpy.ops.object.mode_set(mode="POSE")
    frame("In Pose Mode")
    armature.pose.bones["Bone"].location = (0.0, 1.0, 0.0)
    frame("Posed")
    bpy.ops.object.mode_set(mode="OBJECT")


def test_overlay_in_regions(frame, gpu):
    from body_moments.panels.overlay import draw

    measure(add(box_mesh(1, 2, 4)))
    regions = [SimpleNamespace(as_pointer=lambda number=number: number) for number in range(draw.MAX_REGIONS + 1)]
    for number in (*range(draw.MAX_REGIONS), 0, draw.MAX_REGIONS, 1, 0):
        gpu.context.__dict__["region"] = regions[number]
        frame("Region {:d}".format(number))


def test_the_state_of_the_gpu_is_put_back_whatever_happens(gpu, monkeypatch):
    from body_moments.panels.overlay import draw

    before = dict(gpu.values)
    measure(add(box_mesh(1, 2, 4)))
    bpy.context.view_layer.update()
    draw.draw()
    assert gpu.values == before and any(line.startswith("draw") for line in gpu.lines)
    monkeypatch.setattr(draw, "_draw_batch", lambda *_: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        draw.draw()
    assert gpu.values == before


@pytest.fixture
def windows(gpu, monkeypatch):
    """A window with a 3D Viewport beside something else; what is told to it."""
    from body_moments.panels.overlay import draw

    told = []
    areas = [SimpleNamespace(type=kind, tag_redraw=lambda kind=kind: told.append(kind)) for kind in ("VIEW_3D", "INFO")]
    manager = SimpleNamespace(windows=[SimpleNamespace(screen=SimpleNamespace(areas=areas))])
    gpu.context.__dict__["window_manager"] = manager
    told_to_space = SimpleNamespace(
        draw_handler_add=lambda *given: told.append(given) or "handle",
        draw_handler_remove=lambda *given: told.append(given),
    )
    monkeypatch.setattr(draw, "SpaceView3D", told_to_space)
    app = SimpleNamespace(background=False)
    monkeypatch.setattr(draw, "bpy", SimpleNamespace(context=gpu.context, app=app))
    return told, app


def test_the_overlay_is_drawn_from_registering_to_unregistering_in_windows_alone(windows, gpu):
    from body_moments.panels.overlay import draw

    told, app = windows
    draw.register()
    assert told == [(draw.draw, (), "WINDOW", "POST_VIEW"), "VIEW_3D"]
    measure(add(box_mesh(1, 2, 4)))
    draw.draw()
    assert draw._state.regions
    told.clear()
    draw.unregister()
    assert told == [("handle", "WINDOW"), "VIEW_3D"] and not draw._state.regions
    told.clear()
    draw.unregister()
    app.background = True
    draw.register()
    draw.unregister()
    assert told == [] and draw._state.handle is None
