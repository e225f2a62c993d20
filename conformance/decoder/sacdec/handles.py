# SPDX-License-Identifier: Apache-2.0
"""Handles, what follows them, and the functions of their blend: spec.md 6.4.4 and 6.4.5."""

import heapq
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

MOST_FOLLOWED = 8  # K, handles that a vertex follows

Neighbours = list[list[tuple[int, int]]]  # of each vertex: the other ends of its edges and their lengths


@dataclass(frozen=True)
class Blend:
    """The handles of one component, whose vertices count from `begin` on, and the functions of their blend.

    `handles` [H] are vertices within the component, `weights` [n_c, H] is w_i(v), `functions` [n_c, 4 H] is Psi,
    `leader_of` [H] is the leader (6.4.6) that each handle belongs to. If every vertex is a handle, weights and
    functions are the identity [n_c, n_c] and `leader_of` is None.
    """

    begin: int
    handles: np.ndarray
    weights: sp.csr_matrix
    functions: sp.csr_matrix
    leader_of: np.ndarray | None

    @property
    def end(self) -> int:
        """The first vertex behind the component."""
        return self.begin + self.functions.shape[0]

    def translations(self) -> np.ndarray:
        """The numbers [H] of the functions of the fourth kind."""
        if self.leader_of is None:
            return np.arange(len(self.handles))
        return 4 * np.arange(len(self.handles)) + 3

    def constant(self) -> np.ndarray:
        """The coefficients of the constant 1 (6.4.6)."""
        column = np.zeros(self.functions.shape[1])
        column[self.translations()] = 1
        return column

    def at_rest(self, reference: np.ndarray) -> np.ndarray:
        """The coefficients [.., 3] that give the positions [n_c, 3]: A_i = I and X_i = y_i (6.5.3)."""
        if self.leader_of is None:
            return reference.copy()
        z = np.empty((len(self.handles), 4, 3))
        z[:, :3] = np.eye(3)
        z[:, 3] = reference[self.handles]
        return z.reshape(-1, 3)

    def stiffness(self, laplacian: sp.csc_matrix) -> tuple[sp.csc_matrix, float]:
        """S of spec.md 6.4.5 and r, which is 0 if every vertex is a handle."""
        s = (self.functions.T @ laplacian @ self.functions).tocsc()
        if self.leader_of is None:
            return s, 0.0
        first_kinds = np.ones(s.shape[0], bool)
        first_kinds[self.translations()] = False
        mean = s.diagonal()[first_kinds].mean()
        r = float(mean / 1000) if mean != 0 else 1.0
        return (s + sp.diags(r * first_kinds)).tocsc(), r


def handle_count(vertices: int, harmonics: int, handles_per_harmonic: int, reference_shape: int) -> int | None:
    """spec.md 6.4.4: the handles of a component, None if every vertex is one."""
    s = handles_per_harmonic * harmonics
    if s == 0 or 4 * s >= vertices or reference_shape == 1:
        return None
    return s


def length_neighbours(ends: np.ndarray, grid: np.ndarray) -> Neighbours:
    """spec.md 6.4.4 step 1: the edges [e, 2] of a component with the grid positions [n_c, 3], with their lengths."""
    result: Neighbours = [[] for _ in range(len(grid))]
    squares = ((grid[ends[:, 0]] - grid[ends[:, 1]]) ** 2).sum(axis=1)
    for (a, b), square in zip(ends.tolist(), squares.tolist()):
        length = max(1, math.isqrt(4096 * square))
        result[a].append((b, length))
        result[b].append((a, length))
    return result


def nearest_sources(neighbours: Neighbours, sources: Sequence[int], most: int) -> list[list[tuple[int, int]]]:
    """Of each vertex the pairs (distance, number of the source) of the `most` nearest sources, in this order.

    A source that is among the nearest of a vertex is so of all vertices on a shortest path between them, ties included.
    """
    nearest: list[list[tuple[int, int]]] = [[] for _ in neighbours]
    waiting = [(0, number, vertex) for number, vertex in enumerate(sources)]
    heapq.heapify(waiting)
    while waiting:
        distance, number, vertex = heapq.heappop(waiting)
        known = nearest[vertex]
        if len(known) == most or any(other == number for _, other in known):
            continue
        known.append((distance, number))
        for other, length in neighbours[vertex]:
            heapq.heappush(waiting, (distance + length, number, other))
    return nearest


def farthest_vertices(neighbours: Neighbours, count: int) -> tuple[list[int], int]:
    """spec.md 6.4.4 step 2: the vertices of `count` handles, and c, how far a vertex is from its nearest at most."""
    handles: list[int] = []
    nearest = [2**64] * len(neighbours)
    while len(handles) < count:
        handle = nearest.index(max(nearest))  # the smallest number of several; vertex 0 at first
        handles.append(handle)
        waiting = [(0, handle)]
        while waiting:
            distance, vertex = heapq.heappop(waiting)
            if distance < nearest[vertex]:
                nearest[vertex] = distance
                for other, length in neighbours[vertex]:
                    heapq.heappush(waiting, (distance + length, other))
    return handles, max(nearest)


def followed_handles(nearest: Sequence[tuple[int, int]], covering: int) -> tuple[list[int], np.ndarray]:
    """spec.md 6.4.4 step 3: the handles that a vertex follows and their weights, from its nine nearest and c."""
    within = [(distance, handle) for distance, handle in nearest if distance <= 3 * covering]
    rho = 1 + (within[MOST_FOLLOWED][0] if len(within) > MOST_FOLLOWED else 3 * covering)
    followed = within[:MOST_FOLLOWED]
    weights = np.array([(1 - distance / rho) ** 3 for distance, _ in followed])
    return [handle for _, handle in followed], weights / weights.sum()


def blend_of_handles(
    begin: int, ends: np.ndarray, grid: np.ndarray, shape: np.ndarray, count: int, leaders: int
) -> Blend:
    """The blend of `count` handles of a component.

    `ends` [e, 2] are its edges, `grid` [n_c, 3] its grid positions, `shape` [n_c, 3] its positions in M'0; the first
    `leaders` handles lead (6.4.6).
    """
    neighbours = length_neighbours(ends, grid)
    handles, covering = farthest_vertices(neighbours, count)
    weights = sp.lil_matrix((len(grid), count))
    for vertex, nearest in enumerate(nearest_sources(neighbours, handles, MOST_FOLLOWED + 1)):
        followed, parts = followed_handles(nearest, covering)
        weights[vertex, followed] = parts
    weights = weights.tocsr()
    nearest_leaders = nearest_sources(neighbours, handles[:leaders], 1)
    leader_of = np.array([nearest_leaders[handle][0][1] for handle in handles])
    return Blend(begin, np.array(handles), weights, blend_functions(weights, shape, shape[handles]), leader_of)


def blend_functions(weights: sp.csr_matrix, shape: np.ndarray, of_handles: np.ndarray) -> sp.csr_matrix:
    """Psi [n_c, 4 H] of spec.md 6.4.5, for weights [n_c, H], positions [n_c, 3] and those of the handles [H, 3]."""
    each = weights.tocoo()
    from_handle = shape[each.row] - of_handles[each.col]
    values = each.data[:, None] * np.column_stack([from_handle, np.ones(each.nnz)])
    rows = np.repeat(each.row, 4)
    columns = (4 * each.col[:, None] + np.arange(4)).ravel()
    return sp.csr_matrix((values.ravel(), (rows, columns)), (weights.shape[0], 4 * weights.shape[1]))


def blend_of_all(begin: int, vertices: int) -> Blend:
    """The blend of a component or a patch of which every vertex is a handle."""
    identity = sp.identity(vertices, format="csr")
    return Blend(begin, np.arange(vertices), identity, identity, None)
