# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""3MF files: units, components and transforms, and what a hostile one may not do."""

import contextlib
import json
import zipfile

import numpy as np
import pytest
from body_moments.core.files.limits import Limits
from body_moments.core.streams import threemf
from body_moments.core.verdict import FileError

from tests.blender.batch_files import CORNERS, FACES, document, measured, sentence
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")
CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
PRODUCTION = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06"
RELATIONS = (
    '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
    '<Relationship Id="r" Target="{}" '
    'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>'
)
MOVED = "1 0 0 0 1 0 0 0 1 10 20 30"
TURNED = "0 2 0 -2 0 0 0 0 2 0 0 0"  # x to y, twice as large


def mesh(corners=CORNERS, faces=FACES):
    points = "".join('<vertex x="{}" y="{}" z="{}"/>'.format(*corner) for corner in corners)
    triangles = "".join('<triangle v1="{}" v2="{}" v3="{}"/>'.format(*face) for face in faces)
    return "<mesh><vertices>{}</vertices><triangles>{}</triangles></mesh>".format(points, triangles)


def model(resources, build, attributes="", head=""):
    text = (
        '<?xml version="1.0"?>{}<model xmlns="{}" xmlns:p="{}" '
        "{}><resources>{}</resources><build>{}</build></model>"
    )
    return text.format(head, CORE, PRODUCTION, attributes, resources, build)


def package(path, text, more=(), root="/3D/part.model"):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("_rels/.rels", RELATIONS.format(root))
        archive.writestr(root.lstrip("/"), text)
        for name, data in more:
            archive.writestr(name, data)
    return path


ONE = '<object id="1" name="Tetra">{}</object>'.format(mesh())


@pytest.mark.parametrize("unit", [None, *threemf.UNITS])
def test_a_mesh_has_its_files_unit(tmp_path, unit):
    attributes = 'unit="{}"'.format(unit) if unit else ""
    scale = threemf.UNITS[unit or "millimeter"]
    entry = measured(
        package(tmp_path / "a.3mf", model(ONE, '<item objectid="1"/>', attributes)),
        "--density",
        "1",
    )
    assert entry["name"] == "Tetra" and entry["method"] == "exact"
    assert close(entry["volume"], scale**3, 1e-12)
    assert close(entry["center_of_mass"], np.array([0.25, 0.5, 0.75]) * scale, 1e-12)


def test_components_and_the_build_place_meshes(tmp_path):
    pair = (
        '<object id="2"><components><component objectid="1"/><component objectid="1" '
        'transform="{}"/></components>'
    )
    text = model(
        ONE + pair.format(TURNED) + "</object>",
        '<item objectid="2" transform="{}"/>'.format(MOVED),
        'unit="meter"',
    )
    found = document(package(tmp_path / "a.3mf", text), "--density", "1")
    first, second = found["objects"]
    assert close(found["total"]["volume"], 9.0, 1e-12)
    assert close(first["center_of_mass"], [10.25, 20.5, 30.75], 1e-12)
    assert close(
        second["center_of_mass"], [10.0 - 2.0 * 0.5, 20.0 + 2.0 * 0.25, 30.0 + 2.0 * 0.75], 1e-7
    )


def test_a_sheared_place_is_kept(tmp_path):
    item = '<item objectid="1" transform="1 0 0 0.5 1 0 0 0 1 0 0 0"/>'  # x grows by half of y
    entry = measured(package(tmp_path / "a.3mf", model(ONE, item, 'unit="meter"')))
    assert close(entry["volume"], 1.0, 1e-6) and close(
        entry["center_of_mass"], [0.5, 0.5, 0.75], 1e-6
    )


def test_objects_of_other_parts(tmp_path):
    other = model(ONE, "")
    text = model(
        "", '<item objectid="1" p:path="/3D/other.model"/>', 'unit="meter" requiredextensions="p"'
    )
    entry = measured(package(tmp_path / "a.3mf", text, [("3D/other.model", other)]))
    assert close(entry["volume"], 1.0, 1e-12)


BOMB = '<!DOCTYPE m [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;">]>'
ITEM = '<item objectid="1"/>'
WRONG = {
    "entities": model(ONE, ITEM, head=BOMB),
    "a circle": model(
        '<object id="1"><components><component objectid="1"/></components></object>', ITEM
    ),
    "no such object": model(ONE, '<item objectid="7"/>'),
    "nan": model(
        '<object id="1">{}</object>'.format(mesh(((0, 0, 0), ("nan", 0, 0), (0, 2, 0), (0, 0, 3)))),
        ITEM,
    ),
    "too large": model(
        '<object id="1">{}</object>'.format(mesh(((0, 0, 0), (1e39, 0, 0), (0, 2, 0)))), ITEM
    ),
    "no such vertex": model('<object id="1">{}</object>'.format(mesh(faces=((0, 1, 4),))), ITEM),
    "a negative vertex": model(
        '<object id="1">{}</object>'.format(mesh(faces=((0, 1, -1),))), ITEM
    ),
    "half a transform": model(ONE, '<item objectid="1" transform="1 0 0"/>'),
    "an infinite transform": model(ONE, '<item objectid="1" transform="inf{}"/>'.format(MOVED[1:])),
    "unit": model(ONE, ITEM, 'unit="parsec"'),
    "not xml": "<model",
    "words": model('<object id="1">{}</object>'.format(mesh((("a", 0, 0),))), ITEM),
    "beams": model(
        ONE,
        ITEM,
        'xmlns:b="http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02" '
        'requiredextensions="b"',
    ),
}


MICROSOFT = "http://schemas.microsoft.com/3dmanufacturing/"
EXTENSIONS = {
    MICROSOFT + "trianglesets/2021/07": ("", True),
    MICROSOFT + "slice/2015/07": ("", True),
    MICROSOFT + "slice/2015/07 lowres": ('x:meshresolution="lowres"', False),
    MICROSOFT + "production/alternatives/2021/04": ('x:modelresolution="fullres"', True),
    MICROSOFT + "production/alternatives/2021/04 obfuscated": (
        'x:modelresolution="obfuscated"',
        False,
    ),
    MICROSOFT + "securecontent/2019/04": ("", False),
    "http://schemas.3mf.io/3dmanufacturing/implicit/2023/12": ("", False),
}


@pytest.mark.parametrize("name", EXTENSIONS)
def test_required_extension_counts_by_its_effect_on_the_shape(tmp_path, name):
    attribute, is_read = EXTENSIONS[name]
    space = name.partition(" ")[0]
    attributes = 'unit="meter" xmlns:x="{}" requiredextensions="x"'.format(space)
    text = model(ONE.replace("<object", "<object " + attribute), ITEM, attributes)
    found = document(package(tmp_path / "a.3mf", text))
    if is_read:
        assert close(found["objects"][0]["volume"], 1.0, 1e-12)
    else:
        assert found["errors"][0]["reason"] == sentence("threemf_extension", name=space)


def test_unannounced_beams_are_refused(tmp_path):
    space = MICROSOFT + "beamlattice/2017/02"
    beams = '<b:beamlattice xmlns:b="{}"/></mesh>'.format(space)
    text = model(ONE.replace("</mesh>", beams), ITEM)
    found = document(package(tmp_path / "a.3mf", text))
    assert found["errors"][0]["reason"] == sentence("threemf_extension", name=space)


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_file_is_an_error_with_a_reason(tmp_path, name):
    found = document(package(tmp_path / "a.3mf", WRONG[name]))
    (error,) = found["errors"]
    assert found["objects"] == [] and "Internal" not in error["reason"]
    assert ("document type" if name == "entities" else "3mf") in error["reason"].lower()


@pytest.mark.parametrize("word", ["1_0", "٣", "1.0D0", "0x1", "--1", "", "1 2", "1,0", "INF"])
@pytest.mark.parametrize(
    "element, field",
    [("vertex", 'x="1"'), ("triangle", 'v2="1"'), ("item", MOVED), ("component", MOVED)],
)
def test_word_for_a_number_is_named_with_its_element(tmp_path, element, field, word):
    parts = '<object id="2"><components><component objectid="1" '
    parts += 'transform="{}"/></components></object>'.format(MOVED)
    text = model(ONE + "\n" + parts, '\n<item objectid="2" transform="{}"/>'.format(MOVED))
    at = text.index(field, text.index("<" + element + " ") if element != "vertex" else 0)
    wrong = (
        field[: field.rindex("1")] + word + field[field.rindex("1") + 1 :]
        if field != MOVED
        else word + field[1:]
    )
    path = package(tmp_path / "a.3mf", text[:at] + wrong + text[at + len(field) :])
    with pytest.raises(FileError) as caught:
        threemf.read_3mf(str(path))
    found = caught.value.finding
    line = {"vertex": 1, "triangle": 1, "component": 2, "item": 3}[element]
    assert (found.code, found.values["line"]) == ("line_misread", line)
    assert found.values["expected"] == "a value of a 3MF <{}>".format(element)
    assert word.split()[:1] == found.values["text"].split()[:1] or found.values["text"] == wrong


def test_numbers_of_xml_schema_are_read(tmp_path):
    corners = [
        (" 0 ", "+0", "-0.0"),
        ("+1.", "0e5", ".0"),
        ("0", "\t2E0\n", "0"),
        ("0", "0", "3.0e+00"),
    ]
    text = model('<object id="1">{}</object>'.format(mesh(corners)), ITEM)
    assert close(
        measured(package(tmp_path / "a.3mf", text), "--unit-scale", 1)["volume"], 1e-9, rel=1e-6
    )


def test_no_random_damage_is_our_fault(tmp_path):
    data = package(tmp_path / "a.3mf", model(ONE, ITEM)).read_bytes()
    chance = np.random.default_rng(1)
    for _ in range(150):
        damaged = bytearray(data)
        for place in chance.integers(len(damaged), size=3):
            damaged[place] = chance.integers(256)
        (tmp_path / "b.3mf").write_bytes(bytes(damaged[: chance.integers(1, len(damaged) + 1)]))
        with contextlib.suppress(FileError):
            threemf.read_3mf(str(tmp_path / "b.3mf"))


def test_limits_of_the_archive(tmp_path):
    path = package(
        tmp_path / "a.3mf", model(ONE, ITEM), [("x{}".format(number), "") for number in range(50)]
    )
    assert len(threemf.read_3mf(str(path))[0]) == 1
    for limits in (Limits(entries=20), Limits(unpacked_bytes=100)):
        with pytest.raises(FileError) as refused:
            threemf.read_3mf(str(path), limits)
        assert refused.value.finding.code == "file_exceeds_limit"
    wide = '<object id="{}"><components>{}</components></object>'
    many = "".join(
        wide.format(number, '<component objectid="{}"/>'.format(number - 1) * 10)
        for number in range(2, 12)
    )
    with pytest.raises(FileError) as refused:
        threemf.read_3mf(
            str(package(tmp_path / "b.3mf", model(ONE + many, '<item objectid="11"/>')))
        )
    assert refused.value.finding.code == "file_too_large"


def test_package_without_relations_has_its_model_in_place(tmp_path):
    foreign = (
        '<x:object xmlns:x="http://example.org/x" id="1"/><x:vertex xmlns:x="http://example.org/x" '
        'x="a"/>'
    )
    with zipfile.ZipFile(tmp_path / "a.3mf", "w") as archive:
        archive.writestr("3D/3dmodel.model", model(ONE + foreign, ITEM, 'unit="meter"'))
    assert close(measured(tmp_path / "a.3mf")["volume"], 1.0, 1e-12)


def test_items_that_are_no_printed_models_are_left_out(tmp_path):
    types = ["model", "support", "solidsupport", "surface", "other"]
    parts = [
        '<object id="{}" type="{}" name="{}">{}</object>'.format(9 + i, t, t, mesh())
        for i, t in enumerate(types)
    ]
    group = (
        '<object id="20" name="group"><components><component objectid="10"/></components></object>'
    )
    items = ['<item objectid="{}"/>'.format(9 + i) for i in range(len(types))]
    items += ['<item objectid="9" printable="0"/>', '<item objectid="20"/>']
    path = package(tmp_path / "a.3mf", model("".join([*parts, group]), "".join(items)))
    found = document(path)
    assert [entry["name"] for entry in found["objects"]] == ["model"]
    reasons = {entry["name"]: entry["reason"] for entry in found["left_out"]}
    causes = {kind: "its type is {}".format(kind) for kind in types[1:]}
    causes |= {"model.001": "it is not printed", "group": "its type is support"}
    assert reasons == {name: sentence("file_hides", cause=cause) for name, cause in causes.items()}
    assert len(document(path, "--all")["objects"]) == 7


def box(low, high):
    corners = [
        (x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])
    ]
    quads = (0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)
    return corners, [half for a, b, c, d in quads for half in ((a, b, c), (a, c, d))]


BLOCK = box((-20, -10, 0), (20, 10, 24))
CUTTER = box((-25, -15, 16), (25, 15, 40))
INSIDE = box((-5, -5, 5), (5, 5, 15))


def prusa(path, other, kind, settings="", project=""):
    corners = BLOCK[0] + other[0]
    faces = BLOCK[1] + [tuple(corner + 8 for corner in face) for face in other[1]]
    volume = (
        '<volume firstid="{}" lastid="{}"><metadata type="volume" key="name" value="{}"/>'
        '<metadata type="volume" key="volume_type" value="{}"/>{}</volume>'
    )
    volumes = volume.format(0, 11, "block", "ModelPart", settings)
    volumes += volume.format(12, 23, "other", kind, "")
    text = model('<object id="1">{}</object>'.format(mesh(corners, faces)), '<item objectid="1"/>')
    more = [("Metadata/Slic3r_PE_model.config", '<config><object id="1">{}</object></config>')]
    more = [(name, data.format(volumes)) for name, data in more]
    return package(path, text, [*more, ("Metadata/Slic3r_PE.config", project)])


def bambu(path, other, subtype, settings="", project="{}"):
    places = "".join(
        '<component p:path="/3D/parts.model" objectid="{}"/>'.format(number) for number in (1, 2)
    )
    parts = '<object id="1">{}</object><object id="2" type="other">{}</object>'
    config = '<part id="1" subtype="normal_part">{}</part><part id="2" subtype="{}"/>'
    config = config.format(settings, subtype)
    more = [
        ("3D/parts.model", model(parts.format(mesh(*BLOCK), mesh(*other)), "")),
        (
            "Metadata/model_settings.config",
            '<config><object id="3">{}</object></config>'.format(config),
        ),
        ("Metadata/project_settings.config", project),
    ]
    whole = '<object id="3"><components>{}</components></object>'.format(places)
    return package(path, model(whole, '<item objectid="3"/>'), more)


@pytest.mark.parametrize("write", [prusa, bambu])
@pytest.mark.parametrize("options", [[], ["--overlap", "union"]])
@pytest.mark.parametrize(
    ("other", "kinds", "volume"),
    [
        (CUTTER, ("NegativeVolume", "negative_part"), 12_800),
        (INSIDE, ("ParameterModifier", "modifier_part"), 19_200),
        (INSIDE, ("SupportBlocker", "support_blocker"), 19_200),
        (INSIDE, ("NegativeVolume", "negative_part"), 18_200),
    ],
)
def test_parts_of_slicer_projects_count_as_printed(tmp_path, write, options, other, kinds, volume):
    path = write(tmp_path / "project.3mf", other, kinds[write is bambu])
    found = document(path, *options)
    assert close(found["total"]["volume"], volume * 1e-9, 1e-6) and not found["errors"]
    assert [entry["name"] for entry in found["left_out"]] == [
        "other" if write is prusa else "Object 2"
    ]


@pytest.mark.parametrize("write", [prusa, bambu])
def test_negative_part_over_all_is_refused_by_name(tmp_path, write):
    kind = "NegativeVolume" if write is prusa else "negative_part"
    found = document(write(tmp_path / "a.3mf", box((-30,) * 3, (30,) * 3), kind))
    assert found["status"] == "error" and not found["objects"]
    name = "block" if write is prusa else "Object 1"
    assert "“{}”: they cover all".format(name) in found["errors"][0]["reason"]


def test_settings_of_slicer_project_become_those_of_the_print(tmp_path):
    project = "\n".join(
        "; {} = {}".format(*pair)
        for pair in {
            "fill_density": "20%",
            "perimeters": 3,
            "top_solid_layers": 5,
            "bottom_solid_layers": 4,
            "layer_height": 0.2,
            "external_perimeter_extrusion_width": 0.4,
            "perimeter_extrusion_width": 0.5,
            "filament_density": "1.24,1.27",
        }.items()
    )
    own = '<metadata type="volume" key="fill_density" value="40%"/>'
    own += '<metadata type="volume" key="extruder" value="2"/>'
    path = prusa(tmp_path / "a.3mf", INSIDE, "ModelPart", own, project)
    block, inside = document(path)["objects"]
    assert block["kind"] == inside["kind"] == "printed"
    assert (block["print"]["infill"], inside["print"]["infill"]) == (40.0, 20.0)
    core = (40 - 2.8) * (20 - 2.8) * (24 - 1.8) * 1e-9
    assert close(block["mass"], 1270.0 * (19_200e-9 - 0.6 * core), 1e-6)
    core = 7.2**2 * 8.2e-9
    assert close(inside["mass"], 1240.0 * (1000e-9 - 0.8 * core), 1e-6)
    solid = document(path, "--kind", "solid")["objects"][0]
    assert close(solid["mass"], 1270.0 * 19_200e-9, 1e-6)


BAMBU_SETTINGS = {
    "sparse_infill_density": "20%",
    "wall_loops": "3",
    "top_shell_layers": "5",
    "bottom_shell_layers": ["4"],
    "layer_height": "0.2",
    "filament_density": ["1.24", "1.27"],
}


@pytest.mark.parametrize(
    ("widths", "wall"),
    [  # Orca leaves a width of 0 to the nozzle, and may give it in percent of the nozzle
        ({"outer_wall_line_width": "0.4", "inner_wall_line_width": "0.5"}, 1.4),
        ({"outer_wall_line_width": "0", "inner_wall_line_width": "105%"}, 1.35),
    ],
    ids=["bambu", "orca"],
)
@pytest.mark.parametrize(
    ("own", "infill", "density", "walls"),
    [
        ({}, 20.0, 1240.0, 3),
        ({"sparse_infill_density": "40%", "extruder": "2"}, 40.0, 1270.0, 3),
        ({"wall_loops": "1"}, 20.0, 1240.0, 1),
        ({"wall_loops": "0"}, 20.0, 1240.0, 0),
    ],
)
def test_settings_of_bambu_and_orca_are_read(tmp_path, widths, wall, own, infill, density, walls):
    metadata = "".join('<metadata key="{}" value="{}"/>'.format(*pair) for pair in own.items())
    project = json.dumps(BAMBU_SETTINGS | widths)
    path = bambu(tmp_path / "a.3mf", INSIDE, "modifier_part", metadata, project)
    (block,) = document(path)["objects"]
    if walls < 3:
        wall = walls * {1.4: 0.4, 1.35: 0.45}[wall]
    assert block["kind"] == "printed"
    assert (block["print"]["infill"], block["print"]["walls"]) == (infill, walls)
    core = (40 - 2 * wall) * (20 - 2 * wall) * (24 - 1.8) * 1e-9
    assert close(block["mass"], density * (19_200e-9 - (1.0 - infill / 100.0) * core), 1e-6)


@pytest.mark.parametrize(
    ("own", "expected"),
    [
        ({"spiral_mode": "1"}, {"walls": 1, "top": 0, "bottom": 4, "infill": 0.0}),
        (
            {"layer_height": "0.08", "top_shell_thickness": "1.0", "bottom_shell_thickness": "0.2"},
            {"walls": 3, "top": 13, "bottom": 4, "infill": 20.0},
        ),
    ],
)
def test_vase_and_least_thickness_count(tmp_path, own, expected):
    path = bambu(tmp_path / "a.3mf", INSIDE, "modifier_part", "", json.dumps(BAMBU_SETTINGS | own))
    (block,) = document(path)["objects"]
    assert {name: block["print"][name] for name in expected} == expected


@pytest.mark.parametrize(
    "own",
    [
        {"extruder": "x"},
        {"wall_loops": "two"},
        {"sparse_infill_density": "120%"},
        {"layer_height": "0"},
    ],
)
def test_unreadable_print_settings_leave_the_part_solid(tmp_path, own):
    metadata = "".join('<metadata key="{}" value="{}"/>'.format(*pair) for pair in own.items())
    path = bambu(tmp_path / "a.3mf", INSIDE, "modifier_part", metadata, json.dumps(BAMBU_SETTINGS))
    (block,) = document(path)["objects"]
    assert block["kind"] == "solid" and close(block["volume"], 19_200e-9, 1e-6)
    assert [one["code"] for one in block["findings"]].count("unchecked") == 1
