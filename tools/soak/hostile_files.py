# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Hostile files: sound ones of every format, damaged at random, and the ones that somebody has
thought of.

Everything is made here, from a seed. Needs the bpy module.
"""

import gzip
import io
import json
import os
import random
import struct
import unicodedata
import zipfile
from contextlib import suppress
from pathlib import Path

import bpy
import numpy as np
from body_moments.core.measurement import documents

CORNERS = ((0, 0, 0), (1, 0, 0), (0, 2, 0), (0, 0, 3))
FACES = ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))
RELATIONS = (
    "<Relationships "
    'xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Id="r" '
    'Target="/3D/a.model" '
    'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>'
)
MODEL = (
    '<model xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources><object '
    'id="1"><mesh>'
)
MODEL += "<vertices>{}</vertices><triangles>{}</triangles></mesh></object></resources>"
MODEL += "<build><item objectid='1'/></build></model>"
MODEL = MODEL.format(
    "".join("<vertex x='{}' y='{}' z='{}'/>".format(*corner) for corner in CORNERS),
    "".join("<triangle v1='{}' v2='{}' v3='{}'/>".format(*face) for face in FACES),
)
STATUSES = {*documents.STATUSES}
CRASHES = Path(__file__).with_name("crash_corpus")
TEXT = {".obj", ".gltf", ".usda", ".nrrd"}  # damaged by words rather than by bits


def empty_scene():
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)


def _tetrahedron():
    empty_scene()
    mesh = bpy.data.meshes.new("Tetra")
    mesh.from_pydata(CORNERS, [], FACES)
    bpy.context.collection.objects.link(bpy.data.objects.new("Tetra", mesh))


def seeds(folder: Path) -> dict[str, bytes]:
    """A small sound file of each format."""
    folder.mkdir(exist_ok=True)
    _tetrahedron()
    exporters = {
        ".blend": lambda path: bpy.ops.wm.save_as_mainfile(filepath=path, copy=True),
        ".stl": lambda path: bpy.ops.wm.stl_export(filepath=path),
        ".obj": lambda path: bpy.ops.wm.obj_export(filepath=path, export_materials=False),
        ".ply": lambda path: bpy.ops.wm.ply_export(filepath=path),
        ".glb": lambda path: bpy.ops.export_scene.gltf(filepath=path, export_format="GLB"),
        ".fbx": lambda path: bpy.ops.export_scene.fbx(filepath=path),
        ".usda": lambda path: bpy.ops.wm.usd_export(filepath=path),
        ".usdc": lambda path: bpy.ops.wm.usd_export(filepath=path),
        ".usdz": lambda path: bpy.ops.wm.usd_export(filepath=path),
    }
    found = {}
    for suffix, export in exporters.items():
        path = folder / ("seed" + suffix)
        export(str(path))
        found[suffix] = path.read_bytes()
    values = np.arange(24, dtype="<u2").reshape(2, 3, 4)
    for suffix, save in ((".npy", np.save), (".npz", np.savez_compressed)):
        stream = io.BytesIO()
        save(stream, values)
        found[suffix] = stream.getvalue()
    header = "NRRD0004\ntype: uint16\ndimension: 3\nsizes: 4 3 2\nendian: little\nencoding: {}\n\n"
    found[".nrrd"] = header.format("raw").encode() + values.tobytes()
    nifti = bytearray(352)
    struct.pack_into("<i", nifti, 0, 348)
    struct.pack_into("<8h", nifti, 40, 3, 4, 3, 2, 1, 1, 1, 1)
    struct.pack_into("<2h", nifti, 70, 512, 16)
    struct.pack_into("<8f", nifti, 76, 1, 1, 1, 1, 1, 1, 1, 1)
    struct.pack_into("<f", nifti, 108, 352.0)
    nifti[344:348] = b"n+1\0"
    parts = {"_rels/.rels": RELATIONS, "3D/a.model": MODEL}
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name, text in parts.items():
            archive.writestr(name, text)
    found[".3mf"] = stream.getvalue()
    found[".nii"] = bytes(nifti) + values.tobytes()
    found[".nii.gz"] = gzip.compress(found[".nii"])
    return found


def damaged(data: bytes, suffix: str, chance: random.Random) -> bytes:
    """The data with a few wounds: bits, missing and doubled pieces, numbers that are too large, a
    cut end.
    """
    found = bytearray(data)
    for _ in range(chance.choice((1, 1, 2, 4, 12))):
        place = chance.randrange(len(found)) if found else 0
        kind = chance.randrange(7)
        if kind == 0:
            found[place : place + 1] = bytes([chance.randrange(256)])
        elif kind == 1:
            del found[place : place + chance.choice((1, 1, 4, 64))]
        elif kind == 2:
            found[place:place] = found[place : place + chance.choice((1, 8, 100))]
        elif kind == 3:
            words = (b"-1", b"99999999999", b"1e39", b"nan", b"[", b"{", b'"', b"/", b"\n", b"\0")
            found[place : place + 1] = chance.choice(words)
        elif kind == 4 and suffix not in TEXT:
            number = chance.choice((0xFFFFFFFF, 0x7FFFFFFF, 0x80000000, 0, 1 << 24))
            place -= place % 4
            found[place : place + 4] = struct.pack("<I", number)[: len(found) - place]
        elif kind == 5 and chance.random() < 0.3:
            del found[place:]
        else:
            found[place : place + 1] = (
                bytes([found[place] ^ (1 << chance.randrange(8))]) if found else b""
            )
    return bytes(found)


def write_damaged(folder: Path, count: int, seed: int, suffixes=None) -> list[Path]:
    """So many damaged files, of all formats in turn."""
    sound = seeds(folder.parent / "seeds")
    chance = random.Random(seed)
    folder.mkdir(exist_ok=True)
    kinds = sorted(suffixes or sound)
    found = []
    for number in range(count):
        suffix = kinds[number % len(kinds)]
        path = folder / "fuzzed {:05d}{}".format(number, suffix)
        path.write_bytes(damaged(sound[suffix], suffix, chance))
        found.append(path)
    return found


def write_cut(folder: Path) -> list[Path]:
    """Files of every format that end too early."""
    folder.mkdir(exist_ok=True)
    found = []
    for suffix, data in seeds(folder.parent / "seeds").items():
        for share in (0.0, 0.1, 0.5, 0.9, 0.999):
            path = folder / "cut {:g}{}".format(share, suffix)
            path.write_bytes(data[: int(share * len(data))])
            found.append(path)
    return found


def _scripted(path: Path, marker: Path) -> None:
    """A file whose scripts and drivers would write the marker."""
    _tetrahedron()
    write = "open({!r}, 'w').close()".format(str(marker))
    text = bpy.data.texts.new("start.py")
    text.write("import bpy\n" + write + "\n")
    text.use_module = True
    obj = bpy.data.objects["Tetra"]
    driver = obj.driver_add("location", 0).driver
    driver.expression = "({}, 0.0)[1]".format(write)
    bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True)


def _names() -> list[str]:
    """Names of files with a character of each class of Unicode that a file system takes."""
    found = {}
    for code in range(1, 0x3000):
        character = chr(code)
        if character != "/":
            found.setdefault(unicodedata.category(character), character)
    extra = [
        "\U0001f600",
        "e\u0301",
        "\u202egnp",
        "a\nb",
        "-rf",
        "--output",
        "%s{}",
        "~",
        "$HOME",
        "'\"",
        "CON",
    ]
    return sorted({*("x" + character for character in found.values()), *extra})


def write_cases(folder: Path, marker: Path) -> dict[Path, set[str]]:
    """The files that somebody has thought of, each with the statuses that it may have."""
    folder.mkdir(exist_ok=True)
    sound = seeds(folder.parent / "seeds")
    found: dict[Path, set[str]] = {}

    def put(name: str, data: bytes, *statuses: str) -> Path:
        path = folder / name
        path.write_bytes(data)
        found[path] = set(statuses)
        return path

    blend = sound[".blend"]
    old = blend[:7] + b"-v" + b"123" + blend[12:]
    put("of the future.blend", b"BLENDER17-99v0999" + blend[17:], "unsupported_version")
    put("big endian.blend", b"BLENDER-V249" + blend[12:], "unsupported_version", "error")
    put("ancient.blend", old, "crashed", "error", "unsupported_version")
    put("only a header.blend", b"BLENDER-v405", "error")
    put("garbage.blend", b"BLENDER garbage", "error")
    put("nothing.blend", b"", "error")
    put("not one.blend", sound[".stl"], "error")
    put(
        "a lost letter.ply",
        sound[".ply"].replace(b"property", b"propery", 1),
        "error",
        "crashed",
        "timeout",
    )
    put(
        "millions.ply",
        b"ply\nformat ascii 1.0\nelement vertex 4000000000\nend_header\n",
        "error",
        "crashed",
        "memory",
    )
    put("far.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 2147483647\n", "error", "crashed", "ok")
    put("deep.gltf", b'{"a":' * 100_000, "error", "crashed")
    put("no end.glb", b"glTF\x02\0\0\0\xff\xff\xff\x7f", "error")
    put("nodes in a circle.gltf", _circle(), "error", "crashed", "timeout")
    put("stl of gigabytes.stl", bytes(80) + struct.pack("<I", 0xFFFFFFFF), "error")
    put("nothing to measure.usda", b'#usda 1.0\ndef Xform "a"\n{\n}\n', "error")
    put(
        "refers to itself.usda",
        b'#usda 1.0\ndef "a" (references = @./refers to itself.usda@</a>)\n{\n}\n',
        "error",
    )
    put(
        "huge.npy",
        b"\x93NUMPY\1\0v\0{'descr': '<f8', 'fortran_order': False, 'shape': (99999, 99999, 99999)}",
        "error",
    )
    put("objects.npy", _pickled(), "error")
    put("bomb.nii.gz", gzip.compress(sound[".nii"][:352] + bytes(1 << 24)), "error", "ok")
    put("bomb.npz", _zip_bomb(), "error")
    put(
        "words.nrrd",
        b"NRRD0004\ntype: float\ndimension: 3\nsizes: 1 1 1\nspace directions: " + b"(" * 9999,
        "error",
    )
    put(
        "outside.nhdr",
        b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 1 1 1\nencoding: raw\ndata file: ../../x\n",
        "error",
    )
    put("unknown.xyz", b"1 2 3", "error")
    for path in sorted(CRASHES.iterdir()):  # Each has crashed some Blender.
        put(path.name, path.read_bytes(), *(STATUSES - {"missing", "unsupported_version"}))
    empty_scene()
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "no object.blend"), copy=True)
    found[folder / "no object.blend"] = {"error"}
    scripted = folder / "scripted.blend"
    _scripted(scripted, marker)
    found[scripted] = {"ok"}
    for name in _names():
        with suppress(OSError, ValueError):
            put(name + ".stl", sound[".stl"], "ok")
    sparse = folder / "sparse_4096x4096x4096_uint8.raw"
    sparse.touch()
    os.truncate(sparse, 1 << 36)
    found[sparse] = {"error", "timeout"}
    (folder / "a folder.blend").mkdir()
    (folder / "a folder.blend" / "inside.stl").write_bytes(sound[".stl"])
    found[folder / "a folder.blend" / "inside.stl"] = {"ok"}
    if os.name != "nt":
        os.mkfifo(folder / "pipe.blend")
        found[folder / "pipe.blend"] = {"error"}
        (folder / "dangling.stl").symlink_to(folder / "nowhere.stl")
        found[folder / "dangling.stl"] = {"missing"}
        (folder / "itself.stl").symlink_to(folder / "itself.stl")
        found[folder / "itself.stl"] = {"missing", "error"}
        (folder / "round").symlink_to(folder)
        locked = put("secret.stl", sound[".stl"], *(("error",) if os.getuid() else ("ok",)))
        locked.chmod(0)
    return found


def _circle() -> bytes:
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"children": [1]}, {"children": [0]}],
    }
    return json.dumps(document).encode()


def _pickled() -> bytes:
    stream = io.BytesIO()
    np.save(stream, np.array([{"a": 1}], object), allow_pickle=True)
    return stream.getvalue()


def _zip_bomb() -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for number in range(3000):
            archive.writestr("{}.npy".format(number), bytes(1000))
    return stream.getvalue()
