# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The corpus is made and measured: scenes, arrays and mesh files, by the published command line and
by operators.

`collect` returns one flat table, key -> entry, as JSON holds it. Keys: "RUN/FILE/OBJECT" for a
record, "RUN/FILE total" and "RUN/FILE errors" for a document, "properties/SCENE/OBJECT" for what
operators stored, "fourier/NAME" for a transform. Sentences and severities are left out: they may
change. Findings keep their codes, counts and texts, but no values that round.
"""

from __future__ import annotations

import gzip
import json
import subprocess
import sys
from pathlib import Path

import bpy
import numpy as np

from tests.core.scan_files import nifti, nrrd
from tests.corpus import scenes
from tests.corpus import shapes as s

ROOT = Path(__file__).resolve().parent.parent.parent
SETTINGS = "body_moments"
SENTENCES = {"notes", "warnings", "reason", "density_from", "left_out"}
FULL = ("--order", "4", "--surface-moments", "--pose")
PLAIN = [name for name in scenes.SCENES if name not in {*scenes.NAMED, "sections"}]
UNITS = ["millimeters", "kilometers"]
# Options of the command line and their scenes. Walls of real thickness have volume moments to order
# 3.
RUNS = {
    "world": (FULL, [name for name in PLAIN if name not in {"shapes", "shells", *UNITS}]),
    "walls": (("--order", "3", "--pose"), ["shells", *UNITS]),
    "object": (("--frame", "object", "--order", "2"), PLAIN),
    "signature": (("--order", "8", "--surface-moments", "--pose", "--signature"), ["shapes"]),
    "union": (("--overlap", "union", "--order", "3"), ["overlaps"]),
    "shell": (
        ("--kind", "shell", "--thickness", "0.015", "--order", "3", "--surface-moments"),
        ["shapes", "overlaps"],
    ),
    "density": (("--density", "2700", "--frame", "object"), ["faulty", "shells"]),
    "mass": (("--mass", "7.5"), ["faulty", "nurbs"]),
}
TRANSFORMED = (
    ("closed", "Oblique beam mirrored and sheared"),
    ("shapes", "L beam as a shell"),
    ("built", "Nodes on a grid"),
    ("faulty", "Open sphere off the origin"),
)


def collect(folder: Path) -> dict[str, object]:
    """Everything, made and measured anew in an empty folder."""
    table = {}
    names = {}
    for name in scenes.SCENES:
        table |= _operators(folder, name)
        is_asked = scenes.NAMED.get(name, lambda _: False)
        names[name] = sorted(obj.name for obj in bpy.context.scene.objects if is_asked(obj.name))
    for name, (options, wanted) in RUNS.items():
        table |= _measured(folder, name, options, [folder / (scene + ".blend") for scene in wanted])
    for name in scenes.NAMED:
        asked = [word for one in names[name] for word in ("--object", one)]
        table |= _measured(folder, "named", (*FULL, *asked), [folder / (name + ".blend")])
    for number, (options, files) in enumerate(_arrays(folder)):
        table |= _measured(folder, "array {}".format(number), options, files)
    files = _mesh_files(folder)
    table |= _measured(folder, "file", FULL, files)
    table |= _measured(folder, "file in mm", ("--unit-scale", "0.001", "--order", "2"), files)
    table |= _transforms(folder)
    return table


def _operators(folder: Path, name: str) -> dict[str, object]:
    """Makes a scene, saves it, and returns what operators store on its objects."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    make = scenes.SCENES[name]
    if name == "volumes":
        make(folder)
    else:
        make()
    bpy.context.view_layer.update()
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / (name + ".blend")), copy=True)
    for obj in bpy.context.view_layer.objects:
        obj.select_set(True)
    measure = (
        bpy.ops.object.body_moments_measure_section
        if name == "sections"
        else bpy.ops.object.body_moments_measure
    )
    measure()
    found = {}
    for obj in bpy.context.scene.objects:
        stored = {
            key: _plain(value)
            for key, value in obj.items()
            if key.startswith("body_")
            and key != SETTINGS  # Blender 4.5 lists them too
            and (key == "body_method" or not isinstance(value, str))
        }
        if stored:
            found["properties/{}/{}".format(name, obj.name)] = stored
    return found


def _plain(value):
    """An ID property as JSON holds it; of a group, what is no text."""
    if hasattr(value, "to_dict"):
        return {key: _plain(one) for key, one in value.items() if not isinstance(one, str)}
    return value.to_list() if hasattr(value, "to_list") else value


def _measured(folder: Path, run: str, options, files) -> dict[str, object]:
    """The documents of one command line."""
    results = folder / "results"
    results.mkdir(exist_ok=True)
    output = results / (run + " " + files[0].stem + ".jsonl")
    words = [
        ROOT / "operators" / "batch.py",
        "measure",
        *options,
        "--format",
        "jsonl",
        "--output",
        output,
        *files,
    ]
    done = subprocess.run(
        [sys.executable, "-P", *map(str, words)],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        encoding="utf-8",
        errors="replace",
    )
    if done.returncode not in (0, 1) or not output.is_file():
        raise RuntimeError("{}: exit code {}\n{}".format(run, done.returncode, done.stderr[-4000:]))
    return entries(run, files, output.read_text(encoding="utf-8"))


def entries(run: str, files: list[Path], text: str) -> dict[str, object]:
    """Return the entries of the documents of some files, one a line."""
    table = {}
    for path, line in zip(files, text.splitlines(), strict=True):
        document = json.loads(line)
        place = "{}/{}".format(run, path.name)
        for record in document["objects"]:
            key = "{}/{}".format(place, record["name"])
            if key in table:
                raise RuntimeError("{} is there twice".format(key))
            table[key] = _without_sentences(record)
        table[place + " total"] = _without_sentences(document["total"])
        table[place + " errors"] = sorted(str(error["name"]) for error in document["errors"])
    return table


def _without_sentences(value):
    if isinstance(value, dict):
        return {
            key: "; ".join(map(_finding, one)) if key == "findings" else _without_sentences(one)
            for key, one in value.items()
            if key not in SENTENCES
        }
    return value


def _finding(found: dict) -> str:
    """Return the code of a finding, its number of elements, and its values that are texts or whole
    numbers.
    """
    elements = len(found.get("elements", ()))
    words = [found["code"], *(["{:d}".format(elements)] if elements else [])]
    words += [
        "{}={}".format(name, one)
        for name, one in found["values"].items()
        if isinstance(one, (str, int))
    ]
    return " ".join(words)


def _arrays(folder: Path):
    """(options, files) of arrays and scans."""
    rng = np.random.default_rng(21)
    values = np.round(rng.uniform(0, 4, (5, 7, 6)), 2)
    values *= values > 1
    block = np.full((4, 2, 6), 1.0)
    x, y, z = np.meshgrid(*[np.arange(12) - 5.5] * 3, indexing="ij")
    round_one = (x * x + y * y + z * z < 25).astype(np.uint8)
    np.save(folder / "random.npy", values)
    np.save(folder / "float32.npy", values.astype(np.float32))
    np.save(folder / "block.npy", block)
    np.save(folder / "ball.npy", round_one)
    np.save(folder / "fortran.npy", np.asfortranarray(values))
    np.savez(folder / "zipped.npz", density=values)
    tilted = "space directions: (0.002,0,0) (0,0.003,0.001) (0,-0.001,0.002)"
    scans = {
        "plain.nrrd": nrrd(values.astype(np.float32), "spacings: 2 3 4", 'units: "mm" "mm" "mm"'),
        "packed.nrrd": nrrd(np.round(values).astype(">i2"), "spacings: 0.5 0.5 1", encoding="gzip"),
        "tilted.nrrd": nrrd(values, "space dimension: 3", tilted, "space origin: (1,2,3)"),
        "plain.nii": nifti(
            np.round(values).astype(np.int16), spacing=(2, 2, 3), slope=3.0, intercept=1.0
        ),
        "packed.nii.gz": gzip.compress(nifti(round_one, spacing=(1, 2, 2))),
        "turned.nii": nifti(
            values.astype(np.float32),
            spacing=(1, 2, 3),
            quaternion=(0.1, 0.2, 0.3, 5, 6, 7),
            qfac=-1.0,
        ),
        "mapped.nii": nifti(
            values.astype(np.float32), sform=[[0, -2, 0, 10], [3, 0, 0.5, -20], [0, 0, 4, 5]]
        ),
        "below zero.nrrd": nrrd(-block),
        "empty.nrrd": nrrd(0 * block),
        "not finite.nrrd": nrrd(block * np.nan),
        "broken.nrrd": b"nonsense",
    }
    for name, data in scans.items():
        (folder / name).write_bytes(data)
    names = ("random.npy", "float32.npy", "block.npy", "ball.npy", "fortran.npy", "zipped.npz")
    arrays = [folder / name for name in names]
    every = [*arrays, *(folder / name for name in scans)]
    place = ("--spacing", "0.5,0.25,1.5", "--origin", "-1,20,300")
    yield ("--order", "4"), every
    yield (*place, "--spline-order", "2", "--order", "3"), every
    yield (*place, "--spline-order", "3", "--density-scale", "2.5", "--order", "2"), arrays
    yield (
        (
            "--spline-order",
            "4",
            "--order",
            "4",
            "--unit-scale",
            "1e-5",
            "--mass",
            "12",
            "--frame",
            "object",
        ),
        arrays,
    )


def _mesh_files(folder: Path) -> list[Path]:
    """Bodies in files of other programs, written here, and one that Blender exports."""
    files = []
    parts = {
        "beam": s.prism(s.SLANTED_PLAN, 0.7),
        "hull": s.moved(s.random_hull(4, 10), (10, 20, 30)),
        "open": s.without(s.uv_sphere(), 3),
    }
    for name, part in parts.items():
        points, polygons = part[0].tolist(), part[1]
        triangles = s.triangulated(part)[1]
        stl = ["solid"]
        for face in triangles:
            stl += [
                "facet normal 0 0 0",
                "outer loop",
                *("vertex {} {} {}".format(*points[i]) for i in face),
            ]
            stl += ["endloop", "endfacet"]
        obj = ["o " + name, *("v {} {} {}".format(*point) for point in points)]
        obj += ["f " + " ".join(str(i + 1) for i in face) for face in polygons]
        ply = ["ply", "format ascii 1.0", "element vertex {}".format(len(points))]
        ply += ["property float " + axis for axis in "xyz"]
        ply += [
            "element face {}".format(len(polygons)),
            "property list uchar int vertex_indices",
            "end_header",
        ]
        ply += ["{} {} {}".format(*point) for point in points]
        ply += ["{} {}".format(len(face), " ".join(map(str, face))) for face in polygons]
        for suffix, lines in ((".stl", [*stl, "endsolid"]), (".obj", obj), (".ply", ply)):
            path = folder / (name + suffix)
            path.write_text("\n".join(lines) + "\n", encoding="ascii")
            files.append(path)
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    for place in ("off the origin", "mirrored"):
        scenes.body("Beam " + place, parts["beam"], place=place)
    bpy.ops.export_scene.gltf(filepath=str(folder / "beams.glb"), export_format="GLB")
    return [*files, folder / "beams.glb"]


def _transforms(folder: Path) -> dict[str, object]:
    """Fourier transforms at given wave vectors, and one on a grid."""
    rng = np.random.default_rng(17)
    directions = np.round(rng.normal(size=(24, 3)), 3)
    q = np.concatenate(
        [np.zeros((1, 3)), np.eye(3), 1e-6 * np.eye(3), 0.5 * directions, 8.0 * directions[:8]]
    )
    np.save(folder / "q.npy", q)
    asked = [("given", scene, name, ("--q", folder / "q.npy")) for scene, name in TRANSFORMED]
    asked.append(("grid", *TRANSFORMED[0], ("--grid", "8", "--qmax", "6")))
    table = {}
    for how, scene, name, options in asked:
        out = folder / "{} {}.npz".format(how, name)
        words = ("--object", name, "--fourier", out, *options)
        table |= _measured(
            folder, "fourier {} {}".format(how, name), words, [folder / (scene + ".blend")]
        )
        with np.load(out) as held:
            table["fourier/{} {}".format(how, name)] = {
                "q": held["q"].tolist(),
                "real": held["F"].real.tolist(),
                "imag": held["F"].imag.tolist(),
                "method": str(held["method"]),
            }
    return table
