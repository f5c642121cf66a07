# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Data about objects while a file is open: in memory only, by session uid, which survives renaming,
undo and redo.

`handlers` empties all caches together when a file is loaded and when the add-on is unregistered.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, Generic, TypeVar

from bpy.types import ID

Value = TypeVar("Value")

_caches: list[SessionCache] = []


class SessionCache(Generic[Value]):
    """A cache with one value for each original data-block; iteration yields the values.

    max_size: beyond this number of values the oldest one is forgotten. By default all are kept, as
    edits must be.
    """

    def __init__(self, max_size: int | None = None) -> None:
        self.max_size = max_size
        self._values: dict[int, Value] = {}  # by session uid, the newest last
        _caches.append(self)

    def get(self, data: ID) -> Value | None:
        """Return the value of a data-block, None if there is none."""
        return self._values.get(data.session_uid)

    def by_uid(self, uid: int) -> Value | None:
        """Return the same as `get`, by the session uid of the data-block."""
        return self._values.get(uid)

    def __getitem__(self, data: ID) -> Value:
        return self._values[data.session_uid]

    def __setitem__(self, data: ID, value: Value) -> None:
        self.forget(data)
        self._values[data.session_uid] = value
        if self.max_size is not None and len(self._values) > self.max_size:
            del self._values[next(iter(self._values))]

    def __contains__(self, data: ID) -> bool:
        return data.session_uid in self._values

    def __iter__(self) -> Iterator[Value]:
        return iter(tuple(self._values.values()))

    def __len__(self) -> int:
        return len(self._values)

    def forget(self, data: ID) -> None:
        """Drop the value of a data-block, if any."""
        self._values.pop(data.session_uid, None)

    def clear(self) -> None:
        """Forget all values."""
        self._values.clear()


def current_value(
    cache: SessionCache[tuple[Any, Value]], data: ID, key: object, compute: Callable[[], Value]
) -> Value:
    """Return the cached value of a data-block if it has this key; otherwise compute and cache
    it.
    """
    known = cache.get(data)
    if known is None or known[0] != key:
        known = cache[data] = (key, compute())
    return known[1]


def clear_all() -> None:
    """Empty all caches; their data-blocks are no longer loaded."""
    for cache in _caches:
        cache.clear()
