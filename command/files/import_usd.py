# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""USD files as objects of the open scene, corrected by the file's prims.

Blender's importer makes polygons of round solids, drops the shear of a transform, and ignores
visibility, purpose and subdivision. Its hook tells the object of each prim.
"""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from typing import Any, NamedTuple

import bpy
import numpy as np
from bpy.types import Object
from mathutils import Matrix
from numpy.typing import NDArray

from ...blender.scene.findings import SURFACES_ROUNDED
from ...blender.scene.imports import surface_data
from ...core.cad.obj import UPRIGHT
from ...core.cad.surfaces import revolved_solid
from ...core.files.findings import FILE_UNREADABLE
from ...core.verdict.finding import FileError, Finding, finding
from ..findings import FILE_HIDES, USD_CAGE, USD_UNREAD
from .references import Opened, reported_references

_SHEAR = 1e-6  # cosine of the angle between two axes; larger than the rounding of float32


class _Prim(NamedTuple):
    """Facts about the prim of an object that Blender's importer drops.

    hidden: the reason why a renderer does not show it. scheme: the subdivision of a mesh that is a
    cage. solid: the arguments of `revolved_solid`. place: (4, 4) its matrix in the scene if that is
    sheared. is_member: of an instance.
    """

    hidden: str | None
    scheme: str | None
    solid: tuple[float, float, float, str, bool] | None
    place: NDArray[np.float64] | None
    is_member: bool


_SHAPELESS = "Points", "BasisCurves", "HermiteCurves", "NurbsCurves"  # have no volume
# of prims that are not rendered
_PURPOSES = {
    "proxy": "its purpose is proxy",
    "guide": "its purpose is guide",
}


def import_usd(path: str) -> Opened:
    """Import a USD file: solids as exact surfaces, hidden prims as objects that are not rendered.

    Raise FileError.
    """
    prims, missing = _import(path)
    members = [prim for prim in prims.values() if prim.is_member]
    is_sheared = any(prim.place is not None for prim in prims.values())
    if members and (is_sheared or any(prim.hidden or prim.scheme for prim in members)):
        # All instances show the same objects; objects of their own can be hidden, sheared and
        # reported.
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        prims, _ = _import(path, support_scene_instancing=False)
    return _correct(prims, missing)


def _import(path: str, **options: bool) -> tuple[dict[str, _Prim], tuple[Finding, ...]]:
    """Run Blender's importer, and return the prims of objects by name, and a finding about missing
    references.
    """
    # Objects left out by the importer would be missed in silence, and scaled ones have float32
    # matrices.
    options |= {"import_visible_only": False, "import_guide": True, "import_proxy": True}
    options["apply_unit_conversion_scale"] = False
    results: list[tuple[float, dict[str, _Prim], list[str]] | Exception] = []

    class BODY_MOMENTS_USD_prims(bpy.types.USDHook):
        bl_idname = "body_moments_prims"
        bl_label = "Body Moments Prims"

        @staticmethod
        def on_import(context: Any) -> bool:
            try:
                stage = _Stage(context.get_stage())
                blocks = context.get_prim_map()
                results.append((stage.unit, stage.prims(blocks), stage.unread(blocks)))
            except Exception as error:  # Blender would only print it.
                results.append(error)
            return True

    bpy.utils.expose_bundled_modules()
    bpy.utils.register_class(BODY_MOMENTS_USD_prims)
    try:
        missing = reported_references(lambda: bpy.ops.wm.usd_import(filepath=path, **options))
    finally:
        bpy.utils.unregister_class(BODY_MOMENTS_USD_prims)
    if not results or isinstance(results[0], ImportError):
        raise FileError(FILE_UNREADABLE, error="this Blender lacks the Python modules of USD")
    if isinstance(results[0], Exception):
        raise results[0]
    unit, prims, unread = results[0]
    if unread:
        missing = (*missing, finding(USD_UNREAD, names=unread))
    bpy.context.scene.unit_settings.scale_length = unit
    if not abs(bpy.context.scene.unit_settings.scale_length - unit) <= 1e-6 * unit:
        raise FileError(FILE_UNREADABLE, error="its metersPerUnit is {}".format(unit))
    return prims, missing


class _Stage:
    """An open stage at the scene's frame, in meters per `unit`.

    It is gone when Blender's importer returns.
    """

    def __init__(self, stage: Any) -> None:
        # Blender has these modules, and exposes them on request.
        usd, self._geom = (importlib.import_module("pxr." + name) for name in ("Usd", "UsdGeom"))
        self._stage = stage
        self._time = usd.TimeCode(bpy.context.scene.frame_current)
        self._places = self._geom.XformCache(self._time)
        self.unit = self._geom.GetStageMetersPerUnit(stage)
        self._to_scene = (
            UPRIGHT if self._geom.GetStageUpAxis(stage) == self._geom.Tokens.y else np.eye(4)
        )

    def prims(self, blocks: Mapping[str, list[bpy.types.ID]]) -> dict[str, _Prim]:
        """Return the facts about the prims of objects, by name. blocks: Blender's data, by the
        prims' paths.
        """
        objects = {obj.data: obj for obj in bpy.data.objects if obj.data is not None}
        pairs = [
            (self._stage.GetPrimAtPath(path), block)
            for path, found in blocks.items()
            for block in found
        ]
        prims = {block.name: prim for prim, block in pairs if isinstance(block, Object)}
        # Of an object that is merged from two prims, the geometry's prim says more.
        prims |= {objects[block].name: prim for prim, block in pairs if block in objects}
        return {name: self._facts(prim) for name, prim in prims.items()}

    def unread(self, blocks: Mapping[str, list[bpy.types.ID]]) -> list[str]:
        """Return the paths and types of visible shapes that Blender's importer leaves out."""
        # An empty stands for some of them.
        paths = {
            str(path)
            for path, found in blocks.items()
            if any(getattr(b, "type", "") != "EMPTY" for b in found)
        }
        shapes = [prim for prim in self._stage.Traverse() if prim.IsA(self._geom.Gprim)]
        left = [
            prim
            for prim in shapes
            if str(prim.GetPath()) not in paths and prim.GetTypeName() not in _SHAPELESS
        ]
        shown = [prim for prim in left if self._why_hidden(self._geom.Imageable(prim)) is None]
        return ["{} ({})".format(prim.GetPath(), prim.GetTypeName()) for prim in shown]

    def _facts(self, prim: Any) -> _Prim:
        scheme = (
            self._geom.Mesh(prim).GetSubdivisionSchemeAttr().Get()
            if prim.IsA(self._geom.Mesh)
            else "none"
        )
        place = np.array(self._places.GetLocalToWorldTransform(prim)).T
        return _Prim(
            self._why_hidden(self._geom.Imageable(prim)),
            None if scheme in ("none", "bilinear") else scheme,
            self._solid(prim),
            self._to_scene @ place if self._is_sheared(prim) else None,
            prim.IsInPrototype(),
        )

    def _why_hidden(self, imageable: Any) -> str | None:
        if imageable.ComputeVisibility(self._time) == self._geom.Tokens.invisible:
            return "it is invisible"
        return _PURPOSES.get(imageable.ComputePurpose())

    def _solid(self, prim: Any) -> tuple[float, float, float, str, bool] | None:
        kind = prim.GetTypeName().removesuffix("_1")
        if kind not in ("Sphere", "Capsule", "Cylinder", "Cone"):
            return None

        def value(name: str, other: Any) -> Any:
            attribute = prim.GetAttribute(name)
            return attribute.Get(self._time) if attribute else other

        radius = value("radius", 0.0)
        bottom = value("radiusBottom", radius)
        top = value("radiusTop", 0.0 if kind == "Cone" else radius)
        return bottom, top, value("height", 0.0), value("axis", "Z"), kind in ("Sphere", "Capsule")

    def _is_sheared(self, prim: Any) -> bool:
        """Return whether the transform of a prim, or of one above it, has axes that are not at
        right angles.
        """
        while not prim.IsPseudoRoot():
            axes = np.array(self._places.GetLocalTransformation(prim)[0])[:3, :3]
            lengths = np.linalg.norm(axes, axis=1)
            if (
                np.abs(axes @ axes.T - np.diag(lengths**2)) > _SHEAR * np.outer(lengths, lengths)
            ).any():
                return True
            prim = prim.GetParent()
        return False


def _correct(prims: Mapping[str, _Prim], missing: tuple[Finding, ...]) -> Opened:
    """Correct the objects by their prims, and return the findings."""
    bpy.context.view_layer.update()
    hidden: dict[str, Finding] = {}
    findings: dict[str, tuple[Finding, ...]] = {}
    surfaces: dict[tuple, tuple[bpy.types.Curve, float]] = {}
    for name, prim in sorted(prims.items()):
        obj = bpy.data.objects[name]
        if prim.hidden is not None:
            obj.hide_render = True
            hidden[name] = finding(FILE_HIDES, cause=prim.hidden)
        if prim.scheme is not None:
            findings[name] = (finding(USD_CAGE, scheme=prim.scheme),)
        shear = None if prim.place is None or obj.constraints else _shear(obj, prim.place)
        patch = None if prim.solid is None else revolved_solid(*prim.solid)
        if patch is not None:
            key = (prim.solid, None if shear is None else shear.tobytes())
            if key not in surfaces:
                patch = patch if shear is None else patch.transform(shear)
                surfaces[key] = surface_data(name, [patch], 1.0)[:2]
            data, moved = surfaces[key]
            findings[name] = (finding(SURFACES_ROUNDED, share=moved),) if moved else ()
            _replace(obj, data)
        elif shear is not None and obj.type == "MESH":
            obj.data.transform(Matrix(shear))
    bpy.context.view_layer.update()
    return Opened(missing, (), findings, hidden)


def _shear(obj: Object, place: NDArray[np.float64]) -> NDArray | None:
    """Return the (4, 4) map that the matrix of an object lacks, or None if it is flat and has no
    volume.
    """
    matrix = np.array(obj.matrix_world, np.float64)
    return np.linalg.solve(matrix, place) if np.linalg.det(matrix) else None


def _replace(obj: Object, data: bpy.types.Curve) -> None:
    """Replace an object by one with other data of another type, in its place and under its name."""
    name = obj.name
    new = bpy.data.objects.new(name, data)
    for slot in obj.data.materials if not data.materials else ():
        data.materials.append(slot)
    new.parent = obj.parent
    new.matrix_parent_inverse = obj.matrix_parent_inverse
    new.matrix_basis = obj.matrix_basis
    new.hide_render = obj.hide_render
    for constraint in obj.constraints:
        new.constraints.copy(constraint)
    for collection in obj.users_collection:
        collection.objects.link(new)
    for child in obj.children:
        child.parent = new
    bpy.data.objects.remove(obj)
    new.name = name
