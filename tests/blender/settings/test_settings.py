# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings: values of grids, positions of samples, given parts, acceptance, copies and linked scenes."""

import bpy
import numpy as np
import pytest
from body_moments.blender.settings import properties
from body_moments.blender.settings.given import GIVEN_PROPERTIES, GivenPart, is_point_mass
from body_moments.blender.settings.grid import GridOptions
from body_moments.blender.settings.grid_values import density_function, empty_background_note

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
    assert density_function(plain, None)(values[1:]).tolist() == [0.0, 6.0, 21.0]
    assert density_function(plain, -1.0)(values).tolist() == [0.0, 0.0, 6.0, 21.0]
    with refused("values_negative", density=-3.0):
        density_function(plain, 7.0)(values)
    table = GridOptions(table="0 10, 4 30")
    assert density_function(table, 2.0)(values).tolist() == [10.0, 10.0, 0.0, 30.0]
    with refused("density_non_finite"):
        density_function(table, None)(np.array([0.0, np.nan]))
    for options, background, noted in (
        (plain, 2.0, True),
        (plain, 0.0, False),
        (plain, None, False),
        (table, 2.0, True),
    ):
        notes = empty_background_note(options, background)
        assert [(one.code, one.values) for one in notes] == [("background_empty", {"value": 2.0})] * noted
    assert empty_background_note(GridOptions(value_density=0.0), 2.0) == ()
    assert (
        empty_background_note(plain, np.inf) == () and empty_background_note(GridOptions(table="0 0, 4 30"), 0.0) == ()
    )
    assert GridOptions(spline_order=2, value_density=2.0).meaning().values == {"density": 2.0, "order": 2}
    assert GridOptions(spline_order=2, table="0 1").meaning().code == "values_by_table"
    assert GridOptions.from_settings(add(bpy.data.volumes.new("Cloud")).body_moments, 0.25).value_density == 0.25
    tabled = set_up("VOLUME", {"values_from": "TABLE"}).body_moments
    assert GridOptions.from_settings(tabled).table and not GridOptions.from_settings(tabled, 1.0).table


def test_given_parts():
    obj = add(None)
    settings = obj.body_moments
    settings.given_center, settings.given_inertia_diagonal = (0.1, 0.2, 0.3), (1.1, 2.2, 3.3)
    settings.given_inertia_products = (0.4, 0.5, 0.6)
    nothing = GivenPart.from_settings(settings, 0.5)
    assert not nothing and nothing.key == ""
    settings.use_center = True
    center = GivenPart.from_settings(settings, 0.5)
    assert center and center.center == (0.05, 0.1, 0.15) and center.inertia is None
    settings.use_inertia = True
    both = GivenPart.from_settings(settings, 0.5)
    assert both.inertia == ((1.1, 0.4, 0.5), (0.4, 2.2, 0.6), (0.5, 0.6, 3.3))
    assert len({nothing.key, center.key, both.key}) == 3
    settings.use_center = False
    assert GivenPart.from_settings(settings, 0.5)
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


def test_copied_settings_keep_set_and_unset_values():
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
