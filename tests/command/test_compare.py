# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""`compare`: the allowed difference of each number of a record, from both sides."""

import copy
import math

import pytest
from body_moments.command.results.compare import differences

from tests.blender.batch_files import add_box, document
from tests.blender.flat_objects import sheet

pytestmark = pytest.mark.usefixtures("scene")


def bounds_of(entry, name):
    return entry["error_bound"][name] + entry["error_bound"]["input"][name]


def degree(key):
    return sum(map(int, key.split(",")))


def of_moments(entry, domain, key, name=None):
    moments = entry["moments"]
    bound = sum(moments[part].get(domain, {}).get(key, 0.0) for part in ("error", "input"))
    size = max(
        abs(value) for other, value in moments[domain].items() if degree(other) == degree(key)
    )
    return ("moments", domain, key), name or "moments.{}[{}]".format(domain, key), bound, size


def numbers_of_body(entry):
    """Yield the path and name of each number, the bound of one record, and the size that a
    tolerance refers to.
    """
    share = bounds_of(entry, "volume") / entry["volume"]
    for name in ("volume", "area"):
        yield (name,), name, bounds_of(entry, name), entry[name]
    for name in ("mass", "density"):
        yield (name,), name, share * entry[name], entry[name]
    gyration = math.sqrt(sum(entry["principal_moments"]) / (2 * entry["mass"]))
    for k in range(3):
        bound = bounds_of(entry, "center_of_mass")
        yield ("center_of_mass", k), "center_of_mass[{}]".format("xyz"[k]), bound, gyration
        size = max(abs(value) for row in entry["inertia"] for value in row)
        bound = bounds_of(entry, "inertia")
        yield ("principal_moments", k), "principal_moments[{}]".format(k + 1), bound, size
        for j in range(k, 3):
            yield ("inertia", k, j), "inertia[{}{}]".format("xyz"[k], "xyz"[j]), bound, size
    for domain in ("volume", "surface"):
        for key in ("0,0,0", "0,0,1", "1,1,0", "0,2,0"):
            yield of_moments(entry, domain, key)


def numbers_of_flat(entry):
    bounds, second = entry["error_bound"], entry["second_moments"]
    yield ("area",), "area", bounds_of(entry, "area"), entry["area"]
    gyration = math.sqrt((second["xx"] + second["yy"]) / entry["area"])
    for k in range(3):
        yield (
            ("centroid", k),
            "centroid[{}]".format("xyz"[k]),
            bounds_of(entry, "centroid"),
            gyration,
        )
        for axis in ("x", "y", "normal"):
            turned = (bounds["area"] + bounds["input"]["area"]) / entry["area"]
            yield ("plane", axis, k), "plane.{}[{}]".format(axis, "xyz"[k]), turned, 1.0
    for name in second:
        size = max(map(abs, second.values()))
        yield (
            ("second_moments", name),
            "second_moments[{}]".format(name),
            bounds_of(entry, "second_moments"),
            size,
        )
    for key in ("0,0", "1,0", "1,1", "0,3"):
        yield of_moments(entry, "area", key)
    for number, one in enumerate(entry["invariants"]):
        for part in ("real", "imaginary"):
            size = math.hypot(one["real"], one["imaginary"])
            yield (
                ("invariants", number, part),
                "{} {}".format(one["name"], part),
                one["error"] + one["input"],
                size,
            )


@pytest.mark.parametrize("kind", ["objects", "flat"])
def test_numbers_may_differ_by_both_bounds_and_the_tolerance(kind):
    if kind == "objects":
        add_box("Box", (1.0, 2.0, 3.0)).rotation_euler = (0.3, 0.4, 0.5)
        first = document("--order", "2", "--surface-moments")
        numbers = [*numbers_of_body(first["objects"][0])]
    else:
        sheet([(0, 0), (3, 0), (2, 2), (0, 1)], "Box", location=(1, 2, 3), rotation=(0.3, 0.4, 0.5))
        first = document("--flat", "--order", "3")
        numbers = [*numbers_of_flat(first["flat"][0])]
    label = "None: {}Box".format("flat " if kind == "flat" else "")
    assert not differences([first], [first], 0.0, False)[1]
    for path, name, bound, size in numbers:
        for tolerance in (0.0, 1e-3):
            allowed = tolerance * size + 2.0 * bound
            for share in (-1.02, -0.98, 0.98, 1.02):
                second = copy.deepcopy(first)
                place = second[kind][0]
                for key in path[:-1]:
                    place = place[key]
                value = place[path[-1]]
                place[path[-1]] = other = value + share * allowed
                if abs(other - value - share * allowed) > 0.01 * allowed:
                    continue  # it is less than rounding
                lines, failed = differences([first], [second], tolerance, False)
                assert failed == (abs(share) > 1.0), (name, tolerance, share, lines)
                (line,) = [line for line in lines[:-1] if "{}: {} ".format(label, name) in line]
                assert float(line.rpartition(" ")[2]) == pytest.approx(allowed, rel=0.02)


def test_numbers_without_bounds_may_not_differ():
    add_box("Box")
    first = document("--order", "2")
    entry = first["objects"][0]
    bounds = entry["error_bound"]
    unknown = dict.fromkeys(bounds)
    for part in ("error", "input"):
        entry["moments"][part]["volume"]["2,0,0"] = None
    for entry["error_bound"] in (
        None,
        unknown,
        {**unknown, "input": dict.fromkeys(bounds["input"])},
    ):
        for place in ("volume", "area", "mass", "principal_moments", "moments"):
            second = copy.deepcopy(first)
            found = second["objects"][0]
            if place == "principal_moments":
                found[place][2] *= 1.0 + 1e-9
            elif place == "moments":
                found[place]["volume"]["2,0,0"] *= 1.0 + 1e-9
            else:
                found[place] *= 1.0 + 1e-9
            assert differences([first], [second], 1e-10, False)[1], place
            assert not differences([first], [second], 1e-8, False)[1], place
