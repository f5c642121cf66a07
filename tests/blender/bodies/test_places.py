# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces that stand in several places: one verdict for all, and the boxes, areas and images of each place."""

from types import SimpleNamespace

import numpy as np
import pytest
from body_moments.core.mesh.surface import Surface
from body_moments.core.polyhedron import polyhedron_moments
from body_moments.core.solid.instance_overlaps import PlaceComparison
from body_moments.core.verdict.finding import finding
from body_moments.core.verdict.health import DefectiveElements, Intersection, MeshHealth
from body_moments.operators.bodies import instances
from body_moments.operators.read.reading import Part

from tests.close import close
from tests.core.bodies import box

NOTHING = np.zeros((0, 2), np.intp)


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


HEALTHS = {
    "counted": ("boundary_edges", "non_manifold_edges", "inconsistent_edges", "components", "inverted_components"),
    "further": ("nested_components", "cavities", "overlapping_components", "duplicate_faces", "degenerate_faces"),
}


def health_of(number, closed=True, welded=False, found=Intersection.EXCLUDED, share=0.0):
    names = [*HEALTHS["counted"], *HEALTHS["further"], "non_planar_faces"]
    counts = {name: number + k for k, name in enumerate(names)}
    return MeshHealth(
        closed=closed,
        welded=welded,
        volume_spread=0.5 * number,
        cap_area_share=share,
        self_intersection=found,
        **counts,
    )


def test_the_health_of_one_surface_in_one_place_is_its_own():
    health = health_of(3)
    assert instances.merge_health([(health, 1, 2.0)]) is health


def test_of_several_places_counts_add_and_the_worst_of_all_counts():
    first, second = health_of(3, share=0.25), health_of(10, welded=True, share=0.5, found=Intersection.NOT_CHECKED)
    found = instances.merge_health([(first, 2, 6.0), (second, 1, 2.0)])
    for name in (*HEALTHS["counted"], *HEALTHS["further"], "non_planar_faces"):
        assert getattr(found, name) == 2 * getattr(first, name) + getattr(second, name), name
    assert found.closed and found.welded and found.self_intersection == Intersection.NOT_CHECKED
    assert close(found.cap_area_share, (0.25 * 6.0 + 0.5 * 2.0) / 8.0, 1e-15)
    assert close(found.volume_spread, 1.5 + 5.0, 1e-15)
    assert not any(len(row) for row in vars(found.defective_elements).values())
    worse = instances.merge_health([(first, 1, 1.0), (health_of(1, closed=False, found=Intersection.FOUND), 1, 1.0)])
    assert not worse.closed and not worse.welded and worse.self_intersection == Intersection.FOUND
    assert instances.merge_health([(first, 2, 0.0)]).cap_area_share == 0.0
    elements = DefectiveElements(flipped_faces=np.array([4]))
    named = MeshHealth(closed=True, defective_elements=elements)
    assert not len(instances.merge_health([(named, 2, 1.0)]).defective_elements.flipped_faces)


def test_findings_name_the_sources_that_they_are_of():
    one, other = finding("instance_overlap_unchecked", count=2), finding("overlap_unchecked", count=3)
    assert instances.findings_by_part([("", [one, one, other])], "Whole") == [one, other]
    assert instances.findings_by_part([("Whole", [one])], "Whole") == [one]
    assert instances.findings_by_part([("Part", [one])], "Whole") == [one.of_sources(["Part"])]
    found = instances.findings_by_part([("", [one]), ("Part", [one, other]), ("Part", [one])], "Whole")
    assert found == [one.of_sources(["Whole", "Part"]), other.of_sources(["Part"])]
    faces = [finding("overlap_unchecked", np.array(rows), count=1) for rows in ([1, 2], [1, 2], [3])]
    assert len(instances.each_once(faces)) == 2


@pytest.mark.parametrize("slightly", [False, True])
def test_places_that_have_something_in_common_are_named_by_their_faces(slightly):
    parts = SimpleNamespace(part=np.array([0, 0, 1, 1, 2]), face=np.array([5, 5, 7, -1, 9]))
    solids = [SimpleNamespace(parts=lambda: parts)] * 2
    reading = reading_of((box_surface(), [place()]), (box_surface(), [place()]))
    reading.parts[1].source_object_name = "Other"
    nested, overlapping = np.array([[0, 0], [0, 0], [1, 1]]), np.array([[1, 2], [0, 2], [0, 0]])
    comparison = PlaceComparison(nested, overlapping, 4, slightly, not slightly)
    found = instances.overlap_findings(reading, solids, comparison)
    assert [one.code for one in found] == [
        "components_nested_slightly" if slightly else "components_nested",
        "components_overlap" if slightly else "components_overlap_slightly",
        "overlap_unchecked",
    ]
    assert [one.values for one in found] == [{"count": 3}, {"count": 3}, {"count": 4}]
    assert [list(map(list, one.elements)) for one in found[:2]] == [
        [[5, "Whole"], [7, "Other"]],
        [[5, "Whole"], [9, "Whole"], [9, "Other"]],
    ]
    assert instances.overlap_findings(reading, solids, PlaceComparison(NOTHING, NOTHING, 0, False, False)) == []
    health = instances.with_overlaps(health_of(3), comparison)
    assert health.nested_components == health_of(3).nested_components + 3
    assert health.overlapping_components == health_of(3).overlapping_components + 3


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
