# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Masses and centers of objects from frame to frame: measured again only if the geometry has
changed.

An object that only moves is measured once, and its moments are mapped by its matrices. A mesh mixed
from shape keys is sampled once, and its volume and center are polynomials of the key values while
Blender cuts its faces into the same triangles; after other cuts it is measured.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from bpy.types import Depsgraph, Object

from ....core import bodies, mesh, numerics, statics, verdict
from ....core.moments import Measure, Moments, are_similarities, are_singular
from ... import read, scale, scene
from ...bodies.measure_object import measure_object
from ...bodies.mesh import object_hull
from ...settings.options import object_settings
from ..tracking import updates

MAX_SAMPLES = 200  # for a shape-key mix: with more keys each frame is measured


@dataclass(eq=False)
class _Followed:
    """The measurement of a followed object.

    change: number of the geometry's last update at the measurement, -1 before the first. moments:
    of the mass, in the object's coordinates in SI units. given_mass: in kg, if the mass is given.
    mixes: volume and center as polynomials of the values of the shape keys `keys`, for faces cut
    into `triangles`; density: the density for them. hull: the convex hull in the object's
    coordinates; hull_change: number of the geometry's last update at it.
    """

    change: int = -1
    moments: Moments | None = None
    given_mass: float | None = None
    mixes: statics.Mixes | None = None
    density: float = 0.0
    keys: tuple[str, ...] = ()
    triangles: numerics.Integers | None = None
    hull: mesh.ConvexHull | None = None
    hull_change: int = -1


@dataclass(eq=False)
class Motion:
    """Objects as they are at the frame that the dependency graph shows.

    frames: number of frames to come; shape keys are sampled if that is less work.
    """

    frames: int
    # by session uid, as undo replaces objects
    _followed: dict[int, _Followed] = field(default_factory=dict)

    def mass_and_center(self, obj: Object, depsgraph: Depsgraph) -> tuple[float, numerics.Array]:
        """Return an object's mass, kg, and (3,) center, Blender's units; MeasureError if there is
        no certain one.
        """
        unit = scale.meters_per_unit(depsgraph.scene)
        matrix = bodies.float64_matrix(obj.evaluated_get(depsgraph).matrix_world)
        followed = self._entry(obj)
        if followed.change == -1 and followed.mixes is None:  # at its first frame
            self._shape_keys(obj, depsgraph, followed)
        mixed = None if followed.mixes is None else _mixed(obj, followed, depsgraph, matrix, unit)
        if mixed is not None:
            return mixed
        moments = self.mass_moments(obj, depsgraph)
        return moments.total, moments.center / unit

    def mass_moments(self, obj: Object, depsgraph: Depsgraph) -> Moments:
        """Return the moments of an object's mass to second order, in the world and SI units, or
        raise MeasureError.
        """
        unit = scale.meters_per_unit(depsgraph.scene)
        matrix = bodies.float64_matrix(obj.evaluated_get(depsgraph).matrix_world)
        followed = self._entry(obj)
        change = updates.last_change_of_geometry(obj)
        if (
            followed.moments is None
            or followed.change != change
            or not _can_map(followed.moments, matrix)
        ):
            followed.change = change
            return _measured(obj, followed, depsgraph, matrix, unit)
        moments = followed.moments.transform(bodies.to_si(matrix[None], unit)[0])
        return (
            moments
            if followed.given_mass is None
            else moments * (followed.given_mass / moments.total)
        )

    def _entry(self, obj: Object) -> _Followed:
        return self._followed.setdefault(obj.session_uid, _Followed())

    def hull_points(self, obj: Object, depsgraph: Depsgraph) -> numerics.Array:
        """Return the corners of an object's convex hull, (k, 3) in Blender's units and the
        world.
        """
        followed = self._entry(obj)
        change = updates.last_change_of_geometry(obj)
        if followed.hull is None or followed.hull_change != change:
            followed.hull = object_hull(obj, depsgraph)
            followed.hull_change = change
        matrix = bodies.float64_matrix(obj.evaluated_get(depsgraph).matrix_world)
        return followed.hull.points @ matrix[:3, :3].T + matrix[:3, 3]

    def _shape_keys(self, obj: Object, depsgraph: Depsgraph, followed: _Followed) -> None:
        """Fit `mixes` to an object that shows nothing but a mix of shape keys, if that is
        possible.
        """
        keys = _mixed_keys(obj)
        if not keys or statics.sample_count(len(keys)) > min(self.frames, MAX_SAMPLES):
            return
        measurement = measure_object(obj, depsgraph)
        if (
            measurement.method != verdict.Method(verdict.Procedure.EXACT)
            or measurement.health.welded
        ):
            return
        blocks = obj.data.shape_keys.key_blocks
        # A key adds its difference from the key that it is relative to, times its value.
        shapes = {
            name: _coordinates(blocks[name].data)
            for name in {*keys, *(blocks[key].relative_key.name for key in keys)}
        }
        surface = read.objects.read_object(obj, depsgraph, edges=False).parts[0].surface
        surface = replace(surface, points=_coordinates(obj.data.shape_keys.reference_key.data))
        offsets = [shapes[name] - shapes[blocks[name].relative_key.name] for name in keys]
        followed.mixes = statics.fit_mixes(surface, offsets)
        followed.keys = keys
        followed.triangles, _ = surface.all_triangles()
        followed.density = measurement.density
        followed.given_mass = object_settings(obj, depsgraph.scene).mass


def _mixed_keys(obj: Object) -> tuple[str, ...]:
    """Return the names of the shape keys that may change the mesh, or none if anything else may
    change it, too.
    """
    settings = obj.body_moments
    if obj.type != "MESH" or obj.data.shape_keys is None or not obj.data.shape_keys.use_relative:
        return ()
    if (
        obj.mode != "OBJECT"
        or obj.show_only_shape_key
        or any(modifier.show_viewport for modifier in obj.modifiers)
    ):
        return ()
    if (settings.kind, settings.density_from, settings.overlap) != ("SOLID", "VALUE", "SIGNED"):
        return ()
    blocks = [
        block
        for block in obj.data.shape_keys.key_blocks
        if block != obj.data.shape_keys.reference_key
    ]
    if (
        any(block.vertex_group for block in blocks)
        or obj.instance_type != "NONE"
        or len(obj.particle_systems)
    ):
        return ()
    return tuple(block.name for block in blocks if not block.mute)


def _coordinates(data) -> numerics.Array:
    points = np.empty(3 * len(data), np.float32)
    data.foreach_get("co", points)
    return points.reshape(-1, 3).astype(np.float64)


def _mixed(
    obj: Object, followed: _Followed, depsgraph: Depsgraph, matrix: numerics.NDArray, unit: float
) -> tuple[float, numerics.Array] | None:
    """Return mass, kg, and center, Blender's units in the world, by the mix of shape keys; None if
    triangles changed, or the mesh is flat or inside out. matrix: of the object.
    """
    assert followed.mixes is not None and followed.triangles is not None
    triangles, _ = (
        read.objects.read_object(obj, depsgraph, edges=False).parts[0].surface.all_triangles()
    )
    if not np.array_equal(triangles, followed.triangles):
        return None
    blocks = obj.data.shape_keys.key_blocks
    volumes, centers = followed.mixes.at([[blocks[name].value for name in followed.keys]])
    if np.isnan(volumes[0]) or are_singular(matrix[None, :3, :3])[0]:
        return None
    volume = float(volumes[0]) * abs(np.linalg.det(matrix[:3, :3])) * unit**3
    mass = followed.density * volume if followed.given_mass is None else followed.given_mass
    return mass, matrix[:3, :3] @ centers[0] + matrix[:3, 3]


def _measured(
    obj: Object, followed: _Followed, depsgraph: Depsgraph, matrix: numerics.NDArray, unit: float
) -> Moments:
    """Measure an object, keep its moments if its matrices can map them, and return them in the
    world.
    """
    measurement = measure_object(obj, depsgraph)
    if measurement.method.procedure == verdict.Procedure.OPEN:
        raise verdict.EditRefusedError(scene.findings.OPEN_OBJECT, subject=obj.name)
    moments, factor = measurement.mass_moments
    followed.given_mass = object_settings(obj, depsgraph.scene).mass
    mass = moments.truncate(2) * factor
    followed.moments = (
        mass.transform(np.linalg.inv(bodies.to_si(matrix[None], unit)[0]))
        if _can_map(moments, matrix)
        else None
    )
    return mass


def _can_map(moments: Moments, matrix: numerics.NDArray) -> bool:
    """Return whether a matrix can map the moments: it is not singular, and a similarity for areas
    and lengths.
    """
    if are_singular(matrix[None, :3, :3])[0]:
        return False
    return moments.measure in (Measure.VOLUME, Measure.MASS) or bool(
        are_similarities(matrix[None, :3, :3])[0]
    )
