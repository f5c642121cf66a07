# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The members of an assembly: a collection with its nested collections, or an empty with its
children.

An object counts once, in its first place. An instance of a collection is an assembly of its own,
with the members' own densities, unless the instancer's own density or mass is set. Panels ask for
changes of members, so numpy is not loaded. Objects in a total that are, or may be, no part of the
body, such as cutters and helpers, are found here, too.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from operator import attrgetter

import bpy
from bpy.types import Depsgraph, LayerCollection, Object, Scene, ViewLayer
from mathutils import Matrix

from ...core.measurement import digest
from ...core.numerics import shortest_decimal
from ...core.verdict import Finding, finding
from ..settings.assembly import Root, is_assembly, settings_of
from ..settings.given import GivenPart, is_point_mass, shows_collection
from .findings import (
    BOOLEAN_OPERAND,
    HIDDEN_IN_VIEWPORT,
    MEMBER_COUNTED_BEFORE,
    NOT_RENDERED,
    TOTAL_COPIES_IN_PLACE,
    TOTAL_DOUBTFUL_PARTS,
)
from .fingerprint import matrix_bytes, matrix_hash
from .visibility import MAX_DEPTH, hidden_reason, instanced_by_parent, measurable

by_name = attrgetter("name")
SAMPLED = 64  # vertices that are compared to tell a copy


class MemberKind(StrEnum):
    COLLECTION = "COLLECTION"
    INSTANCE = "INSTANCE"
    EMPTY = "EMPTY"
    OBJECT = "OBJECT"
    POINT = "POINT"


@dataclass(frozen=True, eq=False)
class Member:
    """A member of an assembly, or the assembly itself.

    `data`: an object or collection; the instancer of an instance. `members`: of a collection or an
    instance, or the children of an object. `matrix`: the rows, float64, of an instance's matrix,
    from its collection's members to their displayed places, in Blender units. `left_out`: the
    reason why the member is not counted.
    """

    data: Root
    kind: MemberKind
    members: tuple[Member, ...] = ()
    matrix: tuple[tuple[float, ...], ...] | None = None
    left_out: Finding | None = None

    @property
    def name(self) -> str:
        return self.data.name

    @property
    def is_measured(self) -> bool:
        """True if the member counts and has a body of its own, beside the bodies of its members."""
        return self.kind in (MemberKind.OBJECT, MemberKind.POINT) and self.left_out is None

    def walk(self) -> Iterator[Member]:
        """Yield the member itself and all members below it, each before its own members."""
        yield self
        for member in self.members:
            yield from member.walk()


def members_of(root: Root, depsgraph: Depsgraph) -> Member:
    """Return an original collection, or an empty with children, as an assembly with all its
    members.
    """
    if isinstance(root, bpy.types.Collection):
        return _Walk(root.all_objects, depsgraph).collection(root)
    return _Walk((), depsgraph).empty(root)


def members_key(root: Member, fingerprints: Mapping[Object, str]) -> str:
    """Return a key of all measured members: their results' fingerprints, their transforms and the
    point masses.
    """
    keys = []
    for member in root.walk():
        # The fingerprint of an empty with children is that of its assembly, not of its point mass.
        if member.kind == MemberKind.POINT:
            settings = member.data.body_moments
            key = GivenPart.from_settings(settings, 1.0).key + repr(settings.mass)
        elif member.is_measured:
            key = fingerprints.get(member.data, "")  # the same after a move
        else:
            continue
        keys.append(key + matrix_hash(member.data))
    return "\n".join(keys)


def structure_hash(root: Member) -> str:
    """Return a digest of the members, the places of instances and the given masses of
    assemblies.
    """
    keys = []
    for member in root.walk():
        key = [member.kind.value, member.name, member.left_out.code if member.left_out else ""]
        if member.kind in (MemberKind.COLLECTION, MemberKind.EMPTY):
            settings = settings_of(member.data)
            if settings.mass_from == "MASS":
                given = GivenPart.from_settings(settings, 1.0).key
                key.append(repr((shortest_decimal(settings.mass), given)))
        if member.matrix is not None:
            key.append(matrix_bytes(Matrix(member.matrix)).hex())
        keys.append("|".join(key))
    return digest("\n".join(keys).encode())


class _Walk:
    """A walk through an assembly in the scene, or with `inside` through the members of an
    instance.

    counted: each object that counts, with the name of its assembly. given: empties with children
    whose mass is given; replaced: all objects below these.
    """

    def __init__(self, objects: Collection[Object], depsgraph: Depsgraph, inside: bool = False):
        self.depsgraph = depsgraph
        self.inside = inside
        self.operands = operands_of(objects) if inside else {}
        self.reasons = {} if inside else left_out_reasons(depsgraph.scene, depsgraph.view_layer)
        self.counted: dict[Object, str] = {}
        self.children_of: dict[Object | None, list[Object]] = {}  # `children` searches all objects
        for obj in bpy.data.objects:
            self.children_of.setdefault(obj.parent, []).append(obj)
        self.given = [
            obj for obj in objects if is_assembly(obj) and settings_of(obj).mass_from == "MASS"
        ]
        self.replaced = {child for obj in self.given for child in obj.children_recursive}

    def collection(self, collection: bpy.types.Collection, depth: int = 0) -> Member:
        """Return a collection as a member, with its nested collections before its objects."""
        if self.inside and (collection.hide_render or collection.hide_viewport):
            return Member(collection, MemberKind.COLLECTION, left_out=finding(NOT_RENDERED))
        members = [self.collection(child, depth) for child in collection.children]
        for obj in sorted(collection.objects, key=by_name):
            if obj in self.replaced:
                continue
            if obj in self.given and obj not in self.counted:
                self.counted[obj] = collection.name
                members.append(self.empty(obj, depth))
            else:
                members += self.object(obj, collection.name, depth)
        return Member(collection, MemberKind.COLLECTION, tuple(members))

    def empty(self, obj: Object, depth: int = 0) -> Member:
        """Return an empty as a member, with its own point mass, if it is one, and the members of
        its children.
        """
        point = self.object(obj, obj.name, depth) if is_point_mass(obj) else []
        return Member(obj, MemberKind.EMPTY, (*point, *self.children(obj, depth)))

    def children(self, parent: Object, depth: int) -> list[Member]:
        """Return the children as members, each with its own children; those of a child that is no
        body stand in its place.
        """
        members: list[Member] = []
        for child in sorted(self.children_of.get(parent, ()), key=by_name):
            if child.type == "EMPTY" and not shows_collection(child) and child in self.children_of:
                members.append(self.empty(child, depth))
                continue
            child_members = self.object(child, parent.name, depth)
            below = self.children(child, depth)
            for member in child_members:
                members.append(replace(member, members=(*member.members, *below)))
            if not child_members:
                members += below
        return members

    def object(self, obj: Object, place: str, depth: int) -> list[Member]:
        """Return a list with the object as a member, empty if it is no body; `place` is the name of
        its assembly.
        """
        if not measurable(obj) or instanced_by_parent(obj):
            return []
        kind = MemberKind.POINT if is_point_mass(obj) else MemberKind.OBJECT
        if obj in self.counted:
            before = finding(MEMBER_COUNTED_BEFORE, assembly=self.counted[obj])
            return [Member(obj, kind, left_out=before)]
        self.counted[obj] = place
        reason = self._left_out(obj)
        if reason is not None and not (kind == MemberKind.POINT and reason.code == NOT_RENDERED):
            return [Member(obj, kind, left_out=reason)]
        settings = obj.body_moments
        is_unset = (
            settings.kind == "SOLID"
            and settings.mass_from == "DENSITY"
            and settings.density_from == "VALUE"
            and not settings.is_property_set("density")
        )
        if shows_collection(obj) and is_unset and depth < MAX_DEPTH:
            return [self._instance(obj, depth)]
        return [Member(obj, kind)]

    def _instance(self, obj: Object, depth: int) -> Member:
        """Return a collection instance as an assembly of its own."""
        source = obj.instance_collection
        walk = _Walk(source.all_objects, self.depsgraph, inside=True)
        x, y, z = source.instance_offset
        # The rows of matrix_world · T(-offset): members are placed relative to the offset.
        matrix = tuple((a, b, c, d - (a * x + b * y + c * z)) for a, b, c, d in obj.matrix_world)
        return Member(obj, MemberKind.INSTANCE, (walk.collection(source, depth + 1),), matrix)

    def _left_out(self, obj: Object) -> Finding | None:
        """Return the reason why an object does not count, or why Blender cannot tell whether it
        counts, or None.
        """
        if self.inside:
            if obj in self.operands and obj.display_type in {"WIRE", "BOUNDS"}:
                return finding(BOOLEAN_OPERAND)
            return finding(NOT_RENDERED) if obj.hide_render or obj.hide_viewport else None
        reason = self.reasons.get(obj)
        if reason is None and obj.hide_viewport:
            return finding(HIDDEN_IN_VIEWPORT, name=obj.name, switch="monitor icon")
        if reason is None or reason.code != NOT_RENDERED or obj.hide_render:
            return reason
        return hidden_reason(obj, self.depsgraph) or reason


def left_out_reasons(scene: Scene, view_layer: ViewLayer) -> dict[Object, Finding]:
    """Return the objects that are no parts of the body, each with the reason: it is an operand, or
    not rendered.
    """
    # A layer that is switched off renders nothing; if all are switched off, the open layer counts.
    layers = [layer for layer in scene.view_layers if layer.use] or [view_layer]
    rendered = {
        obj for layer in layers for obj in _rendered(layer.layer_collection) if not obj.hide_render
    }
    operands = operands_of(scene.objects)
    helpers = {obj for obj in operands if obj.display_type in {"WIRE", "BOUNDS"}}
    return {
        obj: finding(BOOLEAN_OPERAND if obj in helpers else NOT_RENDERED)
        for obj in scene.objects
        if obj in helpers or obj not in rendered
    }


def operands_of(objects: Iterable[Object]) -> dict[Object, Object]:
    """Return the operands of objects' Boolean modifiers, each with the first object by name that
    uses it.
    """
    # In reverse order, the first user is entered last and stays.
    users = sorted(objects, key=by_name, reverse=True)
    return {operand: user for user in users for operand in _operands(user)}


def total_caveats(objects: Collection[Object], view_layer: ViewLayer) -> list[Finding]:
    """Return a finding for each reason why some of the summed objects may be no parts of the
    body.
    """
    if len(objects) < 2:
        return []
    objects = sorted(objects, key=by_name)
    operands = operands_of(objects)
    rendered = set(_rendered(view_layer.layer_collection))
    doubtful = {
        "Boolean operands": [[obj.name, operands[obj].name] for obj in objects if obj in operands],
        "Objects that are hidden, not rendered or displayed as wire or bounds": [
            obj.name
            for obj in objects
            if obj not in operands
            and (
                obj.hide_render
                or obj not in rendered
                or obj.display_type in {"WIRE", "BOUNDS"}
                or not obj.visible_get(view_layer=view_layer)
            )
        ],
    }
    return [
        *copies_caveats(objects),
        *(
            finding(TOTAL_DOUBTFUL_PARTS, kind=kind, objects=names)
            for kind, names in doubtful.items()
            if names
        ),
    ]


def copies_caveats(objects: Iterable[Object]) -> list[Finding]:
    """Return a warning about the objects that are copies left in place, if there are any."""
    copies = copies_in_place(objects)
    return [finding(TOTAL_COPIES_IN_PLACE, objects=copies)] if copies else []


def copies_in_place(objects: Iterable[Object]) -> list[str]:
    """Return the names of objects that show the geometry of an earlier one at the same place."""
    shown = [
        (obj, (obj.type, obj.matrix_world.copy().freeze()))
        for obj in objects
        if shows_collection(obj) or obj.data is not None and obj.instance_type == "NONE"
    ]
    counts = Counter(place for _, place in shown)
    seen: set[tuple] = set()
    copies = []
    for obj, place in shown:
        if counts[place] > 1:  # the geometry of others need not be read
            shape = place, _shape(obj)
            if shape in seen:
                copies.append(obj.name)
            seen.add(shape)
    return copies


def _shape(obj: Object) -> tuple:
    """Return a key that is equal for copies: an object's box, modifiers and geometry, of a mesh the
    counts of its elements and a sample of its vertices.
    """
    is_mesh = obj.type == "MESH"
    vertices = obj.data.vertices if is_mesh else ()
    return (
        tuple(map(tuple, obj.bound_box)),
        tuple(modifier.type for modifier in obj.modifiers),
        obj.instance_collection,
        len(vertices),
        len(obj.data.polygons) if is_mesh else obj.data,
        tuple(vertices[i].co[:] for i in range(0, len(vertices), max(len(vertices) // SAMPLED, 1))),
    )


def _operands(obj: Object) -> Iterator[Object]:
    """Yield the operands of an object's enabled Boolean modifiers."""
    for modifier in obj.modifiers:
        if modifier.type != "BOOLEAN" or not (modifier.show_viewport or modifier.show_render):
            continue
        if modifier.operand_type == "OBJECT" and modifier.object is not None:
            yield modifier.object
        elif modifier.operand_type == "COLLECTION" and modifier.collection is not None:
            yield from modifier.collection.all_objects


def _rendered(layer: LayerCollection) -> Iterator[Object]:
    """Yield the objects of rendered collections, also if a parent collection is excluded."""
    if not layer.collection.hide_render:
        if not layer.exclude:
            yield from layer.collection.objects
        for child in layer.children:
            yield from _rendered(child)
