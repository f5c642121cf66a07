# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""USD files as objects of the open scene, corrected by the file's prims.

Blender's importer makes polygons of round solids, drops the shear of a transform, and ignores
visibility, purpose and subdivision. Its hook tells the object of each prim.
"""

import importlib
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import bpy
import numpy as np
from bpy.types import Object

from ...blender import read, scene
from ...core import cad, files
from ...core.numerics import Array, NDArray
from ...core.verdict import FileError, Finding, finding
from ..findings import FILE_HIDES, FRAME_MEASURED, USD_CAGE, USD_UNREAD
from . import placing, references

# Chosen, cosine of the angle between two axes: larger than the rounding of float32, 6e-8.
_SHEAR = 1e-6


class _Prim(NamedTuple):
    """Facts about the prim of an object that Blender's importer drops.

    hidden: the reason why a renderer does not show it. scheme: the subdivision of a mesh that is a
    cage. solid: the arguments of `revolved_solid`. place: (4, 4) its matrix in the scene.
    is_member: of an instance. points: (n, 3) of a mesh that moves. members: of an instancer, the
    names of the objects that it shows, each with its (k, 4, 4) places relative to it. Each is None
    if it does not apply.
    """

    hidden: str | None
    scheme: str | None
    solid: tuple[float, float, float, str, bool] | None
    place: Array
    is_member: bool
    points: Array | None
    members: Mapping[str, Array] | None


_SHAPELESS = "Points", "BasisCurves", "HermiteCurves", "NurbsCurves"  # have no volume
# of prims that are not rendered
_PURPOSES = {"proxy": "its purpose is proxy", "guide": "its purpose is guide"}


def import_usd(path: str, frame: float | None) -> references.Opened:
    """Import a USD file: each object at the place that the file states at the frame, by default its
    first, solids as exact surfaces, hidden prims as objects that are not rendered. Raise FileError.
    """
    prims, missing, start = _import(path, frame)
    members = [prim for prim in prims.values() if prim.is_member]
    has_instancer = any(prim.members is not None for prim in prims.values())
    if members and (has_instancer or any(map(_is_special, members))):
        # All instances show the same objects; objects of their own can be hidden, sheared and
        # reported.
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        prims, missing, start = _import(path, frame, support_scene_instancing=False)
    return _correct(prims, missing, start)


def _is_special(prim: _Prim) -> bool:
    """Return whether an object needs a correction of its own, which a member of an instance cannot
    have.
    """
    axes = prim.place[:3, :3]
    lengths = np.linalg.norm(axes, axis=0)
    products = np.abs(axes.T @ axes - np.diag(lengths**2))  # products of different axes
    is_sheared = (products > _SHEAR * np.outer(lengths, lengths)).any()
    return bool(prim.hidden or prim.scheme or is_sheared or prim.points is not None)


def _import(
    path: str, frame: float | None, **options: bool
) -> tuple[dict[str, _Prim], tuple[Finding, ...], float | None]:
    """Run Blender's importer at a frame, set the scene's unit, and return the prims of objects by
    name, findings about missing references and shapes, and the frame, None without animation.

    options: of the importer. Raises FileError.
    """
    # Objects left out by the importer would be missed in silence, and scaled ones have float32
    # matrices.
    options |= {"import_visible_only": False, "import_guide": True, "import_proxy": True}
    options["apply_unit_conversion_scale"] = False
    results: list[Any] = []  # one tuple, or an exception

    class BODY_MOMENTS_USD_prims(bpy.types.USDHook):
        bl_idname = "body_moments_prims"
        bl_label = "Body Moments Prims"

        @staticmethod
        def on_import(context: Any) -> bool:
            try:
                stage = _Stage(context.get_stage(), frame)
                blocks = context.get_prim_map()
                results.append((stage.unit, stage.prims(blocks), stage.unread(blocks), stage.start))
            except Exception as error:  # Blender would only print it.
                results.append(error)
            return True

    bpy.utils.expose_bundled_modules()
    bpy.utils.register_class(BODY_MOMENTS_USD_prims)
    try:
        missing = references.reported_references(
            lambda: bpy.ops.wm.usd_import(filepath=path, **options)
        )
    finally:
        bpy.utils.unregister_class(BODY_MOMENTS_USD_prims)
    if not results or isinstance(results[0], ImportError):
        raise FileError(files.FILE_UNREADABLE, error="this Blender lacks the Python modules of USD")
    if isinstance(results[0], Exception):
        raise results[0]
    unit, prims, unread, start = results[0]
    if start is not None:
        placing.set_frame(start)
    if unread:
        missing = (*missing, finding(USD_UNREAD, names=unread))
    bpy.context.scene.unit_settings.scale_length = unit
    # Blender clamps a unit beyond its limits, and rounds others to float32, by 6e-8 at most.
    if not abs(bpy.context.scene.unit_settings.scale_length - unit) <= 1e-6 * unit:
        raise FileError(files.FILE_UNREADABLE, error="its metersPerUnit is {}".format(unit))
    return prims, missing, start


class _Stage:
    """An open stage at a frame. unit: of its lengths, in meters. start: the frame, None without
    animation.

    The stage is gone when Blender's importer returns.
    """

    def __init__(self, stage: Any, frame: float | None) -> None:
        # Blender has these modules, and exposes them on request.
        self._usd, self._geom, self._skel = (
            importlib.import_module("pxr." + name) for name in ("Usd", "UsdGeom", "UsdSkel")
        )
        self._stage = stage
        stage.SetInterpolationType(self._usd.InterpolationTypeLinear)  # Blender holds values.
        self.start = self._first_time()
        if self.start is not None and frame is not None:
            self.start = frame
        self._time = self._usd.TimeCode(
            bpy.context.scene.frame_current if self.start is None else self.start
        )
        self._places = self._geom.XformCache(self._time)
        self.unit = self._geom.GetStageMetersPerUnit(stage)
        self._to_scene = (
            cad.UPRIGHT if self._geom.GetStageUpAxis(stage) == self._geom.Tokens.y else np.eye(4)
        )

    def _first_time(self) -> float | None:
        """Return the stated first frame, else the first that has values, None without animation."""
        firsts = [
            attribute.GetTimeSamples()[0]
            for prim in self._stage.TraverseAll()
            for attribute in prim.GetAuthoredAttributes()
            if attribute.GetNumTimeSamples()
        ]
        if firsts and self._stage.HasAuthoredTimeCodeRange():
            return self._stage.GetStartTimeCode()
        return min(firsts, default=None)

    def prims(self, blocks: Mapping[str, list[bpy.types.ID]]) -> dict[str, _Prim]:
        """Return the facts about the prims of objects, by name. blocks: Blender's data, by the
        prims' paths.
        """
        objects = {obj.data: obj for obj in bpy.data.objects if obj.data is not None}
        pairs = [
            (self._stage.GetPrimAtPath(path), block)
            for path, data_blocks in blocks.items()
            for block in data_blocks
        ]
        prims = {block.name: prim for prim, block in pairs if isinstance(block, Object)}
        # Of an object that is merged from two prims, the geometry's prim says more.
        prims |= {objects[block].name: prim for prim, block in pairs if block in objects}
        names = {prim.GetPath(): name for name, prim in prims.items()}
        facts = {name: self._facts(prim, names) for name, prim in prims.items()}
        # Baking changes the stage, so that the facts are read before.
        moving = self._moving_points()
        return {
            name: fact._replace(points=moving.get(prims[name].GetPath()))
            for name, fact in facts.items()
        }

    def _moving_points(self) -> dict[Any, Array]:
        """Return the points of skinned and animated meshes by their paths, in their own
        coordinates.
        """
        points = {
            prim: self._geom.Mesh(prim).GetPointsAttr()
            for prim in self._stage.Traverse()
            if prim.IsA(self._geom.Mesh)
        }
        bound = {
            prim
            for prim in points
            if self._skel.BindingAPI(prim).GetJointIndicesAttr().HasAuthoredValue()
            or self._skel.BindingAPI(prim).GetBlendShapesAttr().HasAuthoredValue()
        }
        moving = {prim for prim in points if points[prim].GetNumTimeSamples() > 1}
        if bound:
            # Blender's modifiers may read the other layers again.
            self._stage.SetEditTarget(self._stage.GetSessionLayer())
            self._skel.BakeSkinning(self._stage.Traverse())
        return {prim.GetPath(): np.array(points[prim].Get(self._time)) for prim in bound | moving}

    def unread(self, blocks: Mapping[str, list[bpy.types.ID]]) -> list[str]:
        """Return the paths and types of visible shapes that Blender's importer leaves out."""
        # An empty stands for some of them.
        paths = {
            str(path)
            for path, data_blocks in blocks.items()
            if any(getattr(block, "type", "") != "EMPTY" for block in data_blocks)
        }
        return [
            "{} ({})".format(prim.GetPath(), prim.GetTypeName())
            for prim in self._stage.Traverse()
            if prim.IsA(self._geom.Gprim)
            and str(prim.GetPath()) not in paths
            and prim.GetTypeName() not in _SHAPELESS
            and self._why_hidden(self._geom.Imageable(prim)) is None
        ]

    def _facts(self, prim: Any, names: Mapping[Any, str]) -> _Prim:
        """Return the facts about a prim, without moving points. names: of objects, by the paths of
        their prims.
        """
        mesh = self._geom.Mesh(prim)
        scheme = mesh.GetSubdivisionSchemeAttr().Get() if mesh else None
        members = None
        if prim.IsA(self._geom.PointInstancer):
            member_places: dict[str, list[NDArray]] = {}
            for path, matrices in self._members(prim):
                if path in names:
                    member_places.setdefault(names[path], []).append(matrices)
            members = {name: np.concatenate(blocks) for name, blocks in member_places.items()}
        return _Prim(
            self._why_hidden(self._geom.Imageable(prim)),
            None if scheme in ("none", "bilinear") else scheme,
            self._solid(prim),
            self._to_scene @ np.array(self._places.GetLocalToWorldTransform(prim)).T,
            prim.IsInPrototype(),
            None,
            members,
        )

    def _members(self, instancer: Any) -> Iterator[tuple[Any, Array]]:
        """Yield the paths of shapes that an instancer shows, and their (k, 4, 4) places in it."""
        schema = self._geom.PointInstancer(instancer)
        matrices = np.array(
            schema.ComputeInstanceTransformsAtTime(
                self._time,
                self._time,
                self._geom.PointInstancer.IncludeProtoXform,
                self._geom.PointInstancer.IgnoreMask,
            ),
            np.float64,
        ).reshape(-1, 4, 4)
        indices = np.array(schema.GetProtoIndicesAttr().Get(self._time) or [], int)
        mask = schema.ComputeMaskAtTime(self._time)
        is_shown = np.array(mask, bool) if len(mask) else np.ones(len(indices), bool)
        for number, target in enumerate(schema.GetPrototypesRel().GetForwardedTargets()):
            prototype_places = matrices[is_shown & (indices == number)].transpose(0, 2, 1)
            root = self._stage.GetPrimAtPath(target)
            for path, local in self._shapes(root, root) if root and len(prototype_places) else ():
                yield path, (prototype_places[:, None] @ local).reshape(-1, 4, 4)

    def _shapes(self, prim: Any, root: Any) -> Iterator[tuple[Any, Array]]:
        """Yield the shapes of a prototype that are shown, and their places relative to its root."""
        imageable = self._geom.Imageable(prim)
        if imageable and (
            imageable.GetVisibilityAttr().Get(self._time) == self._geom.Tokens.invisible
            or imageable.GetPurposeAttr().Get() in _PURPOSES
        ):
            return
        local = np.array(self._places.ComputeRelativeTransform(prim, root)[0]).T
        if prim.IsA(self._geom.PointInstancer):
            yield from ((path, local @ matrices) for path, matrices in self._members(prim))
            return
        if prim.IsA(self._geom.Gprim):
            yield prim.GetPath(), local[None]
        children = self._usd.TraverseInstanceProxies(self._usd.PrimDefaultPredicate)
        for child in prim.GetFilteredChildren(children):
            yield from self._shapes(child, root)

    def _why_hidden(self, imageable: Any) -> str | None:
        """Return the reason why a renderer does not show a prim, or None. A prim below an instancer
        is a prototype.
        """
        above = imageable.GetPrim().GetParent()
        if imageable.ComputeVisibility(self._time) == self._geom.Tokens.invisible:
            return "it is invisible"
        purpose = _PURPOSES.get(imageable.ComputePurpose())
        while purpose is None and above:
            if above.IsA(self._geom.PointInstancer):
                return "it is only shown by its instancer, if at all"
            above = above.GetParent()
        return purpose

    def _solid(self, prim: Any) -> tuple[float, float, float, str, bool] | None:
        """Return the radii at bottom and top, the height and the axis of a round solid, and whether
        its ends are round; None for other prims.
        """
        kind = prim.GetTypeName().removesuffix("_1")
        if kind not in ("Sphere", "Capsule", "Cylinder", "Cone"):
            return None
        values = {
            attribute.GetName(): attribute.Get(self._time) for attribute in prim.GetAttributes()
        }
        radius = values.get("radius", 0.0)
        bottom = values.get("radiusBottom", radius)
        top = values.get("radiusTop", 0.0 if kind == "Cone" else radius)
        is_round = kind in ("Sphere", "Capsule")
        return bottom, top, values.get("height", 0.0), values.get("axis", "Z"), is_round


def _correct(
    prims: Mapping[str, _Prim], missing: tuple[Finding, ...], start: float | None
) -> references.Opened:
    """Correct the imported objects by their prims, and return the findings.

    missing, start: as of `_import`. Solids, points and places come first; members of instancers are
    copies of the corrected objects.
    """
    bpy.context.view_layer.update()
    hidden: dict[str, Finding] = {}
    notes = () if start is None else (finding(FRAME_MEASURED, frame=start),)
    findings: dict[str, tuple[Finding, ...]] = {}
    surfaces: dict[tuple, tuple[bpy.types.Curve, float]] = {}
    for name, prim in sorted(prims.items()):
        obj = bpy.data.objects[name]
        if prim.hidden is not None:
            hidden[name] = finding(FILE_HIDES, cause=prim.hidden)
        if prim.scheme is not None:
            findings[name] = (finding(USD_CAGE, scheme=prim.scheme),)
        patch = None if prim.solid is None else cad.revolved_solid(*prim.solid)
        if prim.solid is not None and patch is not None:
            if prim.solid not in surfaces:
                surfaces[prim.solid] = scene.imports.surface_data(name, [patch], 1.0)[:2]
            data, shift = surfaces[prim.solid]
            if shift:
                findings[name] = (finding(scene.findings.SURFACES_ROUNDED, share=shift),)
            _replace(obj, data)
        elif prim.points is not None and len(prim.points) == len(obj.data.vertices):
            obj.modifiers.clear()
            obj.shape_key_clear()
            obj.data.attributes["position"].data.foreach_set(
                "vector", prim.points.astype(np.float32).ravel()
            )
    places = {name: prim.place for name, prim in prims.items() if prim.members is None}
    placing.place_objects(places)
    for name, prim in prims.items():
        if prim.members is not None:
            _show_members(name, prim)
            member_findings = [
                member_finding
                for member in prim.members
                for member_finding in findings.get(member, ())
            ]
            findings[name] = tuple(dict.fromkeys(member_findings))
        elif prim.hidden is None and not prim.is_member:
            obj = bpy.data.objects[name]
            top = bpy.context.scene.collection
            if _rendered(top).isdisjoint(obj.users_collection):
                top.objects.link(obj)
            obj.hide_render = False
    bpy.context.view_layer.update()
    return references.Opened(missing, notes, findings, hidden)


def _rendered(collection: bpy.types.Collection) -> set[bpy.types.Collection]:
    """Return a collection and those in it, as far as they are rendered and shown."""
    if collection.hide_render or collection.hide_viewport:
        return set()
    return {collection}.union(*map(_rendered, collection.children))


def _show_members(name: str, prim: _Prim) -> None:
    """Replace an instancer by an empty that shows the shapes of its prototypes in their places."""
    old = bpy.data.objects[name]
    collection = bpy.data.collections.new(name)
    for member, matrices in (prim.members or {}).items():
        copy = bpy.data.objects[member].copy()
        copy.parent = None
        copy.hide_render = copy.hide_viewport = False
        read.places.set_places(copy, matrices)
        collection.objects.link(copy)
    obj = bpy.data.objects.new(name, None)
    obj.instance_type, obj.instance_collection = "COLLECTION", collection
    _take_place(obj, old)
    placing.place_objects({name: prim.place})


def _replace(obj: Object, data: bpy.types.Curve) -> None:
    """Replace an object by one with other data of another type, in its place and under its name."""
    new = bpy.data.objects.new(obj.name, data)
    for slot in obj.data.materials if not data.materials else ():
        data.materials.append(slot)
    new.parent = obj.parent
    new.matrix_parent_inverse = obj.matrix_parent_inverse
    new.matrix_basis = obj.matrix_basis
    for constraint in obj.constraints:
        new.constraints.copy(constraint)
    for child in obj.children:
        child.parent = new
    _take_place(new, obj)


def _take_place(new: Object, old: Object) -> None:
    """Give an object the name, the collections and the visibility of one that it replaces."""
    name = old.name
    new.hide_render = old.hide_render
    for collection in old.users_collection:
        collection.objects.link(new)
    bpy.data.objects.remove(old)
    new.name = name
