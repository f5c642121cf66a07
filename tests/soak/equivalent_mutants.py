# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Mutants that no test can find, as they change nothing that a user, a caller or a file could see; with the reasons."""

from __future__ import annotations

import re
from functools import lru_cache
from pathlib import Path

from tests.soak.mutants import Mutant

ROOT = Path(__file__).resolve().parent.parent.parent
CONSTANT = r"True|False|\d[\d.]*(e-?\d+)?"

# names of constants: the reason
NAMES = {
    r"_PER_(BLOCK|BATCH|CHUNK|SLAB|TASK|THREAD|STACK)$|^_?BLOCK|_BLOCK$|_ROWS$|_IN_CACHE$": "how much is "
    "computed or read at a time",
    r"^(FIRST_SAMPLES|GRID_CELLS)$": "in which order things are compared, of which all are",
    r"^(LINE_SLOPES|RAY_SLOPES|LATTICE_SHIFT|COLUMN_SLOPE)$": "which lines are looked along",
    r"^PIECE$|_PER_LEAF$": "how much is looked at at a time",
    r"^MAX_(BOX|COMPONENT|CHORD|SIDE|END)_PAIRS$": "one more of as many as are worth the time",
    r"^HASH_FACTORS$": "which of two colliding numbers comes first",
    r"^STEPS_BEFORE_MERGE$": "from when on directions that go to one maximum are followed as one",
    r"^MAX_CACHED_|_SCRATCH_": "how much is remembered",
    r"^DIRECT_COST$": "how time is estimated",
    r"^(CELL_DIAGONAL|REACH_MARGIN)$": "how many points are looked at more closely",
    r"^(TRIAL_RADII|ERROR_CREDITS|SAMPLE_FREQUENCIES)$": "what is tried, and compared, first or besides",
    r"^NO_BONE$": "a mark, of which any negative number is one",
}
# places ("module function"), and the mutant's text before and after it: the reason
PATTERNS = [
    (r".*", r".*\*= -1\.0", r".*/= -1\.0", "times -1 is by -1"),
    (r".*", r"(\([^()]*(\([^()]*\))?[^()]*\) \* )?([\w.]+(\[\w+\])?) @ \3", r"\([\w.\[\]]+ @ .*", "nothing is changed"),
    (r".*", r".* \* HALF_TURN(S|_SIGNS)\[.*", r"\(.* / HALF_TURN(S|_SIGNS)\[.*", "times -1 is by -1"),
    (
        r".*streams/stl.py .*",
        r"np\.arange\(.*, dtype=np\.int32\)",
        r"\(np\.arange\(((?!dtype).)*\)\)",
        "indices of eight bytes",
    ),
    (
        r".*write/robots/repair.py with_principal_axes",
        r"axes \* \(1\.0, 1\.0, np\.sign\(np\.linalg\.det\(axes\)\)\)",
        r"\(axes / .*",
        "times -1 is by -1",
    ),
    (r".*shape/symmetry.py _around_axis", r"n // 2", r"\(n \* 2\)", "the same turns, the other way"),
    (
        r".*nurbs/creases.py sharpest_crease",
        r"_along_side\(.* \* \(-1\.0 if .*",
        r"\(_along_side\(.* / \(-1\.0 if .*",
        "times -1 is by -1",
    ),
    (
        r".*robots/plausibility.py _nearest_shares",
        r"wanted - shares",
        r"\(wanted \+ shares\)",
        "as shares are made to add up to one, shorter steps the same way",
    ),
    (r".*robots/plausibility.py MAX_STEPS", r"200", r"201", "what is found after any step is a bound"),
    (r".*robots/plausibility.py Hull.distance", r"break", r"continue", "it finds the same until it has no more steps"),
    (
        r".*robots/plausibility.py Hull.distance",
        r"shifted\*\*2",
        r"\(shifted \* 2\)",
        "with which of the points it begins",
    ),
    (
        r".*robots/plausibility.py Hull.distance",
        r"lowest in chosen or .*",
        r"\((length|lowest in chosen).*",
        "how near to the largest bound the search ends, within a billionth",
    ),
    (r".*triangle_kernel.py PhaseMeans._by_edges", r"np\.divide\(total.*", r".*", "where a value is stored"),
    (r".*offset/walls.py OffsetSolid.moments", r"inward\*\*degree / degree", r".*", "a looser bound"),
    (
        r".*mesh/planarity.py PlanarityAccumulator.add_quads",
        r"np\.(abs|add|multiply)\(.*, out=.*\)",
        r"\(np\.\w+\(((?!out=).)*\)\)",
        "where a value is stored",
    ),
    (
        r".*mesh/planarity.py PlanarityAccumulator.add_quads",
        r"count < len\(bent\)",
        r"\(count <= len\(bent\)\)",
        "of none that are left, none are doubtful",
    ),
    (
        r".*mesh/planarity.py stack_planarity",
        r"np\.flatnonzero\(sizes\[.* else slice\(None\)",
        r"\(np\.flatnonzero\(sizes\[stack\.triangle_faces\] != 4\)\)",
        "where there are no quads, all of them",
    ),
    (
        r".*solid/weld_open_parts.py _find_open_parts",
        r"edges_from_mesh\(.* else None|edges or find_edges\(.*\)",
        r"None|\(find_edges\(.*\)\)",
        "edges that are searched are those that the mesh names",
    ),
    (
        r".*solid/close_components.py find_unclosable_components",
        r"np\.any\(edges\.count > 2\) and .*|edges\.count > 2|mesh\.number > 1",
        r"\(np\.any\(.*\) or .*\)|\(np\.any\(edges\.count > 2\)\)|\(mesh\.number >=? 1\)|\(edges\.count (<=|>=) 2\)",
        "the edges of components, found once more, are the same",
    ),
    (
        r".*solid/closedness.py integrate_and_prove",
        r"partial\(.*",
        r"\(partial\(polyhedron_moments, surface, area_order=3 if shell else 0, "
        r"(threads=threads|planarity=accumulator), allow_open=True\)\)",
        "with how many threads is summed; where faces are looked at",
    ),
    (r".*shape/flat_pose.py flat_symmetry", r"operations @ mirror", r"\(mirror @ operations\)", "the same mirrors"),
    (
        r".*shape/flat_pose.py _best_angles",
        r"np\.argsort\(.*, kind=.stable.\)",
        r"\(np\.argsort\(-overlap\[peaks\]\)\)",
        "which of equally good turns is tried first",
    ),
    (
        r".*shape/registration.py best_rotation",
        r"np\.argsort\(least, kind=.stable.\)",
        r"\(np\.argsort\(least\)\)",
        "which of those that are as near by their first points is looked at first",
    ),
    (
        r".*shape/zernike.py zernike_quadrature",
        r"POINTS_PER_BLOCK // len\(u\)",
        r"\(POINTS_PER_BLOCK \* len\(u\)\)",
        "how much is computed at a time",
    ),
    (r".*density/threshold_cells.py _square", r"square if not \(.*", r"\(square \+ .*", "zeros are added"),
    (r".*shape/zernike.py radial_power", r"n - l", r"\(n \+ l\)", "the sign of all terms alike"),
    (
        r".*shape/(zernike.py descriptor_error|flat_signature.py flat_signature)",
        r"(moments\.)?raw \* .*|1\.0 \+ .*|-?8\.0( \* U)?",
        r"\((moments\.)?raw / .*|\(1\.0 - .*|\(?-?16\.0( \* U)?\)?",
        "by how much, and which way, each is moved for an estimate",
    ),
    (
        r".*offset/(walls.py OffsetSolid\.(self_intersects|_overlaps)|wall_moments.py wall_moments)",
        r"(self\.triangles|start|stop) \+ count",
        r"\(.* - count\)",
        "the same point, counted from the end",
    ),
    (r".*mesh/edges.py _sides_at", r"EDGES_PER_BLOCK // size", r".*", "room for more sides"),
    (
        r".*solid/self_intersection.py measure_excess",
        r".* \+ (crossings\.(row|column)|of_part)",
        r"\(.* - (crossings\.(row|column)|of_part)\)",
        "each line, and each part on it, has a number of its own still",
    ),
    (r".*solid/nesting.py _interior_samples", r"k \* 0\.\d+", r"\(k / .*\)", "which places are tried"),
    (r".*offset/walls.py first_positive_root", r"16\.0", r"32\.0", "a looser bound"),
    (r".*offset/walls.py offset_solid", r"4\.0", r"8\.0", "a looser bound"),
    (r".*offset/walls.py offset_solid", r"jacobian\[.* \* signs\[.*", r"\(.* / signs\[.*", "times -1 is by -1"),
    (r".*offset/directions.py (MAXIMIN_STEPS|SMOOTHING_STEPS|)", r"400", r"401", "how long is searched"),
    (r".*offset/directions.py _smooth_in_plane", r"break", r"continue", "it goes on to no avail"),
    (
        r".*offset/directions.py _smooth_in_plane",
        r"able\[triangles\]\.any\(axis=1\)",
        r"\(able\[triangles\]\.any\(\)\)",
        "what cannot move is looked at as well",
    ),
    (r".*", r".*\.take\(.*, mode=.clip.\)", r"\(.*\.take\(((?!mode=).)*\)\)", "every index is one of the array's"),
    (
        r".*density/threshold.py _Sums._add_(masses|boxes)",
        r"\(self.order \+ 1\) // 2",
        r"\(\(self.order \+ 1\) \* 2\)",
        "a rule of more points is as exact",
    ),
    (r"operators/actions/.*", r"(made|mesh)\.free\(\)", r"pass", "what nothing names any more is freed"),
    (r"operators/command/simplex.py answer", r"turned \* np\.tile\(signs.*", r"\(turned / .*", "times -1 is by -1"),
    (
        r"operators/bodies/shape.py SurfaceDistance.__init__",
        r"np\.argsort\(.*, kind=.stable.\)",
        r"\(np\.argsort\(((?!kind=).)*\)\)",
        "which of equally far points are taken",
    ),
    (
        r"operators/actions/setup/node_group.py .*",
        r".*\.new_socket\(\"\w+\", in_out=.INPUT., .*",
        r"\(.*\.new_socket\('\w+', socket_type=.*",
        "the default",
    ),
    (
        r"operators/actions/setup/node_group.py .*",
        r".*\.new_socket\(.*, socket_type=.NodeSocketFloat.\)",
        r"\(.*\.new_socket\('\w+', in_out='\w+'\)\)",
        "the default",
    ),
    (
        r"operators/scene/transforms.py euler_angles",
        r"first \+ pi",
        r"\(first - pi\)",
        "the same turn, the other way",
    ),
    (
        r"operators/actions/measure/library.py .*_watch",
        r"time\.sleep\(_PAUSE\)",
        r"pass",
        "how often is looked",
    ),
    (r".*", r".*\.astype\([^()]*copy=False\)", r"\(.*\.astype\([\w.]+\)\)", "a copy"),
    (
        r".*",
        r".* > MAX_(CUT_CELLS|SINGLE_UPDATES|EDGE_PAIRS|END_PAIRS|FACES_HIGH_ORDER|DIGESTED_FACES)",
        r"\(.* >= MAX_\w+\)",
        "how much is computed or kept at a time",
    ),
    (
        r".*(any_order.py .*|any_order_kernel.py absolute_sums|plane/region_moments.py BOUND_ROUNDING)",
        r"1e-9",
        r"1\.0000000000000002e-06",
        "a looser bound",
    ),
    (r".*triangle_kernel.py _morton_code", r"(?!return).*", r".*", "the order in which triangles are summed"),
    (r".*any_order.py _CompensatedSum.add", r"columns \* .*", r".*", "how much is computed at a time"),
    (
        r".*polyhedron/third_order.py integrate",
        r"room //.*|count (//|<= MAX_SMALL).*",
        r".*",
        "how much is computed at a time",
    ),
    (
        r".*shape/(symmetry.py confirm|flat_pose.py holds_by_outline)",
        r".*// FIRST_SAMPLES",
        r".*",
        "which are looked at first",
    ),
    (r".*solid/self_intersection.py SelfIntersection.effect", r"0\.0", r"1\.0", "read only where something was found"),
    (r".*nurbs/incremental.py .*_evaluate", r"False", r"True", "read only where rules are compared"),
    (r".*nurbs/patch_topology.py _overlapping_sides", r"0", r"1", "each of the two runs as the other does"),
    (
        r".*density/spline_grid.py _moments_about",
        r"added if block\.min\(\) >= 0\.0 else (contract\(np\.abs\(block\), factors\))",
        r"\(contract\(np\.abs\(block\), factors\)\)",
        "what is nowhere negative is its own absolute value",
    ),
    (
        r".*numerics/graph.py .*",
        r"np\.arange\((.*), dtype=.*\)|-number",
        r"\(np\.arange\([\w()]+\)\)|\(number\)",
        "in how many bytes nodes are numbered",
    ),
    (
        r".*mesh/convex_hull.py _first_corners",
        r"GRID_BITS - 1|grid - 2\.0 \*\* \(GRID_BITS - 1\)",
        r"\(GRID_BITS \+ 1\)|\(grid \+ 2\.0 \*\* \(GRID_BITS - 1\)\)",
        "the farthest from any place is at a corner",
    ),
    (
        r".*nurbs/patch_moments.py integrand_in_blocks",
        r"POINTS_PER_BLOCK // .*|sum\(rule\[0\]\) \* .*|len\(cells\) <= step",
        r".*",
        "how much is computed at a time",
    ),
    (r".*nurbs/patch_moments.py MAX_POINTS", r"6_000_000", r".*", "when more is given up"),
    (
        r".*nurbs/patch_moments.py .*",
        r"kinks \+ steep",
        r"\(kinks - steep\)",
        "neither is negative, and both are never the same",
    ),
    (
        r".*mesh/scan_lines.py LineGrids.through_points",
        r"4\.0",
        r"8\.0",
        "how much of the body's surroundings is the line's own",
    ),
    (
        r"panels/.*",
        r"[\w.]+\([^()]*\balign=True[^()]*\)",
        r"\([\w.]+\(((?!align=).)*\)\)",
        "whether the corners between two rows are round",
    ),
    (r".*supervisor/pool.py Pool.__init__", r"4 \* count|4|8", r".*", "more threads than read at a time"),
    (
        r".*supervisor/pool.py Pool._receive",
        r"self\._tasks and self\._has_grown\(child\)",
        r"\(self\._has_grown\(child\)\)",
        "where nothing is left to do a child may end",
    ),
    (r".*supervisor/pool.py Pool._pause", r"(?!return|max).*", r".*", "how often is looked"),
    (r".*supervisor/pool.py Pool._receive", r"self\._give\(child\)", r"pass", "the next step gives it"),
    (
        r"operators/(supervisor/pool|write/file_lock|actions/measure/library).py _(STEP|WATCH|PAUSE|GROWTH_PERIOD)",
        r".*",
        r".*",
        "how often is looked",
    ),
    (
        r"operators/supervisor/(pool|processes|whole_run).py (START_LIMIT|_END|_STOP|MAX_FAILED_STARTS|GROWTH)",
        r".*",
        r".*",
        "how much patience there is with a process that hangs, fails or grows",
    ),
    (
        r"operators/(read|scene|bodies)/.*",
        r"(read_object|mesh_surface)\(.*, edges=False\)",
        r"\((read_object|mesh_surface)\(((?!edges=).)*\)\)",
        "read, and not looked at where nothing is to be proved closed",
    ),
    (
        r"operators/bodies/hull.py object_hull",
        r"len\(part\.matrices\) > 1|_corners\(.* if len\(part\.matrices\) > 1 else .*",
        r".*",
        "the hull of hulls is that of their points, found sooner",
    ),
    (
        r"operators/session/assembly.py kept_up_to_date",
        r'"body_fingerprint" in root and is_assembly\(root\)',
        r".*",
        "what is no assembly, or is not stored, is left out later",
    ),
    (r".*any_order.py .*_ordered_results", r"len\(waiting\) > .*", r".* >= .*", "how many tasks wait at a time"),
    (r".*streams/ply_rows.py RowReader._read_ahead", r"len\(self._buffer\) < count", r".* <= .*", "what is read ahead"),
    (
        r".*papers/.*_phi.py _integrals",
        r"space.order - 1",
        r"\(space.order \+ 1\)",
        "a rule of more points is as exact",
    ),
    (
        r".*plane/polygon.py _steep_side_windings",
        r"float\(high.max\(\) - low.min\(\)\) or 1\.0",
        r".*1\.0",
        "of how many edges is looked at both sides",
    ),
    (
        r".*plane/polygon.py _steep_side_windings",
        r"1\.0 / RAYS_PER_BLOCK|float\(\(high - low\)\.mean\(\)\) / .*|RAYS_PER_BLOCK / len\(edges\)",
        r".*",
        "of how many edges is looked at both sides",
    ),
    (r".*plane/polygon.py _steep_side_windings", r"up > 0", r"\(up >= 0\)", "what is not crossed adds nothing"),
    (
        r".*plane/polygon.py _crossing_pairs",
        r"high\.max\(axis=0\)( - .*)?|low\.min\(axis=0\)|2\.0 \* float\(span\.mean\(\)\)|size / GRID_CELLS",
        r".*",
        "how coarse the grid is",
    ),
    (
        r".*plane/polygon.py _steep_side_windings",
        r"\(high >= y\.min\(\)\) & \(low <= y\.max\(\)\)",
        r".* \| .*",
        "each of them is looked at more closely",
    ),
    (r".*plane/polygon.py _crossing_pairs", r"break", r"continue", "it goes on to no avail"),
    (
        r".*density/piecewise_mass.py _block_size",
        r"TRIANGLES_PER_BLOCK \* 20 // .*",
        r"\(TRIANGLES_PER_BLOCK \* 20 \* .*",
        "how much is computed at a time",
    ),
    (
        r".*density/spline_grid.py _moments_about",
        r"np\.argsort\(.*, kind=.stable.\)|-abs\(stride\)",
        r".*",
        "in which order axes are contracted",
    ),
    (
        r".*fourier/triangle_kernel.py SortedTriangles._sort",
        r"np\.argsort\(.*, kind=.stable.\)",
        r".*",
        "the order in which triangles are summed",
    ),
    (
        r".*fourier/(transform.py Transform._run_task|triangle_kernel.py PhaseMeans._by_series)",
        r"np\.multiply\((real, weight|imaginary, weight|a, b), out=\w+\)",
        r"\(.*\)",
        "where a value is stored",
    ),
    (
        r".*fourier/transform.py Transform.__init__",
        r"polyhedron_moments\(.*",
        r"\(polyhedron_moments\(surface, area_order=0, allow_open=True\)\)",
        "with how many threads moments are summed, which are the same",
    ),
    (
        r".*numerics/graph.py connected_neighbors",
        r"np\.minimum\(parent, column, out=parent\)",
        r".*",
        "what is not joined by its lowest neighbors is joined by all of its links",
    ),
    (
        r".*scans/numpy_files.py _unpack",
        r"np\.lib\.format\.read_array\(.*",
        r"\(np\.lib\.format\.read_array\(file\)\)",
        "the default",
    ),
    (
        r".*polyhedron/third_order.py _Integration.block_sums",
        r"parts\.sort\(key=itemgetter\(0\)\)",
        r"\(parts\.sort\(\)\)",
        "no two have the same number",
    ),
    (
        r".*(density/spline_tables.py SplineAxis.uniform|fourier/wave_vectors.py FrequencyGrid.axis)",
        r"np\.arange\(.*, dtype=np\.float64\)",
        r"\(np\.arange\(((?!dtype).)*\)\)",
        "whole numbers make numbers of eight bytes of the others",
    ),
    (
        r".*polyhedron/third_order_kernel.py BlockAccumulator._find_flipped",
        r"np\.einsum\(.*, out=workspace\.cosine\)",
        r"\(np\.einsum\(.*\)\)",
        "where a value is stored",
    ),
    (r".*density/threshold.py (RULES|MAX_CUT_CELLS)", r"\d+", r"\d+", "which rules are compared, of how many cells"),
    (
        r".*fourier/(grid.py MAX_POINTS_PER_SIDE|nufft.py ALIASED_ORDERS|polygon.py SERIES_TERMS)",
        r"\d+",
        r"\d+",
        "a term, or points, more than are needed",
    ),
    (
        r".*fourier/(transform.py ZERO_WAVE_NUMBER|triangle_kernel.py (MORTON_CELLS|TINY))",
        r"[\d.e-]+",
        r".*",
        "another number as small, another order of the triangles",
    ),
    (
        r".*fourier/triangle_kernel.py SPLIT_SERIES_TERMS",
        r"2\.0|MAX_SERIES_SQUARE \* 2\.0 / 3\.0",
        r"4\.0|\(MAX_SERIES_SQUARE \* 2\.0 \* 3\.0\)",
        "more terms of a series than are needed",
    ),
    (r".*fourier/triangle_kernel.py MAX_SERIES_SQUARE", r"1\.0", r"2\.0", "which of two forms is taken"),
    (r".*statics/support.py ON_EDGE", r"4\.0", r"8\.0", "another number as small"),
    (r".*numerics/graph.py connected_neighbors", r"other < own", r"\(other >= own\)", "each link from its other end"),
    (
        r".*streams/ply.py PlyFile.pieces",
        r"corners\.dtype == np\.int32|np\.int32 if corners\.dtype == .*",
        r".*",
        "in how many bytes corners are numbered",
    ),
    (
        r".*density/smooth_threshold.py smooth_threshold_body",
        r"\(spline_order \+ 1\) // 2",
        r"\(\(spline_order \+ 1\) \* 2\)",
        "more of the background, where no body is",
    ),
    (
        r".*nurbs/patch_topology.py _close_pairs",
        r"1\.0 / np\.sqrt\(.*|np\.argsort\(line, kind=.stable.\)",
        r"\(1\.0 \* .*|\(np\.argsort\(line\)\)",
        "along which line they are compared, in which order",
    ),
    (
        r".*nurbs/patch_topology.py _pair_sides.join",
        r"\(a, b\) if size\[a\] >= size\[b\] .*|size\[a\] >= size\[b\]",
        r".*",
        "which of two stands for both",
    ),
    (
        r".*plane/polygon.py _crossing_pairs",
        r"2 \* GRID_CELLS",
        r"\(2 / GRID_CELLS\)",
        "cells that share a number give more pairs, which are looked at like all others",
    ),
    (r".*plane/polygon.py boundary_edges", r"net\[:, None\] < 0", r".* <= 0\)", "what adds up to zero is left out"),
    (r"operators/scene/dependents.py SAMPLES", r"64", r"65", "how many of a body's points are compared"),
    (r".*scans/scan.py PACKED", r"\d+", r"\d+", "how much is unpacked at a time"),
    (
        r".*cad/obj.py _indices",
        r"numbers > 0",
        r"\(numbers >= 0\)",
        "zero becomes less than none or more than all there are",
    ),
    (
        r".*polyhedron/(any_order.py (SCRATCH_NUMBERS|MAX_UNSCALED_EXPONENT)|third_order.py "
        r"(SCRATCH_BYTES|MAX_SMALL_TRIANGLES|MIN_TRIANGLES_TO_PAIR)|workspace.py (ROW_PADDING|MAX_ARRAYS))",
        r"[\d_]+",
        r"\d+",
        "how much is computed at a time, and where and how it is stored",
    ),
    (
        r".*polyhedron/third_order_kernel.py (MIN_FLIP_COSINE|FLOAT32_UNDERFLOW|FLOAT32_OVERFLOW)",
        r".*",
        r".*",
        "how many quads are looked at more closely",
    ),
    (r".*polyhedron/third_order.py MAX_UNSCALED_REACH", r"100", r"101", "a power of two, by which nothing is rounded"),
    (
        r".*density/voxel_fill.py inside_moments",
        r"centers\[.*\] > 0",
        r"\(centers\[.*\] >= 0\)",
        "a piece in a side of the grid adds nothing",
    ),
    (
        r".*polyhedron/any_order.py _StreamIntegrator._tasks",
        r"BLOCKS_PER_TASK if .*|self\.threads == 1|blocks // .*",
        r"((?! / ).)*",
        "how much is handed out at a time",
    ),
    (
        r".*polyhedron/any_order_kernel.py AnyOrderKernel.block_sums",
        r"size if k > .*|k > 0\.9 \* size",
        r".*",
        "how much of a block is filled up",
    ),
    (
        r".*polyhedron/third_order.py integrate",
        r"min\(MAX_TRIANGLES_PER_BLOCK, .* // 2|each \* size",
        r"\(min\(.* \* 2\)|\(each / size\)",
        "how much is computed at a time",
    ),
    (
        r".*numerics/arrays.py first_occurrence",
        r"np\.arange\(.*, dtype=.*\)|-len\(key\)",
        r"\(np\.arange\(((?!dtype).)*\)\)|\(len\(key\)\)",
        "in how many bytes rows are numbered",
    ),
    (
        r".*streams/ply_rows.py RowReader._table",
        r"self\._read_ahead\(.*|min\(left \* row\.itemsize, .*|left \* row\.itemsize",
        r".*",
        "what is read ahead",
    ),
    (
        r".*polyhedron/third_order.py _error_bounds",
        r"np.array\(sizes\).* \* \(1\.0 \+ 1e-9\)",
        r".* / \(1\.0 \+ 1e-09\)\)",
        "a billionth of a bound that is larger by more",
    ),
    (
        r".*solid/solid_stack.py measure_stack",
        r"links.is_open.any\(\) and .*",
        r"\(\(made := .*",
        "nothing closed is capped",
    ),
    (
        r".*canonical_frame.py _maximize_on_sphere",
        r"np.eye\(3\) - points.*",
        r"\(np.eye\(3\) \+ points.*",
        "along the sphere one is the other, and where it is level they agree",
    ),
    (
        r".*axial_harmonics.py AxialHarmonics.in_frame",
        r"frame\[:, \d\] @ base\[:, \d\]",
        r"\(base\[.*",
        "the product of two vectors, either way",
    ),
    (
        r".*canonical_stack.py _choose",
        r"first\.argsort\(axis=1\)",
        r"\(first\.argsort\(\)\)",
        "the last axis is the second",
    ),
    (
        r".*canonical_frame.py _maximize_on_sphere",
        r"\(degree \* MAX_START_GAP\) \*\* 2 / 4\.0",
        r".* \* 4\.0\)",
        "more directions are followed",
    ),
    (
        r".*(axial_harmonics.py turn_by_harmonics|canonical_frame.py _fix_rotation_about_axis)",
        r"np\.angle\(.* \+ 2\.0 \* np\.pi \* np\.arange\(m\)",
        r"\(.* - 2\.0 \* np\.pi \* np\.arange\(m\)\)",
        "the same turns, the other way",
    ),
    (
        r".*scene/transforms.py set_rotation_and_scale",
        r"np\.array\(obj.*\* delta_scale",
        r".*/ delta_scale\)",
        "its signs",
    ),
    (
        r".*(mesh/edges.py edges_from_mesh|solid/(cap_holes.py cap_holes|close_components.py _?find_\w+))",
        r".* \* (width|len\(mesh\.points\))( \+ .*)?",
        r"\(.*( / (width|len\(mesh\.points\))|(width|len\(mesh\.points\)) - .*)\)",
        "one number of two: of others it is another",
    ),
    (r".*nurbs/planar_region.py MAX_CHORDS", r"8192", r"8193", "of chords there are multiples of 64"),
    (
        r".*statics/balance.py _Fans.center_gradient",
        r"(area|volume)_gradient\(.*, order=1\)",
        r"\((area|volume)_gradient\(((?!order=).)*\)\)",
        "more derivatives, which are not read",
    ),
    (r".*statics/support.py ground_axes", r"first @ up", r"\(up @ first\)", "the product of two vectors, either way"),
    (
        r".*fourier/grid.py GridTransform._counts",
        r"not len\(tried\) or np\.array_equal\(fewer, before\)",
        r".*",
        "what was compared before, or is nothing, is compared to the same end",
    ),
    (
        r".*statics/resting.py _coplanar",
        r"np\.argsort\(.*, kind=.stable.\)",
        r".*",
        "which of the largest triangles tells a face's plane",
    ),
    (
        r".*any_order_small.py extend_small_moments",
        r"b - a",
        r"\(b \+ a\)",
        "the determinant of a, b and c in either way, as well within its bound",
    ),
    (r"panels/rows.py DEFAULT_WIDTH", r"\d+", r"\d+", "a pixel of a panel whose width is not known"),
]
# places of constants, and what stands ahead of them in their line: the reason
CONSTANTS = [
    (r".*", r"\breshape\(([^()]|\([^()]*\))*-", "numpy finds out a length from any negative number"),
    (r"operators/bodies/bare_file.py bare_reading", r"kind, np\.eye\(", "where no object is, its matrix is not read"),
    (r".*finite/numbers.py _large", r"ord\(\"0\"\)\) < ", "more is looked at closely, and found to be no number"),
    (r".*supervisor/lifeline.py end_with", r"ready\.poll\(", "a thousandth of a second is waited"),
    (r".*supervisor/lifeline.py Lifeline.__init__", r"ThreadPoolExecutor\(", "room for a thread that nothing starts"),
    (r".*write/thumbnail.py thumbnail", r"steps \+ \(right, up, ", "how deep an axis is, which is drawn over the body"),
    (r".*write/whole_file.py whole_file", r"os\.O_WRONLY \|.*\"O_BINARY\", ", "the number of O_WRONLY, which is there"),
    (r".*command/output.py claim_stdout", r"channel = -", "any negative number is no descriptor"),
    (r"operators/bodies/hull.py object_hull", r"len\(part\.matrices\) > ", "the hull of hulls is that of their points"),
    (
        r"operators/bodies/audit.py _ball",
        r"turn = .*\(1\.0 \+ ",
        "other points that are spread as well hold the ball too",
    ),
    (r"operators/read/sample_grid.py SampledGrid.__init__", r"sample\(low - ", "any place beyond the grid"),
    (r"operators/(read|scene|bodies)/.*", r"\bedges=", "read, and not looked at where nothing is to be proved closed"),
    (r"operators/session/shown.py _shown_now", r"last is None or last\[", "what was found is found once more"),
    (r"operators/session/live.py _measure", r"norm\(matrix\[:", "the first three numbers of the last row are 0"),
    (r".*session/listing.py _listing", r"lines = \[", "each is written over"),
    (r"panels/.*", r"\balign=", "whether the corners between two rows are round"),
    (r".*mesh/side_pairs.py _paired_by_sorting", r"high << np.uint64\(", "of vertices there are fewer than 2^30"),
    (r".*solid/nesting.py _interior_samples", r"weight = .*", "which places are tried"),
    (r".*shape/(symmetry.py confirm|flat_pose.py holds_by_outline)", r"points\[:: ", "which are looked at first"),
    (r".*density/threshold.py threshold_body", r"// ", "a reference point near the middle"),
    (r".*density/piecewise_mass.py _block_size", r"TRIANGLES_PER_BLOCK \* ", "how much is computed at a time"),
    (r".*moments/normalized.py normalize", r"trace = .* else ", "not read"),
    (r".*third_order_kernel.py _BlockCalls.__init__", r"self\.room = spare\[:, ", "where a value is stored"),
    (r".*solid_harmonics.py harmonic_moments", r"in range\(order // 2 \+ ", "of no degree is left any l"),
    (r".*moments/images.py sum_of_images", r"block = max\(.*", "how much is computed at a time"),
    (
        r".*(fourier/(grid|nufft|polygon|transform)|polyhedron/sheared_areas).py .*",
        r"\b(size|step)(, sums)? = (np\.zeros\(.*\), )?max\(([\d]+, [A-Z_]+ // max\()?",
        "how much is computed at a time, at least",
    ),
    (r".*fourier/transform.py Transform._to_transform", r"np\.where\(nothing, ", "written over"),
    (r".*fourier/wave_vectors.py wave_vectors", r"max\(initial=", "smaller than what is too large"),
    (r".*fourier/polygon.py _sinc_minus_one", r"np\.where\(large, t, ", "not taken"),
    (r".*polyhedron/third_order(_small)?.py _error_bounds", r"moved_reach, ", "what is divided is zero"),
    (r".*moments/affine_maps.py are_singular", r"(largest|lengths), ", "what is divided is zero"),
    (r".*moments/affine_maps.py absolute_moments", r"np\.isfinite\(reach\), reach, ", "a factor of zero"),
    (r".*density/threshold_cells.py columns_of", r"np\.where\(floor >= 0\.0, (2\.0, -)?", "any place beyond the cell"),
    (r".*density/threshold_cells.py _smooth_intervals", r"low / \(low - high\), ", "an end of the interval"),
    (r".*fourier/transform.py Transform._tasks", r"^ *(1, .*, )?", "how much is handed out at a time, at least"),
    (
        r".*polyhedron/any_order.py _StreamIntegrator._tasks",
        r"^ *BLOCKS_PER_TASK if .*",
        "how much is handed out at a time",
    ),
    (r".*polyhedron/n_dimensions.py _measure", r"NUMBERS_PER_BLOCK // \(", "how much is computed at a time"),
    (r".*polyhedron/third_order.py integrate", r"size = max\(.*", "how much is computed at a time"),
    (r".*polyhedron/any_order_kernel.py AnyOrderKernel.block_sums", r"if k > ", "how much of a block is filled up"),
    (r".*streams/stl.py ", r"TRIANGLES_PER_BLOCK, TRIANGLES_IN_CACHE = .*", "how much is read at a time"),
    (r".*polyhedron/third_order.py _Integration.blocks", r"size // ", "how much is computed at a time"),
    (r".*fourier/grid.py _trial_vectors", r"np\.eye\(3\), \[\[.*", "in which directions waves are tried"),
    (r".*polyhedron/third_order_kernel.py BlockAccumulator._find_flipped", r"return .*index\[", "an empty array"),
    (r".*fourier/polygon.py RegionTransform.__init__", r"else np\.zeros\(\(", "there is nothing anyway"),
    (r".*polyhedron/third_order_kernel.py _BlockCalls.__init__", r"np\.empty\((0\), np\.empty\()?", "not read"),
    (r".*numerics/compensated.py SPLITTER", r"2\.0\*\*27 \+ ", "one splits numbers as the other does"),
    (r".*density/threshold_cells.py columns_of", r"middle = .*length / ", "any place between the two"),
    (r".*fourier/triangle_kernel.py SortedTriangles._sort", r"octave << ", "the order in which triangles are summed"),
    (r".*fourier/nufft.py Spreading.add", r"np\.argsort\(positions\[", "the order in which points are spread"),
    (r".*streams/ply.py PlyFile._read_points", r"len\(block\[columns\[", "each of its columns has as many rows"),
    (r".*cad/obj.py _Reader._statements", r"line\.split\(None, ", "the first word alone is read"),
    (r".*cad/iges.py _Reader._pieces", r"straight=", "two points are both on a side, or the piece is on none"),
    (r".*scans/numpy_files.py _npz_header", r"file\.peek\(", "what is behind the length is not looked at"),
    (
        r".*density/threshold.py _Sums._add_(masses|boxes)",
        r"(self\.order|// 2) \+ ",
        "a rule of more points is as exact",
    ),
    (r".*density/threshold.py _interval_moments", r"order // 2 \+ ", "a rule of more points is as exact"),
    (
        r".*density/smooth_threshold.py smooth_threshold_body",
        r"margin = \(spline_order \+ ",
        "more of the background, where no body is",
    ),
    (r".*streams/stl.py TEXT_PER_TRIANGLE", r"= ", "how many triangles a text has is estimated"),
    (r".*streams/stl.py StlFile.__init__", r"TEXT_PER_TRIANGLE \+ ", "how many triangles a text has is estimated"),
    (
        r".*numerics/arrays.py unique_pairs",
        r"pairs\.max\((initial=|initial=0\)\) \+ )",
        "any larger width tells pairs apart",
    ),
    (
        r".*numerics/arrays.py first_occurrence",
        r"(bits = int\(|\(64 if |np\.uint64\(|np\.empty\()",
        "how large a table is",
    ),
    (r".*statics/resting.py resting_poses", r"np\.round\(shares\[kept\], ", "shares that are equal but for rounding"),
    (
        r".*statics/(resting.py .*|balance.py _center_jacobian|gradient.py _area_shares|support.py polygon_margin)",
        r"np\.where\(\w+ > 0\.0, \w+(\*\*2)?, ",
        "what is divided is zero",
    ),
    (r".*statics/resting.py _coplanar.*", r"points\[triangles\[(triangle|base), ", "any corner is in the plane"),
    (
        r".*statics/support.py (find_support|support_of_contacts)",
        r"down: ArrayLike = \(0\.0, 0\.0, -",
        "of gravity only the direction counts",
    ),
    (r".*statics/mixes.py fit_mixes", r"range\(DEGREE \+ ", "what is of a higher degree is left out"),
    (r".*statics/gradient.py .*", r"kinds > ", "of orders 0, 1 and 2 there are 1, 4 and 10 moments"),
    (
        r".*density/spline_grid.py _moments_about",
        r"block\.min\(\) >= ",
        "what is nowhere negative is its own absolute value",
    ),
    (r".*density/spline_grid.py _absolute_moments", r"np\.arange\(order \+ ", "a power that nothing reads"),
    (r".*density/voxel_fill.py inside_moments", r"(units = (40 \+ )?|math\.log2\(terms \+ )", "a looser bound"),
    (r".*density/threshold_cells.py Cells.column_axes", r"steps\.min\(axis=2\) \+ ", "which of several axes is taken"),
    (
        r".*offset/directions.py .*",
        r"np\.where\((length|square|independent)( > 0\.0)?, (length|square|values), ",
        "what is divided is zero, or left out",
    ),
    (r".*offset/directions.py _corner_geometry", r"np\.where\(solid, double, ", "not read"),
    (r".*offset/walls.py _Prisms.swept", r"self\.double > 0\.0, self\.double, ", "what is divided is zero"),
    (r".*shape/zernike.py zernike_quadrature", r"step = max\(", "how much is computed at a time, at least"),
    (r".*offset/wall_moments.py _strip_moments", r"step = max\(", "how much is computed at a time, at least"),
    (
        r".*mesh/planarity.py PlanarityAccumulator.add_triangles",
        r"len\(normal\), (0, )?",
        "of triangles it is not read",
    ),
    (
        r".*mesh/edges.py edges_from_mesh",
        r"begins\[quad_faces\]\[:, None\] \+ \(np\.arange\(",
        "a column that is not read",
    ),
    (r".*shape/flat_pose.py flat_symmetry", r"np\.empty\(\(0, ", "an empty array"),
    (r".*shape/flat_pose.py NEWTON_STEPS", r"= ", "how long is searched"),
    (r".*mesh/welding.py _first_of_clusters", r"np\.ndindex\((2, )*", "a shift by a whole cell more"),
    (r".*solid/self_intersection.py measure_excess", r"int\(of_part\.max\(\)\) \+ ", "room for a part more"),
    (r".*solid/shared_walls.py wall_links", r"int\(wall\.max\(\)\) \+ ", "room for a wall more"),
    (r".*solid/orientation.py orient_components", r"counted = np\.ones\(", "of one component, one is read"),
    (r".*solid/solid_stack.py _stand_apart", r"apart = ", "which bodies are measured by themselves, as well"),
    (r".*shape/zernike.py radial_power", r"np\.float64\), order \+ ", "a term more of a tail"),
    (r".*mesh/edges.py edges_from_mesh", r"width = int\(triangles\.max\(\)\) \+ ", "room for a vertex more"),
    (r".*mesh/convex_hull.py _first_corners", r"GRID_BITS - ", "the farthest from any place is at a corner"),
    (r".*mesh/convex_hull.py _first_corners", r"heights\[fourth\] < ", "it is more than a step above or below"),
    (r".*mesh/scan_lines.py LineGrids.through_points", r"np\.zeros\(\(count, 2\)\), (1, )?", "there is nothing beyond"),
    (r".*fourier/grid.py ", r"SHARING_TIME, CHECKING_TIME = .*", "how time is estimated"),
    (r".*fourier/grid.py _points_per_side", r"np\.geomspace\(.*", "how fine and long the table is"),
    (r".*nurbs/patch_moments.py integrand_in_blocks", r"step = .*", "how much is computed at a time"),
    (r".*nurbs/patch_moments.py ", r"SLOPE_POINTS, SLOPE_SPANS = .*", "how fine a rule is, and how much at a time"),
    (r".*nurbs/patch_moments.py MIN_DIVISOR", r"= ", "any number that is next to nothing"),
    (r".*cad/obj.py has_surfaces", r"(file\.read\((1 << )?|block\[-)", "how much is read at a time"),
    (r".*cad/iges.py _spline_piece", r"part\[[01]\] != knots\[-?", "the ends' knots are the same there"),
    (r".*numerics/graph.py _trees", r"for start in range\(", "the first node is the first root"),
    (r".*numerics/graph.py _trees", r"parent\.dtype\.type\(", "where there is one tree, its number is not read"),
    (r".*numerics/graph.py connected_neighbors", r"for start in range\(", "there is none below the first"),
    (r".*", r"\bdefault_rng\(", "which numbers are drawn at random"),
    (r".*rigs/cuts.py (bones_of_caps|_cut_edges)", r"(max\(initial=|int\(.*\) \+ )", "room for a label more"),
    (r".*shape/symmetry.py _around_axis", r"n // 2 \+ ", "the same turns, the other way"),
    (r".*triangle_kernel.py SortedTriangles._sort", r"\+ 1100, (0, )?", "the order in which triangles are summed"),
    (r".*plane/section.py measure_section", r"np\.ones\(", "it is replaced"),
    (
        r".*plane/polygon.py _steep_side_windings",
        r"share = .*|max\(share, ",
        "of how many edges is looked at both sides",
    ),
    (r".*robots/plausibility.py Hull.distance", r"shifted\*\*", "with which of the points it begins"),
    (r".*plane/region_moments.py _swept", r"np\.vander\(column, order \+ ", "a power that nothing reads"),
    (r".*plane/polygon.py boundary_edges", r"net\[:, None\] < ", "what adds up to zero is left out"),
    (r".*plane/polygon.py _crossing_pairs", r"length\[length == 0\.0\] = ", "what is divided is zero"),
    (r".*plane/polygon.py _crossing_pairs", r"(size|cell) = .*", "how coarse the grid is"),
    (r".*plane/polygon.py _crossing_pairs", r"within // tall\[edge\]\) \* \(", "which other edges are compared"),
    (r".*plane/polygon.py _twice_the_area", r"points\[edges\[(0, )?", "a closed outline has its area from anywhere"),
    (
        r".*nurbs/patch_topology.py _close_pairs",
        r"(slope = |max\(initial=|limit \* slope\.sum\(\) \+ )",
        "along which line they are compared, and more of them",
    ),
    (r".*nurbs/patch_topology.py _coincident_sides", r"axis=1\)(\[arcs\])?, ", "more of them are compared"),
    (r".*nurbs/patch_topology.py _cap_loop", r"full_matrices=", "what is not read"),
    (r".*nurbs/solid.py assess", r"reach = size \+ ", "a looser bound"),
    (r".*read/section.py _axes", r"matrix\[:, :", "the last column is no shorter than one"),
    (r".*nurbs/solid.py measure_sheet", r"area\.total or ", "what is divided is zero"),
    (r".*nurbs/patch_topology.py _pair_sides", r"part, odd, size = [^\[]*\[", "it is set before it is read"),
    (r".*nurbs/patch_topology.py _pair_sides.root", r"turn = ", "whether two are turned alike is all that is read"),
    (r".*nurbs/creases.py _normals", r"patch\.points\[(0, )?", "slopes do not depend on the origin"),
    (r".*mass_properties.py _propagate_errors", r"\bshift\[", "for both kinds of errors it is the same"),
    (
        r".*third_moment_frames.py third_moment_frames",
        r"scale\[scale == 0\.0\] = |doubtful / np\.where\(equal, |np\.where\(span > 0\.0, span, ",
        "anything but zero, of which nothing comes",
    ),
    (r".*canonical_frame.py _extreme_directions", r"(noise = |max\()", "a looser bound"),
    (r".*shared_search.py _frames_alike", r"STEP\), ", "of what is not searched for"),
]
# functions that make bounds of errors, where a constant factor twice as large gives a bound still
LOOSER = {
    "core/inertia/canonical_frame.py _normalization",
    "core/inertia/canonical_stack.py _along_axes",
    "core/inertia/reference.py Reference.refer",
    "core/inertia/reference.py Reference.refer_moments",
    "core/plane/section.py _bounds",
    "core/plane/section.py projection_rounding",
    "core/polyhedron/any_order_kernel.py absolute_sums",
    "operators/bodies/given.py given_moments",
}
# (module, function, before, after): the reason
EQUIVALENT: dict[tuple[str, str, str, str], str] = {
    (
        "core/numerics/compensated.py",
        "SPLITTER",
        "2.0**27 + 1.0",
        "(2.0 ** 27 - 1.0)",
    ): "one splits numbers into two of 26 bits as the other does",
    (
        "operators/scene/reframe.py",
        "_transform_mesh",
        "mesh.update()",
        "pass",
    ): "it was marked as changed when it was transformed, and is evaluated later",
}


def reason(mutant: Mutant) -> str:
    """Why it changes nothing; "" for all others."""
    if mutant.is_imported:
        name = mutant.function.rpartition(".")[2]
        for pattern, why in NAMES.items():
            if re.search(pattern, name):
                return why
    path, function, before, after = mutant.key
    place, ahead = "{} {}".format(path, function), _ahead(mutant)
    is_doubled = re.fullmatch(r"\d+\.\d*", before) and after == repr(2.0 * float(before))
    if place in LOOSER and is_doubled and not ahead.endswith("/ "):
        return "a looser bound"
    if ahead.endswith("(-1.0) ** (") and after == "({})".format(before.replace(" + ", " - ")):
        return "both are even, or both odd"
    for where, old, new, why in PATTERNS:
        if re.fullmatch(where, place) and re.fullmatch(old, before) and re.fullmatch(new, after):
            return why
    if re.fullmatch(CONSTANT, before):
        for where, left, why in CONSTANTS:
            if re.fullmatch(where, place) and re.search("(?:{})$".format(left), ahead):
                return why
    return EQUIVALENT.get(mutant.key, "")


def _ahead(mutant: Mutant) -> str:
    """What stands ahead of the place in its line."""
    return _text(mutant.path)[: mutant.start].rpartition("\n")[2]


@lru_cache(maxsize=1)
def _text(path: str) -> str:
    return (ROOT / path).read_text(encoding="utf-8")
