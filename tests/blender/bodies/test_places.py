# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces that stand in several places: one verdict for all, and the boxes, areas and images of each place."""

from types import SimpleNamespace

import numpy as np
from body_moments.blender.bodies.mesh import instances
from body_moments.blender.read.reading import Part
from body_moments.core.mesh.surface import Surface
from body_moments.core.polyhedron import polyhedron_moments

from tests.close import close
from tests.core.bodies import box


def box_surface(high=(1.0, 2.0, 3.0)):
    points, triangles = box((0, 0, 0), high)
    return Surface(points, triangles=triangles)


def place(linear=None, shift=(0.0, 0.0, 0.0)):
    matrix = np.eye(4)
    matrix[:3, :3] = np.eye(3) if linear is None else linear
    matrix[:3, 3] = shift
    return matrix


def reading_of(*parts):
    return SimpleNamespace(name="Whole", parts=[Part(surface, np.array(places)) for surface, places in parts])


def test_boxes_around_places_tell_whether_they_may_overlap_and_how_large_all_is():
    turn = np.array([[0.0, -2.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])  # to x from -4 to 0, y from 0 to 1
    apart = reading_of(
        (box_surface(), [place(), place(turn, (5.5, 10.0, 0.0))]), (box_surface(), [place(None, (0, 4, 0))])
    )
    assert not instances.instances_overlap(apart)
    assert close(instances.instances_size(apart), np.sqrt(5.5**2 + 11.0**2 + 3.0**2), 1e-14)
    for shift, expected in (((1.0, 0.0, 0.0), False), ((0.99, 1.9, 2.9), True), ((0.99, -2.0, 0.0), False)):
        assert instances.instances_overlap(reading_of((box_surface(), [place(), place(None, shift)]))) is expected
    for x, expected in ((4.9, True), (5.1, False)):  # the turned one reaches from x - 4 to x
        near = reading_of((box_surface(), [place(), place(turn, (x, 0.5, 0.0))]))
        assert instances.instances_overlap(near) is expected


def test_areas_of_places_are_those_of_the_images_also_of_uneven_ones():
    surface = box_surface()
    area = polyhedron_moments(surface, area_order=2)[1]
    maps = [
        place(2.0 * np.eye(3), (1, 2, 3)),
        place(np.diag([1.0, 2.0, 3.0])),
        place(np.diag([1.0, 2.0, 3.0]), (4, 4, 4)),
    ]
    maps += [place(np.diag([1.0, 1.0, -1.0]))]
    measured = []

    def measure(image):
        measured.append(image)
        return polyhedron_moments(image, area_order=2)[1]

    even, uneven = 22.0, 2.0 * (1 * 4 + 4 * 9 + 1 * 9)
    found = list(instances.area_of_instances(surface, area, np.array(maps), measure))
    assert close(sum(one.total for one in found), 4.0 * even + 2.0 * uneven + even, 1e-14) and len(measured) == 1
    first = sum(one.total * one.center for one in found)
    centers = np.array([[0.5, 1.0, 1.5]]) * [[2, 2, 2], [1, 2, 3], [1, 2, 3], [1, 1, -1]]
    centers += [[1, 2, 3], [0, 0, 0], [4, 4, 4], [0, 0, 0]]
    assert close(first, np.array([4.0 * even, uneven, uneven, even]) @ centers, 1e-13)
    alone = list(instances.area_of_instances(surface, area, np.array(maps), None))
    assert close(sum(one.total for one in alone), 5.0 * even + 2.0 * uneven, 1e-14) and len(measured) == 1
    for number, truth in ((0, 4.0 * even), (1, uneven)):
        for how in (measure, None):
            (one,) = instances.area_of_instances(surface, area, np.array(maps[number : number + 1]), how)
            assert close(one.total, truth, 1e-14)


def test_uneven_maps_are_grouped_by_what_they_do_and_every_place_comes_once():
    surface, stretch = box_surface(), np.diag([1.0, 2.0, 3.0])
    maps = [place(stretch, (1, 0, 0)), place(2.0 * np.eye(3)), place(stretch, (0, 5, 0)), place(stretch @ stretch)]
    groups = list(instances.group_by_similarity(surface, np.array(maps)))
    assert groups[0][0] is surface and len(groups) == 3
    assert sorted(number for *_, which in groups for number in which.tolist()) == [0, 1, 2, 3]
    for image, matrices, which in groups:
        for matrix, number in zip(matrices, which.tolist()):
            there = image.points @ matrix[:3, :3].T + matrix[:3, 3]
            truth = surface.points @ maps[number][:3, :3].T + maps[number][:3, 3]
            assert np.abs(there - truth).max() <= 1e-14 * 30.0
            assert (image is surface) == (number == 1)
    assert len(list(instances.group_by_similarity(surface, np.array(maps[1:2])))) == 1
