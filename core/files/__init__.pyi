# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from .damage import MALFORMED as MALFORMED
from .damage import NOT_REGULAR as NOT_REGULAR
from .damage import check_length as check_length
from .damage import check_regular as check_regular
from .damage import damaged as damaged
from .damage import refuse_non_finite as refuse_non_finite
from .damage import wrong_field as wrong_field
from .fbx import FBX_MAGIC as FBX_MAGIC
from .fbx import FbxNode as FbxNode
from .fbx import fbx_array as fbx_array
from .fbx import fbx_tree as fbx_tree
from .findings import DAMAGE_CUT_SHORT as DAMAGE_CUT_SHORT
from .findings import DAMAGE_INCOMPLETE as DAMAGE_INCOMPLETE
from .findings import DAMAGE_SIZE as DAMAGE_SIZE
from .findings import FILE_DAMAGED as FILE_DAMAGED
from .findings import FILE_MISSING as FILE_MISSING
from .findings import FILE_TOO_LARGE as FILE_TOO_LARGE
from .findings import FILE_TYPE as FILE_TYPE
from .findings import FILE_UNREADABLE as FILE_UNREADABLE
from .findings import FILE_UNRECOGNIZED as FILE_UNRECOGNIZED
from .findings import FILE_WITHOUT_OBJECTS as FILE_WITHOUT_OBJECTS
from .findings import HEADER_FIELD as HEADER_FIELD
from .findings import LINE_MISREAD as LINE_MISREAD
from .findings import MISSING_REFERENCES as MISSING_REFERENCES
from .findings import NAMED_FILE_MISSING as NAMED_FILE_MISSING
from .findings import OTHERS_LEFT_OUT as OTHERS_LEFT_OUT
from .findings import XML_ENTITIES as XML_ENTITIES
from .gltf import GltfFile as GltfFile
from .gltf import gltf_document as gltf_document
from .gltf import node_matrix as node_matrix
from .gltf import replace_gltf_document as replace_gltf_document
from .gltf import to_glb as to_glb
from .limits import DEFAULT_LIMITS as DEFAULT_LIMITS
from .limits import Limits as Limits
from .limits import file_limits as file_limits
from .number_text import SPACES as SPACES
from .number_text import parse_number as parse_number
from .number_text import parse_numbers as parse_numbers
from .number_text import parse_whole as parse_whole
from .number_text import parse_wholes as parse_wholes
from .text_fields import BLOCK as BLOCK
from .text_fields import MARK as MARK
from .text_fields import MAX_FLOAT32 as MAX_FLOAT32
from .text_fields import MAX_TEXT as MAX_TEXT
from .text_fields import SHORT as SHORT
from .text_fields import SHORT_OR_NAN as SHORT_OR_NAN
from .text_fields import SHORT_WHOLE as SHORT_WHOLE
from .text_fields import VERTEX as VERTEX
from .text_fields import WHOLE as WHOLE
from .text_fields import Data as Data
from .text_fields import Fault as Fault
from .text_fields import count_fault as count_fault
from .text_fields import find_number_fault as find_number_fault
from .text_fields import find_whole_fault as find_whole_fault
from .text_fields import map_file as map_file
from .text_fields import parse_decimals as parse_decimals
from .text_fields import refuse_line as refuse_line
from .text_fields import shorten as shorten
from .whole_file import hidden_path as hidden_path
from .whole_file import partial_file as partial_file
from .whole_file import replace as replace
from .xml import parse_xml as parse_xml
from .xml import xml_parser as xml_parser

__all__ = []

def __getattr__(name: str) -> Any: ...
