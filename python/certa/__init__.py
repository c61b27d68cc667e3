"""Certa: surface discretization you can trust.

conform     conforming Delaunay tetrahedra of a surface mesh or a piecewise linear complex
curvature   curvatures and their directions at every vertex, or measures of one region
remesh      few polygons along lines of curvature
implicit    the zero set of a function, with certified topology
check       what the others promise, on any mesh
read, write files
view        a page that shows meshes, in a notebook too

Meshes are given as (positions, faces), as objects with `.vertices` and `.faces` or `.points` and `.faces`, as paths of
files, as certa.MeshDocument, or as results of these functions. Indices count from 0, lengths are in the input's unit or
texts such as "2%" (of the bounding box's diagonal). Wrong data raises certa.InputError; what cannot be done within
the limits shows in `outcome` of the result, with a warning. Ctrl-C stops any of them.
"""

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
from ._expressions import (
    Expression,
    TraceError,
    atan,
    cos,
    cosh,
    exp,
    log,
    pi,
    sin,
    sinh,
    smooth_difference,
    smooth_intersection,
    smooth_union,
    sqrt,
    tan,
    tanh,
    trace,
    variables,
)
from ._functions import check, conform, curvature, implicit, read, remesh, view, write
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
    VertexFlags,
    View,
)

__all__ = [name for name in dir() if not name.startswith("_")]

# Tracebacks and help speak of certa.InputError, where users find it.
for _name in __all__:
    if isinstance(globals()[_name], type) or callable(globals()[_name]):
        if getattr(globals()[_name], "__module__", "").startswith("certa._"):
            globals()[_name].__module__ = "certa"
del _name
