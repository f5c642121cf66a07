# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything that an object shows, flattened to surfaces times matrices: its own mesh and all
instances under it.

Instances of geometry nodes are two arrays, transforms and references
(`GeometrySet.instances_pointcloud`). The walk carries all places of one thing as a (k, 4, 4) array
in float64. It mirrors object_dupli.cc; the tests compare the two. Instancing on vertices and faces
and by particles is left to Blender: `depsgraph.object_instances`, one by one.
"""

from collections import Counter
from collections.abc import Callable, Hashable, Iterator
from dataclasses import replace

import bpy
import numpy as np

from ...core.bodies import (
    NO_VALUES,
    FaceAttributes,
    Part,
    SplineReading,
    float64_matrix,
    name_subject,
)
from ...core.mesh import Surface
from ...core.moments import affine_matrices
from ...core.numerics import Array, NDArray
from ...core.verdict import ReadError
from .findings import NON_FINITE_INSTANCES, NOT_SHOWN
from .mesh import face_slots, from_edit_mesh, mesh_surface, read_array, vertex_values
from .places import world_matrices
from .splines import spline_reading
from .visibility import GEOMETRY_TYPES, MAX_DEPTH, blends_keys, evaluated_geometry

NO_PLACES = np.empty((0, 4, 4))


class _NeedsInstanceList(Exception):
    """The instances are of a kind that is only in Blender's own list of instances."""


class InstanceCollector:
    """The collected surfaces with all their places, and the omitted objects.

    faceless: (vertices, edges) of the meshes without a face. left_out: number of elements without
    surface, by a word for their kind. sources: the original objects that were read.
    vanished_count: number of instances that are scaled to nothing. splines: the patches of each
    evaluated surface object that was read, None if its display mesh is measured. drawn: the
    original objects whose own polygons were read. collections: the original collections that are
    instanced, as far as Blender's own list was not needed. materials, attribute, edges: requests
    for the faces' materials, for the vertices' attribute of a name, and for the edges at the
    corners.
    """

    def __init__(
        self,
        root,
        depsgraph,
        materials: bool = False,
        attribute: str | None = None,
        edges: bool = True,
    ):
        self.root = root
        self.depsgraph = depsgraph
        self.materials = materials
        self.attribute = attribute
        self.edges = edges
        # A geometry set owns the meshes that it returns, and the keys are their addresses.
        self._owners: list[object] = []
        self.collections: dict[bpy.types.Collection, None] = {}
        self._reset()

    def _reset(self) -> None:
        self.faceless = (0, 0)
        self.left_out: Counter[str] = Counter()
        self.sources: dict[bpy.types.Object, None] = {}
        self.drawn: dict[bpy.types.Object, None] = {}
        self.vanished_count = 0
        self.splines: dict[bpy.types.Object, SplineReading | None] = {}
        self._parts: dict[Hashable, tuple[Part, list[Array]]] = {}
        self._path: list[bpy.types.Object] = []

    def collect(self) -> None:
        """Read the root object and its instances."""
        place = world_matrices(self.root)
        try:
            self._add_object(self.root, place)
        except _NeedsInstanceList:
            self._reset()
            self._add_listed_instances(place)

    def parts(self) -> list[Part]:
        """Return a part for each surface, without instances of scale 0, which are added to
        `vanished_count`; ReadError for a non-finite matrix.
        """
        parts = []
        for part, matrix_blocks in self._parts.values():
            if not len(part.surface.triangles) and not len(part.surface.quads):
                continue
            matrices = np.concatenate(matrix_blocks)
            total = len(matrices)
            non_finite = total - int(np.isfinite(matrices).all(axis=(1, 2)).sum())
            if non_finite:
                raise ReadError(
                    NON_FINITE_INSTANCES, subject=self.root.name, count=non_finite, total=total
                )
            if total > 1:
                matrices = matrices[matrices[:, :3, :3].any(axis=(1, 2))]
            self.vanished_count += total - len(matrices)
            if len(matrices):
                parts.append(replace(part, matrices=matrices))
        return parts

    def _add_object(self, evaluated, matrices: NDArray) -> None:
        """Add an object with its instances, placed at `matrices` instead of its own matrix."""
        original = evaluated.original
        if original in self._path or len(self._path) > MAX_DEPTH:
            return
        particle_kinds = {
            modifier.particle_system.settings.render_type
            for modifier in original.modifiers
            if modifier.type == "PARTICLE_SYSTEM" and modifier.show_viewport
        }
        if original.instance_type in {"VERTS", "FACES"} or particle_kinds & {
            "OBJECT",
            "COLLECTION",
        }:
            raise _NeedsInstanceList
        if self._path and original.type == "META":
            self.left_out["metaballs, which Blender cannot instance"] += len(matrices)
            return
        self.sources[original] = None
        # The path of objects that show one another ends endless recursion.
        self._path.append(original)
        instanced = False
        if original.type in GEOMETRY_TYPES:
            geometry = self._geometry(evaluated)
            instanced = self._add_instances(geometry, matrices)
            if shows_itself(original, instanced):
                self._add_own_geometry(evaluated, geometry, matrices)
        collection = evaluated.instance_collection
        if not instanced and original.instance_type == "COLLECTION" and collection:
            self._add_collection(collection, matrices)
        self._path.pop()

    def _geometry(self, evaluated):
        geometry = evaluated_geometry(evaluated.original, self.depsgraph, self.root.original)
        self._owners.append(geometry)
        return geometry

    def _add_own_geometry(self, evaluated, geometry, matrices: NDArray) -> None:
        original = evaluated.original
        if original.type != "MESH":
            if original.type == "SURFACE" and evaluated not in self.splines:
                self.splines[evaluated] = spline_reading(evaluated, self.depsgraph, geometry.mesh)
            self._add_mesh(evaluated, geometry.mesh, matrices, evaluated)
        elif original.data.is_editmode:
            self._add_surface(
                evaluated, lambda: self._edit_mode_surface(evaluated), matrices, evaluated
            )
        else:
            # Objects that share a mesh and do not modify it share its evaluated data too.
            self._add_mesh(evaluated.data, geometry.mesh, matrices, evaluated)
        self._count_surfaceless(geometry, len(matrices))

    def _add_instances(self, geometry, matrices: NDArray) -> bool:
        """Add the instances of a geometry set, once for each place of the set; return whether there
        were any.
        """
        cloud = geometry.instances_pointcloud()
        if cloud is None:  # there are no instances
            return False
        count = len(cloud.points)
        values = cloud.attributes
        columns = read_array(values["instance_transform"].data, "value", (count, 4, 4), np.float32)
        transforms = columns.transpose(0, 2, 1).astype(np.float64)
        reference_index = read_array(values[".reference_index"].data, "value", (count,), np.int32)
        references = geometry.instance_references()
        # Instances of the same reference are a segment of the sorted ones.
        order = np.argsort(reference_index, kind="stable")
        bounds = np.searchsorted(reference_index[order], np.arange(len(references) + 1))
        for reference, start, end in zip(references, bounds[:-1], bounds[1:], strict=True):
            if start < end and reference is not None:
                # `parts` refuses matrices that are not finite.
                with np.errstate(invalid="ignore", over="ignore"):
                    placed = matrices[:, None] @ transforms[order[start:end]][None]
                placed = placed.reshape(-1, 4, 4)
                if isinstance(reference, bpy.types.Object):
                    self._add_object(reference.evaluated_get(self.depsgraph), placed)
                elif isinstance(reference, bpy.types.Collection):
                    self._add_collection(reference, placed)
                else:  # another geometry set
                    self._owners.append(reference)
                    self._add_mesh(reference.mesh, reference.mesh, placed)
                    self._count_surfaceless(reference, len(placed))
                    self._add_instances(reference, placed)
        return True

    def _add_collection(self, collection, matrices: NDArray) -> None:
        self.collections[collection.original] = None
        matrices = matrices @ affine_matrices(
            np.eye(3), -np.array(collection.instance_offset[:], np.float64)
        )
        for member in visible_objects(collection):
            evaluated = member.evaluated_get(self.depsgraph)
            placed = matrices[:, None] @ world_matrices(evaluated)[None]
            self._add_object(evaluated, placed.reshape(-1, 4, 4))

    def _add_listed_instances(self, instance_matrix: NDArray) -> None:
        """Add the root and its instances from `depsgraph.object_instances`."""
        original = self.root.original
        if not original.visible_get(view_layer=self.depsgraph.view_layer):
            raise ReadError(
                NOT_SHOWN,
                cause="Blender makes no instances of a hidden object. Show it in the viewport",
                subject=original.name,
            )
        if original.type in GEOMETRY_TYPES:
            geometry = self._geometry(self.root)
            if shows_itself(original, True):
                self._add_own_geometry(self.root, geometry, instance_matrix)
        for instance in self.depsgraph.object_instances:
            if (
                instance.parent != self.root
                or instance.object.type != "MESH"
                or not instance.show_self
            ):
                continue
            source = instance.instance_object
            mesh = instance.object.data
            matrix = float64_matrix(instance.matrix_world)[None]
            self.sources[source.original] = None
            key = self._surface_key(mesh, source)
            if key in self._parts:
                self._parts[key][1].append(matrix)
            elif source.data == mesh:
                # Not the mesh itself: its subdivision may have been left to the graphics card.
                self._add_mesh(mesh, self._geometry(source).mesh, matrix, source)
            else:
                self._add_mesh(mesh, mesh, matrix, source)

    def _add_mesh(self, key: Hashable, mesh, matrices: NDArray, owner=None) -> None:
        """Add a mesh; owner: the evaluated object whose material slots apply."""
        if mesh is not None:
            if owner is not None and len(mesh.polygons):
                self.drawn[owner.original] = None
            self._add_surface(
                self._surface_key(key, owner), lambda: self._read(mesh, owner), matrices, owner
            )

    def _surface_key(self, key: Hashable, owner) -> Hashable:
        """Return the key of a mesh's surface; if materials are read, it includes the object's own
        material slots.
        """
        return (key, _object_slots(owner)) if self.materials and owner is not None else key

    def _read(self, mesh, owner) -> tuple[Surface, FaceAttributes]:
        if not len(mesh.polygons):
            vertices, edges = self.faceless
            self.faceless = (vertices + len(mesh.vertices), edges + len(mesh.edges))
        attributes = FaceAttributes()
        if self.materials or self.attribute is not None:
            attributes = self._read_attributes(mesh, owner)
        return mesh_surface(mesh, edges=self.edges), attributes

    def _read_attributes(self, mesh, owner) -> FaceAttributes:
        values = NO_VALUES
        if self.attribute is not None and len(mesh.polygons):
            with name_subject(self.root.name):
                values = vertex_values(mesh, self.attribute)
        if not self.materials:
            return FaceAttributes(vertex_values=values)
        slots = _slots(mesh, owner)
        # Blender shows a face that names a slot beyond the last one with the last one's material.
        slot_of_face = (
            np.clip(face_slots(mesh), 0, len(slots) - 1)
            if slots
            else np.full(len(mesh.polygons), -1)
        )
        return FaceAttributes(slots, slot_of_face, values)

    def _edit_mode_surface(self, evaluated) -> tuple[Surface, FaceAttributes]:
        """Return the surface of an object in Edit Mode of its mesh, with the modifiers that act
        there.
        """
        original = evaluated.original
        acting = any(
            modifier.show_viewport and modifier.show_in_editmode for modifier in original.modifiers
        )
        if not acting and not blends_keys(original):
            return from_edit_mesh(original.data, lambda copy: self._read(copy, evaluated))
        # The evaluated mesh may be a BMesh in disguise, which only to_mesh() turns into arrays.
        read = self._read(evaluated.to_mesh(), evaluated)
        evaluated.to_mesh_clear()
        return read

    def _add_surface(
        self,
        key: Hashable,
        read: Callable[[], tuple[Surface, FaceAttributes]],
        matrices: NDArray,
        owner,
    ) -> None:
        if key not in self._parts:
            surface, attributes = read()
            name = (self._path[-1] if owner is None else owner.original).name
            self._parts[key] = (
                Part(surface, NO_PLACES, attributes, self.splines.get(owner), name),
                [],
            )
        self._parts[key][1].append(matrices)

    def _count_surfaceless(self, geometry, count: int) -> None:
        """Count the elements without surface in a geometry set, which is shown `count` times."""
        if geometry.curves is not None and len(geometry.curves.curves):
            self.left_out["curves without thickness"] += count * len(geometry.curves.curves)
        if geometry.pointcloud is not None and len(geometry.pointcloud.points):
            self.left_out["points"] += count * len(geometry.pointcloud.points)
        if geometry.volume is not None:
            self.left_out["volumes"] += count


def _object_slots(owner) -> tuple:
    """Return (index, material) of the object's own slots, which replace the materials of its
    data.
    """
    return tuple(
        (i, slot.material.original if slot.material else None)
        for i, slot in enumerate(owner.material_slots)
        if slot.link == "OBJECT"
    )


def _slots(mesh, owner) -> tuple:
    """Return the original materials of an evaluated mesh in the order of slots, None for empty
    slots.
    """
    slots = list(mesh.materials)
    if owner is not None:
        # A copy of an edit mesh has no slots of its own.
        slots = slots or list(owner.original.data.materials)
        object_slots = dict(_object_slots(owner))
        slots += [None] * (max(object_slots, default=-1) + 1 - len(slots))
        for i, material in object_slots.items():
            slots[i] = material
    return tuple(material.original if material else None for material in slots)


def shows_itself(obj, instanced: bool) -> bool:
    """Return whether the viewport shows the object's own geometry beside its instances and
    particles.
    """
    instancer = instanced or obj.instance_type != "NONE" or len(obj.particle_systems) > 0
    return obj.show_instancer_for_viewport or not instancer


def visible_objects(collection, switch: str = "hide_viewport") -> Iterator:
    """Yield the objects of a collection and its children, each once, unless the property `switch`
    disables them.
    """
    objects = {}
    pending = [collection]
    while pending:
        current = pending.pop()
        if not getattr(current, switch):
            objects |= {obj: None for obj in current.objects if not getattr(obj, switch)}
            pending.extend(reversed(current.children))
    yield from objects
