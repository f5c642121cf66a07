# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Selection of the objects to measure in the open scene, with the reasons for omissions and errors in given names."""

from __future__ import annotations

from argparse import Namespace
from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Any

import bpy

from ...blender.read.assembly import left_out_reasons
from ...blender.read.visibility import measurable, measurable_objects
from ...blender.session.findings import NO_SUCH_NAME
from ...blender.settings.given import shows_collection
from ...core.scans.findings import OTHERS_LEFT_OUT
from ...core.verdict.finding import Finding, QueryError, finding
from ..findings import NO_MEASURABLE_OBJECT, NOTHING_RENDERED
from ..options.option_types import split_source
from .entries import failure


def why_nothing(left_out: int) -> Finding:
    """Return the reason why a file without errors has no records."""
    return finding(NOTHING_RENDERED, count=left_out) if left_out else finding(NO_MEASURABLE_OBJECT)


def objects_to_measure(
    names: list[str] | None, everything: bool, hidden: Mapping[str, Finding]
) -> tuple[list[tuple[str, bpy.types.Object]], list[dict[str, Any]], list[dict[str, Any]]]:
    """Return the objects to measure, the objects left out, and the errors.

    The objects to measure come with unique names, the objects left out with a reason; each unknown name is an error.
    everything: True to leave out nothing. hidden: the reasons why the file does not show objects, by their names.

    Objects that the view layer excludes are included if another one renders them: reading them reports the reason.
    """
    scene, layer = bpy.context.scene, bpy.context.view_layer
    same = Counter(obj.name for obj in scene.objects)
    # A linked object may have a local one's name; the full name has the library too.
    labels = {obj: obj.name if same[obj.name] == 1 else obj.name_full for obj in scene.objects}
    if names is None:
        candidates = {*measurable_objects(layer), *_excluded(scene, layer)}
        reasons = {} if everything else left_out_reasons(scene, layer)
        chosen = [(label, obj) for obj, label in labels.items() if obj in candidates and obj not in reasons]
        left_out = [
            failure(labels[obj], hidden.get(obj.name, reason)) for obj, reason in reasons.items() if obj in candidates
        ]
        return chosen, left_out, []
    chosen, errors = [], []
    for name in names:
        matches = [(label, obj) for obj, label in labels.items() if label == name]
        matches = matches or [(label, obj) for obj, label in labels.items() if obj.name == name]
        chosen += [pair for pair in matches if pair not in chosen]
        if not matches:
            errors.append(failure(name, finding(NO_SUCH_NAME, kind="object", name=name)))
    return chosen, [], errors


def _excluded(scene: bpy.types.Scene, layer: bpy.types.ViewLayer) -> set[bpy.types.Object]:
    """Return the scene's measurable objects outside of its view layer.

    Members of instanced collections are left out, because the instancers' records hold them.
    """
    instanced = {obj.instance_collection for obj in scene.objects if shows_collection(obj)}
    members = {member for collection in instanced for member in collection.all_objects}
    return {obj for obj in {*scene.objects} - {*layer.objects} - members if measurable(obj)}


def other_scenes(scene: bpy.types.Scene) -> Iterator[Finding]:
    """Yield a finding if a file has measurable objects outside its open scene."""
    here = {*scene.objects}
    other_scenes = [other.name for other in bpy.data.scenes if any(measurable(obj) for obj in {*other.objects} - here)]
    if other_scenes:
        yield finding(OTHERS_LEFT_OUT, kind="scene", name=scene.name, others=other_scenes)


def set_density(obj: bpy.types.Object, options: Namespace) -> None:
    """Set the source of the object's density and the threshold of its grid, if given. Raises MeasureError.

    The object's settings change in memory. Only --write saves them, together with the results.
    """
    settings = obj.body_moments
    if options.threshold is not None and obj.type == "VOLUME":
        settings.grid_as, settings.threshold = "THRESHOLD", options.threshold
    if options.polynomial is not None:
        settings.mass_from, settings.density_from = "DENSITY", "POLYNOMIAL"
        settings.density_polynomial = options.polynomial
    elif options.density_from is not None:
        source, name = split_source(options.density_from)
        settings.mass_from, settings.density_from = "DENSITY", source.upper()
        if source == "attribute":
            settings.density_attribute = name
        elif source == "volume":
            volume = bpy.context.scene.objects.get(name)
            if volume is None or volume.type != "VOLUME":
                raise QueryError(NO_SUCH_NAME, kind="Volume object", name=name)
            settings.density_volume = volume
