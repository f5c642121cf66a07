# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""File > Export, and the exporters of collections: measured objects as URDF, SDF, MJCF, USD or
glTF.

The exporters of collections keep their path and options in the .blend; Blender runs them again by
Export All.
"""

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import bpy
from bpy.props import BoolProperty, EnumProperty, StringProperty
from bpy.types import Context, FileHandler, Menu, Object, Operator
from bpy_extras.io_utils import ExportHelper

from ...blender import session
from ...blender.write import reports
from ...blender.write.findings import FILE_NOT_WRITTEN
from ...core import files, verdict
from ...core.robots import FORMATS, ROBOT_SCALED, UNIT_SCALE, USD_SCALED, RobotFormat, write
from .. import selection
from ..findings import ROBOT_GEOMETRY_NOT_WRITTEN, ROBOT_NAMES_ALIKE
from ..measure.copy import VIEW3D_MT_body_moments_copy

if TYPE_CHECKING:
    from ...blender.session.robots import SceneLinks

LINKS = (
    (
        "OBJECT",
        "Objects",
        "Each object is a link; rigid-body constraints are joints, and parents hold by fixed "
        "joints",
    ),
    (
        "COLLECTION",
        "Collections",
        "Each collection with all that it holds is a link, along the world's axes",
    ),
    (
        "BONE",
        "Bones",
        "Each bone of a character is a link in its rest frame, with joints of the bones' limits",
    ),
)
GEOMETRY = (
    ("MESH", "Meshes", "Write a mesh for each link, in meters"),
    ("BOX", "Boxes", "The box of the same mass, center and inertia"),
    ("ELLIPSOID", "Ellipsoids", "The ellipsoid of the same mass, center and inertia"),
    (
        "CAPSULE",
        "Capsules",
        "The capsule of the same mass and center, with the inertia that comes nearest",
    ),
    ("NONE", "None", "Links have no geometry"),
)


class RobotExport(selection.InObjectMode, ExportHelper):
    """The common base of the exporters. FORMAT: a name of the table of formats."""

    FORMAT = ""
    bl_options = {"REGISTER", "PRESET"}

    use_selection: BoolProperty(
        name="Selected Objects",
        description="Export selected objects only, else all that are rendered",
    )
    collection: StringProperty(name="Source Collection", options={"HIDDEN"})
    links: EnumProperty(
        name="Links", description="What is one rigid body", items=LINKS, default="OBJECT"
    )
    geometry: EnumProperty(
        name="Geometry", description="What links look like and collide as", items=GEOMETRY
    )
    use_collision: BoolProperty(
        name="Collision",
        description="Links collide as they look; else their geometry is only seen",
        default=True,
    )
    fixed_base: BoolProperty(
        name="Fixed Base",
        description="Fix links without a parent to the world; else passive rigid bodies alone",
    )
    merge_fixed: BoolProperty(
        name="Merge Fixed Links",
        description="Put links on fixed joints into their parents; frames that joints need stay, "
        "without mass",
    )
    mesh_format: EnumProperty(
        name="Mesh Files",
        description="Format of the files of meshes",
        items=(
            ("STL", "STL", "Binary STL"),
            ("OBJ", "OBJ", "Wavefront OBJ, the only one that Drake reads from MJCF"),
        ),
    )
    inertial_only: BoolProperty(
        name="Inertials Only",
        description="Write mass, center and inertia of each link and nothing else",
    )

    @selection.report_refusals
    def execute(self, context: Context) -> set[str]:
        path = Path(bpy.path.abspath(self.filepath))
        objects = session.robots.candidates(context, self.collection, self.use_selection)
        links = self._links(context, objects, path.stem)
        links = replace(links, robot=links.robot.with_fixed_roots()) if self.fixed_base else links
        findings = self._export(context, links, path)
        return selection.report(
            self,
            reports.phrase(
                "{count} link exported to {file}.",
                "{count} links exported to {file}.",
                count=len(links.robot.links),
                file=path.name,
            ),
            *findings,
        )

    def _links(self, context: Context, objects: list[Object], name: str) -> "SceneLinks":
        if self.links == "BONE":
            return session.robots.bone_links(context, name, objects)
        if self.links == "COLLECTION":
            root = (
                bpy.data.collections[self.collection]
                if self.collection
                else context.scene.collection
            )
            return session.robots.collection_links(context, name, root, objects)
        with reports.progress(len(objects)) as step:
            return session.robots.object_links(context, name, objects, step)

    def _export(self, context: Context, links: "SceneLinks", path: Path) -> list[verdict.Finding]:
        # writes the files of meshes, too; returns the findings about them and the robot
        if self.geometry == "MESH" and self.use_collision and not self.inertial_only:
            links = links.with_colliders()
        robot = links.robot
        geometry_findings = []
        if self.geometry != "MESH":
            robot = write.shapes.with_primitives(robot, self.geometry.lower())
        if not self.use_collision:
            robot = write.shapes.without_collision(robot)
        if self.geometry == "MESH" and not self.inertial_only:
            try:
                robot, geometry_findings = write.texts.with_geometry(
                    robot,
                    self.FORMAT,
                    partial(links.surface, context),
                    path,
                    mesh_format=self.mesh_format.lower(),
                )
            except OSError as error:
                raise verdict.FileError(
                    FILE_NOT_WRITTEN, file=path.name, error=verdict.system_reason(error)
                ) from error
        robot = write.joints.merge_fixed(robot) if self.merge_fixed else robot
        all_findings = [*links.findings, *geometry_findings]
        text, findings = write.texts.robot_text(
            robot, self.FORMAT, all_findings, inertial_only=self.inertial_only
        )
        selection.write_file(path, [self._encode(text, path)])
        return findings

    def _encode(self, text: str, _path: Path) -> bytes:
        return text.encode("utf-8")

    def draw(self, _context: Context) -> None:
        self.layout.use_property_decorate = False
        first_properties = () if self.collection else ("use_selection",)
        selection.draw_properties(self, *first_properties, "links", "inertial_only")
        meshes = () if FORMATS[self.FORMAT].holds_meshes else ("mesh_format",)
        column = selection.draw_properties(
            self, "fixed_base", "merge_fixed", "geometry", *meshes, "use_collision"
        )
        column.enabled = not self.inertial_only


class GeometryExport(RobotExport):
    """Base of exporters that leave the geometry of objects to Blender's own exporter."""

    def _export(self, context: Context, links: "SceneLinks", path: Path) -> list[verdict.Finding]:
        # Blender's exporters write the meshes of objects, and nothing else.
        needs_own_file = self.links != "OBJECT" or self.geometry != "MESH" or self.inertial_only
        has_colliders = self.use_collision and any(
            not shape.seen for link in links.with_colliders().robot.links for shape in link.shapes
        )
        # Blender's exporters nest prims and nodes by parents: nested ones cannot move freely. And
        # they would show colliders.
        if needs_own_file or has_colliders or any(joint.free for joint in links.robot.joints):
            return super()._export(context, links, path)
        links.findings.extend(write.texts.check(links.robot, self.FORMAT))
        sheared = session.robots.sheared_objects(
            [obj for objects in links.members.values() for obj in objects]
        )
        if sheared:
            links.findings.append(verdict.finding(ROBOT_SCALED, count=len(sheared), links=sheared))
        return self._export_over(links, path)

    def _export_over(self, links: "SceneLinks", path: Path) -> list[verdict.Finding]:
        """Write the geometry by Blender's exporter, with our masses; return the findings about the
        robot.
        """
        raise NotImplementedError

    def _run_exporter(self, exporter: str, path: Path, options: dict) -> None:
        """Run Blender's own exporter, such as "wm.usd_export", on the same objects.

        Raise FileError if it fails, or leaves no file.
        """
        module, name = exporter.split(".")
        try:
            result = getattr(getattr(bpy.ops, module), name)(
                filepath=str(path), collection=self.collection, **options
            )
        except (AttributeError, RuntimeError) as error:  # a Blender may be built without it
            raise verdict.FileError(
                ROBOT_GEOMETRY_NOT_WRITTEN, error=" ".join(str(error).split())
            ) from error
        if "FINISHED" not in result or not path.is_file():
            raise verdict.FileError(ROBOT_GEOMETRY_NOT_WRITTEN, error=exporter)


class UsdExport(GeometryExport):
    """Base of the USD exporter: a layer with masses refers to that of Blender's exporter."""

    def _export_over(self, links: "SceneLinks", path: Path) -> list[verdict.Finding]:
        robot = links.robot
        findings = links.findings
        usd = write.usd
        # by link, its prim in Blender's layer
        paths = {
            label: session.robots.usd_path(objects[0], usd.identifier)
            for label, objects in links.members.items()
        }
        alike = [label for label, prim in paths.items() if list(paths.values()).count(prim) > 1]
        if alike:
            raise verdict.EditRefusedError(ROBOT_NAMES_ALIKE, names=alike)
        geometry = path.with_name(path.stem + "_geometry.usdc")
        options = {
            "selected_objects_only": self.use_selection,
            "root_prim_path": "/" + session.robots.USD_ROOT,
        }
        self._run_exporter("wm.usd_export", geometry, options)
        mirrored = [link.name for link in robot.roots if min(link.scale) < 0.0]
        if mirrored:
            findings.append(verdict.finding(ROBOT_SCALED, count=len(mirrored), links=mirrored))
        if links.unit != 1.0:
            findings.append(verdict.finding(UNIT_SCALE, scale=links.unit, cause=USD_SCALED))
        remarks = list(map(verdict.sentence, findings))
        text = usd.write_over(robot, paths, "./" + geometry.name, links.unit, remarks)
        selection.write_file(path, [text])
        return findings


class GltfExport(GeometryExport):
    """Base of the glTF exporter: rigid bodies are added to the file of Blender's exporter."""

    def _export_over(self, links: "SceneLinks", path: Path) -> list[verdict.Finding]:
        findings = links.findings
        options = {"use_selection": self.use_selection, "export_format": "GLB", "export_yup": True}
        self._run_exporter("export_scene.gltf", path, options)
        data = path.read_bytes()
        try:
            document = files.gltf_document(data)
        except ValueError as error:
            raise verdict.FileError(ROBOT_GEOMETRY_NOT_WRITTEN, error=path.name) from error
        findings += write.gltf.add_rigid_bodies(document, links.robot, links.unit)
        selection.write_file(path, [files.replace_gltf_document(data, document)])
        return findings

    def _encode(self, text: str, path: Path) -> bytes:
        return files.to_glb(text) if path.suffix.lower() == ".glb" else text.encode("utf-8")


BASES = {"usd": UsdExport, "gltf": GltfExport}  # The other formats are files of our own alone.


def _exporter(form: RobotFormat) -> type[RobotExport]:
    """Return the exporter of a format."""
    members = {
        "FORMAT": form.name,
        "bl_idname": "export_scene.body_moments_" + form.name,
        "bl_label": form.export_label,
        "bl_description": form.export_tip,
        "filename_ext": form.suffix,
        "__annotations__": {
            "filter_glob": StringProperty(default="*" + form.suffix, options={"HIDDEN"})
        },
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

    bl_label = "Mass Properties"

    def draw(self, _context: Context) -> None:
        for form in FORMATS.values():
            text = "{} ({})".format(form.label, form.suffix)
            self.layout.operator(
                "export_scene.body_moments_" + form.name, text=text, translate=False
            )
        self.layout.separator()
        self.layout.menu(VIEW3D_MT_body_moments_copy.__name__)


CLASSES = (
    *map(_exporter, FORMATS.values()),
    *map(_file_handler, FORMATS.values()),
)
