# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers in, numbers out: the moments of bodies, with numpy and the standard library only.

Every body becomes `moments`, and everything else is derived from them. Below are the modules by subject. A paper's
formula is in the module that names it here; where the paper is wrong, that module's docstring says so.

What everything is made of
    moments, affine             raw moments about a point; their sums, shifts and affine images, with error bounds
    mass, measurement           mass, center, inertia, radii of gyration; all results of one measured object
    vectors, precise, rotation  products, exact sums, quaternions
    quadrature, decimal         Gauss's rules; float32 as the decimals that were typed

Solids and shells of triangles and quads
    surface                     the arrays that every reader makes
    polyhedron                  to third order; its loops are `blocks` and, for bodies of few faces, `small`
    recursion                   to any order, also of a stream; its loop is `levels`
    simplex                     in n dimensions
    images, components          areas of uneven images (Nanson); the closed parts of a body
    wall, offset                shells of real thickness; where their vertices go
    gradient, balance           derivatives by every vertex; the least change of shape that moves the center
    sheynin_tuzikov             reference, as printed: Sheynin and Tuzikov 2001 (factorized: `recursion`, `simplex`)
    durso                       reference, as printed: D'Urso 2005
    zhang_chen                  reference, as printed: Zhang and Chen 2001

Whether a surface bounds a solid
    solid                       the verdict, what had to be mended, and the moments
    topology, weld, flatness    edges and parts; vertices and faces that are one; faces that are bent or without area
    mending, caps, nesting      repair on a copy; rims and their caps; shells in shells
    shell_tree                  shells asked for points inside and for crossings
    distance                    of a point from triangles

In the plane, and along curves
    polygon, section            area moments of polygons with holes; section properties, as engineers know them
    curve, curve_moments        B-spline curves; wires and the regions that curves bound
    plane_region                which plane, and which way each curve runs

Free-form surfaces (Soldea, Elber and Rivlin)
    bspline, patch              function spaces and their derivatives; patches
    bezier                      the Bézier patches that they consist of
    patch_moments               sections 2 and 3, by a radial flux: solids, areas, sheets
    patch_solid, closure        what patches bound; whether they close, and their caps
    reevaluation, following     moments while control points move: of a patch, of a body
    blender_knots               Blender's NURBS
    phi                         reference, as printed: the Φ tensors

Densities
    density, density_tables     trivariate B-splines and grids (Soldea, Elber and Rivlin, sections 4 and 5)
    density_inside              a solid filled with a grid's density
    polynomial, graded          polynomials in x, y, z; bodies of such a density
    density_sign                whether such a density is negative somewhere in a body
    weighted                    one density for each part, face or vertex
    scans, samples              files of samples: `nrrd`, `nifti`, `array_files`; the samples in them
    transfer, materials         what a sample stands for; a table of materials
    soldea                      reference, as printed: theorem 4.2

Pose, symmetry and signature
    pose, canonical             the principal frame (Zhang and Chen 2001, eq. 11), made unique by higher moments
    symmetry, matching          a body's own rotations and reflections; laying one body onto another
    harmonics, zernike          solid harmonics; descriptors (Novotni and Klein 2003)
    signature, library          numbers by which a shape is found again; files of them

Fourier transforms
    fourier                     of a solid or a surface, in closed form (for Zhang and Chen's sum over tetrahedra)
    triangle_waves, waves       its means over triangles; wave vectors. What comes of it is a `spectrum`
    fourier_body                of many surfaces at many places
    fourier_grid, nufft         large grids to a tolerance (Barnett, Magland and af Klinteberg 2019)
    fourier_polygon             in the plane
"""
