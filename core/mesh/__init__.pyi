# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from .boundary import BoundarySum as BoundarySum
from .box_pairs import boxes_overlap as boxes_overlap
from .box_pairs import overlapping_box_pairs as overlapping_box_pairs
from .bvh import Bvh as Bvh
from .bvh import SortedComponents as SortedComponents
from .bvh import sort_components as sort_components
from .bvh import tree_of_all as tree_of_all
from .correspondence import Correspondence as Correspondence
from .correspondence import Elements as Elements
from .correspondence import correspondences as correspondences
from .edges import Edges as Edges
from .edges import closed_side_faces as closed_side_faces
from .edges import consistent_orientation as consistent_orientation
from .edges import faces_beside_edges as faces_beside_edges
from .edges import find_edges as find_edges
from .edges import group_components as group_components
from .edges import ring_sizes as ring_sizes
from .edges import uncancelled_sides as uncancelled_sides
from .hulls import ConvexHull as ConvexHull
from .hulls import convex_hull as convex_hull
from .hulls import convex_polygon as convex_polygon
from .hulls import hull_volumes as hull_volumes
from .piercing import intersecting_pairs as intersecting_pairs
from .planarity import Planarity as Planarity
from .planarity import PlanarityAccumulator as PlanarityAccumulator
from .planarity import StackPlanarity as StackPlanarity
from .planarity import stack_planarity as stack_planarity
from .point_triangle import solid_angles as solid_angles
from .point_triangle import triangle_distances as triangle_distances
from .point_triangle import winding_number as winding_number
from .scan_lines import FACES_PER_BLOCK as FACES_PER_BLOCK
from .scan_lines import LINE_SLOPES as LINE_SLOPES
from .scan_lines import Crossings as Crossings
from .scan_lines import LineGrids as LineGrids
from .scan_lines import find_crossings as find_crossings
from .scan_lines import line_counts as line_counts
from .surface import HALVES as HALVES
from .surface import Surface as Surface
from .surface import face_of_each as face_of_each
from .surface import half_ulp as half_ulp
from .surface import has_flipped_corners as has_flipped_corners
from .surface import join_surfaces as join_surfaces
from .surface import keep_used as keep_used
from .surface import normals as normals
from .surface import triangle_areas as triangle_areas
from .surface import turned_quads as turned_quads
from .surface_stack import Connections as Connections
from .surface_stack import SurfaceStack as SurfaceStack
from .surface_stack import TriangleStack as TriangleStack
from .welding import first_at_equal_position as first_at_equal_position
from .welding import first_at_near_position as first_at_near_position
from .welding import may_have_neighbor as may_have_neighbor
from .welding import same_vertices_groups as same_vertices_groups
from .welding import vertex_tolerance as vertex_tolerance

__all__ = [
    "Surface",
    "convex_hull",
]

def __getattr__(name: str) -> Any: ...
