# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Posed characters, as evaluated: mass, center and inertia of every part, and the contacts with the
ground.

The parts are those of Measure Bones. Each keeps its mass, and its moments follow the matrix of its
bone. Objects that a constraint holds to a bone are parts, too, at their own place. All lengths are
in Blender's units, in the world.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field

import numpy as np
from bpy.types import Context, Depsgraph, Object, Scene

from ....core import numerics, statics, verdict
from ....core.bodies import float64_matrix
from ....core.inertia import COLUMNS, ROWS, PlainBody, principal_axes, tensor_rows
from ....core.rig import Parts
from ... import read, scale, write
from ...bodies.findings import RIG_WITHOUT_PARTS, UNWEIGHTED_VERTICES
from ...bodies.rig import Rig, measure_rig
from ...scene.rigid_world import down
from .. import memory, stored
from ..live.motion import Motion
from ..tracking import handlers
from ..tracking.armatures import deformed_meshes
from ..tracking.staleness import stale_reason

# chosen: points up to this height touch the ground, relative to the character's size
REACH = 0.01
OUTLINE = 1e-4  # tolerance of the support polygon's corners, relative to its extent
# in place of the index of a vertex's bone
UNKNOWN = -2  # not looked up yet
NO_BONE = -1  # no weight; as an index, it is the last entry
NO_GRAVITY = (
    "The scene has no gravity, so nothing weighs anything. Turn it on in Scene Properties > "
    "Gravity."
)


@dataclass(frozen=True, eq=False)
class Contacts:
    """Contacts of a character with the ground.

    points: (k, 3). bones: (k,) indices of pose bones, -1 for points without one. names: of the
    bones that carry. lifted: of bones that should carry but do not. height: of the lowest point
    above the ground; None without points.
    """

    points: numerics.Array
    bones: numerics.Index
    names: tuple[str, ...]
    lifted: tuple[str, ...]
    height: float | None


@dataclass(frozen=True, eq=False)
class Weight:
    """A character as it is posed: its parts and contacts.

    support: the support below its center, None if nothing touches. foot: (3,) point of the ground
    below the center. body: the total as plain numbers, SI in the world, with the volume and bounds
    of the rest pose.
    """

    parts: Parts
    contacts: Contacts
    support: statics.Support | None
    foot: numerics.Array
    body: PlainBody


@dataclass(frozen=True, eq=False)
class Character:
    """A measured character, whose parts follow its pose.

    model: the parts in the bones' own spaces. size: largest extent of their bones at rest.
    """

    model: Parts
    size: float
    _motion: Motion = field(default_factory=lambda: Motion(1))  # motion of held objects
    # by session uid of a mesh object
    _vertex_bones: dict[int, numerics.Index] = field(default_factory=dict)

    @property
    def names(self) -> tuple[str, ...]:
        """The bones with parts."""
        return self.model.names

    @classmethod
    def from_bodies(
        cls, armature: Object, bodies: Mapping[str, PlainBody | None], unit: float
    ) -> Character | None:
        """Return the character with these bodies of bones, in rest frames and SI units; None if
        there is no mass.
        """
        bodies = {
            name: body for name, body in bodies.items() if body is not None and body.mass > 0.0
        }
        if not bodies:
            return None
        place = float64_matrix(armature.matrix_world)
        frames = read.bones.RestBones.read(armature).frames
        centers = []
        spreads = []
        ends = []
        for name, body in bodies.items():
            bone = armature.data.bones[name]
            turn, head = frames[name]
            # from the world, at the rest pose, to the bone's own space
            to_bone = np.linalg.inv(place @ float64_matrix(bone.matrix_local))
            spread = numerics.second_of_inertia(np.array(tensor_rows(body.inertia)))
            linear = to_bone[:3, :3] @ turn / unit
            centers.append(linear @ body.center + to_bone[:3, :3] @ head + to_bone[:3, 3])
            spreads.append(linear @ spread @ linear.T)
            ends += [bone.head_local, bone.tail_local]
        masses = np.array([body.mass for body in bodies.values()])
        size = float(np.ptp(np.array(ends) @ place[:3, :3].T, axis=0).max())
        # `placed` gives each part its own matrix.
        model = Parts(tuple(bodies), masses, np.array(centers), np.array(spreads), np.eye(4)[None])
        return cls(model, size)

    def pose(self, armature: Object, depsgraph: Depsgraph) -> Parts:
        """Return the parts as evaluated, held objects included."""
        bones = armature.pose.bones
        row = {bone.name: index for index, bone in enumerate(bones)}
        matrices = bone_matrices(armature, depsgraph)[[row[name] for name in self.names]]
        # Bones with given masses keep them while the others share the rest of a given total.
        shares = np.array([bones[name].body_moments.mass_from != "MASS" for name in self.names])
        factors = self.model.factors_to(
            numerics.shortest_decimal(armature.body_moments_weight.mass), shares
        )
        held_parts = [
            self._held_part(obj, depsgraph) for obj, _ in read.rig.held_objects(armature, depsgraph)
        ]
        return Parts.join([self.model.placed(matrices, factors), *held_parts])

    def _held_part(self, obj: Object, depsgraph: Depsgraph) -> Parts:
        """Return a held object as a part at its own place, without mass if it cannot be
        measured.
        """
        unit = scale.meters_per_unit(depsgraph.scene)
        matrix = float64_matrix(obj.evaluated_get(depsgraph).matrix_world)
        mass = np.zeros(1)
        center = matrix[:3, 3]
        spread = np.zeros((3, 3))
        with suppress(verdict.MeasureError):
            moments = self._motion.mass_moments(obj, depsgraph)
            mass = np.array([moments.total])
            center = moments.center / unit
            spread = moments.about_center().second() / unit**2
        return Parts((obj.name,), mass, center[None], spread[None], matrix[None])

    def stand(
        self, armature: Object, depsgraph: Depsgraph, ground: float
    ) -> tuple[Parts, Contacts, statics.Support | None]:
        """Return the parts as evaluated, their contacts with the ground, and the support, None if
        nothing touches.
        """
        parts = self.pose(armature, depsgraph)
        contacts = self.contacts(armature, depsgraph, ground)
        gravity = down(depsgraph.scene)
        support = None
        if len(contacts.points):
            support = statics.support_of_contacts(contacts.points, parts.center, gravity, OUTLINE)
        return parts, contacts, support

    def contacts(self, armature: Object, depsgraph: Depsgraph, ground: float) -> Contacts:
        """Return the points that touch the ground, at this height against gravity from the world's
        origin. If any bone is set to be a contact, only its vertices count.
        """
        names = [bone.name for bone in armature.pose.bones]
        contact_bones = {bone.name for bone in armature.pose.bones if bone.body_moments.is_contact}
        # (b + 1,): the entry at NO_BONE, the last one, is that of vertices without a bone
        may_touch = np.array(
            [not contact_bones or name in contact_bones for name in names] + [not contact_bones]
        )
        gravity = down(depsgraph.scene)
        reach = REACH * self.size
        lowest = np.inf
        places = [np.zeros((0, 3))]
        bones = [np.zeros(0, np.intp)]
        for obj, bone in contact_objects(armature, depsgraph):
            evaluated = obj.evaluated_get(depsgraph)
            points = read.mesh.vertex_points(evaluated.data)
            matrix = float64_matrix(evaluated.matrix_world)
            may_touch_here = (
                may_touch[self._bones_of(obj, bone, names, depsgraph)] if contact_bones else True
            )
            near, touching, height = statics.find_contacts(
                points, matrix, gravity, ground, reach, may_touch_here
            )
            lowest = min(lowest, height)
            places.append(touching)
            bones.append(self._bones_of(obj, bone, names, depsgraph, near))
        carriers = np.concatenate(bones)
        carrying = sorted(names[bone] for bone in np.unique(carriers).tolist() if bone != NO_BONE)
        least = lowest if np.isfinite(lowest) else None
        return Contacts(
            np.concatenate(places),
            carriers,
            tuple(carrying),
            tuple(sorted(contact_bones.difference(carrying))),
            least,
        )

    def _bones_of(
        self,
        obj: Object,
        bone: str | None,
        names: Sequence[str],
        depsgraph: Depsgraph,
        vertices: numerics.NDArray | None = None,
    ) -> numerics.Index:
        """Return the bone of most weight for each vertex of an object, as indices into `names`.

        bone: the bone that carries the object; None for a skinned mesh, whose bones are remembered
        while it has as many vertices. vertices: their indices, by default all.
        """
        mesh = obj.evaluated_get(depsgraph).data
        count = len(mesh.vertices)
        vertices = np.arange(count) if vertices is None else vertices
        index = {name: number for number, name in enumerate(names)}
        if bone is not None:
            return np.full(len(vertices), index.get(bone, NO_BONE))
        vertex_bones = self._vertex_bones.get(obj.session_uid)
        if vertex_bones is None or len(vertex_bones) != count:
            vertex_bones = self._vertex_bones[obj.session_uid] = np.full(count, UNKNOWN)
        group_bones = [index.get(group.name, NO_BONE) for group in obj.vertex_groups]
        for row in vertices[vertex_bones[vertices] == UNKNOWN].tolist():
            weights = [
                (entry.weight, group_bones[entry.group])
                for entry in mesh.vertices[row].groups
                if group_bones[entry.group] != NO_BONE
            ]
            _weight, vertex_bones[row] = max(weights, default=(0.0, NO_BONE))
        return vertex_bones[vertices]


def measure(context: Context, armature: Object) -> Rig:
    """Measure the bones; raise MeasureError if there are no parts, or no vertex of the meshes has a
    weight.
    """
    rig = measure_rig(context, armature)
    unweighted = [
        finding for finding in rig.measurement.findings if finding.code == UNWEIGHTED_VERTICES
    ]
    meshes = read.rig.skinned_objects(armature, rig.objects)
    if (
        meshes
        and len(unweighted) == len(meshes)
        and all(finding.values["count"] == finding.values["total"] for finding in unweighted)
    ):
        raise verdict.ReadError(RIG_WITHOUT_PARTS, subject=armature.name)
    return rig


def character(armature: Object, unit: float) -> Character | None:
    """Return a measured character, cached with its results; None if its bones have not been
    measured.
    """
    fingerprint = write.properties.fingerprint(armature)
    cached_fingerprint, measured_character = memory.characters.get(armature) or (None, None)
    if cached_fingerprint != fingerprint:
        bodies = {bone.name: write.properties.stored(bone) for bone in armature.pose.bones}
        measured_character = Character.from_bodies(armature, bodies, unit)
        memory.characters[armature] = fingerprint, measured_character
    return measured_character


@memory.until_change
def weight(armature: Object, depsgraph: Depsgraph) -> Weight | None:
    """Return a character as the dependency graph shows it, None if its bones have not been
    measured.
    """
    unit = scale.meters_per_unit(depsgraph.scene)
    measured_character = character(armature, unit)
    # Measured bones may have been removed in Edit Mode.
    if measured_character is None or any(
        name not in armature.pose.bones for name in measured_character.names
    ):
        return None
    gravity = down(depsgraph.scene)
    ground = armature.body_moments_weight.ground
    parts, contacts, support = measured_character.stand(armature, depsgraph, ground)
    # The ground is at -gravity @ point = ground.
    foot = (
        parts.center - (parts.center @ gravity + ground) * gravity
        if support is None
        else support.foot
    )
    inertia = tuple((parts.inertia * unit**2)[ROWS, COLUMNS].tolist())
    moments, axes, _ = principal_axes(inertia)
    rest = write.properties.stored(armature) or PlainBody(0.0, 0.0, 0.0, 0.0, (), (), (), (), {})
    body = rest._replace(
        mass=parts.mass,
        center=tuple((parts.center * unit).tolist()),
        inertia=inertia,
        moments=moments,
        axes=axes,
    )
    return Weight(parts, contacts, support, foot, body)


def require_gravity(scene: Scene) -> None:
    """Raise Refused if a scene has no gravity."""
    if not (scene.use_gravity and any(scene.gravity)):
        raise write.reports.Refused(NO_GRAVITY)


def find(context: Context, armature: Object) -> tuple[Character, float, Rig | None]:
    """Return a character, the height of its ground, and its new measurement, None if its results
    are up to date.

    Bones are measured, and the ground is found, only if necessary: the weight is not shown yet.
    Nothing is stored.
    """
    settings = armature.body_moments_weight
    unit = scale.meters_per_unit(context.scene)
    if not settings.show:
        require_gravity(context.scene)
    rig = _measure_outdated(context, armature)
    if rig is None:
        measured_character = character(armature, unit)
    else:
        bodies = {
            part.name: PlainBody.of_body(part.measurement.in_object_frame(), 0.0, 0.0, 0.0, {})
            for part in rig.parts
            if part.measurement is not None
        }
        measured_character = Character.from_bodies(armature, bodies, unit)
    if measured_character is None:
        raise verdict.ReadError(RIG_WITHOUT_PARTS, subject=armature.name)
    return (
        measured_character,
        settings.ground if settings.show else _find_ground(context, armature, measured_character),
        rig,
    )


def _measure_outdated(context: Context, armature: Object) -> Rig | None:
    """Measure the bones and return their measurement; None if their results are up to date."""
    is_known = weight(armature, context.evaluated_depsgraph_get()) is not None
    if is_known and stale_reason(armature, context.scene) is None:
        return None
    return measure(context, armature)


def store_rest(context: Context, armature: Object) -> None:
    """Measure the bones if necessary and possible, and store them: a posed character has its mass
    at rest.
    """
    with suppress(verdict.MeasureError):
        if (rig := _measure_outdated(context, armature)) is not None:
            stored.results.store_rig(rig)


def keep(armature: Object, measured_character: Character, ground: float, rig: Rig | None) -> None:
    """Store the ground and the measurement that `find` returned; on a linked character, which holds
    no results, remember these.
    """
    armature.body_moments_weight.ground = ground
    if rig is None:
        return
    try:
        stored.results.store_rig(rig)
    except verdict.EditRefusedError:
        memory.characters[armature] = write.properties.fingerprint(armature), measured_character
        handlers.count_change(armature)


def prepare(context: Context, armature: Object) -> Rig | None:
    """Measure a character and find its ground if necessary, and keep both. Return the new
    measurement, if any.
    """
    measured_character, ground, rig = find(context, armature)
    keep(armature, measured_character, ground, rig)
    return rig


def _find_ground(context: Context, armature: Object, measured_character: Character) -> float:
    """Return the height of a character's ground: the world's origin, or its lowest point at rest or
    as posed.

    The higher of the first two that is not above the posed character counts, else the posed lowest
    point.
    """
    with read.rig.rest_pose(context, armature) as depsgraph:
        rest = measured_character.contacts(armature, depsgraph, 0.0).height
    posed = measured_character.contacts(armature, context.evaluated_depsgraph_get(), 0.0).height
    if rest is None or posed is None:
        return armature.body_moments_weight.ground
    return max(
        (height for height in (0.0, rest) if height <= posed + REACH * measured_character.size),
        default=posed,
    )


def contact_objects(armature: Object, depsgraph: Depsgraph) -> list[tuple[Object, str | None]]:
    """Return (object, bone) of the meshes that may touch the ground, outside Edit Mode; None for
    skinned meshes.
    """
    skinned = deformed_meshes(armature)
    hanging = [
        *read.rig.hanging_objects(armature, skinned),
        *read.rig.held_objects(armature, depsgraph),
    ]
    return [
        (obj, bone)
        for obj, bone in [*((obj, None) for obj in skinned), *hanging]
        if obj.type == "MESH" and not obj.hide_render and obj.visible_get() and obj.mode != "EDIT"
    ]


def bone_matrices(armature: Object, depsgraph: Depsgraph) -> numerics.Array:
    """Return the (b, 4, 4) matrices of all pose bones in the world, as evaluated."""
    evaluated = armature.evaluated_get(depsgraph)
    posed = np.empty((len(evaluated.pose.bones), 4, 4), np.float32)
    # The view is filled in place, column by column, so that each matrix is transposed.
    evaluated.pose.bones.foreach_get("matrix", posed.ravel())
    return float64_matrix(evaluated.matrix_world) @ posed.transpose(0, 2, 1)
