# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of bodies: numbers in, numbers out, with numpy and the standard library only.

Every body becomes raw moments about a stated point (`Moments`), by default the middle of its
bounding box, and everything else is derived from them. `from body_moments.core import ...` has the
names that most uses need:

    mass_properties                          all results of a solid from arrays, in one call
    Surface                                  triangles and quads over shared points
    measure_solid, polyhedron_moments        the body in a surface, repaired on a copy; its moments
                                             to any order
    below                                    the part of a body below planes
    grid_moments, read_scan                  densities sampled on a grid; files of samples
    Moments, MassProperties                  raw moments; mass, center, inertia and principal
                                             moments
    principal_frame                          principal axes, unique where the body allows it
    signature, solid_transform               numbers that identify a shape; the Fourier transform
    Finding, MeasureError                    what was noticed or decided; what was refused, and why

The packages, each with its own public names in its `__init__` (none imports a later one):

    numerics     vectors, compensated sums, rotations, quadrature, B-splines, graphs, segments of
                 arrays
    verdict      findings and refusals, method, health of a mesh, tolerances
    moments      `Moments`, sums, shifts and affine images with error bounds; monomials, normalized
                 moments, harmonics
    mesh         `Surface`; edges, welding, planarity, boxes, bounding-volume hierarchy, winding
                 numbers
    inertia      mass properties; the principal frame (Zhang and Chen 2001, eq. 11), made unique by
                 higher moments
    papers       the papers' formulas as printed, one module a paper, and what is wrong in print
    polyhedron   integrals over triangles and quads: to third order, to any order, in n dimensions
                 (Sheynin and Tuzikov)
    shape        symmetry, signature, Zernike descriptors (Novotni and Klein 2003), registration,
                 libraries
    scans        NRRD, NIfTI, numpy's and raw files
    solid        whether a surface bounds a solid; holes capped, faces flipped, shells nested; its
                 moments
    flat         polygons with holes, section properties
    fourier      Fourier transforms in closed form, and on large grids to a tolerance (Barnett et
                 al. 2019)
    rig          the bone that each face goes with; skinned bodies cut into closed pieces
    streams      meshes in .stl and .ply files, read in blocks or as a whole
    density      materials, polynomials, piecewise densities, grids and trivariate splines (Soldea
                 et al., 4 and 5)
    nurbs        B-spline curves and patches (Soldea, Elber and Rivlin, sections 2, 3), Blender's
                 knots
    wall         walls of real thickness
    statics      support polygons, resting poses; derivatives by every vertex, the least change that
                 moves the center
    cuts         parts of bodies below planes; cut and fill; the hollow of a vessel
    cad          B-spline surfaces of IGES and .obj files, with Blender's knots
    measurement  `Measurement`, all results of one measured object
    robots       links, joints and inertials; their formats; the audit of inertials by geometry

Importing this package loads neither numpy nor any of these: each name is imported when it is first
used.
"""

from .lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(
    __name__,
    Finding="verdict",
    MassProperties="inertia",
    MeasureError="verdict",
    Moments="moments",
    Surface="mesh",
    below="cuts",
    grid_moments="density",
    mass_properties="measurement",
    measure_solid="solid",
    polyhedron_moments="polyhedron",
    principal_frame="inertia",
    read_scan="scans",
    signature="shape",
    solid_transform="fourier",
)
