# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Data about objects while a file is open: in memory only, by session uid, gone with the file.

Blender gives every data-block a uid that lasts as long as it is loaded, through renaming, undo and redo, and that no
other one gets later. All caches are emptied together, by `handlers`, when a file is loaded and when the add-on is
unregistered.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterator
from typing import Generic, TypeVar
from weakref import WeakSet

from bpy.types import ID

Value = TypeVar("Value")

_caches: WeakSet[SessionCache] = WeakSet()


class SessionCache(Generic[Value]):
    """One value for each original data-block; iterated over, the values.

    max_size: beyond this number of values the least recently used one is forgotten. By default all are kept, as edits
    of objects must be.
    """

    def __init__(self, max_size: int | None = None) -> None:
        self.max_size = max_size
        self._values: OrderedDict[int, Value] = OrderedDict()  # by session uid, the last one used last
        _caches.add(self)

    def get(self, data: ID, default: Value | None = None) -> Value | None:
        """Return the value of a data-block, or `default` if nothing is remembered."""
        return self.by_uid(data.session_uid, default)

    def by_uid(self, uid: int, default: Value | None = None) -> Value | None:
        """Return the same as `get`, by the session uid of the data-block."""
        if uid not in self._values:
            return default
        self._values.move_to_end(uid)
        return self._values[uid]

    def __getitem__(self, data: ID) -> Value:
        value = self.get(data)
        if value is None:
            raise KeyError(data)
        return value

    def __setitem__(self, data: ID, value: Value) -> None:
        uid = data.session_uid
        self._values[uid] = value
        self._values.move_to_end(uid)
        if self.max_size is not None and len(self._values) > self.max_size:
            self._values.popitem(last=False)

    def __contains__(self, data: ID) -> bool:
        return data.session_uid in self._values

    def __iter__(self) -> Iterator[Value]:
        return iter(tuple(self._values.values()))

    def __len__(self) -> int:
        return len(self._values)

    def forget(self, data: ID) -> None:
        """Forget the value of a data-block, if any."""
        self._values.pop(data.session_uid, None)

    def clear(self) -> None:
        """Forget everything."""
        self._values.clear()


def clear_all() -> None:
    """Empty every cache: their objects are not loaded any more."""
    for cache in _caches:
        cache.clear()
