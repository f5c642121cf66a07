# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Types of the entities of IGES files: their numbers, and the names of surfaces and solids in the
specification.
"""

ARC = 100
CHAIN = 102
CONIC = 104
PLANE = 108
LINE = 110
POINT = 116
RULED = 118
REVOLVED = 120
EXTRUDED = 122
DIRECTION = 123
MATRIX = 124
SPLINE_CURVE = 126
SPLINE_SURFACE = 128
OFFSET = 140
BOUNDARY = 141
CURVE_ON_SURFACE = 142
BOUNDED = 143
TRIMMED = 144
SOLID = 186
PLANE_SURFACE = 190
CYLINDER = 192
CONE = 194
BALL = 196
TORUS = 198
DEFINITION = 308
INSTANCE = 408
SOLID_INSTANCE = 430
EDGES = 504
LOOP = 508
FACE = 510
SHELL = 514

# Curves and points, which bound nothing.
CURVES = {ARC, CHAIN, CONIC, 106, LINE, 112, POINT, SPLINE_CURVE, 130}
# Surfaces and solids that are refused if they stand alone; boundaries make faces of some.
REFUSED = {
    PLANE: "Plane",
    114: "Parametric Spline Surface",
    OFFSET: "Offset Surface",
    150: "Block",
    152: "Wedge",
    154: "Cylinder",
    156: "Cone Frustum",
    158: "Sphere",
    160: "Torus",
    162: "Solid of Revolution",
    164: "Solid of Linear Extrusion",
    168: "Ellipsoid",
    180: "Boolean Tree",
    184: "Solid Assembly",
    PLANE_SURFACE: "Plane Surface",
    CYLINDER: "Cylindrical Surface",
    CONE: "Conical Surface",
    BALL: "Spherical Surface",
    TORUS: "Toroidal Surface",
    412: "Rectangular Array",
    414: "Circular Array",
    416: "External Reference",
    SOLID_INSTANCE: "Solid Instance",
}
# All types that have a volume or an area; the others are curves, points, annotation or structure.
NAMES = REFUSED | {
    RULED: "Ruled Surface",
    REVOLVED: "Surface of Revolution",
    EXTRUDED: "Tabulated Cylinder",
    SPLINE_SURFACE: "Rational B-Spline Surface",
    BOUNDED: "Bounded Surface",
    TRIMMED: "Trimmed Surface",
    SOLID: "Manifold Solid B-Rep",
    INSTANCE: "Subfigure Instance",
    FACE: "Face",
    SHELL: "Shell",
}
PLANES = (PLANE, PLANE_SURFACE)
QUADRICS = (CYLINDER, CONE, BALL, TORUS)
SWEPT_SURFACES = (RULED, REVOLVED, EXTRUDED)
