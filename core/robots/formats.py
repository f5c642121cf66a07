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
        name="urdf",
        short="URDF",
        label="URDF",
        export_label="Export URDF",
        suffix=".urdf",
        export_tip="Export objects as links of a robot in URDF, with their exact mass, center and "
        "inertia",
        copy_tip="Tensor along the axes of the object",
        writer="urdf",
        reader="urdf",
        root="robot",
    ),
    RobotFormat(
        name="sdf",
        short="SDF",
        label="SDF",
        export_label="Export SDF",
        suffix=".sdf",
        export_tip="Export objects as links of a model in SDFormat, with their exact mass, center "
        "and inertia",
        copy_tip="Diagonal tensor in a rotated inertial frame",
        writer="sdf",
        reader="sdf",
        root="sdf",
        read_suffixes=(".world",),
    ),
    RobotFormat(
        name="mjcf",
        short="MJCF",
        label="MuJoCo (MJCF)",
        export_label="Export MJCF",
        suffix=".xml",
        export_tip="Export objects as bodies of a model for MuJoCo, with their exact mass, center "
        "and inertia",
        copy_tip="Principal moments and a quaternion",
        writer="mjcf",
        reader="mjcf",
        root="mujoco",
    ),
    RobotFormat(
        name="usd",
        short="USD",
        label="USD with Mass Properties",
        export_label="Export USD Physics",
        suffix=".usda",
        export_tip="Export the geometry as Blender does, and a layer of text that gives it the "
        "exact mass, center and inertia",
        copy_tip="PhysicsMassAPI and NewtonMassAPI",
        writer="usd",
        reader="usda",
        root="#usda",
        read_suffixes=(".usd",),
        holds_meshes=True,
        binary_suffixes=(".usdc", ".usdz"),
    ),
    RobotFormat(
        name="gltf",
        short="glTF",
        label="glTF with Rigid Bodies",
        export_label="Export glTF with Rigid Bodies",
        suffix=".glb",
        export_tip="Export glTF as Blender does, with rigid bodies of the exact mass, center and "
        "inertia in it",
        copy_tip="KHR_physics_rigid_bodies and OMI_physics_body, with y up",
        writer="gltf",
        holds_meshes=True,
        binary_suffixes=(".glb",),
    ),
    RobotFormat(
        name="osim",
        short="OpenSim",
        label="OpenSim",
        export_label="Export OpenSim",
        suffix=".osim",
        export_tip="Export objects as bodies of a model for OpenSim, with their exact mass, center "
        "and inertia",
        copy_tip="Tensor along the axes of the object",
        writer="osim",
    ),
)
FORMATS = {entry.name: entry for entry in _TABLE}
AUDITED = {entry.root: entry for entry in _TABLE if entry.reader}
AUDITED_SUFFIXES = tuple(
    end for entry in AUDITED.values() for end in (entry.suffix, *entry.read_suffixes)
)
