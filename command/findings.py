# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `command`."""

from ..core.verdict.finding import error, note, warning

SOLID_OPERAND_MEASURED = warning(
    "solid_operand_measured",
    "Measured as a part, but cuts or joins “{object}” by a Boolean modifier. Display it as wire or bounds, or turn "
    "off its rendering, if it is no part.",
)
POSE_OF_FLAT = warning("pose_of_flat", "A flat shape has no pose. Its plane and second moments say how it lies.")
SHAPE_OF_STREAM = warning(
    "shape_of_stream", "A mesh that is read in blocks has no pose or signature. Use --stream never."
)
SIGNATURE_OF_DISPLAY_MESH = warning(
    "signature_of_display_mesh", "The signature is that of the display mesh. Raise Resolution Preview for accuracy."
)
FOURIER_OF_ARRAY = error("fourier_of_array", "The Fourier transform of an array is not supported.")
FOURIER_OBJECT_COUNT = error("fourier_object_count", "--fourier needs one object, and there are {count}. Use --object.")
FOURIER_FAILED = error("fourier_failed", "No Fourier transform: {cause}")
FOURIER_NOT_WRITTEN = error("fourier_not_written", "The Fourier transform cannot be written: {error}.")
WAVE_VECTORS_UNREADABLE = error("wave_vectors_unreadable", "{file} is not a .npy file: {cause}")
WAVE_VECTORS_TOO_MANY = error(
    "wave_vectors_too_many", "There are {count} wave vectors, of at most {limit}. Use several files."
)
WAVE_VECTORS_ARCHIVE = error("wave_vectors_archive", "{file} holds several arrays. Use a .npy file.")
OTHER_SCENES = warning("other_scenes", "Only the scene “{scene}” was measured; left out: {scenes}.")
IMPORTER_MISSING = error("importer_missing", "This Blender has no importer for {suffix} files.")
IMPORT_FAILED = error("import_failed", "Blender cannot read the file: {error}.")
NO_MEASURABLE_OBJECT = error(
    "no_measurable_object", "Nothing was measured: there is no object with a surface or volume."
)
NOTHING_RENDERED = error(
    "nothing_rendered",
    "Nothing was measured: {count} object was left out. Use --all, or turn on its rendering.",
    "Nothing was measured: {count} objects were left out. Use --all, or turn on their rendering.",
)
MISSING_REFERENCES = error(
    "missing_references", "The file refers to what cannot be found: {names}. Restore these files."
)
DRIVER_BLOCKED = warning(
    "driver_blocked",
    "Drivers did not run, as the scripts of files are disabled: {drivers}. Bake what they drive, or save the file "
    "with simple expressions.",
)
SCRIPT_BLOCKED = note(
    "script_blocked", "A script in the file did not run, as the scripts of files are disabled: {script}."
)
FILE_NOT_OPENED = error("file_not_opened", "Blender cannot open the file. Check that it exists and is complete.")
FILE_READ_ONLY = error("file_read_only", "The file is read-only and cannot be saved.")
FILE_NOT_SAVED = error("file_not_saved", "The file cannot be saved: {error}.")
FILE_VANISHED = error("file_vanished", "The file cannot be saved: it is no longer there.")
FILE_CHANGED_MEANWHILE = error(
    "file_changed_meanwhile",
    "The file cannot be saved: another program has saved it since it was opened; nothing was overwritten. Measure "
    "it again.",
)
FILE_CHANGED_SINCE_START = error(
    "file_changed_since_start",
    "The file cannot be saved: it was saved after Blender started, which may not have read that. Run this again, "
    "or name the file after “measure”.",
)
HARD_LINK_SEVERED = warning(
    "hard_link_severed",
    "The file had {count} names (hard links); only “{file}” has the results, the others keep the earlier content.",
)
ASSETS_NOT_MEASURED = warning(
    "assets_not_measured",
    "Assets without numbers in their metadata, because they are not rendered, or not in the scene as an object or "
    "collection: {names}. --all measures what is not rendered.",
)
FILE_IS_FOLDER = error("file_is_folder", "A folder, not a file. Name the files in it.")
FILE_EMPTY = error("file_empty", "The file is empty.")
AT_MESH_VERTEX = note("at_mesh_vertex", "vertex {vertex} of “{mesh}”")
AT_ACCESSOR = note("at_accessor", "element {element} of accessor {accessor}")
AT_NODE = note("at_node", "node “{node}”")
GLTF_BUFFER_MISSING = error(
    "gltf_buffer_missing", "The buffer “{buffer}” is missing. Restore the file beside the glTF file."
)
GLTF_BUFFER_SHORT = error(
    "gltf_buffer_short", "The buffer “{buffer}” is cut short: {size} of {expected} bytes. Export the file again."
)
OBJECT_NOT_IN_FILE = error("object_not_in_file", "No object of this name in the file.")
OBJECT_NOT_IN_SCENE = error("object_not_in_scene", "No object of this name in the scene.")
MISSING_LINKS = error(
    "missing_links", "Linked data is missing: {names}. Restore the linked files, or make the data local."
)
MOMENTS_UNAVAILABLE = error("moments_unavailable", "No moments of this order: {cause}")
THICKNESS_OPTION_UNUSED = warning(
    "thickness_option_unused", "--thickness applies to shells only and was not used. Use --kind shell."
)
THRESHOLD_OPTION_UNUSED = warning(
    "threshold_option_unused", "--threshold applies to arrays, scans and Volume objects and was not used."
)
STREAM_OPTIONS = error(
    "stream_options", "A mesh that is read in blocks cannot be measured with {options}. Use --stream never."
)
UNIT_ASSUMED = warning("unit_assumed", "The file has no unit: 1 unit was taken as 1 m. Use --unit-scale.")
UNIT_SCALE_OPTION_UNUSED = warning("unit_scale_option_unused", "The file has its own unit; --unit-scale was not used.")
ARRAY_OPTIONS_UNUSED = warning("array_options_unused", "Options for arrays and scans were not used: {options}.")
RESULTS_NEED_BLEND = error("results_need_blend", "Results can only be stored in a .blend file; --write did nothing.")
SCENE_NEVER_SAVED = error("scene_never_saved", "The scene was never saved; --write has no file. Save it first.")
INTERRUPTED = error("interrupted", "interrupted; the result was not written")
INTERRUPTED_RESUMABLE = error(
    "interrupted_resumable",
    "interrupted after {done} of {total} files; the result was not written. Run the same with --resume to go on",
)
FILE_CRASHED = error(
    "file_crashed",
    "Blender crashed on the file ({how}), {count} times. Save it again with the program that made it, or leave it out.",
)
FILE_TIMED_OUT = error(
    "file_timed_out",
    "The file took longer than {seconds:g} s. Use a longer --timeout, or open it in Blender to see why.",
)
FILE_TOOK_MEMORY = error(
    "file_took_memory",
    "The file took more than {megabytes:.0f} MB of memory. Use a larger --memory-mb, fewer --jobs, or reduce it.",
)
FILE_VERSION_UNSUPPORTED = error(
    "file_version_unsupported",
    "This Blender ({blender}) cannot read the file, which was saved by Blender {version}. Use a Blender that can.",
)
FILE_NEWER_VERSION = warning(
    "file_newer_version",
    "The file was saved by a newer Blender ({version}) than this one ({blender}), which may have lost some of it. "
    "Use that Blender.",
)
PROGRESS_FILES = note("progress_files", "{done} of {total} files, {rate:.3g} per second, {left} left, {failed} not ok")
PROGRESS_STARTED = note("progress_started", "{done} of {total} files")
PROGRESS_DONE = note(
    "progress_done", "{count} file in {seconds:.1f} s: {counts}", "{count} files in {seconds:.1f} s: {counts}"
)
CHILDREN_FAILED = error("children_failed", "no process that measures can be started: {reason}")
SCRIPTS_ALLOWED = warning(
    "scripts_allowed",
    "Blender was allowed to run the scripts of the file, which may have changed it: {names}. Start Blender with "
    "-Y, or name the file after “measure”.",
)
PROGRESS_FACES = note("progress_faces", "{count:.3g} faces read. Ctrl+C ends it")
PROGRESS_SAMPLES = note("progress_samples", "{count:.3g} samples read. Ctrl+C ends it")
SIMPLEX_ARRAYS = error("simplex_arrays", "The file is no .npz archive with the arrays “points” and “simplices”.")
SIMPLEX_POINTS = error("simplex_points", "“points” must be rows of 1 to {limit} finite coordinates.")
SIMPLEX_OPEN = warning(
    "simplex_open",
    "The facets do not close, so the moments depend on the reference point. Add the missing ones, or turn those "
    "that face the other way by “signs”.",
)
SIMPLEX_ROWS = error(
    "simplex_rows", "“simplices” must be rows of {dimension} or one more numbers of points, counted from 0."
)
SIMPLEX_SIGNS = error("simplex_signs", "“signs” must be 1 or -1 for each of the simplices.")
SIMPLEX_POINT = error("simplex_point", "--about has {count} coordinates, and the points {dimension}.")
SIMPLEX_TOO_MANY = error(
    "simplex_too_many", "More than {limit} moments of order {order} in {dimension} dimensions. Choose fewer."
)
LIBRARY_UNREADABLE = error("library_unreadable", "{file} cannot be read: {error}.")
NAME_NOT_IN_LIBRARY = error("name_not_in_library", "No body named {name} has a signature.")
NAME_AMBIGUOUS = error("name_ambiguous", "Several bodies are named {name}. Use one of {names}.")
USAGE_PATH = error("usage_path", "{path}: {error}. Use another name")
USAGE_FOLDER_READ_ONLY = error(
    "usage_folder_read_only", "argument --{option}: no file can be written in {folder}. Use another folder"
)
USAGE_FILE_NEEDED = error("usage_file_needed", "a FILE is needed")
USAGE_FOLDER_MISSING = error("usage_folder_missing", "argument --{option}: no folder {folder}")
USAGE_IS_FOLDER = error("usage_is_folder", "argument --{option}: {path} is a folder")
USAGE_NOT_REPLACEABLE = error(
    "usage_not_replaceable", "argument --{option}: {path} cannot be replaced: {error}. Use another name"
)
USAGE_FOREIGN_FILE = error(
    "usage_foreign_file",
    "argument --{option}: {path} is not a result of body_moments and would be lost. Use another name, or --force",
)
USAGE_OVERWRITES_DEPENDENCY = error(
    "usage_overwrites_dependency", "argument --{option}: {path} is read with a measured file. Use another name"
)
USAGE_VALUE = error("usage_value", "argument --{option}: {cause}")
USAGE_NOT_POSITIVE = error("usage_not_positive", "{text!r} is not a positive number")
USAGE_NOT_NUMBER = error("usage_not_number", "{text!r} is not a finite number")
USAGE_NOT_TRIPLE = error("usage_not_triple", "{text!r} is not three numbers X,Y,Z")
USAGE_POSITIONS = error("usage_positions", "“{text}” is not x=FILE.npy, y=FILE.npy or z=FILE.npy")
USAGE_POSITIONS_TWICE = error("usage_positions_twice", "--positions names an axis twice: {axes}")
USAGE_NOT_POSITIVE_TRIPLE = error("usage_not_positive_triple", "{text!r} is not three positive numbers X,Y,Z")
USAGE_SPLINE_ORDER = error("usage_spline_order", "{text!r} is not an order from 1 to {limit}")
USAGE_ORDER = error("usage_order", "{text!r} is not an order from 0 to {limit}")
USAGE_ORDER_TOO_HIGH = error("usage_order_too_high", "{text!r} is above the highest order, {limit}")
USAGE_LINKS_OF_BONES = error(
    "usage_links_of_bones", "--links bone takes what the bones' settings say, and no --{option}"
)
USAGE_TEXT_FORMAT = error(
    "usage_text_format", "argument --output: {format} is written as text. Use the suffix .gltf, .usd or .usda"
)
USAGE_FORMAT_UNKNOWN = error("usage_format_unknown", "{text!r} is not one of {formats}")
USAGE_NEEDS_FOURIER = error("usage_needs_fourier", "argument --{option}: needs --fourier OUT.npz")
USAGE_FOURIER_POINTS = error(
    "usage_fourier_points", "argument --fourier: needs either --q Q.npy, or --grid N and --qmax Q"
)
USAGE_GRID_AND_QMAX = error("usage_grid_and_qmax", "arguments --grid and --qmax must be used together")
USAGE_FOURIER_ONE_OBJECT = error("usage_fourier_one_object", "argument --fourier: takes one object of one FILE")
USAGE_PATH_TWICE = error("usage_path_twice", "argument --fourier: {path} is used twice")
USAGE_FREQUENCY_COUNT = error("usage_frequency_count", "{text!r} is not a number of frequencies from 2 to {limit}")
USAGE_DENSITY_SOURCE = error("usage_density_source", "{text!r} is not value, materials, attribute:NAME or volume:NAME")
MATERIAL_UNKNOWN = error("material_unknown", "There is no material “{name}”. Known are {names}")
DENSITY_VOLUME_UNKNOWN = error(
    "density_volume_unknown", "There is no Volume object “{name}” in the scene. Name one that is."
)
USAGE_RANGE = error("usage_range", "{text!r} is not A:B, two whole numbers with A no larger than B")
USAGE_NEEDS_SUPERVISOR = error(
    "usage_needs_supervisor", "argument --{option}: applies to FILEs that are measured by other processes"
)
USAGE_COMMAND = error(
    "usage_command",
    "“{name}” is no command: measure, similar, simplex, audit, manifest, merge, to-csv, summary, compare and "
    "report are",
)
USAGE_RESUME_OUTPUT = error("usage_resume_output", "argument --resume: needs the --output of the run to go on with")
USAGE_NO_BLENDER = error("usage_no_blender", "No module named 'bpy' is here. Use --blender PATH, or install it")
USAGE_BUSY = error(
    "usage_busy", "argument --output: another run is writing {path}. Wait for its end, or use another name"
)
USAGE_OLD_FOREIGN = error(
    "usage_old_foreign",
    "argument --output: {path} is in the way of the older result, and is none itself. Move it, or use --force",
)
FOLDER_WITHOUT_FILES = error(
    "folder_without_files", "No file that can be measured is in the folder {folder}. Name files"
)
RESULTS_UNREADABLE = error("results_unreadable", "The results {file} cannot be read: {error}")
RESULTS_MALFORMED = error(
    "results_malformed", "{file} is not a result of body_moments. Name what “measure” has written"
)
COMPARE_TWO = error("compare_two", "“compare” takes two results")
MANIFEST_UNREADABLE = error("manifest_unreadable", "The list {file} cannot be read: {error}")
MANIFEST_MALFORMED = error("manifest_malformed", "{file} is not a list of files. Make one with “manifest FOLDER”")
USAGE_RESULT_NOT_WRITTEN = error("usage_result_not_written", "the result cannot be written: {error}")
ROBOT_ONE_FILE = error("robot_one_file", "A robot is one file. Name one FILE for this format, not {count}.")
ROBOT_MESHES_NOT_WRITTEN = error("robot_meshes_not_written", "The meshes cannot be written: {error}.")
AUDIT_DONE = note("audit_done", "{links} links: {errors} errors, {warnings} warnings, {notes} notes")
USAGE_REPAIR_FOLDER = error("usage_repair_folder", "--repair: {path} is no folder")
USAGE_REPAIR_SAME = error(
    "usage_repair_same", "--repair: {path} is the folder of a file that is read. Choose another one"
)
AUDIT_COPIES_ALIKE = error(
    "audit_copies_alike", "Two files have one name: {name}. Audit them one at a time, or choose other folders."
)
AUDIT_COPY_EXISTS = error(
    "audit_copy_exists", "{path} is another file and would be lost. Choose another folder, or --force."
)
AUDIT_NOT_WRITTEN = error("audit_not_written", "The file cannot be written: {error}.")
