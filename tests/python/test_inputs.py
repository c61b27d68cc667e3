"""What may be passed as a mesh, and how what may not be is refused."""

import pathlib
import types

import certa
import numpy
import pytest
from hypothesis import given, strategies
from shapes import CUBE, CUBE_FACES

REFERENCE = certa.conform(CUBE, CUBE_FACES)


def same(result):
    return numpy.array_equal(result.tetrahedra, REFERENCE.tetrahedra) and numpy.array_equal(
        result.positions, REFERENCE.positions
    )


POSITION_TYPES = ["f4", "f8", "f2", ">f8", "i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8", ">i4", "O", "longdouble"]
INDEX_TYPES = ["i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8", ">i4", ">u8", "f4", "f8", "O"]


@given(strategies.sampled_from(POSITION_TYPES), strategies.sampled_from(INDEX_TYPES), strategies.sampled_from("CFSL"))
def test_any_type_and_order(position_type, index_type, order):
    positions, faces = CUBE.astype(position_type), CUBE_FACES.astype(index_type)
    if order == "F":
        positions, faces = numpy.asfortranarray(positions), numpy.asfortranarray(faces)
    elif order == "S":  # every other row and column of something larger, backwards
        large = numpy.zeros((16, 6), dtype=position_type)
        large[::2, ::2] = positions
        positions = large[::2, ::2]
        faces = numpy.ascontiguousarray(faces[::-1])[::-1]
        assert not positions.flags.contiguous
    elif order == "L":
        positions, faces = positions.tolist(), tuple(map(tuple, faces.tolist()))
    assert same(certa.conform(positions, faces))


def test_inputs_stay_as_they_are():
    positions, faces = CUBE.copy(), CUBE_FACES.copy()
    positions.flags.writeable = faces.flags.writeable = False
    result = certa.conform(positions, faces)
    result.positions[:] = 7
    result.input.positions[:] = 8
    assert numpy.array_equal(positions, CUBE)


def test_objects_of_other_packages():
    assert same(certa.conform(types.SimpleNamespace(vertices=CUBE, faces=CUBE_FACES)))
    assert same(certa.conform(types.SimpleNamespace(points=CUBE, faces=CUBE_FACES.tolist())))
    padded = numpy.hstack([numpy.full((6, 1), 4), CUBE_FACES]).reshape(-1)
    assert same(certa.conform(types.SimpleNamespace(points=CUBE, faces=padded)))
    assert same(certa.conform((CUBE, CUBE_FACES)))
    assert same(certa.conform(certa.MeshDocument(CUBE, CUBE_FACES)))
    assert same(certa.conform((row for row in CUBE.tolist()), (row for row in CUBE_FACES.tolist())))


def test_objects_of_more_packages():
    quads = types.SimpleNamespace(type="quad", data=CUBE_FACES)
    assert same(certa.conform(types.SimpleNamespace(vertices=CUBE, triangles=CUBE_FACES)))
    assert same(certa.conform(types.SimpleNamespace(points=CUBE, cells=[quads])))
    with pytest.raises(TypeError, match="hexahedron"):
        certa.conform(types.SimpleNamespace(points=CUBE, cells=[types.SimpleNamespace(type="hexahedron", data=[[0] * 8])]))
    tetra = types.SimpleNamespace(type="tetra", data=REFERENCE.tetrahedra)
    assert numpy.isclose(certa.curvature(types.SimpleNamespace(points=CUBE, cells=[tetra])).total.area, 6)


def test_data_frames():
    pandas = pytest.importorskip("pandas")
    assert same(certa.conform(pandas.DataFrame(CUBE), pandas.DataFrame(CUBE_FACES)))


def test_attributes_that_users_change_are_checked_again():
    document = certa.MeshDocument(CUBE, CUBE_FACES)
    document.positions = CUBE.tolist()
    assert same(certa.conform(document))
    for name, value, error in [
        ("positions", None, TypeError),
        ("positions", CUBE[:, :2], ValueError),
        ("corners", document.corners[:-1], ValueError),
        ("polygon_offsets", [0, 30, 4, 24], ValueError),
        ("facet_offsets", [], ValueError),
        ("hole_offsets", [0, 0], ValueError),
        ("facet_markers", [1, 2], ValueError),
        ("facet_markers", [2**40] * 6, ValueError),
        ("segments", [[0, 1, 2]], ValueError),
        ("tetrahedra", [[0, 1, 2, 9]], certa.InputError),
        ("fields", {"vertices": {"a": [1, 2, 3]}}, ValueError),
        ("fields", {"vertices": {"a": ["x"] * 8}}, ValueError),
        ("fields", {"corners": {}}, ValueError),
    ]:
        document = certa.MeshDocument(CUBE, CUBE_FACES)
        setattr(document, name, value)
        with pytest.raises(error):
            certa.view(document)


def test_messages_speak_of_arguments():
    crossing = numpy.vstack([CUBE, CUBE + 0.5]), numpy.vstack([CUBE_FACES, CUBE_FACES + 8])
    with pytest.raises(certa.InputError, match="use repair=True") as caught:
        certa.conform(crossing)
    assert all("--" not in defect.message for defect in caught.value.defects)
    assert certa.conform(crossing, repair=True).outcome == "done"


def test_files_are_meshes(tmp_path):
    certa.write(tmp_path / "cube.off", CUBE, CUBE_FACES)
    assert same(certa.conform(tmp_path / "cube.off")) and same(certa.conform(str(tmp_path / "cube.off")))


def test_polygons_of_several_lengths():
    faces = [list(face) for face in CUBE_FACES[1:]] + [[0, 3, 2], [2, 1, 0]]
    document = certa.MeshDocument(CUBE, faces)
    assert [len(face) for face in document.faces] == [4] * 5 + [3] * 2
    assert certa.conform(document).outcome == "done"


@pytest.mark.parametrize(
    "positions, faces, error, words",
    [
        (CUBE[:, :2], CUBE_FACES, ValueError, r"shape \(n, 3\), not \(8, 2\)"),
        (CUBE.T, CUBE_FACES, ValueError, r"positions\.T"),
        (CUBE.reshape(-1), CUBE_FACES, ValueError, r"reshape\(-1, 3\)"),
        ("cube", CUBE_FACES, TypeError, "str"),
        ([["a", "b", "c"]], CUBE_FACES, TypeError, "real numbers"),
        (CUBE * 1j, CUBE_FACES, TypeError, "complex"),
        ([[0, 0, None]], CUBE_FACES, TypeError, "numbers"),
        (7, CUBE_FACES, TypeError, "int"),
        (numpy.ma.masked_less(CUBE, 0.5), CUBE_FACES, ValueError, "masked"),
        (CUBE, CUBE_FACES + 0.5, ValueError, "is no index"),
        (CUBE, numpy.where(CUBE_FACES == 3, numpy.nan, CUBE_FACES), ValueError, "is no index"),
        (CUBE, CUBE_FACES > 3, TypeError, "bool"),
        (CUBE, CUBE_FACES.reshape(-1), ValueError, r"one row a polygon.*faces\.reshape\(-1, 3\)"),
        (CUBE, {(0, 1, 2), (0, 2, 3)}, TypeError, "set"),
        (CUBE, CUBE_FACES + 1, certa.InputError, "count from 1: subtract 1"),
        (CUBE, CUBE_FACES[None], ValueError, "one row a polygon"),
        (CUBE, "faces", TypeError, "str"),
        (CUBE, [[0, 1, 2], 3], Exception, "faces"),
        (CUBE, [[0, 1, 2], [0, 1, "x", 3]], TypeError, r"faces\[1\]"),
        (numpy.full((4, 3), 2**53 + 1), [[0, 1, 2]], ValueError, "rounded"),
    ],
)
def test_what_is_no_mesh_is_refused(positions, faces, error, words):
    with pytest.raises(error, match=words):
        certa.conform(positions, faces)


@given(strategies.integers(-(2**63), 2**63 - 1).filter(lambda i: not 0 <= i < 8), strategies.integers(0, 5))
def test_indices_out_of_range_are_named(index, row):
    faces = CUBE_FACES.copy()
    faces[row, 2] = index
    with pytest.raises(certa.InputError) as caught:
        certa.conform(CUBE, faces)
    assert caught.value.kind == "index_out_of_range"
    assert caught.value.elements == [certa.ElementRef("polygon", row)]
    assert str(index) in str(caught.value)


@pytest.mark.parametrize("index", [2**64 - 1, 2**70, -(2**70), 8 + 2**32])
def test_huge_indices_do_not_wrap(index):
    with pytest.raises((ValueError, TypeError)):
        certa.conform(CUBE, [[0, 1, index]])


@given(strategies.sampled_from([numpy.nan, numpy.inf, -numpy.inf]), strategies.integers(0, 7), strategies.integers(0, 2))
def test_numbers_that_are_none_are_named(value, row, column):
    positions = CUBE.copy()
    positions[row, column] = value
    with pytest.raises(certa.InputError) as caught:
        certa.conform(positions, CUBE_FACES)
    assert caught.value.kind == "non_finite_coordinate"
    assert caught.value.elements[0] == ("vertex", row)


@pytest.mark.parametrize("mesh", [None, 3, {}, "", object(), CUBE, [CUBE], (1, 2, 3), types.SimpleNamespace(points=CUBE)])
def test_what_says_no_mesh_is_refused(mesh):
    with pytest.raises((TypeError, ValueError)):
        certa.conform(mesh)


def test_an_empty_mesh_is_refused():
    for positions, faces in (([], []), (CUBE, [])):
        with pytest.raises(certa.InputError) as caught:
            certa.curvature(positions, faces)
        assert caught.value.kind == "empty_input"


def test_files_that_are_none(tmp_path):
    with pytest.raises(certa.IoError) as caught:
        certa.read(tmp_path / "none.off")
    assert caught.value.path.endswith("none.off") and isinstance(caught.value, OSError)
    broken = tmp_path / "b\udcff.off"  # a name that is no UTF-8
    pathlib.Path(broken).write_text("OFF\n1 0 0\n0 0 x\n")
    with pytest.raises(certa.IoError) as caught:
        certa.read(broken)
    assert caught.value.line == 3
    with pytest.raises(TypeError):
        certa.write(CUBE, "cube.off")
    with pytest.raises(ValueError):
        certa.read("a\0b")


@pytest.mark.parametrize(
    "options, error, words",
    [
        ({"alpha": 0.7}, certa.InputError, r"^alpha: 0.7 is out of range; allowed is \(0, 0.5\)"),
        ({"alpha": float("nan")}, certa.InputError, "alpha"),
        ({"alpha": [1]}, TypeError, "alpha: expected a number"),
        ({"alpha": True}, TypeError, "alpha"),
        ({"gabriel": 1}, TypeError, "gabriel: expected True or False"),
        ({"protection": "some"}, certa.InputError, "needed|sharp|all"),
        ({"planarity": "2 mm"}, certa.InputError, "planarity: '2 mm' is not a length"),
        ({"max_points": 0}, certa.InputError, "max_points"),
        ({"max_points": 2.5}, certa.InputError, "max_points: '2.5' is not a whole number"),
        ({"max_point": 5}, TypeError, "did you mean 'max_points'"),
        ({"keep-outside": True}, TypeError, "did you mean 'keep_outside'"),
        ({"threads": 0}, ValueError, "threads"),
        ({"progress": 5}, TypeError, "progress"),
        ({"reference": "none"}, ValueError, "reference"),
    ],
)
def test_options_are_those_of_the_command(options, error, words):
    with pytest.raises(error, match=words):
        certa.conform(CUBE, CUBE_FACES, **options)


def test_options_take_numpys_numbers():
    result = certa.conform(
        CUBE, CUBE_FACES, alpha=numpy.float32(0.25), gabriel=numpy.bool_(True), max_points=numpy.int64(100), planarity="1%"
    )
    assert "gabriel" in result.proved


def test_angles_are_in_radians():
    positions = CUBE
    sharp = certa.remesh(positions, CUBE_FACES, feature_angle_radians=1.0, faces=60, verify=False)
    blunt = certa.remesh(positions, CUBE_FACES, feature_angle_radians=numpy.pi, faces=60, verify=False)
    assert sharp.statistics["feature_edges"] > 0 and blunt.statistics["feature_edges"] == 0
    with pytest.raises(certa.InputError, match="error, vertices and faces"):
        certa.remesh(positions, CUBE_FACES, faces=60, vertices=60)
