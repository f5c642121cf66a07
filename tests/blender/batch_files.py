# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files for the tests of the command line, and its run inside this process."""

import sys
from pathlib import Path

import bpy
import numpy as np
from body_moments.core.verdict import finding

from tests.records import valid

# A tetrahedron with its right angle at the origin and legs of 1, 2 and 3 along x, y and z.
CORNERS = ((0, 0, 0), (1, 0, 0), (0, 2, 0), (0, 0, 3))
FACES = ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))
TETRAHEDRON = {"volume": 1.0, "center_of_mass": (0.25, 0.5, 0.75)}

# A box of 1 by 2 by 3 about this point.
CENTER = (10.0, 20.0, 30.0)
BOX_NAME = "Würfel 立方体"

EXPORTERS = {
    ".blend": lambda path: bpy.ops.wm.save_as_mainfile(filepath=path, copy=True),
    ".stl": lambda path: bpy.ops.wm.stl_export(filepath=path),
    ".obj": lambda path: bpy.ops.wm.obj_export(filepath=path),
    ".ply": lambda path: bpy.ops.wm.ply_export(filepath=path),
    ".glb": lambda path: bpy.ops.export_scene.gltf(filepath=path, export_format="GLB"),
    ".gltf": lambda path: bpy.ops.export_scene.gltf(filepath=path, export_format="GLTF_SEPARATE"),
    ".usd": lambda path: bpy.ops.wm.usd_export(filepath=path),
    ".usda": lambda path: bpy.ops.wm.usd_export(filepath=path),
    ".usdc": lambda path: bpy.ops.wm.usd_export(filepath=path),
    ".usdz": lambda path: bpy.ops.wm.usd_export(filepath=path),
    ".fbx": lambda path: bpy.ops.export_scene.fbx(filepath=path),
}


def add_box(name=BOX_NAME, center=CENTER, size=(1.0, 2.0, 3.0)):
    """A new object: a box with its sides along the axes, modelled with its size in the mesh."""
    bpy.ops.mesh.primitive_cube_add(size=1.0, location=center)
    box = bpy.context.active_object
    box.name = box.data.name = name
    for vertex in box.data.vertices:
        vertex.co = [value * length for value, length in zip(vertex.co, size, strict=True)]
    return box


def turn(degrees):
    """A rotation about x, then y, then z, as a (3, 3) matrix."""
    (a, b, c), (d, e, f) = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    x = np.array([[1, 0, 0], [0, a, -d], [0, d, a]])
    y = np.array([[b, 0, e], [0, 1, 0], [-e, 0, b]])
    return np.array([[c, -f, 0], [f, c, 0], [0, 0, 1]]) @ y @ x


def empty_scene():
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)


def save(path: Path) -> str:
    """Export the open scene in the format that the name asks for."""
    EXPORTERS[path.suffix](str(path))
    return str(path)


def box_file(path: Path) -> str:
    empty_scene()
    add_box()
    return save(path)


def write_text(path: Path, text: str) -> str:
    path.write_text(text, encoding="utf-8")
    return str(path)


def stl_text(corners=CORNERS, faces=FACES, end="endsolid t\n") -> str:
    lines = ["solid t"]
    for face in faces:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += ["vertex {} {} {}".format(*corners[i]) for i in face]
        lines += ["endloop", "endfacet"]
    return "\n".join(lines) + "\n" + end


def obj_text() -> str:
    lines = ["o Tetra"] + ["v {} {} {}".format(*corner) for corner in CORNERS]
    return "\n".join(lines + ["f {} {} {}".format(*(i + 1 for i in face)) for face in FACES]) + "\n"


def ply_text() -> str:
    head = ["ply", "format ascii 1.0", f"element vertex {len(CORNERS)}"]
    head += [f"property float {axis}" for axis in "xyz"]
    head += [f"element face {len(FACES)}", "property list uchar int vertex_indices", "end_header"]
    lines = ["{} {} {}".format(*corner) for corner in CORNERS]
    return "\n".join(head + lines + ["3 {} {} {}".format(*face) for face in FACES]) + "\n"


def usda_text(meters_per_unit: float, prims: str = "") -> str:
    points = ", ".join(str(corner) for corner in CORNERS)
    indices = ", ".join(str(i) for face in FACES for i in face)
    return f"""#usda 1.0
(
    metersPerUnit = {meters_per_unit}
    upAxis = "Z"
)

def Mesh "Tetra"
{{
    int[] faceVertexCounts = [3, 3, 3, 3]
    int[] faceVertexIndices = [{indices}]
    point3f[] points = [{points}]
    {prims}
}}
"""


def parsed(*words):
    """The options of a command line, as a process has them that measures by itself."""
    from body_moments.command.files import output
    from body_moments.command.options import arguments, checks

    options = arguments.parse([*map(str, words)])
    checks.prepare(options)
    bpy = sys.modules.get("bpy")
    opened = bpy.data.filepath if bpy else None
    output.check_targets(options, arguments.files_of_options(options, options.files, opened))
    return options


def run(*words):
    """The command line in this process, with its documents; nothing is written anywhere."""
    from body_moments.command.measure.run import Run

    line = Run(parsed("measure", *words))
    line.measure()
    valid(line.documents)
    return line


def in_process(*words):
    """The words of a command line that measures in this process, where tests can reach into it."""
    words = list(map(str, words))
    return ["measure", "--no-supervisor", *words[1:]] if words[:1] == ["measure"] else words


def document(*words):
    """The document of one file, in which nothing went wrong that was not foreseen."""
    line = run(*words)
    assert line.internal_errors == 0
    (found,) = line.documents
    return found


def measured(*words):
    """The one object's record of a document without errors."""
    found = document(*words)
    assert found["errors"] == []
    (entry,) = found["objects"]
    return entry


def reason(*words):
    """The reason in a document that holds one error, which is about the file, and nothing else."""
    found = document(*words)
    assert found["objects"] == []
    (error,) = found["errors"]
    assert error["name"] is None
    return error["reason"]


def sentence(code, **values):
    """What the table makes of a finding."""
    return str(finding(code, **values))


def codes(entry):
    """Those of the findings in a record or a total."""
    return [told["code"] for told in entry["findings"]]


def values(entry, code):
    """Those of the one finding of this code in a record or a total."""
    (told,) = (told for told in entry["findings"] if told["code"] == code)
    return told["values"]


def measure_with(monkeypatch, measure):
    """Let the command line measure each object by itself, by this in place of `measure_object`."""
    monkeypatch.setattr("body_moments.command.measure.scene.measured_together", lambda *_: None)
    monkeypatch.setattr("body_moments.command.measure.measuring.measure_object", measure)
