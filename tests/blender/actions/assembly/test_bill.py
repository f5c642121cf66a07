# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The bill of masses, column by column: levels, what counts, shares, densities, findings, where a mass is given and
below it; and assemblies that cannot hold results."""

import csv

import bpy
import pytest
from body_moments.operators.actions.assembly import assembly

from tests.blender.actions.test_refusals import linked_assembly
from tests.blender.bodies.test_assembly import box, empty
from tests.blender.objects import add, strip_mesh

pytestmark = pytest.mark.usefixtures("scene")


def collection(name, above, mass=None):
    made = bpy.data.collections.new(name)
    above.children.link(made)
    if mass is not None:
        made.body_moments.mass_from, made.body_moments.mass = "MASS", mass
    return made


@pytest.fixture
def rows(tmp_path):
    """Of a whole with a body, and with an assembly of given mass that holds another assembly; by name."""
    whole = collection("Whole", bpy.context.scene.collection)
    given = collection("Given", whole, 500.0)
    inner = collection("Inner", given)
    free = box(whole, (1, 2, 3), name="Free")
    free.data.polygons[0].flip()
    free.data.update()
    box(given, (1, 1, 1), name="In Given")
    box(inner, (1, 1, 2), (4, 0, 0), name="In Inner")
    strip = add(strip_mesh(), "Strip", select=False)
    bpy.context.scene.collection.objects.unlink(strip)
    whole.objects.link(strip)
    strip.body_moments.kind, strip.body_moments.thickness = "SHELL", 0.01
    layer = bpy.context.view_layer
    layer.active_layer_collection = layer.layer_collection.children["Whole"]
    layer.update()
    return exported(tmp_path)


def exported(folder):
    """The rows of the bill of the active collection, by name."""
    path = folder / "bill.csv"
    assert bpy.ops.object.body_moments_export_bill(filepath=str(path)) == {"FINISHED"}
    with path.open(encoding="utf-8", newline="") as file:
        return {row["name"]: row for row in csv.DictReader(file)}


def test_each_row_is_at_its_level_and_counts_where_no_mass_above_it_is_given(rows):
    assert {name: (int(row["level"]), row["counted"]) for name, row in rows.items()} == {
        "Whole": (0, "true"), "Given": (1, "true"), "Inner": (2, "false"), "In Inner": (3, "false"),
        "In Given": (2, "false"), "Free": (1, "true"), "Strip": (1, "true"),
    }  # fmt: skip
    assert {name: row["type"] for name, row in rows.items() if row["type"] != "object"} == dict.fromkeys(
        ("Whole", "Given", "Inner"), "collection"
    )


def test_shares_and_densities_are_those_of_what_counts(rows):
    masses = {name: float(row["mass"]) for name, row in rows.items()}
    total = 6000.0 + 500.0 + masses["Strip"]
    assert masses["Whole"] == pytest.approx(total) and masses["Given"] == 500.0
    counted = ("Whole", "Given", "Free", "Strip")
    assert {name: float(row["share"]) for name, row in rows.items() if row["share"]} == pytest.approx(
        {name: masses[name] / total for name in counted}
    )
    volumes = {"Free": 6.0, "In Given": 1.0, "In Inner": 2.0, "Inner": 2.0, "Given": 3.0}
    for name, volume in volumes.items():
        assert float(rows[name]["volume"]) == pytest.approx(volume)
        assert float(rows[name]["density"]) == pytest.approx(masses[name] / volume)
    assert float(rows["Free"]["area"]) == pytest.approx(22.0)


def test_what_has_no_volume_has_no_density(tmp_path):
    whole = collection("Whole", bpy.context.scene.collection)
    box(whole, (1, 2, 3), name="Box")
    empty(whole, "Point", (1, 2, 3), mass=5.0)
    layer = bpy.context.view_layer
    layer.active_layer_collection = layer.layer_collection.children["Whole"]
    layer.update()
    rows = exported(tmp_path)
    assert (rows["Point"]["mass"], rows["Point"]["volume"], rows["Point"]["density"]) == ("5.0", "0.0", "")
    assert float(rows["Point"]["share"]) == pytest.approx(5.0 / 6005.0, abs=0.0)


def test_each_row_has_its_own_findings_and_method(rows):
    assert {name: row["method"] for name, row in rows.items()} == {
        "Whole": "", "Given": "", "Inner": "", "Free": "reoriented", "In Given": "exact", "In Inner": "exact",
        "Strip": "shell",
    }  # fmt: skip
    notes = {name: row["notes"] + row["warnings"] for name, row in rows.items()}
    assert notes["Given"] == "The mass of the assembly is given: 500 kg." and "lipped face" in notes["Free"]
    assert not any(notes[name] for name in ("Inner", "In Inner", "In Given", "Strip"))
    assert not any(row["left_out"] for row in rows.values())


def test_an_assembly_that_cannot_hold_results_is_not_measured_first(monkeypatch, reported):
    linked_assembly()
    asked = []
    monkeypatch.setattr(assembly, "measure_members", lambda *words: asked.append(words) or iter(()))
    with pytest.raises(RuntimeError, match=r"\A.+\n?\Z"):
        bpy.ops.object.body_moments_measure_assembly()
    assert reported.codes == ["refused", "linked_results"] and not asked
