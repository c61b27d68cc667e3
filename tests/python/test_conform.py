"""`certa.conform`: what comes out of shapes that are known, and where it comes from."""

import certa
import numpy
import pytest
from shapes import CUBE, CUBE_FACES, volumes


def test_cube_is_filled():
    result = certa.conform(CUBE, CUBE_FACES)
    assert result.outcome == "done"
    assert numpy.array_equal(result.positions, CUBE)
    parts = volumes(result.positions, result.tetrahedra)
    assert (parts > 0).all() and numpy.isclose(parts.sum(), 1.0)
    assert set(result.tetrahedron_regions) == {1}
    assert result.proved == ["delaunay", "conforming", "faithful", "labelled"]


def test_triangles_tile_the_facets_they_name():
    result = certa.conform(CUBE, CUBE_FACES)
    for facet, corners in enumerate(CUBE_FACES):
        a, b, c = (result.positions[result.triangles[result.triangle_facets == facet][:, i]] for i in range(3))
        normals = numpy.cross(b - a, c - a) / 2
        ring = CUBE[corners]
        expected = sum(numpy.cross(ring[i] - ring[0], ring[i + 1] - ring[0]) for i in (1, 2)) / 2
        assert numpy.allclose(normals.sum(axis=0), expected)


def test_arrays_own_their_memory():
    result = certa.conform(CUBE, CUBE_FACES)
    positions = result.positions
    del result
    positions += 1.0
    assert numpy.array_equal(positions, CUBE + 1.0)


def test_a_negative_index_is_refused_with_its_polygon():
    with pytest.raises(certa.InputError) as caught:
        certa.conform(CUBE, [[0, 1, 2], [3, -1, 2]])
    assert caught.value.kind == "index_out_of_range"
    assert caught.value.elements == [certa.ElementRef("polygon", 1)]
    assert "vertex -1" in str(caught.value)
