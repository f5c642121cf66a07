# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings: values of grids, positions of samples, given parts, acceptance, copies and linked
scenes.
"""

import pytest
from body_moments.blender.settings import properties
from body_moments.blender.settings.given import GIVEN_PROPERTIES

from tests.blender.objects import add, mesh_body

pytestmark = pytest.mark.usefixtures("scene")
OTHERS = {"STRING": "900 + 2*y", "FLOAT": 0.7, "INT": 3, "BOOLEAN": True}


def changes(settings):
    """Each setting with another value."""
    for prop in settings.bl_rna.properties:
        if (
            prop.identifier in ("rna_type", "name")
            or prop.identifier.startswith("density_")
            and prop.type == "FLOAT"
        ):
            continue
        if prop.type == "ENUM":
            now = getattr(settings, prop.identifier)
            yield (
                prop.identifier,
                next(item.identifier for item in prop.enum_items if item.identifier != now),
            )
        elif prop.type in OTHERS:
            value = OTHERS[prop.type]
            yield (
                prop.identifier,
                [value] * prop.array_length if getattr(prop, "is_array", False) else value,
            )


def test_copied_settings_keep_set_and_unset_values():
    source, target = (
        add(mesh_body(), "Source").body_moments,
        add(mesh_body(), "Target").body_moments,
    )
    assert not properties.copy_settings(source, target) and not target.is_property_set("density")
    source.density = source.density  # set, to what it is by default
    assert not properties.copy_settings(source, target) and target.is_property_set("density")
    for name, other in list(changes(source)):
        if name in properties.COPIED_PROPERTIES:
            setattr(source, name, other)
            assert properties.copy_settings(source, target), name
            assert properties.comparable(getattr(target, name)) == properties.comparable(
                getattr(source, name)
            )
            assert not properties.copy_settings(source, target), name
    assert {*GIVEN_PROPERTIES} < {*properties.COPIED_PROPERTIES}
