# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers of the corpus, before and after a change.

    python tests/corpus/compare.py --write OUT.json     measure the corpus and keep the numbers (.json or .json.gz)
    python tests/corpus/compare.py REFERENCE.json       measure it and compare with what was kept, bit for bit

for a Python with the bpy module (.envs/blender-5.2/bin/python). The second prints every difference and their count, and
ends with 1 where there is one. `within` is what tests/corpus/test_corpus.py asks, on any machine, of the references
that are kept here: Blender 5.2's, and of 4.5 what differs:

    --write reference-5.2.json.gz, and with the other: --write reference-4.5.json.gz --beside reference-5.2.json.gz
"""

from __future__ import annotations

import argparse
import gzip
import importlib.util
import json
import os
import shutil
import sys
import tempfile
import traceback
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import numpy as np

ROOT = Path(__file__).resolve().parent.parent.parent
MISSING = "(missing)"


def load(path: Path) -> dict[str, object]:
    data = path.read_bytes()
    return json.loads(gzip.decompress(data) if path.suffix == ".gz" else data)


def save(path: Path, table: dict[str, object]) -> None:
    """One entry a line, in the order of their keys; floats as the shortest digits that give the same bits."""
    lines = [
        "{}: {}".format(json.dumps(key, ensure_ascii=False), json.dumps(table[key], ensure_ascii=False))
        for key in sorted(table)
    ]
    data = ("{\n" + ",\n".join(lines) + "\n}\n").encode()
    path.write_bytes(gzip.compress(data, 9, mtime=0) if path.suffix == ".gz" else data)


def leaves(value: object, path: str = "") -> Iterator[tuple[str, object]]:
    """Whatever is no table or list, each with its place; an empty one is its own leaf."""
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else None
    if not items:
        yield path, value
        return
    for key, one in items:
        yield from leaves(one, "{} › {}".format(path, key))


def differences(before: dict, after: dict) -> Iterator[tuple[str, object, object]]:
    """(place, before, after) of what differs by as little as a bit, 0.0 and -0.0 too; entries that are new do not."""
    for key in sorted(before):
        if key not in after:
            yield key, "…", MISSING
            continue
        old, new = dict(leaves(before[key], key)), dict(leaves(after[key], key))
        for place, value in old.items():
            if place not in new or repr(value) != repr(new[place]):
                yield place, value, new.get(place, MISSING)
        if isinstance(before[key], list):  # who was refused
            for place in new.keys() - old.keys():
                yield place, MISSING, new[place]


# Within what another processor or numpy may change

BOUND = 0.1  # the share of a reported bound that a number may move by
RELATIVE = 1e-13  # where none is reported, beside the largest number of its kind
EPSILON = 4 * np.finfo(float).eps  # beside the number itself, for bounds that are smaller than its last digits
OF_BOUNDS = 1e-3  # by which a bound may move beside itself: it is made of roundings
OF_ESTIMATES = 0.1  # likewise if it is the difference of two rules that agree, or of points that Blender computes
OF_DISPLAY = 1e-6  # beside the volume of a display mesh, whose points Blender computes in float32
# Beside the largest of each: Zernike descriptors to order 20 are differences of far larger numbers, and the
# chirality of a body that has none is rounding.
OF_SIGNATURE = {"size": RELATIVE, "invariants": 1e-12, "fourier": 1e-12, "zernike": 1e-8, "chirality": 1e-6}
BOUNDED = ("volume", "area", "center_of_mass", "inertia")


def within(before: dict, after: dict, loose: set[str] = frozenset()) -> Iterator[tuple[str, object, object]]:
    """(place, before, after) of what differs by more than rounding. loose: scenes, and bodies in them, whose points
    Blender computes: a tenth of what float32 may have changed is added there."""
    for key in sorted(before):
        if key not in after:
            yield key, "…", MISSING
            continue
        old, new = before[key], after[key]
        if not isinstance(old, dict):
            if old != new:
                yield key, old, new
            continue
        unique = _is_unique(key, before)
        tolerance = Tolerance(old, unique, _is_of(key, loose))
        for name, place, value, found, allowed in tolerance.compared(old, new):
            if allowed is not None and not _close(value, found, allowed):
                yield "{} › {}{}".format(key, name, place), value, found


def _close(value: object, found: object, allowed: float) -> bool:
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if not number or isinstance(found, (str, bool)) or found is None:
        return type(value) is type(found) and value == found
    return abs(value - found) <= allowed


def _is_of(key: str, places: set[str]) -> bool:
    """Whether the entry is of one of these: "SCENE" or "SCENE/OBJECT", or "SCENE total"."""
    place = key.partition("/")[2].replace(".blend", "", 1)
    return any(place == one or place.startswith((one + "/", one + " ")) for one in places)


def _is_unique(key: str, table: dict) -> bool:
    """Whether a body's principal axes are its own; stored properties do not say, their record does."""
    if key.startswith("properties/"):
        _, scene, name = key.split("/", 2)
        found = table.get("object/{}.blend/{}".format(scene, name), {})
    else:
        found = table[key]
    return found.get("principal_axes_unique") is True


class Tolerance:
    """By how much each number of one entry may differ."""

    def __init__(self, entry: dict, unique: bool, loose: bool) -> None:
        self.unique, self.loose = unique, loose
        bound = entry.get("error_bound")
        if bound is None and "body_error_bound" in entry:
            stored = entry["body_error_bound"]
            bound = dict(zip(BOUNDED, stored[:4])) | {"input": dict(zip(BOUNDED, stored[4:]))}
        self.bound = bound or {}
        prefix = "body_" if "body_volume" in entry else ""
        self.entry = {name.removeprefix(prefix): value for name, value in entry.items()}

    def of(self, name: str, values: list[float]) -> float:
        """A tenth of the bound where there is one, else RELATIVE, never less than the last digits of the values."""
        size = max(map(abs, values), default=0.0)
        given = self.bound.get(name)
        allowed = BOUND * given if given else RELATIVE * size
        if self.loose:
            allowed += BOUND * (self.bound.get("input", {}).get(name) or 1e-6 * size)
        return max(allowed, EPSILON * size)

    def share(self) -> float:
        """By what share of itself the mass may differ, and whatever grows as it does."""
        volume = self.entry.get("volume") or 0.0
        return max(RELATIVE, self.of("volume", [volume]) / abs(volume) if volume else 0.0)

    def turn(self) -> float:
        """By what angle unique axes may differ; those that higher moments choose between equal ones, by 1e-6."""
        moments = self.entry.get("principal_moments")
        if not moments or moments[0] is None:
            return 1e-6
        gap = min(np.diff(moments))
        least = RELATIVE * moments[2]
        return min(1e-6, (self.of("inertia", moments) + least) / gap) if gap > 1e-6 * moments[2] else 1e-6

    def compared(self, old: dict, new: dict) -> Iterator[tuple[str, str, object, object, float | None]]:
        """(name, place, before, after, allowed) of every leaf of the entry."""
        for name, value in old.items():
            if name not in new:
                yield name, "", value, MISSING, 0.0
                continue
            found = dict(leaves(new[name]))
            rows = list(leaves(value))
            allowed = self.allowed(name.removeprefix("body_"), value)
            for place, one in rows:
                of_one = allowed(place, one) if callable(allowed) else allowed
                yield name, place, one, found.get(place, MISSING), of_one

    def allowed(self, name: str, value: object):
        numbers = [one for _, one in leaves(value) if isinstance(one, (int, float)) and not isinstance(one, bool)]
        size = max(map(abs, numbers), default=0.0)
        if name in ("volume", "area", "inertia"):
            return self.of(name, numbers)
        if name == "center_of_mass":
            return self.of(name, numbers if self.bound else [size + self.reach()])
        if name == "principal_moments":
            return self.of("inertia", numbers)
        if name == "inertia_products":
            return self.of("inertia", self.entry["inertia_diagonal"])
        if name in ("mass", "density"):
            return self.share() * size
        if name in ("display_volume", "display_mesh"):
            return OF_DISPLAY * size
        if name == "principal_axes":
            return self.turn() if self.unique else None
        if name == "error_bound":
            return lambda place, one: self.of_bound(one)
        if name == "moments":
            return self.of_moments(value)
        if name == "pose":
            return self.of_pose(value)
        if name == "signature":
            return self.of_signature(value)
        if name == "health":
            return lambda place, one: self.of_health(place)
        if name == "section":
            return self.of_section(value)
        if name == "q":
            return 0.0
        return (RELATIVE + (1e-6 if self.loose else 0.0)) * size

    def reach(self) -> float:
        """The largest radius of gyration."""
        mass, moments = self.entry.get("mass"), self.entry.get("principal_moments")
        return float(np.sqrt(abs(moments[2] / mass))) if mass and moments and moments[2] else 0.0

    def of_bound(self, one: object) -> float:
        if isinstance(one, bool) or not isinstance(one, (int, float)):
            return 0.0
        estimated = self.bound.get("estimated") or str(self.entry.get("method")).startswith(("NURBS", "wire"))
        return (OF_ESTIMATES if estimated or self.loose else OF_BOUNDS) * abs(one)

    def of_moments(self, moments: dict):
        """RELATIVE beside the largest of an order, or extent × length^order: odd ones are zero for many bodies. Above
        order 0 a tenth of its own bound where that is more: far away they are differences of large numbers."""
        sizes = {}
        for kind, entries in moments.items():
            if not isinstance(entries, dict) or kind in ("error", "input"):
                continue
            table = {tuple(map(int, key.split(","))): value for key, value in entries.items() if value is not None}
            extent = abs(table.get((0, 0, 0), 0.0))
            second = max((abs(value) for key, value in table.items() if sum(key) == 2), default=0.0)
            length = np.sqrt(second / extent) if extent else 0.0
            for order in {sum(key) for key in table}:
                largest = max(abs(value) for key, value in table.items() if sum(key) == order)
                sizes[kind, order] = max(largest, extent * length**order)
        share = self.share() if self.loose else RELATIVE

        def allowed(place: str, one: object) -> float:
            words = place.split(" › ")[1:]
            if words[:1] in (["error"], ["input"]):
                return self.of_bound(one)
            if len(words) != 2 or words[0] not in moments or "," not in words[1]:
                return 0.0
            order = sum(map(int, words[1].split(",")))
            bound = moments.get("error", {}).get(words[0], {}).get(words[1]) if order else None
            return max(share * sizes.get((words[0], order), 0.0), BOUND * (bound or 0.0))

        return allowed

    def of_pose(self, pose: dict | None):
        unique = pose is not None and pose["unique"] is True
        center = self.entry.get("center_of_mass") or [0.0]
        distance = max(map(abs, center))

        def allowed(place: str, one: object) -> float | None:
            words = place.split(" › ")[1:]
            if words[:1] != ["matrix"]:
                return 0.0
            if not unique:
                return None
            moved = self.of("center_of_mass", center) if self.bound else RELATIVE * distance
            return self.turn() + (self.turn() * distance + moved if words[2] == "3" else 0.0)

        return allowed

    def of_signature(self, signature: dict | None):
        sizes = {
            name: max((abs(one) for _, one in leaves(value) if isinstance(one, (int, float))), default=0.0)
            for name, value in (signature or {}).items()
        }

        def allowed(place: str, one: object) -> float:
            name = (place.split(" › ") + [""])[1]
            return OF_SIGNATURE.get(name, RELATIVE) * sizes.get(name, 0.0)

        return allowed

    def of_health(self, place: str) -> float:
        if place.endswith("volume_spread"):
            return max(RELATIVE, self.share()) * abs(self.entry.get("volume") or 0.0)
        return max(RELATIVE, self.share()) if place.endswith("cap_area_share") else 0.0

    def of_section(self, section: dict):
        side = float(np.sqrt(section["area"][0]))
        sizes = {name: max(map(abs, value)) for name, value in section.items() if isinstance(value, list)}
        lengths = {"origin": side, "centroid": side, "off": side, "reach": side}

        def allowed(place: str, one: object) -> float:
            name = place.split(" › ")[1]
            if name in ("error", "input"):
                return OF_BOUNDS * abs(one)
            return RELATIVE * max(sizes[name], lengths.get(name, 0.0))

        return allowed


# Measuring


def _prepare() -> str:
    """Loads the add-on from this checkout under a name of its own, with a user folder of its own; that folder."""
    folder = tempfile.mkdtemp(prefix="body_moments_corpus_")
    for name in [name for name in os.environ if name.startswith(("BLENDER_USER_", "BLENDER_SYSTEM_"))]:
        del os.environ[name]
    os.environ["BLENDER_USER_RESOURCES"] = folder
    tests = ModuleType("tests")
    tests.__path__ = [str(ROOT / "tests")]
    sys.modules["tests"] = tests
    spec = importlib.util.spec_from_file_location(
        "body_moments", ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    sys.modules["body_moments"] = module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return folder


def _measure() -> dict[str, object]:
    folder = _prepare()
    try:
        import body_moments

        from tests.corpus.runs import collect

        body_moments.register()
        work = Path(folder) / "work"
        work.mkdir()
        return collect(work)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def main() -> int:
    parser = argparse.ArgumentParser(description="Measures the corpus, and keeps or compares the numbers bit for bit.")
    parser.add_argument("reference", nargs="?", type=Path, metavar="REFERENCE.json")
    parser.add_argument("--write", type=Path, metavar="OUT.json")
    parser.add_argument(
        "--beside",
        type=Path,
        metavar="BASE.json",
        help="with --write: only what differs from BASE by more than rounding",
    )
    options = parser.parse_args()
    if (options.reference is None) == (options.write is None):
        parser.error("give either a reference or --write")
    before = None if options.reference is None else load(options.reference)
    after = _measure()
    if options.beside is not None:
        base = load(options.beside)
        changed = {place.partition(" › ")[0] for place, _, _ in within(base, after)}
        after = {key: one for key, one in after.items() if key in changed or key not in base}
    if before is None:
        save(options.write, after)
        print("{} entries were written.".format(len(after)))
        return 0
    count = 0
    for place, old, new in differences(before, after):
        count += 1
        print("{}: {!r} -> {!r}".format(place, old, new))
    print("{} differences in {} entries".format(count, len(before)))
    return 1 if count else 0


if __name__ == "__main__":
    try:
        code = main()
    except Exception:
        traceback.print_exc()
        code = 70
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)  # bpy 4.5 may crash while the interpreter ends
