# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Options of `measure` with valid and invalid values, and combinations that are refused."""

import pytest
from body_moments.command.options import arguments

NO_NUMBERS = ("1_0", "٣", "1.0D0", "0x1", "1e", "1.0.0", "--1")
NUMBERS = {"0.5": 0.5, "1e-300": 1e-300, "1e300": 1e300}
POSITIVE = (NUMBERS, ("0", "-1", "nan", "inf", "-inf", "1e999", "x", "", "1,2", *NO_NUMBERS))
TRIPLES = {"1,-2,3e5": (1.0, -2.0, 3e5), "0,0,0": (0.0, 0.0, 0.0)}
NO_TRIPLES = ("1", "1,2", "1,2,3,4", "1,2,nan", "1,inf,2", "a,b,c", "1,,2", "1_0,2,3", "٣,2,3")
NO_COUNTS = ("0", "-1", "1.5", "x", "", "1000000000", "²", "٣", "000000000", "1e3", "1_0")
# Valid values of each option, and invalid ones.
OPTIONS = {
    **dict.fromkeys(
        ("--density", "--mass", "--thickness", "--unit-scale", "--density-scale", "--qmax"),
        POSITIVE,
    ),
    **dict.fromkeys(("--timeout", "--memory-mb"), POSITIVE),
    "--threshold": ({**NUMBERS, "-2.5": -2.5, "0": 0.0}, ("nan", "inf", "-inf", "", "1_0")),
    "--jobs": ({"1": 1, "999999999": 999999999}, NO_COUNTS),
    "--order": ({"0": 0, "7": 7, "30": 30}, ("-1", "x", "1.5", "1_0", "٣", "31")),
    "--grid": ({"2": 2, "256": 256}, ("1", "257", "0", "-3", "x", "2.5", "1_0", "٣")),
    "--spline-order": ({"1": 1, "16": 16}, ("0", "17", "x", "1.0", "", "-1")),
    "--origin": (TRIPLES, NO_TRIPLES),
    "--spacing": ({"1,2,3e5": (1.0, 2.0, 3e5)}, (*NO_TRIPLES, "1,2,0", "-1,2,3")),
    "--about": (
        {**TRIPLES, **{name: name for name in ("center", "origin", "world")}},
        (*NO_TRIPLES, "Center"),
    ),
    "--positions": (
        {"x=a=b.npy": [("x", "a=b.npy")], "z=c": [("z", "c")]},
        ("w=a.npy", "x", "x=", "=a.npy", "xy=a.npy", ""),
    ),
    "--density-from": (
        {text: text for text in ("value", "materials", "attribute:a:b", "volume:c")},
        ("value:a", "attribute", "attribute:", "volume", "mesh", ""),
    ),
    "--range": (
        {"1:5": (1, 5), ":5": (0, 5), "2:": (2, None), ":": (0, None), "3:3": (3, 3)},
        ("3", "5:3", "-1:3", "a:b", "1:2:3", "1:²", ""),
    ),
    "--format": ({name: name for name in ("json", "csv", "jsonl")}, ("xml", "", "JSON")),
}
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
    assert (
        ended.value.code == 2
        and said.out == ""
        and said.err.startswith("usage: body_moments measure [options]")
    )
    return said.err.rpartition("body_moments: error: ")[2].strip()


@pytest.mark.parametrize("option", OPTIONS)
def test_values_are_taken_or_refused_with_their_reason(option, capsys):
    right, wrong = OPTIONS[option]
    for text, value in right.items():
        found = getattr(parse("{}={}".format(option, text), *WITH.get(option, ())), key(option))
        assert found == value and type(found) is type(value), text
    for text in (
        text for text in right if text.startswith("-") and option in ("--origin", "--about")
    ):
        assert getattr(parse(option, text), key(option)) == right[text]
    for text in wrong:
        said = refused(capsys, "measure", "{}={}".format(option, text))
        assert said.startswith("argument {}: {!r} ".format(option, text))


SUPERVISED = (("--jobs", "1"), ("--timeout", "1"), ("--memory-mb", "1"), ("--blender", "b"))
OF_BODIES = ("--kind=solid", "--thickness=1", "--wall=thin", "--overlap=union")


@pytest.mark.parametrize(
    "option, words",
    [
        ("--format", ["a", "b", "--format", "urdf"]),
        *(
            (word.partition("=")[0], ["--format", "sdf", "--links", "bone", word])
            for word in OF_BODIES
        ),
        ("--output", ["a", "--format", "gltf", "--output", "a.GLB"]),
        ("--output", ["a", "--format", "usd", "--output", "a.usdc"]),
        *(
            (words[0], [*more, *words])
            for words in SUPERVISED
            for more in ([], ["a", "--no-supervisor"])
        ),
        ("--resume", ["--resume"]),
        ("--resume", ["a", "--no-supervisor", "--resume"]),
        ("--output", ["a", "--resume"]),
        *(
            ("--" + name, ["a", "--" + name, value])
            for name, value in (("q", "q"), ("grid", "4"), ("qmax", "1"))
        ),
        ("--q", ["a", "--fourier", "f"]),
        ("--q", ["a", "--fourier", "f", "--q", "q", "--grid", "4", "--qmax", "1"]),
        ("--qmax", ["a", "--fourier", "f", "--grid", "4"]),
        ("--grid", ["a", "--fourier", "f", "--q", "q", "--qmax", "1"]),
        ("--fourier", ["a", "b", "--fourier", "f", "--q", "q"]),
        ("--fourier", ["a", "--fourier", "f", "--q", "q", "--object", "x", "--object", "y"]),
        ("--fourier", ["a", "--fourier", "p", "--q", "p", "--output", "o"]),
        ("--fourier", ["a", "--fourier", "p", "--q", "q", "--output", "./p"]),
        ("--fourier", ["a", "--fourier", "f", "--q", "x/../p", "--output", "p"]),
        ("--positions", ["a", "--positions=x=p", "--positions=y=p", "--positions=x=q"]),
    ],
)
def test_contradicting_options_are_refused(option, words, capsys):
    assert option in refused(capsys, "measure", *words)
