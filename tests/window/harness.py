# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A real Blender with its window on a screen of its own, hands to use it and eyes to see it.

`Window` starts Xvfb, Blender on it, and presses keys and buttons with xdotool, as a person does;
what came of it is asked from inside Blender (inside.py), and scrot takes pictures. Nothing waits
for a fixed time: drawing in software is slow, so everything polls until what it waits for is so.
For the same reason the screen is small, and the viewport is drawn without anti-aliasing.
"""

import contextlib
import json
import os
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np

SIZE = 1000, 1000  # pixels of the screen
START_LIMIT = 480.0  # seconds until Blender's window answers
STEP_LIMIT = 240.0  # seconds until what was pressed has happened
PAGES = 5  # Buttons are searched as far down the sidebar.
# Ctrl C beside a button would save the selected objects in a file.
PREPARED = """
bpy.context.preferences.system.viewport_aa = "OFF"
for keymap in bpy.context.window_manager.keyconfigs.user.keymaps:
    for item in keymap.keymap_items:
        item.active &= item.idname != "view3d.copybuffer"
"""
TOOLS = ("Xvfb", "xdotool", "scrot")


class Window:
    """A running Blender with its window; use it in a `with`.

    Positions are pixels from the lower left corner of the window, as Blender counts them.
    """

    def __init__(
        self,
        blender: str,
        user: Path,
        file: Path,
        log: Path,
        artefacts: Path,
        size: tuple[int, int] = SIZE,
    ):
        self.blender, self.file, self.log, self.artefacts = blender, file, log, artefacts
        self.width, self.height = size
        self.environment = {**os.environ, "BLENDER_USER_RESOURCES": str(user)}
        self.environment["LIBGL_ALWAYS_SOFTWARE"] = "1"
        self.questions = 0
        self.buttons: dict[str, tuple[float, float]] = {}  # Their last known places.

    def __enter__(self):
        with contextlib.ExitStack() as stack:
            self.mailbox = Path(stack.enter_context(tempfile.TemporaryDirectory()))
            self._start_screen(stack)
            self._start_blender(stack)
            self.closing = stack.pop_all()
        return self

    def __exit__(self, *_):
        self.closing.close()

    def _start_screen(self, stack: contextlib.ExitStack) -> None:
        reading, writing = os.pipe()
        screen = ["Xvfb", "-displayfd", str(writing), "-nolisten", "tcp"]
        screen += ["-screen", "0", f"{self.width}x{self.height}x24"]
        server = subprocess.Popen(screen, pass_fds=[writing], stderr=subprocess.DEVNULL)
        stack.callback(_end, server)
        os.close(writing)
        with os.fdopen(reading) as pipe:  # Xvfb writes the number when it is ready
            self.environment["DISPLAY"] = f":{pipe.readline().strip()}"

    def _start_blender(self, stack: contextlib.ExitStack) -> None:
        script = Path(__file__).with_name("inside.py")
        command = [self.blender, "-p", "0", "0", str(self.width), str(self.height), str(self.file)]
        command += ["--python", str(script), "--", str(self.mailbox)]
        output = stack.enter_context(self.log.open("w", encoding="utf-8"))
        self.process = subprocess.Popen(
            command,
            env=self.environment,
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
        )
        stack.callback(_end, self.process)
        self.ask(PREPARED, limit=START_LIMIT)

    def output(self) -> str:
        """Return Blender's output so far; errors while panels are drawn appear only there."""
        return self.log.read_text(encoding="utf-8", errors="replace")

    # questions

    def ask(self, source: str, limit: float = STEP_LIMIT):
        """Run source inside Blender and return what it leaves in `result`."""
        self.questions += 1
        request = self.mailbox / f"{self.questions:06d}.request"
        partial = request.with_suffix(".writing")
        partial.write_text(source, encoding="utf-8")
        partial.rename(request)
        reply = request.with_suffix(".reply")
        end = time.monotonic() + limit
        while not reply.exists():
            if self.process.poll() is not None:
                raise RuntimeError(f"Blender ended ({self.process.returncode})\n{self.output()}")
            if time.monotonic() > end:
                raise TimeoutError(f"no answer in {limit} s to:\n{source}\n{self.output()}")
            time.sleep(0.004)
        answer = json.loads(reply.read_text(encoding="utf-8"))
        if "error" in answer:
            raise RuntimeError(f"{source}\n{answer['error']}")
        return answer["result"]

    def get(self, expression: str):
        return self.ask(f"result = {expression}")

    def wait(self, expression: str, limit: float = STEP_LIMIT):
        """Poll an expression inside Blender until it is true, and return it."""
        end = time.monotonic() + limit
        while not (value := self.get(expression)):
            if time.monotonic() > end:
                self.picture("timeout")
                raise TimeoutError(f"not true after {limit} s: {expression}\n{self.output()}")
            time.sleep(0.02)
        return value

    # hands

    def _xdotool(self, *words) -> None:
        subprocess.run(["xdotool", *map(str, words)], env=self.environment, check=True, timeout=240)

    def move(self, x: float, y: float, *more) -> None:
        """Put the pointer there; the small step before lets Blender notice where it is. more: words
        for xdotool.
        """
        top = self.height - 1 - y
        self._xdotool(
            "mousemove", round(x) - 2, round(top), "mousemove", round(x), round(top), *more
        )

    def click(self, x: float, y: float) -> None:
        self.move(x, y)
        self.get("True")  # an answer comes after the move was handled
        self._xdotool("click", 1)

    def key(self, keys: str) -> None:
        self._xdotool("key", keys)

    def type(self, *keys: str) -> None:
        """Press keys one after the other, each after the one before was handled."""
        for keys_together in keys:
            self.key(keys_together)
            self.get("True")

    def redraw(self) -> None:
        """Return after everything on the screen has been drawn anew."""
        self.ask("bpy.ops.wm.redraw_timer(type='DRAW_WIN_SWAP', iterations=1)")

    # places

    def region(self, kind: str) -> tuple[int, int, int, int]:
        """x, y, width and height of a region of the 3D View."""
        source = "r = regions[{!r}]\nresult = [r.x, r.y, r.width, r.height]".format(kind)
        return tuple(self.ask(source))

    def point_at_view(self) -> None:
        """Put the pointer where nothing is but the 3D View."""
        x, y, width, height = self.region("WINDOW")
        self.move(x + width * 0.3, y + height * 0.2)

    def undo(self) -> None:
        """Press the key of undo in the 3D View."""
        self.point_at_view()
        self.key("ctrl+z")

    def open_tab(self, name: str) -> None:
        """Open the sidebar with the key for it and bring a tab to the front."""
        if not self.get("area.spaces.active.show_region_ui"):
            self.point_at_view()
            self.key("n")
            self.wait("area.spaces.active.show_region_ui")
        self.wait("regions['UI'].width > 100")
        # a tab is known only once it has been drawn, and setting one that is not known raises
        change = (
            f"try:\n    regions['UI'].active_panel_category = {name!r}\nexcept TypeError:\n    pass"
        )
        end = time.monotonic() + STEP_LIMIT
        while self.get("regions['UI'].active_panel_category") != name:
            if time.monotonic() > end:
                self.picture("no-tab")
                raise TimeoutError(f"the sidebar has no tab {name}\n{self.output()}")
            self.ask(change + "\nregions['UI'].tag_redraw()")
            time.sleep(0.1)

    def press(self, operator: str) -> None:
        """Click the button of an operator in the sidebar, after scrolling to it if need be."""
        self.click(*self.place(operator))

    def place(self, operator: str) -> tuple[float, float]:
        """Return the place of an operator's button in the sidebar, after scrolling to it if need
        be.
        """
        place = self.buttons.get(operator)
        if place is None or self.button_at(*place) != operator:
            place = self._find_button(operator)
        return place

    def middle(self, operator: str) -> tuple[float, float]:
        """Return the middle of an operator's button in the sidebar, to two pixels."""
        x, y = self.place(operator)
        inside = [down for down in range(-20, 21, 2) if self.button_at(x, y + down) == operator]
        return x, y + (inside[0] + inside[-1]) / 2

    def choose(self, menu: str, operator: str) -> None:
        """Open a menu at the pointer, as its key or header does, and click the entry of an
        operator.
        """
        # A menu opens with the entry under the pointer that was chosen last: some others may be
        # above it.
        x, y, width, height = self.region("WINDOW")
        x, y = x + width * 0.3, y + height - 60
        self.move(x, y)
        self.ask(f"bpy.ops.wm.call_menu(name={menu!r})")
        for down in (*range(0, -55, -9), *range(9, height - 80, 9)):
            if self.button_at(x, y - down) == operator:
                self._xdotool("click", 1)
                self.get("True")
                return
        self.picture("no-entry")
        self.key("Escape")
        raise LookupError(f"no entry for {operator} in {menu}\n{self.output()}")

    def commands(self) -> list[str]:
        """The commands of all buttons in the part of the sidebar that is seen, from top to bottom,
        with their values.

        What a row shows is what its button would copy.
        """
        x, y, width, height = self.region("UI")
        places = [
            (x + (width - 28) * share, y + height - down)
            for down in range(24, height, 16)
            for share in (0.5, 0.9, 0.95)
        ]
        return [*dict.fromkeys(filter(None, (self._command_at(*place) for place in places)))]

    def button_at(self, x: float, y: float) -> str | None:
        """The operator of the button there."""
        command = self._command_at(x, y)
        return command and command.removeprefix("bpy.ops.").partition("(")[0]

    def _command_at(self, x: float, y: float) -> str | None:
        """The command of the button there.

        Blender tells no positions of buttons, but Ctrl C over one copies its command.
        """
        self.move(x, y, "key", "ctrl+c")
        manager = "bpy.context.window_manager"
        copied = self.ask(f"result = {manager}.clipboard\n{manager}.clipboard = '-'")
        return copied if copied.startswith("bpy.ops.") else None

    def _find_button(self, operator: str) -> tuple[float, float]:
        """Go down the sidebar in steps smaller than a button, then a page further, and so on."""
        x, y, width, height = self.region("UI")
        column = width - 20  # the tabs' labels are on the right
        self.buttons.clear()
        for page in range(PAGES):
            for down in range(30 if page == 0 else 8, height, 14):
                for share in (0.25, 0.84, 0.9):
                    place = (x + column * share, y + height - down)
                    found = self.button_at(*place)
                    if found == operator:
                        self.buttons[operator] = place
                        return place
            self.move(x + column / 2, y + height / 2, *["click", 5] * 8)  # the wheel
            self.get("True")
        self.picture("no-button")
        raise LookupError(f"no button for {operator} in the sidebar\n{self.output()}")

    # eyes

    def picture(self, name: str, form: str = "webp") -> Path:
        """A picture of the screen, drawn anew, kept in the folder of artefacts; a .png has every
        pixel as it is.
        """
        self.redraw()
        path = self.artefacts / f"{name}.{form}"
        subprocess.run(
            ["scrot", "-o", "-q", "85", str(path)], env=self.environment, check=True, timeout=240
        )
        return path

    def pixels(self, name: str) -> np.ndarray:
        """A picture as (height, width, 3) bytes, from the top, read by Blender itself."""
        path = self.picture(name, "png")
        array = self.mailbox / "pixels.npy"
        self.ask(
            f"import numpy as np\nimage = bpy.data.images.load({str(path)!r})\n"
            "image.colorspace_settings.name = 'Non-Color'\n"
            "values = np.empty((image.size[1], image.size[0], image.channels), np.float32)\n"
            "image.pixels.foreach_get(values.ravel())\nbpy.data.images.remove(image)\n"
            f"np.save({str(array)!r}, np.round(255.0 * values[::-1, :, :3]).astype(np.uint8))"
        )
        return np.load(array)


def _end(process: subprocess.Popen) -> None:
    process.terminate()
    try:
        process.wait(60)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


PACKAGE = "bl_ext.user_default.body_moments"


CLOSE_OTHERS = """
for name in ("inertia", "density", "apply", "stability", "assembly", "advanced"):
    cls = getattr(bpy.types, "VIEW3D_PT_body_moments_" + name, None)
    if cls is not None:
        panels = bpy.types.Panel.__subclasses__()
        name = cls.__name__
        for child in [panel for panel in panels if getattr(panel, "bl_parent_id", "") == name]:
            bpy.utils.unregister_class(child)
        bpy.utils.unregister_class(cls)
"""


# opens the panel Stability, and closes the others
OPEN_STABILITY = """
panel = bpy.types.VIEW3D_PT_body_moments_stability
bpy.utils.unregister_class(panel)
panel.bl_options = set()
bpy.utils.register_class(panel)
"""
