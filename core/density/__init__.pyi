# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from .findings import DENSITY_NON_FINITE as DENSITY_NON_FINITE
from .findings import GRID_TRANSFORM_SINGULAR as GRID_TRANSFORM_SINGULAR
from .findings import LABELS_UNFIT as LABELS_UNFIT
from .findings import POSITIONS_ONLY_AS_DENSITY as POSITIONS_ONLY_AS_DENSITY
from .grid_options import GridOptions as GridOptions
from .grid_values import density_function as density_function
from .grid_values import empty_background_note as empty_background_note
from .grid_values import positions_text as positions_text
from .grid_values import sample_positions as sample_positions
from .label_sums import label_moments as label_moments
from .label_sums import sum_labels as sum_labels
from .materials import BY_NAME as BY_NAME
from .materials import CATEGORIES as CATEGORIES
from .materials import CT_DENSITIES as CT_DENSITIES
from .materials import DENSITY_UNITS as DENSITY_UNITS
from .materials import FILAMENT as FILAMENT
from .materials import FOOT as FOOT
from .materials import MATERIALS as MATERIALS
from .materials import POUND as POUND
from .materials import density_unit as density_unit
from .piecewise_mass import PartDensities as PartDensities
from .piecewise_mass import part_densities as part_densities
from .piecewise_mass import sheet_mass_moments as sheet_mass_moments
from .piecewise_mass import solid_mass_moments as solid_mass_moments
from .piecewise_mass import to_mass_moments as to_mass_moments
from .polynomial import Polynomial as Polynomial
from .polynomial import parse_polynomial as parse_polynomial
from .polynomial_mass import find_negative_point as find_negative_point
from .polynomial_mass import local_coordinates as local_coordinates
from .polynomial_mass import polynomial_mass_of_images as polynomial_mass_of_images
from .smooth_threshold import smooth_threshold_body as smooth_threshold_body
from .spline_grid import Blocks as Blocks
from .spline_grid import grid_moments as grid_moments
from .threshold import ThresholdBody as ThresholdBody
from .threshold import threshold_body as threshold_body
from .voxel_fill import MAX_VOXELS as MAX_VOXELS
from .voxel_fill import inside_moments as inside_moments

__all__ = [
    "MATERIALS",
    "grid_moments",
    "sum_labels",
    "threshold_body",
]

def __getattr__(name: str) -> Any: ...
