# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Count found faults and unconfirmed alarms of the audit, and write docs/robots-alarms.md.

    python3 tests/project.py alarms

The robots are those of `project.py robots`, whose folder and packages it uses; it takes half an
hour. Counts in that folder are used again: remove `*_alarms.json` after a change of the audit.
Faults are planted in right links, by the numbers in their URDF. Each alarm about a published
link is checked by trimesh (meshes, hulls), SciPy (a linear program: no masses at points of the hull
have this center and inertia), MuJoCo (MJCF) and NumPy.
"""

import argparse
import json
import re
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache
from itertools import product
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import mujoco
import numpy as np
import trimesh
from loading import ROOT, load_checkout
from published_robots import PACKAGES, WORDS, unpack
from scipy.optimize import linprog
from scipy.spatial import ConvexHull, QhullError

load_checkout()

from body_moments.core.robots import Roots, read_description
from body_moments.core.robots.audit import Audit, Auditor, LinkAudit
from body_moments.core.robots.stated import Description, rotation_of_angles
from body_moments.core.robots.totals import Expectation
from body_moments.core.verdict import FileError, MeasureError, severity

AGREES = 5e-3  # of planted links' inertial and geometry; faults change more than four times that
MOST_LINKS = 3  # of a robot
OSMIUM = 22590.0
INCH, POUND = 0.0254, 0.45359237
LEFT = re.compile(r"(?<![a-z])(left|l|fl|rl|hl|lf|lr|lh)(?![a-z])", re.IGNORECASE)
ALARMS = ("error", "warning")
Numbers = tuple[float, np.ndarray, np.ndarray, np.ndarray]  # mass, center, tensor, angles


# Planted faults: each maps mass, center, tensor and angles of an inertial.


def inertia_times(factor: float, mass: float = 1.0) -> Callable:
    return lambda m, c, i, a: (m * mass, c, i * factor, a)


def listed(*names: str) -> Callable:
    """Write the six entries in the order that another program lists them."""

    def fault(m, c, i, a):
        entries = iter(i["xyz".index(p), "xyz".index(q)] for p, q in names)
        wrong = np.zeros((3, 3))
        for row, column in ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)):
            wrong[row, column] = wrong[column, row] = next(entries)
        return m, c, wrong, a

    return fault


def mapped(linear: np.ndarray, tensor: bool = True, center: bool = True) -> Callable:
    return lambda m, c, i, a: (
        m,
        linear @ c if center else c,
        linear @ i @ linear.T if tensor else i,
        a,
    )


def about(sign: float) -> Callable:
    return lambda m, c, i, a: (m, c, i + sign * m * (c @ c * np.eye(3) - np.outer(c, c)), a)


def thin(m, c, i, a):
    """Shrink the body to 10 million kg/m³."""
    density = m / (4 / 3 * np.pi * np.sqrt(125 * np.linalg.det(spread(i) / m)))
    return m, c, i * (density / 1e7) ** (2 / 3), a


def long(m, c, i, a):
    """Raise the largest principal moment to twice the sum of the others."""
    moments, axes = np.linalg.eigh(i)
    moments[2] = 2 * (moments[0] + moments[1])
    return m, c, (axes * moments) @ axes.T, a


FAULTS: dict[str, Callable] = {
    "no inertial": lambda *_: None,
    "mass 0": lambda m, c, i, a: (0.0, c, i, a),
    "negative mass": lambda m, c, i, a: (-m, c, i, a),
    "no inertia": inertia_times(0.0),
    "negative moments": inertia_times(-1.0),
    "A + B < C": long,
    "denser than any matter": thin,
    "center outside of the geometry": lambda m, c, i, a: (
        m,
        c + 8 * np.sqrt(np.trace(i) / m),
        i,
        a,
    ),
    "mass spread beyond the geometry": inertia_times(30.0),
    "mass in g": lambda m, c, i, a: (m * 1e3, c, i, a),
    "inertia in kg·mm²": inertia_times(1e6),
    "inertia in kg·cm²": inertia_times(1e4),
    "inertia in kg·in²": inertia_times(INCH**-2),
    "inertia in lb·in²": inertia_times(1 / (POUND * INCH**2)),
    "inertia in g·mm²": inertia_times(1e9),
    "mass in g, inertia in g·mm²": inertia_times(1e9, 1e3),
    "mass in g, inertia in g·cm²": inertia_times(1e7, 1e3),
    "mass in lb": inertia_times(1.0, 1 / POUND),
    "mass in lb, inertia in lb·in²": inertia_times(1 / (POUND * INCH**2), 1 / POUND),
    "center in mm": lambda m, c, i, a: (m, c * 1e3, i, a),
    "center in mm, inertia in kg·mm²": lambda m, c, i, a: (m, c * 1e3, i * 1e6, a),
    "center in inches, mass in lb, inertia in lb·in²": lambda m, c, i, a: (
        m / POUND,
        c / INCH,
        i / (POUND * INCH**2),
        a,
    ),
    "inertia of mass 1": lambda m, c, i, a: (m, c, i / m, a),
    "order of MuJoCo": listed("xx", "yy", "zz", "xy", "xz", "yz"),
    "order of the lower triangle": listed("xx", "xy", "yy", "xz", "yz", "zz"),
    "order of Fusion": listed("xx", "yy", "zz", "xy", "yz", "xz"),
    "order of Simscape": listed("xx", "yy", "zz", "yz", "xz", "xy"),
    "axes of the inertia swapped": mapped(np.eye(3)[[1, 0, 2]], center=False),
    "axes of the inertia rotated": mapped(np.eye(3)[[1, 2, 0]], center=False),
    "axes of the center swapped": mapped(np.eye(3)[[1, 0, 2]], tensor=False),
    "signs of the products": lambda m, c, i, a: (m, c, 2 * np.diag(np.diag(i)) - i, a),
    "sign of the center": mapped(np.diag([1, -1, 1]), tensor=False),
    "mirror image": mapped(np.diag([1, -1, 1])),
    "y for z up": mapped(np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])),
    "inertia about the link's origin": about(1.0),
    "parallel axes of the wrong sign": about(-1.0),
    "angles in degrees": lambda m, c, i, a: (m, c, i, np.degrees(a)),
    "angles left out": lambda m, c, i, a: (m, c, i, 0 * a),
}


def tree_of(path: Path) -> ElementTree.Element:
    """Return a file's root element, without the prefixes that some files use undeclared."""
    text = path.read_text(encoding="utf-8", errors="replace")
    return ElementTree.fromstring(re.sub(r"(</?|\s)\w+:(?=[\w.-]+[\s/>=])", r"\1", text))


def numbers_of(link: ElementTree.Element) -> Numbers | None:
    """Return the numbers of a URDF link's inertial, None without one."""
    inertial = link.find("inertial")
    if inertial is None:
        return None
    entry = inertial.find("inertia")
    tensor = np.zeros((3, 3))
    for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"):
        row, column = ("xyz".index(axis) for axis in name[1:])
        value = 0.0 if entry is None else float(entry.get(name, "0"))
        tensor[row, column] = tensor[column, row] = value
    origin, mass = inertial.find("origin"), inertial.find("mass")
    place = {} if origin is None else origin.attrib
    center, angles = (np.array(place.get(key, "0 0 0").split(), float) for key in ("xyz", "rpy"))
    return (0.0 if mass is None else float(mass.get("value", "0"))), center, tensor, angles


def write_numbers(link: ElementTree.Element, numbers: Numbers | None) -> None:
    """Replace a link's inertial."""
    for old in link.findall("inertial"):
        link.remove(old)
    if numbers is None:
        return
    mass, center, tensor, angles = numbers
    inertial = ElementTree.SubElement(link, "inertial")
    place = {
        "xyz": " ".join(map(repr, center.tolist())),
        "rpy": " ".join(map(repr, angles.tolist())),
    }
    ElementTree.SubElement(inertial, "origin", place)
    ElementTree.SubElement(inertial, "mass", value=repr(float(mass)))
    entries = {
        "i" + p + q: repr(float(tensor["xyz".index(p), "xyz".index(q)]))
        for p, q in ("xx", "xy", "xz", "yy", "yz", "zz")
    }
    ElementTree.SubElement(inertial, "inertia", entries)


def along_link(numbers: Numbers) -> tuple[float, np.ndarray, np.ndarray]:
    mass, center, tensor, angles = numbers
    turn = np.asarray(rotation_of_angles(*angles))
    return mass, center, turn @ tensor @ turn.T


def apart(first: tuple, other: tuple) -> float:
    """Return the relative difference of mass, center and inertia of two inertials."""
    radius = np.sqrt(abs(np.trace(first[2]) / 2 / first[0]))
    return max(
        abs(other[0] / first[0] - 1),
        np.linalg.norm(other[1] - first[1]) / radius,
        np.linalg.norm(other[2] - first[2]) / np.linalg.norm(first[2]),
    )


def spread(inertia: np.ndarray) -> np.ndarray:
    return np.trace(inertia) / 2 * np.eye(3) - inertia


def has_alarm(link: LinkAudit) -> bool:
    return any(entry.severity in ALARMS for entry in link.entries)


class Robot:
    """One published URDF, and audits of copies with faults."""

    def __init__(self, path: Path, audit: Audit, roots: Roots, meshes: dict) -> None:
        self.path, self.roots, self.meshes = path, roots, meshes
        self.mass = audit.totals.whole.mass
        self.original = {one.link.name: one for one in audit.links}
        right = [
            name
            for name, one in self.original.items()
            if not has_alarm(one) and one.apart < AGREES and one.link.inertial.mass > 0.0
        ]
        self.right = right[:: -(-len(right) // MOST_LINKS) or 1]

    def plant(
        self, faults: dict[str, Callable], expected: float | None = None, alone: bool = False
    ) -> Audit:
        """Return the audit of a copy with faults in some links, which map their numbers. alone:
        True if no other links are audited.
        """
        root = tree_of(self.path)
        for link in root.findall("link"):
            if link.get("name") in faults:
                write_numbers(link, faults[link.get("name")](*numbers_of(link)))
        copy = self.path.with_name("planted_" + self.path.name)
        copy.write_bytes(ElementTree.tostring(root))
        try:
            description = read_description(copy, self.roots)
        finally:
            copy.unlink()
        if alone:
            links = tuple(one for one in description.links if one.name in faults)
            description = replace(description, links=links, joints=())
        return Auditor(self.roots, {}, Expectation(expected), self.meshes).audit(description)

    def numbers(self) -> dict[str, Numbers]:
        links = tree_of(self.path).findall("link")
        return {
            one.get("name"): numbers for one in links if (numbers := numbers_of(one)) is not None
        }

    def count(self, kind: str, fault: Callable) -> Counter:
        """Return the counts of planted, found and undone faults of a kind."""
        numbers = self.numbers()
        changed = {}
        for name in self.right:
            right = along_link(numbers[name])
            wrong = fault(*numbers[name])
            if wrong is None or apart(right, along_link(wrong)) > 4 * AGREES:
                changed[name] = right
        if not changed:
            return Counter()
        counts = Counter(planted=len(changed))
        for one in self.plant(dict.fromkeys(changed, fault), alone=True).links:
            if one.link.name not in changed:
                continue
            assert not one.link.findings  # The planted numbers are well written.
            counts["found"] += has_alarm(one)
            if not has_alarm(one):
                print("not found:", kind, self.path, one.link.name, file=sys.stderr)
            undone = one.repaired
            if undone is not None:
                back = undone.mass, undone.center, undone.inertia
                counts["undone"] += bool(apart(changed[one.link.name], back) < 4 * AGREES)
        return counts

    def count_whole(self) -> Iterator[tuple[str, Counter]]:
        """Yield the kinds of faults that only several links together show, with their counts."""
        numbers = self.numbers()
        facts: dict[str, Facts] = {}
        for name in [one for one in self.right if numbers[one][0] > 0.002 * self.mass][:1]:
            heavy = self.plant({name: inertia_times(10.0, 10.0)}, self.mass)
            codes = [entry.finding.code for entry in heavy.entries]
            found = Counter(planted=1, found=int("audit_total" in codes))
            yield "mass and inertia times 10, by the expected total", found
        for left, right in [*self.twins()][:1]:
            for kind, fault in (
                ("one twin 20 % heavier", inertia_times(1.2, 1.2)),
                ("one twin's products of the wrong sign", FAULTS["signs of the products"]),
                ("one twin with A + B < C", long),
            ):
                wrong = along_link(fault(*numbers[left]))
                facts = facts or urdf_facts(self.path, self.roots)
                if not do_twins_differ(Facts(wrong, facts[left].shapes), facts[right]):
                    continue  # Copies are as good as mirror images of symmetric shapes.
                audit = {one.link.name: one for one in self.plant({left: fault}).links}
                found = has_alarm(audit[left]) or has_alarm(audit[right])
                if not found:
                    print("not found:", kind, self.path, left, right, file=sys.stderr)
                undone = audit[left].repaired
                back = undone and (undone.mass, undone.center, undone.inertia)
                is_back = back and apart(along_link(numbers[left]), back) < 0.1
                yield kind, Counter(planted=1, found=int(found), undone=int(bool(is_back)))
        first, *others = sorted(self.right, key=lambda name: self.original[name].volume)[::-1] or [
            ""
        ]
        for other in others[-1:]:
            if self.original[other].volume < 0.9 * self.original[first].volume:
                audit = self.plant({other: lambda *_: numbers[first]})
                found = sum(has_alarm(one) for one in audit.links if one.link.name in self.right)
                yield "another link's inertial", Counter(planted=1, found=int(found > 0))

    def twins(self) -> Iterator[tuple[str, str]]:
        """Yield pairs of left and right links without alarms and of equal volume."""
        for name, one in self.original.items():
            sides = LEFT.findall(name)
            if not sides or has_alarm(one) or one.link.inertial is None:
                continue
            other = LEFT.sub(lambda m: self.opposite(m[0]), name)
            twin = self.original.get(other)
            if twin is None or has_alarm(twin) or not twin.volume or twin.link.inertial is None:
                continue
            if abs(one.volume / twin.volume - 1) < 0.01:
                yield name, other

    @staticmethod
    def opposite(word: str) -> str:
        """Return the right side's word for a left side's, in its case."""
        lower = word.lower()
        changed = "right" if lower == "left" else lower.replace("l", "r")
        return changed.upper() if word.isupper() else changed


# Confirmation of alarms by other programs


class Facts:
    """A link as other programs see it: its numbers, and the roles of its shapes, their meshes in
    its frame and their poses.
    """

    def __init__(self, numbers: tuple | None, shapes: list[tuple]) -> None:
        self.numbers, self.shapes = numbers, shapes

    def points(self) -> np.ndarray:
        return np.concatenate([mesh.vertices for _, mesh, _ in self.shapes])

    def filled(self, turn: np.ndarray | None = None) -> list[tuple]:
        """Return volume, center and inertia at density 1 of each role's shapes. turn: of each
        shape in its own frame.
        """
        roles: dict[str, list] = {}
        for role, mesh, pose in self.shapes:
            own = mesh.copy()
            if turn is not None:
                own.apply_transform(pose @ turn @ np.linalg.inv(pose))
            roles.setdefault(role, []).append(own)
        wholes = map(trimesh.util.concatenate, roles.values())
        return [(whole.volume, whole.center_mass, whole.moment_inertia) for whole in wholes]

    def nearest(self, numbers: tuple, turn: np.ndarray | None = None) -> float:
        """Return the difference of an inertial from evenly filled shapes of the same mass."""
        return min(
            apart((numbers[0], center, inertia * numbers[0] / volume), numbers)
            for volume, center, inertia in self.filled(turn)
        )

    def center_distance(self, center: np.ndarray) -> float:
        """Return the distance of a center from that of the shapes, per radius of gyration."""
        return min(
            np.linalg.norm(center - own) / np.sqrt(np.trace(inertia / volume) / 2)
            for volume, own, inertia in self.filled()
        )


@cache
def load(path: Path) -> trimesh.Trimesh:
    loaded = trimesh.load(path)
    return loaded.to_mesh() if isinstance(loaded, trimesh.Scene) else loaded


def pose_of(node: ElementTree.Element) -> np.ndarray:
    origin = node.find("origin")
    place = {} if origin is None else origin.attrib
    center, angles = (np.array(place.get(key, "0 0 0").split(), float) for key in ("xyz", "rpy"))
    pose = trimesh.transformations.euler_matrix(*angles, "sxyz")
    pose[:3, 3] = center
    return pose


def urdf_facts(path: Path, roots: Roots) -> dict[str, Facts]:
    facts = {}
    for link in tree_of(path).findall("link"):
        try:
            numbers = numbers_of(link)
        except ValueError:
            numbers = None
        if numbers is not None:
            turn = trimesh.transformations.euler_matrix(*numbers[3], "sxyz")[:3, :3]
            numbers = (*numbers[:2], turn @ numbers[2] @ turn.T)
        shapes = []
        for role in ("visual", "collision"):
            for node in link.findall(role):
                if (mesh := urdf_mesh(node, roots)) is not None:
                    pose = pose_of(node)
                    shapes.append((role, mesh.apply_transform(pose), pose))
        facts[link.get("name")] = Facts(numbers, shapes)
    return facts


def urdf_mesh(node: ElementTree.Element, roots: Roots) -> trimesh.Trimesh | None:
    """Return a shape of URDF in its own frame, None if it bounds nothing or cannot be read."""
    for shape in node.find("geometry") or ():
        size = {
            key: np.array(text.split(), float)
            for key, text in shape.attrib.items()
            if key != "filename"
        }
        if shape.tag == "mesh":
            try:
                mesh = load(roots.find(shape.get("filename"))).copy()
            except (FileError, ValueError, KeyError):
                return None
            return mesh.apply_transform(np.diag([*size.get("scale", np.ones(3)), 1.0]))
        if any((one <= 0.0).any() for one in size.values()):
            return None
        if shape.tag == "box":
            return trimesh.creation.box(size["size"])
        if shape.tag == "sphere":
            return trimesh.creation.icosphere(4, float(size["radius"][0]))
        make = {"cylinder": trimesh.creation.cylinder, "capsule": trimesh.creation.capsule}
        mesh = make[shape.tag](radius=float(size["radius"][0]), height=float(size["length"][0]))
        return mesh.apply_translation(-mesh.bounds.mean(axis=0))
    return None


def mjcf_facts(path: Path, roots: Roots) -> dict[str, Facts]:
    model = mujoco.MjModel.from_xml_path(str(path))
    facts = {}
    for body in map(model.body, range(1, model.nbody)):
        turn = trimesh.transformations.quaternion_matrix(body.iquat)[:3, :3]
        numbers = (float(body.mass[0]), body.ipos, (turn * body.inertia) @ turn.T)
        shapes = []
        for geom in map(model.geom, np.flatnonzero(model.geom_bodyid == body.id)):
            kind, size = mujoco.mjtGeom(int(geom.type[0])), geom.size
            if kind == mujoco.mjtGeom.mjGEOM_MESH:
                one = model.mesh(geom.dataid[0])
                points = model.mesh_vert[one.vertadr[0] :][: one.vertnum[0]]
                mesh = trimesh.Trimesh(points, model.mesh_face[one.faceadr[0] :][: one.facenum[0]])
            elif kind == mujoco.mjtGeom.mjGEOM_BOX:
                mesh = trimesh.creation.box(2 * size)
            elif kind == mujoco.mjtGeom.mjGEOM_CYLINDER:
                mesh = trimesh.creation.cylinder(size[0], 2 * size[1])
            elif kind == mujoco.mjtGeom.mjGEOM_CAPSULE:
                mesh = trimesh.creation.capsule(2 * size[1], size[0])
                mesh.apply_translation(-mesh.bounds.mean(axis=0))
            elif kind == mujoco.mjtGeom.mjGEOM_SPHERE:
                mesh = trimesh.creation.icosphere(4, size[0])
            else:
                continue
            pose = trimesh.transformations.quaternion_matrix(geom.quat)
            pose[:3, 3] = geom.pos
            role = "visual" if geom.contype[0] == geom.conaffinity[0] == 0 else "collision"
            shapes.append((role, mesh.apply_transform(pose), pose))
        facts[body.name] = Facts(numbers, shapes)
    return facts


def misfit(points: np.ndarray, center: np.ndarray, second: np.ndarray | None) -> float:
    """Return the least error of center and second moments, per size and its square, of any masses
    at the corners of the points' hull and at points within it.
    """
    size = np.linalg.norm(np.ptp(points, axis=0))
    points, center = (points - points.mean(axis=0)) / size, (center - points.mean(axis=0)) / size
    try:
        hull = ConvexHull(points)
    except QhullError:
        points = np.unique(points, axis=0)
    else:
        axes = np.linspace(points.min(axis=0), points.max(axis=0), 9).T
        grid = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 3)
        grid = np.concatenate([grid, center[None]])
        inside = (grid @ hull.equations[:, :3].T + hull.equations[:, 3] <= 1e-9).all(axis=1)
        points = np.concatenate([points[hull.vertices], grid[inside]])
    arms = points - center
    rows, wanted = [*arms.T], [0.0, 0.0, 0.0]
    if second is not None:
        for p, q in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)):
            rows.append(arms[:, p] * arms[:, q])
            wanted.append(second[p, q] / size**2)
    table, slack = np.array(rows), np.ones((len(rows), 1))
    table = np.block([[table, -slack], [-table, -slack]])
    limits = np.array([*wanted, *(-one for one in wanted)])
    cost = np.append(np.zeros(len(points)), 1.0)
    total = np.append(np.ones(len(points)), 0.0)[None]
    return float(linprog(cost, table, limits, total, [1.0]).fun)


def do_twins_differ(first: Facts, other: Facts) -> bool:
    """Return whether no mirror that maps the first's shapes to the other's maps the inertial."""
    mirrors = [np.diag(one) for one in product((1, -1), repeat=3)]
    if first.shapes and other.shapes:
        volume, center, inertia = other.filled()[0]
        own = first.filled()[0]
        fits = [apart(own, (volume, m @ center, m @ inertia @ m)) for m in mirrors]
        mirrors = [m for m, fit in zip(mirrors, fits, strict=True) if fit < 0.05] or mirrors
    tensors = [m @ first.numbers[2] @ m - other.numbers[2] for m in mirrors]
    least = min(map(np.linalg.norm, tensors)) / np.linalg.norm(other.numbers[2])
    return bool(least > 0.045 or abs(first.numbers[0] / other.numbers[0] - 1) > 0.045)


def is_confirmed(
    code: str, values: dict, link: LinkAudit, facts: dict[str, Facts], path: Path, content: Path
) -> bool:
    """Return whether another program sees the same fault of a link."""
    own = facts[link.link.name]
    if code == "inertial_missing":
        return own.numbers is None
    if code == "mesh_missing":
        scheme, _, name = values["name"].rpartition("://")
        inside = name.partition("/")[2] if scheme == "package" else name
        places = content.rglob("*" + inside) if scheme else [path.parent / inside]
        return not any(place.is_file() for place in places)
    if code == "description_number":
        numbers = values["text"].split()
        return own.numbers is None or not numbers or min(map(float, numbers)) <= 0.0
    mass, center, inertia = own.numbers
    moments = np.linalg.eigvalsh(inertia)
    if code == "inertial_not_positive":
        return mass <= 0.0 or moments[0] <= 1e-13 * moments[2]
    if code.startswith("inertial_triangle"):
        return moments[2] > moments[0] + moments[1]
    second = spread(inertia) / mass
    if code == "inertial_too_dense":
        return mass / (4 / 3 * np.pi * np.sqrt(125 * max(np.linalg.det(second), 0))) > OSMIUM
    if code == "inertial_center_outside":
        return misfit(own.points(), center, None) > 5e-4
    if code == "inertial_spread_outside":
        return misfit(own.points(), center, second) > 1e-4
    if code == "audit_density" or "density" in values:
        hull = trimesh.points.PointCloud(own.points()).convex_hull.volume
        volumes = [hull, *(volume for volume, _, _ in own.filled())]
        return any(not 10.0 <= mass / abs(volume) <= 30000.0 for volume in volumes)
    if code == "audit_copied":
        several = [facts[name] for name in values["links"]]
        moments = [
            [np.append(v, np.linalg.eigvalsh(i / v)) for v, _, i in one.filled()] for one in several
        ]
        return all(apart(own.numbers, one.numbers) < 1e-9 for one in several) and any(
            np.abs(one[0] / moments[0][0] - 1).max() > 0.04 for one in moments[1:]
        )
    if code == "audit_twins":
        return do_twins_differ(facts[values["first"]], facts[values["second"]])
    if code == "audit_up_axis":
        turns = ((np.pi / 2, (1, 0, 0)), (-np.pi / 2, (0, 1, 0)))
        ups = [trimesh.transformations.rotation_matrix(*one) for one in turns]
        return min(own.nearest(own.numbers, up) for up in ups) < own.nearest(own.numbers)
    if link.repaired is not None:
        back = link.repaired.mass, link.repaired.center, link.repaired.inertia
        if "center" in values.get("part", ""):  # Then the inertia may be that of uneven mass.
            before, after = own.center_distance(center), own.center_distance(back[1])
            return after < min(0.02, 0.5 * before)
        return own.nearest(back) < min(0.02, 0.5 * own.nearest(own.numbers))
    return False


def count_alarms(audit: Audit, path: Path, roots: Roots, content: Path, codes: dict) -> Counter:
    """Return the counts of links, alarms and unconfirmed ones of a right file; also by codes."""
    read = {"urdf": urdf_facts, "mjcf": mjcf_facts}[audit.description.format]
    facts = read(path, roots) if any(map(has_alarm, audit.links)) else {}
    counts = Counter(links=len(audit.links))
    for link in audit.links:
        alarms = {}
        for entry in link.entries:
            if entry.severity in ALARMS:
                several = (*entry.reasons, entry.finding)
                alarms |= {one.code: one.values for one in several if severity(one) in ALARMS}
        doubtful = False
        for code, values in alarms.items():
            try:
                is_right = is_confirmed(code, values, link, facts, path, content)
            except (KeyError, ValueError, IndexError, QhullError) as error:
                is_right = False
                print(repr(error), file=sys.stderr)
            codes.setdefault(code, Counter()).update(alarms=1, confirmed=int(is_right))
            if not is_right:
                doubtful = True
                print("unconfirmed:", code, path, link.link.name, values, file=sys.stderr)
        counts["alarmed"] += bool(alarms)
        counts["doubtful"] += doubtful
    return counts


HEAD = """# Faults Found, and Alarms

This page tests the [audit](robots.md#audit) in two ways. First, we put known faults into published
robots, and count how many of these faults the audit finds. Second, we audit the unchanged robots,
and other programs check each alarm of the audit. The robots are the URDF and MJCF files of
[Published Robots, Audited](robots-audited.md). The command `python3 tests/project.py alarms` made
this page.

## Faults

The inertial of a link is its mass, center and inertia. Each kind of fault is put into up to three
links of each URDF file. We choose links that are right without the fault: the audit gives no error
or warning about the link, and its inertial differs by less than 0.5 % from the inertial of the
evenly filled geometry. A fault is left out if it changes the inertial by less than 2 %.

The faults in the last five rows of the table below concern several links together. Each of these
faults is put into a URDF file at most once. [Twins](robots.md#twins) are two links that should have
equal or mirrored inertials. The mass of twins may be spread unevenly.

The columns of the table are:

- *Planted* is the number of links with the fault.
- *Found* is the number of these links about which the audit gives an error or a warning.
- *Undone* is the number of these links whose inertial is right after the repair. The repaired
  inertial then differs from the inertial before the fault by at most 2 %. For twins, the limit is
  10 %.

Some names of faults need an explanation:

- *A + B < C*: A, B and C are the principal moments. No body can have such moments.
- *order of …*: the six entries of the inertia are in the order of another program, or in the order
  of the lower triangle of the matrix.
- *inertia of mass 1*: the inertia is divided by the mass.
- *y for z up*: the inertial is stated in axes with y up instead of z up.
- *parallel axes of the wrong sign*: the inertia was moved from the origin to the center, although
  it was already about the center.
- *by the expected total*: the audit finds the fault because the total mass is wrong.

Some faults cannot be undone. No repair can know a missing mass. Pounds can look like kilograms,
because the inertia per mass is the same number in lb·in² per lb and in kg·in² per kg. The audit
then proposes kg·in². But if the center is in inches, too, the audit proposes pounds.

| fault | planted | found | undone |
|---|---|---|---|
"""
ALARMS_HEAD = """
## Alarms

An alarm is an error or a warning of the audit. The published files have {links} links, and
{alarmed} of these links have an alarm. Each alarm is checked with other programs:

- The library trimesh measures the meshes.
- SciPy shows that no set of masses inside the convex hull has the stated center and inertia.
- MuJoCo reads the MJCF files.
- NumPy computes with the numbers of the XML files.

An alarm is confirmed if these programs agree with the audit. The check uses code of the audit only
to find the mesh files.

{verdict}

| alarm | links | confirmed |
|---|---|---|
"""


def counts_of(package: str, folder: Path) -> dict[str, Any]:
    """Return the counts of links, and of planted faults and alarms by their kinds, of a package."""
    faults: dict[str, Counter] = {}
    codes: dict[str, Counter] = {}
    links: Counter = Counter()
    content = unpack(package, folder, "_original")
    meshes: dict = {}
    for path, description in largest(content):
        roots = Roots.for_file(path, [content])
        audit = Auditor(roots, meshes=meshes).audit(description)
        links.update(count_alarms(audit, path, roots, content, codes))
        for key, piece in meshes.items():  # The same hull of fewer points takes less time.
            if len(piece.points) > 1000:
                corners = ConvexHull(piece.points, qhull_options="QJ").vertices
                meshes[key] = replace(piece, points=piece.points[corners])
        if description.format == "urdf":
            robot = Robot(path, audit, roots, meshes)
            counts = [(kind, robot.count(kind, fault)) for kind, fault in FAULTS.items()]
            for kind, count in [*counts, *robot.count_whole()]:
                faults.setdefault(kind, Counter()).update(count)
    return {"links": links, "faults": faults, "codes": codes}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--folder", type=Path, default=ROOT / ".envs" / "robots-audited")
    parser.add_argument("--package", action="append", help="only these, and no page")
    options = parser.parse_args()
    faults: dict[str, Counter] = {}
    codes: dict[str, Counter] = {}
    links: Counter = Counter(alarmed=0, doubtful=0)
    for package in options.package or PACKAGES:
        report = options.folder / (package.partition("==")[0] + "_alarms.json")
        if not report.is_file():
            report.write_text(json.dumps(counts_of(package, options.folder)), encoding="utf-8")
        counts = json.loads(report.read_text(encoding="utf-8"))
        links.update(counts["links"])
        for kinds, found in ((faults, counts["faults"]), (codes, counts["codes"])):
            for kind, count in found.items():
                kinds.setdefault(kind, Counter()).update(count)
        print(package, dict(links), flush=True)
    text = HEAD
    for kind, count in faults.items():
        text += "| {} | {} | {} | {} |\n".format(
            kind, count["planted"], count["found"], count["undone"]
        )
    verdict = "All alarms of these {alarmed} links are confirmed."
    if links["doubtful"]:
        verdict = "{doubtful} of these {alarmed} links have an alarm that is not confirmed."
    text += ALARMS_HEAD.format(verdict=verdict.format(**links), **links)
    for code, count in sorted(codes.items()):
        text += "| {} | {} | {} |\n".format(
            WORDS.get(code, code), count["alarms"], count["confirmed"]
        )
    print(text)
    if not options.package:
        (ROOT / "docs" / "robots-alarms.md").write_text(text, encoding="utf-8")


def largest(content: Path) -> list[tuple[Path, Description]]:
    """Return the URDF or MJCF file with the most links of each robot of a package."""
    robots: dict[str, tuple[Path, Description]] = {}
    for path in sorted(content.rglob("*")):
        if path.suffix not in (".urdf", ".xml"):
            continue
        try:
            description = read_description(path, Roots.for_file(path, [content]))
        except MeasureError:
            continue
        known = robots.get(description.name)
        if description.links and (known is None or len(known[1].links) < len(description.links)):
            robots[description.name] = path, description
    return [robots[name] for name in sorted(robots)]


if __name__ == "__main__":
    main()
