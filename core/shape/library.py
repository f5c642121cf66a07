# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Libraries of signatures: JSON lines, as `measure --signature --format jsonl` writes them, and what is nearest in
them."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from .signature import ALIKE, Likeness, Signature, compared

SAME = 1e-4  # signatures nearer than this are one shape's: some float32 steps, and no more than a careless export
SAME_SIZE = 1e-4
UNCLEAR = ("copy or mirror", "scaled copy or mirror")  # verdicts where the signatures do not tell the hand


@dataclass(frozen=True, eq=False)
class Entry:
    """One body of a library."""

    name: str
    file: str
    signature: Signature

    @property
    def label(self) -> str:
        """FILE:NAME, by which the command line tells bodies of one name apart."""
        return "{:s}:{:s}".format(self.file, self.name) if self.file else self.name


def read_library(path: Path) -> tuple[list[Entry], list[str]]:
    """The bodies with a signature, and a sentence for each without. ValueError where the file is no library."""
    entries, faults = [], []
    for number, line in enumerate(path.read_text(encoding="utf-8").split("\n"), 1):
        if not line.strip():
            continue
        try:
            document = json.loads(line)
            objects = document["objects"]
        except (ValueError, KeyError, TypeError) as error:
            raise ValueError(
                "Line {:d} is no document of body_moments; write the library with --format jsonl.".format(number)
            ) from error
        for record in objects:
            name, file = str(record.get("name")), str(document.get("file") or "")
            try:
                entries.append(Entry(name, file, Signature.from_record(record.get("signature") or {})))
            except ValueError:
                reason = (
                    "It has no shape that a signature could tell; the warnings of its record say why."
                    if "signature" in record and record["signature"] is None
                    else "It has no signature; measure it with --signature."
                )
                faults.append("{:s}:{:s}: {:s}".format(file, name, reason))
    return entries, faults


def nearest(
    wanted: Signature, entries: Iterable[Entry], any_size: bool = False, any_hand: bool = False
) -> list[tuple[Entry, Likeness]]:
    """All entries with their likeness to the one that is wanted, the most alike first."""
    rows = [(entry, compared(wanted, entry.signature)) for entry in entries]
    return sorted(rows, key=lambda row: row[1].distance(any_size, any_hand))


def same_size(likeness: Likeness) -> bool:
    """Whether the two bodies are of one size, to noise."""
    return abs(likeness.scale - 1.0) <= SAME_SIZE


def verdict(likeness: Likeness) -> str:
    """What a shape is to the one that it was compared with, in a few words."""
    if likeness.shape > ALIKE:
        return "different"
    if likeness.shape > SAME:
        return "similar"
    if likeness.mirrored is None:
        return UNCLEAR[0] if same_size(likeness) else UNCLEAR[1]
    if likeness.mirrored:
        return "mirror image" if same_size(likeness) else "scaled mirror"
    return "copy" if same_size(likeness) else "scaled copy"
