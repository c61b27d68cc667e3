"""What the functions return: numpy arrays with names, and where each element comes from."""

from dataclasses import dataclass, field
from typing import Any, Dict, List, Optional

import numpy

from ._document import MeshDocument
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
