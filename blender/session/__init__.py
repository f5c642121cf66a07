# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The session's state while a file is open: staleness, results, live numbers, walls, moments."""

from ...core.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(
    __name__,
    BalanceGroup="balance_group",
    CharacterMotion="character.flight",
    SimilarSearch="similar",
    balance_pose="character.balance",
    bill_csv="stored.assembly",
    is_beyond_tolerance="stored.collider_tolerance",
    check_stability="stored.stability",
    lay_on_ground="stored.stability",
    make_rigid_bodies="rigid_bodies",
    plan_colliders="colliders",
    reframe_objects="snapping",
    remeasure="snapping",
    remove_colliders="colliders",
    store_colliders="colliders",
    store_measured="stored.results",
    tolerance_remedy="stored.collider_tolerance",
)
