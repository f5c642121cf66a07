# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Flipped bits in files whose format has checksums, through the real command: refused, or of no
effect.

A file that is measured all the same has the numbers of the whole one, to the bit. Formats without a
checksum are in docs/limits.md.
"""

import gzip
import json
import random
import tempfile
import time
from collections import Counter
from pathlib import Path

import bpy
import numpy as np

from tools.soak import commands, hostile, hostile_files

NUMBERS = ("mass", "volume", "area", "center_of_mass", "inertia")
CHECKED = (".3mf", ".usdz", ".npz", ".nii.gz", ".nrrd")
DAMAGED = 40  # Damaged files of each format in a round.


def whole_files(folder: Path) -> dict[str, bytes]:
    """A sound file of each format that has a checksum."""
    sound = hostile_files.seeds(folder)
    values = np.random.default_rng(1).integers(0, 999, 500).astype("<u2")
    header = (
        "NRRD0004\ntype: uint16\ndimension: 3\nsizes: 10 10 5\nendian: little\nencoding: gzip\n\n"
    )
    hostile_files.empty_scene()
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=5)
    bpy.ops.wm.usd_export(filepath=str(folder / "sphere.usdz"))
    sound[".usdz"] = (folder / "sphere.usdz").read_bytes()
    sound[".nrrd"] = header.encode() + gzip.compress(values.tobytes())
    return {suffix: sound[suffix] for suffix in CHECKED}


def flipped(data: bytes, chance: random.Random) -> bytes:
    """The data with one bit changed."""
    found = bytearray(data)
    found[chance.randrange(len(found))] ^= 1 << chance.randrange(8)
    return bytes(found)


def numbers(document: dict) -> str:
    """Return the measured numbers as text, or "" for a refused file."""
    if document["status"] != "ok":
        return ""
    return json.dumps([[body.get(name) for name in NUMBERS] for body in document["objects"]])


def warnings(document: dict) -> set[str]:
    return {warning for body in document["objects"] for warning in body["warnings"]}


def run(budget_seconds: float, seed: int, count: int = DAMAGED) -> str:
    """Rounds of damaged files of each format until the budget is spent; the report counts what came
    of them.
    """
    end, chance = time.monotonic() + budget_seconds, random.Random(seed)
    refused, reported, same, silent = Counter(), Counter(), Counter(), []
    with tempfile.TemporaryDirectory(prefix="body_moments_damage_") as name:
        folder = Path(name)
        whole = whole_files(folder / "seeds")
        files = folder / "files"
        files.mkdir()
        while True:
            paths = {}
            for suffix, data in whole.items():
                for number in range(count + 1):  # the first is whole
                    path = files / "{:03d}{}".format(number, suffix)
                    path.write_bytes(flipped(data, chance) if number else data)
                    paths[path] = suffix
            documents = hostile.measured(list(paths), folder)
            commands.check_documents(documents, list(paths))
            truth, known = {}, {}
            for document, suffix in zip(documents, paths.values(), strict=True):
                found = numbers(document)
                if suffix not in truth:
                    assert found, (suffix, document["errors"])
                    truth[suffix], known[suffix] = found, warnings(document)
                elif not found:
                    refused[suffix] += 1
                elif found == truth[suffix]:
                    same[suffix] += 1
                elif warnings(document) - known[suffix]:
                    reported[suffix] += 1
                else:
                    silent.append((Path(document["file"]).name, found, truth[suffix]))
            assert not silent, silent
            if time.monotonic() >= end:
                break
    text = "{} {} refused, {} reported, {} the same"
    return "; ".join(text.format(one, refused[one], reported[one], same[one]) for one in CHECKED)
