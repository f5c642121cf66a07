# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers in, numbers out: the moments of bodies, with numpy and the standard library only.

`surface` is what every reader makes, `polyhedron` and `solid` turn it into `moments`, and `mass`, `pose` and
`measurement` derive everything else from those. `simplex`, `polygon` and `section` are the same in other dimensions;
`sheynin_tuzikov`, `durso` and `zhang_chen` are the papers' own formulae, as references.
"""
