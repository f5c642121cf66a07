# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""An error that nobody foresaw ends the work on one object of many, is reported as what it is, and
leaves nothing half done.
"""

import os
from dataclasses import replace
from pathlib import Path

import body_moments
import bpy
import pytest
from body_moments.blender.bodies import measure_body, measure_object
from body_moments.blender.read import objects
from body_moments.blender.scene import empties, reframe
from body_moments.blender.session.stored import outcome
from body_moments.blender.write import properties, section
from body_moments.operators import batch
from body_moments.operators.measure.measure_selected import OBJECT_OT_body_moments_measure

from tests.blender import batch_files as files
from tests.blender.objects import add, mesh_body, only, place
from tests.blender.operator_calls import OPERATORS as UNKEYED
from tests.operators.modal_runs import finished, pressed

pytestmark = pytest.mark.usefixtures("registered", "scene")

ERRORS = [TypeError("planted"), RecursionError("planted"), NotImplementedError("planted")]
OPERATORS = {
    **{name: run for name, run in UNKEYED.items() if name not in ("clear", "balance", "setting")},
    "section": lambda: bpy.ops.object.body_moments_measure_section(),
}


@pytest.fixture(autouse=True)
def in_steps(monkeypatch):
    monkeypatch.setattr(OBJECT_OT_body_moments_measure, "MAX_AT_ONCE", 0)


def three(flat=False):
    """Three selected objects, the first active, each turned in another way."""
    bodies = []
    for place_, name in enumerate("abc"):
        mesh = mesh_body()
        if flat:
            mesh.clear_geometry()
            mesh.from_pydata([(0, 0, 0), (2, 0, 0), (0, 1, 0)], [], [(0, 1, 2)])
        bodies.append(add(mesh, name, (5.0 * place_, 0, 0), (0.1 * place_ + 0.1, 0.2, 0.3)))
    only(*bodies)
    return bodies


def plant(monkeypatch, error, *names, module=objects, function="read_object"):
    """The error, wherever one of these objects is read, by itself or together with others."""
    for place_, name in ((module, function), (measure_object, "plain_mesh")):
        monkeypatch.setattr(place_, name, failing_for(names, error, getattr(place_, name)))


def failing_for(names, error, real):
    def failing(obj, *args, **options):
        if obj.name in names:
            raise error
        return real(obj, *args, **options)

    return failing


def state(obj):
    """All that an operator may change of an object."""
    kept = {
        key: repr(getattr(obj[key], "to_list", lambda key=key: obj[key])())
        for key in properties.DESCRIPTIONS
        if key in obj
    }
    points = [tuple(vertex.co) for vertex in obj.data.vertices]
    found = repr(section.stored(obj)), obj.is_property_set("body_moments_symmetry")
    return kept, found, place(obj).tolist(), points, obj.rigid_body, obj.parent


@pytest.mark.parametrize("error", ERRORS, ids=lambda error: type(error).__name__)
@pytest.mark.parametrize("name", OPERATORS)
def test_the_error_of_one_object_ends_no_other(name, error, monkeypatch, reported, capfd):
    bodies = three(flat=name == "section")
    before = [state(body) for body in bodies]
    if name == "section":
        plant(monkeypatch, error, "b", module=body_moments.blender.bodies, function="section_of")
    else:
        plant(monkeypatch, error, "b")
    assert OPERATORS[name]() == {"FINISHED"}
    out, err = capfd.readouterr()
    assert {finding.values["object"] for finding in reported if finding.code == "failure"} == {"b"}
    cause = reported.values("internal_error")
    assert (cause["type"], cause["error"]) == (type(error).__name__, "planted")
    assert "b: Internal error: {type}: planted ({where}). Please report it.".format(**cause) in out
    file, _, line = cause["where"].partition(":")  # what has called the planted function
    assert (
        (Path(body_moments.__file__).parent / file).is_file()
        and int(line) > 0
        and not file.startswith("tests/")
    )
    assert "Traceback" in err and "in failing" in err
    after = [state(body) for body in bodies]
    assert after[1] == before[1]
    if name not in {"cursor", "similar", "empty"}:
        assert after[2] != before[2] and (name == "match" or after[0] != before[0])
    if name == "empty":
        assert {
            one[empties.OBJECT_KEY].name for one in bpy.data.objects if empties.OBJECT_KEY in one
        } == {"a", "c"}


def test_internal_error_is_kept_for_the_panel(monkeypatch):
    bodies = three()
    with monkeypatch.context() as planted:
        plant(planted, TypeError("several\nlines. "), "a", "b")
        operator, window = pressed(OBJECT_OT_body_moments_measure)
        assert finished(operator, window) == {"FINISHED"}
    (group,) = outcome.last().groups
    assert group.objects == ("a", "b") and group.finding.code == "internal_error"
    assert group.finding.values["error"] == "several lines"
    assert [properties.is_stored(body) for body in bodies] == [False, False, True]
    ((kind, text),) = operator.reports
    assert kind == "WARNING" and text.startswith(
        "Measured 1 of 3 objects. a: Internal error: TypeError"
    )
    assert finished(*pressed(OBJECT_OT_body_moments_measure)) == {"FINISHED"}
    assert outcome.last() is None


def unwritable(monkeypatch, *names):
    """Measurements of these objects of which Blender takes a part only: what comes before the
    fingerprint.
    """
    real = measure_body.measure_body

    def damaged(obj, *args):
        measured = real(obj, *args)
        if obj.name not in names:
            return measured
        return replace(measured, measurement=replace(measured.measurement, fingerprint=object()))

    monkeypatch.setattr(measure_body, "measure_body", damaged)
    monkeypatch.setattr(measure_object, "plain_mesh", lambda *_: None)


@pytest.mark.parametrize("stored", [False, True])
def test_failed_write_restores_previous_results(stored, monkeypatch):
    bodies = three()
    if stored:
        bpy.ops.object.body_moments_measure()
    for body in bodies:
        body.body_moments.density = 500.0
    before = state(bodies[1])
    unwritable(monkeypatch, "b")
    operator, window = pressed(OBJECT_OT_body_moments_measure)
    assert finished(operator, window) == {"FINISHED"}
    assert "b: Internal error: TypeError" in operator.reports[0][1]
    assert state(bodies[1]) == before
    assert [bodies[i]["body_density"] for i in (0, 2)] == [500.0, 500.0]


@pytest.mark.parametrize("name", ["align", "match", "origin", "axes"])
def test_moved_object_is_restored_after_internal_error(name, monkeypatch):
    bodies = three()
    before = state(bodies[1])
    real, seen = reframe.shape, []

    def failing(obj, *args):
        seen.append(obj.name)
        # looked at again, to see whether its shape is the same
        if obj.name == "b" and seen.count("b") % 2 == 0:
            raise TypeError("planted")
        return real(obj, *args)

    monkeypatch.setattr(reframe, "shape", failing)
    # which reframes them together
    monkeypatch.setattr(reframe, "reframe_own_meshes", lambda *_: [])
    assert OPERATORS[name]() == {"FINISHED"}
    assert seen.count("b") >= 2 and state(bodies[1]) == before


def test_the_command_line_goes_on_tells_it_and_exits_with_70(tmp_path, monkeypatch, capfd):
    three()
    path = files.save(tmp_path / "part.blend")
    result = tmp_path / "result.json"
    plant(monkeypatch, RecursionError("planted"), "b")
    line = files.run(path)
    (found,) = line.documents
    assert [one["name"] for one in found["objects"]] == ["a", "c"]
    (error,) = found["errors"]
    assert error["name"] == "b" and error["reason"].startswith(
        "Internal error: RecursionError: planted ("
    )
    assert "Traceback" in capfd.readouterr().err
    with open(os.devnull, "w") as nowhere:
        assert (
            batch.main(
                files.in_process("measure", path, "--output", result), channel=nowhere.fileno()
            )
            == 70
        )
    assert result.read_text().count("Internal error") == 1
