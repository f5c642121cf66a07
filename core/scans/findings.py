# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/scans`."""

from ..verdict.finding import error, note, warning

FILE_DAMAGED = error("file_damaged", "The file “{file}” is damaged: {cause}. Obtain it again, or export it again.")
DAMAGE_HEADER = error("damage_header", "its header has fewer than {bytes} bytes")
DAMAGE_LINES = error("damage_lines", "it lacks the lines that its header skips")
DAMAGE_ARRAY = error("damage_array", "it is not a complete NumPy array")
DAMAGE_ARRAYS = error("damage_arrays", "it is not a complete archive of NumPy arrays")
DAMAGE_ARCHIVE = error("damage_archive", "it is not a complete archive ({error})")
DAMAGE_TOO_SHORT = error("damage_too_short", "it holds {bytes} of the {total} bytes of samples that its sizes require")
DAMAGE_TOO_LONG = error("damage_too_long", "it holds more than the {total} bytes of samples that its sizes require")
DAMAGE_TOO_SMALL = error("damage_too_small", "{samples:size} samples cannot be compressed into it")
DAMAGE_CHECKSUM = error("damage_checksum", "the checksum of its compressed part is wrong")
DAMAGE_UNPACKED_LENGTH = error("damage_unpacked_length", "the length of its compressed part is wrong")
DAMAGE_PACKED_START = error(
    "damage_packed_start", "its compressed part, or what follows it, does not begin as gzip does"
)
DAMAGE_PACKED = error("damage_packed", "its compressed part cannot be decompressed ({error})")
DAMAGE_PACKED_END = error("damage_packed_end", "its compressed part is cut short")
NRRD_SKIP_FROM_END = error(
    "nrrd_skip_from_end", "“byte skip: -1” is for raw samples; compressed ones are counted from their start."
)
NO_3D_ARRAY = error("no_3d_array", "No array in the file has 3 dimensions.")
ARRAYS_LEFT_OUT = warning("arrays_left_out", "The array “{array}” was measured; left out: {arrays}.")
RAW_TYPE_UNKNOWN = error("raw_type_unknown", "Unknown sample type “{type}”. Use one of {types}.")
RAW_WITHOUT_LAYOUT = error(
    "raw_without_layout",
    "A raw file does not describe its samples. Name it NAME_XxYxZ_TYPE.raw, such as "
    "head_128x128x54_uint16.raw, or add "
    "an NRRD header.",
)
NIFTI_UNRECOGNIZED = error("nifti_unrecognized", "Not a NIfTI-1 file.")
NIFTI_HEADER_OF_PAIR = error(
    "nifti_header_of_pair", "The file is the header of a .hdr and .img pair. Save it as one .nii file."
)
NIFTI_DIMENSIONS = error("nifti_dimensions", "The NIfTI header gives {dimensions} dimensions.")
NIFTI_TYPE = error("nifti_type", "The NIfTI data type {type} is not a supported real number.")
NIFTI_TYPE_SIZE = error("nifti_type_size", "The NIfTI header contradicts itself: {bits} bits for data type {type}.")
NIFTI_OFFSET = error("nifti_offset", "The NIfTI header gives an impossible data offset, {offset:g}.")
NIFTI_SPACING = error("nifti_spacing", "The NIfTI header gives an impossible spacing, {x:g} x {y:g} x {z:g}.")
NIFTI_ROTATION = error("nifti_rotation", "The NIfTI header gives an invalid rotation.")
NRRD_UNRECOGNIZED = error("nrrd_unrecognized", "Not an NRRD file (NRRD0001 to NRRD0005).")
NRRD_FIELD_MISSING = error("nrrd_field_missing", "The NRRD header lacks the field “{field}”.")
NRRD_FIELD_NOT_NUMBERS = error(
    "nrrd_field_not_numbers", "The NRRD field “{field}” is not a list of numbers: {text:.60s}."
)
NRRD_FIELD_NOT_ONE_NUMBER = error("nrrd_field_not_one_number", "The NRRD field “{field}” must be one number.")
NRRD_DIMENSION_MISMATCH = error("nrrd_dimension_mismatch", "The NRRD fields “dimension” and “sizes” disagree.")
NRRD_TYPE = error("nrrd_type", "The NRRD type “{type:.40s}” is not a real number.")
NRRD_ENDIAN_MISSING = error("nrrd_endian_missing", "The NRRD header lacks the byte order (field “endian”).")
NRRD_SEVERAL_FILES = error("nrrd_several_files", "The samples are spread over several files. Join them into one.")
NRRD_DATA_FILE_MISSING = error("nrrd_data_file_missing", "The data file “{file:.80s}” is missing.")
NRRD_DATA_FILE_OUTSIDE = error(
    "nrrd_data_file_outside",
    "The data file “{file:.80s}” is outside of the header's folder. Move it there; or, if you trust the header, "
    "turn on Allow Outside, or use --allow-outside.",
)
FILE_EXCEEDS_LIMIT = error(
    "file_exceeds_limit",
    "“{file}” exceeds a limit: {count} {name} of at most {limit}. If you trust the file, set the environment "
    "variable BODY_MOMENTS_LIMITS to {name}={next}.",
)
LIMITS_UNRECOGNIZED = error(
    "limits_unrecognized",
    "The environment variable BODY_MOMENTS_LIMITS has “{text}”, which is no limit. Use NAME=NUMBER, with a NAME "
    "of {names}.",
)
NRRD_HEADER_UNENDED = error(
    "nrrd_header_unended", "The NRRD header has no end: the empty line before the samples is missing."
)
NRRD_ENCODING = error("nrrd_encoding", "The NRRD encoding “{encoding:.40s}” is not supported. Save it as raw or gzip.")
NRRD_SPACE_DIRECTIONS = error("nrrd_space_directions", "The NRRD field “space directions” must have three vectors.")
NRRD_SPACINGS = error("nrrd_spacings", "The NRRD field “spacings” must have three nonzero numbers.")
NRRD_VECTOR = error("nrrd_vector", "The NRRD field “{field}” has a vector that is not three numbers: {text:.60s}.")
SCAN_DIMENSIONS = error("scan_dimensions", "The file has {dimensions} dimensions; a scan has 3. Save one volume of it.")
SCAN_SIZE = error("scan_size", "The size of the scan is impossible: {samples:size}.")
SCAN_SAMPLE_TYPE = error("scan_sample_type", "Samples of type {type} are not real numbers.")
SCAN_EMPTY = error("scan_empty", "The scan has no samples.")
SCAN_FILE_TYPE = error("scan_file_type", "Unsupported file type. Supported scans: {suffixes}.")
SCAN_OUT_OF_MEMORY = error("scan_out_of_memory", "The samples do not fit into memory. Decompress the file.")
SCAN_PLACEMENT = error(
    "scan_placement", "The header places all samples in one plane: a spacing or direction is zero or not finite."
)
SCAN_SCALING = error("scan_scaling", "The header scales the samples by numbers that are not finite.")
SCAN_OWN_UNIT = warning(
    "scan_own_unit", "The file has its own unit; the unit scale applies only to the given spacing and origin."
)
SCAN_PLACEMENT_OVERRIDDEN = note("scan_placement_overridden", "Given values replace those of the header: {fields}.")
SCAN_WITHOUT_SPACING = warning(
    "scan_without_spacing", "The file has no spacing: 1 unit was assumed. Use Set Spacing, or --spacing."
)
POSITIONS_MISSING = error("positions_missing", "The file of positions along {axis}, “{file}”, does not exist.")
POSITIONS_NOT_A_ROW = error(
    "positions_not_a_row",
    "The positions along {axis} in “{file}” are not one row of numbers, but {dimensions} dimensions of type "
    "{type}. Save an array of one dimension.",
)
POSITIONS_COUNT = error(
    "positions_count",
    "“{file}” has {count} positions along {axis}, and the scan {samples} samples. Save one for each sample.",
)
POSITIONS_OF_ONE_SAMPLE = error(
    "positions_of_one_sample",
    "The scan has one sample along {axis}; a position does not tell how thick it is. Leave “{file}” out.",
)
POSITIONS_NON_FINITE = error(
    "positions_non_finite",
    "Position {place} along {axis} in “{file}” is not finite; the first is position 0. Correct it.",
)
POSITIONS_NOT_ASCENDING = error(
    "positions_not_ascending",
    "Position {place} along {axis} in “{file}” is not greater than the one before; the first is position 0. Sort "
    "the positions, and the samples with them.",
)
SCAN_WITHOUT_UNIT = warning(
    "scan_without_unit", "The file has no unit: 1 unit was taken as 1 m. Use Set Spacing, or --unit-scale."
)
FILE_MISSING = error("file_missing", "No such file.")
FILE_NOT_REGULAR = error("file_not_regular", "Not a regular file.")
