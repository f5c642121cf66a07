# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the formats of robots cannot say or would round wrongly, and files that are none: findings,
names, limits.
"""

import json
import struct
from dataclasses import replace

import numpy as np
import pytest
from body_moments.core.files import gltf_document, replace_gltf_document, to_glb
from body_moments.core.robots.model import Link, Robot
from body_moments.core.robots.write import mjcf, stl, text, usd

from tests.blender.documents import of_box


def with_least(mass, moment):
    """An inertial of this mass and this least moment."""
    return replace(
        of_box(1.0, (1.0, 2.0, 4.0)),
        mass=mass,
        moments=np.array([moment, 2.0 * moment, 3.0 * moment]),
    )


def test_too_small_mujoco_inertials_are_named():
    least = mjcf.LEAST
    links = [
        Link("none", None),
        Link("right", with_least(1.0, least)),
        Link("light", with_least(np.nextafter(least, 0.0), 1.0)),
        Link("thin", with_least(1.0, 0.25 * least)),
        Link("large", of_box(2.0, (1.0, 2.0, 4.0))),
    ]
    assert mjcf.check(Robot("r", tuple(links[:2]))) == mjcf.check(Robot("r", ())) == []
    (found,) = mjcf.check(Robot("r", tuple(links)))
    assert (found.code, found.values["links"]) == ("inertia_too_small", ["light", "thin"])
    assert (found.values["limit"], found.values["program"]) == (1e-15, "MuJoCo")


def test_too_small_usd_inertials_are_named():
    """Half of a moment has all its digits: readers may halve it."""
    least = float(np.finfo(np.float32).tiny)
    links = [
        Link("none", None),
        Link("right", with_least(1.0, np.nextafter(2.0 * least, 1.0))),
        Link("small", with_least(1.0, 2.0 * least)),
        Link("zero", with_least(1.0, 0.0)),
        Link("unknown", with_least(1.0, np.nan)),
    ]
    assert usd.check(Robot("r", tuple(links[:2]))) == usd.check(Robot("r", ())) == []
    (found,) = usd.check(Robot("r", tuple(links)))
    assert (found.code, found.values["links"]) == (
        "inertia_too_small",
        ["small", "zero", "unknown"],
    )


def test_rounded_largest_moment_is_within_sum_of_others():
    """It is lowered no more than that needs, and not at all where nothing is to do."""
    draw = np.random.default_rng(3)
    lowered = 0
    for first, second in draw.uniform(0.5, 2.0, (500, 2)):
        low, high = sorted((first, second))
        moments = np.array([low, high, low + high])  # of a plate
        plain, rounded = moments.astype(np.float32), usd.round_down(moments)
        assert rounded.dtype == np.float32 and (rounded[:2] == plain[:2]).all()
        sides = float(rounded[0]) + float(rounded[1])
        assert float(rounded[2]) <= sides
        if float(plain[2]) <= sides:
            assert rounded[2] == plain[2]
        else:
            lowered += 1
            assert float(np.nextafter(rounded[2], np.float32(9.0))) > sides
    assert 50 < lowered < 450
    assert usd.round_down([1.0, 2.0, 2.5]).tolist() == [1.0, 2.0, 2.5]


def test_names_that_become_one_are_numbered():
    names = ["a b", "a-b", "a_b", "a_b_2", "c"]
    assert text.unique_names(names, usd.identifier) == dict(
        zip(names, ["a_b", "a_b_2", "a_b_3", "a_b_2_2", "c"])
    )
    assert text.unique_names(["a", "b"], str, ["a", "a_2"]) == {"a": "a_3", "b": "b"}
    files = {("Arm", 0): "arm.stl", ("ARM", 0): "arm_2.stl", ("äb", 0): "_b.stl", ("", 0): "_.stl"}
    files |= {("Arm", 2): "arm_collider_2.stl", ("arm_collider_2", 0): "arm_collider_2_2.stl"}
    assert stl.mesh_files(files, "My Robot") == {
        name: "meshes/my_robot/" + file for name, file in files.items()
    }


GLB = struct.pack("<4s2I", b"glTF", 2, 32)


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"{",
        b"\xff\xfe",
        GLB,
        GLB + struct.pack("<I4s", 8, b"BIN\0") + bytes(8),
        GLB + struct.pack("<I4s", 4, b"JSON") + b"[1, ",
        GLB + struct.pack("<I4s", 0, b"JSON"),
        GLB + struct.pack("<I", 4),
    ],
)
def test_invalid_gltf_is_refused(data):
    with pytest.raises(ValueError, match=".*"):
        gltf_document(data)


@pytest.mark.parametrize("length", range(1, 6))
def test_binary_gltf_has_aligned_chunks_and_keeps_others(length):
    document = {"name": "x" * length}
    other = struct.pack("<II", 8, 0x004E4942) + b"12345678"
    data = to_glb('{"a": 1}')
    data = struct.pack("<III", 0x46546C67, 2, len(data) + len(other)) + data[12:] + other
    for made, rest in (
        (replace_gltf_document(data, document), other),
        (to_glb(json.dumps(document)), b""),
    ):
        magic, version, total, size, kind = struct.unpack_from("<IIIII", made)
        assert (magic, version, total, kind) == (0x46546C67, 2, len(made), 0x4E4F534A)
        text = made[20 : 20 + size]
        assert size % 4 == 0 and size - len(text.rstrip(b" ")) < 4 and json.loads(text) == document
        assert made[20 + size :] == rest and gltf_document(made) == document
