# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measurement of several bodies as one: assemblies and rigs of a file that have results or a given
mass.

With asset metadata, collections that are assets are included.
"""

from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any

import bpy

from ...blender import bodies, read, settings
from ...blender.bodies.assembly.measure import Assembly, measure_assembly
from ...blender.read.assembly import Root, is_assembly, settings_of
from ...blender.session import stored
from ...core.measurement import Measurement, record
from ...core.verdict import MeasureError, Procedure
from .entries import Contents


@dataclass(frozen=True, eq=False)
class Combined:
    """Measurements of assemblies and rigs. unit: meters per Blender unit. more: further entries of
    the assemblies' records, by their objects or collections.
    """

    unit: float = 1.0
    assemblies: list[Assembly] = field(default_factory=list)
    rigs: list[bodies.rig.Rig] = field(default_factory=list)
    more: dict[Root, dict[str, Any]] = field(default_factory=dict)

    def measurements(self) -> dict[Root, Measurement]:
        """Return the measurements of the assemblies by their objects or collections."""
        return {assembly.root.member.data: assembly.measurement for assembly in self.assemblies}

    def records(self, frame: str) -> dict[str, Any]:
        """Return a document's `assemblies` and `bones`; a list that would be empty is left out."""
        assemblies = [
            record.record(
                replace(
                    assembly.measurement,
                    place_error=self.unit * read.places.member_error(assembly.root.member)[0],
                ),
                frame,
                more=self.more.get(assembly.root.member.data),
            )
            for assembly in self.assemblies
        ]
        bones = [
            record.record(
                replace(part.measurement, place_error=place_error),
                frame,
                more={"armature": rig.armature.name},
            )
            for rig in self.rigs
            for mesh_error in [max(map(read.places.place_error, rig.objects), default=0.0)]
            for place_error in [self.unit * (mesh_error + read.places.place_error(rig.armature))]
            for part in rig.parts
            if part.measurement is not None
        ]
        entries_by_kind = {
            "assemblies": sorted(assemblies, key=lambda entry: entry["name"]),
            "bones": bones,
        }
        return {name: entries for name, entries in entries_by_kind.items() if entries}

    def store(self, contents: Contents) -> None:
        for assembly in self.assemblies:
            with contents.attempt(assembly.measurement.name):
                stored.assembly.store(bpy.context, assembly)
        for rig in self.rigs:
            with contents.attempt(rig.armature.name):
                stored.results.store_rig(rig)


def measure_combined(
    options: settings.options.MeasureOptions, contents: Contents, assets: bool
) -> Combined:
    """Measure the assemblies and the rigs of the open scene that have results or a given mass.

    `options` override the members' settings; `contents` gets the failures; `assets` adds assets
    that have a mass.
    """
    scene = bpy.context.scene
    combined = Combined(options.meters_per_unit(scene))
    member_options = replace(options, order=None)

    def add_assembly(root: Root) -> None:
        combined.assemblies.append(
            measure_assembly(root, bpy.context.evaluated_depsgraph_get(), member_options)
        )

    by_name = sorted(scene.objects, key=lambda obj: obj.name)
    empties = [obj for obj in by_name if obj.type == "EMPTY" and is_assembly(obj)]
    collections = scene.collection, *scene.collection.children_recursive
    roots = dict.fromkeys((*collections, *empties))
    measured = [
        root
        for root in roots
        if root.get("body_method") == Procedure.ASSEMBLY or settings_of(root).mass_from == "MASS"
    ]
    for root in measured:
        with contents.attempt(root.name):
            add_assembly(root)
    for root in roots if assets else ():
        if root.asset_data is not None and root.library is None and root not in measured:
            with suppress(MeasureError):  # assemblies of lamps, or of objects that are left out
                add_assembly(root)
    for armature in by_name:
        if armature.type == "ARMATURE" and armature.get("body_method") == Procedure.ASSEMBLY:
            with contents.attempt(armature.name):
                combined.rigs.append(bodies.rig.measure_rig(bpy.context, armature))
    return combined
