"""Meshes of tetrahedra with ten nodes, for tests."""

from itertools import permutations, product

import meshio
import numpy as np

from quintet.components.fe_plate.meshes.tetrahedra import EDGES, raised

# Corners of a regular tetrahedron.
REGULAR = np.array([(1.0, 1.0, 1.0), (-1.0, 1.0, -1.0), (1.0, -1.0, -1.0), (-1.0, -1.0, 1.0)])


def box(counts, size=(1.0, 1.0, 1.0), shaken=0.0, seed=1):
    """Nodes (n, 3) and tetrahedra (e, 10) of a box: six in each brick, inner nodes shaken."""
    grid = np.stack(np.meshgrid(*[np.arange(n + 1) for n in counts], indexing="ij"), axis=-1)
    number = np.arange(grid[..., 0].size).reshape(grid.shape[:3])
    corner = []
    for cell, axes in product(product(*map(range, counts)), permutations(range(3))):
        path = [np.array(cell)]
        for axis in axes:
            path.append(path[-1] + np.eye(3, dtype=int)[axis])
        if np.linalg.det(np.array(path[1:]) - path[0]) < 0.0:
            path[1], path[2] = path[2], path[1]
        corner.append([number[tuple(place)] for place in path])
    node = grid.reshape(-1, 3).astype(float)
    inner = ((node > 0) & (node < counts)).all(axis=1)
    node[inner] += shaken * np.random.default_rng(seed).uniform(-1.0, 1.0, (inner.sum(), 3))
    points, nodes, _ = raised(node * np.array(size) / counts, np.array(corner))
    return points, nodes


def curved(node, corner, amount, seed=2):
    """Move midside nodes of inner edges by an amount [m]: curved elements within a box."""
    node = node.copy()
    low, high = node.min(axis=0), node.max(axis=0)
    middles = np.unique(corner[:, 4:])
    inner = middles[((node[middles] > low + 1e-9) & (node[middles] < high - 1e-9)).all(axis=1)]
    node[inner] += amount * np.random.default_rng(seed).uniform(-1.0, 1.0, (len(inner), 3))
    return node


def regular(edge=1.0):
    """Nodes and element of one regular tetrahedron."""
    corners = REGULAR * edge / np.sqrt(8.0)
    if np.linalg.det(corners[1:] - corners[0]) < 0.0:
        corners[[1, 2]] = corners[[2, 1]]
    return np.concatenate([corners, corners[EDGES].mean(axis=1)]), np.arange(10)[None]


def write_mesh(path, node, corner, kind="tetra10", **keys):
    """Write a mesh; return the path of its file."""
    meshio.Mesh(node, [(kind, corner)], **keys).write(path)
    return str(path)
