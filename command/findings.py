# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `command`. Usage errors and progress are plain texts where they are printed."""

from ..core.verdict import error, note, warning

PRINT_SETTINGS = (
    "the file's print settings, which cannot be read: the part counts as a solid. Give them by "
    "--print"
)
SOLID_OPERAND_MEASURED = warning(
    "solid_operand_measured",
    "Measured as a part, but cuts or joins “{object}” by a Boolean modifier. Display it as wire or "
    "bounds, or turn "
    "off its rendering, if it is no part.",
)
SIGNATURE_OF_DISPLAY_MESH = warning(
    "signature_of_display_mesh",
    "The signature is that of the display mesh. Raise Resolution Preview for accuracy.",
)
FOURIER_OBJECT_COUNT = error(
    "fourier_object_count",
    "--fourier needs one object that is no array, and there are {count}. Use --object.",
)
NO_SHAPES = "there is no object with a surface or volume"
NOTHING_RENDERED = "all objects were left out. Use --all, or turn on their rendering"
NOTHING_MEASURED = error("nothing_measured", "Nothing was measured: {cause:word}.")
FILE_HIDES = note("file_hides", "The file does not show it: {cause:word}. Use --all to measure it.")
FRAME_MEASURED = note(
    "frame_measured",
    "The file is animated: measured at frame {frame:g}. --at-frame chooses another.",
)
PLACES_UNCHECKED = warning(
    "places_unchecked",
    "Size and place may not be those of the file, as Blender's importer reads it differently, or "
    "they could not be compared: {cause:word}. Apply the transforms, or export as USD.",
)
USD_CAGE = warning(
    "usd_cage",
    "By the file, the mesh is the cage of a subdivision surface ({scheme}), and the cage was "
    "measured. Export it "
    "subdivided, or with the subdivisionScheme “none”.",
)
USD_UNREAD = error(
    "usd_unread",
    "Blender does not import these shapes of the USD file: {names}. Export them as meshes.",
)
DRIVER_BLOCKED = warning(
    "driver_blocked",
    "Drivers did not run, as the scripts of files are disabled: {drivers}. Bake what they drive, "
    "or save the file "
    "with simple expressions.",
)
SCRIPT_BLOCKED = note(
    "script_blocked",
    "A script in the file did not run, as the scripts of files are disabled: {script}.",
)
SCRIPTS_ALLOWED = warning(
    "scripts_allowed",
    "Blender was allowed to run the scripts of the file, which may have changed it: {names}. Start "
    "Blender with "
    "-Y, or name the file after “measure”.",
)
ASSETS_NOT_MEASURED = warning(
    "assets_not_measured",
    "Assets without numbers in their metadata, because they are not rendered, or not in the scene "
    "as an object or "
    "collection: {names}. --all measures what is not rendered.",
)
MEASURED_AS_SHELL = note(
    "measured_as_shell",
    "The surface encloses no volume. For its cut and fill it was measured as a thin shell.",
)
PART_UNAVAILABLE = error("part_unavailable", "No {part}: {cause}")
OPTIONS_UNUSED = warning(
    "options_unused",
    "Options that do not apply to this body, or to how its file is read, were not used: {options}.",
)
STREAM_OPTIONS = error(
    "stream_options",
    "A mesh that is read in blocks cannot be measured with {options}. Use --stream never.",
)
NEEDS_BLEND = "that needs a .blend file that was saved before"
RESULTS_NOT_STORED = error("results_not_stored", "Results were not stored: {cause:word}.")
FILE_CRASHED = error(
    "file_crashed",
    "Blender crashed on the file ({how}), {count} times. Save it again with the program that made "
    "it, or leave it out.",
)
FILE_TIMED_OUT = error(
    "file_timed_out",
    "The file took longer than {seconds:g} s. Use a longer --timeout, or open it in Blender to see "
    "why.",
)
FILE_TOOK_MEMORY = error(
    "file_took_memory",
    "The file took more than {megabytes:.0f} MB of memory. Use a larger --memory-mb, fewer --jobs, "
    "or reduce it.",
)
FILE_VERSION_UNSUPPORTED = error(
    "file_version_unsupported",
    "This Blender ({blender}) cannot read the file, which was saved by Blender {version}. Use a "
    "Blender that can.",
)
FILE_NEWER_VERSION = warning(
    "file_newer_version",
    "The file was saved by a newer Blender ({version}) than this one ({blender}), which may have "
    "lost some of it. "
    "Use that Blender.",
)
SIMPLEX_OPEN = warning(
    "simplex_open",
    "The facets do not close, so the moments depend on the reference point. Add the missing ones, "
    "or turn those "
    "that face the other way by “signs”.",
)
