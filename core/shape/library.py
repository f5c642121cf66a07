# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Libraries of signatures in JSON lines, and a search for the nearest.

`measure --signature --format jsonl` writes such lines.
"""

import json
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path

from ..numerics import check_type
from ..verdict import FileError, Finding, finding
from .findings import LIBRARY_LINE, NO_SHAPE, RECORD_WITHOUT_SIGNATURE
from .signatures import MAX_SIMILAR_DIFFERENCE, Likeness, Signature, similarity

# signatures nearer than this are one shape's: some float32 steps, and no more than a careless
# export
SAME_SHAPE_DISTANCE = 1e-4
SAME_SIZE_RTOL = 1e-4
MAX_LINE_BYTES = 1 << 28
DECIMALS = 12  # decimals of distances; further ones are rounding errors


class Similarity(StrEnum):
    """The relation of a shape to the one that it was compared with."""

    COPY = "copy"
    SCALED_COPY = "scaled_copy"
    MIRROR = "mirror"
    SCALED_MIRROR = "scaled_mirror"
    COPY_OR_MIRROR = "copy_or_mirror"
    SCALED_COPY_OR_MIRROR = "scaled_copy_or_mirror"
    SIMILAR = "similar"
    DIFFERENT = "different"


# the signatures do not decide the hand
UNDECIDED_HANDEDNESS = (Similarity.COPY_OR_MIRROR, Similarity.SCALED_COPY_OR_MIRROR)


@dataclass(frozen=True, eq=False)
class Entry:
    """A body of a library: its name, its file's name or "", and its signature."""

    name: str
    file: str
    signature: Signature

    @property
    def label(self) -> str:
        """FILE:NAME, by which the command line distinguishes bodies of one name."""
        return _label(self.file, self.name)


def _label(file: str, name: str) -> str:
    """Return FILE:NAME, or the name alone without a file."""
    return "{:s}:{:s}".format(file, name) if file else name


def read_library(path: Path) -> tuple[list[Entry], list[Finding]]:
    """Read a library of signatures, JSON lines of ``measure --signature --format jsonl``.

    Parameters
    ----------
    path : Path

    Returns
    -------
    entries : list of Entry
        The bodies with a signature.
    findings : list of Finding
        One for each body without a signature.

    Raises
    ------
    FileError
        If a line of the file is not such JSON, or too long.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from body_moments.core.shape import read_library
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = Path(folder) / "parts.jsonl"
    ...     _ = path.write_text('{"objects": [{"name": "Cube"}]}')
    ...     entries, findings = read_library(path)
    >>> entries, findings[0].code
    ([], 'record_without_signature')
    """
    entries = []
    missing = []
    for number, line in enumerate(_lines(path), 1):
        if not line.strip():
            continue
        try:
            document = json.loads(line)
            records = [dict(record) for record in (*document["objects"], *document.get("flat", ()))]
        except (ValueError, KeyError, TypeError, RecursionError) as error:
            raise FileError(LIBRARY_LINE, file=path.name, line=number) from error
        for record in records:
            name = str(record.get("name"))
            file = str(document.get("file") or "")
            try:
                signature = Signature.from_record(record.get("signature") or {})
            except FileError:
                has_no_shape = "signature" in record and record["signature"] is None
                remedy = NO_SHAPE if has_no_shape else "Measure with --signature"
                missing.append(
                    finding(RECORD_WITHOUT_SIGNATURE, name=_label(file, name), remedy=remedy)
                )
            else:
                entries.append(Entry(name, file, signature))
    return entries, missing


def _lines(path: Path) -> Iterator[bytes]:
    """Yield the lines of a file; FileError for one that is too long to be read."""
    with open(path, "rb") as file:
        for number, line in enumerate(iter(lambda: file.readline(MAX_LINE_BYTES + 1), b""), 1):
            if len(line) > MAX_LINE_BYTES:
                raise FileError(LIBRARY_LINE, file=path.name, line=number)
            yield line


def rank(
    query: Signature, entries: Iterable[Entry], any_size: bool = False, any_hand: bool = False
) -> list[tuple[Entry, Likeness]]:
    """Sort the bodies of a library by their likeness to a shape, the most alike first.

    Parameters
    ----------
    query : Signature
    entries : iterable of Entry
    any_size, any_hand : bool
        True if another size, or a mirror image, is as good as a copy.

    Returns
    -------
    list of (Entry, Likeness)
        Bodies that are as alike, to rounding, in the order given.

    Examples
    --------
    >>> from body_moments.core.mesh import Surface
    >>> from body_moments.core.polyhedron import polyhedron_moments
    >>> from body_moments.core.shape import rank, signature
    >>> from body_moments.core.shape.library import Entry
    >>> faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    >>> surface = Surface.from_triangles(np.eye(4, 3, -1), faces)
    >>> bodies = []
    >>> for name, map in (("wide", np.diag([3.0, 1.0, 1.0])), ("same", np.eye(3))):
    ...     moments = polyhedron_moments(surface.transform(map), 20)[0].about_center()
    ...     bodies.append(Entry(name, "", signature(moments, 3.0)))
    >>> [entry.name for entry, likeness in rank(bodies[1].signature, bodies)]
    ['same', 'wide']
    """
    check_type("query", query, Signature)
    ranked = [(entry, similarity(query, entry.signature)) for entry in entries]
    return sorted(ranked, key=lambda row: round(row[1].distance(any_size, any_hand), DECIMALS))


def classify(similarity: Likeness) -> Similarity:
    """Name the relation of a shape to the one that it was compared with."""
    if similarity.shape > MAX_SIMILAR_DIFFERENCE:
        return Similarity.DIFFERENT
    if similarity.shape > SAME_SHAPE_DISTANCE:
        return Similarity.SIMILAR
    relation = {None: "copy_or_mirror", True: "mirror", False: "copy"}[similarity.is_mirror_image]
    is_same_size = abs(similarity.scale - 1.0) <= SAME_SIZE_RTOL
    return Similarity(relation if is_same_size else "scaled_" + relation)
