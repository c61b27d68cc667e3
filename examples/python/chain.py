"""From a formula to a page: a certified mesh, few polygons, conforming tetrahedra, all of it in one picture.

python3 chain.py [FOLDER] writes chain.html and tetrahedra.vtu there. Every step is verified by a checker that shares
no code with what made it; what a step proved stands in `proved`.
"""

import pathlib
import sys

import certa


def solid(x, y, z):
    """A torus of radii 1 and 0.4; negative inside. It is called once, with expressions for x, y and z."""
    ring = x**2 + y**2
    return (ring + z**2 + 0.84) ** 2 - 4 * ring


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")

    surface = certa.implicit(solid, error="1%")
    print(surface)
    print("  proved:", ", ".join(surface.proved))

    few = certa.remesh(surface, error="2%")
    print(few)
    print("  proved:", ", ".join(few.proved))

    # Quads are not planar: cut into triangles they are a complex that the tetrahedra honour exactly.
    tetrahedra = certa.conform(few, triangulate=True)
    print(tetrahedra)
    print("  proved:", ", ".join(tetrahedra.proved))

    curvatures = certa.curvature(surface)
    print(f"smallest and largest curvature: {curvatures.k_min.min():.3g}, {curvatures.k_max.max():.3g}")

    certa.write(folder / "tetrahedra.vtu", tetrahedra)
    page = certa.view(("certified surface", curvatures), ("few polygons", few), ("tetrahedra", tetrahedra))
    page.save(folder / "chain.html")
    print(f"look at {folder / 'chain.html'}")


if __name__ == "__main__":
    main()
