# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Make Colliders by its button: progress and Esc, undo and redo, what the panel and the redo panel
show.
"""

from tests.window.conftest import OPEN
from tests.window.harness import CLOSE_OTHERS

CHAIR = """
import bpy
for obj in list(bpy.data.objects):
    bpy.data.objects.remove(obj)
boxes = [((0, 0, 1), (1, 1, 0.1)), ((0, 0.9, 2), (1, 0.1, 1))]
boxes += [((x, y, 0.45), (0.1, 0.1, 0.45)) for x in (-0.9, 0.9) for y in (-0.9, 0.9)]
points, faces = [], []
for (x, y, z), (a, b, c) in boxes:
    n = len(points)
    points += [(x + i * a, y + j * b, z + k * c) for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]
    faces += [[n + i for i in side] for side in
              ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))]
mesh = bpy.data.meshes.new("Chair")
mesh.from_pydata(points, [], faces)
for number in range(PARTS):
    obj = bpy.data.objects.new("Chair", mesh if number == 0 else mesh.copy())
    obj.location.x = 3 * number
    bpy.context.collection.objects.link(obj)
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
bpy.ops.view3d.view_selected()
bpy.ops.ed.undo_push(message="Chairs")
"""
MAKE = "object.body_moments_make_colliders"
ROW = 22  # pixels between two buttons
COUNT = "sum('body_collider' in obj for obj in bpy.data.objects)"
RUNNING = (
    "[op.bl_idname for op in window.modal_operators if 'body_moments' in op.bl_idname.lower()]"
)


def chairs(window, count):
    window.ask("PARTS = {}\n{}".format(count, CHAIR))


def test_button_makes_colliders_that_undo_removes(window):
    chairs(window, 1)
    window.ask(OPEN + CLOSE_OTHERS)
    window.open_tab("Moments")
    window.ask("bpy.ops.object.body_moments_measure()")
    window.press("object.body_moments_make_colliders")
    window.wait(COUNT + " > 0")
    assert window.get("bpy.context.mode") == "OBJECT" and window.get(
        "[o.name for o in bpy.context.selected_objects]"
    ) == ["Chair"]
    made = window.get(COUNT)
    window.ask("area.spaces.active.show_region_hud = True")
    window.point_at_view()
    window.key("F9")
    window.picture("colliders redo panel")
    window.key("Escape")
    window.picture("colliders")
    window.key("ctrl+z")
    window.wait(COUNT + " == 0")
    assert window.get("'body_colliders' in bpy.context.object") is False
    window.key("ctrl+shift+z")
    window.wait("{} == {}".format(COUNT, made))
    window.press("object.body_moments_remove_colliders")
    window.wait(COUNT + " == 0")


def test_buttons_of_colliders_stay_and_choose_another_shape(window):
    chairs(window, 1)
    window.press(MAKE)
    window.wait(COUNT + " > 0")
    window.redraw()
    window.buttons.clear()
    before = window.middle(MAKE)
    x, y = before[0], before[1] - ROW  # the menu of shapes

    def steps_to_corrections():
        below = [window.button_at(x + 60, y - ROW - down) for down in range(0, 2 * ROW, 4)]
        return below.index(MAKE)  # of Vertices, under the label Correct

    steps = steps_to_corrections()
    window.click(x, y)
    window.redraw()
    window.picture("colliders shapes")
    window.key("b")  # Box
    window.wait("bpy.context.object['body_colliders']['shape'] == 'box'")
    assert window.get("[o['body_collider']['kind'] for o in bpy.context.object.children]") == [
        "box"
    ]
    window.ask("bpy.context.object.scale.x = 2.0\nbpy.context.view_layer.update()")
    window.redraw()
    window.picture("colliders out of date")
    window.buttons.clear()
    after = window.middle(MAKE)
    assert abs(after[1] - before[1]) <= 3
    assert abs(steps_to_corrections() - steps) <= 1


def test_esc_leaves_nothing_behind(window):
    chairs(window, 3000)
    before = window.get("[len(bpy.data.objects), len(bpy.data.meshes), len(bpy.data.collections)]")
    window.ask("bpy.ops.object.body_moments_make_colliders('INVOKE_DEFAULT', shape='HULL')")
    window.wait(RUNNING)
    window.point_at_view()
    window.picture("colliders running")
    window.key("Escape")
    window.wait("not " + RUNNING)
    assert (
        window.get("[len(bpy.data.objects), len(bpy.data.meshes), len(bpy.data.collections)]")
        == before
    )
