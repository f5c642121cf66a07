# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""`simplex`: moments in n dimensions, against fractions."""

import io
import itertools
import json
import math
import zipfile
from fractions import Fraction

import numpy as np
import pytest
from body_moments.core.polyhedron import facets_of
from body_moments.operators import batch

from tests.blender.batch_files import sentence
from tests.command.processes import script
from tests.records import valid


def answered(path, *words):
    ended = script("simplex", path, *words)
    return ended.returncode, valid(
        json.loads(ended.stdout)
    ) if ended.stdout else ended.stderr.decode()


def corner(dimension, exponents) -> Fraction:
    """∫ x^α over the simplex of the origin and the unit vectors."""
    product = math.prod(math.factorial(power) for power in exponents)
    return Fraction(product, math.factorial(sum(exponents) + dimension))


@pytest.mark.parametrize("dimension, order", [(1, 4), (2, 30), (3, 6), (4, 5), (7, 2)])
@pytest.mark.parametrize("full", [True, False])
def test_moments_of_a_corner_in_n_dimensions_are_fractions(tmp_path, capfd, dimension, order, full):
    points = np.eye(dimension + 1, dimension)
    simplices = np.arange(dimension + 1)[None, ::-1]
    arrays = {"points": points, "simplices": simplices}
    if not full:
        facets, signs = facets_of(points, simplices)
        arrays = {"points": points, "simplices": facets, "signs": signs}
    np.savez(tmp_path / "a.npz", **arrays)
    assert batch.main(["simplex", str(tmp_path / "a.npz"), "--order", str(order)], channel=1) == 0
    text = capfd.readouterr().out
    record = valid(json.loads(text))
    assert text == json.dumps(record, indent=1) + "\n"  # one number a line
    assert record["dimension"] == dimension and record["closed"] is True
    powers = [
        row for row in itertools.product(range(order + 1), repeat=dimension) if sum(row) <= order
    ]
    assert len(record["moments"]) == len(powers)
    for row in powers:
        key, truth = ",".join(map(str, row)), corner(dimension, row)
        assert abs(Fraction(record["moments"][key]) - truth) <= Fraction(record["error"][key])
        assert record["error"][key] < 1e-10 * float(truth)


def test_simplices_report_about_boundary_and_openness(tmp_path):
    square = np.array([[1, 1], [3, 1], [3, 3], [1, 3]], float)
    np.savez(tmp_path / "a.npz", points=square, simplices=[[0, 1], [1, 2], [2, 3], [3, 0]])
    code, record = answered(tmp_path / "a.npz", "--about", "2,2", "--boundary")
    assert code == 0 and record["about"] == [2, 2] and record["closed"]
    assert record["moments"]["0,0"] == pytest.approx(4.0, rel=1e-14)
    assert record["moments"]["2,0"] == pytest.approx(4.0 / 3.0, rel=1e-14)
    assert record["boundary"]["moments"]["0,0"] == pytest.approx(8.0, rel=1e-14)
    np.savez(tmp_path / "a.npz", points=square, simplices=[[0, 1], [1, 2], [2, 3]])
    record = answered(tmp_path / "a.npz")[1]
    assert record["closed"] is False and [one["code"] for one in record["findings"]] == [
        "simplex_open"
    ]


def test_wrong_files_and_options_are_said(tmp_path, capfd):
    points = np.eye(3, 2)
    for arrays in (
        {"points": points},
        {"points": points, "simplices": [[0]]},
        {"points": np.eye(14, 13), "simplices": [range(14)]},
        {"points": points, "simplices": [[0, 1], [1, 2]], "signs": [1, 2]},
        {"points": np.array([object()]), "simplices": [[0]]},
        {"points": np.arange(3.0), "simplices": [[0], [1]]},
        {"points": points[None], "simplices": [[0, 1, 2]]},
        {"points": np.zeros((3, 0)), "simplices": [[0]]},
        {"points": points, "simplices": [[0, 1, 2, 0]]},
        {"points": points, "simplices": np.zeros((0, 3), int)},
        {"points": points, "simplices": [[0, 1, -1]]},  # as core/polyhedron refuses it
        {"points": points, "simplices": [[0, 1], [1, 2]], "signs": [1]},
        {"points": points, "simplices": [[0, 1], [1, 2]], "signs": [[1, 1]]},
    ):
        np.savez(tmp_path / "a.npz", **arrays)
        assert batch.main(["simplex", str(tmp_path / "a.npz")], channel=1) == 1
        said = capfd.readouterr()
        assert not said.out and "a.npz" in said.err
    (tmp_path / "a.npz").write_bytes(b"nonsense")
    assert batch.main(["simplex", str(tmp_path / "a.npz")], channel=1) == 1
    capfd.readouterr()
    assert batch.main(["simplex", str(tmp_path / "missing.npz")], channel=1) == 1
    assert "missing.npz: cannot be read: No such file or directory\n" in capfd.readouterr().err
    np.savez(tmp_path / "a.npz", points=np.eye(9, 8), simplices=[range(9)])
    assert batch.main(["simplex", str(tmp_path / "a.npz"), "--about", "1,2"], channel=1) == 1
    for words in (["--order", "31"], ["--about", "1,x"], []):
        assert (
            batch.main(
                ["simplex", *([str(tmp_path / "a.npz")] if words else []), *words], channel=1
            )
            == 2
        )


def test_overflowing_moment_bounds_are_refused(tmp_path, capfd):
    """Moments of odd order about the middle of a square are zero, however large it is."""
    square = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]])
    for scale, order, code in ((1e106, 1, 0), (1e109, 1, 1), (1e109, 0, 0), (1e160, 0, 1)):
        np.savez(
            tmp_path / "a.npz", points=scale * square, simplices=[[0, 1], [1, 2], [2, 3], [3, 0]]
        )
        assert (
            batch.main(["simplex", str(tmp_path / "a.npz"), "--order", str(order)], channel=1)
            == code
        )
        said = capfd.readouterr()
        assert bool(said.out) == (not code) and (
            sentence("moments_overflow", order=order) in said.err
        ) == bool(code)


def test_archives_that_are_damaged_or_something_else_are_said(tmp_path, capfd):
    path, rng = tmp_path / "a.npz", np.random.default_rng(0)
    np.savez_compressed(path, points=rng.random((500, 3)), simplices=[[0, 1, 2]])
    packed = bytearray(path.read_bytes())
    packed[200:260] = b"\xff" * 60
    np.savez(path, points=np.eye(3, 2), simplices=[[0, 1, 2]])
    encrypted = bytearray(path.read_bytes())
    for mark, flag in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        for at in range(len(encrypted)):
            if encrypted.startswith(mark, at):
                encrypted[at + flag] |= 1
    head, plain, text = io.BytesIO(), io.BytesIO(), io.BytesIO()
    form = {"descr": "<f8", "fortran_order": False, "shape": (10**15, 3)}
    np.lib.format.write_array_header_1_0(head, form)
    huge = io.BytesIO()
    for target, content in ((huge, head.getvalue()), (text, b"no array")):
        with zipfile.ZipFile(target, "w") as archive:
            for name in ("points", "simplices"):
                archive.writestr(name + ".npy" * (target is huge), content)
    np.save(plain, np.eye(3))
    for data in (packed, encrypted, huge.getvalue(), text.getvalue(), plain.getvalue()):
        path.write_bytes(data)
        assert batch.main(["simplex", str(path)], channel=1) == 1
        assert "a.npz" in capfd.readouterr().err
