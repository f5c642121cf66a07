# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""`simplex`: moments in n dimensions of a body that is given by simplices, which fill it or form
its boundary.
"""

import argparse
import json
from math import comb
from pathlib import Path
from typing import Any

import numpy as np

from ..core import files, measurement, polyhedron, scans
from ..core.numerics import Array, Integers, NDArray
from ..core.verdict import MeasureError, finding, system_reason
from .findings import SIMPLEX_OPEN
from .options import arguments
from .options import option_types as types
from .parser import COMMANDS, Parser, UsageError, flag, value

MAX_DIMENSION = 12
MAX_MOMENTS = 1 << 20

_EPILOG = """\
FILE.npz has `points`, m rows of n coordinates, and `simplices`, rows of numbers of points from 0
on: n + 1 of them are a full simplex (a triangle in the plane, a tetrahedron in space), n a facet of
the boundary, outward where the determinant of its corners is positive for a body around the origin:
edges counter-clockwise in the plane, triangles counter-clockwise from outside in space. Optional
are `signs`, 1 or -1 for each row: with -1 it is turned, or its full simplex taken away.
exit code: 0 measured, 1 the file cannot be measured, 2 wrong usage, 3 interrupted,
70 a fault of the program"""


def parse(argv: list[str]) -> argparse.Namespace:
    """Return the options of `simplex`. Raises SystemExit(2), or HelpRequested."""
    parser = Parser(
        prog="body_moments",
        usage="body_moments simplex FILE.npz [--order N] [--about X,Y,...] [--boundary]",
        description=COMMANDS["simplex"],
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument("command", metavar="simplex")
    parser.add_argument("file", type=Path, metavar="FILE.npz")
    parser.add_options(
        {
            "--order": value(types.order, "N", "all |α| up to this (2)", default=2),
            "--about": value(_point, "X,Y,...", "the point that they are about (the origin)"),
            "--boundary": flag("add the moments of the boundary itself: length, area, …"),
        }
    )
    return parser.parse_intermixed_args(arguments.join_negative_values(argv))


def answer(options: argparse.Namespace) -> tuple[list[str], int]:
    """Return the text of the record, and the exit code; the reason for a failure is on the standard
    error.
    """
    try:
        return [json.dumps(_measure(options), indent=1, allow_nan=False) + "\n"], 0
    except (UsageError, MeasureError) as error:
        measurement.print_message(options.file, error)
    except OSError as error:
        measurement.print_message(options.file, "cannot be read: {}".format(system_reason(error)))
    return [], 1


def _measure(options: argparse.Namespace) -> dict[str, Any]:
    """Return the record. Raises UsageError, MeasureError and OSError."""
    points, simplices, signs = _read(options.file)
    dimension = points.shape[1]
    if comb(dimension + options.order, dimension) > MAX_MOMENTS:
        raise UsageError(
            "These are more than {} moments. Choose a lower --order".format(MAX_MOMENTS)
        )
    about = np.zeros(dimension) if options.about is None else np.array(options.about)
    if len(about) != dimension:
        raise UsageError(
            "--about has {} coordinates, and the points {}".format(len(about), dimension)
        )
    facets = simplices
    if simplices.shape[1] == dimension + 1:
        # The facets come in blocks: one facet of each simplex, then another one of each.
        facets, facet_signs = polyhedron.facets_of(points, simplices)
        signs = facet_signs if signs is None else facet_signs * np.tile(signs, dimension + 1)
    is_closed = polyhedron.closes(points, facets, signs)
    findings = [] if is_closed else [finding(SIMPLEX_OPEN)]
    for open_boundary in findings:
        measurement.print_message(options.file, open_boundary)
    record: dict[str, Any] = (
        {
            "schema": "body-moments-simplex/1",
            "file": str(options.file),
            "dimension": dimension,
            "simplices": len(simplices),
            "closed": is_closed,
            "order": options.order,
            "about": about.tolist(),
        }
        | _as_record(
            polyhedron.enclosed_moments(
                points, facets, options.order, about, signs, allow_open=True
            )
        )
        | measurement.described(findings)
    )
    if options.boundary:
        outer = facets if facets is simplices else polyhedron.outer_facets(points, facets, signs)
        record["boundary"] = _as_record(
            polyhedron.facet_moments(points, outer, options.order, about)
        )
    return record


def _point(text: str) -> list[float]:
    return [types.number(word) for word in text.split(",")]


def _as_record(moments: polyhedron.SimplexMoments) -> dict[str, dict[str, float]]:
    """Return the moments and their bounds by the powers of the coordinates, such as "2,0,1"."""
    keys = [
        ",".join(map(str, row))
        for row in polyhedron.multi_indices(len(moments.about), moments.order).tolist()
    ]
    return {
        "moments": dict(zip(keys, moments.raw.tolist())),
        "error": dict(zip(keys, moments.rounding_error.tolist())),
    }


def _read(path: Path) -> tuple[Array, Integers, NDArray | None]:
    """Return (m, n) points, (k, n) or (k, n + 1) simplices and (k,) signs, or None.

    Raises UsageError, MeasureError and OSError.
    """
    arrays = scans.read_arrays(path, ("points", "simplices", "signs"), files.file_limits())
    if not {"points", "simplices"} <= arrays.keys():
        raise UsageError("The file is no .npz archive with the arrays “points” and “simplices”")
    points = arrays["points"]
    simplices = arrays["simplices"]
    signs = arrays.get("signs")
    dimension = points.shape[1] if points.ndim == 2 else 0
    if (
        points.dtype.kind not in "iuf"
        or not 1 <= dimension <= MAX_DIMENSION
        or not np.isfinite(points).all()
    ):
        raise UsageError(
            "“points” must be rows of 1 to {} finite coordinates".format(MAX_DIMENSION)
        )
    is_table = (
        simplices.ndim == 2
        and simplices.dtype.kind in "iu"
        and simplices.shape[1] in (dimension, dimension + 1)
    )
    if not is_table or not len(simplices) or simplices.min() < 0 or simplices.max() >= len(points):
        raise UsageError(
            "“simplices” must be rows of {} or one more numbers of points, from 0 on".format(
                dimension
            )
        )
    if signs is not None and (
        signs.shape != (len(simplices),) or not np.isin(signs, (-1, 1)).all()
    ):
        raise UsageError("“signs” must be 1 or -1 for each of the simplices")
    return points.astype(np.float64), simplices.astype(np.int64), signs
