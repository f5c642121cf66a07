# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Changes of the scene: frames and data of objects, placed and created objects."""

from ...core.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(
    __name__,
    add_center="rig",
    add_marker="node_group",
    add_volume="imports",
    align_to_world="snap_targets",
    balance_mesh="sculpt_balance",
    center_of_mass_group="node_group",
    create_physics_rig="rig",
    defects_by_kind="mesh_faults",
    delete_faces="mesh_faults",
    fill_holes="mesh_faults",
    import_surfaces="imports",
    is_copy="snap_targets",
    matrix_along_axes="snap_targets",
    matrix_at_center="snap_targets",
    merge_by_distance="mesh_faults",
    move_parent="empties",
    move_to_match="snap_targets",
    place_empties="empties",
    plan_match="snap_targets",
    read_placed="imports",
    require_editable_mesh="mesh_faults",
    require_matchable="snap_targets",
    reverse_faces="mesh_faults",
    select_elements="mesh_faults",
    snap_target="snap_targets",
    targets_in_turn="snap_targets",
    write_volume="imports",
)
