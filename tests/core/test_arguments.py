# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Arguments of the core's public functions: lists are as good as arrays, and all others are refused
by name.
"""

import dataclasses
import re

import numpy as np
import pytest
from body_moments.core import (
    MassProperties,
    Moments,
    Surface,
    grid_moments,
    mass_properties,
    measure_solid,
    polyhedron_moments,
    principal_frame,
    signature,
    solid_transform,
)
from body_moments.core.density import threshold_body
from body_moments.core.flat import Plane, directed_edges, fit_plane, measure_section, region_moments
from body_moments.core.fourier import polygon_transform, surface_transform
from body_moments.core.inertia import combine, pose_matrix
from body_moments.core.mesh import convex_hull
from body_moments.core.numerics import SplineSpace, clamped_space, quaternion
from body_moments.core.nurbs import (
    Curve,
    Patch,
    length_moments,
    measure_patches,
)
from body_moments.core.polyhedron import enclosed_moments, facet_moments, facets_of
from body_moments.core.scans import Scan, sample_matrix
from body_moments.core.shape import rank, similarity, symmetry
from body_moments.core.statics import (
    area_gradient,
    balance,
    find_support,
    resting_poses,
    volume_gradient,
)
from body_moments.core.wall import offset_solid, wall_moments

POINTS = np.eye(4, 3, -1) * (3.0, 2.0, 1.0)
TRIANGLES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
SURFACE = Surface.from_triangles(POINTS, TRIANGLES)
VOLUME = polyhedron_moments(SURFACE, 6)[0]
CENTRAL = VOLUME.about_center()
PROPERTIES = MassProperties.from_moments(VOLUME)
SQUARE = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]])
EDGES = directed_edges([range(4)])
PLANE = Plane(np.zeros(3), np.eye(3), 0.0, "X")
FLAT_POINTS = np.column_stack([SQUARE, np.zeros(4)])
ORIGIN, AXES, MATRIX = np.zeros(3), np.eye(3), np.eye(4)
LINE = clamped_space(2)
CURVE_POINTS = np.array([[0.0, 0.0, 0.0], [3.0, 4.0, 0.0]])
CURVE = Curve(LINE, CURVE_POINTS)
PATCH_POINTS = np.array([[[0.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0]]])
PATCH = Patch((LINE, LINE), PATCH_POINTS)
SAMPLES = np.arange(8.0).reshape(2, 2, 2)
SHAPE = signature(CENTRAL, 2.0)
Q = np.array([[0.0, 0.0, 0.0], [1.0, 2.0, 3.0]])

# A function, and arguments that it takes.
CALLS = {
    "Curve": (Curve, {"space": LINE, "points": CURVE_POINTS, "weights": np.array([1.0, 2.0])}),
    "Curve.evaluate": (CURVE.evaluate, {"parameters": np.array([0.0, 0.5])}),
    "Curve.transform": (CURVE.transform, {"matrix": MATRIX}),
    "Hull.transform": (convex_hull(POINTS).transform, {"linear": AXES}),
    "MassProperties.from_moments": (
        MassProperties.from_moments,
        {"moments": VOLUME, "preferred_axes": AXES},
    ),
    "MassProperties.in_frame": (PROPERTIES.in_frame, {"rotation": AXES, "origin": ORIGIN}),
    "MassProperties.inertia_about": (PROPERTIES.inertia_about, {"point": ORIGIN}),
    "Moments": (
        Moments,
        {
            "raw": np.ones(4),
            "about": ORIGIN,
            "rounding_error": np.zeros(4),
            "input_error": np.zeros(4),
        },
    ),
    "Moments.about_point": (VOLUME.about_point, {"point": np.ones(3)}),
    "Moments.in_frame": (VOLUME.in_frame, {"rotation": AXES, "origin": ORIGIN}),
    "Moments.transform": (VOLUME.transform, {"matrix": MATRIX}),
    "Patch": (
        Patch,
        {
            "spaces": (LINE, LINE),
            "points": PATCH_POINTS,
            "weights": np.array([[1.0, 2.0], [3.0, 4.0]]),
        },
    ),
    "Patch.transform": (PATCH.transform, {"matrix": MATRIX}),
    "SplineSpace": (SplineSpace, {"knots": np.arange(4.0), "order": 2, "count": 2}),
    "Surface": (
        Surface,
        {
            "points": POINTS,
            "triangles": TRIANGLES,
            "quads": np.array([[0, 1, 2, 3]]),
            "displacement": ORIGIN,
        },
    ),
    "Surface.from_triangles": (Surface.from_triangles, {"points": POINTS, "triangles": TRIANGLES}),
    "Surface.transform": (SURFACE.transform, {"linear": AXES, "offset": ORIGIN}),
    "area_gradient": (area_gradient, {"surface": SURFACE, "about": ORIGIN}),
    "balance": (
        balance,
        {
            "surface": SURFACE,
            "movable": np.arange(4),
            "target": CENTRAL.about + 0.01,
            "across": AXES,
            "weights": np.ones(4),
        },
    ),
    "combine": (lambda bodies: combine([(bodies, 2.0)]), {"bodies": VOLUME}),
    "convex_hull": (convex_hull, {"points": POINTS}),
    "directed_edges": (lambda loops: directed_edges([loops]), {"loops": np.arange(4)}),
    "enclosed_moments": (
        enclosed_moments,
        {
            "points": POINTS,
            "simplices": TRIANGLES,
            "order": 2,
            "about": ORIGIN,
            "signs": np.ones(4),
        },
    ),
    "facet_moments": (
        facet_moments,
        {"points": POINTS, "simplices": TRIANGLES, "order": 2, "about": ORIGIN},
    ),
    "facets_of": (facets_of, {"points": POINTS, "simplices": np.array([[0, 1, 2, 3]])}),
    "find_support": (find_support, {"points": POINTS, "center": CENTRAL.about, "down": -AXES[2]}),
    "fit_plane": (
        fit_plane,
        {
            "points": FLAT_POINTS,
            "triangles": TRIANGLES[:1],
            "prefer": AXES,
            "origin": ORIGIN,
            "facing": AXES[2],
        },
    ),
    "grid_moments": (grid_moments, {"samples": SAMPLES, "shape": (2, 2, 2), "matrix": MATRIX}),
    "length_moments": (lambda curves: length_moments([curves]), {"curves": CURVE}),
    "mass_properties": (
        lambda points, triangles: mass_properties(points, triangles, density=1.0),
        {"points": POINTS, "triangles": TRIANGLES},
    ),
    "measure_patches": (lambda patches: measure_patches([patches]), {"patches": PATCH}),
    "measure_section": (measure_section, {"plane": PLANE, "points": FLAT_POINTS, "edges": EDGES}),
    "measure_solid": (measure_solid, {"surface": SURFACE}),
    "offset_solid": (offset_solid, {"surface": SURFACE}),
    "polygon_transform": (
        lambda loops, q: polygon_transform([loops], q),
        {"loops": SQUARE, "q": Q[:, :2]},
    ),
    "polyhedron_moments": (polyhedron_moments, {"body": SURFACE, "about": ORIGIN}),
    "pose_matrix": (pose_matrix, {"center": ORIGIN, "axes": AXES}),
    "principal_frame": (principal_frame, {"moments": VOLUME, "preferred_axes": AXES}),
    "quaternion": (quaternion, {"rotation": AXES}),
    "rank": (rank, {"query": SHAPE, "entries": []}),
    "region_moments": (
        region_moments,
        {"points": SQUARE, "edges": EDGES, "order": 2, "about": ORIGIN[:2]},
    ),
    "resting_poses": (resting_poses, {"hull": convex_hull(POINTS), "center": CENTRAL.about}),
    "sample_matrix": (
        sample_matrix,
        {
            "scan": Scan(SAMPLES, MATRIX),
            "spacing": np.ones(3),
            "origin": ORIGIN,
            "unit_scale": None,
        },
    ),
    "signature": (signature, {"moments": CENTRAL, "radius": 2.0}),
    "similarity": (similarity, {"a": SHAPE, "b": SHAPE}),
    "solid_transform": (solid_transform, {"surface": SURFACE}),
    "surface_transform": (surface_transform, {"surface": SURFACE, "q": Q}),
    "symmetry": (symmetry, {"moments": VOLUME}),
    "threshold_body": (threshold_body, {"samples": SAMPLES, "threshold": 3.5, "matrix": MATRIX}),
    "volume_gradient": (volume_gradient, {"surface": SURFACE, "about": ORIGIN}),
    "wall_moments": (
        wall_moments,
        {"wall": offset_solid(SURFACE), "inward": 0.0, "outward": 0.1, "order": 3},
    ),
}
CALLS["solid_transform"][1]["q"] = Q
ARRAYS = [
    (call, name)
    for call, (_, given) in CALLS.items()
    for name in given
    if isinstance(given[name], np.ndarray)
]
OBJECTS = [
    (call, name)
    for call, (_, given) in CALLS.items()
    for name, value in given.items()
    if type(value).__module__.startswith("body_moments")
]
# Wave vectors come from a user's file, and are refused as one.
ARRAYS_OF_CALLERS = [(call, name) for call, name in ARRAYS if name != "q"]


def numbers(result):
    """The numbers in a result, in a fixed order."""
    if dataclasses.is_dataclass(result):
        return [numbers(getattr(result, field.name)) for field in dataclasses.fields(result)]
    if isinstance(result, (tuple, list)):
        return [numbers(item) for item in result]
    return (
        np.asarray(result).tolist() if isinstance(result, (np.ndarray, np.generic, float)) else None
    )


@pytest.mark.parametrize(("call", "name"), ARRAYS)
def test_lists_give_the_same_as_arrays(call, name):
    function, given = CALLS[call]
    found, truth = (
        function(**{**given, name: value}) for value in (given[name].tolist(), given[name])
    )
    assert str(numbers(found)) == str(numbers(truth))


@pytest.mark.parametrize(("call", "name"), ARRAYS_OF_CALLERS)
def test_misshapen_arguments_are_refused_by_name_and_shape(call, name):
    function, given = CALLS[call]
    array = np.ones((7,) * (given[name].ndim + 2), given[name].dtype)
    if call in ("Moments.in_frame", "MassProperties.in_frame"):
        array = array[..., :2]  # there are stacks of these
    expected = r"{} must be \(.+\) (real numbers|integers), not {} {}"
    with pytest.raises(
        ValueError, match=expected.format(name, re.escape(str(array.shape)), array.dtype)
    ):
        function(**{**given, name: array})


@pytest.mark.parametrize(("call", "name"), ARRAYS_OF_CALLERS)
@pytest.mark.parametrize(
    "value",
    [object(), "text", [[1.0], [1.0, 2.0]], 1j],
    ids=["object", "text", "ragged", "complex"],
)
def test_nonnumeric_arguments_are_refused_by_name(call, name, value):
    function, given = CALLS[call]
    with pytest.raises(ValueError, match="{} must be".format(name)):
        function(**{**given, name: value})


@pytest.mark.parametrize(("call", "name"), OBJECTS)
def test_objects_of_another_class_are_refused_by_name(call, name):
    function, given = CALLS[call]
    with pytest.raises(
        (TypeError, ValueError), match=r"\b(surface|{}) must be a \w+, not".format(name)
    ):
        function(**{**given, name: 3.0})
