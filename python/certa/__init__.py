"""Certa: surface discretization you can trust.

conform     conforming Delaunay tetrahedra of a surface mesh or a piecewise linear complex
read, write files

Meshes are given as (positions, faces), as objects with `.vertices` and `.faces` or `.points` and `.faces`, as paths of
files, as certa.MeshDocument, or as results of these functions. Indices count from 0, lengths are in the input's unit or
texts such as "2%" (of the bounding box's diagonal). Wrong data raises certa.InputError; what cannot be done within
the limits shows in `outcome` of the result. Ctrl-C stops any of them.
"""

import warnings as _warnings

from . import _certa, _inputs
from ._certa import version as __version__
from ._document import MeshDocument
from ._errors import (
    CertaWarning,
    Defect,
    ElementRef,
    ExpressionError,
    InputError,
    InternalError,
    IoError,
    UnfinishedWarning,
    Violation,
)
from ._options import documented as _documented
from ._results import ConformingCheck, ConformResult
from ._sources import as_document as _as_document
from ._sources import watch as _watch


def _note(messages, where):
    if messages:
        more = f" (and {len(messages) - 1} more in {where})" if len(messages) > 1 else ""
        _warnings.warn(messages[0] + more, CertaWarning, stacklevel=4)


def _finish(result, why):
    if result.outcome != "done":
        _warnings.warn(f"not finished: {result.outcome}{why}", UnfinishedWarning, stacklevel=4)
    return result


def read(path, *, format=None) -> MeshDocument:
    """Read a mesh file; numbers arrive as the nearest doubles, order is kept.

    Parameters
    ----------
    path : path of a file, "-" for standard input
    format : instead of the one that the extension or the content stands for: "off", "obj", "ply", "stl", "poly",
        "smesh", "node", "medit", "vtu" or "msh"

    Raises
    ------
    IoError with path, line and reason.
    """
    document = MeshDocument._from_library(_certa.read(_inputs.path_text(path), format))
    _note(document.notes, "notes")
    return document


@_documented("output", without=("reference",))
def write(path, mesh, faces=None, *, format=None, **options) -> None:
    """Write a mesh or a result to a file, whole or not at all; every number reads back as the same double.

    Parameters
    ----------
    path : path of the file; its extension says the format
    mesh, faces : see the package's help
    format : instead of the one that the extension stands for
    {options}

    Raises
    ------
    IoError, also when the format cannot carry what the mesh holds: the message names one that can.
    """
    if not _inputs.is_path(path) and not isinstance(path, bytes):
        raise TypeError(f"write(path, mesh): expected the path of a file first, not {type(path).__name__}")
    _certa.write(_inputs.path_text(path), _as_document(mesh, faces), format, options)


@_documented("conform")
def conform(
    mesh, faces=None, *, segments=None, verify=True, reference="id", threads=None, progress=None, **options
) -> ConformResult:
    """Make the conforming Delaunay tetrahedral mesh of a surface mesh or a piecewise linear complex.

    Parameters
    ----------
    mesh, faces : see the package's help; certa.MeshDocument describes facets with holes, region seeds and markers
    segments : (m, 2) indices of segments beside those of the mesh
    {options}
    verify : bool, default True
        run the independent checker on the result
    reference : 'id' or 'marker', default 'id'
        what formats with one number per element will carry: 1-based facet and segment, or the input's markers
    threads : int
        how many; all by default; results do not depend on it
    progress : callable
        called now and then with the name of the stage and the fraction of it done; an exception in it stops the run

    Raises
    ------
    InputError with every violation that was found.
    """
    document = _as_document(mesh, faces, segments=segments)
    if reference not in ("id", "marker"):
        raise ValueError(f"reference: '{reference}' is not 'id' or 'marker'")
    values = _certa.conform(document, options, bool(verify), reference, *_watch(progress, threads))
    promises = ["delaunay", "conforming", "faithful", "labelled"] + (["gabriel"] if options.get("gabriel") else [])
    if values["check"] is not None:
        values["check"] = ConformingCheck(**values["check"], promises=promises)
    for name in ("document", "input"):
        values[name] = MeshDocument._from_library(values[name])
    result = ConformResult(**values)
    _note([defect.message for defect in result.warnings], "warnings")
    return _finish(result, "; obstacles say where and why")
