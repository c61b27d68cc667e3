"""curvature, remesh, implicit, check, view, read and write: known answers, and what is refused."""

import html
import pickle
import re

import certa
import numpy
import pytest
from shapes import CUBE, CUBE_FACES, icosphere, torus

TORUS = "(x^2+y^2+z^2+0.84)^2 - 4*(x^2+y^2)"


@pytest.fixture(scope="module")
def few():
    return certa.remesh(torus(), faces=300)


@pytest.fixture(scope="module")
def ring():
    return certa.implicit(TORUS)


def test_curvature_of_a_sphere():
    positions, triangles = icosphere(3)
    result = certa.curvature(positions, triangles)
    assert numpy.isclose(result.total.gaussian, 4 * numpy.pi)
    assert abs(result.mean.mean() - 2) < 0.02 and abs(result.gaussian.mean() - 1) < 0.02
    assert (result.k_min <= result.k_max).all()
    assert (numpy.einsum("ij,ij->i", result.normal, positions) > 0.99).all()
    assert result.euler_characteristic == 2
    assert set(result.document.fields["vertices"]) >= {"k_min", "k_max", "dir_min", "mean"}
    assert result.tensor is None and certa.curvature(positions, triangles, tensors=True).tensor.shape == (642, 6)


def test_curvature_names_the_polygons_that_triangles_come_from():
    result = certa.curvature(CUBE, CUBE_FACES)
    assert numpy.array_equal(numpy.bincount(result.source_faces), [2] * 6)
    assert (result.flags & certa.VertexFlags.border == 0).all()


def test_measures_of_regions():
    whole = certa.curvature(CUBE, CUBE_FACES, region="ball:0,0,0:5").measures
    assert numpy.isclose(whole.area, 6) and numpy.isclose(whole.gaussian, 4 * numpy.pi)
    half = certa.curvature(CUBE, CUBE_FACES, region="ball:0,0,0:5 & halfspace:0.5,0,0:1,0,0").measures
    assert numpy.isclose(half.area, 3)
    assert numpy.isclose(certa.curvature(CUBE, CUBE_FACES, region=[0, 3]).measures.area, 2)
    mask = numpy.arange(6) < 2
    assert numpy.isclose(certa.curvature(CUBE, CUBE_FACES, region=mask).measures.area, 2)
    with pytest.raises(certa.InputError, match="polygon 1"):
        certa.curvature(CUBE, CUBE_FACES, region=[6])


def test_regions_of_solids():
    ball = certa.conform(*icosphere(1))
    assert numpy.isclose(certa.curvature(ball, solid=1).total.gaussian, 4 * numpy.pi)
    with pytest.raises(certa.InputError, match="no tetrahedron is of region 7; there are regions 1"):
        certa.curvature(ball, solid=7)


def test_remesh_is_checked_and_says_so(few):
    assert few.outcome == "done" and few.check.ok
    assert "topology" in few.proved and "embedded" in few.proved
    assert len(few.triangles) + len(few.quads) == len(few.polygon_offsets) - 1
    assert certa.check(few).ok
    assert certa.check(few.document, against=torus()).mesh["components"][0]["genus"] == 1


def test_remesh_takes_faces_as_mesh_and_as_number():
    positions, triangles = torus()
    result = certa.remesh(positions, triangles, faces=200, verify=False, lines=True)
    assert 100 < len(result.polygon_offsets) - 1 < 400 and result.check is None and result.proved == []
    assert {line.maximum for line in result.lines} == {False, True}


def test_implicit_torus(ring):
    assert ring.verdict == "certified" and ring.isotopic and ring.proved == ["isotopic"]
    assert [component.genus for component in ring.components] == [1]
    edges = numpy.unique(numpy.sort(ring.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
    assert len(ring.positions) - len(edges) + len(ring.triangles) == 0
    assert certa.check(ring).ok


def test_a_certificate_does_not_serve_another_mesh(ring):
    moved = ring.positions.copy()
    moved[0] += 0.5
    check = certa.check((moved, ring.triangles), TORUS, certificate=ring.certificate)
    assert not check.ok and check.violations


def test_meshes_against_functions():
    positions, triangles = icosphere(2)
    assert certa.check((positions, triangles), lambda x, y, z: x**2 + y**2 + z**2 - 1).ok
    assert certa.check((positions, triangles), TORUS, box=[-2, -2, -2, 2, 2, 2]).verdict == "refuted"


def test_undecided_is_told_and_warned_of():
    with pytest.warns(certa.UnfinishedWarning, match="meets"):
        result = certa.implicit("x^2 + y^2 - 1", box=[[-2] * 3, [2] * 3])
    assert result.verdict == "undecided" and len(result.triangles) == 0
    assert result.obstacles[0].reason == "meets_box"
    assert certa.implicit("x^2 + y^2 + z^2 - 1", level=-2).verdict == "empty"


@pytest.mark.parametrize("engine", ["growth", "plantinga-vegter", "thesis"])
def test_engines(engine):
    result = certa.implicit("x^2 + y^2 + z^2 - 1", engine=engine)
    assert result.verdict == "certified" and [component.genus for component in result.components] == [0]
    assert result.proved == ([] if engine == "plantinga-vegter" else ["isotopic"])
    with pytest.raises(certa.InputError, match="growth"):
        certa.implicit("x", engine="cubes")


def test_level_and_lengths():
    result = certa.implicit("x^2 + y^2 + z^2", box=(-3, -3, -3, 3, 3, 3), level=4, hausdorff="2%")
    assert result.proved == ["isotopic", "hausdorff"] and result.hausdorff <= 0.02 * 108**0.5
    radii = numpy.linalg.norm(result.positions, axis=1)
    assert (abs(radii - 2) < result.hausdorff).all()


def test_refinement_over_budget_is_an_attribute():
    # Points around the middle of a segment: it is no edge without points of its own.
    points = [[0, 0, 0], [10, 0, 0], [5, 0.1, 0], [5, -0.05, 0.1], [5, -0.05, -0.1]]
    with pytest.warns(certa.UnfinishedWarning, match="over_budget"):
        result = certa.conform(points, segments=[[0, 1]], max_points=5)
    assert result.outcome == "over_budget" and result.proved == [] and result.document.remark


def test_repairs_name_what_facets_come_from():
    bent = CUBE.copy()
    bent[6, 2] = 1.5
    with pytest.raises(certa.InputError) as caught:
        certa.conform(bent, CUBE_FACES)
    assert {defect.kind for defect in caught.value.defects} == {"non_planar_facet"}
    result = certa.conform(bent, CUBE_FACES, triangulate=True)
    assert result.outcome == "done" and len(result.facet_sources) == 7 and result.repairs
    assert sorted(set(result.facet_sources)) == list(range(6))
    assert certa.check(result).ok


def test_a_wrong_mesh_fails_its_check():
    result = certa.conform(CUBE, CUBE_FACES)
    broken = certa.MeshDocument(result.positions, tetrahedra=result.tetrahedra[1:])
    check = certa.check(broken, against=(CUBE, CUBE_FACES))
    assert not check.ok and check.violations[0].message


def test_tetrahedra_have_promises_of_their_own(tmp_path):
    positions, triangles = icosphere(2)
    result = certa.conform(positions, triangles)
    certa.write(tmp_path / "ball.mesh", result)
    for mesh in (tmp_path / "ball.mesh", str(tmp_path / "ball.mesh"), certa.MeshDocument(result.positions, tetrahedra=result.tetrahedra)):
        check = certa.check(mesh)
        assert check.ok and check.promises == ["well-formed", "delaunay"]
        assert check.tetrahedra_checked == len(result.tetrahedra)
    # A vertex moved through its neighbours: some circumsphere holds another vertex, or a tetrahedron is turned over.
    moved = result.positions.copy()
    moved[0] *= 0.9
    spoiled = certa.check(certa.MeshDocument(moved, tetrahedra=result.tetrahedra))
    assert not spoiled.ok and {v.promise for v in spoiled.violations} <= {"well-formed", "delaunay"}
    assert certa.check(tmp_path / "ball.mesh", gabriel=True).promises[-1] == "gabriel"


def test_functions_are_compared_with_triangles():
    with pytest.raises(ValueError, match="polygon 1 has 4 corners"):
        certa.check((CUBE, CUBE_FACES), against="x^2 + y^2 + z^2 - 1")


def test_a_coarse_ball_becomes_tetrahedra():
    """One of its quads crosses itself seen along the axis nearest to its normal."""
    few = certa.remesh(certa.implicit("x^2 + y^2 + z^2 - 1", error="3%"), vertices=100)
    assert certa.conform(few, triangulate=True).check.ok


def test_a_surface_alone_has_nothing_to_be_checked_against():
    for options in ({}, {"certificate": "{}"}, {"box": [0, 0, 0, 1, 1, 1]}):
        with pytest.raises(TypeError, match="against="):
            certa.check(icosphere(1), **options)
    ball = certa.conform(*icosphere(1))
    with pytest.raises(TypeError, match="against="):
        certa.check(ball.document, repair=True)
    with pytest.raises(TypeError, match="tetrahedral"):
        certa.check(icosphere(1), against=ball.document)


@pytest.mark.parametrize("name", ["m.vtu", "m.mesh", "m.msh"])
def test_files_read_back(tmp_path, name):
    result = certa.conform(CUBE / 3, CUBE_FACES)
    certa.write(tmp_path / name, result)
    back = certa.read(tmp_path / name)
    assert numpy.array_equal(back.positions, CUBE / 3)
    assert numpy.array_equal(back.tetrahedra, result.tetrahedra)
    assert certa.check(tmp_path / name, against=(CUBE / 3, CUBE_FACES)).ok


def test_fields_go_to_files_that_carry_them_and_no_others(tmp_path):
    result = certa.curvature(CUBE, CUBE_FACES)
    certa.write(tmp_path / "c.vtu", result)
    assert numpy.array_equal(certa.read(str(tmp_path / "c.vtu")).fields["vertices"]["mean"], result.mean)
    with pytest.raises(certa.IoError, match="vtu"):
        certa.write(tmp_path / "c.off", result)
    assert not (tmp_path / "c.off").exists()


def test_facets_with_holes_seeds_and_markers(tmp_path):
    square, hole = [[0, 0, 0], [3, 0, 0], [3, 3, 0], [0, 3, 0]], [[1, 1, 0], [2, 1, 0], [2, 2, 0], [1, 2, 0]]
    document = certa.MeshDocument(
        square + hole + [[1.5, 1.5, 2.0]],
        facets=[{"polygons": [[0, 1, 2, 3], [4, 5, 6, 7]], "holes": [[1.5, 1.5, 0]]}],
        facet_markers=[7],
    )
    with pytest.warns(certa.CertaWarning):
        result = certa.conform(document)
    a, b, c = (result.positions[result.triangles[:, i]] for i in range(3))
    assert numpy.isclose(numpy.linalg.norm(numpy.cross(b - a, c - a), axis=1).sum() / 2, 8)
    certa.write(tmp_path / "frame.poly", document)
    back = certa.read(tmp_path / "frame.poly")
    assert list(back.facet_markers) == [7] and len(back.facet_holes) == 1


def test_pages_show_several_models(few, tmp_path):
    page = certa.view(few, ("input", torus()), title="a <torus>", up="y")
    page.save(tmp_path / "page.html")
    assert (tmp_path / "page.html").read_text(encoding="utf-8") == page.html
    assert "a \\u003ctorus\\u003e" in page.html
    frame = page._repr_html_()
    inside = re.fullmatch(r'<iframe srcdoc="([^"]*)" [^<>]*></iframe>', frame, re.DOTALL).group(1)
    assert html.unescape(inside) == page.html


def test_results_survive_pickling(few):
    for thing in (few, certa.conform(CUBE, CUBE_FACES), certa.curvature(CUBE, CUBE_FACES), certa.trace(lambda x, y, z: x)):
        copy = pickle.loads(pickle.dumps(thing))
        assert repr(copy) == repr(thing)


def test_same_bytes_for_any_number_of_threads():
    positions, triangles = torus()
    one, all_of_them = (certa.remesh(positions, triangles, faces=200, threads=n, verify=False) for n in (1, None))
    assert one.positions.tobytes() == all_of_them.positions.tobytes()
    assert numpy.array_equal(one.corners, all_of_them.corners)
