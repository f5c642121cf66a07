# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Instances of a STEP file in clear text (ISO 10303-21).

Attributes are numbers, texts, truth values, lists, references, enumerations as `.NAME.`, None for
`$` and `*`, and pairs of a type and its values. Instances are parsed when they are needed.
References and the depth of lists are not trusted.
"""

from __future__ import annotations

import re
from typing import Any, TypeAlias

from ..files import FILE_TOO_LARGE, FILE_UNRECOGNIZED
from ..verdict import FileError
from .iges_entities import MANY_DIGITS, MAX_DEPTH

MAX_INSTANCES = 5_000_000
Parts: TypeAlias = dict[str, list[Any]]
# Strings and comments hide a semicolon.
_STOP = re.compile(rb"'[^']*'|/\*.*?\*/|;", re.DOTALL)
_HEAD = re.compile(rb"(?:\s|/\*.*?\*/)*#(\d+)\s*=\s*(\w*)", re.DOTALL)
_REAL = re.compile(rb"\d+\.\d*")
_REFERENCE = re.compile(rb"#(\d+)")
_ENTITY = re.compile(rb"(\w+)\s*\(")
_TOKEN = re.compile(
    r"#(?P<reference>\d+)|'(?P<text>(?:[^']|'')*)'|(?P<real>[+-]?\d+\.\d*(?:[eE][+-]?\d+)?)"
    r"|(?P<integer>[+-]?\d+)|(?P<enumeration>\.\w+\.)|(?P<name>!?[A-Za-z_]\w*)|(?P<nothing>[$*])"
    r'|"(?P<binary>[0-9A-F]*)"|(?P<mark>[(),])|(?:\s|/\*.*?\*/)+',
    re.DOTALL,
)
_ESCAPE = re.compile(
    r"''|\\\\|\\S\\(?P<high>.)|\\X\\(?P<byte>[0-9A-Fa-f]{2})|\\P[A-I]\\"
    r"|\\X(?P<width>[24])\\(?P<codes>[0-9A-Fa-f]*)\\X0\\",
    re.DOTALL,
)


class Reference(int):
    """The number of another instance."""


class _Name(str):
    """The name of an entity or a type, before its values."""


def untyped(value: Any) -> Any:
    """Return an attribute's value without its type, the single one of a pair of type and values."""
    return value[1][0] if isinstance(value, tuple) else value


class Part21:
    """The instances of a STEP file.

    named: the numbers of instances by the names of their entities. torn: the number of the last
    instance if the file ends too early, else 0. precision: largest share of a number that its last
    decimal rounds away. FileError if it is no STEP file.
    """

    def __init__(self, data: bytes) -> None:
        if not data.lstrip().startswith(b"ISO-10303-21"):
            raise FileError(FILE_UNRECOGNIZED, format="STEP (ISO 10303-21)")
        self._data = data
        self._spans: dict[int, tuple[int, int]] = {}
        self._known: dict[int, Parts] = {}
        self.named: dict[str, list[int]] = {}
        digits = max(
            (len(word.replace(b".", b"").strip(b"0")) for word in _REAL.findall(data)), default=0
        )
        self.precision = 0.5 * 10.0 ** (1 - digits) if digits >= MANY_DIGITS else 0.0
        start = last = 0
        statement = b""
        for stop in _STOP.finditer(data):
            if stop[0] != b";":
                continue
            head = _HEAD.match(data, start, stop.start())
            if head:
                last = int(head[1])
                self._spans[last] = head.start(2), stop.start()
                names = [head[2]] if head[2] else _ENTITY.findall(data, head.end(), stop.start())
                for name in names:
                    self.named.setdefault(name.decode().upper(), []).append(last)
            else:
                statement = data[start : stop.start()].strip()
            start = stop.end()
        if len(self._spans) > MAX_INSTANCES:
            raise FileError(FILE_TOO_LARGE, limit=MAX_INSTANCES, content="entities")
        self.torn = 0 if statement.endswith(b"END-ISO-10303-21") else last

    def line(self, number: int) -> int:
        """Return the line in which an instance begins, or the last line."""
        return self._data.count(b"\n", 0, self._spans.get(number, (None, None))[0]) + 1

    def extract(self, *lines: str) -> bytes:
        """Return a file of these statements and of all instances that they need."""
        needed: set[int] = set()
        texts = ["".join(lines).encode()]
        for text in texts:  # They grow by the instances that a text refers to.
            references = set(map(int, _REFERENCE.findall(text))) - needed
            for number in references & self._spans.keys():
                needed.add(number)
                texts.append(b"#%d=%s;\n" % (number, self._data[slice(*self._spans[number])]))
        return b"ISO-10303-21;\n%sEND-ISO-10303-21;\n" % b"".join(texts)

    def entity(self, number: int) -> str:
        """Return the longest name of an instance's entities."""
        start, end = self._spans.get(number, (0, 0))
        return max(_ENTITY.findall(self._data, start, end), key=len, default=b"").decode()

    def __getitem__(self, number: int) -> Parts:
        """Return attributes by entity; KeyError if the instance is missing, ValueError if it is
        damaged.
        """
        if number not in self._known:
            text = self._data[slice(*self._spans[number])].decode("utf-8", "replace")
            self._known[number] = _parts(text)
        return self._known[number]


def _parts(text: str) -> Parts:
    """Return the attributes of an instance by entity; ValueError if it is damaged."""
    stack: list[list[Any]] = [[]]
    at = 0
    while at < len(text):
        token = _TOKEN.match(text, at)
        if token is None or token[0] == ")" and len(stack) == 1 or len(stack) > MAX_DEPTH:
            raise ValueError("damaged")
        at = token.end()
        kind = token.lastgroup or ""
        if kind in _CONVERTED:
            stack[-1].append(_CONVERTED[kind](token[kind]))
        elif token[0] == "(":
            stack.append([])
        elif token[0] == ")":
            values = stack.pop()
            is_named = stack[-1] and isinstance(stack[-1][-1], _Name)
            stack[-1].append((stack[-1].pop().upper(), values) if is_named else values)
    if len(stack) != 1 or len(stack[0]) != 1:
        raise ValueError("damaged")
    # One entity is a pair of its name and attributes, several are a list of such pairs.
    return dict(stack[0][0] if isinstance(stack[0][0], list) else stack[0])


def _text(text: str) -> str:
    """Return a string without its escapes."""

    def plain(escape: re.Match[str]) -> str:
        if escape["high"]:
            return chr(ord(escape["high"]) + 128)
        if escape["byte"]:
            return chr(int(escape["byte"], 16))
        if escape["width"]:
            encoding = "utf-16-be" if escape["width"] == "2" else "utf-32-be"
            return bytes.fromhex(escape["codes"]).decode(encoding)
        return {"''": "'", "\\\\": "\\"}.get(escape[0], "")

    return _ESCAPE.sub(plain, text)


_CONVERTED: dict[str, Any] = {
    "reference": Reference,
    "text": _text,
    "real": float,
    "integer": int,
    "enumeration": lambda word: {".T.": True, ".F.": False}.get(word, word.upper()),
    "name": _Name,
    "nothing": lambda _: None,
    "binary": str,
}
