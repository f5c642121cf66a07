# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Exported robots read back: each link's inertial beside the mesh that the file gives it."""

from dataclasses import dataclass
from xml.etree import ElementTree

import numpy as np
from body_moments.command import audit
from body_moments.core.files import GltfFile, node_matrix
from body_moments.core.inertia import MassProperties
from body_moments.core.mesh import Surface
from body_moments.core.numerics.rotations import rotation_matrix
from body_moments.core.polyhedron import polyhedron_moments
from body_moments.core.robots import Roots, read_description
from body_moments.core.robots.read.meshes import read_mesh
from body_moments.core.robots.stated import rotation_of_angles

SUFFIXES = {
    "urdf": ".urdf",
    "sdf": ".sdf",
    "mjcf": ".xml",
    "usd": ".usda",
    "gltf": ".gltf",
    "osim": ".osim",
}
KHR = "KHR_physics_rigid_bodies"


@dataclass
class ExportedLink:
    """A link in kg and meters: its inertial, and the corners (n, 3, 3) of its mesh's triangles,
    none without a mesh.
    """

    mass: float
    center: np.ndarray
    inertia: np.ndarray
    corners: np.ndarray

    @property
    def sides(self):
        """(3,) the extent of the mesh along the axes of the link, of a glTF along the scene's."""
        points = self.corners.reshape(-1, 3)
        return points.max(axis=0) - points.min(axis=0)


def assert_filled(link, density, rel=1e-5):
    """The inertial is that of the mesh filled with this density."""
    points = link.corners.reshape(-1, 3).astype(np.float64)
    surface = Surface.from_triangles(points, np.arange(len(points)).reshape(-1, 3))
    body = MassProperties.from_moments(polyhedron_moments(surface)[0], density)
    assert abs(link.mass - body.mass) <= rel * body.mass
    assert np.abs(link.center - body.center).max() <= rel * link.sides.max()
    assert np.abs(link.inertia - body.inertia).max() <= rel * np.abs(body.inertia).max()


def exported_links(path):
    """Return the links of a file by name; of a format that the audit reads, it has to find nothing
    but notes.
    """
    data = path.read_bytes()
    if path.suffix in (".gltf", ".glb"):
        return _gltf_links(data)
    if path.suffix == ".osim":
        return {
            body.get("name"): _osim_link(body, Roots.for_file(path))
            for body in ElementTree.parse(path).iter("Body")
        }
    assert audit.answer(audit.parse(["audit", str(path)]))[1] == 0
    roots = Roots.for_file(path)
    links = [
        link for link in read_description(path, roots).links if link.inertial and link.inertial.mass
    ]
    return {link.name.rsplit("/", 1)[-1]: _stated(link, roots) for link in links}


def _stated(link, roots):
    corners = [np.zeros((0, 3, 3))]
    for shape in (stated.shape for stated in link.shapes if stated.role == "collision"):
        surface = shape.surface or read_mesh(roots.find(shape.file))[0]
        points = surface.points @ shape.pose.rotation.T + shape.pose.position
        corners.append(points[surface.all_triangles()[0]])
    inertial = link.inertial
    return ExportedLink(inertial.mass, inertial.center, inertial.inertia, np.concatenate(corners))


def _osim_link(body, roots):
    xx, yy, zz, xy, xz, yz = map(float, body.findtext("inertia").split())
    corners = [np.zeros((0, 3, 3))]
    for frame in body.iter("PhysicalOffsetFrame"):
        position, (a, b, c) = (
            np.array(frame.findtext(name).split(), float) for name in ("translation", "orientation")
        )
        turn = rotation_of_angles(-a, -b, -c).T
        surface, _ = read_mesh(roots.find(frame.findtext("attached_geometry/Mesh/mesh_file")))
        corners.append(surface.points[surface.all_triangles()[0]] @ turn.T + position)
    center = np.array(body.findtext("mass_center").split(), float)
    tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    return ExportedLink(float(body.findtext("mass")), center, tensor, np.concatenate(corners))


def _gltf_links(data):
    """In the axes of the scene, which are y up."""
    file = GltfFile(data, "")
    document, links = file.document, {}

    def visit(index, above, body):
        node = document["nodes"][index]
        here = above @ node_matrix(node)
        motion = node.get("extensions", {}).get(KHR, {}).get("motion")
        if motion is not None:
            turn = here[:3, :3] / np.linalg.norm(here[:3, :3], axis=0)
            x, y, z, w = motion["inertiaOrientation"]
            turn = turn @ rotation_matrix([w, x, y, z])
            center = here[:3, :3] @ motion["centerOfMass"] + here[:3, 3]
            inertia = (turn * motion["inertiaDiagonal"]) @ turn.T
            body = links[node["name"]] = ExportedLink(
                motion["mass"], center, inertia, np.zeros((0, 3, 3))
            )
        for primitive in document["meshes"][node["mesh"]]["primitives"] if "mesh" in node else ():
            points = (
                file.numbers(primitive["attributes"]["POSITION"]) @ here[:3, :3].T + here[:3, 3]
            )
            corners = points[file.numbers(primitive["indices"]).astype(int).reshape(-1, 3)]
            body.corners = np.concatenate([body.corners, corners])
        for child in node.get("children", ()):
            visit(child, here, body)

    for index in document["scenes"][0]["nodes"]:
        visit(index, np.eye(4), None)
    return links
