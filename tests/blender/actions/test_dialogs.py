# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What operators show and ask before they run, and how they run in a window: dialogs, file browsers, menus, tooltips,
steps, Esc. Kept as text.

Blender makes no operator without running it: what stands in for one has its functions and its settings.
"""

import re
from types import SimpleNamespace

import bpy
import pytest
from body_moments.core.verdict.finding import finding
from body_moments.operators.actions import modal as stepwise
from body_moments.operators.actions.measure import copy

from tests.blender.actions.measure.test_section import I_BEAM, flat_mesh
from tests.blender.actions.scene_state import difference, state
from tests.blender.actions.test_transcripts import (
    MODULES,
    OPERATORS,
    assembly,
    bones,
    computed,
    edited,
    empty_tree,
    moving,
    operator_of,
    parts,
    stable,
    trouble,
    variants,
)
from tests.blender.bodies.test_assembly import box, box_mesh
from tests.blender.objects import add, mesh_body, only
from tests.blender.panels.drawing import Layout

pytestmark = pytest.mark.usefixtures("registered", "scene")
ELSEWHERE = ("fourier_run", "preset_add")  # whose press test_stepwise.py tries, and Blender's own
ROUNDING, DIGEST = r"\d\.\d+e[-−]\d+", r"v1(:[\da-f]+)+"  # and of numbers that have it
TIMER, ESC, MOUSE = (SimpleNamespace(type=name) for name in ("TIMER", "ESC", "MOUSEMOVE"))


class Window:
    """Blender's context with a window that writes down what is asked of it; without one where `is_open` is false."""

    def __init__(self, is_open=True):
        self.said = []
        self.window = self if is_open else None
        self.window_manager = self.workspace = self
        self.screen = SimpleNamespace(areas=[self] if is_open else [])
        self.type, self.spaces = "IMAGE_EDITOR", SimpleNamespace(active=SimpleNamespace(image=None))

    def __getattr__(self, name):
        return getattr(bpy.context, name)

    def say(self, *words):
        self.said.append(" ".join(map(str, words)))

    def event_timer_add(self, seconds, window):
        self.say("timer", seconds, window is self)
        return "timer"

    def event_timer_remove(self, timer):
        self.say("no more", timer)

    def modal_handler_add(self, operator):
        self.say("modal", type(operator).__name__)

    def fileselect_add(self, operator):
        self.say("file browser", type(operator).__name__)

    def invoke_search_popup(self, operator):
        self.say("search popup", type(operator).__name__)

    def invoke_props_dialog(self, operator):
        self.say("dialog", type(operator).__name__)
        return {"RUNNING_MODAL"}

    def progress_begin(self, least, most):
        self.say("progress", least, most)

    def progress_update(self, done):
        self.say("done {:.6g}".format(done))

    def progress_end(self):
        self.say("progress ends")

    def status_text_set(self, text):
        self.say("status", text)

    def tag_redraw(self):
        self.say("drawn again")


def stand_in(cls, report, **settings):
    """Of an operator, with its settings as they start; what it reports goes to `report`."""
    functions = {name: value for name, value in vars(cls).items() if name not in ("__dict__", "__weakref__")}
    bases = tuple(base for base in cls.__bases__ if base is not bpy.types.Operator)
    made = type(cls.__name__, bases, functions)()
    made.report = report
    made.bl_rna, made.layout = operator_of(cls.__name__).get_rna_type(), Layout()
    made.properties = SimpleNamespace(is_property_set=settings.__contains__)
    for prop in made.bl_rna.properties:
        if prop.type == "ENUM" and prop.is_enum_flag:
            setattr(made, prop.identifier, set(prop.default_flag))
        elif prop.type not in ("POINTER", "COLLECTION"):
            setattr(made, prop.identifier, tuple(prop.default_array) if getattr(prop, "is_array", 0) else prop.default)
    vars(made).update(settings)
    return made


def having(name):
    return [key for key in sorted(OPERATORS) if any(name in vars(base) for base in OPERATORS[key].__mro__[:-3])]


DRAWN_IN = {
    "OBJECT_OT_body_moments_rest_on_ground": (parts, stable),
    "OBJECT_OT_body_moments_sculpt_balance": (parts, edited),
}
DRAWN_WITH = {
    "OBJECT_OT_body_moments_rest_on_ground": ({"pose": 0}, {"pose": 6}, {"pose": 7}),
    "OBJECT_OT_body_moments_rigid_bodies": ({"comparison": "Body: 1 kg\nOther: 2 kg"},),
    "OBJECT_OT_body_moments_balance_group": ({"contacts": "Feet", "use_scene_range": False},),
}


@pytest.mark.parametrize("name", having("draw"))
def test_a_dialog(name, kept):
    pages = []
    for build in DRAWN_IN.get(name, (parts,)):
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        build()
        shown = set()
        for options in (*variants(name), *DRAWN_WITH.get(name, ())):
            operator = stand_in(OPERATORS[name], print, **options)
            operator.draw(bpy.context)
            text = operator.layout.text()
            if text not in shown:
                pages += ["=== {:s}: {}".format(build.__name__, options), text]
            shown.add(text)
    kept("dialogs/{:s}.txt".format(name.replace("_body_moments", "")), "\n".join(pages))


def test_menus(kept):
    pages = []
    for module in MODULES:
        functions = {name: value for name, value in vars(module).items() if name == "_menu"}
        classes = [value for value in vars(module).values() if isinstance(value, type)]
        for cls in classes:
            if issubclass(cls, bpy.types.Menu) and cls.__module__ == module.__name__:
                functions[cls.__name__] = cls.draw
        for name, function in functions.items():
            layout = Layout()
            function(SimpleNamespace(layout=layout), bpy.context)
            pages += ["=== {:s}: {:s}".format(module.__name__.rpartition(".")[2], name), layout.text()]
    kept("menus.txt", "\n".join(pages))


def test_tooltips(kept):
    pages = []
    for name in sorted(OPERATORS):
        if "description" in vars(OPERATORS[name]):
            for values in (
                {"value": "1.5", "unit": "kg", "accepted": True},
                {"value": "1.5", "unit": "", "accepted": False},
            ):
                text = OPERATORS[name].description(bpy.context, SimpleNamespace(**values))
                pages += ["=== {:s}: {}".format(name, values), text]
    kept("tooltips.txt", "\n".join(pages))


PATHS = ("", "//", "/folder/", "a", "a.csv", "a.CSV", "a.txt", "a.json", "a.npz", "a.urdf", "folder/a.jsonl", "a.b")


@pytest.mark.parametrize("name", [name for name in having("check") if not name.endswith(ELSEWHERE)])
def test_what_becomes_of_a_path(name, kept):
    lines = []
    for path in PATHS:
        operator = stand_in(OPERATORS[name], print, filepath=path)
        lines.append("{!r}: {} {!r}".format(path, operator.check(bpy.context), operator.filepath))
    kept("paths/{:s}.txt".format(name.replace("_body_moments", "")), "\n".join(lines))


def bodies(count, data=box_mesh):
    only(*(add(data(1, 2, 4), "Box {:d}".format(index), (9 * index, 0, 0)) for index in range(count)))


def four():
    bodies(4)


def five():
    bodies(5)


def none_selected():
    bodies(1)
    bpy.ops.object.select_all(action="DESELECT")


def rigid():
    five()
    for obj in bpy.context.selected_objects[1:]:
        bpy.context.view_layer.objects.active = obj
        bpy.ops.rigidbody.object_add()


def shapes():
    only(*(add(mesh_body(), name, (4 * place, 0, 0), (0, place, 0)) for place, name in enumerate("ab")))


def flat():
    add(bpy.data.meshes.new("Flat"), "a/b").data.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [], [(0, 1, 2)])
    bpy.context.view_layer.update()


def saved(folder):
    def saved_five():
        five()
        bpy.ops.wm.save_as_mainfile(filepath=str(folder / "saved.blend"))

    return saved_five


def many_members():
    assembly()
    root = bpy.context.collection
    for index in range(4):
        box(root, (1, 2, 4), (9 * index, 0, 9), name="more {:d}".format(index))


PRESSED_IN = {
    "OBJECT_OT_body_moments_balance_group": (moving, none_selected),
    "OBJECT_OT_body_moments_find_similar": (shapes,),
    "OBJECT_OT_body_moments_find_symmetry": (shapes,),
    "OBJECT_OT_body_moments_fourier": (parts, flat),
    "OBJECT_OT_body_moments_match_pose": (shapes,),
    "OBJECT_OT_body_moments_measure": (parts, four, five),
    "OBJECT_OT_body_moments_measure_assembly": (assembly, empty_tree, many_members),
    "OBJECT_OT_body_moments_set_rigid_body_mass": (four, rigid, trouble),
}
OPTIONS = {
    "OBJECT_OT_body_moments_export_bill": ({"target": "OBJECT"}, {"filepath": "mine.csv"}),
    "OBJECT_OT_body_moments_measure_assembly": ({"target": "OBJECT"},),
    "OBJECT_OT_body_moments_fourier": ({"of": "AREA"}, {"filepath": "folder/mine.npz"}),
    "OBJECT_OT_body_moments_save_numbers": ({"filepath": "mine.csv"},),
}


@pytest.mark.parametrize("name", [name for name in having("invoke") if not name.endswith(ELSEWHERE)])
def test_a_press(name, kept, tmp_path, monkeypatch):
    monkeypatch.setattr(stepwise, "STEP_SECONDS", 0.0)
    monkeypatch.setattr(stepwise, "MAX_STEP_SECONDS", 0.0)
    pages, is_written = [], "filepath" in operator_of(name).get_rna_type().properties
    for build in (*PRESSED_IN.get(name, (parts,)), *([saved(tmp_path)] if is_written else ())):
        for options in ({}, *OPTIONS.get(name, ())):
            before = []
            for way in ("without a window", "a window", "Esc"):
                bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
                build()
                lines, changes = pressed(name, options, way)
                if lines:
                    pages += ["=== {:s}, {:s}: {}".format(build.__name__, way, options), *lines]
                    pages += ["changes as before"] if changes and changes == before else changes
                    before = changes
    text = re.sub(ROUNDING, "rounding", re.sub(DIGEST, "digest", "\n".join(pages)))
    text = text.replace(str(tmp_path), "FOLDER")
    kept("pressed/{:s}.txt".format(name.replace("_body_moments", "")), text)


def pressed(name, options, way):
    """What comes of it, and what it changes."""
    window = Window(way != "without a window")
    before = state()
    operator = stand_in(OPERATORS[name], lambda kind, text: window.say(*kind, text), **options)
    answer = operator.invoke(window, MOUSE)
    window.say(answer)
    if "dialog " + name in window.said:
        answer = operator.execute(window)
        window.say("confirmed", answer)
    if "modal " + name not in window.said or "file browser " + name in window.said:
        if hasattr(operator, "filepath"):
            window.say("path", repr(operator.filepath))
        return [] if way == "Esc" else window.said, [*difference(before, state())]
    window.say(operator.modal(window, MOUSE))
    window.say(operator.modal(window, TIMER))
    answer = {"RUNNING_MODAL"}
    for event in [ESC] if way == "Esc" else [TIMER] * 1000:
        answer = operator.modal(window, event)
        if answer != {"RUNNING_MODAL"}:
            break
    window.say(answer)
    return window.said, [*difference(before, state())]


def beam():
    add(flat_mesh(I_BEAM), "Beam")
    bpy.ops.object.body_moments_measure_section()


DRAWN_AGAIN = {
    "OBJECT_OT_body_moments_axis_from_selection": lambda: edited(2),
    "OBJECT_OT_body_moments_clear_assembly": assembly,
    "OBJECT_OT_body_moments_clear_bones": bones,
    "OBJECT_OT_body_moments_live": parts,
    "OBJECT_OT_body_moments_measure_bones": bones,
    "OBJECT_OT_body_moments_measure_section": beam,
    "OBJECT_OT_body_moments_physics_rig": bones,
    "OBJECT_OT_body_moments_rig_center": bones,
    "OBJECT_OT_body_moments_stability": parts,
}


@pytest.mark.parametrize("name", DRAWN_AGAIN)
def test_what_several_areas_show_has_them_drawn_again(name):
    DRAWN_AGAIN[name]()
    for _ in range(2 if name.endswith("live") else 1):  # on, and off
        window = Window()
        assert stand_in(OPERATORS[name], print).execute(window) == {"FINISHED"}
        assert window.said == ["drawn again"]


PROGRESS = {  # of operators on two objects: what is done after each step
    "OBJECT_OT_body_moments_add_empty": (1, 2),
    "OBJECT_OT_body_moments_align_to_world": (1, 2),
    "OBJECT_OT_body_moments_measure": (2,),  # they are measured together
    "OBJECT_OT_body_moments_stability": (1, 2),
    "OBJECT_OT_body_moments_find_symmetry": None,
}


@pytest.mark.parametrize("count", [1, 2])
@pytest.mark.parametrize("name", PROGRESS)
def test_of_several_objects_the_cursor_shows_the_progress(name, count, monkeypatch):
    bodies(count)
    window = Window()
    monkeypatch.setattr(stepwise, "bpy", SimpleNamespace(context=window))
    assert stand_in(OPERATORS[name], lambda *_: None).execute(bpy.context) == {"FINISHED"}
    if count == 1:
        assert not window.said
        return
    first, *steps, last = window.said
    assert (first, last) == ("progress 0 2", "progress ends")
    shares = [float(step.removeprefix("done ")) for step in steps]
    assert shares == sorted(shares) and shares[-1] == 2.0
    assert PROGRESS[name] in (tuple(shares), None)


def test_the_cursor_shows_no_progress_any_more_where_a_step_fails(monkeypatch):
    window = Window()
    monkeypatch.setattr(stepwise, "bpy", SimpleNamespace(context=window))
    with pytest.raises(ZeroDivisionError), stepwise.progress(3) as step:
        step(1)
        raise ZeroDivisionError
    assert window.said == ["progress 0 3", "done 1", "progress ends"]


@pytest.mark.parametrize(("away", "worked"), [(0.0, 0.1), (0.05, 0.1), (0.5, 0.5), (1.0, 1.0), (7.0, 1.0)])
def test_between_two_events_is_worked_as_long_as_the_window_took_within_limits(away, worked, monkeypatch):
    now, tick = [100.0], 2.0**-6
    monkeypatch.setattr(stepwise, "perf_counter", lambda: now[0])

    def steps():
        while True:
            now[0] += tick
            yield 0.0

    operator, window = stepwise.ModalSteps(), Window()
    operator.PROGRESS, operator._steps = finding("progress_measuring"), steps()
    operator.start_modal(window, 1.0)
    for _ in range(2):
        now[0] += away
        began = now[0]
        assert operator.modal(window, TIMER) == {"RUNNING_MODAL"}
        assert worked <= now[0] - began < worked + tick


def test_what_has_nothing_to_do_is_done_as_a_whole():
    operator, window = stepwise.ModalSteps(), Window()
    operator.PROGRESS = finding("progress_measuring")
    assert operator.start_modal(window, 0) == {"RUNNING_MODAL"}
    assert ["100%" in line for line in window.said if line.startswith("status")] == [True]


COPIED_IN = {
    "OBJECT_OT_body_moments_copy_inertial": parts,
    "OBJECT_OT_body_moments_copy_csv": parts,
    "OBJECT_OT_body_moments_copy_report": parts,
    "OBJECT_OT_body_moments_copy_reference": parts,
    "OBJECT_OT_body_moments_copy_moments": computed,
    "OBJECT_OT_body_moments_copy_section": beam,
    "OBJECT_OT_body_moments_copy_value": parts,
}


def test_what_is_copied_in_a_window(kept, monkeypatch):
    monkeypatch.setattr(
        copy, "bpy", SimpleNamespace(app=SimpleNamespace(background=False, version=(9, 9, 9)), data=bpy.data)
    )
    pages = []
    for name, build in COPIED_IN.items():
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        build()
        window = Window()
        options = {"value": "1.5", "unit": "kg"} if name.endswith("value") else {}
        operator = stand_in(OPERATORS[name], lambda kind, text, to=window: to.say(*kind, text), **options)
        window.say(operator.execute(window), len(window.clipboard.splitlines()), "lines")
        pages += ["=== " + name, *window.said, window.clipboard.splitlines()[0]]
    kept("copied.txt", "\n".join(pages))
