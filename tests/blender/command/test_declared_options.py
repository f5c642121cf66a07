# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of all commands as they are declared: names, values, defaults and help. They are a public contract."""

import pytest
from body_moments.operators.command import arguments, audit, gather, similar, simplex
from body_moments.operators.command.parser import HelpRequested, Parser

GATHER = ("manifest", "merge", "to-csv", "summary", "compare", "report")


def parsers(monkeypatch):
    """Of each command, its name and its parser."""

    def stop(parser, _file=None):
        found.append(parser)
        raise HelpRequested("")

    found = []
    monkeypatch.setattr(Parser, "print_help", stop)
    commands = {"measure": lambda words: arguments.parse(words, False), "similar": similar.parse, "audit": audit.parse}
    commands |= {"simplex": simplex.parse, **dict.fromkeys(GATHER, gather._parse)}
    for name, parse in commands.items():
        with pytest.raises(HelpRequested):
            parse([name, "--help"])
        yield name, found.pop()


def declared(parser):
    """Lines of text, the same for all versions of argparse."""
    yield "usage: {}".format(parser.usage)
    yield "about: {}".format(parser.description)
    for action in parser._actions:
        name = ", ".join(action.option_strings) or action.dest
        values = {"nargs": action.nargs, "const": action.const, "default": action.default, "choices": action.choices}
        values |= {"type": getattr(action.type, "__name__", None), "metavar": action.metavar}
        shown = ["{}={}".format(key, value) for key, value in values.items() if value is not None]
        yield "{}{}: {}".format(name, " (required)" if action.required else "", type(action).__name__.strip("_"))
        yield from ["    " + line for line in shown]
        yield "    {}".format(action.help)
    yield "end: {}".format(parser.epilog)


def test_the_options_of_all_commands_are_declared_as_they_are_kept(monkeypatch, kept):
    pages = []
    for name, parser in parsers(monkeypatch):
        pages += ["=== " + name, *declared(parser), ""]
    kept("options.txt", "\n".join(pages[:-1]))
