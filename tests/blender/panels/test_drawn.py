# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""All that the panels draw, in scenes that differ in one thing: kept as text, which `pytest --rewrite` writes.

A page is read as a user reads the panel. The numbers on it are tested where they are measured.
"""

from difflib import unified_diff
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from body_moments.core.verdict.finding import finding

from tests.blender.actions.assembly.test_assembly import assembly_of_boxes
from tests.blender.actions.measure.test_section import I_BEAM, curve_of, flat_mesh, square
from tests.blender.actions.rig.test_rig import character
from tests.blender.actions.setup.test_remedy_buttons import boxes
from tests.blender.actions.test_stability import wedge
from tests.blender.bodies.test_assembly import box, box_mesh, empty
from tests.blender.grids import vdb_grid, volume_object
from tests.blender.objects import add, only, strip_mesh
from tests.blender.panels.drawing import Context, Layout, drawn, region

pytestmark = pytest.mark.usefixtures("scene")
NARROW = Context(184)


class Book:
    """Pages with their titles. Of a page that shows the same panels as others, what differs from the most alike."""

    def __init__(self):
        self.pages, self.earlier = [], {}

    def draw(self, title, *names, **options):
        bpy.context.view_layer.update()
        text = drawn(*names, **options)
        shown = [(title, text)]
        for other, before in self.earlier.setdefault(names, []):
            lines = list(unified_diff(before.split("\n"), text.split("\n"), n=1, lineterm=""))[2:]
            shown.append(("{:s}: beside “{:s}”".format(title, other), "\n".join(lines)))
        self.write(*min(shown, key=lambda page: len(page[1])))
        self.earlier[names].append((title, text))

    def write(self, title, text):
        self.pages += ["=== " + title, text, ""]


@pytest.fixture
def book(kept, request):
    made = Book()
    yield made
    kept(request.node.name.removeprefix("test_") + ".txt", "\n".join(made.pages[:-1]))


def measure():
    assert bpy.ops.object.body_moments_measure() <= {"FINISHED", "CANCELLED"}
    bpy.context.view_layer.update()


def solid(name="Body", **place):
    """A box of 1 m, 2 m and 4 m."""
    return add(box_mesh(1, 2, 4), name, **place)


def store_findings(obj, *findings):
    from body_moments.operators.write import properties

    obj["body_findings"] = properties.findings_text(findings)


def test_body(book):
    book.draw("No object", "", "inertia", "density", "given", "bones", "section", "MATERIAL_PT_body_moments")
    obj = solid(location=(1, 0, 0), rotation=(0.0, 0.0, np.pi / 2))
    book.draw("Not measured", "")
    measure()
    book.draw("Measured", "")
    book.draw("Measured, narrow", "", context=NARROW)
    book.draw("Measured, very narrow", "", context=Context(100))
    book.draw("Measured, wide, high resolution", "", context=Context(900, 2.0))
    book.draw("Measured, high resolution", "", context=Context(480, 2.0))
    book.draw("Measured, a region that is not drawn", "", context=Context(None))
    bpy.context.scene.body_moments.frame = "OBJECT"
    book.draw("Object frame", "")
    obj.location.x = 2.0
    book.draw("Moved", "")
    obj.location.x = 1.0
    obj.body_moments.material = "Copper"
    book.draw("Another material", "")
    book.draw("Another material, narrow", "", context=NARROW)
    obj["body_method"] = "guess"
    book.draw("A method of another version", "")
    bpy.ops.object.body_moments_clear()
    obj.body_moments.density = 2000.0
    book.draw("Cleared, custom density", "")


def test_findings(book):
    obj = solid()
    measure()
    found = (
        finding("t_junctions", count=3),
        finding("flipped_faces", count=2),
        finding("overlap_unchecked", count=2),
        finding("no_faces"),
        finding("density_defaulted", accepted=True),
    )
    store_findings(obj, *found)
    book.draw("Findings of each severity", "")
    book.draw("Findings, narrow", "", context=NARROW)
    book.draw("Findings, closed", "", closed=("body_moments_warnings", "body_moments_notes"))
    from body_moments.panels import remedies

    for code in remedies.REMEDIES:
        layout = Layout()
        remedies.remedies(layout, Context(), SimpleNamespace(code=code))
        book.write(code, layout.text())
    bpy.ops.curve.primitive_bezier_circle_add()
    layout = Layout()
    remedies.remedies(layout, Context(), SimpleNamespace(code="holes_capped"))
    book.write("holes_capped of a curve", layout.text())


def test_repaired(book):
    add(boxes(2.0, 1.0, reverse=[0]))
    measure()
    book.draw("A flipped face, a cavity that is not one", "", "selection")
    bpy.ops.object.body_moments_accept(code="flipped_faces", accepted=True)
    book.draw("A finding accepted", "")
    add(strip_mesh())
    measure()
    book.draw("A strip that cannot be closed", "", "selection")
    opened = bpy.data.meshes.new("Open")
    closed = box_mesh(1, 2, 4)
    opened.from_pydata([v.co for v in closed.vertices], [], [tuple(f.vertices) for f in closed.polygons][1:])
    add(opened)
    measure()
    book.draw("A box without a face", "")


def test_refused(book):
    wire = bpy.data.meshes.new("Wire")
    wire.from_pydata([(0, 0, 0), (1, 0, 0)], [(0, 1)], [])
    obj = add(wire)
    measure()
    book.draw("Refused", "")
    obj.data = box_mesh(1, 2, 4)
    measure()
    obj.body_moments.density_from, obj.body_moments.density_polynomial = "POLYNOMIAL", "-1"
    measure()
    book.draw("Refused again", "")
    book.draw("Refused again, narrow", "", context=NARROW)
    bpy.ops.wm.body_moments_dismiss()
    book.draw("Dismissed", "")
    from body_moments.operators.session import outcome

    outcome.remember("Match Pose", [finding("no_volume", object="Other {:d}".format(i)) for i in range(10)])
    for width in (250, 265, 300):
        book.draw("Ten refusals of others, of {:d} pixels".format(width), "", context=Context(width))
    outcome.remember("Match Pose", [finding("no_volume", object="Body")])
    book.draw("One refusal, of this object", "")
    outcome.remember("Match Pose", [finding("no_volume", object="Other")])
    book.draw("One refusal, of another object", "")
    outcome.remember("Match Pose", [finding("no_faces")])
    book.draw("One refusal, of no object", "")


def test_live(book, monkeypatch):
    from body_moments.operators.session import live

    obj = solid()
    measure()
    bpy.ops.object.body_moments_live()
    now = SimpleNamespace(**vars(live.current_numbers(obj)) | {"seconds": 0.0125})
    monkeypatch.setattr(live, "current_numbers", lambda _: now)
    for lag in live.Lag:
        monkeypatch.setattr(live, "lag", lambda _, lag=lag: lag)
        book.draw("Live: {:s}".format(lag.name), "", "advanced")
    monkeypatch.setattr(live, "is_stale", lambda *_: True)
    book.draw("Live, other settings", "")
    now.measurement, now.refusal = None, finding("no_volume")
    book.draw("Live refuses", "")


def test_units(book):
    obj = solid(scale=(2, 2, 2))
    measure()
    book.draw("Eight meters?", "")
    for width in (184, 250, 265, 330):
        book.draw("Eight meters? Of {:d} pixels".format(width), "", context=Context(width))
    bpy.ops.scene.body_moments_keep_units()
    book.draw("Answered", "")
    scene = bpy.context.scene
    scene.body_moments.units_answered = False
    scene.unit_settings.scale_length = 0.5
    measure()
    book.draw("A scale that is not one", "")
    scene.unit_settings.scale_length = 2.0
    measure()
    book.draw("A scale of two", "")
    scene.unit_settings.scale_length = 1.0
    for scale, density in ((1.2, 9000.0), (1.3, 5.0), (1.25, 6399.0), (1.25, 6400.0)):  # 5 m and 100 t are large enough
        obj.scale, obj.body_moments.density = (scale,) * 3, density
        measure()
        book.draw("Scale {:g}, density {:g}".format(scale, density), "")
    scene.unit_settings.system = "IMPERIAL"
    measure()
    book.draw("Imperial", "", "inertia", "density")


def test_inertia(book):
    obj = solid(location=(1, 2, 3))
    book.draw("Not measured", "inertia")
    measure()
    book.draw("Measured", "inertia")
    book.draw("Narrow", "inertia", context=NARROW)
    book.draw("Tensor closed", "inertia", closed=("body_moments_tensor",))
    for title, size in (("Equal 2, 3", (2, 2, 4)), ("Equal 1, 2", (1, 4, 4)), ("All equal", (2, 2, 2))):
        obj.data = box_mesh(*size)
        measure()
        book.draw(title, "inertia")


def test_reference(book):
    obj, other = solid(), add(None, "Other", location=(1, 0, 0))
    only(obj)
    book.draw("Not measured", "reference")
    measure()
    settings = bpy.context.scene.body_moments_reference
    for about in ("ORIGIN", "WORLD", "CURSOR", "OBJECT", "AXIS"):
        if about in settings.bl_rna.properties["about"].enum_items:
            settings.about = about
            settings.object = other
            book.draw(about, "reference")
    book.draw("Axis, narrow", "reference", context=NARROW)
    settings.second = settings.first
    book.draw("No axis", "reference")


def test_density(book):
    obj = solid()
    settings = obj.body_moments
    book.draw("One value", "density")
    book.draw("One value, narrow", "density", context=NARROW)
    settings.kind = "SHELL"
    book.draw("Shell", "", "density")
    settings.wall = "INWARD"
    measure()
    book.draw("Wall", "", "density")
    settings.thickness = 0.6
    book.draw("Wall that folds", "density")
    settings.kind, settings.mass_from = "SOLID", "MASS"
    book.draw("Given mass", "", "density", "given")
    settings.use_center = settings.use_inertia = True
    book.draw("Given mass, center and inertia", "given")
    settings.mass_from = "DENSITY"
    for source in ("POLYNOMIAL", "ATTRIBUTE", "VOLUME", "MATERIALS"):
        settings.density_from = source
        book.draw(source, "", "density")
    for name in ("Steel", "Cork"):
        obj.data.materials.append(bpy.data.materials.new(name))
    obj.data.materials.append(bpy.data.materials["Cork"])
    obj.data.materials.append(None)
    book.draw("Two materials", "density")
    book.draw("Two materials, narrow", "density", context=NARROW)
    settings.density_from, settings.density_polynomial = "POLYNOMIAL", "900 + z"
    measure()
    book.draw("Mean of a polynomial", "")
    bpy.ops.curve.primitive_nurbs_circle_add()
    book.draw("Curve", "density")
    settings = bpy.context.object.body_moments
    settings.density_from = "ATTRIBUTE"
    book.draw("Attribute of a curve", "density")
    settings.kind = "WIRE"
    measure()
    book.draw("Wire", "", "density", "advanced", "selection")
    settings.mass_from = "MASS"
    book.draw("Wire of a mass", "", "density")
    bpy.data.meshes.new("Mesh")
    add(bpy.data.objects[0].data).body_moments.kind = "WIRE"
    book.draw("A mesh set to wire", "density")
    scene = bpy.context.scene
    scene.body_moments.default_material, scene.body_moments.density_unit = "Copper", "G_CM3"
    solid()
    book.draw("Default material, g/cm³", "", "density")


def test_grid(book, tmp_path):
    obj = volume_object(tmp_path / "a.vdb", vdb_grid(np.ones((4, 4, 4), np.float32)))
    only(obj)
    settings = obj.body_moments
    book.draw("Density", "", "density")
    measure()
    book.draw("Measured", "", "advanced")
    settings.values_from = "TABLE"
    book.draw("Table", "density")
    settings.mass_from = "MASS"
    book.draw("Mass", "", "density")
    settings.sample_positions = "0 1 2 3" if isinstance(settings.sample_positions, str) else True
    book.draw("Positions", "density")
    settings.grid_as = "SOLID"
    book.draw("Solid of a mass", "", "density")
    settings.mass_from = "DENSITY"
    settings.density_from = "MATERIALS"
    book.draw("Solid of a density", "", "density")
    settings.grid_as = "THRESHOLD"
    for fill in [item.identifier for item in settings.bl_rna.properties["threshold_fill"].enum_items]:
        settings.threshold_fill = fill
        book.draw("Threshold, " + fill, "", "density")


def test_damaged_numbers(book):
    obj = solid()
    measure()
    bpy.ops.object.body_moments_stability()
    obj["body_center_of_mass"] = "gone"
    book.draw("A body", "", "inertia", "stability", "selection", "shape", "advanced")
    obj["body_center_of_mass"] = [0.0, 0.0, 0.0]
    bpy.context.scene.gravity = (0.0, 0.0, 0.0)
    book.draw("Without gravity", "stability")
    obj.scale = (1, 1, 0)
    book.draw("Flattened", "stability")
    armature, _ = character()
    bpy.ops.object.body_moments_measure_bones()
    armature.data.bones.active = armature.data.bones["head"]
    armature.pose.bones["head"]["body_mass"] = "gone"
    armature["body_inertia_diagonal"] = "gone"
    book.draw("Bones", "", "bones", "BONE_PT_body_moments")
    rounded = add(bpy.data.meshes.new("Ball"), "Ball")
    rounded.body_moments.mass_from, rounded.body_moments.mass = "MASS", 1.0
    book.draw("Nothing", "", "inertia", "selection")


def test_objects(book):
    for kind, data in (
        ("Camera", bpy.data.cameras.new("C")),
        ("Armature", bpy.data.armatures.new("A")),
        ("Empty", None),
    ):
        add(data, kind)
        book.draw(kind, "", "density", "given", "section", "inertia")
    point = empty(bpy.context.scene.collection, "Point", mass=2.0)
    only(point)
    book.draw("Point mass", "", "given")
    instancer = add(None, "Instancer")
    instancer.instance_type, instancer.instance_collection = "COLLECTION", bpy.data.collections.new("Parts")
    book.draw("Instancer", "", "density", "given")
    bpy.ops.surface.primitive_nurbs_surface_sphere_add()
    measure()
    book.draw("NURBS surface", "", "advanced")
    book.draw("NURBS surface, closed", "advanced", closed=("body_moments_bounds", "body_moments_display_mesh"))


def test_apply(book):
    obj = solid()
    book.draw("Without a rigid body", "apply", "advanced")
    book.draw("Narrow", "apply", "advanced", context=NARROW)
    bpy.ops.rigidbody.object_add()
    assert obj.rigid_body
    book.draw("With a rigid body", "apply")


def test_stability(book):
    obj = add(wedge(), location=(1, 2, 0), scale=(1, 4, 1))
    book.draw("Unknown", "stability")
    measure()
    bpy.ops.object.body_moments_stability()
    book.draw("Tips over", "stability")
    obj.rotation_euler.y = np.arctan2(2.0, 1.5)  # on its leaning side
    book.draw("Stands", "stability")
    book.draw("Narrow", "stability", context=NARROW)
    obj.data.vertices[0].co.x -= 1.0
    obj.data.update()
    book.draw("Stale", "stability")
    cylinder = bpy.ops.mesh.primitive_cylinder_add(vertices=7)
    assert cylinder == {"FINISHED"}
    bpy.context.scene.unit_settings.scale_length = 0.001
    measure()
    bpy.ops.object.body_moments_stability()
    book.draw("Nine poses", "stability")


def test_selection(book):
    first = solid("First")
    book.draw("Nothing measured", "selection")
    measure()
    book.draw("One", "selection")
    second, strip = solid("Second", location=(4, 0, 0)), add(strip_mesh(), "Strip", location=(0, 0, 8))
    capped = add(boxes(2.0, reverse=[0]), "Flipped", location=(0, 9, 0))
    for obj in (second, strip, capped):
        only(obj)
        measure()
    unmeasured = solid("Not yet")
    only(first, second)
    second.body_moments.density = 500.0
    book.draw("Two, of which one is out of date", "selection")
    only(first, second, strip, capped, unmeasured)
    book.draw("All", "selection")
    book.draw("All, narrow", "selection", context=NARROW)
    mass, first["body_mass"] = first["body_mass"], 0.0
    only(first)
    book.draw("One whose stored mass was changed to nothing", "selection")
    first["body_mass"] = mass
    layout, listed = Layout(), bpy.types.BODY_MOMENTS_UL_measured
    listed.draw_filter(SimpleNamespace(bl_rna=listed.bl_rna), bpy.context, layout)
    book.write("What filters", layout.text())
    layout = Layout()
    cls = SimpleNamespace(bl_rna=listed.bl_rna, filter_name="", sort_by="NAME", warnings_first=False)
    cls.bitflag_filter_item = 1 << 30
    for settings in ({}, {"filter_name": "t"}, {"sort_by": "VERDICT"}, {"warnings_first": True}):
        vars(cls).update(settings)
        flags, order = listed.filter_items(cls, bpy.context, bpy.context.view_layer, "objects")
        layout.write(repr(settings), repr([flag >> 30 for flag in flags]), repr(list(order)))
    book.write("Filters", layout.text())


def test_assembly(book):
    from body_moments.operators.write import properties

    root = assembly_of_boxes()
    book.draw("No assembly yet", "assembly", "COLLECTION_PT_body_moments")
    out = box(root, (1, 1, 1), name="out")
    out.hide_render = True
    only(bpy.data.objects["b0"])
    bpy.ops.object.body_moments_measure_assembly()
    book.draw("Measured", "assembly")
    book.draw("Narrow", "assembly", context=NARROW)
    settings = root.body_moments
    settings.active_row = list(settings.rows.keys()).index("out")
    book.draw("A member that is left out", "assembly")
    found = finding("no_faces"), finding("t_junctions", count=3)
    for title, order in (("first", found), ("last", found[::-1])):
        settings.rows["out"].findings = properties.findings_text(order)
        book.draw("A member with two findings, the worst one " + title, "assembly")
    first = settings.rows[0]
    first.findings, settings.active_row = properties.findings_text(found[:1]), 0
    book.draw("The first member, with a finding", "assembly")
    first.findings = ""
    mass, root["body_mass"] = root["body_mass"], "gone"
    book.draw("Damaged numbers", "assembly")
    root["body_mass"], method, root["body_method"] = mass, root["body_method"], "exact"
    book.draw("Numbers of something else", "assembly")
    root["body_method"] = method
    settings.active_row = len(settings.rows)
    settings.rows["Arm"].is_open = False
    book.draw("No active row", "assembly")
    names = SimpleNamespace(filter_name="", bitflag_filter_item=1)
    for name in ("", "B", "arm"):
        names.filter_name = name
        flags = bpy.types.BODY_MOMENTS_UL_assembly.filter_items(names, bpy.context, settings, "rows")
        book.write("Filter “{:s}”".format(name), "{} {}".format(list(settings.rows.keys()), flags))
    settings.mass_from, settings.use_center = "MASS", True
    book.draw("Given mass", "assembly")
    bpy.data.objects["b1"].location.x = 9.0
    book.draw("A member moved", "assembly")
    parent = empty(bpy.context.scene.collection, "Arm Empty", at=(1, 0, 0))
    solid("Child").parent = parent
    only(parent)
    bpy.context.view_layer.update()
    bpy.ops.object.body_moments_measure_assembly(target="OBJECT")
    book.draw("An empty with a child", "assembly")


def test_bones(book):
    armature, skin = character()
    book.draw("Not measured", "", "bones", "BONE_PT_body_moments")
    bpy.ops.object.body_moments_measure_bones()
    armature.data.bones.active = armature.data.bones["head"]
    book.draw("Measured", "", "bones", "BONE_PT_body_moments")
    settings = armature.pose.bones["head"].body_moments
    for source in ("DENSITY", "MASS"):
        settings.mass_from = source
        book.draw(source, "BONE_PT_body_moments")
    skin.body_moments.density = 5.0
    book.draw("Out of date", "bones", "BONE_PT_body_moments")
    from body_moments.panels import bones

    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(bones, "LISTED", 2)
        book.draw("More bones than are listed", "bones")
    armature.data.bones.active = None
    book.draw("No active bone", "BONE_PT_body_moments")
    bpy.ops.object.mode_set(mode="POSE")
    book.draw("Posed", "")
    bpy.ops.object.mode_set(mode="OBJECT")
    only(skin)
    measure()
    only(armature)
    bpy.ops.object.mode_set(mode="POSE")
    book.draw("Posed, the skin measured", "")
    mass, skin["body_mass"] = skin["body_mass"], 0.0
    book.draw("Posed, the stored mass changed to nothing", "")
    skin["body_mass"] = mass
    skin.body_moments.kind = "SHELL"
    damaged = add(box_mesh(1, 2, 4), "Damaged", select=False)
    damaged.parent, damaged.parent_type, damaged["body_mass"] = armature, "ARMATURE", 1.0
    book.draw("Posed, the skin out of date, another mesh with damaged numbers", "")
    bpy.ops.object.mode_set(mode="OBJECT")


def test_moments(book):
    obj = solid(location=(1, 0, 0))
    settings = bpy.context.scene.body_moments
    book.draw("Not computed", "orders")
    settings.moments_order = 2
    bpy.ops.object.body_moments_compute_moments()
    book.draw("To order 2", "orders")
    book.draw("Narrow", "orders", context=NARROW)
    for of in [item.identifier for item in settings.bl_rna.properties["moments_of"].enum_items][1:]:
        settings.moments_of = of
        book.draw(of, "orders")
    settings.moments_about, settings.moments_of = "REFERENCE", "VOLUME"
    bpy.context.scene.body_moments_reference.about = "OBJECT"
    book.draw("About no object", "orders")
    settings.moments_about, settings.moments_order = "CENTER", 6
    bpy.ops.object.body_moments_compute_moments()
    book.draw("To order 6", "orders")
    obj.location.x = 2.0
    book.draw("Moved", "orders")


def test_section(book):
    from body_moments.operators.write import properties

    add(flat_mesh(I_BEAM), "Beam")
    book.draw("Not measured", "section")
    bpy.ops.object.body_moments_measure_section()
    book.draw("An I beam", "section")
    book.draw("Closed", "section", closed=("body_moments_section_moduli", "body_moments_section_bounds"))
    book.draw("Narrow", "section", context=NARROW)
    bpy.context.object.data.vertices[0].co.x += 0.5
    bpy.context.object.data.update()
    book.draw("Edited", "section")
    bpy.context.object["body_section"]["findings"] = properties.findings_text((finding("flipped_faces", count=2),))
    book.draw("Warned of", "section")
    add(curve_of(square(0, 0, 4), square(1, 1, 1)[::-1], square(2, 2, 1)[::-1], square(6, 6, 1)), "Curve")
    bpy.ops.object.body_moments_measure_section()
    book.draw("A square with two holes, and a square", "section")
    add(flat_mesh(square(-1, -1, 2)), "Square")
    bpy.ops.object.body_moments_measure_section()
    book.draw("A square", "section")
    add(flat_mesh(square(-2000, -1999.99, 4000)), "Large")
    bpy.ops.object.body_moments_measure_section()
    book.draw("A large square, not quite in the middle", "section")
    add(flat_mesh(square(0, 0, 0.1)), "Small")
    bpy.ops.object.body_moments_measure_section()
    book.draw("A small square", "section")


def test_shape(book):
    solid()
    book.draw("Nothing looked for", "shape")
    bpy.ops.object.body_moments_find_symmetry()
    book.draw("A box", "shape")
    book.draw("Narrow", "shape", context=NARROW)
    book.draw("Closed", "shape", closed=("body_moments_symmetry",))
    bpy.context.object.scale.x = 2.0
    book.draw("Stretched", "shape")
    bpy.context.object.scale.x = 1.0
    stored = bpy.context.object.body_moments_symmetry
    stored.compatible, stored.of_display_mesh = "D4h", True
    for index in range(10):
        element = stored.elements.add()
        element.kind, element.direction = ("AXIS", "PLANE", "ROUND")[index % 3], (0, 0.6, -0.8)
        element.order = index
    book.draw("Of a display mesh, with more elements", "shape")
    search = bpy.context.scene.body_moments_search
    search.wanted = "Body"
    book.draw("Nothing found", "shape")
    from body_moments.panels import shape

    for index, verdict in enumerate([*shape.ICONS, "of the future"]):
        found = search.found.add()
        found.name, found.verdict, found.scale, found.distance = "Shape", verdict, 1.5, 0.25 * index
    book.draw("Found", "shape")
    search.looked_at = "library.blend"
    for index in range(4):
        search.found.add().name = "More {:d}".format(index)
    book.draw("Found in a library", "shape")
    book.draw("Found, closed", "shape", closed=("body_moments_similar",))


def test_materials(book):
    made = bpy.data.materials.new("Steel")
    obj = solid()
    obj.data.materials.append(made)
    context = Context(material=made)
    book.draw("No density", "MATERIAL_PT_body_moments", context=context)
    made.body_moments.density = 7820.0
    book.draw("A density", "MATERIAL_PT_body_moments", context=context)
    made.body_moments.material = "Copper"
    book.draw("Of the table", "MATERIAL_PT_body_moments", context=context)
    from body_moments.panels.material_menus import CATEGORY_MENUS, OBJECT_MT_body_moments_materials

    for title, target in (("objects", None), ("a material", made)):
        for cls in (OBJECT_MT_body_moments_materials, CATEGORY_MENUS[-1]):
            layout = Layout()
            cls.draw(SimpleNamespace(layout=layout, bl_label=cls.bl_label), Context(body_moments_material=target))
            book.write("{:s}, of {:s}".format(cls.bl_label, title), layout.text())


def test_menus(book):
    from body_moments.panels import body, material_menus, menus
    from body_moments.panels.overlay import popover

    obj = solid()
    context = Context(mode="OBJECT", space_data=SimpleNamespace(overlay=SimpleNamespace(show_overlays=True)))

    def draw(title, function, context):
        layout = Layout()
        with region(context):
            function(SimpleNamespace(layout=layout), context)
        book.write(title, layout.text())

    draw("Body Moments", menus.VIEW3D_MT_body_moments.draw, context)
    for place, function in menus.ADDED:
        draw(place, function, context)
        draw(place + ", in Edit Mode", function, Context(mode="EDIT_MESH"))
    bpy.ops.rigidbody.object_add()
    draw("PHYSICS_PT_rigid_body of a rigid body", menus._rigid_body_panel, context)
    draw("PHYSICS_PT_rigid_body without an object", menus._rigid_body_panel, Context(object=None))
    for paths in ([], ["presets"]):
        with pytest.MonkeyPatch.context() as patched:
            patched.setattr(bpy.utils, "preset_paths", lambda _, paths=paths: paths)
            layout, cls = Layout(), material_menus.OBJECT_PT_body_moments_presets
            names = ("bl_label", "preset_subdir", "preset_operator", "preset_add_operator")
            shown = SimpleNamespace(layout=layout, **{name: getattr(cls, name) for name in names})
            shown.path_menu = lambda *given, layout=layout, **options: layout.write("path_menu", repr(given), *options)
            cls.draw(shown, bpy.context)
            book.write("Presets in {}".format(paths), layout.text())
    draw("Overlays", popover.section, context)
    context.space_data.overlay.show_overlays = bpy.context.scene.body_moments.overlay.show = False
    draw("Overlays switched off", popover.section, context)
    draw("Header", body.VIEW3D_PT_body_moments.draw_header_preset, context)
    assert obj.rigid_body


def test_preferences(book):
    from body_moments.operators.settings.preferences import BodyMomentsPreferences as Preferences

    for material in ("NONE", "CUSTOM"):
        layout = Layout()
        shown = SimpleNamespace(bl_rna=Preferences.bl_rna, layout=layout, default_material=material)
        Preferences.draw(shown, bpy.context)
        book.write(material, layout.text())


def test_german(book, monkeypatch):
    from body_moments.operators.write import translations

    texts = translations.dictionary()["de_DE"]
    look_up = SimpleNamespace(pgettext_iface=lambda text, context="*": texts.get((context, text), text))
    monkeypatch.setattr(translations, "bpy", SimpleNamespace(app=SimpleNamespace(translations=look_up)))
    add(boxes(2.0, reverse=[0]), scale=(1, 2, 4))
    measure()
    bpy.ops.object.body_moments_find_symmetry()
    names = ("", "inertia", "density", "stability", "selection", "assembly", "advanced", "orders", "section", "shape")
    book.draw("A box with a flipped face", *names)
    book.draw("Narrow", *names, context=NARROW)
