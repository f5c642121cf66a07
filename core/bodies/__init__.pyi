# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from .files import ArrayOptions as ArrayOptions
from .files import body_of_mesh as body_of_mesh
from .files import measure_array as measure_array
from .files import measure_faces as measure_faces
from .files import measure_labels as measure_labels
from .files import measure_mesh_file as measure_mesh_file
from .files import read_mesh as read_mesh
from .findings import DENSITY_DEFAULTED as DENSITY_DEFAULTED
from .findings import DENSITY_FROM_GRID as DENSITY_FROM_GRID
from .findings import DRAWN_AS_POLYGONS as DRAWN_AS_POLYGONS
from .findings import FAR_FROM_ORIGIN as FAR_FROM_ORIGIN
from .findings import GRID_AS_SHELL as GRID_AS_SHELL
from .findings import GRID_DENSITY as GRID_DENSITY
from .findings import GRID_EMPTY as GRID_EMPTY
from .findings import GRID_TOO_LARGE as GRID_TOO_LARGE
from .findings import MASS_OVERFLOW as MASS_OVERFLOW
from .findings import NEEDS_POLYGONS as NEEDS_POLYGONS
from .findings import SAMPLES_POSITIONED as SAMPLES_POSITIONED
from .findings import SHAPE_OF_GRID as SHAPE_OF_GRID
from .findings import SHAPE_OF_OPEN_SURFACE as SHAPE_OF_OPEN_SURFACE
from .findings import SHAPE_UNAVAILABLE as SHAPE_UNAVAILABLE
from .findings import WIRE_UNSUPPORTED as WIRE_UNSUPPORTED
from .grid import MAX_SAMPLES as MAX_SAMPLES
from .grid import Samples as Samples
from .grid import ThresholdGrid as ThresholdGrid
from .grid import ThresholdGridBody as ThresholdGridBody
from .grid import density_body as density_body
from .grid import label_body as label_body
from .grid import threshold_grid_body as threshold_grid_body
from .instances import area_of_instances as area_of_instances
from .instances import each_once as each_once
from .instances import findings_by_part as findings_by_part
from .instances import group_by_similarity as group_by_similarity
from .instances import instances_overlap as instances_overlap
from .instances import merge_health as merge_health
from .instances import singular_instances_message as singular_instances_message
from .mesh_body import MAX_MASS_MOMENT as MAX_MASS_MOMENT
from .mesh_body import MeshBody as MeshBody
from .mesh_body import drawn_names as drawn_names
from .mesh_body import extend_input_error as extend_input_error
from .mesh_body import of_drawn as of_drawn
from .mesh_body import sum_of_instances as sum_of_instances
from .mesh_body import with_input_error as with_input_error
from .pocket import PocketRoom as PocketRoom
from .printed import find_cores as find_cores
from .printed import print_body as print_body
from .reading import NO_VALUES as NO_VALUES
from .reading import FaceAttributes as FaceAttributes
from .reading import Part as Part
from .reading import Reading as Reading
from .reading import SplineReading as SplineReading
from .reading import about_file as about_file
from .reading import attribute_to_source as attribute_to_source
from .reading import float64_matrix as float64_matrix
from .reading import measure_reading as measure_reading
from .reading import name_subject as name_subject
from .reading import to_si as to_si
from .wall import WallBody as WallBody
from .wall import Walls as Walls
from .wall import find_walls as find_walls
from .wall import vessel_surface as vessel_surface

__all__ = []

def __getattr__(name: str) -> Any: ...
