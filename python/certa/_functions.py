"""The functions of the package: they name arguments, hand them to the library, and make objects of what it returns."""

from __future__ import annotations

import os
import pathlib
import warnings
from typing import Any, List, Optional, Union

from numpy.typing import ArrayLike

from . import _certa, _inputs
from ._document import MeshDocument
from ._errors import CertaWarning, UnfinishedWarning
from ._expressions import expression_of
from ._options import Progress, documented
from ._results import (
    ConformingCheck,
    ConformResult,
    CurvatureLine,
    CurvatureMeasures,
    CurvatureResult,
    ImplicitCheck,
    ImplicitComponent,
    ImplicitMeshCheck,
    ImplicitResult,
    Obstacle,
    RegionResult,
    RemeshResult,
    SurfaceCheck,
    Umbilic,
    View,
)
from ._sources import as_document, available_memory, box_of, named_models, watch

# Objects with .vertices and .faces or .points and .faces are meshes, too; functions are texts, expressions, callables.
MeshLike = Any
Faces = Any
FunctionLike = Any
Path = Union[str, "os.PathLike[str]"]

_MESH_NAMES = (".off", ".obj", ".ply", ".stl", ".poly", ".smesh", ".node", ".ele", ".mesh", ".vtu", ".msh", ".csv")
_ALONE = (
    "nothing says what the mesh is to be checked against: give against= what it was made from or stands for (only "
    "tetrahedra have promises that are theirs alone: their form and the Delaunay property)"
)


def _note(messages, where):
    if messages:
        more = f" (and {len(messages) - 1} more in {where})" if len(messages) > 1 else ""
        warnings.warn(messages[0] + more, CertaWarning, stacklevel=4)


def _unfinished(result, message):
    warnings.warn(f"{message}; look at `outcome` before you use what there is", UnfinishedWarning, stacklevel=4)
    return result


def read(path: Path, *, format: Optional[str] = None) -> MeshDocument:
    """Read a mesh file; numbers arrive as the nearest doubles, order is kept.

    Parameters
    ----------
    path : path of a file, "-" for standard input
    format : str, optional
        instead of the one that the extension or the content stands for: "off", "obj", "ply", "stl", "poly", "smesh",
        "node", "medit", "vtu" or "msh"

    Raises
    ------
    IoError with path, line and reason.
    """
    document = MeshDocument._from_library(_certa.read(_inputs.path_text(path), format))
    for note in document.notes:
        warnings.warn(note, CertaWarning, stacklevel=2)
    return document


@documented("output", without=("reference",))
def write(
    path: Path, mesh: MeshLike, faces: Optional[Faces] = None, *, format: Optional[str] = None, **options
) -> None:
    """Write a mesh or a result to a file, whole or not at all; every number reads back as the same double.

    Parameters
    ----------
    path : path of the file; its extension says the format
    mesh, faces : see the package's help
    format : str, optional
        instead of the one that the extension stands for
    {options}

    Raises
    ------
    IoError, also when the format cannot carry what the mesh holds: the message names one that can.
    """
    if not _inputs.is_path(path) and not isinstance(path, bytes):
        raise TypeError(f"write(path, mesh): expected the path of a file first, not {type(path).__name__}")
    name = os.fsdecode(path)
    document = as_document(mesh, faces)
    kind = format or pathlib.PurePath(name).suffix[1:].lower()
    if isinstance(mesh, ImplicitResult) and kind not in ("ply", "vtu"):
        # Components are not lost: they are the connected parts. Formats without fields would refuse their numbers.
        document = MeshDocument(mesh.positions, mesh.triangles, remark=document.remark)
    _certa.write(_inputs.path_text(path), document, format, options)


@documented("conform")
def conform(
    mesh: MeshLike,
    faces: Optional[Faces] = None,
    *,
    segments: Optional[ArrayLike] = None,
    verify: bool = True,
    reference: str = "id",
    threads: Optional[int] = None,
    progress: Progress = None,
    **options,
) -> ConformResult:
    """Make the conforming Delaunay tetrahedral mesh of a surface mesh or a piecewise linear complex.

    Parameters
    ----------
    mesh, faces : see the package's help; certa.MeshDocument describes facets with holes, region seeds and markers
    segments : (m, 2) indices, optional
        segments beside those of the mesh
    {options}
    verify : bool, default True
        run the independent checker on the result
    reference : 'id' or 'marker', default 'id'
        what formats with one number per element will carry: 1-based facet and segment, or the input's markers
    threads : int, optional
        how many; all by default; results do not depend on it
    progress : callable, optional
        called now and then with the name of the stage and the fraction of it done; an exception in it stops the run

    Raises
    ------
    InputError with every violation that was found.
    """
    document = as_document(mesh, faces, segments=segments)
    if reference not in ("id", "marker"):
        raise ValueError(f"reference: {reference!r} is not 'id' or 'marker'")
    values = _certa.conform(document, options, bool(verify), reference, *watch(progress, threads))
    promises = ["delaunay", "conforming", "faithful", "labelled"] + (["gabriel"] if options.get("gabriel") else [])
    if values["check"] is not None:
        values["check"] = ConformingCheck(**values["check"], promises=promises)
    for name in ("document", "input"):
        values[name] = MeshDocument._from_library(values[name])
    result = ConformResult(**values)
    _note([defect.message for defect in result.warnings], "warnings")
    if result.outcome != "done":
        why = result.obstacles[0].message if result.obstacles else "obstacles say where"
        return _unfinished(result, f"not finished ({result.outcome}): {why}")
    return result


@documented("curvature")
def curvature(
    mesh: MeshLike,
    faces: Optional[Faces] = None,
    *,
    region: Optional[Union[str, ArrayLike]] = None,
    solid: Optional[int] = None,
    threads: Optional[int] = None,
    progress: Progress = None,
    **options,
) -> Union[CurvatureResult, RegionResult]:
    """Measure principal curvatures and directions at every vertex, or the curvature measures of one region.

    Curvatures are positive on a sphere whose normals point outwards; `mean` is the density of k1 + k2.

    Parameters
    ----------
    mesh, faces : see the package's help; of tetrahedra the boundary is measured
    region : str or indices of faces, optional
        measure this part of space or of the surface instead: "ball:x,y,z:R", "box:x,y,z:x,y,z",
        "halfspace:x,y,z:nx,ny,nz", joined by & | ! and parentheses, or the indices of faces or a mask of them
    solid : int, optional
        of tetrahedra: the boundary of this region only
    {options}
    threads : int, optional
        how many; all by default; results do not depend on it
    progress : callable, optional
        called now and then with the name of the stage and the fraction of it done; an exception in it stops the run

    Returns
    -------
    CurvatureResult, with a region RegionResult
    """
    document = as_document(mesh, faces)
    if solid is not None:
        solid = int(_inputs.integers([solid], "solid")[0])
    watched = watch(progress, threads)
    if region is not None:
        if not isinstance(region, str):
            region = _inputs.selected(region, "region")
        values = _certa.region_measures(document, options, solid, region, *watched)
        values["measures"] = CurvatureMeasures(**values["measures"])
        return RegionResult(**values)
    values = _certa.curvature(document, options, solid, *watched)
    fields = values.pop("fields")
    arrays = {name: fields.get(name) for name in CurvatureResult.__dataclass_fields__ if name not in values}
    arrays["bounds"] = {name[len("bound_") :]: array for name, array in fields.items() if name.startswith("bound_")}
    places = {location: dict(named) for location, named in document.fields.items()}
    places["vertices"].update(fields)
    copy = MeshDocument._from_library({**document.__dict__, "fields": places})
    values["total"] = CurvatureMeasures(**values["total"])
    return CurvatureResult(**{**arrays, **values, "document": copy})


@documented("remesh")
def remesh(
    mesh: MeshLike,
    mesh_faces: Optional[Faces] = None,
    /,
    *,
    features: Optional[ArrayLike] = None,
    guides: Optional[ArrayLike] = None,
    placement: bool = True,
    lines: bool = False,
    verify: bool = True,
    threads: Optional[int] = None,
    progress: Progress = None,
    **options,
) -> RemeshResult:
    """Few polygons along lines of curvature: anisotropic, quad-dominant, with creases and boundary kept.

    Without error, vertices or faces the error is 0.2 % of the diagonal.

    Parameters
    ----------
    mesh, mesh_faces : see the package's help; the option `faces` is the number of faces asked for
    features : (m, 2) indices, optional
        edges that are creases, whatever their angle
    guides : (m, 2) indices, optional
        edges that lines follow without being creases
    {options}
    placement : bool, default True
        move vertices to where the error is least
    lines : bool, default False
        also return the lines of curvature and the umbilics
    verify : bool, default True
        run the independent checker on the result
    threads : int, optional
        how many; all by default; results do not depend on it
    progress : callable, optional
        called now and then with the name of the stage and the fraction of it done; an exception in it stops the run
    """
    document = as_document(mesh, mesh_faces)
    edges = _inputs.elements(() if features is None else features, 2, "features")
    followed = _inputs.elements(() if guides is None else guides, 2, "guides")
    values = _certa.remesh(
        document, options, edges, followed, bool(placement), bool(lines), bool(verify), *watch(progress, threads)
    )
    values["lines"] = [CurvatureLine(*line) for line in values["lines"]]
    values["umbilics"] = [Umbilic(*umbilic) for umbilic in values["umbilics"]]
    if values["check"] is not None:
        values["check"] = SurfaceCheck(**values["check"])
    result = RemeshResult(**values, input=document)
    _note(result.statistics["notes"], "statistics['notes']")
    if result.check is not None and not result.check.ok:
        result.outcome = "unverified"
        return _unfinished(result, f"the result fails its check: {result.check.violations[0].message}")
    if result.outcome != "done":
        return _unfinished(result, f"what was asked for could not be had ({result.outcome})")
    return result


@documented("implicit")
def implicit(
    function: FunctionLike,
    box: ArrayLike = ((-2.0, -2.0, -2.0), (2.0, 2.0, 2.0)),
    *,
    level: FunctionLike = 0.0,
    error: Optional[Union[float, str]] = None,
    hausdorff: Optional[Union[float, str]] = None,
    engine: str = "growth",
    memory_bytes: Optional[int] = None,
    verify: bool = True,
    threads: Optional[int] = None,
    progress: Progress = None,
    **options,
) -> ImplicitResult:
    """Mesh the zero set of a function of x, y, z with certified topology. Inside is negative.

    Parameters
    ----------
    function : str, certa.Expression, path of a file, or Python function of x, y, z
        an expression, or a function that is called once with expressions for x, y, z: it may use + - * / **,
        certa.sin and the like (numpy's too), and neither branches nor min, max, abs
    box : low and high corner, default -2 to 2
        without clip=True the surface must not meet its boundary
    level : number, default 0
        mesh {{function = level}} instead
    error : length, optional
        refine and simplify to this distance from the zero set, as sampled; as fine as the proof by default
    hausdorff : length, optional
        prove that mesh and zero set are within this length of each other
    engine : 'growth', 'plantinga-vegter' or 'thesis', default 'growth'
        the second writes no certificate
    {options}
    memory_bytes : int, optional
        stop before more would be taken; what is free by default
    verify : bool, default True
        run the independent checker on the result
    threads : int, optional
        how many; all by default; results do not depend on it
    progress : callable, optional
        called now and then with the name of the stage and the fraction of it done; an exception in it stops the run

    Raises
    ------
    ExpressionError with line and column, TraceError.
    """
    if isinstance(function, os.PathLike):
        function = pathlib.Path(function).read_text(encoding="utf-8-sig")
    expression = expression_of(function)
    if not (level is None or (isinstance(level, (int, float)) and level == 0)):
        expression = expression - expression_of(level)
    memory = available_memory() if memory_bytes is None else int(memory_bytes)
    corners = box_of(box)
    values = _certa.implicit(
        expression._function, corners, options, error, hausdorff, str(engine), memory, bool(verify),
        *watch(progress, threads),
    )  # fmt: skip
    values["components"] = [ImplicitComponent(*component) for component in values["components"]]
    values["obstacles"] = [Obstacle(*obstacle) for obstacle in values["obstacles"]]
    if values["check"] is not None:
        values["check"] = ImplicitCheck(**values["check"])
    result = ImplicitResult(**values)
    if result.verdict == "undecided":
        first = result.obstacles[0] if result.obstacles else Obstacle(result.outcome, result.low, result.high)
        return _unfinished(result, f"undecided ({first.reason}) in the box {first.low} to {first.high}")
    if hausdorff is not None and result.verdict == "certified" and result.hausdorff is None:
        result.outcome = "undecided"
        return _unfinished(result, "the mesh is not proved to be within the distance asked for; a smaller one may be")
    return result


@documented("conforming_check", "surface_check")
def check(
    mesh: MeshLike,
    against: Optional[Union[MeshLike, FunctionLike]] = None,
    *,
    certificate: Optional[str] = None,
    box: Optional[ArrayLike] = None,
    repair: bool = False,
    triangulate: bool = False,
    threads: Optional[int] = None,
    progress: Progress = None,
    **options,
) -> Union[ConformingCheck, SurfaceCheck, ImplicitCheck, ImplicitMeshCheck]:
    """Verify what the other functions promise, on the mesh of any program.

    Parameters
    ----------
    mesh : see the package's help; for a result of conform, remesh or implicit nothing else is needed
    against : mesh, or function (str, certa.Expression, Python function), optional
        what the mesh was made from or stands for; of other tetrahedra, without it, form and Delaunay property are decided
    certificate : str, optional
        of `implicit`: verify a triangle mesh by it
    box : low and high corner, optional
        against a function: the mesh's box, enlarged by about a sixth, by default
    repair, triangulate : bool, default False
        the tetrahedral mesh was made with that option
    {options}
    threads : int, optional
        how many; all by default; results do not depend on it
    progress : callable, optional
        called now and then with the name of the stage and the fraction of it done; an exception in it stops the run

    Returns
    -------
    ConformingCheck, SurfaceCheck, ImplicitCheck or ImplicitMeshCheck; each has `ok`
    """
    watched = watch(progress, threads)
    if against is None and isinstance(mesh, (ConformResult, RemeshResult)):
        against = mesh.input
    if against is None and isinstance(mesh, ImplicitResult):
        against, certificate = mesh.function, certificate or mesh.certificate or None
    document = as_document(mesh)
    if against is None:
        return _check_alone(document, certificate, box, repair or triangulate, options, watched)
    if certificate is not None or _is_function(against):
        given = {name: value for name, value in options.items() if value is not None}
        if given:
            raise TypeError(f"check() against a function has no option '{next(iter(given))}'")
        source = expression_of(against)
        if certificate is not None:
            values = _certa.check_implicit(document, source.text, certificate, *watched)
            return ImplicitCheck(**values)
        corners = None if box is None else box_of(box)
        values = _certa.check_mesh_against(document, source.text, corners, *watched)
        values["obstacles"] = [Obstacle(*obstacle) for obstacle in values["obstacles"]]
        return ImplicitMeshCheck(**values)
    if box is not None:
        raise TypeError("box goes with a function to check against")
    other = as_document(against, name="against")
    if len(document.tetrahedra):
        values = _certa.check_conforming(document, other, _only(options, "conforming_check"), bool(repair),
                                         bool(triangulate), *watched)  # fmt: skip
        promises = ["well-formed", "delaunay", "conforming", "faithful", "labelled"]
        return ConformingCheck(**values, promises=promises + (["gabriel"] if options.get("gabriel") else []))
    if len(other.tetrahedra):
        raise TypeError("against is a tetrahedral mesh: a surface mesh is checked against a surface")
    return SurfaceCheck(**_certa.check_surface(document, other, _only(options, "surface_check"), *watched))


def _check_alone(document, certificate, box, mended, options, watched):
    """What can be said of tetrahedra without what they were made from."""
    if not len(document.tetrahedra) or certificate is not None or box is not None or mended:
        raise TypeError(_ALONE)
    values = _certa.check_delaunay_mesh(document, _only(options, "conforming_check"), *watched)
    return ConformingCheck(**values, promises=["well-formed", "delaunay"] + (["gabriel"] if options.get("gabriel") else []))


def _is_function(against):
    from ._expressions import Expression

    if isinstance(against, (Expression, int, float)):
        return True
    if isinstance(against, str):
        return pathlib.PurePath(against).suffix.lower() not in _MESH_NAMES
    return callable(against) and not hasattr(against, "faces")


def _only(options, table):
    """The options of one table; others that were given do not apply to this kind of mesh."""
    known = {row["name"] for row in _certa.option_tables[table]}
    for name, value in options.items():
        if name not in known and value is not None and value is not False:
            raise TypeError(f"check(): '{name}' does not apply to this kind of mesh")
    return {name: value for name, value in options.items() if name in known}


@documented("view")
def view(*models: MeshLike, title: str = "", names: Optional[List[str]] = None, height: int = 600, **options) -> View:
    """Make a self-contained page that shows meshes; as the last value of a notebook's cell it shows itself.

    Parameters
    ----------
    models : meshes, see the package's help, or pairs of a name and a mesh
    title : str, optional
        of the page; the names of the models by default
    names : list of str, optional
        of the models
    height : int, default 600
        in a notebook, in pixels
    {options}
    """
    pairs = named_models(models, names)
    return View(_certa.view(pairs, str(title), options), int(height))
