# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts and print settings in the projects of slicers, which are 3MF files with further entries.

PrusaSlicer lists the ranges of triangles of an object's parts in `Slic3r_PE_model.config`, Bambu
Studio and OrcaSlicer the objects in `model_settings.config`. Settings of the whole project are in
`Slic3r_PE.config` and in `project_settings.config`.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from ..files import parse_number, parse_whole, parse_xml, xml_parser

PRUSA, PRUSA_PROJECT = "/metadata/slic3r_pe_model.config", "/metadata/slic3r_pe.config"
BAMBU, BAMBU_PROJECT = "/metadata/model_settings.config", "/metadata/project_settings.config"
NEGATIVE = "negative"
# Kinds of parts besides those that are printed: what cuts, and why the others are left out.
_KINDS = {
    "negativevolume": NEGATIVE,
    "negative_part": NEGATIVE,
    "parametermodifier": "it only modifies settings",
    "modifier_part": "it only modifies settings",
    "supportblocker": "it only marks supports",
    "support_blocker": "it only marks supports",
    "supportenforcer": "it only marks supports",
    "support_enforcer": "it only marks supports",
}
# Print settings, by the names of PrusaSlicer and of Bambu Studio and OrcaSlicer.
_NAMES = {
    "infill": ("fill_density", "sparse_infill_density"),
    "walls": ("perimeters", "wall_loops"),
    "top": ("top_solid_layers", "top_shell_layers"),
    "bottom": ("bottom_solid_layers", "bottom_shell_layers"),
    "layer_height": ("layer_height",),
    "outer": ("external_perimeter_extrusion_width", "outer_wall_line_width"),
    "inner": ("perimeter_extrusion_width", "inner_wall_line_width"),
    "top_least": ("top_solid_min_thickness", "top_shell_thickness"),
    "bottom_least": ("bottom_solid_min_thickness", "bottom_shell_thickness"),
    "vase": ("spiral_vase", "spiral_mode"),
}
_ELEMENTS = "object", "volume", "part"
_VASE = {"walls": 1.0, "top": 0.0, "infill": 0.0}
LEAST_LAYER = 1e-6  # a smaller share of a layer is rounding
USUAL_LINE = 0.45  # mm, where the width is left to the slicer


@dataclass(frozen=True)
class SlicerPart:
    """A part of an object: its first and last triangle, None for all; its kind: "" if it is
    printed, NEGATIVE, or why it is left out; its settings.
    """

    triangles: tuple[int, int] | None = None
    kind: str = ""
    name: str = ""
    settings: Mapping[str, str] = field(default_factory=dict)


@dataclass
class SlicerProject:
    """The parts of objects, by the id of the object, and for Bambu's parts by its own; settings of
    the project and of whole objects.
    """

    parts: dict[str, list[SlicerPart]] = field(default_factory=dict)
    components: dict[tuple[str, str], SlicerPart] = field(default_factory=dict)
    objects: dict[str, dict[str, str]] = field(default_factory=dict)
    settings: dict[str, Any] = field(default_factory=dict)

    @classmethod
    def read(cls, text_of: Callable[[str], bytes | None]) -> SlicerProject:
        """Return the project whose entries `text_of` returns. Raises ValueError."""
        project = cls()
        for entry in (PRUSA, BAMBU):
            if text := text_of(entry):
                project._read_parts(text)
        if text := text_of(PRUSA_PROJECT):
            for line in text.decode("utf-8", "replace").splitlines():
                name, equals, value = line.lstrip("; ").partition(" = ")
                if equals:
                    project.settings[name] = value.strip()
        if text := text_of(BAMBU_PROJECT):
            found = json.loads(text)
            project.settings |= found if isinstance(found, dict) else {}
        return project

    def _read_parts(self, text: bytes) -> None:
        stack: list[tuple[dict[str, str], dict[str, str]]] = []  # of elements and their settings

        def start(tag: str, values: dict[str, str]) -> None:
            if tag in _ELEMENTS:
                stack.append((values, {}))
            elif tag == "metadata" and stack and "key" in values:
                stack[-1][1][values["key"]] = values.get("value", "")

        def end(tag: str) -> None:
            if tag not in _ELEMENTS:
                return
            values, own = stack.pop()
            if tag == "object":
                self.objects[values["id"]] = own
                return
            parent = stack[0][0]["id"]
            kind = own.get("volume_type", values.get("subtype", "")).lower()
            if own.get("modifier") == "1":
                kind = "parametermodifier"
            triangles = None
            if tag == "volume":
                triangles = parse_whole(values["firstid"]), parse_whole(values["lastid"])
            part = SlicerPart(triangles, _KINDS.get(kind, ""), own.get("name", ""), own)
            if tag == "volume":
                self.parts.setdefault(parent, []).append(part)
            else:
                self.components[parent, values["id"]] = part

        parser = xml_parser()
        parser.StartElementHandler = start
        parser.EndElementHandler = end
        parse_xml(parser, [text])

    def print_settings(self, settings: Mapping[str, Any]) -> dict[str, float]:
        """Return the print settings of a part among its own, its object's and the project's:
        `infill` in percent, counts, `line_width` and `layer_height` in m, `density` in kg/m³.

        Empty if there is no infill. Raises ValueError.
        """
        known = {**self.settings, **settings}

        def number(name: str, percent: bool = False) -> float | None:
            value = next((known[key] for key in _NAMES[name] if key in known), "")
            if isinstance(value, list):  # a value for each variant of the printer
                value = value[0] if value else ""
            text = str(value)
            if not text or ("%" in text and not percent):
                return None
            return parse_number(text.rstrip("%").strip())

        infill = number("infill", percent=True)
        if infill is None:
            return {}
        made = {name: number(name) for name in ("walls", "top", "bottom", "layer_height")}
        made = {name: value for name, value in made.items() if value is not None}
        made |= {"infill": infill} | (_VASE if number("vase") else {})
        outer, inner = number("outer") or USUAL_LINE, number("inner") or USUAL_LINE
        walls = made.get("walls", 1.0)
        height = made.get("layer_height", math.inf)
        if not (walls >= 0.0 and height > 0.0 and 0.0 <= infill <= 100.0):
            raise ValueError("a print setting is out of its range")
        for side in ("top", "bottom"):
            least = math.ceil((number(side + "_least") or 0.0) / height - LEAST_LAYER)
            if made.get(side):
                made[side] = max(made[side], least)
        if "layer_height" in made:
            made["layer_height"] *= 1e-3
        count = max(walls, 1.0)
        made["line_width"] = 1e-3 * (outer + (count - 1.0) * inner) / count
        extruder = max(0, parse_whole(str(known.get("extruder", "1"))) - 1)
        densities = known.get("filament_density", ())
        if isinstance(densities, str):
            densities = densities.split(",")
        if extruder < len(densities) and parse_number(str(densities[extruder]).strip()) > 0.0:
            made["density"] = 1e3 * parse_number(str(densities[extruder]).strip())
        if not all(map(math.isfinite, made.values())):
            raise ValueError("a print setting is not finite")
        return made
