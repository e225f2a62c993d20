# SPDX-License-Identifier: Apache-2.0
"""Edges, weights and masses of a shape: spec.md 6.4.1 and 6.4.2."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp


@dataclass(frozen=True)
class Edges:
    """The edges of a mesh, `ends` [e, 2] with the smaller vertex first, and the corners that face them.

    Corner i of all is vertex `corners[i]` and faces edge `faced[i]` in triangle `triangle_of[i]`.
    """

    ends: np.ndarray
    corners: np.ndarray
    faced: np.ndarray
    triangle_of: np.ndarray


def mesh_edges(triangles: np.ndarray) -> Edges:
    """spec.md 6.4.1: unordered pairs of different vertices of a triangle, each once, and the corners that face them."""
    if len(triangles) == 0:
        none = np.zeros(0, np.int64)
        return Edges(np.zeros((0, 2), np.int64), none, none, none)
    opposite = np.concatenate([triangles[:, [1, 2]], triangles[:, [2, 0]], triangles[:, [0, 1]]])
    corners = np.concatenate([triangles[:, 0], triangles[:, 1], triangles[:, 2]])
    triangle_of = np.tile(np.arange(len(triangles)), 3)
    facing = opposite[:, 0] != opposite[:, 1]
    ends, faced = np.unique(np.sort(opposite[facing], axis=1), axis=0, return_inverse=True)
    return Edges(ends, corners[facing], faced.ravel(), triangle_of[facing])


def edge_weights(edges: Edges, triangles: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """spec.md 6.4.1, "Weight", of every edge on the shape with these positions [n, 3]."""
    p = positions[triangles]
    sides = p - np.roll(p, 1, axis=1)
    longest = (sides**2).sum(axis=2).max(axis=1, initial=0)[edges.triangle_of]
    at_corner = positions[edges.corners]
    to_a = positions[edges.ends[edges.faced, 0]] - at_corner
    to_b = positions[edges.ends[edges.faced, 1]] - at_corner
    dot = (to_a * to_b).sum(axis=1)
    area2 = np.linalg.norm(np.cross(to_a, to_b), axis=1)
    real = longest > 0
    denominator = np.where(real, np.maximum(area2, 1e-6 * longest), 1)
    part = np.where(real, np.clip(dot / denominator, -5, 5) / 2, 0)
    weights = np.bincount(edges.faced, part, minlength=len(edges.ends))
    return np.maximum(weights, 0.001)


def vertex_masses(triangles: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """spec.md 6.4.1, "Mass", of every vertex on M'0; they sum to 1."""
    p = positions[triangles]
    areas = np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1) / 2
    masses = np.zeros(len(positions))
    for corner in range(3):
        np.add.at(masses, triangles[:, corner], areas / 3)
    mean = masses.mean()
    masses = np.maximum(masses, 0.001 * mean) if mean > 0 else np.ones(len(positions))
    return masses / masses.sum()


def inhomogeneity(x: np.ndarray, y: np.ndarray, z: np.ndarray) -> np.ndarray:
    """The polynomial q of spec.md 6.4.2."""
    linear = 0.31 * x - 0.23 * y + 0.17 * z
    quadratic = 0.19 * x * y - 0.29 * y * z + 0.13 * z * x + 0.21 * x * x - 0.15 * z * z
    cubic = 0.11 * x * x * y - 0.07 * y * y * z + 0.05 * z * z * x + 0.09 * y * y * y
    return linear + quadratic + cubic


def unevenness(ends: np.ndarray, grid: np.ndarray) -> np.ndarray:
    """1 + 0.1 q of spec.md 6.4.2 of edges [e, 2] within a component or patch that has the grid positions [n_c, 3]."""
    low = grid.min(axis=0)
    extent = max(int((grid.max(axis=0) - low).max()), 1)
    x, y, z = (((grid[ends[:, 0]] + grid[ends[:, 1]]) / 2 - low) / extent).T
    return 1 + 0.1 * inhomogeneity(x, y, z)


def uneven_edges(
    edges: Edges, weights: np.ndarray, grid: np.ndarray, begin: int, end: int
) -> tuple[np.ndarray, np.ndarray]:
    """The edges within a component or patch, the vertices from `begin` to `end` - 1, and their uneven weights (6.4.2).

    The ends [e, 2] count from `begin`. `weights` are those of all `edges`, `grid` [n, 3] is of all vertices.
    """
    inside = np.all((edges.ends >= begin) & (edges.ends < end), axis=1)
    ends = edges.ends[inside] - begin
    return ends, weights[inside] * unevenness(ends, grid[begin:end])


def laplacian(vertices: int, ends: np.ndarray, weights: np.ndarray) -> sp.csc_matrix:
    """spec.md 6.4.2: minus the weight at the two places of each edge, rows that sum to 0."""
    a, b = ends[:, 0], ends[:, 1]
    off = sp.coo_matrix(
        (np.concatenate([weights, weights]), (np.concatenate([a, b]), np.concatenate([b, a]))), (vertices, vertices)
    ).tocsc()
    return (sp.diags(np.asarray(off.sum(axis=1)).ravel()) - off).tocsc()
