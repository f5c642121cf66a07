# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from .file_mesh import FileMesh as FileMesh
from .file_mesh import box_of_blocks as box_of_blocks
from .file_mesh import name_of_file as name_of_file
from .file_mesh import without_repeats as without_repeats
from .findings import NEGATIVE_PARTS_CUT as NEGATIVE_PARTS_CUT
from .findings import NEGATIVE_PARTS_UNFIT as NEGATIVE_PARTS_UNFIT
from .measure import KINDS as KINDS
from .measure import MeshFile as MeshFile
from .measure import StreamIntegrals as StreamIntegrals
from .measure import measure_stream as measure_stream
from .measure import open_mesh_file as open_mesh_file
from .stl import StlFile as StlFile
from .threemf import Placed as Placed
from .threemf import read_3mf as read_3mf

__all__ = []

def __getattr__(name: str) -> Any: ...
