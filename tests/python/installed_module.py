"""Works with the package that is installed in the folder given, and only with that."""

import pathlib
import sys

import certa

folder = pathlib.Path(sys.argv[1]) / "certa"
assert pathlib.Path(certa.__file__).parent == folder, certa.__file__
assert {"py.typed", "__init__.pyi"} <= {path.name for path in folder.iterdir()}
positions = [[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)]
faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
result = certa.conform(positions, faces)
assert "<html" in certa.view(result).html
print(f"{len(result.tetrahedra)} tetrahedra, proved: {', '.join(result.proved)}")
