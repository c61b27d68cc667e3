"""One document from whatever a caller passes as a mesh."""

import os

import numpy

from . import _certa, _inputs
from ._document import MeshDocument


def as_document(mesh, faces=None, *, segments=None, name="mesh"):
    """A certa.MeshDocument of an object, of (positions, faces), or of the file at a path."""
    # Points with segments need no faces.
    alone = faces is None and segments is not None and _is_rows(mesh)
    document = _document_of(mesh, () if alone else faces, name)._checked()
    if segments is None:
        return document
    more = _inputs.elements(segments, 2, "segments")
    if len(document.segment_markers):
        raise ValueError("segments: the mesh has segments with markers; make a certa.MeshDocument of all of them")
    return replaced(document, segments=numpy.concatenate([document.segments, more]))


def replaced(document, **attributes):
    """A shallow copy with other attributes."""
    copy = MeshDocument.__new__(MeshDocument)
    copy.__dict__.update(document.__dict__, **attributes)
    return copy


def _is_rows(mesh):
    """Rows of three numbers rather than (positions, faces)."""
    return hasattr(mesh, "__array__") or (isinstance(mesh, (tuple, list)) and (len(mesh) > 2 or numpy.ndim(mesh[0]) == 1))


def _document_of(mesh, faces, name):
    if faces is not None:
        if _inputs.is_path(mesh) or isinstance(mesh, MeshDocument):
            raise TypeError(f"{name}: faces go with positions, not with {type(mesh).__name__}")
        return MeshDocument(mesh, faces)
    if isinstance(mesh, MeshDocument):
        return mesh
    if isinstance(getattr(mesh, "document", None), MeshDocument):
        return mesh.document
    if _inputs.is_path(mesh):
        return MeshDocument._from_library(_certa.read(_inputs.path_text(mesh), None))
    if isinstance(mesh, (tuple, list)) and len(mesh) == 2:
        return MeshDocument(mesh[0], mesh[1])
    if hasattr(mesh, "points") and hasattr(mesh, "cells") and not hasattr(mesh, "faces"):
        return _document_of_cells(mesh, name)
    positions = _first(mesh, "vertices", "points", "positions")
    around = _first(mesh, "faces", "triangles")
    if positions is None or around is None:
        hint = "; points alone are certa.MeshDocument(positions)" if _is_rows(mesh) else ""
        raise TypeError(
            f"{name}: expected positions and faces, an object with .vertices and .faces or .points and .faces, a path "
            f"or a certa.MeshDocument, not {type(mesh).__name__} alone{hint}"
        )
    document = MeshDocument(positions)
    flat = getattr(around, "ndim", 2) == 1 and getattr(getattr(around, "dtype", None), "kind", "O") in "iu"
    document._set_polygons(*(_inputs.padded_polygons(around) if flat else _inputs.polygons(around)))
    return document


def _first(mesh, *names):
    for name in names:
        value = getattr(mesh, name, None)
        if value is not None and not callable(value):
            return value
    return None


def _document_of_cells(mesh, name):
    """Points with blocks of cells of one type each, as meshio has them."""
    rows, segments, tetrahedra = [], [numpy.zeros((0, 2), dtype=numpy.int64)], [numpy.zeros((0, 4), dtype=numpy.int64)]
    for block in mesh.cells:
        kind, cells = getattr(block, "type", None), getattr(block, "data", None)
        if kind == "line":
            segments.append(_inputs.elements(cells, 2, "line cells"))
        elif kind == "tetra":
            tetrahedra.append(_inputs.elements(cells, 4, "tetra cells"))
        elif kind in ("triangle", "quad", "polygon"):
            rows += list(_inputs.integers(cells, f"{kind} cells"))
        elif kind != "vertex":
            raise TypeError(f"{name}: cells of type {kind!r} are none of line, triangle, quad, polygon and tetra")
    return MeshDocument(mesh.points, rows, segments=numpy.concatenate(segments), tetrahedra=numpy.concatenate(tetrahedra))


def watch(progress, threads):
    """(progress, threads) as the library takes them."""
    if progress is not None and not callable(progress):
        raise TypeError(f"progress: expected a function of stage and fraction, not {type(progress).__name__}")
    if threads is None:
        return progress, 0
    if isinstance(threads, bool) or not hasattr(threads, "__index__"):
        raise TypeError(f"threads: expected a whole number, not {type(threads).__name__}")
    count = threads.__index__()
    if not 1 <= count <= 4096:
        raise ValueError(f"threads: {count} is out of range; allowed is [1, 4096]")
    return progress, count


def box_of(box):
    """Six numbers, low and high corner."""
    corners = _inputs.doubles(numpy.asarray(box, dtype=object).reshape(-1).tolist(), 0, "box")
    if corners.shape != (6,):
        raise ValueError(f"box: expected a low and a high corner, six numbers in all, not {len(corners)}")
    return corners


def available_memory():
    """Bytes that are free on this machine and in this control group; None where nobody knows."""
    limits = []
    try:
        with open("/proc/meminfo", encoding="ascii") as file:
            limits += [int(line.split()[1]) * 1024 for line in file if line.startswith("MemAvailable:")]
        with open("/sys/fs/cgroup/memory.max", encoding="ascii") as limit:
            with open("/sys/fs/cgroup/memory.current", encoding="ascii") as used:
                limits.append(max(0, int(limit.read()) - int(used.read())))
    except (OSError, ValueError):  # not mounted, or "max"
        pass
    return min(limits, default=None)


def named_models(models, names):
    """(name, document) of each model; names are file names, or numbers."""
    pairs = []
    for i, model in enumerate(models):
        if isinstance(model, tuple) and len(model) == 2 and isinstance(model[0], str) and not isinstance(model[1], str):
            name, model = model
        elif _inputs.is_path(model):
            name = os.path.basename(os.fsdecode(model)).encode("utf-8", "replace").decode()
        else:
            name = type(model).__name__.replace("Result", "").lower() if hasattr(model, "document") else f"mesh {i + 1}"
        pairs.append((name, as_document(model, name=f"model {i + 1}")))
    if names is not None:
        if len(names) != len(pairs):
            raise ValueError(f"names: {len(names)} names for {len(pairs)} models")
        pairs = [(str(name), document) for name, (_, document) in zip(names, pairs)]
    return pairs
