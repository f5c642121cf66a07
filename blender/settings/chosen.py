# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The objects that a panel is about."""

from __future__ import annotations

from bpy.types import Context, Object


def pinned_object(context: Context) -> Object | None:
    """Return the object that is pinned in the Properties editor of the context, or None."""
    pinned = getattr(context.space_data, "pin_id", None)
    return None if pinned is None else context.object


def chosen_objects(context: Context) -> list[Object]:
    """Return the objects that a panel is about: the pinned one, else the selected ones, else the
    active one.
    """
    active = pinned_object(context)
    selected = [] if active is not None else list(context.view_layer.objects.selected)
    return selected or [obj for obj in (active or context.object,) if obj is not None]
