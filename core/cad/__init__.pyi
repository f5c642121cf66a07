# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from .findings import FACES_NOT_READ as FACES_NOT_READ
from .obj import UPRIGHT as UPRIGHT
from .obj import has_surfaces as has_surfaces
from .obj import read_obj_faces as read_obj_faces
from .obj_text import check_obj_text as check_obj_text
from .surface_file import read_meshes as read_meshes
from .surface_file import read_source as read_source
from .surface_file import read_surfaces as read_surfaces
from .surfaces import MAX_ORDER as MAX_ORDER
from .surfaces import SurfaceBody as SurfaceBody
from .surfaces import is_storable as is_storable
from .surfaces import revolved_solid as revolved_solid

__all__ = []

def __getattr__(name: str) -> Any: ...
