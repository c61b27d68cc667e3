"""An independent reader and writer (meshio) agrees with ours, both ways, for VTU, .msh and Medit.

meshio writes a mesh; `certa convert` turns it into every volume format; meshio reads that: coordinates and
connectivity must be the same to the bit. Prints "certa-test-skipped" and succeeds where meshio is not installed.
"""
import itertools
import os
import subprocess
import sys
import tempfile

try:
    import meshio
    import numpy
except ImportError:
    print("certa-test-skipped: python3-meshio is not installed")
    sys.exit(0)

CERTA = sys.argv[1]
failures = []


def make_mesh():
    """A grid of tetrahedra with its boundary-like triangles and some lines; all coordinates are long doubles to print."""
    n = 4
    random = numpy.random.default_rng(7)
    points = random.random((n**3, 3)) * numpy.array([1.0, 1e-300, 1e300])
    points[0] = [0.1, -0.0, 5e-324]
    corner = lambda i, j, k: (i * n + j) * n + k
    tetrahedra, triangles, lines = [], [], []
    for i, j, k in itertools.product(range(n - 1), repeat=3):
        c = [corner(i + a, j + b, k + d) for a, b, d in itertools.product((0, 1), repeat=3)]
        for a, b, d, e in ((0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7)):
            tetrahedra.append([c[a], c[b], c[d], c[e]])
        triangles.append([c[0], c[1], c[3]])
        lines.append([c[0], c[7]])
    cells = [("line", numpy.array(lines)), ("triangle", numpy.array(triangles)), ("tetra", numpy.array(tetrahedra))]
    numbers = [numpy.arange(1, len(block) + 1) for _, block in cells]
    return points, cells, numbers


def blocks_of(mesh, kind):
    found = [block.data for block in mesh.cells if block.type == kind]
    return numpy.vstack(found) if found else numpy.zeros((0, 0), dtype=int)


def cell_data(mesh, name, kind):
    return numpy.concatenate([data for block, data in zip(mesh.cells, mesh.cell_data[name]) if block.type == kind])


def compare(path, points, cells, numbers, name):
    mesh = meshio.read(path)
    if name not in mesh.cell_data:
        name = "gmsh:physical"
    if mesh.points.dtype != numpy.float64 or mesh.points.tobytes() != points.tobytes():
        failures.append(f"{path}: points differ")
    for (kind, block), own in zip(cells, numbers):
        if not numpy.array_equal(blocks_of(mesh, kind), block):
            failures.append(f"{path}: cells of type {kind} differ")
        elif name not in mesh.cell_data:
            failures.append(f"{path}: no cell data {name}, only {list(mesh.cell_data)}")
        elif not numpy.array_equal(cell_data(mesh, name, kind).ravel(), own):
            failures.append(f"{path}: {name} of type {kind} differs")


def convert(source, target, *options):
    done = subprocess.run([CERTA, "convert", source, target, *options], capture_output=True, text=True)
    if done.returncode != 0:
        failures.append(f"convert {source} {target} {options}: {done.returncode}: {done.stderr.strip()}")
    return done.returncode == 0


def main():
    points, cells, numbers = make_mesh()
    marked = meshio.Mesh(points, cells, cell_data={"marker": numbers})
    gmsh_tags = {"gmsh:physical": numbers, "gmsh:geometrical": numbers}
    tagged = meshio.Mesh(points, cells, cell_data=gmsh_tags)
    sources = [
        ("medit.mesh", lambda p: meshio.write(p, meshio.Mesh(points, cells, cell_data={"medit:ref": numbers}), file_format="medit")),
        ("plain.vtu", lambda p: meshio.write(p, marked, file_format="vtu", binary=False)),
        ("base64.vtu", lambda p: meshio.write(p, marked, file_format="vtu", binary=True, compression=None)),
        ("zlib.vtu", lambda p: meshio.write(p, marked, file_format="vtu", binary=True, compression="zlib")),
        ("text22.msh", lambda p: meshio.write(p, tagged, file_format="gmsh22", binary=False)),
        ("binary22.msh", lambda p: meshio.write(p, tagged, file_format="gmsh22", binary=True)),
    ]
    targets = [
        ("out.mesh", (), "medit:ref"),
        ("out.vtu", (), "marker"),
        ("out_text.vtu", ("--encoding", "ascii"), "marker"),
        ("out41.msh", (), "marker"),
        ("out41_binary.msh", ("--encoding", "binary"), "marker"),
        ("out22.msh", ("--msh-version", "2.2",), "gmsh:physical"),
        ("out22_binary.msh", ("--msh-version", "2.2", "--encoding", "binary"), "gmsh:physical"),
    ]
    with tempfile.TemporaryDirectory() as folder:
        for source_name, write in sources:
            source = os.path.join(folder, source_name)
            write(source)
            points = meshio.read(source).points  # its text VTU keeps twelve digits
            for target_name, options, name in targets:
                target = os.path.join(folder, source_name.replace(".", "_") + "_" + target_name)
                if convert(source, target, *options):
                    compare(target, points, cells, numbers, name)
    print("\n".join(failures) if failures else f"{len(sources) * len(targets)} conversions agree with meshio {meshio.__version__}")
    return 1 if failures else 0


sys.exit(main())
