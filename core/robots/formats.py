# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of robot formats that the command line, the exporters and the audit use.

It imports nothing heavy: a format's modules are loaded when they are used.
"""

from importlib import import_module
from types import ModuleType
from typing import NamedTuple


class RobotFormat(NamedTuple):
    """A format. Names and endings are contracts; labels and tooltips are texts of the interface.

    short, copy_tip: name and tooltip in the menu Copy. export_label, export_tip: name and tooltip
    of the exporter. writer: module of `write/` with `check(robot)` and `write(robot, remarks,
    inertial_only=...)`; for formats that the audit repairs also `inertial_text`. holds_meshes:
    False if meshes are files of their own. binary_suffixes: endings of the format's binary files,
    which must not hold text. reader: module of `read/` with `read`, "" if the audit does not read
    the format. root: the first element of a file. read_suffixes: more endings of files that the
    audit reads, besides `suffix`.
    """

    name: str
    short: str
    label: str
    export_label: str
    suffix: str
    export_tip: str
    copy_tip: str
    writer: str
    reader: str = ""
    root: str = ""
    read_suffixes: tuple[str, ...] = ()
    holds_meshes: bool = False
    binary_suffixes: tuple[str, ...] = ()

    @property
    def writer_module(self) -> ModuleType:
        """The module that writes the format."""
        return import_module(".write." + self.writer, __package__)

    @property
    def reader_module(self) -> ModuleType:
        """The module that reads the format."""
        return import_module(".read." + self.reader, __package__)


_TABLE = (
    RobotFormat(
        *("urdf", "URDF", "URDF", "Export URDF", ".urdf"),
        "Export objects as links of a robot in URDF, with their exact mass, center and inertia",
        "Tensor along the axes of the object",
        *("urdf", "urdf", "robot"),
    ),
    RobotFormat(
        *("sdf", "SDF", "SDF", "Export SDF", ".sdf"),
        "Export objects as links of a model in SDFormat, with their exact mass, center and inertia",
        "Diagonal tensor in a rotated inertial frame",
        *("sdf", "sdf", "sdf"),
        read_suffixes=(".world",),
    ),
    RobotFormat(
        *("mjcf", "MJCF", "MuJoCo (MJCF)", "Export MJCF", ".xml"),
        "Export objects as bodies of a model for MuJoCo, with their exact mass, center and inertia",
        "Principal moments and a quaternion",
        *("mjcf", "mjcf", "mujoco"),
    ),
    RobotFormat(
        *("usd", "USD", "USD with Mass Properties", "Export USD Physics", ".usda"),
        "Export the geometry as Blender does, and a layer of text that gives it the exact mass, "
        "center and inertia",
        "PhysicsMassAPI and NewtonMassAPI",
        *("usd", "usda", "#usda"),
        read_suffixes=(".usd",),
        holds_meshes=True,
        binary_suffixes=(".usdc", ".usdz"),
    ),
    RobotFormat(
        *("gltf", "glTF", "glTF with Rigid Bodies", "Export glTF with Rigid Bodies", ".glb"),
        "Export glTF as Blender does, with rigid bodies of the exact mass, center and inertia in "
        "it",
        "KHR_physics_rigid_bodies and OMI_physics_body, with y up",
        "gltf",
        holds_meshes=True,
        binary_suffixes=(".glb",),
    ),
    RobotFormat(
        *("osim", "OpenSim", "OpenSim", "Export OpenSim", ".osim"),
        "Export objects as bodies of a model for OpenSim, with their exact mass, center and "
        "inertia",
        "Tensor along the axes of the object",
        "osim",
    ),
)
FORMATS = {entry.name: entry for entry in _TABLE}
AUDITED = {entry.root: entry for entry in _TABLE if entry.reader}
AUDITED_SUFFIXES = tuple(
    end for entry in AUDITED.values() for end in (entry.suffix, *entry.read_suffixes)
)
