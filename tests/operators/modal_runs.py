# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Modal operators, run to their end."""

from types import SimpleNamespace

import bpy

TIMER, ESC, MOUSE = (SimpleNamespace(type=name) for name in ("TIMER", "ESC", "MOUSEMOVE"))


def stand_in(cls, report, **settings):
    """Return an object with the functions and default settings of an operator class; `report` gets
    its reports.
    """
    functions = {
        name: value for name, value in vars(cls).items() if name not in ("__dict__", "__weakref__")
    }
    bases = tuple(base for base in cls.__bases__ if base is not bpy.types.Operator)
    made = type(cls.__name__, bases, functions)()
    made.report = report
    category, _, name = cls.__name__.partition("_OT_")
    made.bl_rna = getattr(getattr(bpy.ops, category.lower()), name).get_rna_type()
    made.properties = SimpleNamespace(is_property_set=settings.__contains__)
    for prop in made.bl_rna.properties:
        if prop.type == "ENUM" and prop.is_enum_flag:
            setattr(made, prop.identifier, set(prop.default_flag))
        elif prop.type not in ("POINTER", "COLLECTION"):
            setattr(
                made,
                prop.identifier,
                tuple(prop.default_array) if getattr(prop, "is_array", 0) else prop.default,
            )
    vars(made).update(settings)
    return made


class Window:
    """What of a window such an operator uses; everything else is Blender's."""

    def __init__(self):
        self.handlers, self.timers, self.status = [], [], []
        self.window = self.window_manager = self.workspace = self
        self.modal_handler_add = self.handlers.append
        self.status_text_set = self.status.append
        self.progress_begin = self.progress_update = lambda *_: None

    def __getattr__(self, name):
        return getattr(bpy.context, name)

    def event_timer_add(self, _seconds, window):
        self.timers.append(window)
        return window

    def event_timer_remove(self, timer):
        self.timers.remove(timer)

    def progress_end(self):
        pass


def pressed(cls, **settings):
    """An operator as its button starts it, without Blender's own part, and the window that it
    has.
    """
    reports = []
    operator = stand_in(cls, lambda kind, text: reports.append((*kind, text)), **settings)
    operator.reports = reports
    window = Window()
    assert operator._run(window, True) == {"RUNNING_MODAL"}
    assert window.handlers == [operator] and window.timers == [window]
    return operator, window


def finished(operator, window, limit=100):
    for _ in range(limit):
        result = operator.modal(window, TIMER)
        if result != {"RUNNING_MODAL"}:
            assert window.timers == [] and window.status[-1] is None
            return result
    raise AssertionError("it never ends")
