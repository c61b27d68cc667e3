"""Takes what Python programs have at hand: arrays of any kind and order, nested lists, data frames, other packages'
meshes. What comes out are contiguous arrays of the library's own types; nothing is rounded or reordered."""

import numbers
import os

import numpy

_ROUNDED = "some numbers are no doubles, and nothing is rounded silently; round them yourself"


def _array(values, what):
    if isinstance(values, (str, bytes, dict, set, frozenset)):
        raise TypeError(f"{what}: expected an array of numbers, not {type(values).__name__}")
    if isinstance(values, numpy.ma.MaskedArray) and numpy.ma.is_masked(values):
        raise ValueError(f"{what}: the array has masked entries; fill or remove them first")
    if not hasattr(values, "__array__") and not hasattr(values, "__len__"):
        if not hasattr(values, "__iter__"):
            raise TypeError(f"{what}: expected an array of numbers, not {type(values).__name__}")
        values = list(values)  # a generator
    try:
        array = numpy.asarray(values)
    except ValueError:
        raise ValueError(f"{what}: the rows have different lengths") from None
    if array.dtype.kind == "O":
        array = _from_objects(array, what)
    if array.size == 0 and array.dtype.kind not in "iuf":
        array = array.astype(numpy.float64)
    if array.dtype.kind not in "iuf":
        raise TypeError(f"{what}: expected real numbers, not an array of {array.dtype}")
    return array


def _from_objects(array, what):
    """Numbers of several kinds, among them integers beyond 64 bits."""
    entries = array.reshape(-1).tolist()
    for entry in entries:
        if not isinstance(entry, numbers.Real) or isinstance(entry, bool):
            raise TypeError(f"{what}: expected numbers, and {entry!r:.40} is {type(entry).__name__}")
    try:
        converted = [float(entry) for entry in entries]
    except OverflowError:
        raise ValueError(f"{what}: some numbers are too large for doubles") from None
    if any(a != b and a == a for a, b in zip(converted, entries)):
        raise ValueError(f"{what}: {_ROUNDED}")
    return numpy.array(converted, dtype=numpy.float64).reshape(array.shape)


def doubles(values, width, what):
    """An (n, width) array of doubles; width 0: a flat one."""
    array = _array(values, what)
    if array.size == 0:
        array = array.reshape((0, width) if width else (0,))
    if width and (array.ndim != 2 or array.shape[1] != width):
        hint = ""
        if array.ndim == 2 and array.shape[0] == width:
            hint = f"; {what}.T has it"
        elif array.ndim == 1 and array.size % width == 0:
            hint = f"; {what}.reshape(-1, {width}) may be meant"
        raise ValueError(f"{what}: expected shape (n, {width}), not {array.shape}{hint}")
    if not width and array.ndim != 1:
        raise ValueError(f"{what}: expected a flat array, not shape {array.shape}")
    exact = numpy.ascontiguousarray(array, dtype=numpy.float64)
    if array.dtype.itemsize >= 8 and array.dtype.newbyteorder("=") != numpy.float64:
        if not numpy.array_equal(exact.astype(array.dtype), array, equal_nan=array.dtype.kind == "f"):
            raise ValueError(f"{what}: {_ROUNDED}")
    return exact


def integers(values, what):
    """64-bit integers in the shape given."""
    array = _array(values, what)
    if array.dtype.kind == "f":
        whole = numpy.isfinite(array) & (numpy.abs(array) < 2.0**62)
        whole &= numpy.where(whole, array, 0.5) == numpy.floor(numpy.where(whole, array, 0.0))
        if not whole.all():
            place = tuple(int(i) for i in numpy.argwhere(~whole)[0])
            raise ValueError(f"{what}: {array[place]} at {list(place)} is no index")
    elif array.dtype.kind == "u" and array.dtype.itemsize == 8 and array.size and array.max() > 2**62:
        raise ValueError(f"{what}: {array.max()} is no index")
    return numpy.ascontiguousarray(array, dtype=numpy.int64)


def elements(values, width, what):
    """An (n, width) array of indices."""
    array = integers(values, what)
    if array.size == 0:
        array = array.reshape(0, width)
    if array.ndim != 2 or array.shape[1] != width:
        raise ValueError(f"{what}: expected shape (n, {width}), not {array.shape}")
    return array


def polygons(values, what="faces"):
    """(corners, offsets) of a rectangular array or of rows of any length."""
    if not hasattr(values, "__array__"):
        if isinstance(values, (str, bytes, dict, set, frozenset)) or not hasattr(values, "__iter__"):
            raise TypeError(f"{what}: expected rows of indices, not {type(values).__name__}")
        values = list(values)
        lengths = [len(row) if hasattr(row, "__len__") else -1 for row in values]
        if lengths and min(lengths) >= 0 and min(lengths) != max(lengths):
            return _ragged(values, lengths, what)
    else:
        values = numpy.asarray(values)
        if values.dtype.kind == "O" and values.ndim == 1 and all(hasattr(row, "__len__") for row in values):
            return _ragged(list(values), [len(row) for row in values], what)
    array = integers(values, what)
    if array.size == 0:
        array = array.reshape(0, 3)
    if array.ndim != 2:
        hint = f"; {what}.reshape(-1, 3) may be meant" if array.ndim == 1 and array.size % 3 == 0 else ""
        raise ValueError(f"{what}: expected rows of indices, one row a polygon, not shape {array.shape}{hint}")
    rows, width = array.shape
    return array.reshape(-1), numpy.arange(rows + 1, dtype=numpy.int64) * width


def _ragged(rows, lengths, what):
    corners = [integers(row, f"{what}[{i}]") for i, row in enumerate(rows) if lengths[i]]
    for i, row in enumerate(corners):
        if row.ndim != 1:
            raise ValueError(f"{what}[{i}]: expected indices, not shape {row.shape}")
    flat = numpy.concatenate(corners) if corners else numpy.zeros(0, dtype=numpy.int64)
    return flat, numpy.concatenate([[0], numpy.cumsum(lengths)]).astype(numpy.int64)


def padded_polygons(values):
    """(corners, offsets) of a flat array in which a count stands before each polygon, as pyvista has it."""
    flat = integers(values, "faces").reshape(-1)
    starts, at = [], 0
    while at < len(flat):
        count = int(flat[at])
        if count < 0 or at + 1 + count > len(flat):
            raise ValueError(f"faces: {count} at [{at}] is no count of corners that fits the rest of the array")
        starts.append((at + 1, count))
        at += 1 + count
    counts = numpy.array([count for _, count in starts], dtype=numpy.int64)
    keep = numpy.ones(len(flat), dtype=bool)
    keep[[start - 1 for start, _ in starts]] = False
    return flat[keep], numpy.concatenate([[0], numpy.cumsum(counts)]).astype(numpy.int64)


def selected(values, what):
    """Indices, or a mask that is true for them."""
    mask = numpy.asarray(values)
    if mask.dtype.kind == "b" and mask.ndim == 1:
        return numpy.flatnonzero(mask).astype(numpy.int64)
    return integers(values, what).reshape(-1)


def is_path(value):
    return isinstance(value, (str, os.PathLike))


def path_text(path):
    """A path as the library takes it: the bytes of the file system."""
    if not is_path(path) and not isinstance(path, bytes):
        raise TypeError(f"expected the path of a file, not {type(path).__name__}")
    encoded = os.fsencode(path)
    if b"\0" in encoded:
        raise ValueError("a path holds no zero byte")
    if not encoded:
        raise ValueError("the path of a file is empty")
    return encoded
