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
from dataclasses import dataclass, field, replace
from typing import Any

from ..files import parse_number, parse_whole, parse_xml, xml_parser

# Entries with parts, and with settings of the whole project.
PRUSA = "/metadata/slic3r_pe_model.config"
PRUSA_PROJECT = "/metadata/slic3r_pe.config"
BAMBU = "/metadata/model_settings.config"
BAMBU_PROJECT = "/metadata/project_settings.config"
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
# Chosen: a smaller share of a layer is rounding, of the order of 1e-16 in a quotient.
LEAST_LAYER = 1e-6
USUAL_LINE = 0.45  # mm, where the width is left to the slicer


@dataclass(frozen=True)
class SlicerPart:
    """A part of an object.

    triangles: the indices of its first and its last one, None for all of the object's. kind: "" if
    it is printed, NEGATIVE, or the reason why it is left out.
    """

    triangles: tuple[int, int] | None = None
    kind: str = ""
    name: str = ""
    settings: Mapping[str, str] = field(default_factory=dict)


@dataclass
class SlicerProject:
    """The parts and settings of a project.

    parts: of PrusaSlicer, by the object's id. components: of Bambu Studio and OrcaSlicer, by the
    ids of the object and of the part. objects: settings of whole objects, by id. settings: of the
    whole project.
    """

    parts: dict[str, list[SlicerPart]] = field(default_factory=dict)
    components: dict[tuple[str, str], SlicerPart] = field(default_factory=dict)
    objects: dict[str, dict[str, str]] = field(default_factory=dict)
    settings: dict[str, Any] = field(default_factory=dict)

    @classmethod
    def read(cls, text_of: Callable[[str], bytes | None]) -> SlicerProject:
        """Return the project of a file. text_of: returns an entry of the file by its name, None if
        there is none. Raises ValueError.
        """
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
            settings = json.loads(text)
            project.settings |= settings if isinstance(settings, dict) else {}
        return project

    def _read_parts(self, text: bytes) -> None:
        """Add the objects and parts of an XML text, with their settings."""
        # The attributes and the settings of the elements that are open, objects first.
        stack: list[tuple[dict[str, str], dict[str, str]]] = []

        def start(tag: str, values: dict[str, str]) -> None:
            if tag in _ELEMENTS:
                stack.append((values, {}))
            elif tag == "metadata" and stack and "key" in values:
                _, settings = stack[-1]
                settings[values["key"]] = values.get("value", "")

        def end(tag: str) -> None:
            if tag not in _ELEMENTS:
                return
            values, settings = stack.pop()
            if tag == "object":
                self.objects[values["id"]] = settings
                return
            object_values, _ = stack[0]
            parent = object_values["id"]
            kind = settings.get("volume_type", values.get("subtype", "")).lower()
            if settings.get("modifier") == "1":
                kind = "parametermodifier"
            part = SlicerPart(
                kind=_KINDS.get(kind, ""), name=settings.get("name", ""), settings=settings
            )
            if tag == "volume":
                triangles = parse_whole(values["firstid"]), parse_whole(values["lastid"])
                self.parts.setdefault(parent, []).append(replace(part, triangles=triangles))
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
        stated = {**self.settings, **settings}

        def number(name: str, percent: bool = False) -> float | None:
            """Return a setting by our name in the slicer's unit, None if it is not stated, or is a
            percentage of another setting and `percent` is False.
            """
            value = next((stated[key] for key in _NAMES[name] if key in stated), "")
            if isinstance(value, list):  # a value for each variant of the printer
                value = value[0] if value else ""
            text = str(value)
            if not text or ("%" in text and not percent):
                return None
            return parse_number(text.rstrip("%").strip())

        infill = number("infill", percent=True)
        if infill is None:
            return {}
        print_settings = {"infill": infill}
        for name in ("walls", "top", "bottom", "layer_height"):
            value = number(name)
            if value is not None:
                print_settings[name] = value
        if number("vase"):
            print_settings |= _VASE
        outer = number("outer") or USUAL_LINE
        inner = number("inner") or USUAL_LINE
        walls = print_settings.get("walls", 1.0)
        height = print_settings.get("layer_height", math.inf)
        if not (walls >= 0.0 and height > 0.0 and 0.0 <= infill <= 100.0):
            raise ValueError("a print setting is out of its range")
        for side in ("top", "bottom"):
            least_layers = math.ceil((number(side + "_least") or 0.0) / height - LEAST_LAYER)
            if print_settings.get(side):
                print_settings[side] = max(print_settings[side], least_layers)
        # Slicers state lengths in mm.
        if "layer_height" in print_settings:
            print_settings["layer_height"] = 1e-3 * height
        count = max(walls, 1.0)  # One of the lines is the outer one: this is their mean width.
        print_settings["line_width"] = 1e-3 * (outer + (count - 1.0) * inner) / count
        density = _filament_density(stated)
        if density > 0.0:
            print_settings["density"] = density
        if not all(map(math.isfinite, print_settings.values())):
            raise ValueError("a print setting is not finite")
        return print_settings


def _filament_density(settings: Mapping[str, Any]) -> float:
    """Return the density of the filament in a part's extruder, kg/m³, 0 if it is not stated."""
    # Extruders are counted from 1; 0 is the project's, taken as the first.
    extruder = max(0, parse_whole(str(settings.get("extruder", "1"))) - 1)
    densities = settings.get("filament_density", ())  # g/cm³
    if isinstance(densities, str):
        densities = densities.split(",")
    if extruder >= len(densities):
        return 0.0
    return 1e3 * parse_number(str(densities[extruder]).strip())
