# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""All of a file that an operator of ours may change, by its place, so that two states can be compared."""

import re

import bmesh
import bpy
import numpy as np
from body_moments.operators.session import outcome, stability, staleness

DATA = ("objects", "collections", "materials", "meshes", "curves", "images", "texts", "node_groups", "actions")
DATA = (*DATA, "armatures", "volumes", "scenes")
GEOMETRY = r"^v1:[\da-f]{12}:"  # at the start of a fingerprint: its last bits are the processor's
OF_OBJECTS = ("parent", "parent_type", "parent_bone", "data", "hide_render", "display_type", "show_in_front")


def shown(value):
    """A value as text, numbers to five digits."""
    if isinstance(value, float):
        return "{:.5g}".format(round(value, 6) + 0.0)
    if hasattr(value, "to_list"):
        value = value.to_list()
    if hasattr(value, "to_dict"):
        return "{{{:s}}}".format(", ".join("{:s}: {:s}".format(key, shown(value[key])) for key in sorted(value.keys())))
    if isinstance(value, list | tuple | set) or type(value).__name__ in (
        "Vector",
        "Euler",
        "Quaternion",
        "Matrix",
        "Color",
    ):
        return "[{:s}]".format(", ".join(map(shown, sorted(value) if isinstance(value, set) else value)))
    if isinstance(value, bpy.types.ID):
        return value.name
    if isinstance(value, str):
        return repr(re.sub(GEOMETRY, "v1:geometry:", value))
    return repr(value)


def sums(values):
    """The sum of numbers, and of each times its place."""
    flat = np.asarray(values, float).ravel()
    return [float(flat.sum()), float(flat @ np.arange(1.0, len(flat) + 1.0) / max(len(flat), 1))]


def settings(place, group):
    """What is set in a property group."""
    for prop in group.bl_rna.properties:
        is_field = prop.type == "FLOAT" and prop.identifier.startswith("density_")  # the same in another unit
        if prop.identifier == "rna_type" or is_field or not group.is_property_set(prop.identifier):
            continue
        value = getattr(group, prop.identifier)
        if prop.type == "COLLECTION":
            for index, item in enumerate(value):
                yield from settings("{:s}.{:s}[{:d}]".format(place, prop.identifier, index), item)
        elif prop.type == "POINTER" and isinstance(value, bpy.types.PropertyGroup):
            yield from settings("{:s}.{:s}".format(place, prop.identifier), value)
        else:
            yield "{:s}.{:s}".format(place, prop.identifier), value[:] if getattr(prop, "is_array", False) else value


def custom(place, owner):
    for key in owner.keys():  # noqa: SIM118
        if not key.startswith("body_moments") and "fingerprint" not in key:
            value = owner[key]
            if key == "body_principal_axes" and max(value, key=abs) < 0.0:
                value = [-number for number in value]  # the same turn
            yield "{:s}[{:s}]".format(place, key), value


def of_animation(place, animation):
    if animation is None:
        return
    for driver in animation.drivers:
        yield "{:s} driver {:s}[{:d}]".format(place, driver.data_path, driver.array_index), driver.driver.expression
    for layer in animation.action.layers if animation.action else ():
        for strip in layer.strips:
            bag = strip.channelbag(animation.action_slot)
            for curve in bag.fcurves if bag else ():
                keys = [tuple(key.co) for key in curve.keyframe_points]
                name = "{:s} keys {:s}[{:d}]".format(place, curve.data_path, curve.array_index)
                yield name, [len(keys), *sums(keys), [key.interpolation for key in curve.keyframe_points][:1]]


def of_object(obj):
    place = "objects/" + obj.name
    yield place + " matrix", [list(row) for row in obj.matrix_world]
    for name in (*OF_OBJECTS, "mode", "rotation_mode"):
        yield "{:s}.{:s}".format(place, name), getattr(obj, name)
    is_there = obj.name in bpy.context.view_layer.objects
    yield place + " selected, hidden", [obj.select_get(), obj.hide_get()] if is_there else None
    if obj.type == "EMPTY":
        yield place + " display", [obj.empty_display_type, obj.empty_display_size]
    for modifier in obj.modifiers:
        used = getattr(modifier, "node_group", None) or getattr(modifier, "object", None)
        yield "{:s} modifier {:s}".format(place, modifier.name), [modifier.type, used]
    for constraint in obj.constraints:
        yield (
            "{:s} constraint {:s}".format(place, constraint.name),
            [constraint.type, getattr(constraint, "target", None), constraint.influence],
        )
    for name, body in (("rigid body", obj.rigid_body), ("rigid constraint", obj.rigid_body_constraint)):
        for prop in body.bl_rna.properties if body else ():
            if prop.type not in ("COLLECTION",) and prop.identifier != "rna_type":
                value = getattr(body, prop.identifier)
                yield (
                    "{:s} {:s}.{:s}".format(place, name, prop.identifier),
                    value[:] if getattr(prop, "is_array", 0) else value,
                )
    yield from custom(place, obj)
    for name in ("body_moments", "body_moments_assembly", "body_moments_symmetry"):
        yield from settings("{:s}.{:s}".format(place, name), getattr(obj, name))
    yield from of_animation(place, obj.animation_data)
    for bone in obj.pose.bones if obj.pose else ():
        yield from custom("{:s} bone {:s}".format(place, bone.name), bone)
    if obj.type == "MESH" and obj.mode == "OBJECT":
        mesh = obj.data
        yield place + " points", [len(mesh.vertices), *sums(sorted(tuple(vertex.co) for vertex in mesh.vertices))]
        mesh.calc_loop_triangles()
        corners = np.array([[mesh.vertices[i].co[:] for i in each.vertices] for each in mesh.loop_triangles], float)
        volume = np.linalg.det(corners).sum() / 6.0 if len(corners) else 0.0
        yield place + " faces", [len(mesh.polygons), len(mesh.loops), float(volume)]
        yield (
            place + " chosen",
            [sums([each.select for each in part]) for part in (mesh.vertices, mesh.edges, mesh.polygons)],
        )
    elif obj.type == "MESH" and obj.mode == "EDIT":
        mesh = bmesh.from_edit_mesh(obj.data)
        yield place + " points, edited", sums([tuple(vertex.co) for vertex in mesh.verts])
        for name in ("select", "hide"):
            parts = (mesh.verts, mesh.edges, mesh.faces)
            yield (
                "{:s} {:s}, edited".format(place, name),
                [sums([getattr(one, name) for one in part]) for part in parts],
            )


def of_nodes(group):
    """What a group of nodes takes and gives, its nodes with the numbers in them, and what is linked."""
    place = "node_groups/" + group.name
    yield place + " is a modifier", group.is_modifier
    for item in group.interface.items_tree:
        limits = [getattr(item, name, None) for name in ("default_value", "min_value")]
        limits = [value if isinstance(value, float | int | None) else list(value) for value in limits]
        yield "{:s} {:s} {:s}".format(place, item.in_out, item.name), [item.socket_type, *limits, item.description]
    for node in group.nodes:
        chosen = [getattr(node, name, "") for name in ("operation", "data_type", "domain", "label")]
        values = [getattr(socket, "default_value", None) for socket in node.inputs if not socket.is_linked]
        values = [value for value in values if not isinstance(value, str)]  # no choices: 4.5 has no sockets
        values = [list(value) if hasattr(value, "__len__") else value for value in values]
        yield "{:s} node {:s}".format(place, node.name), [node.bl_idname, list(node.location), *chosen, *values]
    yield (
        place + " links",
        [
            "{:s}.{:s} > {:s}.{:s}".format(
                link.from_node.name, link.from_socket.identifier, link.to_node.name, link.to_socket.identifier
            )
            for link in group.links
        ],
    )
    data = group.asset_data
    yield place + " asset", data and [data.description, [tag.name for tag in data.tags]]


def state():
    bpy.context.view_layer.update()
    found = {}
    for name in DATA:
        found |= {"{:s}/{:s}".format(name, one.name): "there" for one in getattr(bpy.data, name)}
    for obj in bpy.data.objects:
        found |= dict(of_object(obj))
    for collection in (*bpy.data.collections, bpy.context.scene.collection):
        place = "collections/" + collection.name
        found[place + " objects"] = sorted(obj.name for obj in collection.objects)
        found[place + " children"] = sorted(one.name for one in collection.children)
        found[place + " offset"] = list(collection.instance_offset)
        found |= dict(custom(place, collection)) | dict(settings(place, collection.body_moments))
    for material in bpy.data.materials:
        found |= dict(settings("materials/" + material.name, material.body_moments))
    for group in bpy.data.node_groups:
        found |= dict(of_nodes(group))
    for text in bpy.data.texts:
        found["texts/{:s} text".format(text.name)] = text.as_string()
    scene = bpy.context.scene
    for name in ("body_moments", "body_moments_reference", "body_moments_search"):
        found |= dict(settings("scene." + name, getattr(scene, name)))
    units = scene.unit_settings
    found["scene units"] = [units.system, units.scale_length, units.length_unit, units.mass_unit]
    found["scene select mode"] = list(scene.tool_settings.mesh_select_mode)
    found["scene cursor"] = [list(row) for row in scene.cursor.matrix]
    slot = scene.transform_orientation_slots[0]
    found["scene orientation"] = [
        slot.type,
        *([list(row) for row in slot.custom_orientation.matrix] if slot.custom_orientation else ()),
    ]
    found["scene rigid bodies"] = scene.rigidbody_world is not None
    found["scene frame"] = scene.frame_current
    active = bpy.context.view_layer.objects.active
    found["active"] = "" if active is None else active.name
    return {place: shown(value) for place, value in found.items()}


def difference(before, after):
    """The lines of what is new, gone and other."""
    for place in sorted({*before, *after}):
        old, new = before.get(place), after.get(place)
        if old is None:
            yield "+ {:s} {:s}".format(place, new)
        elif new is None:
            yield "- {:s}".format(place)
        elif old != new:
            yield "  {:s} {:s} -> {:s}".format(place, old, new)


def panels():
    """What the panels say of all this: what is out of date, what was refused."""
    for obj in bpy.data.objects:
        reasons = {
            "results": staleness.stale_reason(obj, bpy.context.scene),
            "section": staleness.section_stale_reason(obj),
            "symmetry": staleness.symmetry_stale_reason(obj),
        }
        for name, reason in reasons.items():
            if reason is not None:
                yield "! objects/{:s} {:s}: {:s}".format(obj.name, name, reason)
        if stability.is_known(obj):
            yield "! objects/{:s} stands: {}".format(obj.name, getattr(stability.support(obj), "stands", None))
    last = outcome.last()
    if last is not None:
        yield "! {:s}: {:s}".format(last.action, ", ".join([*(found.code for found in last.findings), *last.objects]))
