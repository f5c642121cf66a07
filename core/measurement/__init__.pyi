# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from .builder import Extent as Extent
from .builder import add_extents as add_extents
from .builder import build_measurement as build_measurement
from .builder import extent_of as extent_of
from .builder import find_extent as find_extent
from .builder import find_large_bounds as find_large_bounds
from .builder import find_properties as find_properties
from .builder import mass_properties as mass_properties
from .builder import measure_body as measure_body
from .builder import measure_total as measure_total
from .checked import check_document as check_document
from .checked import check_journal_line as check_journal_line
from .checked import parse_json as parse_json
from .documents import FLAT_SPECTRUM_ARRAYS as FLAT_SPECTRUM_ARRAYS
from .documents import FORMATS as FORMATS
from .documents import FRAMES as FRAMES
from .documents import MAX_ORDER as MAX_ORDER
from .documents import SPECTRUM_ARRAYS as SPECTRUM_ARRAYS
from .documents import bound_of as bound_of
from .documents import count_findings as count_findings
from .documents import document as document
from .documents import failed_document as failed_document
from .documents import plain as plain
from .documents import radius_of_gyration as radius_of_gyration
from .documents import table as table
from .documents import to_csv as to_csv
from .documents import to_json_lines as to_json_lines
from .findings import DENSITY_FROM as DENSITY_FROM
from .findings import DENSITY_FROM_MASS as DENSITY_FROM_MASS
from .findings import DENSITY_FROM_VALUE as DENSITY_FROM_VALUE
from .findings import NO_VOLUME as NO_VOLUME
from .findings import UNIFORM_DENSITIES as UNIFORM_DENSITIES
from .findings import WALL_UNSUPPORTED as WALL_UNSUPPORTED
from .findings import ZERO_QUANTITY as ZERO_QUANTITY
from .page import to_html as to_html
from .plain_text import PROGRAM as PROGRAM
from .plain_text import counted as counted
from .plain_text import print_message as print_message
from .plain_text import visible as visible
from .record import described as described
from .record import flat_record as flat_record
from .results import Body as Body
from .results import Measurement as Measurement
from .settings import VERSION as VERSION
from .settings import Pocket as Pocket
from .settings import PrintSettings as PrintSettings
from .settings import Settings as Settings
from .settings import digest as digest
from .settings import fingerprint as fingerprint

__all__ = [
    "FORMATS",
    "mass_properties",
    "to_html",
]

def __getattr__(name: str) -> Any: ...
