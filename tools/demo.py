# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo's body, its picture and its report; `python3 tests/project.py demo` calls this.

    demo.py build BODY.blend                       a bracket with holes, in millimeters
    demo.py picture BODY.blend RECORD.json PNG     the bracket with its centre and principal axes
    demo.py report RECORD.json                     the record as a person reads it (no Blender)

The bracket is modelled as people do it: a plate, a wall and a rib united, and holes cut, by
modifiers. Its volume is also known by hand, and the report says both.
"""

import json
import math
import os
import sys
from pathlib import Path

# millimeters
LENGTH, WIDTH, HEIGHT, THICKNESS = 80.0, 60.0, 50.0, 8.0
RIB_LEG, RIB_THICKNESS = 30.0, 6.0
SIDES = 64  # Sides of the prisms for the holes.
PLATE_HOLES = [(x, y, 3.3) for x in (35.0, 70.0) for y in (10.0, 50.0)]  # x, y, radius
WALL_HOLES = [(12.0, 35.0, 5.0), (48.0, 35.0, 5.0)]  # y, z, radius
NAME = "Bracket"


def volume_by_hand() -> float:
    """The bracket's volume in m³ from its dimensions."""

    def hole(radius: float) -> float:
        return THICKNESS * SIDES / 2 * radius**2 * math.sin(2 * math.pi / SIDES)

    solid = THICKNESS * WIDTH * (LENGTH + HEIGHT - THICKNESS) + RIB_THICKNESS * RIB_LEG**2 / 2
    return 1e-9 * (solid - sum(hole(radius) for *_, radius in PLATE_HOLES + WALL_HOLES))


def build(path: str) -> None:
    import bpy
    from mathutils import Euler, Vector

    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    scene = bpy.context.scene
    scene.unit_settings.system = "METRIC"
    scene.unit_settings.scale_length = 0.001
    scene.unit_settings.length_unit = "MILLIMETERS"
    parts, holes = (bpy.data.collections.new(name) for name in ("Parts", "Holes"))

    def make(name: str, points, faces, collection):
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(points, [], faces)
        made = bpy.data.objects.new(name, mesh)
        collection.objects.link(made)
        return made

    def prism(name: str, outline, along: Vector, collection):
        """The solid that a counter-clockwise outline sweeps; `along` is where its normal points."""
        count = len(outline)
        points = [*outline, *(Vector(point) + along for point in outline)]
        sides = [(i, (i + 1) % count, (i + 1) % count + count, i + count) for i in range(count)]
        faces = [tuple(range(count))[::-1], tuple(range(count, 2 * count)), *sides]
        return make(name, points, faces, collection)

    def rectangle(x: float, y: float) -> list[Vector]:
        return [Vector(point) for point in ((0, 0, 0), (x, 0, 0), (x, y, 0), (0, y, 0))]

    def hole(center: Vector, radius: float, turn: Euler) -> None:
        """A drill through a plate, longer than the plate at both ends."""
        turns = [2 * math.pi * i / SIDES for i in range(SIDES)]
        circle = [Vector((radius * math.cos(t), radius * math.sin(t), -2.0)) for t in turns]
        drill = prism("Hole", circle, Vector((0, 0, THICKNESS + 4.0)), holes)
        drill.location, drill.rotation_euler = center, turn

    body = prism(NAME, rectangle(LENGTH, WIDTH), Vector((0, 0, THICKNESS)), scene.collection)
    prism("Wall", rectangle(THICKNESS, WIDTH), Vector((0, 0, HEIGHT)), parts)
    # the rib reaches into plate and wall, so that no faces of the union only touch
    inset, middle, leg = THICKNESS / 2, (WIDTH + RIB_THICKNESS) / 2, RIB_LEG
    corners = ((-inset, -inset), (leg, -inset), (leg, 0.0), (0.0, leg), (-inset, leg))
    outline = [Vector((THICKNESS + x, middle, THICKNESS + z)) for x, z in corners]
    prism("Rib", outline, Vector((0, -RIB_THICKNESS, 0)), parts)
    for x, y, radius in PLATE_HOLES:
        hole(Vector((x, y, 0)), radius, Euler((0, 0, 0)))
    for y, z, radius in WALL_HOLES:
        hole(Vector((0, y, z)), radius, Euler((0, math.pi / 2, 0)))

    for name, operation, operand in (("Unite", "UNION", parts), ("Drill", "DIFFERENCE", holes)):
        scene.collection.children.link(operand)
        modifier = body.modifiers.new(name, "BOOLEAN")
        modifier.operation, modifier.solver = operation, "EXACT"
        modifier.operand_type, modifier.collection = "COLLECTION", operand
        for tool in operand.objects:
            tool.parent, tool.display_type, tool.hide_render = body, "WIRE", True
        operand.hide_viewport = operand.hide_render = True
    bpy.context.view_layer.objects.active = body
    body.select_set(True)
    bpy.ops.wm.save_as_mainfile(filepath=os.path.abspath(path), compress=True)


def picture(body: str, record: str, path: str) -> None:
    import bpy
    from mathutils import Matrix, Vector

    bpy.ops.wm.open_mainfile(filepath=os.path.abspath(body), use_scripts=False)
    scene = bpy.context.scene
    bracket = bpy.data.objects[NAME]
    measured = json.loads(Path(record).read_text(encoding="utf-8"))["objects"][0]
    unit = scene.unit_settings.scale_length
    center = Vector(measured["center_of_mass"]) / unit
    axes = Matrix(measured["principal_axes"]).transposed()  # rows: the axes
    reach = 0.62 * max(bracket.dimensions)

    def material(name: str, color, alpha: float = 1.0):
        made = bpy.data.materials.new(name)
        if not made.use_nodes:  # always true, and deprecated, in Blender 5
            made.use_nodes = True
        shader = next(n for n in made.node_tree.nodes if n.type == "BSDF_PRINCIPLED")
        for key, value in (
            ("Base Color", (*color, 1.0)),
            ("Alpha", alpha),
            ("Roughness", 0.45),
        ):
            shader.inputs[key].default_value = value
        return made

    def add(data, place: Matrix, look) -> None:
        data.materials.append(look)
        added = bpy.data.objects.new(data.name, data)
        added.matrix_world = place
        scene.collection.objects.link(added)

    def lathe(name: str, profile, sides: int = 32):
        """A surface of revolution about z; profile: (radius, z) from bottom to top."""
        points = [
            (r * math.cos(2 * math.pi * i / sides), r * math.sin(2 * math.pi * i / sides), z)
            for r, z in profile
            for i in range(sides)
        ]
        faces = [
            (a * sides + i, a * sides + j, (a + 1) * sides + j, (a + 1) * sides + i)
            for a in range(len(profile) - 1)
            for i, j in ((i, (i + 1) % sides) for i in range(sides))
        ]
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(points, [], faces)
        return mesh

    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(camera)
    scene.camera = camera
    view = Vector((1.0, -1.35, 0.85)).normalized()
    facing = view.to_track_quat("Z", "Y")
    camera.matrix_world = Matrix.LocRotScale(center + view * 10 * reach, facing, None)
    camera.data.type, camera.data.ortho_scale = "ORTHO", 2.9 * reach
    camera.data.clip_end = 100 * reach

    bracket.data.materials.append(material("Aluminium", (0.22, 0.32, 0.45), 0.5))
    thin, head = 0.012 * reach, 0.09 * reach
    colors = ((0.85, 0.08, 0.06), (0.1, 0.55, 0.08), (0.05, 0.2, 0.85))
    arrow = [(0.0, -reach), (thin, -reach), (thin, reach - head), (2.8 * thin, reach - head)]
    for number, (axis, color) in enumerate(zip(axes, colors, strict=True), start=1):
        look = material(f"Axis {number}", color)
        turn = axis.to_track_quat("Z", "Y")
        add(
            lathe(f"Axis {number}", [*arrow, (0.0, reach)]),
            Matrix.LocRotScale(center, turn, None),
            look,
        )
        text = bpy.data.curves.new(f"Label {number}", "FONT")
        text.body, text.size, text.align_x, text.align_y = (
            str(number),
            0.16 * reach,
            "CENTER",
            "CENTER",
        )
        tip = center + axis * 1.12 * reach + view * 2 * reach
        add(text, Matrix.LocRotScale(tip, facing, None), look)
    ball = [
        (4 * thin * math.sin(a), -4 * thin * math.cos(a))
        for a in (math.pi * i / 16 for i in range(17))
    ]
    add(lathe("Center", ball), Matrix.Translation(center), material("Center", (0.9, 0.6, 0.0)))

    sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    sun.data.energy, sun.data.angle = 2.5, 0.2
    sun.rotation_euler = (0.7, 0.2, 0.9)
    scene.collection.objects.link(sun)
    scene.world = bpy.data.worlds.new("World")
    if not scene.world.use_nodes:
        scene.world.use_nodes = True
    background = next(n for n in scene.world.node_tree.nodes if n.type == "BACKGROUND")
    background.inputs["Color"].default_value = (0.85, 0.87, 0.9, 1.0)
    background.inputs["Strength"].default_value = 0.8

    # Cycles on the processor: the one renderer that every Blender has without a graphics card
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples = "CPU", 32
    scene.cycles.use_denoising = False
    scene.view_settings.view_transform = "Standard"
    scene.render.resolution_x, scene.render.resolution_y = 800, 600
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "PNG"
    scene.render.filepath = os.path.abspath(path)
    bpy.ops.render.render(write_still=True)


def report(record: str) -> None:
    document = json.loads(Path(record).read_text(encoding="utf-8"))
    measured = document["objects"][0]
    bound = measured["error_bound"]

    def vector(values, scale: float, digits: int) -> str:
        rounded = [round(scale * value, digits) + 0.0 for value in values]  # no negative zeros
        return "  ".join(f"{value:>{digits + 6}.{digits}f}" for value in rounded)

    print(f"{measured['name']}, Blender {document['blender']}, {document['frame']} frame")
    print(f"  verdict            {measured['kind']}, {measured['method']}")
    print(f"  mass               {measured['mass']:.9g} kg at {measured['density']:g} kg/m³")
    volume = measured["volume"]
    print(f"  volume             {volume * 1e6:.9g} cm³, by hand {volume_by_hand() * 1e6:.9g} cm³")
    rounding, coordinates = bound["volume"] / volume, bound["input"]["volume"] / volume
    bounds = f"{rounding:.1e} (rounding) + {coordinates:.1e} (coordinates)"
    print(f"  error of volume    at most {bounds}, in parts of it")
    print(f"  area               {measured['area'] * 1e4:.9g} cm²")
    print(f"  center of mass     {vector(measured['center_of_mass'], 1e3, 6)}  mm")
    print(f"  principal moments  {vector(measured['principal_moments'], 1e6, 6)}  kg·mm²")
    for number, axis in enumerate(zip(*measured["principal_axes"], strict=True), start=1):
        print(f"  principal axis {number}   {vector(axis, 1.0, 6)}")
    print("  inertia about the center, kg·mm²")
    for row in measured["inertia"]:
        print(f"                     {vector(row, 1e6, 6)}")
    for warning in measured["warnings"]:
        print(f"  note: {warning}")


def main() -> None:
    words = sys.argv[1:]
    if "--" in words:  # called by Blender itself
        words = words[words.index("--") + 1 :]
    {"build": build, "picture": picture, "report": report}[words[0]](*words[1:])
    sys.stdout.flush()


if __name__ == "__main__":
    main()
