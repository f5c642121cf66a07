# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from .catalog import declared as declared
from .decision import Verdict as Verdict
from .decision import find_verdict as find_verdict
from .decision import open_body_caveats as open_body_caveats
from .finding_types import Code as Code
from .finding_types import EditRefusedError as EditRefusedError
from .finding_types import FileError as FileError
from .finding_types import Finding as Finding
from .finding_types import MeasureError as MeasureError
from .finding_types import QueryError as QueryError
from .finding_types import ReadError as ReadError
from .finding_types import Severity as Severity
from .finding_types import error as error
from .finding_types import finding as finding
from .finding_types import note as note
from .finding_types import repair as repair
from .finding_types import system_reason as system_reason
from .finding_types import truncate as truncate
from .finding_types import truncate_findings as truncate_findings
from .finding_types import unique as unique
from .finding_types import warning as warning
from .findings import FLIPPED_FACES as FLIPPED_FACES
from .findings import LINKED_OBJECT as LINKED_OBJECT
from .findings import NO_FACES as NO_FACES
from .findings import OBJECT_SIZE as OBJECT_SIZE
from .findings import SELF_INTERSECTION as SELF_INTERSECTION
from .findings import TOO_LARGE as TOO_LARGE
from .findings import TOO_SMALL as TOO_SMALL
from .health import DefectiveElements as DefectiveElements
from .health import Intersection as Intersection
from .health import MeshHealth as MeshHealth
from .method import Method as Method
from .method import Procedure as Procedure
from .method import Source as Source
from .method import least_trusted as least_trusted
from .sentences import HEALTH as HEALTH
from .sentences import METHODS as METHODS
from .sentences import SIMILARITY as SIMILARITY
from .sentences import Group as Group
from .sentences import fill as fill
from .sentences import grouped as grouped
from .sentences import method_key as method_key
from .sentences import of_severity as of_severity
from .sentences import sentence as sentence
from .sentences import severity as severity
from .sentences import truncate_list as truncate_list
from .tolerances import CLOSED_SHEET_VOLUME_RTOL as CLOSED_SHEET_VOLUME_RTOL
from .tolerances import FLAT_CAP_VOLUME_RTOL as FLAT_CAP_VOLUME_RTOL
from .tolerances import MAX_COORDINATE as MAX_COORDINATE
from .tolerances import NEGLIGIBLE as NEGLIGIBLE
from .tolerances import WELDING_RTOL as WELDING_RTOL
from .tolerances import check_size as check_size
from .tolerances import welding_tolerance as welding_tolerance

__all__ = [
    "Finding",
    "MeasureError",
    "Method",
    "Severity",
]

def __getattr__(name: str) -> Any: ...
