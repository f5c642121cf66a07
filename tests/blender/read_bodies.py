# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects for the tests of reading, and what Blender itself says of them."""

import bmesh
import bpy
import numpy as np

CUBE = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
CUBE_FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def mesh(name="Mesh", points=CUBE, faces=CUBE_FACES, edges=()):
    data = bpy.data.meshes.new(name)
    data.from_pydata(
        [tuple(map(float, p)) for p in points], list(edges), [tuple(map(int, f)) for f in faces]
    )
    return data


def link(name, data=None, collection=None):
    obj = bpy.data.objects.new(name, data)
    (collection or bpy.context.scene.collection).objects.link(obj)
    return obj


def cube(name="Cube", collection=None):
    return link(name, mesh(name), collection)


def collection(name, parent=True):
    made = bpy.data.collections.new(name)
    if parent:
        bpy.context.scene.collection.children.link(made)
    return made


def layer_of(made):
    return bpy.context.view_layer.layer_collection.children[made.name]


def activate(obj):
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)


def drag_a_corner(obj):
    """Edit Mode, with the mesh's first vertex moved to (-7, -1, -1)."""
    activate(obj)
    bpy.ops.object.mode_set(mode="EDIT")
    bm = bmesh.from_edit_mesh(obj.data)
    bm.verts.ensure_lookup_table()
    bm.verts[0].co = (-7.0, -1.0, -1.0)
    bmesh.update_edit_mesh(obj.data)


def depsgraph():
    return bpy.context.evaluated_depsgraph_get()


def nodes(obj, build):
    """A geometry nodes modifier: `build(tree, source)` gives the output socket, `source` is the
    object's own geometry."""
    tree = bpy.data.node_groups.new("Tree", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    source, sink = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    tree.links.new(build(tree, source.outputs[0]), sink.inputs[0])
    modifier = obj.modifiers.new("Nodes", "NODES")
    modifier.node_group = tree
    return modifier


def node(tree, kind, inputs=None, **links):
    """Add a node; `inputs` sets defaults by the sockets' names, `links` joins sockets to inputs by
    name."""
    made = tree.nodes.new(kind)
    for key, value in (inputs or {}).items():
        made.inputs[key].default_value = value
    for key, socket in links.items():
        tree.links.new(socket, made.inputs[key.rstrip("_")])
    return made


def join(tree, *sockets):
    made = tree.nodes.new("GeometryNodeJoinGeometry")
    for socket in sockets:
        tree.links.new(socket, made.inputs[0])
    return made.outputs[0]


def canonical(triangles, faces):
    """Triangles with their faces as a set: the smallest vertex first, the winding kept."""
    turned = [np.roll(t, -int(np.argmin(t))).tolist() for t in np.asarray(triangles)]
    return sorted((int(face), *turn) for face, turn in zip(faces, turned, strict=True))


def loop_triangles(data):
    data.calc_loop_triangles()
    return canonical(
        [t.vertices[:] for t in data.loop_triangles], [t.polygon_index for t in data.loop_triangles]
    )


def bmesh_triangles(obj):
    """What a BMesh of the evaluated object is tessellated to."""
    bm = bmesh.new()
    try:
        bm.from_object(obj, depsgraph())
        triples = bm.calc_loop_triangles()
        return canonical(
            [[x.vert.index for x in t] for t in triples], [t[0].face.index for t in triples]
        )
    finally:
        bm.free()


def surface_triangles(surface):
    return canonical(*surface.all_triangles())


def places(reading):
    """(faces, world matrix) of every place of every part, in a fixed order."""
    found = []
    for part in reading.parts:
        faces = len(part.surface.triangles) + len(part.surface.quads)
        found += [(faces, *matrix.ravel()) for matrix in part.matrices]
    return np.array(sorted(found, key=_rounded)).reshape(-1, 17)


def shown(obj):
    """The same from Blender's own list of what it draws, the object itself included."""
    found = []
    for item in depsgraph().object_instances:
        owner = item.parent if item.is_instance else item.object
        if owner.original != obj or item.object.type != "MESH" or not item.show_self:
            continue
        faces = item.object.data
        faces.calc_loop_triangles()
        sizes = [p.loop_total for p in faces.polygons]
        count = sum(1 if size <= 4 else size - 2 for size in sizes)
        if count:
            found.append(
                (count, *np.array([row[:] for row in item.matrix_world], np.float64).ravel())
            )
    return np.array(sorted(found, key=_rounded)).reshape(-1, 17)


def _rounded(row):
    return tuple(round(float(x), 4) + 0.0 for x in row)
