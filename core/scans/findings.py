# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/scans`."""

from ..verdict import error, note, warning

NRRD_DATA_FILE_OUTSIDE = error(
    "nrrd_data_file_outside",
    "The data file “{file:.80s}” is outside of the header's folder. Move it there; or, if you "
    "trust the header, "
    "turn on Allow Outside, or use --allow-outside.",
)
RAW_WITHOUT_LAYOUT = error(
    "raw_without_layout",
    "A raw file does not describe its samples. Name it NAME_XxYxZ_TYPE.raw, such as "
    "head_128x128x54_uint16.raw, or add "
    "an NRRD header.",
)
SCAN_IN_SEVERAL_FILES = error(
    "scan_in_several_files",
    "The samples are in another file or in several. Save them as one {suffix} file.",
)
SCAN_SIZE = error(
    "scan_size", "A scan has three possible sizes, not {samples:size}. Save one volume of it."
)
SCAN_SAMPLE_TYPE = error(
    "scan_sample_type", "Samples of type {type:.40s} are not supported real numbers."
)
SCAN_OWN_UNIT = warning(
    "scan_own_unit",
    "The file has its own unit; the unit scale applies only to the given spacing and origin.",
)
SCAN_PLACEMENT_OVERRIDDEN = note(
    "scan_placement_overridden", "Given values replace those of the header: {fields}."
)
SCAN_UNSTATED = warning(
    "scan_unstated", "The file has no {part:word}: 1 was assumed. Use Set Spacing, or --{option}."
)
UNIT_ASSUMED = warning(
    "unit_assumed",
    "The file has no unit: 1 unit was taken as 1 {unit}. Use --unit-scale, or state the unit.",
)
SCAN_LABELS = warning(
    "scan_labels",
    "The samples look like labels ({count} whole numbers), between which a threshold has no "
    "meaning. Set Measure As to Label, or use --label N or --label all.",
)
LABEL_ABSENT = error(
    "label_absent",
    "“{file:.80s}” has no label {labels}; it has {others}. Correct {remedy:word}.",
)
POSITIONS_COUNT = error(
    "positions_count",
    "The positions along {axis} in “{file}” must be one row of numbers, {samples} as the scan has "
    "samples there, and "
    "at least 2; the file has {array}. Save one for each sample, or leave it out.",
)
POSITIONS_NOT_ASCENDING = error(
    "positions_not_ascending",
    "Position {place} along {axis} in “{file}” is not a finite number greater than the one before; "
    "the first is "
    "position 0. Correct it, or sort the positions, and the samples with them.",
)
