# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What stored numbers were computed from, in a text short enough for a property: geometry, transform and settings.

The geometry's part is a digest of the moments themselves: no two shapes that a person would distinguish share twenty
moments to the last bit, and it costs nothing. Transform and settings can be digested without measuring, so a panel
may compare them while it draws. Beside them stands a digest of the shape that a mesh object shows, cheap enough to be
taken whenever Blender re-evaluates it.
"""

from __future__ import annotations

import hashlib

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.mesh.surface import Surface
from ...core.numerics.float32 import shortest_decimal
from ...core.verdict.finding import ReadError
from ..settings.density import object_density
from ..settings.digest import density_key
from .mesh import mesh_surface
from .visibility import evaluated_geometry

VERSION = "v1"
MAX_DIGESTED_FACES = 50_000  # faces: reading and digesting them takes 2 ms


def fingerprint(geometry: bytes, matrix: str, settings: str) -> str:
    """The text stored as `body_fingerprint`: version, then the three digests."""
    return ":".join([VERSION, digest(geometry), matrix, settings])


def matrix_hash(obj: bpy.types.Object) -> str:
    """A digest of where the object is and how it is turned, scaled and sheared."""
    return digest(np.array(obj.matrix_world, np.float32).tobytes())


def scale_hash(obj: bpy.types.Object) -> str:
    """A digest of how the object is scaled and sheared, wherever it lies."""
    linear = np.array(obj.matrix_world, np.float64)[:3, :3]
    products = linear.T @ linear
    largest = np.abs(products).max() or 1.0
    return digest((np.round(products / largest, 5) + 0.0).tobytes())


def settings_hash(obj: bpy.types.Object, scene: bpy.types.Scene) -> str:
    """A digest of the settings that the numbers of this object depend on."""
    settings = obj.body_moments
    unit = shortest_decimal(scene.unit_settings.scale_length)
    given = shortest_decimal(settings.linear_density) if settings.kind == "WIRE" else object_density(settings, scene)
    return effective_hash(
        "SOLID" if obj.type == "VOLUME" else settings.kind,
        given if settings.mass_from == "DENSITY" else None,
        shortest_decimal(settings.mass) if settings.mass_from == "MASS" else None,
        shortest_decimal(settings.thickness) * unit,
        settings.overlap,
        unit,
        settings.wall,
        density_key(obj, str(obj.get("body_materials", "")).splitlines(), scene),
    )


def effective_hash(
    kind: str,
    density: float | None,
    mass: float | None,
    thickness: float,
    overlap: str,
    unit_scale: float,
    wall: str = "THIN",
    varying: str = "",
) -> str:
    """A digest of settings as they were used; what a kind has no use for does not count. varying: `density_key`, which
    takes the place of the density."""
    density = None if varying else density
    # as a setting holds it
    density, mass = [None if value is None else shortest_decimal(value) for value in (density, mass)]
    used = [
        kind,
        density,
        mass,
        float("{:.6g}".format(thickness)) if kind == "SHELL" else None,
        overlap if kind == "SOLID" else None,
        round(unit_scale, 12),
        *([varying] if varying else []),
    ]
    if kind == "SHELL" and wall != "THIN":
        used.append(wall)
    return digest(repr(used).encode())


def shape_digest(obj, depsgraph) -> bytes | None:
    """Of the faces of a mesh object in Object Mode, wherever it stands; None of others, large ones, those that show
    instances, and those whose mesh is edited by way of another object."""
    if (
        obj.type != "MESH"
        or obj.mode != "OBJECT"
        or obj.data.is_editmode
        or obj.instance_type != "NONE"
        or len(obj.particle_systems)
        or "NODES" in [modifier.type for modifier in obj.modifiers]
    ):
        return None
    try:
        geometry = evaluated_geometry(obj, depsgraph, obj)  # it owns its mesh
    except ReadError:
        return None
    mesh = geometry.mesh
    if mesh is None or len(mesh.polygons) > MAX_DIGESTED_FACES:
        return None
    return surface_digest(mesh_surface(mesh, edges=False), len(mesh.polygons))


def surface_digest(surface: Surface, face_count: int) -> bytes | None:
    """A digest of the faces of a mesh as they were read; None of many."""
    if face_count > MAX_DIGESTED_FACES:
        return None
    shape = hashlib.blake2b(digest_size=16)
    for array in (surface.points, surface.triangles, surface.quads):
        shape.update(np.ascontiguousarray(array))
        shape.update(repr(array.shape).encode())
    return shape.digest()


def digest(data: bytes | NDArray) -> str:
    """A short text that differs for different data."""
    return hashlib.blake2s(data, digest_size=6).hexdigest()
