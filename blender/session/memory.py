# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The session's memory of the open file: everything remembered, by which key, and until when.

Nothing here is written to data. Loading a file and unregistering the add-on forget all of it
(`forget_file`); other ends are said beside the declaration. Data-blocks are keys by their session
uid, which survives renaming, undo and redo.

Functions that keep their last results until the next change have the decorator `until_change`.
Those that keep them by the content of their arguments (`lru_cache`) do so themselves: such results
cannot become out of date.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import wraps
from typing import TYPE_CHECKING, Generic, ParamSpec, TypeVar

from bpy.types import ID, Object, Scene

from ...core import statics, verdict

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from .character.weight import Character
    from .displayed import Displayed
    from .live.following import Followed
    from .stored.computed_moments import ComputedMoments
    from .stored.cuts import KnownCutFill, Level
    from .stored.faults import Faults
    from .stored.floating import Afloat
    from .stored.outcome import ActionOutcome
    from .stored.sliders import SliderGrid, SliderWalls
    from .stored.stability import KnownHull
    from .tracking.stamps import Kind, Stamp
    from .tracking.updates import Update

Value = TypeVar("Value")
Arguments = ParamSpec("Arguments")
_containers: list[SessionCache | dict | set | list] = []


class SessionCache(Generic[Value]):
    """A cache with one value for each original data-block; iteration yields the values.

    max_size: beyond this number of values the oldest one is forgotten. By default all are kept, as
    edits must be.
    """

    def __init__(self, max_size: int | None = None) -> None:
        self.max_size = max_size
        self._values: dict[int, Value] = {}  # by session uid, the newest last
        _containers.append(self)

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


Container = TypeVar("Container", bound=dict | set | list)


def _remembered(container: Container) -> Container:
    """Register a container to be cleared by `forget_file`, and return it."""
    _containers.append(container)
    return container


# ---------------------------------------------------------------- Edits and stamps

# the last update of each data-block, by session uid: of geometry that may be an edit, of geometry
# that is no edit, and of the transform alone
edits: dict[int, Update] = _remembered({})
returns: dict[int, Update] = _remembered({})
moves: dict[int, Update] = _remembered({})
# session uids of objects with settings changed since the last update
changed_settings: set[int] = _remembered(set())
# session uid → number of the last update whose effects on stamps are noted
resolved: dict[int, int] = _remembered({})
# object → the stamps that it carried when its geometry changed
edited: SessionCache[frozenset[str]] = SessionCache()
# object → the stamps of its data in memory, by kind
carried: SessionCache[dict[Kind, Stamp]] = SessionCache()
# stamp → digest of the surface when it was stored: copies of an object share both
shapes: dict[str, bytes] = _remembered({})
# session uid of a skinned mesh → the armature that deforms it; made anew after undo and loading
watched: dict[int, Object] = _remembered({})

# ---------------------------------------------------------------- Displayed numbers

# object → its state with Live on; until Live is turned off
followed: SessionCache[Followed] = SessionCache()
# session uid → drawn numbers of objects that depend on no other; until the object or scene changes
drawn: dict[int, Displayed] = _remembered({})
# session uids of drawn objects that have only moved since
moved: set[int] = _remembered(set())
# scene → the last measured objects with their places (`displayed.places`), and their overlaps
overlaps: SessionCache[tuple[frozenset, Sequence[verdict.Finding]]] = SessionCache()

# ---------------------------------------------------------------- Results too large to store

hulls: SessionCache[KnownHull] = SessionCache()
levels: SessionCache[Level] = SessionCache(max_size=64)
cut_fills: SessionCache[KnownCutFill] = SessionCache(max_size=64)
afloat: SessionCache[Afloat] = SessionCache(max_size=64)
faults: SessionCache[Faults] = SessionCache()
moments: SessionCache[ComputedMoments] = SessionCache(max_size=16)
walls: SessionCache[SliderWalls] = SessionCache(max_size=64)
grids: SessionCache[SliderGrid] = SessionCache(max_size=2)  # one may have gigabytes
# objects and scenes whose exact numbers are due after a slider's last change
due_numbers: list[tuple[Object, Scene]] = _remembered([])
# armature → the stamp of its results, and its model
characters: SessionCache[tuple[str, Character | None]] = SessionCache()
# empty of a balance group → its support by frame
supports: SessionCache[Mapping[int, statics.Support]] = SessionCache()


@dataclass
class State:
    """Single values.

    generation: changes since Blender's start, which loading a file does not forget; results of an
    older generation may be wrong. updates: those since the file was loaded. is_undo_pending:
    whether the next update is that of undo or redo. last_event: time of the last update. drawn_in:
    the scene's part in `drawn`. outcome: refusals of the last action, until undo, another selection
    or action. outcome_seen_in: the selection and last action when the outcome was first shown.
    """

    generation: int = 0
    updates: int = 0
    is_undo_pending: bool = False
    last_event: float = 0.0
    drawn_in: tuple = ()
    outcome: ActionOutcome | None = None
    outcome_seen_in: tuple = ()


state = State()


def until_change(function: Callable[Arguments, Value]) -> Callable[Arguments, Value]:
    """Decorate a function of data-blocks and values: it keeps its results until the next change.

    Calls are told apart by the session uids of data-blocks and the values of other arguments.
    """
    results: dict[tuple, Value] = _remembered({})
    kept_at = state.generation

    @wraps(function)
    def current(*arguments: Arguments.args, **options: Arguments.kwargs) -> Value:
        nonlocal kept_at
        if kept_at != (generation := state.generation):
            results.clear()
            kept_at = generation
        key = tuple(
            getattr(argument, "session_uid", argument)
            for argument in (*arguments, *options.values())
        )
        if key in results:
            return results[key]
        value = function(*arguments, **options)
        if generation == state.generation:  # else the call itself has counted a change
            results[key] = value
        return value

    return current


def forget_file() -> None:
    """Forget everything but the generation."""
    for container in _containers:
        container.clear()
    vars(state).update(vars(State(state.generation)))  # in place: other modules refer to `state`
