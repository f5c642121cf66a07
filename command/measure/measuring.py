# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Selection of the objects to measure in the open scene, and their measurement.

Omitted objects come with the reasons, and unknown names as errors. Bodies are measured together or
one by one, with their shapes; flat shapes, Fourier transforms and pictures alone.
"""

from argparse import Namespace
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import bpy

from ...blender import read, session, write
from ...blender.bodies import fourier, stack
from ...blender.bodies.flat import flat_shape
from ...blender.bodies.flat.region import area_findings, clearer_refusal, flat_region
from ...blender.bodies.measure_object import measure_object, measured_in_turn
from ...blender.bodies.shape.object_shape import NoShapeError, shape_of
from ...blender.read import assembly, visibility
from ...blender.settings.given import shows_collection
from ...blender.settings.options import MeasureOptions
from ...core import bodies, files, verdict
from ...core.measurement import Measurement, flat_record
from ...core.moments import flusser_invariants, hu_invariants, normalize
from ...core.verdict import Finding, MeasureError, QueryError, finding
from ..files.output import guard
from ..findings import NO_SHAPES, NOTHING_MEASURED, NOTHING_RENDERED, SIGNATURE_OF_DISPLAY_MESH
from ..options import checks, option_types
from .entries import failure, picture

LEAST_ORDER = 2  # moments to this order are always computed
HU_ORDER = 3  # order for Hu's invariants


def measured_together(
    objects: Sequence[bpy.types.Object], options: Namespace, measure_options: MeasureOptions
) -> Callable[[bpy.types.Object], stack.Measured] | None:
    """Return a function that measures objects in batches, or None if they have to be measured one
    by one.

    That is the case if an object needs settings or results of its own besides mass properties.
    """
    individual_options = ("order", "threshold", "label", "polynomial", "density_from")
    is_alone = options.pose or options.signature
    if is_alone or any(getattr(options, name) is not None for name in individual_options):
        return None
    return measured_in_turn(objects, bpy.context.evaluated_depsgraph_get(), measure_options)


def measure_shape(
    obj: bpy.types.Object, options: Namespace, measure_options: MeasureOptions
) -> tuple[Measurement, dict[str, Any], tuple[Finding, ...]]:
    """Return an object's measurement, its pose and signature if requested, and findings about
    these.

    Pose and signature are None for objects without a shape of their own, which are still measured.
    """
    depsgraph = bpy.context.evaluated_depsgraph_get()
    requested = [name for name in ("pose", "signature") if getattr(options, name)]
    if not requested:
        return measure_object(obj, depsgraph, measure_options), {}, ()
    try:
        shape = shape_of(obj, depsgraph, measure_options)
    except NoShapeError as refusal:
        return refusal.measurement, dict.fromkeys(requested), (refusal.finding,)
    shape_entries: dict[str, Any] = {"pose": shape.pose()} if options.pose else {}
    findings: tuple[Finding, ...] = ()
    if options.signature and shape.has_surface:
        shape_entries["signature"] = shape.signature().as_record()
        if shape.measurement.method.source == verdict.Source.NURBS:
            findings = (finding(SIGNATURE_OF_DISPLAY_MESH),)
    elif options.signature:
        shape_entries["signature"] = None
        findings = (finding(bodies.SHAPE_UNAVAILABLE, cause=bodies.NEEDS_POLYGONS),)
    return shape.measurement, shape_entries, findings


def thumbnail_of(obj: bpy.types.Object, measurement: Measurement, unit: float) -> str | None:
    """Return the picture of a measured object, or None if it shows no faces. unit: in meters."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    try:
        surface = read.objects.read_object(obj, depsgraph, edges=False).join()
    except MeasureError:  # such as a grid of densities
        return None
    return picture(surface, measurement, unit)


def write_transform(
    obj: bpy.types.Object, options: Namespace, measure_options: MeasureOptions
) -> tuple[Finding, ...]:
    """Write an object's Fourier transform to a file, and return findings.

    Raises MeasureError and OSError.
    """
    depsgraph = bpy.context.evaluated_depsgraph_get()
    unit = measure_options.unit_scale
    under_way = (
        fourier.flat_transform(obj, depsgraph, options.waves, frame=options.frame, unit=unit)
        if options.flat
        else fourier.object_transform(
            obj, depsgraph, measure_options, options.waves, frame=options.frame
        )
    )
    for _ in under_way.steps():
        pass
    transform, findings = under_way.result()
    write.spectrum.save(
        options.fourier, transform, options.frame, guard(options.force), under_way.arrays
    )
    return findings


def record_of_flat(
    label: str,
    obj: bpy.types.Object,
    options: Namespace,
    unit: float | None,
    refusal: MeasureError,
    findings: tuple[Finding, ...],
) -> dict[str, Any]:
    """Return the record of an object as a flat shape.

    refusal: the reason why it is no body. findings: about its file. Raises MeasureError.
    """
    depsgraph = bpy.context.evaluated_depsgraph_get()
    order = options.order
    posed = checks.unused(name for name in ("pose", "float") if getattr(options, name))
    extra_entries: dict[str, Any] = {"pose": None} if options.pose else {}
    invariants = []
    try:
        region = flat_region(obj, depsgraph, selected=False, unit=unit)
        moments = region.moments(max(order or 0, LEAST_ORDER))
        if options.signature:
            shape = flat_shape.flat_shape_of(obj, depsgraph, unit)
            extra_entries["signature"] = shape.signature().as_record()
        if order is not None and order >= HU_ORDER:
            normalized = normalize(moments)
            invariants = [*hu_invariants(normalized), *flusser_invariants(normalized)]
    except MeasureError as error:
        raise clearer_refusal(refusal, error) from None
    return flat_record(
        label,
        obj.type,
        region.plane,
        moments,
        (*region.findings, *area_findings(region, moments.total), *posed, *findings),
        order=order,
        invariants=invariants,
        more=extra_entries,
        about=options.about,
        frame=(options.frame, region.rotation, region.location),
    )


def why_nothing(left_out: int) -> Finding:
    """Return the reason why a file without errors has no records."""
    return finding(NOTHING_MEASURED, cause=NOTHING_RENDERED if left_out else NO_SHAPES)


def objects_to_measure(
    names: list[str] | None, everything: bool, hidden: Mapping[str, Finding]
) -> tuple[list[tuple[str, bpy.types.Object]], list[dict[str, Any]], list[dict[str, Any]]]:
    """Return the objects to measure, the objects left out, and the errors.

    The objects to measure come with unique names, the objects left out with a reason; each unknown
    name is an error. everything: True to leave out nothing. hidden: the reasons why the file does
    not show objects, by their names.

    Objects that the view layer excludes are included if another one renders them: reading them
    reports the reason.
    """
    scene = bpy.context.scene
    layer = bpy.context.view_layer
    name_counts = Counter(obj.name for obj in scene.objects)
    # A linked object may have a local one's name; the full name has the library too.
    labels = {
        obj: obj.name if name_counts[obj.name] == 1 else obj.name_full for obj in scene.objects
    }
    if names is None:
        candidates = {*visibility.measurable_objects(layer), *_excluded(scene, layer)}
        reasons = {} if everything else assembly.left_out_reasons(scene, layer)
        labeled_objects = [
            (label, obj)
            for obj, label in labels.items()
            if obj in candidates and obj not in reasons
        ]
        left_out = [
            failure(labels[obj], hidden.get(obj.name, reason))
            for obj, reason in reasons.items()
            if obj in candidates
        ]
        return labeled_objects, left_out, []
    by_name = {
        name: [(label, obj) for obj, label in labels.items() if label == name]
        or [(label, obj) for obj, label in labels.items() if obj.name == name]
        for name in names
    }
    errors = [
        failure(name, finding(session.findings.NO_SUCH_NAME, kind="object", name=name))
        for name, matches in by_name.items()
        if not matches
    ]
    return [*dict.fromkeys(pair for pairs in by_name.values() for pair in pairs)], [], errors


def _excluded(scene: bpy.types.Scene, layer: bpy.types.ViewLayer) -> set[bpy.types.Object]:
    """Return the scene's measurable objects outside of its view layer.

    Members of instanced collections are left out, because the instancers' records hold them.
    """
    instanced = {obj.instance_collection for obj in scene.objects if shows_collection(obj)}
    members = {member for collection in instanced for member in collection.all_objects}
    return {
        obj for obj in {*scene.objects} - {*layer.objects} - members if visibility.measurable(obj)
    }


def other_scenes(scene: bpy.types.Scene) -> Iterator[Finding]:
    """Yield a finding if a file has measurable objects outside its open scene."""
    here = {*scene.objects}
    scene_names = [
        other_scene.name
        for other_scene in bpy.data.scenes
        if any(visibility.measurable(obj) for obj in {*other_scene.objects} - here)
    ]
    if scene_names:
        yield finding(files.OTHERS_LEFT_OUT, kind="scene", name=scene.name, others=scene_names)


def set_density(obj: bpy.types.Object, options: Namespace) -> None:
    """Set the source of the object's density and the threshold or label of its grid, if given.

    Raises MeasureError.

    The object's settings change in memory. Only --write saves them, together with the results.
    """
    source, name = option_types.split_source(options.density_from or "")
    new_settings: dict[str, Any] = {}
    if options.threshold is not None and obj.type == "VOLUME":
        new_settings |= {"grid_as": "THRESHOLD", "threshold": options.threshold}
    if options.label is not None and obj.type == "VOLUME":
        new_settings |= {
            "grid_as": "LABEL",
            "label": 0 if options.label == "all" else options.label,
        }
    if options.polynomial is not None:
        source = "polynomial"
        new_settings["density_polynomial"] = options.polynomial
    if source:
        new_settings |= {"mass_from": "DENSITY", "density_from": source.upper()}
    if source == "attribute":
        new_settings["density_attribute"] = name
    if source == "volume":
        volume = bpy.context.scene.objects.get(name)
        if volume is None or volume.type != "VOLUME":
            raise QueryError(session.findings.NO_SUCH_NAME, kind="Volume object", name=name)
        new_settings["density_volume"] = volume
    for key, value in new_settings.items():
        setattr(obj.body_moments, key, value)
