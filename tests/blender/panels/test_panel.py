# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panel shows, drawn into a layout that writes everything down."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from body_moments.core.verdict.finding import finding

from tests.blender.objects import add, measured, mesh_body, only, strip_mesh

pytestmark = pytest.mark.usefixtures("scene")


class Layout:
    """Records labels, properties and operators, in the order of drawing. Checks that what is
    drawn exists.
    """

    def __init__(self, record=None, closed=()):
        object.__setattr__(self, "record", [] if record is None else record)
        object.__setattr__(self, "closed", closed)

    def __setattr__(self, name, value):
        if name == "alert" and value:
            self.record.append(("alert", ""))
        object.__setattr__(self, name, value)

    def _sub(self, **_options):
        return Layout(self.record, self.closed)

    row = column = split = box = grid_flow = menu_pie = _sub

    def panel(self, name, default_closed=False):
        return self._sub(), None if name in self.closed else self._sub()

    def separator(self, **_options):
        pass

    def label(self, text="", icon="NONE", **options):
        parameters = bpy.types.UILayout.bl_rna.functions["label"].parameters
        assert icon in parameters["icon"].enum_items and {*options} <= {*parameters.keys()}
        self.record.append(("label", text, options.get("translate", True)))

    def prop(self, data, name, text=None, **_options):
        assert name in data.bl_rna.properties
        self.record.append(("prop", name))

    def prop_enum(self, data, name, value, **_options):
        assert value in data.bl_rna.properties[name].enum_items
        self.record.append(("prop", name))

    def operator(self, name, text=None, icon="NONE", **_options):
        assert icon in bpy.types.UILayout.bl_rna.functions["label"].parameters["icon"].enum_items
        category, function = name.split(".")
        getattr(getattr(bpy.ops, category), function).get_rna_type()
        properties = SimpleNamespace()
        self.record.append(("operator", name, properties))
        return properties

    def template_list(self, name, _identifier, data, listed, active_data, active, **_options):
        assert hasattr(bpy.types, name) and active in active_data.bl_rna.properties
        for index, row in enumerate(getattr(data, listed)):
            getattr(bpy.types, name).draw_item(None, bpy.context, self, data, row, 0, active_data, active, index)

    def prop_search(self, data, name, owner, collection, **_options):
        assert collection in owner.bl_rna.properties
        self.prop(data, name)

    def context_pointer_set(self, name, data):
        self.record.append(("pointer", name, data))

    def menu(self, name, **_options):
        assert hasattr(bpy.types, name)
        self.record.append(("menu", name))

    def popover(self, name, **_options):
        assert hasattr(bpy.types, name)
        self.record.append(("popover", name))


def drawn(closed=(), without=()):
    """What the main panel and its sub-panels show, in their order, all open. without: names of sub-panels."""
    from body_moments.panels import body, places

    layout = Layout(closed=closed)
    body.VIEW3D_PT_body_moments.draw(SimpleNamespace(layout=layout), bpy.context)
    for name in places.ORDER:
        panel = getattr(bpy.types, "VIEW3D_PT_body_moments_" + name, None)
        if panel is not None and name not in without and (not hasattr(panel, "poll") or panel.poll(bpy.context)):
            layout.record.append(("label", panel.bl_label, True))
            panel.draw(SimpleNamespace(layout=layout), bpy.context)
    return layout.record


def labels(record):
    return [entry[1] for entry in record if entry[0] == "label"]


def shows(record, code, **values):
    """Whether the sentence of a finding is drawn, in however many lines."""
    return str(finding(code, **values)) in " ".join(labels(record))


def findings_of(obj, severity=None):
    """The codes that are stored, all or of one severity."""
    from body_moments.operators.write import messages, properties

    found = properties.findings(obj)
    return [one.code for one in (found if severity is None else messages.of_severity(found, severity))]


def copied(record, unit):
    return [
        entry[2].value
        for entry in record
        if entry[0] == "operator" and entry[1].endswith("copy_value") and entry[2].unit == unit
    ]


def test_both_panels_draw_and_show_that_an_object_has_no_results():
    add(mesh_body())
    assert "Not Measured" in labels(drawn())
    assert bpy.types.VIEW3D_PT_body_moments.bl_category == "Moments"
    assert bpy.types.OBJECT_PT_body_moments.bl_context == "object"


def test_why_an_object_could_not_be_measured_is_shown_until_it_is():
    flat = bpy.data.meshes.new("Wire")
    flat.from_pydata([(0, 0, 0), (1, 0, 0)], [(0, 1)], [])
    obj = add(flat)
    bpy.ops.object.body_moments_measure()
    record = drawn()
    assert "Not Measured" in labels(record) and shows(record, "only_loose_geometry", vertices=2, edges=1)
    obj.data = mesh_body()
    bpy.ops.object.body_moments_measure()
    assert "Not Measured" not in labels(drawn())
    assert "Exact" in labels(drawn())


def test_a_refusal_beside_stored_numbers_does_not_deny_them():
    obj = add(mesh_body())
    bpy.ops.object.body_moments_measure()
    obj.body_moments.density_from, obj.body_moments.density_polynomial = "POLYNOMIAL", "-1"
    bpy.ops.object.body_moments_measure()
    found = labels(drawn())
    assert "Not Measured Again" in found and "Not Measured" not in found and "Exact" in found


def test_what_measure_and_live_refuse_for_the_same_reason_is_not_shown_twice():
    obj = add(mesh_body())
    bpy.ops.object.body_moments_measure()
    obj.body_moments.density_from, obj.body_moments.density_polynomial = "POLYNOMIAL", "-1"
    bpy.ops.object.body_moments_live()
    from body_moments.operators.session import live, results

    sentence = str(live.current_numbers(obj).refusal)
    assert sentence in " ".join(labels(drawn()))
    bpy.ops.object.body_moments_measure()
    assert " ".join(labels(drawn())).count(sentence) == 1
    assert str(results.failure(obj)) == sentence
    bpy.ops.object.body_moments_live()


def test_a_refusal_is_not_held_against_other_settings():
    obj = add(mesh_body())
    settings = obj.body_moments
    settings.density_from, settings.density_polynomial = "POLYNOMIAL", "1000+"
    bpy.ops.object.body_moments_measure()
    assert shows(drawn(), "polynomial_syntax_at", part="1000+")
    settings.density_from = "VALUE"
    assert "Not Measured" in labels(drawn()) and not shows(drawn(), "polynomial_syntax_at", part="1000+")
    settings.density_from = "POLYNOMIAL"
    assert shows(drawn(), "polynomial_syntax_at", part="1000+")


def test_a_flat_solid_gets_the_remedies_shell_and_section():
    flat = bpy.data.meshes.new("Flat")
    flat.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [], [(0, 1, 2)])
    add(flat)
    bpy.ops.object.body_moments_measure()
    assert shows(drawn(), "no_volume")


def test_every_kind_of_object_can_be_active():
    for kind in ("CAMERA", "EMPTY", "LIGHT", "ARMATURE"):
        data = {
            "CAMERA": lambda: bpy.data.cameras.new("C"),
            "LIGHT": lambda: bpy.data.lights.new("L", "POINT"),
            "ARMATURE": lambda: bpy.data.armatures.new("A"),
            "EMPTY": lambda: None,
        }[kind]()
        add(data, kind)
        record = drawn()
        assert not [entry for entry in record if entry[0] == "prop" and entry[1] in ("density", "overlap")]
        assert [entry for entry in record if entry[0] == "operator" and entry[1] == "object.body_moments_measure"]


def test_an_object_that_its_kind_would_make_a_body_shows_its_kind():
    curve = bpy.data.curves.new("Path", "CURVE")
    curve.splines.new("POLY").points.add(1)
    add(curve)
    assert ("prop", "kind") in drawn()
    empty = add(None, "Instancer")
    empty.instance_type, empty.instance_collection = "COLLECTION", bpy.data.collections.new("Parts")
    assert ("prop", "kind") in drawn()


def test_a_wire_shows_no_volume_and_no_area_anywhere():
    curve = bpy.data.curves.new("Path", "CURVE")
    curve.splines.new("POLY").points.add(1)
    curve.splines[0].points[1].co = (3.0, 0.0, 0.0, 1.0)
    obj = add(curve)
    obj.body_moments.kind = "WIRE"
    bpy.ops.object.body_moments_measure()
    found = labels(drawn())
    assert "3 m" in found and found.count("Center") == 2 and found.count("Mass") == 2
    assert not {"Volume", "Area"} & set(found)


def test_the_order_is_that_of_cad_dialogs():
    add(mesh_body())
    bpy.ops.object.body_moments_measure()
    found = labels(drawn())
    order = [
        "Body",
        "Exact",
        "Mass",
        "Volume",
        "Area",
        "Center of Mass (World)",
        "Inertia",
        "Principal Moments",
        "Principal Axes",
        "Radii of Gyration",
        "Inertia Tensor",
        "Apply to Object",
        "Selection",
        "Advanced",
        "Error Bounds",
    ]
    places = [found.index(text) for text in order]
    assert places == sorted(places)


def test_values_are_shown_with_units_and_copied_with_all_digits():
    obj = add(mesh_body(), location=(1, 2, 3), rotation=(0.3, 0.2, 0.1))
    bpy.ops.object.body_moments_measure()
    found = measured(obj)
    record = drawn(without=("selection",))
    assert "3.15 m³" in labels(record)
    assert float(copied(record, "m³")[0]) == obj["body_volume"]
    assert float(copied(record, "kg")[0]) == obj["body_mass"]
    center = [float(text) for text in copied(record, "m")[1:4]]
    assert np.abs(np.array(center) - found.mass_properties.center).max() < 1e-12


@pytest.mark.parametrize("frame", ["WORLD", "OBJECT"])
@pytest.mark.parametrize("unit", [1.0, 0.001])
def test_the_frame_shown_is_the_frame_chosen(frame, unit):
    from body_moments.operators.session import results

    scene = bpy.context.scene
    scene.unit_settings.scale_length = unit
    obj = add(mesh_body(), location=(1, 2, 3), rotation=(0.3, 0.2, 0.1), scale=(1, 2, -1))
    bpy.ops.object.body_moments_measure()
    scene.body_moments.frame = frame
    shown, truth = results.of_object(obj, scene).body, measured(obj)
    truth = truth.mass_properties if frame == "WORLD" else truth.in_object_frame()
    assert np.abs(shown.center - truth.center).max() < 1e-12 * max(1.0, np.abs(truth.center).max())
    assert np.abs(shown.inertia - truth.inertia).max() < 1e-12 * np.trace(truth.inertia)
    assert np.abs(shown.principal.axes - truth.principal.axes).max() < 1e-9
    assert np.abs(shown.radii_of_gyration / truth.radii_of_gyration - 1.0).max() < 1e-12


def test_the_total_shows_what_may_be_no_part_of_it(capfd):
    """Without a window there is no clipboard: the whole report goes to the standard output."""
    from body_moments.operators.session import results

    body, cutter = add(mesh_body(), "Body"), add(mesh_body(), "Cutter", location=(1, 1, 1))
    cutter.display_type = "WIRE"
    body.modifiers.new("Cut", "BOOLEAN").object = cutter
    only(body, cutter)
    bpy.ops.object.body_moments_measure()
    (caveat,) = results.total(bpy.context).findings
    assert caveat.code == "total_boolean_operands" and "“Cutter” of “Body”" in str(caveat)
    assert shows(drawn(), caveat.code, **caveat.values)
    bpy.ops.object.body_moments_copy_report()
    assert str(caveat) in capfd.readouterr().out
    body.modifiers.clear()
    bpy.context.view_layer.update()
    assert [one.code for one in results.total(bpy.context).findings] == ["total_hidden_objects"]
    only(cutter)
    bpy.context.view_layer.update()
    assert results.total(bpy.context).findings == ()


def test_the_total_shows_that_an_open_body_makes_it_depend_on_a_point(capfd):
    from body_moments.operators.session import results

    only(add(mesh_body(), "Body"), add(strip_mesh(), "Strip"))
    bpy.ops.object.body_moments_measure()
    (caveat,) = results.total(bpy.context).findings
    assert caveat.code == "total_of_open_objects"
    assert "“Strip”" in str(caveat) and "“Body”" not in str(caveat)
    bpy.ops.object.body_moments_copy_report()
    assert str(caveat) in capfd.readouterr().out


def test_what_is_rounding_in_a_totals_center_is_shown_as_0():
    for turn in ((0.3, 0.2, 0.1), (0.1, 0.5, 0.7)):
        bpy.ops.mesh.primitive_cylinder_add(vertices=7, rotation=turn)
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.body_moments_measure()
    told = labels(drawn())
    assert told[told.index("Center of Mass (World)") :][1:6:2] == ["X", "Y", "Z"]
    assert told[told.index("Center of Mass (World)") :][2:7:2] == ["0 m", "0 m", "0 m"]


def test_totals_have_parallel_axis_terms():
    from body_moments.operators.session import results

    objects = [add(mesh_body(), str(i), location=(10 * i, 2 * i, -i), rotation=(i, 0, 0)) for i in range(3)]
    only(*objects)
    bpy.ops.object.body_moments_measure()
    add(mesh_body(), "Not Measured")
    for obj in objects:
        obj.select_set(True)
    from body_moments.core.inertia.mass_properties import combine

    truth = combine([measured(obj).mass_moments for obj in objects])
    total = results.total(bpy.context)
    assert total.count == 3 and total.missing == ("Not Measured",)
    assert abs(total.body.mass / truth.mass - 1.0) < 1e-12
    assert np.abs(total.body.center - truth.center).max() < 1e-9
    moments = truth.principal.moments
    assert np.abs(total.body.principal.moments - moments).max() < 1e-9 * moments.max()
    found = labels(drawn())
    assert "3 Objects" in found
    assert "Not measured: “Not Measured”" in " ".join(found)
    objects[1].body_moments.kind = "SHELL"
    bpy.context.view_layer.update()
    assert "Out of date: “1”" in " ".join(labels(drawn()))


def test_damaged_results_are_not_shown():
    obj = add(mesh_body())
    bpy.ops.object.body_moments_measure()
    obj["body_center_of_mass"] = 5.0
    assert "Not Measured" in labels(drawn())
    obj["body_center_of_mass"] = [1.0, 2.0]
    assert "Not Measured" in labels(drawn())


def store_findings(obj, *findings):
    from body_moments.operators.write import properties

    obj["body_findings"] = properties.findings_text(findings)


FOUND = (finding("t_junctions", count=3), finding("overlap_unchecked", count=2), finding("no_faces"))


def test_warnings_are_shown_wrapped_before_the_numbers_and_notes_behind_them_errors_first():
    obj = add(mesh_body())
    obj.body_moments.density = 1000.0
    bpy.ops.object.body_moments_measure()
    assert not any(label.startswith(("Warnings", "Notes")) for label in labels(drawn()))
    store_findings(obj, *FOUND)
    found = labels(drawn())
    start, end, behind = found.index("Warnings (2)"), found.index("Material"), found.index("Notes (1)")
    assert start < end < found.index("Mass") < behind < found.index("Apply to Object")
    assert " ".join(found[start + 1 : end]) == "{} {}".format(FOUND[2], FOUND[1])
    assert end - start > 4  # lines
    assert " ".join(found[behind + 1 :]).startswith(str(FOUND[0]))


def test_warnings_are_open_and_notes_closed_at_first(monkeypatch):
    closed = {}

    def panel(self, name, default_closed=False):
        closed[name] = default_closed
        return self._sub(), self._sub()

    monkeypatch.setattr(Layout, "panel", panel)
    obj = add(mesh_body())
    bpy.ops.object.body_moments_measure()
    store_findings(obj, *FOUND)
    drawn()
    assert closed["body_moments_warnings"] is False and closed["body_moments_notes"] is True


def test_findings_that_are_damaged_or_of_another_version_do_not_stop_the_panel():
    obj = add(mesh_body())
    bpy.ops.object.body_moments_measure()
    for text in ("", "[", "{}", '[{"code": "of_the_future", "values": {}}]', '[{"code": "holes_capped"}]', "[1]"):
        obj["body_findings"] = text
        assert "Exact" in labels(drawn())
    obj["body_method"] = "guess"
    assert "Guess" in labels(drawn())


@pytest.mark.parametrize("kind", ["FONT", "META", "CURVE"])
def test_polygons_that_stand_for_a_curve_are_a_note_and_no_warning(kind, capfd):
    if kind == "META":
        bpy.ops.object.metaball_add()
        bpy.context.object.data.render_resolution = bpy.context.object.data.resolution
    elif kind == "FONT":
        bpy.ops.object.text_add()
        bpy.context.object.data.body, bpy.context.object.data.extrude = "o", 0.1
    else:
        bpy.ops.curve.primitive_bezier_circle_add()
        bpy.context.object.data.bevel_depth = 0.2
    bpy.ops.object.body_moments_measure()
    obj = bpy.context.object
    out = capfd.readouterr().out
    assert {"surface_drawn_as_polygons", "curves_drawn_as_polygons"} & {*findings_of(obj, "note")}
    assert not findings_of(obj, "warning") and obj["body_warnings"] == ""
    assert "Info: Measured {:s}\n".format(obj.name) in out and "Warning" not in out
    found = labels(drawn())
    assert any(label.startswith("Notes (") for label in found)
    assert not any(label.startswith("Warnings (") for label in found)


def test_a_density_from_a_grid_is_shown_and_no_warning(tmp_path, capfd):
    from tests.blender.grids import vdb_grid, volume_object

    only(volume_object(tmp_path / "a.vdb", vdb_grid(np.ones((4, 4, 4), np.float32))))
    bpy.ops.object.body_moments_measure()
    assert "Warning" not in capfd.readouterr().out
    assert "Notes (2)" in labels(drawn())


def test_faces_of_a_mesh_that_are_not_planar_are_a_warning():
    obj = add(mesh_body())
    obj.data.vertices[3].co.z += 0.2
    obj.data.update()
    bpy.ops.object.body_moments_measure()
    assert findings_of(obj, "warning") == ["non_planar_faces"] and "Warnings (1)" in labels(drawn())


def test_a_warning_beside_a_note_is_one(capfd):
    bpy.ops.curve.primitive_bezier_circle_add()
    curve = bpy.context.object.data
    curve.bevel_depth, curve.render_resolution_u = 0.1, 30
    bpy.ops.object.body_moments_measure()
    assert "Warning: Measured BézierCircle, with warnings" in capfd.readouterr().out.replace("Bezier", "Bézier")
    found = labels(drawn())
    assert any(label.startswith("Warnings (") for label in found) and any(
        label.startswith("Notes (") for label in found
    )


def test_sentences_fit_into_the_narrowest_sidebar():
    from body_moments.panels import rows

    style = SimpleNamespace(widget=SimpleNamespace(points=11.0))
    for scale in (1.0, 2.0):
        preferences = SimpleNamespace(system=SimpleNamespace(ui_scale=scale), ui_styles=[style])
        context = SimpleNamespace(region=SimpleNamespace(width=184 * scale), preferences=preferences)
        assert 0 < rows._width(context)[0] <= (184 - rows.REGION_MARGIN) * scale


def test_words_longer_than_a_line_are_broken_and_numbers_with_spaces_are_not():
    from body_moments.panels import rows

    lines = rows._wrapped("Trägheitstensor um 20\u2009000 mm", 60, 11.0)
    assert "".join(lines).replace("-", "").startswith("Trägheitstensor") and "-" in lines[0]
    assert any("20\u2009000" in line for line in lines)
    assert all(len(part) > 2 for part in lines)
    assert rows._wrapped("short", 60, 11.0) == ("short",)


def test_numbers_are_whole_in_the_narrowest_sidebar(monkeypatch):
    from body_moments.panels import rows

    def shown(width):
        style = SimpleNamespace(widget=SimpleNamespace(points=11.0))
        preferences = SimpleNamespace(system=SimpleNamespace(ui_scale=1.0), ui_styles=[style])
        region = None if width is None else SimpleNamespace(width=width)
        context = SimpleNamespace(region=region, preferences=preferences)
        monkeypatch.setattr(rows, "bpy", SimpleNamespace(context=context))
        layout, factors = Layout(), []
        monkeypatch.setattr(Layout, "split", lambda self, factor, **_: factors.append(factor) or self._sub())
        rows.text(layout, "Volume", "0.182213 m³", "0.18221349", "m³")
        rows.direction(layout, "2", (-0.0, -0.98765432, 0.1566))
        return layout.record, factors

    for width in (300, None):  # None: without a window
        record, shared = shown(width)
        assert labels(record) == ["Volume", "0.182213 m³", "2", "0.0000", "−0.9877", "0.1566"]
        assert shared == [rows.LABEL_SHARE, rows.INDEX_LABEL_SHARE]
    record, shared = shown(120)  # the unit goes with the label
    assert labels(record)[:3] == ["Volume", "m³", "0.182213"]
    record, shared = shown(184)
    assert labels(record) == ["Volume", "0.182213 m³", "2 x", "0.0000", "2 y", "−0.9877", "2 z", "0.1566"]
    assert shared == [rows.SHORT_LABEL_SHARE] * 3  # the volume has a row of its own
    assert copied(record, "") == ["-0.0", "-0.98765432", "0.1566"]


def test_drawing_changes_nothing_and_measures_nothing(monkeypatch):
    from body_moments.operators.bodies import request

    obj = add(mesh_body())
    bpy.ops.object.body_moments_measure()
    monkeypatch.setattr(request, "read_object", lambda *_: pytest.fail("the panel measures"))
    before = {key: str(obj[key]) for key in obj.keys() if key.startswith("body_")}  # noqa: SIM118
    drawn()
    assert {key: str(obj[key]) for key in obj.keys() if key.startswith("body_")} == before  # noqa: SIM118


def outdated():
    """The code of the reason that is shown, if any."""
    text = " ".join(labels(drawn(without=("selection",))))
    codes = ("settings", "geometry", "transform")
    return [code for code in codes if "Out of date: {}".format(finding("stale_" + code)) in text]


def test_out_of_date_after_a_change_of_transform_settings_or_geometry_and_not_after_measuring():
    obj = add(mesh_body())
    update = bpy.context.view_layer.update
    bpy.ops.object.body_moments_measure()
    update()
    assert not outdated()
    obj.scale.x = 2.0
    update()
    assert outdated() == ["transform"]
    obj.scale.x = 1.0
    update()
    assert not outdated()
    obj.body_moments.kind = "SHELL"
    assert outdated() == ["settings"]
    bpy.ops.object.body_moments_measure()
    update()
    assert not outdated()
    obj.data.vertices[0].co.x -= 1.0
    obj.data.update()
    update()
    assert outdated() == ["geometry"]
    bpy.ops.object.body_moments_measure()
    update()
    assert not outdated()
    obj.modifiers.new("Subdivision", "SUBSURF")
    update()
    assert outdated()


def test_selecting_renaming_and_undoing_something_else_leaves_results_up_to_date():
    obj = add(mesh_body())
    bpy.ops.object.body_moments_measure()
    bpy.context.view_layer.update()
    bpy.ops.ed.undo_push(message="measured")
    obj.select_set(False)
    obj.select_set(True)
    obj.name = "Renamed"
    bpy.context.view_layer.update()
    assert not outdated()
    bpy.ops.ed.undo_push(message="renamed")
    bpy.ops.ed.undo()
    bpy.context.view_layer.update()
    assert bpy.context.object.name == "Body" and not outdated()


def test_an_operator_that_refuses_leaves_results_up_to_date():
    obj = add(mesh_body())
    obj.modifiers.new("Cast", "CAST")
    bpy.ops.object.body_moments_measure()
    bpy.context.view_layer.update()
    assert bpy.ops.object.body_moments_origin_to_center() == {"CANCELLED"}
    assert not outdated()


def test_a_saved_file_is_up_to_date_when_opened_and_out_of_date_when_edited(tmp_path):
    add(mesh_body())
    bpy.ops.object.body_moments_measure()
    path = str(tmp_path / "a.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    assert not outdated()
    obj = bpy.context.object
    obj.data.vertices[0].co.x -= 1.0
    obj.data.update()
    bpy.context.view_layer.update()
    assert outdated()


def test_a_file_saved_after_an_edit_is_out_of_date_when_opened(tmp_path):
    obj = add(mesh_body())
    bpy.ops.object.body_moments_measure()
    obj.data.vertices[0].co.x -= 1.0
    obj.data.update()
    bpy.context.view_layer.update()
    path = str(tmp_path / "a.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    assert outdated()
    bpy.ops.wm.open_mainfile(filepath=path)
    assert outdated()
    bpy.ops.object.body_moments_measure()
    assert not outdated()


def test_the_presets_panel_draws_without_presets(monkeypatch):
    from body_moments.panels.material_menus import OBJECT_MT_body_moments_materials, OBJECT_PT_body_moments_presets

    monkeypatch.setattr(bpy.utils, "preset_paths", lambda _: [])
    add(mesh_body())
    for cls in (OBJECT_MT_body_moments_materials, OBJECT_PT_body_moments_presets):
        layout = Layout()
        cls.draw(
            SimpleNamespace(layout=layout, preset_add_operator=getattr(cls, "preset_add_operator", "")),
            bpy.context,
        )
        assert layout.record


def settings_drawn(obj):
    return [entry[1] for entry in drawn() if entry[0] == "prop"]


def test_the_panel_shows_the_settings_of_each_source_of_density():
    obj = add(mesh_body())
    assert "density_kg_m3" in settings_drawn(obj) and "density_polynomial" not in settings_drawn(obj)
    obj.body_moments.density_from = "POLYNOMIAL"
    shown = settings_drawn(obj)
    assert {"density_polynomial", "density_frame"} <= {*shown} and "density_kg_m3" not in shown
    obj.body_moments.density_from = "ATTRIBUTE"
    assert "density_attribute" in settings_drawn(obj)
    obj.body_moments.density_from = "MATERIALS"
    assert settings_drawn(obj).count("density_kg_m3") == 1 and shows(drawn(), "panel_no_material_slots")
    for name in ("Steel", "Cork"):
        obj.data.materials.append(bpy.data.materials.new(name))
    obj.data.materials.append(bpy.data.materials["Cork"])  # one row for each material
    assert settings_drawn(obj).count("density_kg_m3") == 3
    targets = [entry[2].name for entry in drawn() if entry[0] == "pointer"]
    assert targets == ["Steel", "Cork"] and {"Steel", "Cork"} <= {*labels(drawn())}
    obj.body_moments.mass_from = "MASS"
    assert "density_from" not in settings_drawn(obj)


def test_the_panel_shows_where_the_density_came_from():
    obj = add(mesh_body())
    bpy.ops.object.body_moments_measure()
    assert not [text for text in labels(drawn()) if text.startswith("Mean density")]
    obj.body_moments.density_from, obj.body_moments.density_polynomial = "POLYNOMIAL", "900 + z"
    bpy.ops.object.body_moments_measure()
    text = " ".join(labels(drawn()))
    assert "Mean density, from polynomial" in text and "900 + z" in text


def test_a_materials_panel_draws_its_density():
    from body_moments.panels.material_menus import MATERIAL_PT_body_moments

    made = bpy.data.materials.new("Steel")
    for density, default in ((0.0, True), (7820.0, False)):
        made.body_moments.density = density
        layout = Layout()
        with bpy.context.temp_override(material=made):
            MATERIAL_PT_body_moments.draw(SimpleNamespace(layout=layout), bpy.context)
        assert ("prop", "density_kg_m3") in layout.record
        assert shows(layout.record, "panel_material_default") == default and (default or not labels(layout.record))
    assert MATERIAL_PT_body_moments.poll(SimpleNamespace(material=made))
    assert not MATERIAL_PT_body_moments.poll(SimpleNamespace())


def test_the_menus_set_the_material_that_the_layout_points_at():
    from body_moments.panels.material_menus import CATEGORY_MENUS

    made = bpy.data.materials.new("Steel")
    for target, wanted in ((None, "object.body_moments_set_material"), (made, "material.body_moments_set_density")):
        layout = Layout()
        CATEGORY_MENUS[0].draw(
            SimpleNamespace(layout=layout, bl_label="Metals"),
            SimpleNamespace(body_moments_material=target, scene=bpy.context.scene),
        )
        buttons = [entry for entry in layout.record if entry[0] == "operator"]
        assert buttons and {entry[1] for entry in buttons} == {wanted}
        if target:
            assert {entry[2].target for entry in buttons} == {"Steel"}


def test_a_nurbs_surface_shows_what_its_display_mesh_would_have_given_and_follows_edits():
    bpy.ops.surface.primitive_nurbs_surface_sphere_add()
    assert ("operator", "object.body_moments_live") in [entry[:2] for entry in drawn()]
    bpy.ops.object.body_moments_measure()
    shown = labels(drawn())
    assert "NURBS: Exact" in shown
    assert "Display Mesh" in shown and "-1.33% of the volume" in shown
    bpy.ops.object.body_moments_live()
    assert any(label.startswith("Live (") for label in labels(drawn()))
    bpy.ops.object.body_moments_live()
    assert not any(label.startswith("Live (") for label in labels(drawn()))


def test_a_wire_shows_its_length_and_asks_for_its_linear_density():
    bpy.ops.curve.primitive_nurbs_circle_add()
    bpy.context.object.body_moments.kind = "WIRE"
    bpy.ops.object.body_moments_measure()
    record = drawn()
    assert "Wire" in labels(record) and "Length" in labels(record)
    assert ("prop", "linear_density") in record


def test_a_wall_of_real_thickness_is_called_so_whatever_the_setting_is_now():
    obj = add(mesh_body())
    obj.body_moments.kind, obj.body_moments.thickness = "SHELL", 0.01
    bpy.ops.object.body_moments_measure()
    assert "Shell" in labels(drawn()) and "Wall" not in labels(drawn())
    obj.body_moments.wall = "INWARD"
    bpy.ops.object.body_moments_measure()
    assert "Wall" in labels(drawn()) and shows(drawn(), "panel_wall_limit", length=largest(obj))
    obj.body_moments.kind = "SOLID"
    assert "Wall" in labels(drawn()) and outdated() == ["settings"]


def largest(obj):
    from body_moments.operators.session import walls

    return walls.max_thickness(obj)


def test_the_list_names_objects_without_numbers():
    from body_moments.panels.selection import BODY_MOMENTS_UL_measured

    obj = add(mesh_body(), "Not yet")
    layout = Layout()
    BODY_MOMENTS_UL_measured.draw_item(None, bpy.context, layout, None, obj, 0, None, "", 0)
    assert labels(layout.record) == ["Not yet"]
