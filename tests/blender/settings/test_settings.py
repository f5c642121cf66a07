# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings: values of grids, positions of samples, given parts, acceptance, copies and linked scenes."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from body_moments.blender.settings import accepted, preferences, properties
from body_moments.blender.settings.given import GIVEN_PROPERTIES, GivenPart, is_point_mass
from body_moments.blender.settings.grid import GridOptions, positions_text
from body_moments.core.scans.positions import EVEN
from body_moments.core.verdict.finding import finding

from tests.blender.findings import refused
from tests.blender.objects import add, mesh_body

pytestmark = pytest.mark.usefixtures("scene")
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
