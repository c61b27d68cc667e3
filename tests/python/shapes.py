"""Shapes whose answers are known."""

import numpy

CUBE = numpy.array(
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], dtype=numpy.float64
)
CUBE_FACES = numpy.array([[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]])


def volumes(positions, tetrahedra):
    """Signed volumes."""
    a, b, c, d = (positions[tetrahedra[:, i]] for i in range(4))
    return numpy.einsum("ij,ij->i", numpy.cross(b - a, c - a), d - a) / 6.0


def icosphere(rounds):
    """A triangulated unit sphere, normals outwards."""
    golden = (1 + 5**0.5) / 2
    points = [[-1, golden, 0], [1, golden, 0], [-1, -golden, 0], [1, -golden, 0]]
    points += [[y, z, x] for x, y, z in points[:4]] + [[z, x, y] for x, y, z in points[:4]]
    points = numpy.array(points) / numpy.linalg.norm([1, golden])
    distance = numpy.linalg.norm(points[:, None] - points[None], axis=2)
    near = (distance > 0.1) & (distance < 1.1)
    triangles = numpy.array(
        [(i, j, k) for i in range(12) for j in range(i) for k in range(j) if near[i, j] and near[j, k] and near[i, k]]
    )
    for _ in range(rounds):
        sides = numpy.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        edges, number = numpy.unique(sides, axis=0, return_inverse=True)
        ab, bc, ca = (len(points) + number.reshape(-1, 3)).T
        a, b, c = triangles.T
        points = numpy.concatenate([points, points[edges].mean(axis=1)])
        triangles = numpy.concatenate([numpy.stack(t, 1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    points /= numpy.linalg.norm(points, axis=1)[:, None]
    a, b, c = (points[triangles[:, i]] for i in range(3))
    inwards = numpy.einsum("ij,ij->i", numpy.cross(b - a, c - a), a) < 0
    triangles[inwards] = triangles[inwards][:, ::-1]
    return points, triangles


def torus(around=24, across=12, large=1.0, small=0.4):
    """A triangulated torus, normals outwards."""
    u, v = numpy.meshgrid(numpy.arange(around), numpy.arange(across), indexing="ij")
    a, b = 2 * numpy.pi * u / around, 2 * numpy.pi * v / across
    ring = large + small * numpy.cos(b)
    points = numpy.stack([ring * numpy.cos(a), ring * numpy.sin(a), small * numpy.sin(b)], axis=2).reshape(-1, 3)
    index = lambda i, j: ((i % around) * across + j % across).reshape(-1)
    p, q, r, s = index(u, v), index(u + 1, v), index(u + 1, v + 1), index(u, v + 1)
    return points, numpy.concatenate([numpy.stack([p, q, r], 1), numpy.stack([p, r, s], 1)])
