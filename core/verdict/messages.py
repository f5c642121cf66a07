# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The one table of what can be found, decided, refused or reported: code → severity and message.

A message is a `str.format` template over the finding's values. `plural` is taken where the value `count` is not 1.
Values stay numbers, strings, booleans and lists; only the table formats them:

    {share:percent}      a fraction, as 12.3%                {samples:size}   integers, as 2 x 3 x 4
    {thickness:length}   meters, as the scene shows them     {point:point}    three of these
    {names}              a list, the first 8: “A”, “B”, and 3 more    {side:word}     a word of ours, to be translated
    {cause}, {causes}    another finding, or several ({"code", "values"}): their messages
    {elements}           what it is about (`Finding.elements`, of which there are `count`): 3, 5, 9, or 3 of “Cube”

The optional value `sources` (names of the objects that a surface came from, where that is not the measured object
itself) puts “A”, “B”: before any message. `accepted` says that a user has judged the finding: a warning is a note then.
"""

from __future__ import annotations

import string
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from .finding import MAX_STORED_ELEMENTS, Elements, Finding, Severity, truncate
from .method import Method, Verdict

MAX_LISTED = MAX_STORED_ELEMENTS
ACCEPTED = "Accepted: {}"  # before a finding that a user has judged, by its value `accepted`


@dataclass(frozen=True)
class Message:
    """severity: "note", "warning" or "error". text: for one; plural: for another `count`, where the two differ."""

    severity: Severity
    text: str
    plural: str | None = None


def _note(text: str, plural: str | None = None) -> Message:
    return Message(Severity.NOTE, text, plural)


def _warning(text: str, plural: str | None = None) -> Message:
    return Message(Severity.WARNING, text, plural)


def _error(text: str, plural: str | None = None) -> Message:
    return Message(Severity.ERROR, text, plural)


def _item(item: Any, translate: Callable[[str], str]) -> str:
    """A number, “a name”, or a pair of them: 3 of “Cube”."""
    if hasattr(item, "tolist"):
        item = item.tolist()
    if isinstance(item, (list, tuple)):
        return translate("{} of {}").format(*[_item(part, translate) for part in item])
    return "“{}”".format(item) if isinstance(item, str) else "{}".format(item)


def truncate_list(items: Elements, count: int | None = None, translate: Callable[[str], str] = str) -> str:
    """Write the first items of a list, names in quotation marks, and how many more there are.

    Parameters
    ----------
    items : sequence
        Names, numbers, or pairs of them.
    count : int, optional
        How many there are in all, where `items` are only the first of them.
    translate : callable
        Applied to the template of what is not an item.

    Returns
    -------
    str
        “A”, “B”, and 3 more.
    """
    shown, more = truncate(items, MAX_LISTED, count)
    texts = [_item(item, translate) for item in shown]
    if more:
        texts.append(translate(MESSAGES["and_more"].text).format(count=more))
    return ", ".join(texts)


class _Formatter(string.Formatter):
    """`str.format` with the formats named above. lengths: what shows a length in meters, by default in meters."""

    def __init__(self, translate: Callable[[str], str], lengths: Callable[[float], str] | None) -> None:
        self.translate, self.lengths = translate, lengths or "{:.4g} m".format

    def format_field(self, value: Any, format_spec: str) -> str:
        if isinstance(value, Mapping):
            return sentence(Finding.from_record(value), self.translate, self.lengths)
        if value is None:  # what was not finite before it was stored
            return self.translate("unknown")
        if format_spec == "percent":
            return "{:.3g}%".format(100.0 * value)
        if format_spec == "length":
            return self.lengths(value)
        if format_spec == "word":
            return self.translate(value)
        if format_spec == "size":
            return " x ".join("{:d}".format(number) for number in value)
        if format_spec == "point":
            return "({})".format(", ".join(self.lengths(number + 0.0) for number in value))
        if isinstance(value, (list, tuple)):
            if len(value) and isinstance(value[0], Mapping):
                return self._joined([self.format_field(finding, "") for finding in value])
            return truncate_list(value, translate=self.translate)
        return super().format_field(value, format_spec)

    @staticmethod
    def _joined(texts: Sequence[str]) -> str:
        """Sentences after one another, clauses with commas."""
        return "".join(text + (" " if text.endswith(".") else ", ") for text in texts[:-1]) + "".join(texts[-1:])


def sentence(
    finding: Finding, translate: Callable[[str], str] = str, lengths: Callable[[float], str] | None = None
) -> str:
    """The sentence of a finding. translate: applied to each template before it is filled. lengths: what shows a length
    in meters, by default in meters."""
    entry, values = MESSAGES[finding.code], finding.values
    template = entry.text if entry.plural is None or values.get("count") == 1 else entry.plural
    elements = truncate_list(finding.elements, values.get("count"), translate)
    text = _Formatter(translate, lengths).vformat(translate(template), (), {**values, "elements": elements})
    sources = values.get("sources")
    text = "{}: {}".format(truncate_list(sources, translate=translate), text) if sources else text
    return translate(ACCEPTED).format(text) if values.get("accepted") else text


def severity(finding: Finding) -> Severity:
    """How much a finding matters, by its code; a warning that was accepted is a note."""
    by_code = MESSAGES[finding.code].severity
    return Severity.NOTE if by_code == Severity.WARNING and finding.values.get("accepted") else by_code


def of_severity(findings: Iterable[Finding], *severities: Severity) -> list[Finding]:
    """Those of the findings that have one of the severities."""
    return [finding for finding in findings if severity(finding) in severities]


MESSAGES: dict[str, Message] = {
    # ------------------------------------------------------------------ Meshes: what cannot be measured (core/solid)
    "no_faces": _error("No faces. Add faces, or select another object."),
    "no_geometry": _error("No geometry. Add faces, or check whether a modifier removes them."),
    "no_face_area": _error("All faces have zero area. Move their vertices apart, or select another object."),
    "surface_not_closed": _error(
        "The surface does not close, and its volume depends on the reference point. Use the moments of the body that "
        "measure_solid makes of it."
    ),
    "boundary_open": _error(
        "The facets do not close, and the moments of what they enclose depend on the reference point. Add the missing "
        "ones, or turn those that face the other way by “signs”."
    ),
    "no_volume": _error(
        "The faces enclose no volume. Set Kind to Shell, close the mesh, or use Measure Section for a flat shape."
    ),
    "no_certain_volume": _error("The volume is zero within rounding. Check for vertices far away from the object."),
    "invalid_faces": _error("Faces use vertices that do not exist. Run mesh.validate() in the Python Console."),
    "non_finite_vertices": _error(
        "{count} of {total} vertices has no finite coordinates. Delete it, or fix the modifier, driver or import that "
        "made it.",
        "{count} of {total} vertices have no finite coordinates. Delete them, or fix the modifier, driver or import "
        "that made them.",
    ),
    "object_too_large": _error("Too large to be measured. Scale the object down."),
    "object_too_small": _error("Too small to be measured. Scale the object up."),
    "moments_overflow": _error(
        "Moments of order {order} exceed the range of numbers. Scale the object, or choose a lower order."
    ),
    "moments_overflow_at_origin": _error(
        "About this origin, moments of order {order} exceed the range of numbers. Set About to Center."
    ),
    "mass_moments_unknown": _error(
        "Moments of the mass are not available to order {order} for this object. Set Order to 3, or Domain to Volume."
    ),
    "moments_of_flat": _error("A flat shape has no volume. Set Domain to Area."),
    "invariants_of_flat": _error("Invariants are those of flat shapes. Set Domain to Area."),
    "invariants_order": _error("Invariants need order {order}. Set Order, and compute the moments."),
    "normalization_undefined": _error(
        "The moments cannot be normalized: the volume or area is zero. Set About to Center."
    ),
    # ------------------------------------------------------------------ Meshes: what was found and repaired
    "vertices_welded": _warning(
        "Open edges were welded: vertices moved by up to {share:percent} of the size. Use Mesh > Merge > By Distance."
    ),
    "vertices_welded_slightly": _note("Open edges were welded: vertices moved by up to {share:percent} of the size."),
    "duplicate_faces_ignored": _warning(
        "Duplicate face left out: {elements}. Delete it.", "{count} duplicate faces left out: {elements}. Delete them."
    ),
    "duplicate_faces_ignored_slightly": _note(
        "Duplicate face left out: {elements}.", "{count} duplicate faces left out: {elements}."
    ),
    "duplicate_faces_counted": _warning(
        "Duplicate face counted twice: {elements}. Delete it.",
        "{count} duplicate faces counted twice: {elements}. Delete them.",
    ),
    "duplicate_faces_counted_slightly": _note(
        "Duplicate face counted twice: {elements}.", "{count} duplicate faces counted twice: {elements}."
    ),
    "t_junctions": _note(
        "{count} gap without area (T-junction) was taken as closed.",
        "{count} gaps without area (T-junctions) were taken as closed.",
    ),
    "flipped_faces": _warning(
        "Flipped face measured as reversed: {elements}. Use Mesh > Normals > Recalculate Outside.",
        "{count} flipped faces measured as reversed: {elements}. Use Mesh > Normals > Recalculate Outside.",
    ),
    "flipped_faces_slightly": _note(
        "Flipped face measured as reversed: {elements}.", "{count} flipped faces measured as reversed: {elements}."
    ),
    "inverted_components": _warning(
        "Inside-out components measured as reversed: {count} of {total}. Use Mesh > Normals > Recalculate Outside."
    ),
    "inverted_components_slightly": _note("Inside-out components measured as reversed: {count} of {total}."),
    "holes_capped": _warning(
        "Holes capped: {count} ({flat} flat, {curved} curved; {share:percent} of the area). Use Mesh > Clean Up > Fill "
        "Holes."
    ),
    "holes_capped_slightly": _note("Holes capped: {count} ({share:percent} of the area)."),
    "one_sided_components": _warning(
        "One-sided components cannot be closed: {count} of {total}. Volume, center of mass and inertia depend on "
        "the reference "
        "point. Set Kind to Shell."
    ),
    "non_manifold_components": _warning(
        "Components cannot be closed where more than two faces meet at an edge: {count} of {total}. Volume, "
        "center of mass "
        "and inertia depend on the reference point. Delete interior faces and fill holes, or set Kind to Shell."
    ),
    "cavities_subtracted": _note(
        "{count} cavity was subtracted: an inward component inside another.",
        "{count} cavities were subtracted: inward components inside others.",
    ),
    "cavities_break_through": _warning(
        "{count} cavity breaks through its wall, by up to {share:percent} of the size; what lies outside counts as "
        "negative. Make the cavity smaller or the wall thicker.",
        "{count} cavities break through their walls, by up to {share:percent} of the size; what lies outside counts as "
        "negative. Make the cavities smaller or the walls thicker.",
    ),
    "cavities_break_through_slightly": _note(
        "{count} cavity breaks through its wall, by up to {share:percent} of the size.",
        "{count} cavities break through their walls, by up to {share:percent} of the size.",
    ),
    "components_nested": _warning(
        "{count} outward component lies inside another; the shared space counts twice. Flip cavities, or set "
        "Overlaps to "
        "Count as Union.",
        "{count} outward components lie inside others; the shared space counts twice. Flip cavities, or set "
        "Overlaps to "
        "Count as Union.",
    ),
    "components_nested_slightly": _note(
        "{count} outward component lies inside another; the shared space counts twice.",
        "{count} outward components lie inside others; the shared space counts twice.",
    ),
    "components_overlap": _warning(
        "{count} components overlap; the shared space counts twice. Set Overlaps to Count as Union."
    ),
    "components_overlap_slightly": _note("{count} components overlap; the shared space counts twice."),
    "overlap_unchecked": _warning(
        "{count} pair of components was not checked for overlap, which would take too long.",
        "{count} pairs of components were not checked for overlap, which would take too long.",
    ),
    "flat_components": _warning(
        "{count} of {total} components is flat and has no volume. Delete it, or set Kind to Shell.",
        "{count} of {total} components are flat and have no volume. Delete them, or set Kind to Shell.",
    ),
    "flat_components_slightly": _note(
        "{count} of {total} components is flat and has no volume.",
        "{count} of {total} components are flat and have no volume.",
    ),
    "flat_surface": _warning("The surface is flat and encloses no volume. Set Kind to Shell."),
    "self_intersecting": _warning(
        "The surface intersects itself and regions count as negative. Set Overlaps to Count as Union, or repair "
        "the mesh."
    ),
    "self_intersection": _warning(
        "The surface intersects itself: about {share:percent} of the volume counts twice or as negative. Set Overlaps "
        "to Count as Union, or repair the mesh."
    ),
    "self_intersection_slightly": _note(
        "The surface intersects itself: about {share:percent} of the volume counts twice or as negative."
    ),
    "self_intersection_unchecked": _note("Whether the surface intersects itself was not checked."),
    "negative_inertia": _error(
        "The surface intersects itself or cannot be closed, and regions count as negative. Set Overlaps to Count as "
        "Union, repair the mesh, or set Kind to Shell."
    ),
    "non_planar_faces": _warning(
        "Non-planar faces: their triangulation can change the volume by up to {share:percent}. Use Face > Triangulate "
        "Faces."
    ),
    "non_planar_faces_slightly": _note(
        "Non-planar faces: their triangulation can change the volume by up to {share:percent}."
    ),
    "non_planar_faces_of_display_mesh": _note(
        "Non-planar faces of the display mesh: their triangulation can change the volume by up to {share:percent}."
    ),
    "duplicate_faces_of_shell": _warning(
        "{count} duplicate face counts as material. Delete it.",
        "{count} duplicate faces count as material. Delete them.",
    ),
    "duplicate_faces_of_shell_slightly": _note(
        "{count} duplicate face counts as material.", "{count} duplicate faces count as material."
    ),
    # ------------------------------------------------------------------ Union
    "union_by_boolean": _note("Overlapping components were united by Blender's exact Boolean, accurate to 7 digits."),
    "union_failed": _error(
        "Blender's Boolean cannot unite the components. Close and clean up the mesh, or set Overlaps to Count "
        "Each Shell."
    ),
    "holes_capped_before_union": _warning("Holes capped before uniting ({share:percent} of the area)."),
    "holes_capped_before_union_slightly": _note("Holes capped before uniting ({share:percent} of the area)."),
    "faces_reversed_before_union": _warning(
        "Faces were turned outward before uniting. Use Mesh > Normals > Recalculate Outside."
    ),
    "open_components_united": _warning(
        "Open components were united; the result may not be the intended body. Close the mesh."
    ),
    "union_of_display_mesh": _warning(
        "The display mesh was measured, as uniting needs polygons. Raise Resolution Preview, or set Overlaps to Count "
        "Each Shell."
    ),
    # ------------------------------------------------------------------ Instances
    "zero_scale": _error(
        "A zero scale flattens the object. Set its scale and its parents' scale, or set Kind to Shell."
    ),
    "all_instances_zero_scale": _error("A zero scale flattens all instances. Set their scale, or set Kind to Shell."),
    "instances_zero_scale": _warning(
        "{count} instance is flattened by a zero scale and encloses nothing.",
        "{count} instances are flattened by a zero scale and enclose nothing.",
    ),
    "instances_vanished": _note(
        "Left out: {count} instance scaled to zero.", "Left out: {count} instances scaled to zero."
    ),
    "no_visible_instances": _error("All instances are scaled to zero. Set their scale."),
    "instance_overlap_unchecked": _warning(
        "Overlap was not checked between {count} instances whose bounding boxes overlap. Use Object > Apply > Make "
        "Instances Real and join them."
    ),
    "flat_instance_sources": _warning(
        "{count} of {total} surfaces is flat: its area counts, its volume does not.",
        "{count} of {total} surfaces are flat: their areas count, their volumes do not.",
    ),
    "flat_instance_sources_slightly": _note(
        "{count} of {total} surfaces is flat and has no volume.",
        "{count} of {total} surfaces are flat and have no volume.",
    ),
    "non_finite_instances": _error(
        "{count} of {total} instance transforms is not finite. Fix what makes NaN or infinity.",
        "{count} of {total} instance transforms are not finite. Fix what makes NaN or infinity.",
    ),
    "instances_of_hidden_object": _error("Blender makes no instances of a hidden object. Show it in the viewport."),
    "instanced_object_unreadable": _error("The instanced object “{object}” cannot be read: {cause}"),
    "instanced_by_parent": _note("Shown only as instances of “{parent}”; measured once, at its own location."),
    "only_volume_instances": _error("Only instances of volumes are shown. Measure the Volume objects."),
    "instances_beside_volume": _warning("Left out: instances shown beside the volume."),
    "empty_without_instances": _error(
        "The empty instances nothing. Choose a collection in Object Properties > Instancing."
    ),
    "collection_without_surface": _error(
        "The instanced collection shows no surface. Add or show an object with faces."
    ),
    "instancer_hidden": _error("The object's own geometry is not shown. Turn on Show Instancer in Object Properties."),
    # ------------------------------------------------------------------ Visibility
    "not_in_scene": _error("Not in the scene “{scene}”. Link the object to a collection of the scene."),
    "disabled_in_viewports": _error("Disabled in viewports. Turn on the monitor icon in the Outliner."),
    "collection_excluded": _error(
        "The collection “{collection}” is excluded from the view layer. Enable it in the Outliner."
    ),
    "collection_disabled": _error(
        "The collection “{collection}” is disabled in viewports. Turn on its monitor icon in the Outliner."
    ),
    "collection_hidden": _error("The collection “{collection}” is hidden. Turn on its eye icon in the Outliner."),
    "hidden_in_viewport": _error("Hidden in the viewport. Turn on the eye icon in the Outliner."),
    "not_evaluated": _error("Blender has not evaluated the object. Update the view layer."),
    "hidden_object_measured": _warning("Measured although not shown: {cause}"),
    "object_without_geometry": _error("Objects of type {type} have no geometry. Select an object with a surface."),
    "non_finite_transform": _error(
        "The transform is not finite. Reset location, rotation and scale, of the parents too."
    ),
    "not_rendered": _note("Not rendered. Turn on the camera icon in the Outliner, or use --all."),
    "boolean_operand": _note("Only an operand of Boolean modifiers. Use --all to measure it."),
    "solid_operand_measured": _warning(
        "Measured as a part, but cuts or joins “{object}” by a Boolean modifier. Display it as wire or bounds, or turn "
        "off its rendering, if it is no part."
    ),
    # ------------------------------------------------------------------ Modes, modifiers, render differences
    "edit_mode_modifiers": _note("Read in Edit Mode with its modifiers: {modifiers}."),
    "edit_mode_shape_keys": _note("Read in Edit Mode with shape keys."),
    "edit_mode_mesh": _note("Read from the mesh in Edit Mode."),
    "edit_mode_single_shape_key": _warning(
        "Only the edited shape key “{shape_key}” was read. Leave Edit Mode to blend all."
    ),
    "edit_mode_modifiers_off": _warning("Modifiers off in Edit Mode were left out: {modifiers}. Leave Edit Mode."),
    "sculpt_mode_modifiers": _note("Read in Sculpt Mode with the modifiers that act there."),
    "dynamic_topology": _error("The mesh sculpted with Dyntopo cannot be read. Leave Sculpt Mode."),
    "sculpted_multires": _error("The levels sculpted with “{modifier}” cannot be read. Leave Sculpt Mode."),
    "modifier_error": _warning("The modifier “{modifier}” reports an error: {error}"),
    "render_differs": _warning("Measured as in the viewport; the render differs: {differences}."),
    "render_only_members": _warning("Left out, as only the render shows them: {objects}."),
    "viewport_only_members": _warning("Measured, although the render does not show them: {objects}."),
    # clauses of `differences`: each a finding of its own, joined by semicolons
    "render_modifier_off": _note("“{modifier}” is not rendered"),
    "render_modifier_only": _note("“{modifier}” is only rendered"),
    "render_levels_differ": _note("“{modifier}” has {viewport} in the viewport and {render} in the render"),
    "render_particles_differ": _note("“{modifier}” shows {share:percent} of its particles"),
    "render_resolution_differs": _note("resolution is {viewport:.3g} in the viewport and {render:.3g} in the render"),
    "render_resolution_u_differs": _note("Resolution U is {viewport} in the viewport and {render} in the render"),
    "render_resolution_v_differs": _note("Resolution V is {viewport} in the viewport and {render} in the render"),
    # ------------------------------------------------------------------ Object types without a surface
    "no_surface": _error("No surface. Add one, for example with a modifier."),
    "only_without_surface": _error("No surface, only {kinds}. Add a surface, for example with a modifier."),
    "only_loose_geometry": _error(
        "No faces, only {vertices} vertices and {edges} edges. Fill faces, or add thickness with a modifier."
    ),
    "surfaceless_left_out": _warning("Left out, as without a surface: {kinds}."),
    "lines_only_curve": _error(
        "Lines without a surface. Add a bevel or extrusion, fill the curve, or set Kind to Wire."
    ),
    "lines_only_text": _error("Lines without a surface. Add a bevel or extrusion, or fill the text."),
    "lines_only_surface": _error("Lines without a surface. Extrude them in Edit Mode, or use a curve object."),
    "splines_without_surface": _error(
        "No spline has a surface: too few points for the order or for Bézier ends. Add points, lower Order, or "
        "turn off "
        "Bézier in Active Spline."
    ),
    "empty_text": _error("The text is empty. Type a text."),
    "metaball_of_family": _error("“{object}” holds the polygons of this metaball family. Measure that object."),
    "metaball_family": _note("Holds the polygons of its metaball family: {objects}."),
    # kinds that were left out, counted; used inside {kinds}
    "kind_curves": _note("{count} curve without thickness", "{count} curves without thickness"),
    "kind_points": _note("{count} point", "{count} points"),
    "kind_volumes": _note("{count} volume", "{count} volumes"),
    "kind_metaballs": _note(
        "{count} metaball, which Blender cannot instance", "{count} metaballs, which Blender cannot instance"
    ),
    # ------------------------------------------------------------------ Curves, text, metaballs, wires
    "surface_drawn_as_polygons": _note(
        "The surface was measured as drawn polygons. Doubling the resolution makes the error four times smaller."
    ),
    "curves_drawn_as_polygons": _note(
        "The curves were measured as drawn polygons. Doubling the resolution makes the error four times smaller."
    ),
    "curve_not_filled": _note("The curve is not filled; the flat region that it bounds was measured."),
    "curve_fill_measured": _warning("Blender's fill of the curves was measured, overlapping or not: {cause}"),
    "curve_fill_for_density": _warning(
        "Blender's fill of the curve was measured, as a varying density needs polygons."
    ),
    "curve_before_modifiers": _warning("The curve was measured without the modifiers that work on its mesh."),
    "bevel_range_ignored": _warning("The whole curve was measured; the start and end of its bevel are ignored."),
    "splines_left_out": _warning(
        "{count} of {total} splines is left out: too few points for its order or for Bézier ends.",
        "{count} of {total} splines are left out: too few points for their order or for Bézier ends.",
    ),
    "no_curve": _error("No spline is a curve. Add points."),
    "unknown_knots": _error(
        "Blender does not expose the imported knots. Turn Endpoint off and on in Active Spline to make known ones."
    ),
    "only_curves_are_wires": _error("Only curves can be wires. Set Kind to Solid or Shell."),
    "no_length": _error("The curve has no length. Move its points apart."),
    "non_finite_control_points": _error(
        "Some control points have no finite coordinates. Delete them, or fix the modifier or driver that moves them."
    ),
    "shape_keys_of_other_points": _error(
        "The shape keys were made for another number of points. Remove them, or undo what added or removed points."
    ),
    "non_positive_weights": _error(
        "Some control points have weights that are not positive. Set their weights above zero."
    ),
    "curve_open": _error("A curve is open and bounds no region. Close it with Toggle Cyclic, or set Kind to Wire."),
    "curves_not_coplanar": _error(
        "The curves are not in one plane and bound no flat region. Flatten them, or set Kind to Wire."
    ),
    "curve_too_small": _error(
        "A curve is smaller than the rounding of its coordinates. Delete it, move it nearer to the origin, or set"
        " Kind to "
        "Wire."
    ),
    "curves_cross": _error(
        "The curves cross or touch, so the region is ambiguous. Separate them, or set Kind to Wire."
    ),
    # ------------------------------------------------------------------ NURBS surfaces
    "no_patches": _error("No NURBS patches. Add a surface with enough points."),
    "no_extent": _error("All control points coincide. Move them apart."),
    "discontinuous_patch": _error(
        "A patch can be discontinuous at a knot repeated as often as its order. Split the patch there."
    ),
    "area_error_estimate_large": _warning("The estimated error of the area is above the target."),
    "volume_error_estimate_large": _warning(
        "The estimated error of the volume is above rounding, because of extreme weights."
    ),
    "wall_error_estimate_large": _warning("The estimated error of the wall's volume is above the target."),
    "flipped_patches": _warning(
        "{count} patch faces against the others and was measured as reversed. Use Segments > Switch Direction.",
        "{count} patches face against the others and were measured as reversed. Use Segments > Switch Direction.",
    ),
    "flipped_patches_slightly": _note(
        "{count} patch faces against the others and was measured as reversed.",
        "{count} patches face against the others and were measured as reversed.",
    ),
    "ambiguous_patch_sides": _warning(
        "{count} patch side meets more than one other, so the orientation is a guess. Make all patches face outward.",
        "{count} patch sides meet more than one other, so the orientation is a guess. Make all patches face outward.",
    ),
    "inverted_patch_components": _warning(
        "Inside-out components measured as reversed: {count} of {total}. Use Segments > Switch Direction."
    ),
    "inverted_patch_components_slightly": _note("Inside-out components measured as reversed: {count} of {total}."),
    "open_patch_sides": _warning(
        "Open patch sides form no loops to cap, or the surface is one-sided. Volume, center of mass and inertia "
        "depend on "
        "the reference point. Close the surface, or set Kind to Shell."
    ),
    "flat_patch_holes_capped": _warning(
        "Flat holes capped exactly: {count} ({share:percent} of the area). Close the surface."
    ),
    "flat_patch_holes_capped_slightly": _note("Flat holes capped exactly: {count} ({share:percent} of the area)."),
    "curved_patch_holes_capped": _warning(
        "Non-planar holes capped by a cone: {count} ({out_of_plane:percent} of the size out of plane, "
        "{share:percent} of "
        "the area). Close the surface."
    ),
    "curved_patch_holes_capped_slightly": _note(
        "Non-planar holes capped by a cone: {count} ({share:percent} of the area)."
    ),
    "patch_boundary_crosses_itself": _warning(
        "{count} boundary crosses itself; the region beyond the crossing counts as negative.",
        "{count} boundaries cross themselves; the regions beyond the crossings count as negative.",
    ),
    "control_points_recovered": _warning(
        "Control points were recovered from the display mesh, accurate to 6 digits, as modifiers or keys move them."
    ),
    "display_mesh_for_density": _warning(
        "The display mesh was measured, as a varying density needs polygons. Raise Resolution Preview for accuracy."
    ),
    "display_mesh_for_modifiers": _warning(
        "The display mesh was measured, as modifiers work on it: {modifiers}. Raise Resolution Preview for accuracy."
    ),
    "display_mesh_for_weights": _warning(
        "The display mesh was measured, as {count} control point has no positive weight. Raise the weight above zero.",
        "The display mesh was measured, as {count} control points have no positive weights. Raise the weights above "
        "zero.",
    ),
    "display_mesh_measured": _warning("The display mesh was measured. Raise Resolution Preview for accuracy."),
    # ------------------------------------------------------------------ Walls
    "no_thickness": _error("The shell has no thickness. Set Thickness."),
    "wall_measured": _note(
        "The wall was measured with real thickness: {thickness:length}, {side:word}, mitered corners."
    ),
    "wall_unoriented": _warning(
        "The surface is not closed; “inward” is behind its faces as they are. Use Mesh > Normals > Flip to change"
        " sides."
    ),
    "wall_faces_reversed": _warning("Faces were turned outward. Use Mesh > Normals > Recalculate Outside."),
    "wall_thickness_varies": _warning(
        "At corners of more than three planes the wall is {minimum:.3g} to {maximum:.3g} times as thick."
    ),
    "wall_thickness_varies_slightly": _note(
        "At corners of more than three planes the wall is {minimum:.6g} to {maximum:.6g} times as thick."
    ),
    "wall_faces_without_area": _warning(
        "{count} face without area moved with its neighbors.", "{count} faces without area moved with their neighbors."
    ),
    "wall_overlap_unchecked": _warning("Overlap of the walls was not checked at this thickness. Press Measure."),
    "walls_overlap": _warning("The walls overlap; the shared space counts twice. Reduce Thickness, or change Wall."),
    "instance_walls_unchecked": _warning(
        "Overlap was not checked between the walls of instances. Use Object > Apply > Make Instances Real and "
        "join them."
    ),
    "wall_folds": _error(
        "A wall of {thickness:length} ({side:word}) folds over itself near {point:point}; the largest is "
        "{largest:length}. Reduce Thickness, change Wall, or set Wall to Thin."
    ),
    "wall_folds_somewhere": _error(
        "A wall of {thickness:length} ({side:word}) folds over itself; the largest is {largest:length}. Reduce "
        "Thickness, change "
        "Wall, or set Wall to Thin."
    ),
    "wall_faces_fold_back": _error(
        "Faces fold back on their neighbors near {point:point}, leaving no room for a wall. Repair them, change "
        "Wall, or "
        "set Wall to Thin."
    ),
    "wall_faces_fold_back_somewhere": _error(
        "Faces fold back on their neighbors, leaving no room for a wall. Repair them, change Wall, or set Wall to Thin."
    ),
    "wall_non_manifold": _error(
        "{count} edge has more than two faces. Separate the parts, or set Wall to Thin.",
        "{count} edges have more than two faces. Separate the parts, or set Wall to Thin.",
    ),
    "wall_inconsistent_faces": _error(
        "{count} edge joins faces with opposite normals. Use Mesh > Normals > Recalculate Outside, or set Wall to"
        " Thin.",
        "{count} edges join faces with opposite normals. Use Mesh > Normals > Recalculate Outside, or set Wall to"
        " Thin.",
    ),
    "wall_precision_lost": _error(
        "{share:percent} of the area is in faces too small, so far from the origin, to have a direction in "
        "float32. Model "
        "nearer to the origin, or set Wall to Thin."
    ),
    "wall_needs_one_density": _error(
        "A wall of real thickness needs one density. Set Density From to One Value, or Wall to Thin."
    ),
    "wall_order": _error(
        "Of a wall of real thickness, moments above order {order} and area moments are not known. Set Wall to Thin."
    ),
    "wall_of_mixed_surfaces": _error(
        "Walls are not supported for NURBS surfaces and meshes together. Set Wall to Thin."
    ),
    "wall_thicker_than_curvature": _error(
        "The wall is thicker than the radius of curvature of its surface. Reduce Thickness."
    ),
    "wall_creases": _warning(
        "At creases of up to {angle:.0f}° the wall overlaps or gapes, as it is not mitered. Use Object > Convert "
        "> Mesh."
    ),
    # ------------------------------------------------------------------ Density and mass
    "density_defaulted": _warning("No density is set: 1000 kg/m³ was used. Set Density or a material."),
    "density_default_kept": _note("No density is set: 1000 kg/m³ was used. Set Density or a material."),
    "linear_density_defaulted": _warning("No linear density is set: 1 kg/m was used. Set Linear Density."),
    "linear_density_default_kept": _note("No linear density is set: 1 kg/m was used. Set Linear Density."),
    "zero_density": _error("The density is zero. Set Density."),
    "zero_mass": _error("The mass is zero. Set Mass."),
    "mass_overflow": _error("The densities are too large. Lower them."),
    "density_volume_missing": _error("No Volume object is chosen for the density. Choose one in Volume."),
    "density_volume_unreadable": _error("The density from “{object}” cannot be read: {cause}"),
    "density_attribute_missing": _error("No vertex attribute is named for the density. Set Attribute."),
    "density_attribute_of_solid": _error(
        "A vertex attribute holds densities on the surface only. Set Kind to Shell, or change Density From."
    ),
    "density_volume_of_shell": _error(
        "A grid holds densities inside a solid only. Set Kind to Solid, or change Density From."
    ),
    "attribute_missing": _error("No vertex attribute “{attribute}”. Create it, or change Attribute."),
    "attribute_type": _error(
        "The attribute “{attribute}” is not a float per vertex. Use Convert Attribute in Object Data Properties."
    ),
    "attribute_non_finite": _error(
        "The attribute “{attribute}” is not finite at {count} vertex: {elements}. Set its density.",
        "The attribute “{attribute}” is not finite at {count} vertices: {elements}. Set their densities.",
    ),
    "attribute_negative": _error(
        "The attribute “{attribute}” is negative at {count} vertex: {elements}. Set its density.",
        "The attribute “{attribute}” is negative at {count} vertices: {elements}. Set their densities.",
    ),
    "materials_of_union": _error(
        "United components have no materials. Set Overlaps to Count Each Shell, or Density From to One Value."
    ),
    "material_without_density": _error(
        "{count} of {total} faces has no material with a density, and Density is zero. Set Density.",
        "{count} of {total} faces have no material with a density, and Density is zero. Set Density.",
    ),
    "object_density_used": _warning(
        "{count} of {total} faces has no material with a density and takes the object's {density:.7g} kg/m³.",
        "{count} of {total} faces have no material with a density and take the object's {density:.7g} kg/m³.",
    ),
    "object_density_used_for_materials": _warning(
        "{count} of {total} faces takes the object's {density:.7g} kg/m³, as these materials have no density: "
        "{materials}.",
        "{count} of {total} faces take the object's {density:.7g} kg/m³, as these materials have no density: "
        "{materials}.",
    ),
    "mixed_material_component": _warning(
        "A component has several materials ({materials}) and takes their mean by area, {density:.7g} kg/m³. Use Mesh > "
        "Separate > By Material."
    ),
    "mixed_material_components": _warning(
        "{count} of {total} components have several materials and take their means by area. Use Mesh > Separate >"
        " By Material."
    ),
    "mixed_materials_slightly": _note(
        "{count} of {total} components has several materials and takes their mean by area.",
        "{count} of {total} components have several materials and take their means by area.",
    ),
    "overlapping_densities": _warning("Densities add up where components overlap. Cut a cavity for each insert."),
    "cavity_material_ignored": _warning(
        "Materials of cavity faces are ignored: a cavity removes the surrounding material."
    ),
    "cavity_material_ignored_slightly": _note("Materials of the faces of small cavities are ignored."),
    "sheared_density_axes": _warning(
        "The object is sheared; its density follows the nearest right-angled axes. Use Object > Apply > Scale."
    ),
    "density_of_united_instances": _error(
        "United instances have no object coordinates. Set Coordinates to World, or Overlaps to Count Each Shell."
    ),
    "density_possibly_negative": _warning(
        "The density may be negative inside the object, though no tested point shows it."
    ),
    "density_negative": _error(
        "The density is negative: {density:.4g} kg/m³ at {point:point} in {frame:word} coordinates. Change Polynomial "
        "or Coordinates."
    ),
    # where a density comes from (the panel, `density_from` of records, body_density_from)
    "density_from_value": _note("one value"),
    "density_from_mass": _note("given mass"),
    "density_from_members": _note("members"),
    "density_from_samples": _note("samples"),
    "density_from_grid": _note("grid “{grid}”"),
    "density_from_grid_of": _note("grid “{grid}” of “{object}”"),
    "density_from_polynomial": _note("polynomial {polynomial}, in {frame:word} coordinates"),
    "density_from_coefficients": _note(
        "polynomial with the coefficients {polynomial} of 1, x, y, z, …, in {frame:word} coordinates"
    ),
    "density_from_attribute": _note("vertex attribute “{attribute}”"),
    "density_from_materials": _note("materials: {materials}"),
    "density_of_material": _note("{material} {density:.7g} kg/m³"),
    "density_of_others": _note("others {density:.7g} kg/m³"),
    "density_mixed_by_area": _note("mixed components by area"),
    # ------------------------------------------------------------------ Polynomials (as typed)
    "polynomial_empty": _error("The polynomial is empty. Type one, such as 1000 + 20*z."),
    "polynomial_too_long": _error("The polynomial is longer than {limit} characters. Shorten it."),
    "polynomial_syntax": _error("The polynomial cannot be read. Write products with *, as in 20*z."),
    "polynomial_syntax_at": _error("The polynomial cannot be read at “{part}”. Write products with *, as in 20*z."),
    "polynomial_nested": _error("The polynomial is nested too deeply or has invalid characters. Simplify it."),
    "polynomial_coefficients": _error("Too many coefficients: the degree is at most {limit}."),
    "polynomial_number_too_large": _error("“{part}” is too large a number."),
    "polynomial_unknown_name": _error("“{part}” is not x, y or z."),
    "polynomial_not_allowed": _error(
        "“{part}” is not allowed in a polynomial. Use numbers, x, y, z, +, -, *, division by a number, whole "
        "powers with "
        "**, and parentheses."
    ),
    "polynomial_caret": _error("“{part}” is not allowed in a polynomial. Write powers with **."),
    "polynomial_division_by_zero": _error("“{part}” divides by zero."),
    "polynomial_exponent": _error("The exponent in “{part}” must be a whole number from 0 to {limit}."),
    "polynomial_degree": _error("“{part}” has a degree above {limit}."),
    "polynomial_not_constant": _error("“{part}” must be a number, without x, y and z."),
    "polynomial_overflow": _error("“{part}” has coefficients outside the range of numbers."),
    "polynomial_beyond_numbers": _error(
        "The polynomial has values outside the range of numbers at the object. Use smaller coefficients, or move the "
        "object nearer to the origin."
    ),
    # ------------------------------------------------------------------ Grids of voxels
    "grid_density": _note("Density from the grid “{grid}”, {samples:size} voxels. {cause}"),
    "grid_density_of": _note(
        "Density from the grid “{grid}” of “{object}”, constant in each voxel. {cause} The error bounds of the "
        "mass are "
        "estimates."
    ),
    "array_density": _note("Density from an array of {samples:size} samples. {cause}"),
    # {cause} of the three above
    "values_scaled": _note("A value of 1 stands for {density:.6g} kg/m³."),
    "values_by_table": _note("Values become densities by the transfer table."),
    "values_scaled_spline": _note(
        "A value of 1 stands for {density:.6g} kg/m³; the values are spline coefficients of order {order}, which "
        "smooth them."
    ),
    "values_by_table_spline": _note(
        "Values become densities by the transfer table; they are spline coefficients of order {order}, which "
        "smooth them."
    ),
    "grid_without_surface": _note(
        "A grid has no surface: the area is 0, the volume is that of the voxels that are not empty."
    ),
    "background_empty": _warning("Voxels with the background value {value:.6g} count as empty."),
    "level_set_measured": _note(
        "The level set “{grid}” was measured as a solid of {polygons} polygons, within a fraction of a voxel."
    ),
    "grid_is_level_set": _error(
        "The grid “{grid}” is a level set of distances, not densities. Set Measure As to Solid, or convert it to a fog "
        "volume."
    ),
    "density_grid_is_level_set": _error(
        "The grid “{grid}” of “{object}” is a level set of distances, not densities. Choose another grid."
    ),
    "grid_is_not_level_set": _error("The grid “{grid}” is not a level set. Set Measure As to Density."),
    "level_set_empty": _error("The level set “{grid}” bounds no volume. Choose another grid."),
    "grid_empty": _error("The grid has no voxels with mass. Choose another grid, or check Values."),
    "density_grid_empty": _error(
        "The grid “{grid}” of “{object}” is empty or flattened. Choose another grid, or set its scale."
    ),
    "density_grid_elsewhere": _error(
        "The grid “{grid}” of “{object}” has no density inside the object. Check where both are."
    ),
    "outside_grid": _warning(
        "{share:percent} of the volume is outside the grid and counts as empty. Enlarge the grid."
    ),
    "outside_grid_slightly": _note("{share:percent} of the volume is outside the grid and counts as empty."),
    "density_grid_too_fine": _error(
        "The grid “{grid}” of “{object}” has too many voxels around the object, {samples:size}. Use a coarser grid."
    ),
    "threshold_measured": _note(
        "The body where the grid “{grid}” is at least {threshold}, by its interpolant. Its surface passes through "
        "{cells} cells."
    ),
    "threshold_clipped": _warning(
        "The body reaches the edge of the grid “{grid}” and is cut off there. Raise Threshold, or enlarge the grid."
    ),
    "threshold_not_reached": _error(
        "No value of the grid “{grid}” reaches the threshold {threshold}; the largest is {largest}. Lower Threshold."
    ),
    "threshold_positions": _error(
        "A threshold needs samples at equal distances. Leave out --positions, or resample the scan."
    ),
    "threshold_needs_factor": _error(
        "Within a threshold, values become densities by a factor alone. Set Values to Factor, or Filled With to "
        "Material."
    ),
    "threshold_too_large": _error(
        "The grid “{grid}” spans too many voxels, {samples}, for a threshold. Resample it, or crop it."
    ),
    "grid_as_shell": _error("A grid of voxels cannot be a shell. Set Kind to Solid."),
    "open_surface_of_grid": _error("The surface is open, so the inside of the grid is undefined. Close the mesh."),
    "object_without_grid": _error("The Volume object shows no grid. Choose another one."),
    "volume_without_grids": _error("The volume has no grids. Choose a file, or add a modifier that makes grids."),
    "volume_file_unreadable": _error("The volume's file cannot be read: {error}. Choose another file."),
    "volume_file_missing": _error("The volume's file is missing or damaged. Choose another file."),
    "grid_missing": _error("No grid “{grid}”; the volume has {grids}. Change Grid."),
    "grid_type": _error("The grid “{grid}” does not hold scalar numbers. Choose another grid."),
    "grid_value_type": _error("The grid “{grid}” holds values of type {type}, not densities. Choose another grid."),
    "no_scalar_grid": _error("No grid holds scalar numbers; the volume has {grids}. Choose another volume."),
    "grid_unreadable": _error("The grid “{grid}” cannot be read: {error}."),
    "grid_frustum": _error("The grid “{grid}” has a frustum transform. Resample it with a linear transform."),
    "grid_too_sparse": _error("The grid “{grid}” spans too many voxels, {samples:size}. Remove distant voxels."),
    "grid_far_from_origin": _error(
        "The voxel indices of the grid “{grid}” are too far from zero. Move its origin nearer."
    ),
    "grid_transform_singular": _error("The transform of the grid is singular or not finite. Set its scale."),
    "grid_names_repeated": _warning("Several grids have the same name; only the first counts. Rename the others."),
    "grids_left_out": _warning("The grid “{grid}” was measured; left out: {grids}."),
    "grid_simplified": _warning(
        "Simplify reduces the voxels to {share:percent} of their resolution. Turn off Simplify in Render Properties."
    ),
    "grid_needs_openvdb": _error(
        "The grid “{grid}” can only be read with the openvdb module, which this Blender lacks. Convert it to floats."
    ),
    "grid_too_large_without_openvdb": _error(
        "The grid “{grid}” has too many voxels, {samples:size}, to be read without the openvdb module."
    ),
    "level_set_needs_openvdb": _error(
        "Level sets cannot be recognized without the openvdb module. Add a Grid to Mesh node and measure the mesh."
    ),
    "grid_not_sampled": _error("The grid “{grid}” cannot be sampled."),
    "temporary_folder_full": _error("Voxels cannot be written to the temporary folder. Free some disk space."),
    "density_non_finite": _error("The densities are not finite, or too large to be summed. Remove such values."),
    "values_non_finite_for_table": _error(
        "Some values are not finite and have no density in the transfer table. Remove them."
    ),
    "values_negative": _error(
        "Negative densities, down to {density:.6g} kg/m³. Set Values to Table, or Measure As to Solid for a level set."
    ),
    "array_negative": _error(
        "Negative densities, down to {density:.6g} kg/m³. Convert the samples to densities, or use File > Import "
        "> Scan of "
        "Densities."
    ),
    "transfer_table_syntax": _error(
        "“{part}” is not a pair of the transfer table: a value and a density in kg/m³, with commas between pairs."
    ),
    "transfer_table_too_short": _error("The transfer table needs at least two pairs of a value and a density."),
    "transfer_table_numbers": _error("The transfer table has negative densities or numbers that are not finite."),
    "transfer_table_order": _error("The values of the transfer table must ascend."),
    # ------------------------------------------------------------------ Arrays and scans
    "file_damaged": _error("The file “{file}” is damaged: {cause}. Obtain it again, or export it again."),
    # clauses of `cause` in file_damaged
    "damage_header": _error("its header has fewer than {bytes} bytes"),
    "damage_lines": _error("it lacks the lines that its header skips"),
    "damage_array": _error("it is not a complete NumPy array"),
    "damage_arrays": _error("it is not a complete archive of NumPy arrays"),
    "damage_archive": _error("it is not a complete archive ({error})"),
    "damage_too_short": _error("it holds {bytes} of the {total} bytes of samples that its sizes require"),
    "damage_too_long": _error("it holds more than the {total} bytes of samples that its sizes require"),
    "damage_too_small": _error("{samples:size} samples cannot be compressed into it"),
    "damage_checksum": _error("the checksum of its compressed part is wrong"),
    "damage_unpacked_length": _error("the length of its compressed part is wrong"),
    "damage_packed_start": _error("its compressed part, or what follows it, does not begin as gzip does"),
    "damage_packed": _error("its compressed part cannot be decompressed ({error})"),
    "damage_packed_end": _error("its compressed part is cut short"),
    "damage_ply_header": _error("its header is not that of a PLY file"),
    "damage_ply_rows": _error("it ends, or has something else than numbers, before its {count} rows of “{name}” do"),
    "damage_ply_index": _error("a face has a vertex that is not among its {vertices}"),
    "nrrd_skip_from_end": _error("“byte skip: -1” is for raw samples; compressed ones are counted from their start."),
    "no_3d_array": _error("No array in the file has 3 dimensions."),
    "arrays_left_out": _warning("The array “{array}” was measured; left out: {arrays}."),
    "raw_type_unknown": _error("Unknown sample type “{type}”. Use one of {types}."),
    "raw_without_layout": _error(
        "A raw file does not describe its samples. Name it NAME_XxYxZ_TYPE.raw, such as "
        "head_128x128x54_uint16.raw, or add "
        "an NRRD header."
    ),
    "nifti_unrecognized": _error("Not a NIfTI-1 file."),
    "nifti_header_of_pair": _error("The file is the header of a .hdr and .img pair. Save it as one .nii file."),
    "nifti_dimensions": _error("The NIfTI header gives {dimensions} dimensions."),
    "nifti_type": _error("The NIfTI data type {type} is not a supported real number."),
    "nifti_type_size": _error("The NIfTI header contradicts itself: {bits} bits for data type {type}."),
    "nifti_offset": _error("The NIfTI header gives an impossible data offset, {offset:g}."),
    "nifti_spacing": _error("The NIfTI header gives an impossible spacing, {x:g} x {y:g} x {z:g}."),
    "nifti_rotation": _error("The NIfTI header gives an invalid rotation."),
    "nrrd_unrecognized": _error("Not an NRRD file (NRRD0001 to NRRD0005)."),
    "nrrd_field_missing": _error("The NRRD header lacks the field “{field}”."),
    "nrrd_field_not_numbers": _error("The NRRD field “{field}” is not a list of numbers: {text:.60s}."),
    "nrrd_field_not_one_number": _error("The NRRD field “{field}” must be one number."),
    "nrrd_dimension_mismatch": _error("The NRRD fields “dimension” and “sizes” disagree."),
    "nrrd_type": _error("The NRRD type “{type:.40s}” is not a real number."),
    "nrrd_endian_missing": _error("The NRRD header lacks the byte order (field “endian”)."),
    "nrrd_several_files": _error("The samples are spread over several files. Join them into one."),
    "nrrd_data_file_missing": _error("The data file “{file:.80s}” is missing."),
    "nrrd_data_file_outside": _error(
        "The data file “{file:.80s}” is outside of the header's folder. Move it there; or, if you trust the header, "
        "turn on Allow Outside, or use --allow-outside."
    ),
    "file_exceeds_limit": _error(
        "“{file}” exceeds a limit: {count} {name} of at most {limit}. If you trust the file, set the environment "
        "variable BODY_MOMENTS_LIMITS to {name}={next}."
    ),
    "limits_unrecognized": _error(
        "The environment variable BODY_MOMENTS_LIMITS has “{text}”, which is no limit. Use NAME=NUMBER, with a NAME "
        "of {names}."
    ),
    "nrrd_header_unended": _error("The NRRD header has no end: the empty line before the samples is missing."),
    "nrrd_encoding": _error("The NRRD encoding “{encoding:.40s}” is not supported. Save it as raw or gzip."),
    "nrrd_space_directions": _error("The NRRD field “space directions” must have three vectors."),
    "nrrd_spacings": _error("The NRRD field “spacings” must have three nonzero numbers."),
    "nrrd_vector": _error("The NRRD field “{field}” has a vector that is not three numbers: {text:.60s}."),
    "scan_dimensions": _error("The file has {dimensions} dimensions; a scan has 3. Save one volume of it."),
    "scan_size": _error("The size of the scan is impossible: {samples:size}."),
    "scan_sample_type": _error("Samples of type {type} are not real numbers."),
    "scan_empty": _error("The scan has no samples."),
    "scan_file_type": _error("Unsupported file type. Supported scans: {suffixes}."),
    "scan_out_of_memory": _error("The samples do not fit into memory. Decompress the file."),
    "scan_placement": _error(
        "The header places all samples in one plane: a spacing or direction is zero or not finite."
    ),
    "scan_scaling": _error("The header scales the samples by numbers that are not finite."),
    "scan_non_finite": _error("Some samples are not finite. Remove them."),
    "scan_own_unit": _warning(
        "The file has its own unit; the unit scale applies only to the given spacing and origin."
    ),
    "scan_placement_overridden": _note("Given values replace those of the header: {fields}."),
    "scan_without_spacing": _warning("The file has no spacing: 1 unit was assumed. Use Set Spacing, or --spacing."),
    "samples_positioned": _note("The samples stand at the given positions along {axes}."),
    "positions_missing": _error("The file of positions along {axis}, “{file}”, does not exist."),
    "positions_not_a_row": _error(
        "The positions along {axis} in “{file}” are not one row of numbers, but {dimensions} dimensions of type "
        "{type}. Save an array of one dimension."
    ),
    "positions_count": _error(
        "“{file}” has {count} positions along {axis}, and the scan {samples} samples. Save one for each sample."
    ),
    "positions_of_one_sample": _error(
        "The scan has one sample along {axis}; a position does not tell how thick it is. Leave “{file}” out."
    ),
    "positions_non_finite": _error(
        "Position {place} along {axis} in “{file}” is not finite; the first is position 0. Correct it."
    ),
    "positions_not_ascending": _error(
        "Position {place} along {axis} in “{file}” is not greater than the one before; the first is position 0. Sort "
        "the positions, and the samples with them."
    ),
    "positions_of_other_samples": _error(
        "The grid “{grid}” has samples beyond its {count} positions along {axis}. Import the scan again."
    ),
    "positions_damaged": _error(
        "The positions of the samples of “{grid}” are not rows of ascending numbers. Import the scan again."
    ),
    "positions_only_as_density": _error(
        "The samples of the grid “{grid}” do not stand evenly, and can be measured as a density only. Set Measure As "
        "to Density, or import the scan without positions."
    ),
    "scan_drawn_evenly": _note(
        "Blender draws samples evenly. They are measured where they stand; the ends along {axes} are in their places."
    ),
    "scan_without_unit": _warning("The file has no unit: 1 unit was taken as 1 m. Use Set Spacing, or --unit-scale."),
    "scan_ct_numbers": _note("Negative values are taken as CT numbers, by the transfer table."),
    "given_density_ignored": _warning("The samples are densities; the given density was not used."),
    # ------------------------------------------------------------------ Principal axes, pose, shape
    "axes_all_free": _note("All principal moments are equal; the object's own axes are used."),
    "axes_2_3_free": _note(
        "Principal moments 2 and 3 are equal; the directions nearest to the object's axes are used."
    ),
    "axes_1_2_free": _note(
        "Principal moments 1 and 2 are equal; the directions nearest to the object's axes are used."
    ),
    "axes_ambiguous": _note(
        "The body is symmetric under half a turn; the directions nearest to the object's axes are used."
    ),
    "axes_all_free_by_shape": _note(
        "All principal moments are equal; the shape's own axes nearest to the object's axes are used."
    ),
    "axes_2_3_free_by_shape": _note(
        "Principal moments 2 and 3 are equal; the shape's own directions nearest to the object's axes are used."
    ),
    "axes_1_2_free_by_shape": _note(
        "Principal moments 1 and 2 are equal; the shape's own directions nearest to the object's axes are used."
    ),
    "axes_from_third_order": _warning(
        "The principal axes use moments to order 3 only, as the mesh has many faces; Apply to Object and --pose use "
        "higher orders and may differ."
    ),
    "strict_rule_equal_moments": _error("Zhang and Chen's rule is undefined for equal principal moments. Turn it off."),
    "strict_rule_no_skewness": _error(
        "Zhang and Chen's rule is undefined without skewness along axes 1 and 2. Turn it off."
    ),
    "shape_of_grid": _warning("A grid of densities has no shape for a pose or signature."),
    "pose_of_flat": _warning("A flat shape has no pose. Its plane and second moments say how it lies."),
    "shape_of_stream": _warning("A mesh that is read in blocks has no pose or signature. Use --stream never."),
    "shape_of_wire_or_wall": _error(
        "Pose and signature are not available for wires and walls. Set Wall to Thin, or convert to a mesh."
    ),
    "shape_of_open_surface": _error(
        "Pose and signature depend on the reference point, as the surface is open. Close it, or set Kind to Shell."
    ),
    "shape_far_from_origin": _error("Too far from the world origin for an accurate shape. Move the object nearer."),
    "signature_of_display_mesh": _warning(
        "The signature is that of the display mesh. Raise Resolution Preview for accuracy."
    ),
    "signature_needs_polygons": _error("The signature needs polygons. Use Object > Convert > Mesh."),
    "mirror_image": _error("A mirror image of the active object, which no rotation can match."),
    "flat_mirror_image": _error(
        "A mirror image of the active object, seen from the front. Turn it over, or mirror it."
    ),
    "flat_and_body": _error("A flat shape and a body cannot match. Select objects of one kind, or set Kind to Shell."),
    "flat_of_type": _error("Only meshes, 2D curves and texts can be flat shapes. Convert the object to a mesh."),
    # ------------------------------------------------------------------ Fourier transform
    "fourier_of_wire": _error(
        "The Fourier transform of a wire is not available. Set Kind to Solid or Shell, or Domain to Surface."
    ),
    "fourier_of_open_surface": _error(
        "The surface is open and bounds no body. Close it, set Kind to Shell, or set Domain to Surface."
    ),
    "fourier_of_wall": _error(
        "The Fourier transform needs a thin shell. Set Wall to Thin or Domain to Surface, or apply a Solidify modifier."
    ),
    "fourier_no_extent": _error("The object has no extent. Set Max Frequency."),
    "fourier_approximate": _note(
        "The fast Fourier transform of this grid is accurate to {share:g} of its value at 0. Use --q for the "
        "closed form."
    ),
    "fourier_of_display_mesh": _warning(
        "The Fourier transform is that of the display mesh. Raise Resolution Preview for accuracy."
    ),
    "fourier_of_uniform_density": _warning("The Fourier transform is that of the shape, with uniform density."),
    "fourier_too_large": _error("Too large for a Fourier transform. Scale the object down."),
    "fourier_too_small": _error("Too small for a Fourier transform. Scale the object up."),
    "fourier_of_array": _error("The Fourier transform of an array is not supported."),
    "fourier_object_count": _error("--fourier needs one object, and there are {count}. Use --object."),
    "fourier_failed": _error("No Fourier transform: {cause}"),
    "fourier_not_written": _error("The Fourier transform cannot be written: {error}."),
    "fourier_folder_missing": _error("The folder “{folder}” does not exist. Choose another File Path."),
    "fourier_path_missing": _error("No file is chosen. Set File Path."),
    "wave_vectors_shape": _error(
        "Wave vectors must be rows of {dimension} real numbers; the array has shape {shape:size} and type {type}."
    ),
    "wave_vectors_non_finite": _error("Some wave vectors are not finite."),
    "wave_vectors_too_large": _error("Some wave vectors exceed 1e100 rad/m."),
    "wave_vectors_unreadable": _error("{file} is not a .npy file: {cause}"),
    "wave_vectors_too_many": _error("There are {count} wave vectors, of at most {limit}. Use several files."),
    "wave_vectors_archive": _error("{file} holds several arrays. Use a .npy file."),
    "frequency_range": _error("The largest frequency must be positive and at most 1e100 rad/m."),
    "frequency_count": _error("A grid needs at least two frequencies along each axis."),
    # ------------------------------------------------------------------ Sections
    "section_no_area": _error("The faces have no area. Select other faces."),
    "section_encloses_nothing": _error("The outlines enclose no area. Close them."),
    "section_not_flat": _error(
        "Not flat: points are up to {share:percent} of the size off a plane. Select faces of one plane, or flatten"
        " them."
    ),
    "outlines_cross": _error("Outlines cross or overlap. Move them apart, or convert to a mesh and unite its faces."),
    "outlines_cross_at": _error(
        "Outlines cross at {count} place. Move them apart, or convert to a mesh and unite its faces.",
        "Outlines cross at {count} places. Move them apart, or convert to a mesh and unite its faces.",
    ),
    "outlines_coincide": _error("Two outlines coincide. Delete one."),
    "outline_open": _error(
        "The outline is open at {count} corner. Close it.",
        "The outline is open at {count} corners. Close it.",
    ),
    "section_face_crosses_itself": _error("Some faces cross themselves. Cut them where they cross."),
    "section_faces_reversed": _warning(
        "{count} face points the other way and counts with the others.",
        "{count} faces point the other way and count with the others.",
    ),
    "section_faces_overlap": _warning(
        "Faces overlap or cross themselves; the shared area counts for each. Separate them."
    ),
    "section_overlap_unchecked": _warning("Too many edges to check all for overlap."),
    "section_projected": _warning(
        "Points up to {share:percent} of the size off the plane were projected. Flatten the faces."
    ),
    "section_projected_slightly": _note("Points up to {share:percent} of the size off the plane were projected."),
    "section_fill_wrong": _warning(
        "Blender's fill covers {share:percent} of the area; the outlines were measured. Simplify them."
    ),
    "section_modified_fill": _note("Blender's fill with its modifiers was measured."),
    "section_without_modifiers": _warning("The faces in Edit Mode were measured without modifiers: {modifiers}."),
    "section_splines_open": _warning(
        "{count} open spline encloses nothing and was left out. Use Toggle Cyclic.",
        "{count} open splines enclose nothing and were left out. Use Toggle Cyclic.",
    ),
    "section_not_filled": _note("The curve is not filled; its outlines were measured as if filled."),
    "section_drawn_as_polygons": _note(
        "Curves were measured as drawn polygons ({corners} corners, resolution {resolution}). Doubling the resolution "
        "makes the error four times smaller."
    ),
    "section_render_resolution": _warning("The viewport resolution was used; the render has {render}."),
    "section_no_selected_face": _error("No face is selected. Select the faces of the section."),
    "section_no_outline_text": _error("No closed outline. Type a text."),
    "section_no_outline_curve": _error("No closed outline. Close the splines with Toggle Cyclic."),
    "section_text_on_curve": _error(
        "The text follows a curve and is not filled. Fill it, or use Object > Convert > Mesh."
    ),
    "section_3d_curve": _error("A 3D curve encloses no flat region. Set it to 2D in Object Data Properties > Shape."),
    "section_extruded": _error("The curve is extruded or beveled. Set Extrude and Bevel Depth to 0."),
    "section_offset": _error("The Offset moves the filled outline. Set it to 0, or use Object > Convert > Mesh."),
    "section_non_finite": _error("Some points have no finite coordinates. Delete them, or fix what made them."),
    # ------------------------------------------------------------------ Editing: objects left unchanged
    "linked_object": _error("Linked from another file. Use Object > Relations > Make Local."),
    "linked_object_data": _error(
        "Linked from another file. Use Object > Relations > Make Local for the object and its data."
    ),
    "library_override_settings": _error(
        "A library override, which would lose its settings. Use Object > Relations > Make Local."
    ),
    "library_override_symmetry": _error(
        "A library override, which would lose its symmetry. Use Object > Relations > Make Local."
    ),
    "library_override_mass": _error(
        "A library override, which would lose its rigid body mass. Use Object > Relations > Make Local."
    ),
    "open_object": _error(
        "The surface is open and cannot be capped, so it has no center of mass. Close it, or set Kind to Shell."
    ),
    "scale_zero_axis": _error("The scale is zero along an axis. Set the scale."),
    "scale_zero_axis_of_parent_target": _error(
        "The scale is zero along an axis. Set the scale, or turn off Parent to Object."
    ),
    "parent_scale_zero": _error("The parent has a zero scale. Set it."),
    "parent_or_delta_scale_zero": _error("The parent's scale or the delta scale is zero. Clear it."),
    "parent_shears": _error("The parent shears the object. Clear the parent, or apply its scale."),
    "channel_locked": _error("The {channel:word} is locked. Unlock it in Object Properties > Transform."),
    "channel_animated": _error("The {channel:word} is animated or driven. Remove the animation."),
    "location_constrained": _error("A constraint or the parent holds the location. Apply or remove it."),
    "rotation_constrained": _error("A constraint or the parent holds the rotation or scale. Apply or remove it."),
    "collection_instance": _error(
        "A collection instance has no geometry of its own. Use Object > Apply > Make Instances Real."
    ),
    "volume_not_reframed": _error(
        "The voxels of a volume cannot be moved inside the object. Use Add Empty or Align Object to World."
    ),
    "data_without_transform": _error("Geometry of this type cannot be transformed. Use Object > Convert > Mesh."),
    "instances_on_own_geometry": _error(
        "Children are instanced on its vertices or faces. Use Object > Apply > Make Instances Real."
    ),
    "render_only_modifier": _error(
        "The modifier “{modifier}” is not shown in viewports and may depend on the origin. Show or remove it."
    ),
    "density_in_object_coordinates": _error(
        "The density polynomial uses object coordinates, which would change. Set Coordinates to World."
    ),
    "density_in_world_coordinates": _error(
        "The density polynomial uses world coordinates and does not move along. Set Coordinates to Object."
    ),
    "bound_to_armature": _error(
        "Bound to the armature “{armature}”, which would not move along. Rotate the armature, or apply its modifier."
    ),
    "shape_depends_on_location": _error(
        "The shape would change, as it depends on the location through {modifiers}. Apply them."
    ),
    "shape_depends_on_location_unknown": _error(
        "The shape would change, as it depends on the location. Use Object > Convert > Mesh."
    ),
    "shape_depends_on_origin": _error(
        "The shape would change, as it depends on the origin or axes through {modifiers}. Apply or remove them."
    ),
    "shape_depends_on_origin_unknown": _error(
        "The shape would change. Apply the scale, or use Object > Convert > Mesh."
    ),
    "text_off_plane": _error("Text can only move in its own plane. Use Object > Convert > Mesh."),
    "child_linked": _error(
        "The child “{object}” is linked from another file and cannot be held in place. Make it local."
    ),
    "child_not_held": _error("The child “{object}” cannot be held in place. Use Object > Parent > Clear Parent on it."),
    "dependent_shape_changes": _error(
        "“{object}” would change shape, as a modifier refers to this object. Apply that modifier."
    ),
    "dependent_curve_changes": _error(
        "“{object}” would change shape, as it uses this object. Use Object > Convert > Mesh on it."
    ),
    "empty_followed": _error(
        "The object follows its empty “{empty}” and would move along. Clear that parent or constraint."
    ),
    "empty_constrained": _error("A constraint holds the empty “{empty}”. Remove it."),
    "data_copied": _note("The data was copied, as other objects use it."),
    "follower_moved": _warning("“{object}” follows by a constraint and moved along."),
    "active_is_child": _error("The active object is a child of this one and would move along. Clear the parent."),
    "not_a_rigid_body": _error("Not a rigid body. Turn on Add Rigid Bodies."),
    "rigid_body_needs_mesh": _error("Only meshes can be rigid bodies. Use Object > Convert > Mesh."),
    "rigid_body_mass_too_small": _error(
        "The mass {mass:.3g} kg is below the {limit:.3g} kg of a rigid body. Raise Density."
    ),
    "rigid_body_display_scaled": _note(
        "Physics properties show masses times {factor:.6g} (unit scale cubed); the physics engine uses kilograms."
    ),
    "rigid_body_center_elsewhere": _warning(
        "Physics uses the origin as center of mass, which differs for {objects}. Use Axes to Principal Axes."
    ),
    "balance_no_selection": _error("No vertex is selected. Select the vertices that may move."),
    "balance_no_area": _error("No movable vertex belongs to a face with area. Select others."),
    "balance_zero_volume": _error("The faces enclose no volume. Close the mesh, or set Kind to Shell."),
    "balance_no_effect": _error("Moving these vertices cannot bring the center of mass there. Select more."),
    "balance_short": _error(
        "The center of mass stays {distance:length} short. Select more vertices, or a nearer point."
    ),
    "balance_short_by_limit": _error(
        "With Max Distance {limit:length} the center of mass stays {distance:length} short. Raise Max Distance, "
        "or select more vertices."
    ),
    "balance_folds_faces": _error(
        "{count} face would turn over. Select more vertices, or a nearer point.",
        "{count} faces would turn over. Select more vertices, or a nearer point.",
    ),
    "balance_no_group": _error("No vertex group “{group}”. Choose one in Vertex Group."),
    "balance_no_active_group": _error("No vertex group. Add one with the vertices that may move."),
    "balance_group_empty": _error(
        "No vertex has a weight in the vertex group “{group}”. Assign the vertices that may move."
    ),
    "balance_triangulation_varies": _error("The triangulation changes with every move. Use Face > Triangulate Faces."),
    "balance_linked_mesh": _error("The mesh is linked from another file. Make it local."),
    "balance_shape_keys": _error("The mesh has shape keys. Apply or remove them."),
    "balance_wall": _error("Balancing needs a thin shell. Set Wall to Thin."),
    "balance_varying_density": _error("Balancing needs uniform density. Set Density From to One Value."),
    "balance_unclean": _error(
        "The mesh is not closed with all faces outward. Merge by distance, fill holes and recalculate normals, or"
        " set Kind to Shell."
    ),
    "balance_zero_scale": _error("A zero scale flattens the object. Set the scale."),
    "balance_instances": _error("The object shows instances. Use Object > Apply > Make Instances Real."),
    "balance_modified": _error("The measured shape is made by {modifiers}. Apply or hide them."),
    "balance_modified_unknown": _error(
        "The measured shape is made by animation, constraints or instances. Apply them."
    ),
    "balance_mesh_shared": _note("Other objects use this mesh and changed too."),
    "balance_only_active": _note("Only “{object}” was balanced; the other meshes in Edit Mode are unchanged."),
    "modified_mesh": _error(
        "Modifiers change the mesh, so its defects are not those of what is measured. Apply or hide {modifiers}."
    ),
    "linked_results": _error("Linked from another file. Make it local to store results."),
    "override_results": _error("A library override, which would lose its results. Make it local to store results."),
    "material_not_local": _error("No local material “{material}”. Make it local."),
    "orientation_needs_viewport": _warning("A transform orientation needs an open 3D Viewport."),
    # ------------------------------------------------------------------ Totals
    "total_boolean_operands": _warning("Boolean operands count as bodies: {operands}. Leave out what is not a part."),
    "total_hidden_objects": _warning(
        "Objects that are hidden, not rendered or displayed as wire or bounds count: {objects}. Leave out what is"
        " not a part."
    ),
    "total_of_open_objects": _warning(
        "The total depends on the reference point, as these are open: {objects}. Close them, or leave them out."
    ),
    "other_scenes": _warning("Only the scene “{scene}” was measured; left out: {scenes}."),
    # ------------------------------------------------------------------ Files and the command line
    "importer_missing": _error("This Blender has no importer for {suffix} files."),
    "import_failed": _error("Blender cannot read the file: {error}."),
    "file_without_objects": _error("No object in the file. Check that it is a {suffix} file."),
    "no_measurable_object": _error("Nothing was measured: there is no object with a surface or volume."),
    "nothing_rendered": _error(
        "Nothing was measured: {count} object was left out. Use --all, or turn on its rendering.",
        "Nothing was measured: {count} objects were left out. Use --all, or turn on their rendering.",
    ),
    "missing_references": _error("The file refers to what cannot be found: {names}. Restore these files."),
    "driver_blocked": _warning(
        "Drivers did not run, as the scripts of files are disabled: {drivers}. Bake what they drive, or save the file "
        "with simple expressions."
    ),
    "script_blocked": _note("A script in the file did not run, as the scripts of files are disabled: {script}."),
    "file_not_opened": _error("Blender cannot open the file. Check that it exists and is complete."),
    "file_read_only": _error("The file is read-only and cannot be saved."),
    "file_not_saved": _error("The file cannot be saved: {error}."),
    "file_vanished": _error("The file cannot be saved: it is no longer there."),
    "file_changed_meanwhile": _error(
        "The file cannot be saved: another program has saved it since it was opened; nothing was overwritten. Measure "
        "it again."
    ),
    "file_changed_since_start": _error(
        "The file cannot be saved: it was saved after Blender started, which may not have read that. Run this again, "
        "or name the file after “measure”."
    ),
    "hard_link_severed": _warning(
        "The file had {count} names (hard links); only “{file}” has the results, the others keep the earlier content."
    ),
    "assets_not_measured": _warning(
        "Assets without numbers in their metadata, because they are not rendered, or not in the scene as an object or "
        "collection: {names}. --all measures what is not rendered."
    ),
    "result_foreign_file": _error("{path} is not a result of body_moments and would be lost"),
    "file_is_folder": _error("A folder, not a file. Name the files in it."),
    "file_type": _error("Unsupported file type. Supported: {suffixes}."),
    "file_missing": _error("No such file."),
    "file_not_regular": _error("Not a regular file."),
    "file_unreadable": _error("The file cannot be read: {error}."),
    "file_empty": _error("The file is empty."),
    "non_finite_coordinates": _error(
        "{count} number in the file is not finite (NaN or infinity), at {place}. Repair the file, or export it again.",
        "{count} numbers in the file are not finite (NaN or infinity), the first at {place}. Repair the file, or "
        "export it again.",
    ),
    "line_misread": _error("Line {line} would be misread: {cause}. Repair the file, or export it again."),
    "field_not_number": _note("“{text}” is not a finite decimal number"),
    "field_not_whole": _note("“{text}” is not a whole number"),
    "field_not_vertex": _note("“{text}” refers to a vertex that is not there"),
    "field_not_word": _note("“{text}” stands in the place of “{expected}”"),
    "field_count": _note("“{text}” has too few numbers or too many"),
    "at_vertex": _note("vertex {vertex}"),
    "at_triangle": _note("triangle {triangle}"),
    "at_mesh_vertex": _note("vertex {vertex} of “{mesh}”"),
    "at_accessor": _note("element {element} of accessor {accessor}"),
    "at_node": _note("node “{node}”"),
    "gltf_buffer_missing": _error("The buffer “{buffer}” is missing. Restore the file beside the glTF file."),
    "gltf_buffer_short": _error(
        "The buffer “{buffer}” is cut short: {size} of {expected} bytes. Export the file again."
    ),
    "threemf_damaged": _error("The 3MF file is damaged: {error}. Export it again."),
    "threemf_field": _error(
        "The 3MF file has “{text}” in <{element}> on line {line}, which cannot be read. Export it again."
    ),
    "threemf_extension": _error(
        "The 3MF file needs an extension that changes its shape and is not read: {name}. Export it as plain meshes."
    ),
    "threemf_instances": _error("The 3MF file places more than {limit} meshes. Join some of them."),
    "iges_unrecognized": _error("Not an IGES file in fixed ASCII form: a line has no section in column 73."),
    "iges_not_ascii": _error("The IGES file is binary or compressed. Save it in fixed ASCII form."),
    "iges_damaged": _error("The IGES file is damaged: {cause}. Export it again."),
    "iges_global_section": _note("its global section is not complete or not possible"),
    "iges_directory": _note("its directory entry {number} is not two lines of whole numbers"),
    "iges_unit": _error("The IGES file has the unknown unit “{unit}”. Export it in millimeters or meters."),
    "obj_call": _error("The file runs another one by “call”, which is not followed. Insert the other file."),
    "surface_file_type": _error("Unsupported file type. Supported files of surfaces: {suffixes}."),
    "file_without_surfaces": _error("The file has no B-spline surfaces. Export surfaces, or import a mesh."),
    "no_surface_kept": _error("No surface of the file can be kept: {causes}"),
    "too_many_surfaces": _error("The file places more than {limit} surfaces. Export fewer at a time."),
    "too_many_control_points": _error(
        "The file's surfaces need more than {limit} control points. Export fewer at a time."
    ),
    "surface_trimmed": _warning(
        "Not imported, because it is trimmed: {kind} {names}. Untrim it, or export a mesh.",
        "Not imported, because they are trimmed: {count} of the kind {kind}: {names}. Untrim them, or export a mesh.",
    ),
    "surface_type_unsupported": _warning(
        "Not imported, because Blender's surfaces cannot be it: {kind} {names}. Convert it to a B-spline surface, or "
        "export a mesh.",
        "Not imported, because Blender's surfaces cannot be them: {count} of the kind {kind}: {names}. Convert them to "
        "B-spline surfaces, or export a mesh.",
    ),
    "surface_of_unsupported": _warning(
        "Not imported, because Blender's surfaces cannot be “{base}”: {kind} {names}. Convert it to a B-spline "
        "surface, or export a mesh.",
        "Not imported, because Blender's surfaces cannot be “{base}”: {count} of the kind {kind}: {names}. Convert "
        "them to B-spline surfaces, or export a mesh.",
    ),
    "surface_order": _warning(
        "Not imported, because its order is {order}, and {limit} is the highest: {kind} {names}. Lower its degree, or "
        "export a mesh.",
        "Not imported, because their order is {order}, and {limit} is the highest: {count} of the kind {kind}: "
        "{names}. Lower their degree, or export a mesh.",
    ),
    "surface_too_large": _warning(
        "Not imported, because it needs {points} control points, and {limit} is the limit: {kind} {names}. Split it.",
        "Not imported, because they need {points} control points each, and {limit} is the limit: {count} of the kind "
        "{kind}: {names}. Split them.",
    ),
    "surface_points": _warning(
        "Not imported: {kind} {names}. {cause}", "Not imported: {count} of the kind {kind}: {names}. {cause}"
    ),
    "surface_damaged": _warning(
        "Not imported, because its numbers are missing or not possible: {kind} {names}. Export it again.",
        "Not imported, because their numbers are missing or not possible: {count} of the kind {kind}: {names}. Export "
        "them again.",
    ),
    "surface_recursive": _warning(
        "Not imported, because it refers to itself, or too deeply: {kind} {names}. Export it again.",
        "Not imported, because they refer to themselves, or too deeply: {count} of the kind {kind}: {names}. Export "
        "them again.",
    ),
    "surface_flattened": _warning(
        "Not imported, because its transformation flattens it: {kind} {names}. Export it again.",
        "Not imported, because their transformations flatten them: {count} of the kind {kind}: {names}. Export them "
        "again.",
    ),
    "surfaces_hidden": _note("{count} hidden surface was left out.", "{count} hidden surfaces were left out."),
    "curves_left_out": _note(
        "{count} curve or point, which bounds nothing, was left out.",
        "{count} curves and points, which bound nothing, were left out.",
    ),
    "surfaces_imported": _note(
        "Imported {count} patch of order {order} from {file}.",
        "Imported {count} patches of order {order} at most from {file}.",
    ),
    "surfaces_rounded": _note(
        "Blender stores control points as 32-bit numbers: points of the surfaces moved by up to {share:percent} of the "
        "size."
    ),
    "not_imported": _warning("Not imported: {cause}"),
    "no_surface_file": _error("No file is chosen. Choose IGES or .obj files."),
    "stl_size": _error("The STL file is cut short or damaged: its size does not match its number of triangles."),
    "stl_cut_short": _error("The STL file is cut short: “endsolid” is missing."),
    "ply_concave_polygons": _error(
        "{count} polygon of the PLY file is concave. Triangulate it, or import it with --stream never.",
        "{count} polygons of the PLY file are concave. Triangulate them, or import them with --stream never.",
    ),
    "file_without_faces": _error("The file has no faces."),
    "mesh_streamed": _warning(
        "{count} face was read in blocks, without repair: self-intersection, nested and inside-out components were not "
        "looked for. Use --stream never where memory allows it.",
        "{count} faces were read in blocks, without repair: self-intersection, nested and inside-out components were "
        "not looked for. Use --stream never where memory allows it.",
    ),
    "streamed_open": _warning(
        "The surface is not closed, or its faces disagree: the volume depends on the reference point. Repair the mesh, "
        "or use --stream never."
    ),
    "streamed_inside_out": _warning("The surface is inside out as a whole and was measured as reversed."),
    "file_exists": _error("The file “{file}” exists. Turn on Overwrite."),
    "volume_not_written": _error("The volume cannot be written: {error}"),
    "openvdb_missing": _error("This Python has no openvdb module. Use Blender."),
    "no_import_file": _error("No file is chosen. Choose a scan."),
    "object_not_in_file": _error("No object of this name in the file."),
    "object_not_in_scene": _error("No object of this name in the scene."),
    "missing_links": _error("Linked data is missing: {names}. Restore the linked files, or make the data local."),
    "moments_unavailable": _error("No moments of this order: {cause}"),
    "thickness_option_unused": _warning("--thickness applies to shells only and was not used. Use --kind shell."),
    "threshold_option_unused": _warning("--threshold applies to arrays, scans and Volume objects and was not used."),
    "stream_options": _error("A mesh that is read in blocks cannot be measured with {options}. Use --stream never."),
    "unit_assumed": _warning("The file has no unit: 1 unit was taken as 1 m. Use --unit-scale."),
    "unit_scale_option_unused": _warning("The file has its own unit; --unit-scale was not used."),
    "array_options_unused": _warning("Options for arrays and scans were not used: {options}."),
    "results_need_blend": _error("Results can only be stored in a .blend file; --write did nothing."),
    "scene_never_saved": _error("The scene was never saved; --write has no file. Save it first."),
    "out_of_memory": _error("Too little memory. Measure it alone, reduce it, or use a larger machine."),
    "interrupted": _error("interrupted; the result was not written"),
    "interrupted_resumable": _error(
        "interrupted after {done} of {total} files; the result was not written. Run the same with --resume to go on"
    ),
    "file_crashed": _error(
        "Blender crashed on the file ({how}), {count} times. Save it again with the program that made it, or leave it "
        "out.",
    ),
    "file_timed_out": _error(
        "The file took longer than {seconds:g} s. Use a longer --timeout, or open it in Blender to see why."
    ),
    "file_took_memory": _error(
        "The file took more than {megabytes:.0f} MB of memory. Use a larger --memory-mb, fewer --jobs, or reduce it."
    ),
    "file_version_unsupported": _error(
        "This Blender ({blender}) cannot read the file, which was saved by Blender {version}. Use a Blender that can."
    ),
    "file_newer_version": _warning(
        "The file was saved by a newer Blender ({version}) than this one ({blender}), which may have lost some of it. "
        "Use that Blender."
    ),
    "progress_files": _note("{done} of {total} files, {rate:.3g} per second, {left} left, {failed} not ok"),
    "progress_started": _note("{done} of {total} files"),
    "progress_done": _note("{count} file in {seconds:.1f} s: {counts}", "{count} files in {seconds:.1f} s: {counts}"),
    "children_failed": _error("no process that measures can be started: {reason}"),
    "scripts_allowed": _warning(
        "Blender was allowed to run the scripts of the file, which may have changed it: {names}. Start Blender with "
        "-Y, or name the file after “measure”."
    ),
    "progress_faces": _note("{count:.3g} faces read. Ctrl+C ends it"),
    "progress_samples": _note("{count:.3g} samples read. Ctrl+C ends it"),
    "internal_error": _error("Internal error: {type}: {error} ({where}). Please report it."),
    # simplex
    "simplex_arrays": _error("The file is no .npz archive with the arrays “points” and “simplices”."),
    "simplex_points": _error("“points” must be rows of 1 to {limit} finite coordinates."),
    "simplex_open": _warning(
        "The facets do not close, so the moments depend on the reference point. Add the missing ones, or turn those "
        "that face the other way by “signs”."
    ),
    "simplex_rows": _error("“simplices” must be rows of {dimension} or one more numbers of points, counted from 0."),
    "simplex_signs": _error("“signs” must be 1 or -1 for each of the simplices."),
    "simplex_point": _error("--about has {count} coordinates, and the points {dimension}."),
    "simplex_too_many": _error("More than {limit} moments of order {order} in {dimension} dimensions. Choose fewer."),
    # similar
    "library_line_too_long": _error(
        "{file}: line {line} has more than {limit} bytes. Write the library with --format jsonl."
    ),
    "library_line": _error(
        "{file}: line {line} is not a body_moments document. Write the library with --format jsonl."
    ),
    "library_unreadable": _error("{file} cannot be read: {error}."),
    "record_without_shape": _error("{name}: no signature, as the body has no shape; see the findings of its record."),
    "record_without_signature": _error("{name}: no signature. Measure with --signature."),
    "signature_unrecognized": _error("The signature was not written by --signature."),
    "signature_incomplete": _error("The signature is incomplete."),
    "name_not_in_library": _error("No body named {name} has a signature."),
    "name_ambiguous": _error("Several bodies are named {name}. Use one of {names}."),
    # wrong usage (exit code 2, after “error: ”)
    "usage_path": _error("{path}: {error}. Use another name"),
    "usage_folder_read_only": _error("argument --{option}: no file can be written in {folder}. Use another folder"),
    "usage_file_needed": _error("a FILE is needed"),
    "usage_folder_missing": _error("argument --{option}: no folder {folder}"),
    "usage_is_folder": _error("argument --{option}: {path} is a folder"),
    "usage_overwrites_input": _error("argument --{option}: {path} is a file that is read. Use another name"),
    "usage_not_replaceable": _error("argument --{option}: {path} cannot be replaced: {error}. Use another name"),
    "usage_foreign_file": _error(
        "argument --{option}: {path} is not a result of body_moments and would be lost. Use another name, or --force"
    ),
    "usage_overwrites_dependency": _error("argument --{option}: {path} is read with a measured file. Use another name"),
    "usage_value": _error("argument --{option}: {cause}"),
    "usage_not_positive": _error("{text!r} is not a positive number"),
    "usage_not_number": _error("{text!r} is not a finite number"),
    "usage_not_triple": _error("{text!r} is not three numbers X,Y,Z"),
    "usage_positions": _error("“{text}” is not x=FILE.npy, y=FILE.npy or z=FILE.npy"),
    "usage_positions_twice": _error("--positions names an axis twice: {axes}"),
    "usage_not_positive_triple": _error("{text!r} is not three positive numbers X,Y,Z"),
    "usage_spline_order": _error("{text!r} is not an order from 1 to {limit}"),
    "usage_order": _error("{text!r} is not an order from 0 to {limit}"),
    "usage_order_too_high": _error("{text!r} is above the highest order, {limit}"),
    "usage_links_of_bones": _error("--links bone takes what the bones' settings say, and no --{option}"),
    "usage_text_format": _error("argument --output: {format} is written as text. Use the suffix .gltf, .usd or .usda"),
    "usage_format_unknown": _error("{text!r} is not one of {formats}"),
    "usage_needs_fourier": _error("argument --{option}: needs --fourier OUT.npz"),
    "usage_fourier_points": _error("argument --fourier: needs either --q Q.npy, or --grid N and --qmax Q"),
    "usage_grid_and_qmax": _error("arguments --grid and --qmax must be used together"),
    "usage_fourier_one_object": _error("argument --fourier: takes one object of one FILE"),
    "usage_path_twice": _error("argument --fourier: {path} is used twice"),
    "usage_frequency_count": _error("{text!r} is not a number of frequencies from 2 to {limit}"),
    "usage_density_source": _error("{text!r} is not value, materials, attribute:NAME or volume:NAME"),
    "material_unknown": _error("There is no material “{name}”. Known are {names}"),
    "density_volume_unknown": _error("There is no Volume object “{name}” in the scene. Name one that is."),
    "usage_range": _error("{text!r} is not A:B, two whole numbers with A no larger than B"),
    "usage_needs_supervisor": _error("argument --{option}: applies to FILEs that are measured by other processes"),
    "usage_command": _error(
        "“{name}” is no command: measure, similar, simplex, audit, manifest, merge, to-csv, summary, compare and "
        "report are"
    ),
    "usage_resume_output": _error("argument --resume: needs the --output of the run to go on with"),
    "usage_no_blender": _error("No module named 'bpy' is here. Use --blender PATH, or install it"),
    "usage_busy": _error("argument --output: another run is writing {path}. Wait for its end, or use another name"),
    "usage_old_foreign": _error(
        "argument --output: {path} is in the way of the older result, and is none itself. Move it, or use --force"
    ),
    "folder_without_files": _error("No file that can be measured is in the folder {folder}. Name files"),
    "results_unreadable": _error("The results {file} cannot be read: {error}"),
    "results_malformed": _error("{file} is not a result of body_moments. Name what “measure” has written"),
    "compare_two": _error("“compare” takes two results"),
    "manifest_unreadable": _error("The list {file} cannot be read: {error}"),
    "manifest_malformed": _error("{file} is not a list of files. Make one with “manifest FOLDER”"),
    "usage_result_not_written": _error("the result cannot be written: {error}"),
    # ------------------------------------------------------------------ Rigid bodies
    "rigid_world_linked": _error(
        "The rigid body world uses the collection “{collection}”, which is linked. Give it one of this file."
    ),
    "rigid_bodies_made": _note(
        "{count} rigid body of {mass:.7g} kg; Calculate Mass would say {calculated:.7g} kg",
        "{count} rigid bodies of {mass:.7g} kg; Calculate Mass would say {calculated:.7g} kg",
    ),
    # ------------------------------------------------------------------ Rigs
    "no_active_armature": _error("The active object is not an armature. Select one."),
    "armature_in_edit_mode": _error("The armature is in Edit Mode. Leave it."),
    "no_deforming_bones": _error("No bone deforms meshes. Make those that do deforming bones."),
    "bone_missing": _warning("Its parent bone “{bone}” does not exist, so it is not in the total. Choose another one."),
    "rig_without_parts": _error(
        "The armature deforms no mesh that can be measured, and nothing is parented to its bones. Add an Armature "
        "modifier to the mesh."
    ),
    "bone_part_impossible": _error("No body has the moments of the bone's part: {cause} Check weights and normals."),
    "bone_parts_impossible": _warning(
        "{count} bone has a part whose moments no body has: {names}. Check weights and normals.",
        "{count} bones have parts whose moments no body has: {names}. Check weights and normals.",
    ),
    "unweighted_vertices": _warning(
        "{count} of {total} vertices has no weight on a deforming bone; faces with such vertices alone go with the "
        "nearest bone. Assign weights.",
        "{count} of {total} vertices have no weight on a deforming bone; faces with such vertices alone go with the "
        "nearest bone. Assign weights.",
    ),
    "rig_open_mesh": _warning(
        "The mesh cannot be closed; each bone's part is closed at its own cuts. Repair the mesh."
    ),
    "rig_wall_thin": _note("The wall counts as a thin sheet: area times thickness."),
    "rig_mean_density": _warning("The density varies; every bone's part has the mean density of the mesh."),
    "bones_measured": _note(
        "{armature}: {mass:.7g} kg in the parts of {count} bone",
        "{armature}: {mass:.7g} kg in the parts of {count} bones",
    ),
    "physics_rig_created": _note("Rigid bodies created: {count}, joints: {joints}"),
    "physics_rig_too_light": _error(
        "Rigid bodies weigh {limit:.3g} kg at least, and these parts less: {names}. Scale the character, or set masses."
    ),
    "rig_center_added": _note("Added the center of mass of “{armature}”, which follows its pose"),
    "stale_rig": _warning("Bones, settings or objects changed"),
    # ------------------------------------------------------------------ References
    "axis_points_coincide": _error("The two points of the axis are too near to each other. Move one of them."),
    "axis_needs_two_points": _error("{count} points are selected. Select two vertices, or two objects."),
    "reference_object_missing": _error("No object is chosen as the reference. Choose one in Object."),
    "reference_stored": _note(
        "Stored the inertia of {count} object about the reference",
        "Stored the inertia of {count} objects about the reference",
    ),
    # ------------------------------------------------------------------ Given parts and assemblies
    "center_given": _note("The center of mass is given."),
    "inertia_given": _note("The inertia is given."),
    "given_inertia_impossible": _error(
        "No body has the given inertia: its principal moments are {moments}, and none may be negative or exceed the "
        "sum of the other two. Check signs and units."
    ),
    "given_center_outside": _warning("The given center of mass is outside the object. Check Center of Mass."),
    "given_center_missing": _warning(
        "The given mass is at the world origin, for no member has a mass. Turn on Given Center."
    ),
    "assembly_mass_given": _note("The mass of the assembly is given: {mass:.7g} kg."),
    "assembly_without_members": _error(
        "Nothing in the assembly has a mass. Add objects that can be measured, or set its mass."
    ),
    "member_counted_before": _note("Counted already, in “{assembly}”."),
    "members_not_measured": _warning(
        "{count} member cannot be measured and is not in the total: {names}. Measure it alone to see why.",
        "{count} members cannot be measured and are not in the total: {names}. Measure them alone to see why.",
    ),
    "members_counted_before": _note(
        "{count} member is in the assembly more than once and counts once: {names}.",
        "{count} members are in the assembly more than once and count once: {names}.",
    ),
    "members_left_out": _note(
        "{count} member is not rendered, or only an operand of Boolean modifiers, and is not in the total: {names}.",
        "{count} members are not rendered, or only operands of Boolean modifiers, and are not in the total: {names}.",
    ),
    "members_excluded": _warning(
        "{count} member is excluded or disabled and is not in the total: {names}. Enable it in the Outliner.",
        "{count} members are excluded or disabled and are not in the total: {names}. Enable them in the Outliner.",
    ),
    "members_hidden": _note(
        "{count} member is hidden and counts: {names}.", "{count} members are hidden and count: {names}."
    ),
    "members_density_unset": _warning(
        "{count} member has no density or mass set and counts with the default: {names}. Set Density.",
        "{count} members have no density or mass set and count with the default: {names}. Set Density.",
    ),
    "members_mass_given": _note(
        "{count} assembly in it has a given mass: {names}.", "{count} assemblies in it have a given mass: {names}."
    ),
    "members_not_stored": _note(
        "{count} member cannot hold results: {names}.", "{count} members cannot hold results: {names}."
    ),
    "instance_without_scale": _error("The instance is scaled to zero along an axis. Set its scale."),
    "instance_stretches_sheets": _error(
        "The instance stretches shells or wires unevenly, and their mass has no one factor. Give it a uniform scale."
    ),
    "no_active_collection": _error("No collection is active. Click one in the Outliner."),
    "no_active_assembly_empty": _error("The active object is not an empty with children. Select one."),
    "assembly_measured": _note(
        "{assembly}: {mass:.7g} kg from {count} object", "{assembly}: {mass:.7g} kg from {count} objects"
    ),
    "assembly_has_open_members": _error(
        "A member is open, and its center depends on a reference point. Close its mesh, or set Kind to Shell."
    ),
    "cursor_to_assembly": _note("Moved the 3D cursor to the center of mass of “{assembly}”"),
    "empty_at_assembly": _note("Placed an empty at the principal frame of “{assembly}”"),
    "assembly_offset_set": _note("Instances of “{assembly}” are placed by its center of mass"),
    "assembly_origin_moved": _note("Moved “{assembly}” to the center of mass; its children stay"),
    "children_would_move": _error(
        "These would move with it: {names}. Remove what holds them, such as constraints or animation."
    ),
    "bill_written": _note(
        "Wrote the masses of {count} member to “{file}”", "Wrote the masses of {count} members to “{file}”"
    ),
    "no_export_file": _error("No file is named. Choose one."),
    "file_not_written": _error("The file cannot be written: {error}"),
    # ------------------------------------------------------------------ Stored results: out of date
    "stale_member": _warning("A member changed, or was measured anew"),
    "stale_members": _warning("Members were added, removed or moved, or given masses changed"),
    "stale_fingerprint": _warning("Fingerprint damaged"),
    "stale_settings": _warning("Settings changed"),
    "stale_geometry": _warning("Geometry changed"),
    "stale_transform": _warning("Transform changed"),
    "stale_scale": _warning("Scale changed"),
    "stale_unit_scale": _warning("Unit scale changed"),
    "stale_results": _warning("Out of date: the object changed after it was measured. Measure it again."),
    "no_stored_results": _error("No stored results. Measure the object."),
    # ------------------------------------------------------------------ Reports of operators
    "nothing_measurable": _note("Nothing selected can be measured"),
    "nothing_to_do": _note("Nothing to do: {cause}"),
    "left_unchanged": _warning("{count} of {total} left unchanged: {causes}"),
    "failure": _warning("{object}: {cause}"),
    "refused": _error("{object}: {cause}"),
    "and_more": _note("and {count} more"),
    "measured_one": _note("Measured {object}"),
    "measured_one_with_warnings": _warning("Measured {object}, with warnings"),
    "measured_several": _note("Measured {count} of {total} objects"),
    "with_warnings": _warning("{count} with warnings: {objects}"),
    "object_warnings": _warning("{object}: {causes}"),
    "measured_section": _note("Measured the section of {object}"),
    "measured_section_with_warnings": _warning("Measured the section of {object}, with warnings"),
    "measured_sections": _note("Measured {count} section", "Measured {count} sections"),
    "no_defects": _note("Measured {count} object: no defects", "Measured {count} objects: no defects"),
    "with_defects": _warning(
        "{count} of {total} measured objects has defects",
        "{count} of {total} measured objects have defects",
    ),
    "object_defects": _warning("{object}: {defects}"),
    "results_removed": _note("Removed the results of {count} object", "Removed the results of {count} objects"),
    "no_results_to_remove": _note("The selected objects have no results"),
    "value_copied": _note("Copied {value}"),
    "no_value_to_copy": _warning("No value to copy"),
    "csv_copied": _note("Copied {count} row.", "Copied {count} rows."),
    "numbers_saved": _note("Saved {count} object to “{file}”.", "Saved {count} objects to “{file}”."),
    "numbers_suffix": _error("The format of “{file}” is unknown. Let its name end in .csv, .json or .jsonl."),
    "report_copied": _note("Copied the report of {count} object", "Copied the report of {count} objects"),
    "section_copied": _note("Copied the section of {object}"),
    "moments_computed": _note("Computed {count} moments of {object}"),
    "moments_copied": _note("Copied {count} moments"),
    "wire_without_moments": _warning(
        "{object}: a wire has no volume or surface. Set Kind to Solid or Shell; measure --order gives moments of "
        "length."
    ),
    "aligned_to_world": _note("Aligned {count} object to the world axes", "Aligned {count} objects to the world axes"),
    "already_aligned": _note("already aligned"),
    "cursor_moved": _note(
        "Moved the 3D cursor to the center of mass of {count} object",
        "Moved the 3D cursor to the center of mass of {count} objects",
    ),
    "empties_placed": _note(
        "Placed an empty at the principal frame of {count} object",
        "Placed empties at the principal frames of {count} objects",
    ),
    "empties_in_place": _note("the empties are in place"),
    "origins_moved": _note(
        "Moved the origin of {count} object to the center of mass",
        "Moved the origins of {count} objects to the center of mass",
    ),
    "axes_made_principal": _note(
        "Aligned the axes of {count} object to its principal axes",
        "Aligned the axes of {count} objects to their principal axes",
    ),
    "already_in_place": _note("already in place"),
    "orientation_created": _note("Created the transform orientation “{name}”"),
    "node_group_added": _note("Added the node group “{group}”"),
    "node_marker_added": _note("Added the node group “{group}” and the marker “{object}”"),
    "node_marker_is_of_solid": _note("nodes take the object as a solid of one density"),
    "no_reversed_faces": _note("no faces were measured as reversed"),
    "faces_reversed": _note("Reversed {count} face", "Reversed {count} faces"),
    "material_set": _note("Set {count} object to {material}", "Set {count} objects to {material}"),
    "material_set_already": _note("already set to {material}"),
    "blender_material_set": _note("Set “{target}” to {material}"),
    "settings_copied": _note("Copied the settings to {count} object", "Copied the settings to {count} objects"),
    "settings_equal": _note("the settings are equal"),
    "rigid_body_masses_set": _note(
        "Set the rigid body mass of {count} object",
        "Set the rigid body mass of {count} objects",
    ),
    "rigid_body_masses_equal": _note("the masses are equal"),
    "balanced": _note(
        "Moved {count} vertex by at most {distance:length}; the center of mass went from {start:point} to {end:point}",
        "Moved {count} vertices by at most {distance:length}; the center of mass went from {start:point} to "
        "{end:point}",
    ),
    "poses_matched": _note("Moved {count} object onto {object}", "Moved {count} objects onto {object}"),
    "pose_distance": _note("{object}: surfaces at most {maximum:length} apart, {mean:length} on average"),
    "pose_not_a_copy": _warning(
        "{object}: surfaces at most {maximum:length} apart, {mean:length} on average; not a copy, or cut off"
    ),
    "shapes_compared": _note("Compared {count} shape", "Compared {count} shapes"),
    "shape_counts": _note("{counts}"),
    # clauses of `counts`
    "shapes_copy": _note("{count} copy", "{count} copies"),
    "shapes_scaled_copy": _note("{count} scaled copy", "{count} scaled copies"),
    "shapes_mirror": _note("{count} mirror image", "{count} mirror images"),
    "shapes_scaled_mirror": _note("{count} scaled mirror image", "{count} scaled mirror images"),
    "shapes_copy_or_mirror": _note("{count} copy or mirror image", "{count} copies or mirror images"),
    "shapes_scaled_copy_or_mirror": _note(
        "{count} scaled copy or mirror image", "{count} scaled copies or mirror images"
    ),
    "shapes_similar": _note("{count} similar"),
    "none_similar": _note("none is similar"),
    "nearest_shape": _note("nearest is {object}, at {distance:.2e}"),
    "object_not_in_view_layer": _error("No object {object} in the view layer"),
    "records_left_out": _warning("Left out: {causes}"),
    "library_file_unreadable": _error("{file} cannot be read: {error}"),
    "symmetry_found": _note("{object}: {group}, {description}"),
    "symmetry_found_of_display_mesh": _note("{object}: {group}, {description}, of the display mesh"),
    "symmetry_searched": _note("Searched {count} object", "Searched {count} objects"),
    "symmetry_sphere": _note("sphere"),
    "symmetry_revolution": _note("body of revolution"),
    "symmetry_revolution_reversible": _note("body of revolution, symmetric end to end"),
    "symmetry_axes": _note("{count} rotation axis, {order}-fold", "{count} rotation axes, up to {order}-fold"),
    "symmetry_planes": _note("{count} mirror plane", "{count} mirror planes"),
    "symmetry_inversion": _note("center of inversion"),
    "symmetry_none": _note("no symmetry"),
    "fourier_written": _note("Wrote {count} frequencies to {file}; the image {image} shows slices of their magnitude"),
    "scan_imported": _note("Imported {samples:size} samples as “{file}”"),
    "canceled_measuring": _note("Measuring canceled; nothing was changed"),
    "canceled_search": _note("Search canceled; nothing was changed"),
    "canceled_match_pose": _note("Match Pose canceled; nothing was moved"),
    "canceled_fourier": _note("Fourier transform canceled; nothing was written"),
    "progress_library": _note("Measuring the library: {share:.0%}. Esc to stop"),
    "canceled_library": _warning("Stopped. The files measured so far stand in the journal"),
    "library_not_started": _error("No process can be started: {error}."),
    "library_failed": _error("Measuring the library failed with exit code {code}. Use the command line to see why."),
    "library_measured": _note("{count} file measured; report: {file}", "{count} files measured; report: {file}"),
    "library_measured_with_failures": _warning(
        "{count} file measured, {failed} without a result; report: {file}",
        "{count} files measured, {failed} of them not or not fully; report: {file}",
    ),
    "progress_measuring": _note("Measuring: {share:.0%}. Esc to cancel"),
    "progress_comparing": _note("Comparing: {share:.0%}. Esc to cancel"),
    "progress_symmetry": _note("Finding symmetry: {share:.0%}. Esc to cancel"),
    "progress_fourier": _note("Fourier transform: {share:.0%}. Esc to cancel"),
    # ------------------------------------------------------------------ Why a button is off (poll_message_set)
    "poll_object_mode": _note("Switch to Object Mode"),
    "poll_select_objects": _note("Select objects"),
    "poll_select_meshes": _note("Select mesh objects"),
    "poll_measure_selected": _note("Measure the selected objects first"),
    "poll_measure_section": _note("Measure a section first"),
    "poll_compute_moments": _note("Compute the moments first"),
    "poll_active_wanted": _note("Make an object active to compare with"),
    "poll_active_measurable": _note("Make a measurable object active"),
    "poll_active_surface": _note("Make an object with a surface active"),
    "poll_active_selected": _note("Make an object active and select it"),
    "poll_active_mesh": _note("Make a mesh object active"),
    "poll_match_selection": _note("Select the objects to move, then the object to match"),
    "poll_edit_vertices": _note("Switch to Edit Mode and select the vertices that may move"),
    "poll_vertices_or_group": _note("Select the vertices that may move in Edit Mode, or add a vertex group"),
    "poll_section": _note("Select faces in Edit Mode, or a flat mesh, 2D curve or text"),
    "poll_select_others": _note("Select other objects besides the active one"),
    # ------------------------------------------------------------------ Panels
    "panel_override": _warning("Library override: settings and results are lost on saving. Make it local."),
    "panel_wall_limit": _note("Largest wall: {length:length}"),
    "panel_wall_folds": _warning("Folds over from {length:length}"),
    "panel_density_mean": _note("Mean density, from {cause}"),
    "panel_no_material_slots": _note("No material slots"),
    "panel_unit_question": _note("{length} long and {mass}: is a unit of this scene a millimeter?"),
    "panel_live_first_order": _note(
        "Live: mass, volume and center of this frame; inertia follows when it stops ({milliseconds:.0f} ms)"
    ),
    "panel_live_behind": _warning("Live lags: measuring takes {milliseconds:.0f} ms, and waits until the edit stops"),
    "panel_posed": _note("Sum of {count} mesh of the armature", "Sum of {count} meshes of the armature"),
    "panel_posed_missing": _warning("Not measured: {objects}"),
    "panel_posed_stale": _warning("Out of date: {objects}"),
    "panel_live": _note("Live ({milliseconds:.0f} ms). Press Measure to store"),
    "panel_orders_copied": _note("Orders {first} to {last} are only in the copy."),
    "panel_symmetry_tolerance": _note("The surface matches its images within {share:.2g} of the radius of gyration"),
    "panel_symmetry_tolerance_of_display_mesh": _note(
        "The display mesh matches its images within {share:.2g} of the radius of gyration"
    ),
    "panel_symmetry_of_moments": _note("Moments to order 6 alone allow {group}"),
    "panel_equal_moments_all": _note("All principal moments are equal"),
    "panel_equal_moments_12": _note("Principal moments 1 and 2 are equal"),
    "panel_equal_moments_23": _note("Principal moments 2 and 3 are equal"),
    "panel_fourier_default": _note("0 rad/m: from the object's size"),
    "panel_nothing_measured": _note("No selected object is measured"),
    "panel_nothing_to_compare": _note("Nothing to compare with"),
    "panel_material_default": _note("None: the object's density is used"),
    # ------------------------------------------------------------------ Stability and balance
    "hull_without_extent": _error("All points are on one line: nothing can stand on it."),
    "center_outside_hull": _error(
        "The center of mass is outside the convex hull: no body can have it there. Check the surface and the density."
    ),
    "no_stable_pose": _error("There is no pose in which it rests: it rolls on."),
    "hull_simplified": _note(
        "“{object}” is finely divided: its convex hull is taken with {corners} corners, to {share:percent} of its size"
    ),
    "stability_computed": _note("{count} of {total} object stands", "{count} of {total} objects stand"),
    "objects_tip": _warning("{names} tips over", "{names} tip over"),
    "laid_on_ground": _note("Laid {count} object on the ground", "Laid {count} objects on the ground"),
    "already_on_ground": _note("already on the ground"),
    "poll_object_or_pose_mode": _note("Switch to Object Mode or Pose Mode"),
    "progress_balance": _note("Following the center of mass: {share:percent}. Esc to cancel"),
    "canceled_balance": _note("Balance Group canceled; nothing was changed"),
    "no_such_collection": _error("There is no collection “{collection}”. Choose another one."),
    "balance_group_without_contacts": _error("“{collection}” has no object with a surface. Choose another collection."),
    "balance_group_empty_group": _error(
        "Nothing to follow. Select objects with a surface, or an armature that deforms some."
    ),
    "balance_group_made": _note(
        "“{empty}” has {count} key of the center of mass; objects: {objects_count}",
        "“{empty}” has {count} keys of the center of mass; objects: {objects_count}",
    ),
    "balance_group_inside": _note(
        "It is over the support polygon at {count} of {total} frames",
    ),
    "panel_stability_unknown": _note("Stability has not been computed."),
    "panel_stability_stale": _note("The geometry has changed. Check again."),
    # ------------------------------------------------------------------ Robots: what a format cannot say
    "robot_links_left_out": _warning(
        "{count} object without mass is no link: {links}.", "{count} objects without mass are no links: {links}."
    ),
    "robot_without_links": _error("There is no link. Measure objects with mass."),
    "robot_without_bones": _error("There is no link. Select an armature with what it moves."),
    "robot_one_file": _error("A robot is one file. Name one FILE for this format, not {count}."),
    "robot_base_added": _note(
        "{count} objects have no parent. They are fixed to an added link without mass, {name}. Parent them to one of "
        "them to avoid it."
    ),
    "robot_ellipsoid_as_box": _note(
        "The format has no ellipsoid. The box of equal mass and inertia stands in its place: {links}."
    ),
    "urdf_effort_unknown": _note(
        "Set effort and velocity of the joint to its motor's. They are placeholders: {joints}.",
        "Set effort and velocity of {count} joints to those of their motors. They are placeholders: {joints}.",
    ),
    "sdf_limits_lost": _warning(
        "SDF knows no limits of a joint about several axes. It moves freely: {joints}.",
        "SDF knows no limits of joints about several axes. {count} move freely: {joints}.",
    ),
    "left_out_of_robot": _warning("{count} of {total} objects are no links: {causes}"),
    "robot_exported": _note("{count} link exported to {file}.", "{count} links exported to {file}."),
    "robot_scaled": _warning(
        "Readers differ about bodies that are scaled. Apply the scale of {links} (Object > Apply > Scale)."
    ),
    "robot_sheared": _warning(
        "Bodies must not be sheared. Apply the scale of the parents of {links} (Object > Apply > Scale)."
    ),
    "robot_names_alike": _error("Blender gives {names} one name in USD. Rename one of them."),
    "gltf_node_missing": _warning(
        "{count} link has no node of its own in the file: {links}.",
        "{count} links have no nodes of their own in the file: {links}.",
    ),
    "gltf_unit_scale": _note(
        "Blender writes its units to glTF as meters: a node above all others scales them by {scale:g}. Readers differ "
        "about bodies that are scaled."
    ),
    "gltf_unreadable": _error("Blender's exporter has not written a glTF file."),
    "robot_geometry_not_written": _error("Blender's exporter failed: {error}."),
    "robot_not_written": _error("The file cannot be written: {error}."),
    "robot_copied": _note("Inertial of {count} link copied.", "Inertials of {count} links copied."),
    "primitives_added": _note("{count} shape added", "{count} shapes added"),
    "primitive_has_parent": _error("It has a parent, or is linked. Clear the parent to simulate it."),
    "robot_links_bare": _note("{count} link has no geometry: {links}.", "{count} links have no geometry: {links}."),
    "robot_meshes_not_written": _error("The meshes cannot be written: {error}."),
    "mjcf_inertia_too_small": _warning(
        "MuJoCo refuses a moving body with a mass or principal moment below {limit:g} kg or kg·m²: {links}, with "
        "{least:.3g}. Set boundmass and boundinertia of the compiler, fix it to its parent, or model in larger units.",
        "MuJoCo refuses moving bodies with a mass or principal moment below {limit:g} kg or kg·m²: {count} of them, "
        "{links}, down to {least:.3g}. Set boundmass and boundinertia of the compiler, fix them to their parents, or "
        "model in larger units.",
    ),
    "mjcf_mesh_too_large": _warning(
        "MuJoCo refuses meshes of more than {limit} triangles: {links}. Reduce them with a Decimate modifier, or leave "
        "geometry out."
    ),
    "usd_inertia_too_small": _warning(
        "The inertia of {links} is too small for the single precision of PhysicsMassAPI. Read newton:inertia, or use "
        "a stage in smaller units."
    ),
    # ------------------------------------------------------------------ Audit of robot descriptions: files
    "xml_entities": _error("The file declares a document type, with which entities could be declared. Remove it."),
    "xml_too_large": _error("The file nests more than {depth} elements or has more than {limit}."),
    "xml_invalid": _error("The file is not XML: {error}."),
    "usda_invalid": _error("The file is not text of USD (line {line})."),
    "usd_not_text": _error("Only the text form of USD is read. Convert the file to .usda with usdcat."),
    "description_unknown": _error("The file is no robot description. Its first element is {tag}."),
    "description_without_links": _error("The file has no links."),
    "description_too_large": _error("The file is larger than {limit} MB, or has too many links."),
    "include_unreadable": _error(
        "A file that it includes cannot be read: {name}. Name its folder with --root, or allow all with "
        "--allow-outside."
    ),
    "include_twice": _error("It includes a file twice: {name}."),
    "description_number": _warning("Line {line}: <{element}> has “{text}” in the place of numbers. Correct it."),
    "mesh_on_network": _warning("A mesh is on a network, and was not loaded: {name}. Download it."),
    "mesh_outside": _warning(
        "A mesh is outside of the folders that may be read: {name}. Name its folder with --root, or allow all with "
        "--allow-outside."
    ),
    "mesh_missing": _warning("A mesh was not found: {name}. Name the folder of its package with --root."),
    "mesh_unreadable": _warning("A mesh is of a kind that is not read: {name}. Convert it to one of {suffixes}."),
    "mesh_damaged": _warning("A mesh cannot be read: {name} ({error})."),
    "mesh_too_large": _warning("A mesh is too large: {name}."),
    "mesh_empty": _warning("A mesh has no triangles: {name}."),
    "audit_done": _note("{links} links: {errors} errors, {warnings} warnings, {notes} notes"),
    "usage_repair_folder": _error("--repair: {path} is no folder"),
    "usage_repair_same": _error("--repair: {path} is the folder of a file that is read. Choose another one"),
    "audit_copies_alike": _error("Two files have one name: {name}. Audit them one at a time, or choose other folders."),
    "audit_text": _note("See the text “{text}” in the Text Editor"),
    "audit_copy_exists": _error("{path} is another file and would be lost. Choose another folder, or --force."),
    "audit_not_written": _error("The file cannot be written: {error}."),
    # ------------------------------------------------------------------ Audit: what no body can have
    "inertial_missing": _warning("No inertial. Readers differ: some take 1 kg, some none. Add mass and inertia."),
    "inertial_not_finite": _error("Mass, center or inertia is not a number."),
    "inertial_of_frame": _note("Zero mass, inertia and no geometry: a mere frame. Leave the inertial out."),
    "inertial_mass_not_positive": _error("The mass is {mass:.6g} kg."),
    "inertial_not_positive": _error("Impossible: the inertia has a principal moment of {moment:.6g} kg·m²."),
    "inertial_triangle": _error(
        "Impossible: the largest principal moment exceeds the sum of the others by {excess:percent}."
    ),
    "inertial_triangle_slightly": _warning(
        "The largest principal moment exceeds the sum of the others by {excess:percent}, as rounding does. Some "
        "readers refuse it; state more digits."
    ),
    "inertial_center_outside": _error("Impossible: the center of mass is {distance:length} outside of the geometry."),
    "inertial_spread_outside": _error(
        "Impossible: with this inertia, mass lies outside of the geometry (variance {factor:.3g} times too large)."
    ),
    # ------------------------------------------------------------------ Audit: the change that makes it right
    "audit_uniform_instead": _warning("Repaired as an even filling of the geometry with the stated mass."),
    "audit_not_uniform": _note(
        "Not an even filling of the geometry: {factor:.4g} times its inertia, the center {distance:length} from its."
    ),
    "audit_up_axis": _warning(
        "The mesh's file says that z is not up. Readers obey that or not; the inertial is right where they do. "
        "Export the mesh with z up."
    ),
    "audit_density": _warning("The density is {density:.3g} kg/m³. Check mass and mesh."),
    "audit_mass_and_inertia_unit": _warning(
        "The density is {density:.3g} kg/m³. Multiply mass and inertia by {factor:g}."
    ),
    "audit_mass_unit": _warning("Multiply the mass by {factor:g}: it then agrees with the geometry."),
    "audit_inertia_unit": _warning("Multiply the inertia by {factor:g}: it then agrees with the geometry."),
    "audit_center_unit": _warning("Multiply the center of mass by {factor:g}: it then agrees with the geometry."),
    "audit_length_unit": _warning(
        "Multiply the lengths of the inertial by {factor:g}, its inertia by the square: it then agrees with the "
        "geometry."
    ),
    "audit_mesh_unit": _warning("Scale the mesh by {factor:g}: the inertial then agrees with it."),
    "audit_inertia_of_unit_mass": _warning("The inertia is that of 1 kg. Multiply it by the mass, {factor:.6g}."),
    "audit_inertia_of_unit_density": _warning(
        "The inertia is that of density 1. Multiply it by the density, {factor:.6g}."
    ),
    "audit_inertia_about_origin": _warning(
        "The inertia is about the origin of the link. State it about the center of mass."
    ),
    "audit_inertia_about_mesh_origin": _warning(
        "The inertia is about the origin of the mesh. State it about the center of mass."
    ),
    "audit_inertia_shifted_twice": _warning(
        "The inertia was shifted away from the center of mass with the wrong sign. Add the parallel-axis term."
    ),
    "audit_angles_in_degrees": _warning("The angles of the inertial are in degrees. State them in radians."),
    "audit_angles_in_radians": _warning("The angles of the inertial are in radians. State them in degrees."),
    "audit_shape_angles_in_degrees": _warning(
        "The angles of the geometry are in degrees: in radians it agrees with the inertial. State them in radians."
    ),
    "audit_quaternion_order": _warning("The quaternion of the inertial is in the other order. Move w to its place."),
    "audit_frame_transposed": _warning("The rotation of the inertial is the inverse of what it should be. Invert it."),
    "audit_frame_not_meant": _warning(
        "The inertia is along the axes of the link, though the inertial is rotated. Remove the rotation."
    ),
    "audit_products_sign": _warning(
        "Products of inertia have the wrong sign: {products}. Entries of the tensor are negative integrals; change it."
    ),
    "audit_center_sign": _warning("The center of mass has the wrong sign along {axes}. Change it."),
    "audit_mirrored": _warning("The inertial is that of the mirror image along {axis}. Mirror it."),
    "audit_axes_swapped": _warning("The axes of the inertia are swapped. Put them in the order {order}."),
    "audit_center_axes_swapped": _warning("The axes of the center of mass are swapped. Put them in the order {order}."),
    "audit_all_axes_swapped": _warning("The axes of the inertial are swapped. Put them in the order {order}."),
    "audit_diagonal_swapped": _warning("The diagonal of the inertia is swapped. Put it in the order {order}."),
    "audit_products_swapped": _warning("The products of inertia are swapped. Put ixy, ixz and iyz in their places."),
    "audit_frame_turned": _warning("The inertial is turned by 90 degrees about {axis}. Turn it back."),
    "audit_tensor_turned": _warning("The inertia is turned by 90 degrees about {axis}. Turn it back."),
    "audit_axes_transposed": _warning(
        "The principal axes were taken as rows for columns. Put the tensor together with their transpose."
    ),
}

# What an enum says in a panel or a report: method → headline, explanation. Not findings.
METHODS = {
    "exact": ("Exact", "The surface is closed"),
    "grid exact": ("Exact, from a Grid", "Voxel values are taken as they are"),
    "reoriented": ("Reoriented", "Closed after flipped faces were reversed"),
    "capped": ("Capped", "The surface is open; its holes were capped"),
    "open": ("Open", "Open or through itself: it bounds no certain volume"),
    "shell": ("Shell", "The mass is in the surface"),
    "wall": ("Wall", "The mass is in a wall of real thickness"),
    "union": ("Union", "Overlapping components were united by Blender's exact Boolean, accurate to 7 digits"),
    "wire": ("Wire", "The mass is along the curve"),
    "given": ("Given", "The mass is given; there is no geometry"),
    "assembly": ("Assembly", "The members as one body"),
}


def method_key(method: Method | None, walled: bool) -> str:
    """Return the entry of METHODS that a method belongs to, "" for none. walled: whether a shell is a wall."""
    if method is None:
        return ""
    if walled and method.verdict == Verdict.SHELL:
        return "wall"
    return str(method) if str(method) in METHODS else method.verdict.value


# Counts of the health record, as the text report and Select Defects name them: one, several.
HEALTH = {
    "boundary_edges": ("boundary edge", "boundary edges"),
    "non_manifold_edges": ("non-manifold edge", "non-manifold edges"),
    "inconsistent_edges": ("edge with opposite normals", "edges with opposite normals"),
    "inverted_components": ("inside-out component", "inside-out components"),
    "nested_components": ("component inside another, counted twice", "components inside others, counted twice"),
    "overlapping_components": ("overlapping component", "overlapping components"),
    "cavities": ("cavity", "cavities"),
    "duplicate_faces": ("duplicate face", "duplicate faces"),
    "degenerate_faces": ("zero-area face", "zero-area faces"),
    "non_planar_faces": ("non-planar face", "non-planar faces"),
    "flipped_faces": ("flipped face", "flipped faces"),
}
# Clauses of `defects`.
MESSAGES |= {
    "defect_" + name: _note("{count} " + singular, "{count} " + plural) for name, (singular, plural) in HEALTH.items()
}
# What a shape is to the one that it was compared with (an enum in core/shape).
SIMILARITY = {
    "copy": "copy",
    "scaled_copy": "scaled copy",
    "mirror": "mirror image",
    "scaled_mirror": "scaled mirror image",
    "copy_or_mirror": "copy or mirror image",
    "scaled_copy_or_mirror": "scaled copy or mirror image",
    "similar": "similar",
    "different": "different",
}
# Sides of a wall, for {side}.
SIDES = {"inward": "inward", "outward": "outward", "centered": "centered"}
