# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""STEP files written by OpenCascade (`tools/make_step.py`), against closed forms and its own mass
properties, and damaged copies of them.
"""

import json
import re
import tarfile
from pathlib import Path

import numpy as np
import pytest
from body_moments.core.cad import read_surfaces, step
from body_moments.core.cad.part21 import Part21
from body_moments.core.cad.step_shapes import Shapes
from body_moments.core.moments import sum_moments
from body_moments.core.numerics import SplineSpace
from body_moments.core.nurbs import Curve, measure_patches
from body_moments.core.nurbs.patch_topology import find_topology
from body_moments.core.verdict import FileError

GPROP_RTOL = 4e-10
PI = np.pi
ANGLES = (np.arange(200) + 0.5) * PI / 200.0  # Gauss and Chebyshev's rule on a disk of radius 3
HALF, WEIGHT = 3.0 * np.cos(ANGLES), 9.0 * PI / 200.0 * np.sin(ANGLES) ** 2
SECTION = 2239.310204308137 / 12.0  # by Gauss' rule on each span of the outline; GProp is 1 % off
EXACT = {
    "cylinder": 500.0 * PI,
    "cone": 520.0 / 3.0 * PI,
    "apex": 120.0 * PI,
    "sphere": 500.0 / 3.0 * PI,
    "torus": 180.0 * PI**2,
    "tube": 3600.0 * PI,
    "wedge": 325.0,
    "drilled": 8000.0 - 320.0 * PI,
    "cross": 3600.0 * PI
    - 4.0 * (WEIGHT * (np.sqrt(100.0 - HALF**2) - np.sqrt(25.0 - HALF**2))).sum(),
    "fillets": 5168.0 + 192.0 * PI + 32.0 / 3.0 * PI,
    "chamfers": 16688.0 / 3.0,
    "rim": PI * (491.0 + 2.0 / 3.0 + 2.0 * PI),
    "bead": 4.0 / 3.0 * PI * 21.0**1.5,
    "cap": 108.0 * PI,
    "half_torus": 90.0 * PI**2,
    "slant": 250.0 * PI,
    "steinmetz": 2000.0 / 3.0,
    "tee": 930.0 * PI - 2.0 * (WEIGHT * np.sqrt(25.0 - HALF**2)).sum(),
    "frustum": 1350.0,
    "twisted": 516.0,
    "open_box": 1464.0,
    "cup": 349.0 * PI,
    "prism": 12.0 * SECTION,
    "leaning": 12.0 * SECTION,
    "drilled_prism": 12.0 * SECTION - 48.0 * PI,
    "turned": 201.0,
    "hyperboloid": 48.0,
    "hyperboloid_back": 48.0,
    "lune": 2000.0 / 3.0 * 0.05,
    "broad_lune": 2000.0 / 3.0 * 6.25,
    "cavity": 8000.0 - 288.0 * PI,
    "plate": 19500.0 - 288.0 * PI,
    "bolt": 480.0 * np.sqrt(3.0) + 320.0 * PI,
}
with tarfile.open(Path(__file__).parent / "kernel" / "step.tar.xz") as archive:
    TEXTS = {Path(one.name).stem: archive.extractfile(one).read().decode() for one in archive}
GPROP = json.loads(TEXTS.pop("volumes"))


def read(tmp_path, text):
    path = tmp_path / "part.step"
    path.write_text(text)
    return read_surfaces(path, for_blender=False)


@pytest.mark.parametrize("name", TEXTS)
def test_step_part_of_a_kernel_is_within_its_bound(tmp_path, name):
    file = read(tmp_path, TEXTS[name])
    assert file.refused == ()
    bodies = [measure_patches(one.patches, stored=one.rounding) for one in file.bodies]
    assert {str(body.method) for body in bodies} == {"exact"}
    assert {one.code for body in bodies for one in body.findings} <= {"cavities_subtracted"}
    volume = sum_moments([body.volume for body in bodies])
    scale = file.unit * 1e3
    error = scale**3 * (volume.rounding_error + volume.input_error)[0]
    truth, center = GPROP[name]
    slack = 0.0 if name in EXACT else GPROP_RTOL * truth
    truth = EXACT.get(name, truth)
    assert abs(scale**3 * volume.total - truth) <= error + slack
    assert error <= 1e-9 * truth
    if "prism" not in name and name != "leaning":
        assert np.abs(scale * volume.center - center).max() <= 1e-5  # GProp is so far off the axis


@pytest.mark.parametrize("name", ["cross", "torus", "fillets"])
def test_step_placement_without_direction_measures_the_same(tmp_path, name):
    placement = r"(AXIS2_PLACEMENT_3D\('',#\d+,#\d+),#\d+"
    text, count = re.subn(placement, r"\1,$", TEXTS[name])
    (body,) = read(tmp_path, text).bodies
    measure = measure_patches(body.patches, stored=body.rounding)
    assert count and str(measure.method) == "exact"
    assert measure.volume.total == pytest.approx(EXACT[name], rel=1e-9)


def test_assemblies_without_bodies_are_limited(tmp_path, monkeypatch):
    monkeypatch.setattr(step, "MAX_PLACED", 200)
    text = TEXTS["cylinder"]
    context = re.search(r"SHAPE_REPRESENTATION\('',\(#11,#15\),(#\d+)", text)[1]
    relation = (
        "#{}=(REPRESENTATION_RELATIONSHIP('','',#{},#{})SHAPE_REPRESENTATION_RELATIONSHIP()"
        "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#90001));"
    )
    more = "#90001=ITEM_DEFINED_TRANSFORMATION('','',#11,#11);"
    for k in range(91000, 91080, 10):
        more += "#{}=SHAPE_REPRESENTATION('',(#11),{});".format(k, context)
        more += "".join(relation.format(k + use, k, k + 10) for use in (1, 2))
    more += "#91080=SHAPE_REPRESENTATION('',(#11),{});ENDSEC;".format(context)
    with pytest.raises(FileError, match="200"):
        read(tmp_path, more.join(text.rsplit("ENDSEC;", 1)))


def with_edges(text, kind, entity):
    """Return a text whose edges of a kind of curve are on another entity, from vertex a to b."""
    curves = set(re.findall(r"#(\d+) = {}\(".format(kind), text))
    bases = dict(re.findall(r"#(\d+) = (?:SURFACE|SEAM)_CURVE\('',#(\d+)", text))
    points = dict(re.findall(r"#(\d+) = VERTEX_POINT\('',#(\d+)\)", text))
    more = []

    def replaced(match):
        first, last, curve = match.groups()
        if bases[curve] not in curves:
            return match[0]
        number = "9{:03}".format(len(more))
        ends = {"a": points[first], "b": points[last], "curve": bases[curve]}
        more.append("#{}={};\n".format(number, entity.format(n=number, **ends)))
        return "EDGE_CURVE('',#{},#{},#{}".format(first, last, number)

    text = re.sub(r"EDGE_CURVE\('',#(\d+),#(\d+),#(\d+)", replaced, text)
    assert more
    return "".join([*more, "ENDSEC;"]).join(text.rsplit("ENDSEC;", 1))


OPEN = ".UNSPECIFIED.,.F.,.F."
TRIMMED = (
    "COMPOSITE_CURVE('',(#{n}1),.F.);#{n}1=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.F.,#{n}2);"
    "#{n}2=TRIMMED_CURVE('',#{curve},"
)
EDGES = {
    "polyline": ("LINE", "POLYLINE('',(#{a},#{b}))"),
    "uniform curve": ("LINE", "UNIFORM_CURVE('',1,(#{a},#{b})," + OPEN + ")"),
    "part by points": ("LINE", TRIMMED + "(#{b}),(#{a}),.F.,.CARTESIAN.)"),
    "part by angles": (
        "CIRCLE",
        TRIMMED + "(PARAMETER_VALUE(1.3)),(PARAMETER_VALUE(0.)),.F.,.PARAMETER.)",
    ),
}
CURVE = r"B_SPLINE_CURVE_WITH_KNOTS(\('',8,[^;]*?),\(9,\s*9\)[^;]*;"
SURFACE = r"B_SPLINE_SURFACE_WITH_KNOTS(\('',1,1,[^;]*?),\(2,\s*2\)[^;]*;"
NET = r"B_SPLINE_SURFACE_WITH_KNOTS\([^;]*?_KNOTS\.\)"
OFFSET = r"#\1 = OFFSET_SURFACE('',#99\1,{},.F.);#99\1 = \g<2>{}"
ENTITIES = {
    "far side of a cone": (
        "cone",
        r"CONICAL_SURFACE\('',#\d+,6\.,(.*?;)",
        r"CONICAL_SURFACE('',#9001,0.8,\1#9001=AXIS2_PLACEMENT_3D('',#9002,$,$);"
        r"#9002=CARTESIAN_POINT('',(0.,0.,17.));",
    ),
    "offset cylinder": ("drilled", r"#(\d+) = (CYL.*_SURFACE\('',#\d+,)4\.", ("1.", "3.")),
    "offset cone": ("cone", r"#(\d+) = (CON.*_SURFACE\('',#\d+,)6\.", ("1.", "4.9229670385731")),
    "offset sphere": ("sphere", r"#(\d+) = (SPH.*_SURFACE\('',#\d+,)5\.", ("-2.", "7.")),
    "offset torus": ("torus", r"#(\d+) = (TOR.*_SURFACE\('',#\d+,10\.,)3\.", ("1.", "2.")),
    "offset plane": ("wedge", r"#(\d+) = (PLANE\('',#\d+)", ("0.", "")),
    "Bézier curve": ("steinmetz", CURVE, r"BEZIER_CURVE\1);"),
    "quasi-uniform curve": ("steinmetz", CURVE, r"QUASI_UNIFORM_CURVE\1);"),
    "uniform surface": ("twisted", SURFACE, r"UNIFORM_SURFACE\1);"),
    "Bézier surface": ("twisted", SURFACE, r"BEZIER_SURFACE\1);"),
    "quasi-uniform surface": ("twisted", SURFACE, r"QUASI_UNIFORM_SURFACE\1);"),
    "rational Bézier surface": ("loft", NET, "BEZIER_SURFACE()"),
    "ends off their curve": ("wedge", r"(CIRCLE\('',#\d+,)5\.", r"\g<1>5.003"),
}


@pytest.mark.parametrize("kind", [*EDGES, *ENTITIES])
def test_step_part_with_another_entity_measures_the_same(tmp_path, kind):
    if kind in EDGES:
        name, text = "wedge", with_edges(TEXTS["wedge"], *EDGES[kind])
    else:
        name, pattern, better = ENTITIES[kind]
        better = OFFSET.format(*better) if kind.startswith("offset") else better
        text, count = re.subn(pattern, better, TEXTS[name])
        assert count
    file = read(tmp_path, text)
    (body,) = file.bodies
    measure = measure_patches(body.patches, stored=body.rounding)
    assert file.refused == () and str(measure.method) == "exact"
    truth = EXACT.get(name, GPROP[name][0])
    error = (measure.volume.rounding_error + measure.volume.input_error)[0]
    assert abs(measure.volume.total - truth) <= error + 1e-9 * truth
    assert error <= 1e-9 * truth or kind == "ends off their curve"


def test_bound_covers_both_readings_of_edges_beside_a_surface(tmp_path):
    text, count = re.subn(r"(CYLINDRICAL_SURFACE\('',#\d+,)5\.", r"\g<1>5.001", TEXTS["cylinder"])
    (body,) = read(tmp_path, text).bodies
    volume = measure_patches(body.patches, stored=body.rounding).volume
    bound = (volume.rounding_error + volume.input_error)[0]
    assert count == 1 and bound < 2e-3 * volume.total
    for radius in (5.0, 5.001):
        assert abs(volume.total - 20.0 * PI * radius**2) <= bound


def test_torus_across_its_axis_is_the_part_that_the_file_names(tmp_path):
    sphere = r"SPHERICAL_SURFACE\('',(#\d+),5\.\)"
    torus = r"DEGENERATE_TOROIDAL_SURFACE('',\1,2.,{},.{}.)"
    offset = r"OFFSET_SURFACE('',#9901,0.5,.F.);#9901="
    for way, radius, base in (  # the outer part, and the inner one, which faces inward
        ("T", 2.0, torus.format("3.", "T")),
        ("F", -2.0, torus.format("3.", "F")),
        ("F", -2.0, offset + torus.format("3.5", "F")),
    ):
        text = re.sub(sphere, base, TEXTS["sphere"])
        text = re.sub(r"(ADVANCED_FACE.*)\.T\.", r"\1.{}.".format(way), text)
        (body,) = read(tmp_path, text).bodies
        measure = measure_patches(body.patches, stored=body.rounding)
        angle = np.arccos(-radius / 3.0)
        sine = np.sin(angle)
        arms = radius**2 * sine + 3.0 * radius * (angle + sine * np.cos(angle))
        truth = 6.0 * PI * (arms + 9.0 * (sine - sine**3 / 3.0))
        assert str(measure.method) == "exact"
        assert measure.volume.total == pytest.approx(truth, rel=1e-9)
    with pytest.raises(FileError, match="crosses its axis"):
        read(tmp_path, re.sub(sphere, r"TOROIDAL_SURFACE('',\1,2.,3.)", TEXTS["sphere"]))


@pytest.mark.parametrize(
    "kind, knots",
    [
        ("UNIFORM", range(-3, 8)),
        ("QUASI_UNIFORM", [0, 0, 0, *range(5), 4, 4, 4]),
        ("BEZIER", [0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 2]),
    ],
)
def test_step_spline_without_knots_has_those_of_its_kind(kind, knots):
    points = np.random.default_rng(1).uniform(size=(7, 3))
    lines = [
        "#{}=CARTESIAN_POINT('',{});".format(k + 1, tuple(p)) for k, p in enumerate(points.tolist())
    ]
    lines.append("#9={}_CURVE('',3,(#1,#2,#3,#4,#5,#6,#7),{});".format(kind, OPEN))
    text = "ISO-10303-21;DATA;{}ENDSEC;END-ISO-10303-21;".format("".join(lines))
    (curve,) = Shapes(Part21(text.encode())).curve(9, None)
    known = Curve(SplineSpace(tuple(map(float, knots)), 4, 7), points)
    assert np.abs(curve.uniform(20) - known.uniform(20)).max() <= 1e-15


def test_hundreds_of_rims_are_joined(tmp_path):
    (plate,) = read(tmp_path, TEXTS["plate"]).bodies
    faces = []
    for k in range(18):
        matrix = np.eye(4)
        matrix[2, 3] = 9.0 * k
        faces += [face.transform(matrix) for face in plate.patches]
    topology = find_topology(faces, 1e-6)
    assert topology.number == 18 and topology.open_sides == 0


@pytest.mark.parametrize("name, unit", [("mm", 1e-3), ("inch", 0.0254), ("m", 1.0)])
def test_step_assembly_has_names_colors_and_unit(tmp_path, name, unit):
    file = read(tmp_path, TEXTS["assembly_" + name])
    assert file.unit == pytest.approx(unit, rel=1e-15)
    assert [one.name for one in file.bodies] == ["Plätte", *["Bolt"] * 4]
    assert file.bodies[0].color is None
    # sRGB of the linear color that OpenCascade was given.
    assert file.bodies[1].color == pytest.approx((0.906332, 0.349190, 0.484529), abs=1e-6)


def number_of(text, entity):
    return re.search(r"#(\d+) = " + entity, text)[1]


def test_representation_of_a_shape_aspect_is_no_second_body(tmp_path):
    text = TEXTS["assembly_mm"]
    solid, context = re.search(
        r"ADVANCED_BREP_SHAPE_REPRESENTATION\('[^']*',\(#\d+,(#\d+)\),(#\d+)\)", text
    ).groups()
    more = (
        "#99990 = SHAPE_ASPECT('','',#{},.F.);\n#99991 = PROPERTY_DEFINITION('','',#99990);\n"
        "#99992 = SHAPE_REPRESENTATION('',({}),{});\n"
        "#99993 = SHAPE_DEFINITION_REPRESENTATION(#99991,#99992);\nENDSEC;"
    ).format(number_of(text, "PRODUCT_DEFINITION_SHAPE"), solid, context)
    file = read(tmp_path, more.join(text.rsplit("ENDSEC;", 1)))
    assert [one.name for one in file.bodies] == ["Plätte", *["Bolt"] * 4] and file.refused == ()


def test_hidden_step_solid_is_left_out_with_a_note(tmp_path):
    text = TEXTS["assembly_mm"]
    hide = "#99999 = INVISIBILITY((#{}));\nENDSEC;".format(number_of(text, "STYLED_ITEM"))
    file = read(tmp_path, hide.join(text.rsplit("ENDSEC;", 1)))
    assert [one.name for one in file.bodies] == ["Plätte"]
    assert [(one.code, one.values["count"]) for one in file.notes] == [("surfaces_hidden", 4)]


SWAPS = {
    "end": (r"(#\d+ = ADVANCED_FACE.*?#\d+ = ADVANCED_FACE[^;]*;).*", r"\1", "ADVANCED_FACE"),
    "unit": (r"\.MILLI\.,\.METRE\.", ".MILLI.,.CUBIT.", "CONTEXT"),
    "misses": (r"(CYLINDRICAL_SURFACE\('',#\d+,)4\.", r"\g<1>4.3", "ADVANCED_FACE"),
    "ends": (r"(CIRCLE\('',#\d+,)4\.", r"\g<1>4.3", "EDGE_CURVE"),
    "close": (r"(EDGE_LOOP\('',\(#\d+),#\d+", r"\1", "EDGE_LOOP"),
    "face that is missing": (r"(CLOSED_SHELL\('',\(#\d+),#\d+", r"\1", "CLOSED_SHELL"),
    "not in the file": (r"(CYLINDRICAL_SURFACE\('',)#\d+", r"\1#999999", "ADVANCED_FACE"),
    "numbers": (r"(CYLINDRICAL_SURFACE\('',#\d+,)4\.", r"\g<1>-4.", "ADVANCED_FACE"),
    "possible": (r"CYLINDRICAL_SURFACE\(", "CYLINDRICAL_SURFACE" + "(" * 90, "ADVANCED_FACE"),
    "BOUNDED_SURFACE": (r"CYLINDRICAL_SURFACE", "BOUNDED_SURFACE", "ADVANCED_FACE"),
    "crosses the axis": (
        r"(SURFACE_OF_REVOLUTION.*?AXIS1_PLACEMENT.*?POINT\('',\()0\.",
        r"\g<1>12.",
        "ADVANCED_FACE",
    ),
    "inside out": (ENTITIES["offset cylinder"][1], OFFSET.format("-7.", "3."), "ADVANCED_FACE"),
}


@pytest.mark.parametrize("fault", SWAPS)
def test_damaged_step_solid_is_refused_in_one_sentence(tmp_path, fault):
    pattern, better, entity = SWAPS[fault]
    whole = TEXTS["vase" if "axis" in fault else "drilled"]
    text, count = re.subn(pattern, better, whole, count=1, flags=re.DOTALL)
    assert count == 1
    with pytest.raises(FileError) as error:
        read(tmp_path, text)
    (cause,) = error.value.finding.values["causes"]
    message = str(error.value)
    assert fault in message and entity in cause["values"]["kind"]
    (number, line) = re.search(r"#(\d+) \(line (\d+)\)", message).groups()
    assert "#{} = ".format(number) in text.splitlines()[int(line) - 1]


def test_right_solids_beside_damage_are_measured(tmp_path):
    whole = TEXTS["assembly_mm"]
    within = re.search(r"REPRESENTATION_RELATIONSHIP\('','',(#\d+),(#\d+)\)", whole)
    swapped = within[0].replace(within[2], within[1])
    for text, names, faults in (
        (whole.replace("CYLINDRICAL_SURFACE", "BOUNDED_SURFACE", 1), ["Plätte"], 1),
        (whole.replace(within[0], swapped), ["Bolt"] * 4 + ["Plätte"], 1),
        (
            re.sub(
                r"SHAPE_REPRESENTATION\('',\([^)]*\)(,#\d+\);)",
                r"\g<0>\n#9999999=SHAPE_REPRESENTATION('',$\1",
                whole,
                count=1,
            ),
            ["Bolt"] * 4 + ["Plätte"],
            1,
        ),
    ):
        file = read(tmp_path, text)
        assert sorted(one.name for one in file.bodies) == names
        assert len(file.refused) == faults and file.unread == 0


def test_other_items_are_refused_by_name_and_curves_noted(tmp_path):
    items = {
        91: "TESSELLATED_SOLID('',(),$)",
        92: "TESSELLATED_SOLID('',(),#15)",  # shows the solid
        93: "GEOMETRIC_SET('',(#94))",
        94: "CURVE_BOUNDED_SURFACE('',#31,(),.T.)",
        95: "GEOMETRIC_CURVE_SET('',(#25,#49))",
        96: "TESSELLATED_SOLID('',(),#31)",  # of an item that nothing places
    }
    lines = "".join("#9900{}={};".format(k, entity) for k, entity in items.items())
    lines = re.sub(r"#(9\d)\b", r"#9900\1", lines)
    more = ",".join("#9900{}".format(k) for k in items)
    text = TEXTS["cylinder"].replace("(#11,#15)", "(#11,#15,{})".format(more))
    file = read(tmp_path, (lines + "ENDSEC;").join(text.rsplit("ENDSEC;", 1)))
    assert len(file.bodies) == 1
    assert [(one.values["base"], one.values["count"]) for one in file.refused] == [
        ("TESSELLATED_SOLID", 2),
        ("GEOMETRIC_SET", 1),
        ("CURVE_BOUNDED_SURFACE", 1),
    ]
    assert [(one.code, one.values["count"]) for one in file.notes] == [("curves_left_out", 2)]


def test_part21_reads_strings_comments_and_types():
    text = Part21(
        b"ISO-10303-21;DATA;\n/* #1=A(); */ #2 = b('it''s; \\X2\\00E4\\X0\\ \\S\\d \\X\\E9',"
        b"$,*,.T.,.x.,(1,-2.5E-3),LENGTH_MEASURE(3.),#2);\n#3=(C()D(1));ENDSEC;END-ISO-10303-21;"
    )
    assert text.torn == 0 and text.named == {"B": [2], "C": [3], "D": [3]}
    measure = "LENGTH_MEASURE", [3.0]
    assert text[2] == {"B": ["it's; ä ä é", None, None, True, ".X.", [1, -2.5e-3], measure, 2]}
    assert text[3] == {"C": [], "D": [1]} and text.line(3) == 3
