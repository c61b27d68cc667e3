"""Meshes as files say them: what `read` returns, what every function takes."""

from __future__ import annotations

from typing import Any, Dict, List, Optional, Union

import numpy
from numpy.typing import ArrayLike

from . import _inputs

_LOCATIONS = ("vertices", "polygons", "segments", "tetrahedra")
_FLAT = (
    "corners",
    "polygon_offsets",
    "facet_offsets",
    "hole_offsets",
    "point_markers",
    "segment_markers",
    "facet_markers",
)


class MeshDocument:
    """Points, polygons, segments and tetrahedra with markers and fields: everything that a mesh file can say.

    Parameters
    ----------
    positions : (n, 3) numbers
    faces : rows of indices, one row a polygon, of equal lengths or not
    segments : (m, 2) indices of segments on their own
    tetrahedra : (t, 4) indices
    facets : in place of `faces`, planar facets of several rings: each a list of rows of indices (three or more: a
        ring, two: an isolated segment, one: an isolated point), or a dictionary with such "polygons" and with "holes",
        points in the plane around which the facet is left out
    point_markers, segment_markers, facet_markers : one integer each
    region_holes : (k, 3) points; the region around each is left out
    region_seeds : rows x, y, z, attribute, max_volume; the last two may be missing
    fields : {"vertices": {name: array}, "polygons": ..., "segments": ..., "tetrahedra": ...}, a row per element

    All of these are attributes, as numpy arrays. Polygons are kept flat: polygon i has the corners
    corners[polygon_offsets[i] : polygon_offsets[i + 1]], facet j the polygons from facet_offsets[j] on. Indices count
    from 0 and are not allowed to be negative.
    """

    positions: numpy.ndarray
    corners: numpy.ndarray
    polygon_offsets: numpy.ndarray
    facet_offsets: numpy.ndarray
    facet_holes: numpy.ndarray
    hole_offsets: numpy.ndarray
    segments: numpy.ndarray
    tetrahedra: numpy.ndarray
    point_markers: numpy.ndarray
    segment_markers: numpy.ndarray
    facet_markers: numpy.ndarray
    region_holes: numpy.ndarray
    region_seeds: numpy.ndarray
    fields: Dict[str, Dict[str, numpy.ndarray]]
    reference: Optional[str]
    remark: str
    notes: List[str]

    def __init__(
        self,
        positions: ArrayLike = (),
        faces: Any = None,
        *,
        segments: Optional[ArrayLike] = None,
        tetrahedra: Optional[ArrayLike] = None,
        facets: Any = None,
        point_markers: Optional[ArrayLike] = None,
        segment_markers: Optional[ArrayLike] = None,
        facet_markers: Optional[ArrayLike] = None,
        region_holes: Optional[ArrayLike] = None,
        region_seeds: Optional[ArrayLike] = None,
        fields: Optional[Dict[str, Dict[str, ArrayLike]]] = None,
        remark: str = "",
    ) -> None:
        self.positions = _inputs.doubles(positions, 3, "positions")
        self.facet_holes = numpy.zeros((0, 3))
        if facets is not None:
            if faces is not None:
                raise TypeError("faces and facets: give one of them")
            self._set_facets(facets)
        else:
            self._set_polygons(*_inputs.polygons(() if faces is None else faces))
        self.segments = _inputs.elements(() if segments is None else segments, 2, "segments")
        self.tetrahedra = _inputs.elements(() if tetrahedra is None else tetrahedra, 4, "tetrahedra")
        self.point_markers = _flat(point_markers, "point_markers")
        self.segment_markers = _flat(segment_markers, "segment_markers")
        self.facet_markers = _flat(facet_markers, "facet_markers")
        self.region_holes = _inputs.doubles(() if region_holes is None else region_holes, 3, "region_holes")
        self.region_seeds = _seeds(region_seeds)
        self.fields = _fields(fields)
        self.reference = None
        self.remark = str(remark)
        self.notes = []

    def _set_polygons(self, corners, offsets):
        self.corners, self.polygon_offsets = corners, offsets
        self.facet_offsets = numpy.arange(len(offsets), dtype=numpy.int64)
        self.hole_offsets = numpy.zeros(len(offsets), dtype=numpy.int64)

    def _set_facets(self, facets):
        polygons, counts, holes, hole_counts = [], [0], [], [0]
        for i, facet in enumerate(facets):
            name = f"facets[{i}]"
            rings = facet["polygons"] if isinstance(facet, dict) else facet
            corners, offsets = _inputs.polygons(rings, name)
            polygons += [corners[a:b] for a, b in zip(offsets[:-1], offsets[1:])]
            counts.append(counts[-1] + len(offsets) - 1)
            around = _inputs.doubles(facet.get("holes", ()) if isinstance(facet, dict) else (), 3, f"{name}['holes']")
            holes.append(around)
            hole_counts.append(hole_counts[-1] + len(around))
        self.corners = numpy.concatenate(polygons) if polygons else numpy.zeros(0, dtype=numpy.int64)
        lengths = [len(polygon) for polygon in polygons]
        self.polygon_offsets = numpy.concatenate([[0], numpy.cumsum(lengths)]).astype(numpy.int64)
        self.facet_offsets = numpy.array(counts, dtype=numpy.int64)
        self.hole_offsets = numpy.array(hole_counts, dtype=numpy.int64)
        self.facet_holes = numpy.concatenate(holes) if holes else numpy.zeros((0, 3))

    def _checked(self):
        """The same with every attribute as the library takes it, whatever users have set them to."""
        flat = {name: _flat(getattr(self, name), name) for name in _FLAT}
        return self._from_library(
            {
                **flat,
                "positions": _inputs.doubles(self.positions, 3, "positions"),
                "segments": _inputs.elements(self.segments, 2, "segments"),
                "tetrahedra": _inputs.elements(self.tetrahedra, 4, "tetrahedra"),
                "facet_holes": _inputs.doubles(self.facet_holes, 3, "facet_holes"),
                "region_holes": _inputs.doubles(self.region_holes, 3, "region_holes"),
                "region_seeds": _seeds(self.region_seeds),
                "fields": _fields(self.fields),
                "reference": self.reference,
                "remark": str(self.remark),
            }
        )

    @classmethod
    def _from_library(cls, values):
        document = cls.__new__(cls)
        document.__dict__.update(values)
        return document

    @property
    def faces(self) -> Union[numpy.ndarray, List[numpy.ndarray]]:
        """The polygons: an (m, k) array if all have k corners, else a list of arrays."""
        return split(self.corners, self.polygon_offsets)

    @property
    def vertices(self) -> numpy.ndarray:
        """The same as positions."""
        return self.positions

    def __repr__(self):
        counts = [f"{len(self.positions)} points"]
        if len(self.polygon_offsets) > 1:
            counts.append(f"{len(self.polygon_offsets) - 1} polygons")
        if len(self.segments):
            counts.append(f"{len(self.segments)} segments")
        if len(self.tetrahedra):
            counts.append(f"{len(self.tetrahedra)} tetrahedra")
        names = [name for fields in self.fields.values() for name in fields]
        return f"<certa.MeshDocument: {', '.join(counts)}{'; fields ' + ', '.join(names) if names else ''}>"


def split(corners, offsets):
    """Polygons as an array where all have the same number of corners, else as a list of arrays."""
    lengths = numpy.diff(offsets)
    if len(lengths) == 0:
        return numpy.zeros((0, 3), dtype=numpy.int64)
    if (lengths == lengths[0]).all():
        return corners.reshape(-1, lengths[0])
    return numpy.split(corners, offsets[1:-1])


def _flat(values, what):
    array = _inputs.integers(() if values is None else values, what)
    if array.ndim != 1:
        raise ValueError(f"{what}: expected a flat array, not shape {array.shape}")
    return array


def _seeds(rows):
    array = numpy.asarray(() if rows is None else rows)
    if array.ndim == 2 and array.shape[1] in (3, 4):
        array = numpy.hstack([array, numpy.zeros((len(array), 5 - array.shape[1]))])
    return _inputs.doubles(array, 5, "region_seeds")


def _fields(places):
    result = {location: {} for location in _LOCATIONS}
    for location, fields in (places or {}).items():
        if location not in result:
            raise ValueError(f"fields: '{location}' is none of {', '.join(_LOCATIONS)}")
        for name, values in fields.items():
            if not isinstance(name, str) or not name:
                raise ValueError(f"fields: {name!r} is no name")
            array = numpy.asarray(list(values) if isinstance(values, range) else values)
            if array.dtype.kind == "b":
                array = array.astype(numpy.int64)
            if array.dtype.kind not in "iuf" or array.ndim not in (1, 2):
                raise ValueError(f"field '{name}': expected one row of numbers per element")
            result[location][name] = (
                _inputs.integers(array, name) if array.dtype.kind in "iu" else numpy.ascontiguousarray(array, numpy.float64)
            )
    return result
