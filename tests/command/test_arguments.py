# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Options of `measure` with valid and invalid values, and combinations that are refused."""

import pytest

pytest.importorskip("bpy")
from body_moments.command.options import arguments
from body_moments.command.options.formats import FORMATS

from tests.blender.batch_files import sentence

NO_NUMBERS = ("1_0", "٣", "1.0D0", "0x1", "1e", "1.0.0", "--1")
NUMBERS = {"0.5": 0.5, "1e-300": 1e-300, "1e300": 1e300}
POSITIVE = (
    NUMBERS,
    {text: "usage_not_positive" for text in ("0", "-1", "nan", "inf", "-inf", "1e999", "x", "", "1,2", *NO_NUMBERS)},
)
TRIPLES = {"1,-2,3e5": (1.0, -2.0, 3e5), "0,0,0": (0.0, 0.0, 0.0)}
NO_TRIPLES = {
    text: "usage_not_triple"
    for text in ("1", "1,2", "1,2,3,4", "1,2,nan", "1,inf,2", "a,b,c", "1,,2", "1_0,2,3", "٣,2,3")
}
COUNTS = {
    text: "usage_not_positive" for text in ("0", "-1", "1.5", "x", "", "1000000000", "²", "٣", "000000000", "1e3")
}
ORDERS = {"-1": {"usage_order": 30}, "x": {"usage_order": 30}, "1.5": {"usage_order": 30}}
ORDERS |= {"1_0": {"usage_order": 30}, "٣": {"usage_order": 30}}
LIMITED = {
    "--order": ({"0": 0, "7": 7, "30": 30}, {**ORDERS, "31": {"usage_order_too_high": 30}}),
    "--grid": (
        {"2": 2, "256": 256},
        {text: {"usage_frequency_count": 256} for text in ("1", "257", "0", "-3", "x", "2.5", "1_0", "٣")},
    ),
    "--spline-order": (
        {"1": 1, "16": 16},
        {text: {"usage_spline_order": 16} for text in ("0", "17", "x", "01", "1.0", "", "-1")},
    ),
}
OPTIONS = {
    **dict.fromkeys(("--density", "--mass", "--thickness", "--unit-scale", "--density-scale", "--qmax"), POSITIVE),
    **dict.fromkeys(("--timeout", "--memory-mb"), POSITIVE),
    "--threshold": (
        {**NUMBERS, "-2.5": -2.5, "0": 0.0},
        dict.fromkeys(("nan", "inf", "-inf", "", "1_0"), "usage_not_number"),
    ),
    "--jobs": ({"1": 1, "999999999": 999999999}, COUNTS),
    "--origin": (TRIPLES, NO_TRIPLES),
    "--spacing": (
        {"1,2,3e5": (1.0, 2.0, 3e5)},
        {**NO_TRIPLES, **dict.fromkeys(("1,2,0", "-1,2,3"), "usage_not_positive_triple")},
    ),
    "--about": (
        {**TRIPLES, "center": "center", "origin": "origin", "world": "world"},
        {**NO_TRIPLES, "Center": "usage_not_triple"},
    ),
    "--positions": (
        {"x=a=b.npy": [("x", "a=b.npy")], "z=c": [("z", "c")]},
        dict.fromkeys(("w=a.npy", "x", "x=", "=a.npy", "xy=a.npy", ""), "usage_positions"),
    ),
    "--density-from": (
        {text: text for text in ("value", "materials", "attribute:a:b", "volume:c")},
        dict.fromkeys(("value:a", "attribute", "attribute:", "volume", "mesh", ""), "usage_density_source"),
    ),
    "--range": (
        {"1:5": (1, 5), ":5": (0, 5), "2:": (2, None), ":": (0, None), "3:3": (3, 3)},
        dict.fromkeys(("3", "5:3", "-1:3", "a:b", "1:2:3", "1:²", ""), "usage_range"),
    ),
    "--format": (
        {name: name for name in ("json", "csv", "jsonl")},
        dict.fromkeys(("xml", "", "JSON"), {"usage_format_unknown": ", ".join(FORMATS)}),
    ),
    **LIMITED,
}  # fmt: skip
# Options that each option needs beside it.
WITH = {
    "--grid": ("--fourier", "f.npz", "--qmax", "1"),
    "--qmax": ("--fourier", "f.npz", "--grid", "4"),
    "--q": ("--fourier", "f.npz"),
    "--fourier": ("--q", "q.npy"),
    "--resume": ("--output", "o.json"),
}


def key(option):
    return option[2:].replace("-", "_")


def parse(*words):
    return arguments.parse(["measure", "a.stl", *words])


def refused(capsys, *words, **keywords):
    """The reason that is given, after the usage."""
    with pytest.raises(SystemExit) as ended:
        arguments.parse([*words], **keywords)
    said = capsys.readouterr()
    assert ended.value.code == 2 and said.out == "" and said.err.startswith("usage: body_moments measure [options]")
    return said.err.rpartition("body_moments: error: ")[2].strip()


@pytest.mark.parametrize("option", OPTIONS)
def test_values_are_taken_or_refused_with_their_reason(option, capsys):
    right, wrong = OPTIONS[option]
    for text, value in right.items():
        found = getattr(parse("{}={}".format(option, text), *WITH.get(option, ())), key(option))
        assert found == value and type(found) is type(value), text
    for text in (text for text in right if text.startswith("-") and option in ("--origin", "--about")):
        assert getattr(parse(option, text), key(option)) == right[text]
    for text, code in wrong.items():
        values = {"text": text}
        if isinstance(code, dict):
            ((code, more),) = code.items()
            values["formats" if option == "--format" else "limit"] = more
        said = refused(capsys, "measure", "{}={}".format(option, text))
        assert said == "argument {}: {}".format(option, sentence(code, **values)), text


@pytest.mark.parametrize(
    "words, code, values",
    [
        (["a", "b", "--format", "urdf"], "robot_one_file", {"count": 2}),
        *(
            (["--format", "sdf", "--links", "bone", option, value], "usage_links_of_bones", {"option": option[2:]})
            for option, value in (("--density", "1"), ("--mass", "1"), ("--kind", "solid"), ("--thickness", "1"),
                                  ("--material", "Brass"), ("--wall", "thin"), ("--overlap", "union"))
        ),
        (["a", "--format", "gltf", "--output", "a.GLB"], "usage_text_format", {"format": "gltf"}),
        (["a", "--format", "usd", "--output", "a.usdc"], "usage_text_format", {"format": "usd"}),
        *(
            ([*more, option, value], "usage_needs_supervisor", {"option": option[2:]})
            for option, value in (("--jobs", "1"), ("--timeout", "1"), ("--memory-mb", "1"), ("--blender", "b"))
            for more in ([], ["a", "--no-supervisor"])
        ),
        (["--resume"], "usage_needs_supervisor", {"option": "resume"}),
        (["a", "--no-supervisor", "--resume"], "usage_needs_supervisor", {"option": "resume"}),
        (["a", "--resume"], "usage_resume_output", {}),
        *((["a", "--" + name, value], "usage_needs_fourier", {"option": name}) for name, value in
          (("q", "q"), ("grid", "4"), ("qmax", "1"))),
        (["a", "--fourier", "f"], "usage_fourier_points", {}),
        (["a", "--fourier", "f", "--q", "q", "--grid", "4", "--qmax", "1"], "usage_fourier_points", {}),
        (["a", "--fourier", "f", "--grid", "4"], "usage_grid_and_qmax", {}),
        (["a", "--fourier", "f", "--q", "q", "--qmax", "1"], "usage_grid_and_qmax", {}),
        (["a", "b", "--fourier", "f", "--q", "q"], "usage_fourier_one_object", {}),
        (["a", "--fourier", "f", "--q", "q", "--object", "x", "--object", "y"], "usage_fourier_one_object", {}),
        *((["a", "--fourier", first, "--q", second, "--output", third], "usage_path_twice", {"path": path})
          for first, second, third, path in
          (("p", "p", "o", "p"), ("p", "q", "./p", "p"), ("f", "p", "x/../p", "x/../p"))),
        (["a", "--positions=x=p", "--positions=y=p", "--positions=x=q"], "usage_positions_twice", {"axes": [*"xyx"]}),
    ],
)  # fmt: skip
def test_contradicting_options_are_refused(words, code, values, capsys):
    assert refused(capsys, "measure", *words) == sentence(code, **values)
