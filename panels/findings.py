# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `panels`."""

from ..core.verdict.finding import note, warning

PANEL_OVERRIDE = warning("panel_override", "Library override: settings and results are lost on saving. Make it local.")
PANEL_WALL_LIMIT = note("panel_wall_limit", "Largest wall: {length:length}")
PANEL_WALL_FOLDS = warning("panel_wall_folds", "Folds over from {length:length}")
PANEL_DENSITY_MEAN = note("panel_density_mean", "Mean density, from {cause}")
PANEL_NO_MATERIAL_SLOTS = note("panel_no_material_slots", "No material slots")
PANEL_UNIT_QUESTION = note("panel_unit_question", "{length} long and {mass}: is a unit of this scene a millimeter?")
PANEL_LIVE_FIRST_ORDER = note(
    "panel_live_first_order",
    "Live: mass, volume and center of this frame; inertia follows when it stops ({milliseconds:.0f} ms)",
)
PANEL_LIVE_BEHIND = warning(
    "panel_live_behind", "Live lags: measuring takes {milliseconds:.0f} ms, and waits until the edit stops"
)
PANEL_POSED = note("panel_posed", "Sum of {count} mesh of the armature", "Sum of {count} meshes of the armature")
PANEL_POSED_MISSING = warning("panel_posed_missing", "Not measured: {objects}")
PANEL_POSED_STALE = warning("panel_posed_stale", "Out of date: {objects}")
PANEL_LIVE = note("panel_live", "Live ({milliseconds:.0f} ms). Press Measure to store")
PANEL_ORDERS_COPIED = note("panel_orders_copied", "Orders {first} to {last} are only in the copy.")
PANEL_SYMMETRY_TOLERANCE = note(
    "panel_symmetry_tolerance", "The surface matches its images within {share:.2g} of the radius of gyration"
)
PANEL_SYMMETRY_TOLERANCE_OF_DISPLAY_MESH = note(
    "panel_symmetry_tolerance_of_display_mesh",
    "The display mesh matches its images within {share:.2g} of the radius of gyration",
)
PANEL_SYMMETRY_OF_MOMENTS = note("panel_symmetry_of_moments", "Moments to order 6 alone allow {group}")
PANEL_EQUAL_MOMENTS_ALL = note("panel_equal_moments_all", "All principal moments are equal")
PANEL_EQUAL_MOMENTS_12 = note("panel_equal_moments_12", "Principal moments 1 and 2 are equal")
PANEL_EQUAL_MOMENTS_23 = note("panel_equal_moments_23", "Principal moments 2 and 3 are equal")
PANEL_NOTHING_MEASURED = note("panel_nothing_measured", "No selected object is measured")
PANEL_NOTHING_TO_COMPARE = note("panel_nothing_to_compare", "Nothing to compare with")
PANEL_MATERIAL_DEFAULT = note("panel_material_default", "None: the object's density is used")
PANEL_STABILITY_UNKNOWN = note("panel_stability_unknown", "Stability has not been computed.")
PANEL_STABILITY_STALE = note("panel_stability_stale", "The geometry has changed. Check again.")
