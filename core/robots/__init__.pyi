# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from .audit import Audit as Audit
from .audit import Auditor as Auditor
from .audit import repaired_copy as repaired_copy
from .comparison import Effect as Effect
from .comparison import compare as compare
from .comparison import ratio as ratio
from .findings import AUDIT_TOTAL as AUDIT_TOTAL
from .findings import DESCRIPTION_UNKNOWN as DESCRIPTION_UNKNOWN
from .findings import JOINT_VALUE_UNUSABLE as JOINT_VALUE_UNUSABLE
from .findings import ROBOT_SCALED as ROBOT_SCALED
from .findings import ROBOT_WITHOUT_LINKS as ROBOT_WITHOUT_LINKS
from .findings import UNIT_SCALE as UNIT_SCALE
from .findings import USD_SCALED as USD_SCALED
from .formats import AUDITED_SUFFIXES as AUDITED_SUFFIXES
from .formats import FORMATS as FORMATS
from .formats import RobotFormat as RobotFormat
from .links import Candidate as Candidate
from .links import Connection as Connection
from .links import assemble_robot as assemble_robot
from .links import make_candidate as make_candidate
from .links import robot_name as robot_name
from .model import VALUES as VALUES
from .model import FreeAxis as FreeAxis
from .model import Inertial as Inertial
from .model import Link as Link
from .model import Mimic as Mimic
from .model import Pose as Pose
from .model import Robot as Robot
from .model import Shape as Shape
from .primitives import equal_inertia_shape as equal_inertia_shape
from .primitives import moments_of as moments_of
from .primitives import primitive_moments as primitive_moments
from .read.descriptions import read_description as read_description
from .read.roots import Roots as Roots
from .totals import Expectation as Expectation
from .write import audit_report as audit_report
from .write.joints import merge_fixed as merge_fixed
from .write.marker import is_audit as is_audit
from .write.marker import is_ours as is_ours
from .write.shapes import with_primitives as with_primitives
from .write.shapes import without_collision as without_collision
from .write.texts import robot_text as robot_text
from .write.texts import with_geometry as with_geometry

__all__ = []

def __getattr__(name: str) -> Any: ...
