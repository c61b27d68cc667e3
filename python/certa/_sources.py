"""One document from whatever a caller passes as a mesh."""

from . import _certa, _inputs
from ._document import MeshDocument


def as_document(mesh, faces=None, *, segments=None, name="mesh"):
    """A certa.MeshDocument of an object, of (positions, faces), or of the file at a path."""
    document = _document_of(mesh, faces, name)
    if segments is None:
        return document
    more = _inputs.elements(segments, 2, "segments")
    if len(document.segment_markers):
        raise ValueError("segments: the mesh has segments with markers; make a certa.MeshDocument of all of them")
    return replaced(document, segments=_inputs.numpy.concatenate([document.segments, more]))


def replaced(document, **attributes):
    """A shallow copy with other attributes."""
    copy = MeshDocument.__new__(MeshDocument)
    copy.__dict__.update(document.__dict__, **attributes)
    return copy


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
    positions = getattr(mesh, "vertices", None)
    if positions is None:
        positions = getattr(mesh, "points", None)
    around = getattr(mesh, "faces", None)
    if positions is None or around is None or callable(positions) or callable(around):
        raise TypeError(
            f"{name}: expected (positions, faces), an object with .vertices and .faces or .points and .faces, a path "
            f"or a certa.MeshDocument, not {type(mesh).__name__}"
        )
    document = MeshDocument(positions)
    flat = getattr(around, "ndim", 2) == 1 and getattr(getattr(around, "dtype", None), "kind", "O") in "iu"
    document._set_polygons(*(_inputs.padded_polygons(around) if flat else _inputs.polygons(around)))
    return document


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
