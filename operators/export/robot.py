# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""File > Export, and the exporters of collections: measured objects as URDF, SDF, MJCF, USD or glTF.

The exporters of collections keep their path and options in the .blend; Blender runs them again by Export All.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

import bpy
from bpy.props import BoolProperty, EnumProperty, StringProperty
from bpy.types import Context, FileHandler, Menu, Object, Operator, UILayout
from bpy_extras.io_utils import ExportHelper

from ...blender.read.robots import USD_ROOT, sheared_objects, usd_path
from ...blender.session import robots as scenes
from ...blender.session.robots import SceneLinks
from ...blender.write import reports
from ...core.files.whole_file import whole_file
from ...core.robots.findings import ROBOT_SCALED
from ...core.robots.formats import FORMATS, RobotFormat
from ...core.robots.write import gltf, usd
from ...core.robots.write.shapes import with_primitives
from ...core.robots.write.texts import robot_text, with_geometry
from ...core.verdict.finding import EditRefusedError, FileError, Finding, MeasureError, finding, system_reason
from ...core.verdict.sentences import sentence
from .. import selection
from ..findings import (
    ROBOT_EXPORTED,
    ROBOT_GEOMETRY_NOT_WRITTEN,
    ROBOT_NAMES_ALIKE,
    ROBOT_NOT_WRITTEN,
    ROBOT_SHEARED,
)
from ..modal import progress
from .copy_inertial import OBJECT_OT_body_moments_copy_inertial

LINKS = (
    ("OBJECT", "Objects", "Each object is a link; its parent holds it by a fixed joint"),
    ("COLLECTION", "Collections", "Each collection with all that it holds is a link, along the world's axes"),
    ("BONE", "Bones", "Each bone of a character is a link in its rest frame, with joints of the bones' limits"),
)
GEOMETRY = (
    ("MESH", "Meshes", "Write a mesh for each link, in meters"),
    ("BOX", "Boxes", "The box of the same mass, center and inertia"),
    ("ELLIPSOID", "Ellipsoids", "The ellipsoid of the same mass, center and inertia"),
    ("CAPSULE", "Capsules", "The capsule of the same mass and center, with the inertia that comes nearest"),
    ("NONE", "None", "Links have no geometry"),
)


class RobotExport(ExportHelper):
    """The common base of the exporters. FORMAT: a name of the table of formats."""

    FORMAT = ""
    bl_options = {"REGISTER", "PRESET"}

    use_selection: BoolProperty(
        name="Selected Objects", description="Export selected objects only, else all that are rendered", default=False
    )
    collection: StringProperty(name="Source Collection", options={"HIDDEN"})
    links: EnumProperty(name="Links", description="What is one rigid body", items=LINKS, default="OBJECT")
    geometry: EnumProperty(name="Geometry", description="What links look like and collide as", items=GEOMETRY)
    inertial_only: BoolProperty(
        name="Inertials Only", description="Write mass, center and inertia of each link and nothing else", default=False
    )

    @classmethod
    def poll(cls, context: Context) -> bool:
        if context.mode != "OBJECT":
            return reports.unavailable(cls, "Switch to Object Mode")
        return True

    def execute(self, context: Context) -> set[str]:
        try:
            objects = scenes.candidates(context, self.collection, self.use_selection)
            findings = self._export(context, objects, Path(bpy.path.abspath(self.filepath)))
        except MeasureError as error:
            selection.report(self, reports.refusal(error))
            return {"CANCELLED"}
        except OSError as error:
            selection.report(self, finding(ROBOT_NOT_WRITTEN, error=system_reason(error)))
            return {"CANCELLED"}
        selection.report(self, *findings)
        return {"FINISHED"}

    def _links(self, context: Context, objects: list[Object], name: str) -> SceneLinks:
        if self.links == "BONE":
            return scenes.bone_links(context, name, objects)
        if self.links == "COLLECTION":
            root = bpy.data.collections[self.collection] if self.collection else context.scene.collection
            return scenes.collection_links(context, name, root, objects)
        with progress(len(objects)) as step:
            return scenes.object_links(context, name, objects, step)

    def _export(self, context: Context, objects: list[Object], path: Path) -> list[Finding]:
        made = self._links(context, objects, path.stem)
        robot, bare = made.robot, []
        if self.geometry != "MESH":
            robot = with_primitives(robot, self.geometry.lower())
        elif not self.inertial_only:
            robot, bare = with_geometry(robot, self.FORMAT, partial(made.surface, context), path)
        text, findings = robot_text(robot, self.FORMAT, [*made.findings, *bare], inertial_only=self.inertial_only)
        with whole_file(path) as file:
            file.write(self._encode(text, path))
        return [finding(ROBOT_EXPORTED, count=len(robot.links), file=path.name), *findings]

    def _encode(self, text: str, _path: Path) -> bytes:
        return text.encode("utf-8")

    def draw(self, _context: Context) -> None:
        layout = self.layout
        layout.use_property_split, layout.use_property_decorate = True, False
        if not self.collection:
            layout.prop(self, "use_selection")
        self._draw_options(layout)

    def _draw_options(self, layout: UILayout) -> None:
        layout.prop(self, "links")
        layout.prop(self, "inertial_only")
        column = layout.column()
        column.enabled = not self.inertial_only
        column.prop(self, "geometry")


class GeometryExport(RobotExport):
    """Base of exporters that leave the geometry of objects to Blender's own exporter; all else is a file of our own."""

    _export_over: Callable[[Context, SceneLinks, Path], list[Finding]]  # writes the geometry as Blender does, with the
    # masses, and returns what is to be said about them

    def _export(self, context: Context, objects: list[Object], path: Path) -> list[Finding]:
        if self.links != "OBJECT" or self.geometry != "MESH" or self.inertial_only:
            return super()._export(context, objects, path)
        made = self._links(context, objects, path.stem)
        sheared = sheared_objects([obj for held in made.members.values() for obj in held])
        if sheared:
            made.findings.append(finding(ROBOT_SHEARED, count=len(sheared), links=sheared))
        findings = self._export_over(context, made, path)
        return [finding(ROBOT_EXPORTED, count=len(made.robot.links), file=path.name), *findings]

    def _run_exporter(self, exporter: str, path: Path, options: dict) -> None:
        """Run Blender's own exporter on the same objects."""
        module, name = exporter.split(".")
        try:
            result = getattr(getattr(bpy.ops, module), name)(filepath=str(path), collection=self.collection, **options)
        except (AttributeError, RuntimeError) as error:  # a Blender may be built without it
            raise FileError(ROBOT_GEOMETRY_NOT_WRITTEN, error=" ".join(str(error).split())) from error
        if "FINISHED" not in result or not path.is_file():
            raise FileError(ROBOT_GEOMETRY_NOT_WRITTEN, error=exporter)


class UsdExport(GeometryExport):
    """Base of the exporter whose layer of masses lies over Blender's layer."""

    def _export_over(self, context: Context, made: SceneLinks, path: Path) -> list[Finding]:
        robot, findings = made.robot, made.findings
        paths = {label: usd_path(held[0], usd.identifier) for label, held in made.members.items()}
        alike = [label for label, prim in paths.items() if list(paths.values()).count(prim) > 1]
        if alike:
            raise EditRefusedError(ROBOT_NAMES_ALIKE, names=alike)
        findings += usd.check(robot)
        geometry = path.with_name(path.stem + "_geometry.usdc")
        options = {"selected_objects_only": self.use_selection, "root_prim_path": "/" + USD_ROOT}
        self._run_exporter("wm.usd_export", geometry, options)
        scaled = [link.name for link in robot.roots if min(link.scale) < 0.0]
        if scaled:
            findings.append(finding(ROBOT_SCALED, count=len(scaled), links=scaled))
        remarks = list(map(sentence, findings))
        text = usd.write_over(robot, paths, "./" + geometry.name, made.unit, remarks)
        with whole_file(path) as file:
            file.write(text.encode("utf-8"))
        return findings


class GltfExport(GeometryExport):
    """Base of the exporter that adds bodies to the file of Blender's exporter."""

    def _export_over(self, context: Context, made: SceneLinks, path: Path) -> list[Finding]:
        findings = made.findings
        options = {"use_selection": self.use_selection, "export_format": "GLB", "export_yup": True}
        self._run_exporter("export_scene.gltf", path, options)
        data = path.read_bytes()
        try:
            document = gltf.read_json(data)
        except ValueError as error:
            raise FileError(ROBOT_GEOMETRY_NOT_WRITTEN, error=path.name) from error
        findings += gltf.add_rigid_bodies(document, made.robot, made.unit)
        with whole_file(path) as file:
            file.write(gltf.replace_json(data, document))
        return findings

    def _encode(self, text: str, path: Path) -> bytes:
        return gltf.to_glb(text) if path.suffix.lower() == ".glb" else text.encode("utf-8")


BASES = {"usd": UsdExport, "gltf": GltfExport}  # The other formats are files of our own alone.


def _exporter(form: RobotFormat) -> type[RobotExport]:
    """Return the exporter of a format."""
    members = {
        "FORMAT": form.name,
        "bl_idname": "export_scene.body_moments_" + form.name,
        "bl_label": form.export_label,
        "bl_description": form.export_tip,
        "filename_ext": form.suffix,
        "__annotations__": {"filter_glob": StringProperty(default="*" + form.suffix, options={"HIDDEN"})},
    }
    bases = BASES.get(form.name, RobotExport), Operator
    return type("EXPORT_SCENE_OT_body_moments_" + form.name, bases, members)


def _file_handler(form: RobotFormat) -> type[FileHandler]:
    """Return the file handler that makes an exporter a collection exporter."""
    name = "IO_FH_body_moments_{}".format(form.name)
    members = {
        "bl_idname": name,
        "bl_label": form.label,
        "bl_export_operator": "export_scene.body_moments_" + form.name,
        "bl_file_extensions": form.suffix,
        "poll_drop": classmethod(lambda _cls, _context: False),
    }
    return type(name, (FileHandler,), members)


class TOPBAR_MT_body_moments_export(Menu):
    """Formats of robots and engines, with exact mass properties"""

    bl_idname = "TOPBAR_MT_body_moments_export"
    bl_label = "Mass Properties"

    def draw(self, _context: Context) -> None:
        for form in FORMATS.values():
            text = "{} ({})".format(form.label, form.suffix)
            self.layout.operator("export_scene.body_moments_" + form.name, text=text, translate=False)
        self.layout.separator()
        self.layout.operator_menu_enum(OBJECT_OT_body_moments_copy_inertial.bl_idname, "format")


def _menu(menu: Menu, _context: Context) -> None:
    menu.layout.menu(TOPBAR_MT_body_moments_export.bl_idname)


CLASSES = (
    *map(_exporter, FORMATS.values()),
    *map(_file_handler, FORMATS.values()),
    TOPBAR_MT_body_moments_export,
)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.TOPBAR_MT_file_export.append(_menu)


def unregister() -> None:
    bpy.types.TOPBAR_MT_file_export.remove(_menu)
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
