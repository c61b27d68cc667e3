"""What the functions return: numpy arrays with names, and where each element comes from."""

from __future__ import annotations

import enum
import html
import os
from dataclasses import dataclass, field
from typing import Any, Dict, List, NamedTuple, Optional, Tuple, Union

import numpy

from . import _certa, _inputs
from ._document import MeshDocument, split
from ._errors import Defect, Violation

Array = numpy.ndarray


def _counted(count, word):
    return f"{count:,} {word}" + ("" if count == 1 else "s")


@dataclass(eq=False, repr=False)
class ConformingCheck:
    """What the checker found out about a tetrahedral mesh and the complex that it is to conform to."""

    violations: List[Violation]  #: at most 100 of each promise
    violation_count: int
    max_deviation: float  #: largest distance of a vertex from its segment or facet
    full_hull: bool
    tetrahedra_checked: int
    segments_checked: int
    facets_checked: int
    promises: List[str] = field(default_factory=list)  #: what was checked, by name

    @property
    def ok(self) -> bool:
        """All promises hold."""
        return self.violation_count == 0

    def __repr__(self) -> str:
        what = "verified: " + ", ".join(self.promises) if self.ok else _counted(self.violation_count, "violation")
        return f"<certa.ConformingCheck: {what}>"


@dataclass(eq=False, repr=False)
class ConformResult:
    """A conforming Delaunay tetrahedral mesh, and where each of its elements comes from."""

    outcome: str  #: "done", or why not: "over_budget", "below_min_feature"
    positions: Array  #: (n, 3); the input's points first, unchanged and in order
    vertex_origins: Array  #: (n,); 0: input point, 1: added on a segment, 2: added in a facet
    vertex_source_indices: Array  #: (n,); of the point, segment or facet
    tetrahedra: Array  #: (t, 4), positively oriented
    tetrahedron_regions: Array  #: (t,); 0 is the outside
    triangles: Array  #: (f, 3), which the input's facets consist of
    triangle_facets: Array  #: (f,); facet of the input
    edges: Array  #: (e, 2), which the input's segments consist of
    edge_segments: Array  #: (e,); row of `segments`
    segments: Array  #: (s, 2); the given ones in order, then the remaining sides of facets
    region_attributes: Array  #: per region, from its seed
    facet_sources: Array  #: with `repair` or `triangulate`: facet of the input per facet of `input`
    warnings: List[Defect]
    repairs: List[Defect]
    obstacles: List[Defect]  #: unless done: what stopped the run, and where
    statistics: Dict[str, Any]
    check: Optional[ConformingCheck]  #: what the independent checker said; None without `verify`
    input: MeshDocument  #: what the mesh conforms to: the input, mended where that was asked for
    document: MeshDocument  #: the mesh as files have it

    @property
    def vertices(self) -> Array:
        """The same as positions."""
        return self.positions

    @property
    def proved(self) -> List[str]:
        """What the independent checker proved, by name."""
        return self.check.promises if self.check is not None and self.check.ok else []

    def __repr__(self) -> str:
        return (
            f"<certa.ConformResult ({self.outcome}): {len(self.positions):,} vertices, "
            f"{len(self.tetrahedra):,} tetrahedra, {len(self.triangles):,} constraint triangles>"
        )


VertexFlags = enum.IntFlag("VertexFlags", _certa.vertex_flags, module="certa")
VertexFlags.__doc__ = "What is special about a vertex: bits of CurvatureResult.flags."


@dataclass(eq=False)
class CurvatureMeasures:
    """Integrals over a part of a surface, not densities; `mean` is that of k1 + k2."""

    area: float
    gaussian: float
    mean: float
    tensor: Array  #: xx, xy, xz, yy, yz, zz
    swapped_tensor: Array
    edge_mass: float
    vertex_mass: float


@dataclass(eq=False, repr=False)
class CurvatureResult:
    """Curvatures at the vertices of a surface, a row per vertex of the input; what was not asked for is None."""

    outcome: str
    area: Array  #: of the region around each vertex
    mean: Array  #: density of k1 + k2: 2 on a unit sphere
    gaussian: Array  #: density of k1 k2
    k_min: Array
    k_max: Array
    dir_min: Array  #: (n, 3), unit, the direction of k_min
    dir_max: Array
    normal: Array  #: (n, 3), unit, outwards
    confidence: Array  #: of the directions, in [0, 1]
    flags: Array  #: bits, see VertexFlags
    radius: Optional[Array]  #: with ball="auto"
    mean_measure: Optional[Array]
    gaussian_measure: Optional[Array]
    edge_mass: Optional[Array]
    vertex_mass: Optional[Array]
    tensor: Optional[Array]  #: (n, 6) xx, xy, xz, yy, yz, zz; a measure
    swapped_tensor: Optional[Array]
    bounds: Dict[str, Array]  #: with bounds=True: the numbers of Theorem 13 by name
    triangles: Array  #: (t, 3), what was measured: the polygons cut, or the boundary of the tetrahedra
    source_faces: Array  #: (t,); the polygon, or the tetrahedron behind, each comes from
    total: CurvatureMeasures  #: of the whole surface
    euler_characteristic: int
    statistics: Dict[str, Any]
    document: MeshDocument  #: the input with the curvatures as fields

    def __repr__(self) -> str:
        return f"<certa.CurvatureResult: {len(self.area):,} vertices, {len(self.triangles):,} triangles>"


@dataclass(eq=False)
class RegionResult:
    """The measures of one region."""

    outcome: str
    measures: CurvatureMeasures
    bound: Optional[Dict[str, Any]]  #: with bounds=True: the numbers of Theorem 13
    statistics: Dict[str, Any]


@dataclass(eq=False, repr=False)
class SurfaceCheck:
    """What the checker found out about a surface mesh and the surface that it stands for."""

    violations: List[Violation]  #: at most 100 of each promise
    violation_count: int
    promises: List[str]  #: what was checked, by name
    distance: Dict[str, Any]  #: measured, and proved bounds, both ways
    mesh: Dict[str, Any]  #: counts, components, genus
    input: Dict[str, Any]
    creases: Dict[str, Any]
    folded_polygons: int
    contacts: int
    possible_contacts: int
    input_contacts: int

    @property
    def ok(self) -> bool:
        """All promises hold."""
        return self.violation_count == 0

    def __repr__(self) -> str:
        what = "verified: " + ", ".join(self.promises) if self.ok else _counted(self.violation_count, "violation")
        return f"<certa.SurfaceCheck: {what}>"


class CurvatureLine(NamedTuple):
    """A line of curvature on the input."""

    maximum: bool  #: runs along the direction of k_max
    closed: bool
    points: Array


class Umbilic(NamedTuple):
    """Where the directions are not defined; half_turns is the index times two."""

    place: Tuple[float, float, float]
    face: int  #: of the input
    half_turns: int


@dataclass(eq=False, repr=False)
class RemeshResult:
    """Polygons along lines of curvature."""

    outcome: str  #: "done", or why not; "unverified": the checker found violations, see `check`
    positions: Array
    corners: Array  #: polygon i has corners[polygon_offsets[i] : polygon_offsets[i + 1]]
    polygon_offsets: Array
    feature_edges: Array  #: (f, 2), sides that cover creases and boundary
    feature_curves: Array  #: (f,); number of the curve
    lines: List[CurvatureLine]  #: with lines=True
    umbilics: List[Umbilic]
    statistics: Dict[str, Any]
    check: Optional[SurfaceCheck]  #: what the independent checker said; None without `verify`
    input: MeshDocument  #: what was remeshed

    @property
    def vertices(self) -> Array:
        """The same as positions."""
        return self.positions

    @property
    def faces(self) -> Union[Array, List[Array]]:
        """The polygons: an (m, k) array if all have k corners, else a list of arrays."""
        return split(self.corners, self.polygon_offsets)

    @property
    def triangles(self) -> Array:
        """The polygons of three corners."""
        return self._with_corners(3)

    @property
    def quads(self) -> Array:
        """The polygons of four corners."""
        return self._with_corners(4)

    def _with_corners(self, count: int) -> Array:
        starts = self.polygon_offsets[:-1][numpy.diff(self.polygon_offsets) == count]
        return self.corners[starts[:, None] + numpy.arange(count)]

    @property
    def proved(self) -> List[str]:
        """What the independent checker proved, by name."""
        return self.check.promises if self.check is not None and self.check.ok else []

    @property
    def document(self) -> MeshDocument:
        """The mesh as files have it."""
        document = MeshDocument(self.positions)
        document._set_polygons(self.corners, self.polygon_offsets)
        return document

    def __repr__(self) -> str:
        return (
            f"<certa.RemeshResult ({self.outcome}): {len(self.positions):,} vertices, "
            f"{len(self.polygon_offsets) - 1:,} polygons, {len(self.quads):,} of them quads>"
        )


class Obstacle(NamedTuple):
    """A box where the proof got stuck, and why."""

    reason: str
    low: Tuple[float, float, float]
    high: Tuple[float, float, float]


class ImplicitComponent(NamedTuple):
    """A connected part of the surface."""

    genus: int
    inner_sign: int  #: of the function just inside; 0 unless isotopic
    degree: int
    parent: Optional[int]  #: the component next around it
    loops: int  #: boundary loops in the faces of a box that clips


@dataclass(eq=False, repr=False)
class ImplicitCheck:
    """What a certificate proves about a mesh, read by code that shares nothing with what wrote it."""

    violations: List[str]
    violation_count: int
    verdict: str
    isotopic: bool
    hausdorff: Optional[float]
    genera: List[int]
    loops: List[int]
    leaves_checked: int
    marks_checked: int
    triangles_checked: int

    @property
    def ok(self) -> bool:
        """The certificate proves what it claims."""
        return self.violation_count == 0

    @property
    def promises(self) -> List[str]:
        """What was checked, by name."""
        names = ["isotopic"] if self.isotopic else ["components", "genera"] + (["boundary_loops"] if self.loops else [])
        return names + (["hausdorff"] if self.hausdorff is not None else [])

    def __repr__(self) -> str:
        what = "verified: " + ", ".join(self.promises) if self.ok else _counted(self.violation_count, "violation")
        return f"<certa.ImplicitCheck: {what}>"


@dataclass(eq=False, repr=False)
class ImplicitMeshCheck:
    """What is proved about any triangle mesh and the zero set of a function."""

    verdict: str  #: "certified", "refuted" or "undecided"
    reasons: List[str]
    triangles: Array  #: named by the reasons
    triangle_count: int
    surface_known: bool
    mesh_genera: List[int]
    surface_genera: List[int]
    faces_positive: bool
    outcome: str
    obstacles: List[Obstacle]
    low: Tuple[float, float, float]
    high: Tuple[float, float, float]

    @property
    def ok(self) -> bool:
        """The mesh is isotopic to the zero set."""
        return self.verdict == "certified"

    def __repr__(self) -> str:
        return f"<certa.ImplicitMeshCheck: {self.verdict}{'; ' + self.reasons[0] if self.reasons else ''}>"


@dataclass(eq=False, repr=False)
class ImplicitResult:
    """The zero set of a function as a mesh of certified topology."""

    outcome: str
    verdict: str  #: "certified", "empty", or "undecided": nothing is claimed, `obstacles` say where and why
    isotopic: bool  #: proved: mesh and zero set can be moved into each other; else components and genera agree
    positions: Array
    triangles: Array  #: facing f > 0; empty unless certified, or a guess with uncertified=True
    triangle_components: Array
    components: List[ImplicitComponent]
    obstacles: List[Obstacle]  #: the first 1000
    obstacle_count: int
    hausdorff: Optional[float]  #: proved: within this length of each other, both ways
    low: Tuple[float, float, float]
    high: Tuple[float, float, float]
    statistics: Dict[str, Any]
    certificate: str  #: JSON, for `check`
    function: str  #: what was meshed the zero set of, as a text
    check: Optional[ImplicitCheck]  #: what the independent checker said

    @property
    def vertices(self) -> Array:
        """The same as positions."""
        return self.positions

    @property
    def faces(self) -> Array:
        """The same as triangles."""
        return self.triangles

    @property
    def proved(self) -> List[str]:
        """What the independent checker proved, by name."""
        return self.check.promises if self.check is not None and self.check.ok else []

    @property
    def document(self) -> MeshDocument:
        """The mesh as files have it, with the number of its component, from 1, for each triangle."""
        remark = ""
        if self.verdict == "undecided":
            remark = f"NOT CERTIFIED: a guess; {self.obstacles[0].reason if self.obstacles else self.outcome}"
        fields = {"polygons": {"component": self.triangle_components + 1}} if len(self.triangle_components) else None
        return MeshDocument(self.positions, self.triangles, fields=fields, remark=remark)

    def __repr__(self) -> str:
        genera = ", ".join(str(component.genus) for component in self.components[:20])
        what = f"; components of genus {genera}" if self.components else ""
        return f"<certa.ImplicitResult ({self.verdict}): {len(self.triangles):,} triangles{what}>"


class View:
    """A page that shows meshes: displays itself in notebooks; `html` is its text, `save` writes it to a file."""

    def __init__(self, html: str, height: int = 600) -> None:
        self.html = html
        self.height = height

    def save(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Write the page, whole or not at all; it needs neither a network nor other files."""
        _certa.write_text(_inputs.path_text(path), self.html)

    def _repr_html_(self) -> str:
        return (
            f'<iframe srcdoc="{html.escape(self.html)}" style="width: 100%; height: {self.height}px; border: 0" '
            'sandbox="allow-scripts allow-downloads" allowfullscreen></iframe>'
        )

    def __repr__(self) -> str:
        return f"<certa.View: {len(self.html):,} characters; save(path) writes it>"
