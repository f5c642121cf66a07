# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What follows from settings, each changed alone in each state, kept as text; grids, given parts, options, copies."""

import re
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from body_moments.core.scans.positions import EVEN
from body_moments.core.verdict.finding import MeasureError, finding
from body_moments.operators.read.fingerprint import settings_hash
from body_moments.operators.settings import accepted, density, digest, hooks, preferences, properties
from body_moments.operators.settings.given import GIVEN_PROPERTIES, GivenPart, is_point_mass
from body_moments.operators.settings.grid import GridOptions, positions_text
from body_moments.operators.settings.options import MeasureOptions

from tests.blender.findings import refused
from tests.blender.objects import add, mesh_body

pytestmark = pytest.mark.usefixtures("scene")
STATES = {
    "one value": {},
    "one value that is set": {"density": 7000.0},
    "materials": {"density_from": "MATERIALS"},
    "polynomial": {"density_from": "POLYNOMIAL", "density_polynomial": " 900 + x "},
    "coefficients, world": {
        "density_from": "POLYNOMIAL",
        "density_polynomial": "900, 1",
        "density_frame": "WORLD",
    },
    "attribute": {"density_from": "ATTRIBUTE", "density_attribute": "rho"},
    "no attribute": {"density_from": "ATTRIBUTE"},
    "volume": {"density_from": "VOLUME"},
    "mass": {"mass_from": "MASS", "mass": 2.0, "use_center": True},
    "mass, polynomial": {"mass_from": "MASS", "density_from": "POLYNOMIAL", "density_polynomial": "900 + x"},
    "wire": {"kind": "WIRE"},
    "shell": {"kind": "SHELL", "thickness": 0.1},
    "wall": {"kind": "SHELL", "wall": "INWARD"},
}
GRIDS = {
    "density": {},
    "table": {"values_from": "TABLE", "spline_order": 2},
    "solid": {"grid_as": "SOLID"},
    "threshold": {"grid_as": "THRESHOLD", "threshold": 0.3, "threshold_fill": "MATERIAL"},
    "threshold, filled": {"grid_as": "THRESHOLD", "threshold": 0.3, "threshold_fill": "GRID"},
    "positions": {"sample_positions": '{"x":[0.0,1.5,3.0]}', "value_density": 2.5, "grid": "density"},
    "mass": {"mass_from": "MASS", "use_inertia": True},
}
OTHERS = {"STRING": "900 + 2*y", "FLOAT": 0.7, "INT": 3, "BOOLEAN": True}


def changes(settings):
    """Each setting with another value."""
    for prop in settings.bl_rna.properties:
        if prop.identifier in ("rna_type", "name") or prop.identifier.startswith("density_") and prop.type == "FLOAT":
            continue
        if prop.type == "ENUM":
            now = getattr(settings, prop.identifier)
            yield prop.identifier, next(item.identifier for item in prop.enum_items if item.identifier != now)
        elif prop.type in OTHERS:
            value = OTHERS[prop.type]
            yield prop.identifier, [value] * prop.array_length if getattr(prop, "is_array", False) else value


def set_up(kind, state):
    """An object in no scene, with these settings."""
    if kind == "VOLUME":
        obj = bpy.data.objects.new("Cloud", bpy.data.volumes.new("Cloud"))
    else:
        obj = bpy.data.objects.new("Body", bpy.data.meshes.new("Body"))
        for name in ("Steel", "Nothing"):
            obj.data.materials.append(bpy.data.materials.get(name) or bpy.data.materials.new(name))
        bpy.data.materials["Steel"].body_moments.density = 7800.0
    for name, value in state.items():
        setattr(obj.body_moments, name, value)
    if state.get("density_from") == "VOLUME":
        fog = bpy.data.objects.get("Fog") or bpy.data.objects.new("Fog", bpy.data.volumes.new("Fog"))
        obj.body_moments.density_volume = fog
    return obj


def said(get, *arguments):
    try:
        found = get(*arguments)
    except MeasureError as error:
        return "refused: " + error.finding.code
    return repr(found)


@pytest.mark.parametrize(("kind", "states"), [("MESH", STATES), ("VOLUME", GRIDS)])
def test_each_setting_changed_alone(kept, kind, states, monkeypatch, scene):
    called, lines = [], []
    for name in (name for name in vars(hooks) if name.startswith("on_")):
        monkeypatch.setattr(hooks, name, [lambda *_, name=name: called.append(name.removeprefix("on_"))])
    for title, state in states.items():
        obj = set_up(kind, state)
        settings = obj.body_moments
        found = said(density.density_field, settings)
        lines += ["=== " + title, "density key: " + digest.density_key(obj, ["Used"], scene)]
        lines.append("field: " + re.sub(r"polynomial=Polynomial\(.*?\), in", "polynomial=…, in", found))
        lines.append("density: {!r}".format(density.object_density(settings, scene)))
        lines.append("anchor: {!r}".format(density.density_anchor(obj)))
        if kind == "VOLUME":
            options = GridOptions.of(settings)
            lines += [repr(options), repr(options.key), options.meaning().code, repr(options.meaning().values)]
        for name, other in list(changes(settings)):
            again = set_up(kind, state)
            before = digest.density_key(again, ["Used"], scene), settings_hash(again, scene)
            called.clear()
            setattr(again.body_moments, name, other)
            now = digest.density_key(again, ["Used"], scene), settings_hash(again, scene)
            marks = [mark for mark, old, new in zip(("density key", "settings"), before, now) if old != new]
            lines.append("    {:s}: {:s}; calls {:s}".format(name, ", ".join(marks) or "-", ", ".join(called) or "-"))
            bpy.data.batch_remove([again.data, again])
    kept("each_setting_of_a_{:s}.txt".format(kind.lower()), "\n".join(lines))


def test_where_a_polynomial_density_comes_from_says_whose_coordinates_are_meant():
    for frame, text, code in (("OBJECT", " 900 + x", "polynomial"), ("WORLD", "900, 1 ", "coefficients")):
        settings = set_up("MESH", {"density_from": "POLYNOMIAL", "density_polynomial": text, "density_frame": frame})
        found = density.density_field(settings.body_moments).polynomial_source()
        assert found == finding("density_from_" + code, polynomial=text.strip(), frame=frame.lower())


def test_what_other_settings_call(monkeypatch, scene):
    called = []
    for name in (name for name in vars(hooks) if name.startswith("on_")):
        monkeypatch.setattr(hooks, name, [lambda *_, name=name: called.append(name)])
    scene.body_moments.default_material = "Copper"
    assert called == ["on_default_density_change"]
    called.clear()
    bpy.data.collections.new("Parts").body_moments.use_center = True
    assert called == ["on_change", "on_part_change"]


def test_densities_that_nobody_has_set(scene):
    settings = add(mesh_body()).body_moments
    assert density.object_density(settings, scene) == 1000.0 and density.is_density_unset(settings, scene)
    scene.body_moments.default_material = "Copper"
    assert density.object_density(settings, scene) == 8960.0 and not density.is_density_unset(settings, scene)
    settings.density = 0.1
    assert density.object_density(settings, scene) == 0.1 and not density.is_density_unset(settings, scene)
    made = bpy.data.materials.new("Steel")
    assert density.material_density(None) is None and density.material_density(made) is None
    made.body_moments.density = 0.1
    assert density.material_density(made) == 0.1


def test_values_of_grids_become_densities():
    values = np.array([-1.0, 0.0, 2.0, 7.0])
    plain = GridOptions(value_density=3.0)
    assert plain.to_densities(None)(values[1:]).tolist() == [0.0, 6.0, 21.0]
    assert plain.to_densities(-1.0)(values).tolist() == [0.0, 0.0, 6.0, 21.0]
    with refused("values_negative", density=-3.0):
        plain.to_densities(7.0)(values)
    table = GridOptions(table="0 10, 4 30")
    assert table.to_densities(2.0)(values).tolist() == [10.0, 10.0, 0.0, 30.0]
    with refused("values_non_finite_for_table"):
        table.to_densities(None)(np.array([0.0, np.nan]))
    for options, background, noted in (
        (plain, 2.0, True),
        (plain, 0.0, False),
        (plain, None, False),
        (table, 2.0, True),
    ):
        notes = options.empty_background_note(background)
        assert [(one.code, one.values) for one in notes] == [("background_empty", {"value": 2.0})] * noted
    assert GridOptions(value_density=0.0).empty_background_note(2.0) == ()
    assert plain.empty_background_note(np.inf) == () and GridOptions(table="0 0, 4 30").empty_background_note(0.0) == ()
    for order, code in ((1, "values_scaled"), (2, "values_scaled_spline")):
        assert GridOptions(spline_order=order, value_density=2.0).meaning().code == code
        assert GridOptions(spline_order=order, table="0 1").meaning().code == code.replace("scaled", "by_table")
    assert GridOptions.of(add(bpy.data.volumes.new("Cloud")).body_moments, 0.25).value_density == 0.25
    tabled = set_up("VOLUME", {"values_from": "TABLE"}).body_moments
    assert GridOptions.of(tabled).table and not GridOptions.of(tabled, 1.0).table


def test_positions_of_samples():
    rows = (np.array([0.0, 1.0, 4.0]), None, np.array([0.0, 2.0]))
    text = positions_text(rows)
    assert text == '{"x":[0.0,0.5,2.0],"z":[0.0,1.0]}' and positions_text(EVEN) == ""
    options = GridOptions(sample_positions=text)
    x, y, z = options.positions("rho", np.array([0, 5, 0]), (3, 9, 2))
    assert x.tolist() == [0.0, 0.5, 2.0] and y is None and z.tolist() == [0.0, 1.0]
    assert GridOptions().positions("rho", np.zeros(3, int), (1, 1, 1)) == EVEN
    for low, shape in (((0, 0, 0), (4, 1, 1)), ((-1, 0, 0), (2, 1, 1)), ((1, 0, 0), (3, 1, 1)), ((0, 0, 2), (1, 1, 1))):
        with refused("positions_of_other_samples", grid="rho"):
            options.positions("rho", np.array(low), shape)
    for damaged in (
        "[",
        "[1]",
        '{"x":1}',
        '{"x":[0]}',
        '{"x":[0,0]}',
        '{"x":[1,0]}',
        '{"x":[0,NaN]}',
        '{"x":[0,Infinity]}',
    ):
        with refused("positions_damaged", grid="rho"):
            GridOptions(sample_positions=damaged).positions("rho", np.zeros(3, int), (1, 1, 1))
    GridOptions().needs_even_samples("rho")
    with refused("positions_only_as_density", grid="rho"):
        options.needs_even_samples("rho")


def test_given_parts():
    obj = add(None)
    settings = obj.body_moments
    settings.given_center, settings.given_inertia_diagonal = (0.1, 0.2, 0.3), (1.1, 2.2, 3.3)
    settings.given_inertia_products = (0.4, 0.5, 0.6)
    nothing = GivenPart.of(settings, 0.5)
    assert not nothing and nothing.key == ""
    settings.use_center = True
    center = GivenPart.of(settings, 0.5)
    assert center and center.center.tolist() == [0.05, 0.1, 0.15] and center.inertia is None
    settings.use_inertia = True
    both = GivenPart.of(settings, 0.5)
    assert both.inertia.tolist() == [[1.1, 0.4, 0.5], [0.4, 2.2, 0.6], [0.5, 0.6, 3.3]]
    assert len({nothing.key, center.key, both.key}) == 3
    settings.use_center = False
    assert GivenPart.of(settings, 0.5)
    assert not is_point_mass(obj)
    settings.mass_from = "MASS"
    assert is_point_mass(obj)
    obj.instance_type, obj.instance_collection = "COLLECTION", bpy.data.collections.new("Parts")
    assert not is_point_mass(obj)
    obj.instance_type = "NONE"
    assert is_point_mass(obj)
    mesh = add(mesh_body())
    mesh.body_moments.mass_from = "MASS"
    assert not is_point_mass(mesh)


def test_settings_are_copied_with_whether_they_are_set():
    source, target = add(mesh_body(), "Source").body_moments, add(mesh_body(), "Target").body_moments
    assert not properties.copy_settings(source, target) and not target.is_property_set("density")
    source.density = source.density  # set, to what it is by default
    assert not properties.copy_settings(source, target) and target.is_property_set("density")
    for name, other in list(changes(source)):
        if name in properties.COPIED_PROPERTIES:
            setattr(source, name, other)
            assert properties.copy_settings(source, target), name
            assert properties._comparable(getattr(target, name)) == properties._comparable(getattr(source, name))
            assert not properties.copy_settings(source, target), name
    assert {*GIVEN_PROPERTIES} < {*properties.COPIED_PROPERTIES}


def test_options_become_settings(scene):
    scene.unit_settings.scale_length = 0.5
    settings = add(mesh_body()).body_moments
    settings.mass_from, settings.density_from = "MASS", "MATERIALS"
    properties.apply_options(settings, MeasureOptions(), scene)
    assert (settings.kind, settings.mass_from, settings.density_from) == ("SOLID", "MASS", "MATERIALS")
    properties.apply_options(
        settings, MeasureOptions(kind="shell", density=5.0, thickness=0.25, overlap="union"), scene
    )
    assert (settings.kind, settings.overlap, settings.thickness, settings.density) == ("SHELL", "UNION", 0.5, 5.0)
    assert (settings.mass_from, settings.density_from) == ("DENSITY", "VALUE") and settings.linear_density == 1.0
    properties.apply_options(settings, MeasureOptions(kind="wire", density=7.0), scene)
    assert (settings.linear_density, settings.density) == (7.0, 5.0)
    properties.apply_options(settings, MeasureOptions(mass=3.0), scene)
    assert (settings.mass_from, settings.mass) == ("MASS", 3.0)
    grid = set_up("VOLUME", {"values_from": "TABLE"}).body_moments
    properties.apply_options(grid, MeasureOptions(density=4.0), scene)
    assert (grid.values_from, grid.value_density, grid.density) == ("FACTOR", 4.0, 4.0)
    point = add(None).body_moments
    point.mass_from, point.mass = "MASS", 2.0
    properties.apply_options(point, MeasureOptions(density=4.0), scene)
    assert (point.mass_from, point.mass) == ("MASS", 2.0) and not point.is_property_set("density")


def test_accepted_findings():
    obj, holes, junctions = add(mesh_body()), finding("holes_capped", count=1), finding("t_junctions", count=2)
    assert accepted.accepted_codes(obj) == frozenset()
    assert accepted.set_accepted(obj, "t_junctions", True) and accepted.set_accepted(obj, "holes_capped", True)
    assert obj.body_moments.accepted == "holes_capped t_junctions"
    assert not accepted.set_accepted(obj, "holes_capped", True)
    marked = accepted.with_acceptance([holes, junctions], accepted.accepted_codes(obj))
    assert [one.values.get("accepted") for one in marked] == [True, True]
    assert accepted.with_acceptance(marked, accepted.accepted_codes(obj)) == marked
    assert accepted.set_accepted(obj, "t_junctions", False) and not accepted.set_accepted(obj, "t_junctions", False)
    now = accepted.with_acceptance(marked, accepted.accepted_codes(obj))
    assert now == (marked[0], junctions)


def test_a_scene_gets_the_preferences_once_where_it_has_nothing_of_its_own(monkeypatch, scene):
    source = SimpleNamespace(show_overlay=False)
    values = {"frame": "OBJECT", "density_unit": "G_CM3", "digits": 9, "digit_grouping": "NONE"}
    vars(source).update(values, default_material="CUSTOM", default_density=50.0)
    monkeypatch.setattr(preferences, "preferences", lambda: source)
    assert {*values, "default_material", "default_density", "show_overlay"} == {*vars(source)}
    assert {*preferences.COPIED} == {*vars(source)} - {"show_overlay"}
    settings = scene.body_moments
    settings.digits = 3
    settings.overlay.show = True
    preferences.copy_defaults(scene)
    assert settings.has_defaults and settings.digits == 3 and settings.overlay.show
    for name in {*preferences.COPIED} - {"digits"}:
        assert getattr(settings, name) == getattr(source, name), name
    settings.property_unset("digits")
    settings.overlay.property_unset("show")
    preferences.copy_defaults(scene)
    assert not settings.is_property_set("digits") and not settings.overlay.is_property_set("show")
    settings.has_defaults = False
    preferences.copy_defaults(scene)
    assert settings.digits == 9 and settings.overlay.is_property_set("show") and not settings.overlay.show


def test_a_linked_scene_keeps_what_it_has(monkeypatch, scene, tmp_path):
    bpy.data.libraries.write(str(tmp_path / "a.blend"), {scene})
    with bpy.data.libraries.load(str(tmp_path / "a.blend"), link=True) as (there, here):
        here.scenes = there.scenes[:1]
    source = SimpleNamespace(
        show_overlay=False, **{name: getattr(scene.body_moments, name) for name in preferences.COPIED}
    )
    monkeypatch.setattr(preferences, "preferences", lambda: source)
    (linked,) = here.scenes
    preferences.copy_defaults(linked)
    assert linked.library is not None and not linked.body_moments.has_defaults
    preferences.copy_defaults(scene)
    assert scene.body_moments.has_defaults


def test_without_preferences_a_scene_stays_as_it_is(monkeypatch, scene):
    monkeypatch.setattr(preferences, "preferences", lambda: None)
    preferences.copy_defaults(scene)
    assert not scene.body_moments.has_defaults


def test_a_density_comes_from_volumes_alone(scene):
    poll = properties.BodyMomentsObjectSettings.__annotations__["density_volume"].keywords["poll"]
    assert poll(None, add(bpy.data.volumes.new("Cloud"))) and not poll(None, add(mesh_body()))


def test_preferences_are_those_of_the_add_on_where_it_is_one(monkeypatch):
    addons = {}
    context = SimpleNamespace(preferences=SimpleNamespace(addons=addons))
    monkeypatch.setattr(preferences, "bpy", SimpleNamespace(context=context))
    assert preferences.preferences() is None
    addons[preferences.ADDON_ID] = SimpleNamespace(preferences="its own")
    assert preferences.preferences() == "its own"


def test_the_default_density_is_none_its_own_or_that_of_a_material(scene):
    settings = scene.body_moments
    for name, wanted, material in (("NONE", None, ""), ("CUSTOM", 1234.5, ""), ("Copper", 8960.0, "Copper")):
        settings.default_material, settings.default_density = name, 1234.5
        assert preferences.default_density(scene) == wanted and preferences.default_material(scene) == material


@pytest.mark.parametrize("kind", ["Object", "Material", "Scene"])
def test_settings_have_the_add_ons_name(kind):
    assert getattr(bpy.types, kind).bl_rna.properties["body_moments"].name == "Body Moments"
