# SPDX-License-Identifier: Apache-2.0
"""Copies of vertices: spec.md 5.6."""

from collections.abc import Sequence

import numpy as np

from .draco_mesh import DracoMesh
from .errors import require
from .mixing import Table
from .range_coder import BitModel, RangeDecoder, UnsignedModels

Triangle = Sequence[int]


def corner_kinds(draco: DracoMesh, triangles: np.ndarray) -> list[list[object]]:
    """The kind of each corner of `triangles` [m, 3], of which the first are Draco's. Kinds compare equal if they are."""
    attributes = [a for a in (draco.uv_triangles, draco.normal_indices, draco.color_indices) if a is not None]
    count = len(draco.triangles)
    kinds: list[list[object]] = [[tuple(int(a[j, k]) for a in attributes) for k in range(3)] for j in range(count)]
    first: dict[int, object] = {}
    for triangle, own in zip(triangles[:count].tolist(), kinds):
        for vertex, kind in zip(triangle, own):
            first.setdefault(vertex, kind)
    kinds += [[first.get(vertex) for vertex in triangle] for triangle in triangles[count:].tolist()]
    return kinds


class CopyDecoder:
    """Everything that 5.6 remembers and learns."""

    def __init__(self, decoder: RangeDecoder, triangles: list[list[int]], kinds: list[list[object]]) -> None:
        self.decoder = decoder
        self.triangles = triangles
        self.kinds = kinds
        self.copies: list[list[int]] = []  # of each triangle's corners
        self.count: dict[int, int] = {}  # copies of each vertex so far
        self.last: dict[int, int] = {}  # that of the last corner of each vertex
        self.last_of_kind: dict[tuple[int, object], int] = {}  # and kind
        self.kind: dict[tuple[int, int], object] = {}  # of each copy of each vertex
        self.edge: dict[tuple[int, int], int] = {}  # of vertices v and w, the copy of v at the last edge of both
        self.first = Table(lambda key: BitModel())
        self.second = Table(lambda key: BitModel())
        self.new = BitModel()
        self.which = UnsignedModels()

    def decode(self) -> list[list[int]]:
        """The copies of all corners."""
        for j, triangle in enumerate(self.triangles):
            own: list[int] = []
            self.copies.append(own)
            for k, vertex in enumerate(triangle):
                kind = self.kinds[j][k]
                copy = self._corner(triangle, k, kind, own) if vertex in self.count else 0
                self.count[vertex] = max(self.count.get(vertex, 0), copy + 1)
                self.last[vertex] = self.last_of_kind[vertex, kind] = copy
                self.kind[vertex, copy] = kind
                own.append(copy)
            for a, b in ((0, 1), (1, 2), (2, 0)):
                if triangle[a] != triangle[b]:
                    self.edge[triangle[a], triangle[b]] = own[a]
                    self.edge[triangle[b], triangle[a]] = own[b]
        return self.copies

    def _candidates(
        self, triangle: list[int], k: int, kind: object, own: list[int]
    ) -> tuple[list[tuple[int, int]], int]:
        """Pairs (level, copy) in their order, none twice, and e. `own` are the copies of the corners before."""
        vertex = triangle[k]
        found = []
        for other in ((k + 1) % 3, (k + 2) % 3):
            w = triangle[other]
            if w != vertex and (vertex, w) in self.edge:
                level = 3 if other >= len(own) else 4 if own[other] == self.edge[w, vertex] else 1
                found.append((level, self.edge[vertex, w]))
        across = len(found)
        if (vertex, kind) in self.last_of_kind:
            found.append((2, self.last_of_kind[vertex, kind]))
        found.append((2, self.last[vertex]))
        levelled = [(level if self.kind[vertex, copy] == kind else 0, copy) for level, copy in found]
        levelled.sort(key=lambda candidate: -candidate[0])
        return [c for i, c in enumerate(levelled) if c[1] not in [d[1] for d in levelled[:i]]], across

    def _corner(self, triangle: list[int], k: int, kind: object, own: list[int]) -> int:
        candidates, across = self._candidates(triangle, k, kind, own)
        n = self.count[triangle[k]]
        split = sum(self.count.get(triangle[other], 0) > 1 for other in ((k + 1) % 3, (k + 2) % 3))
        (l0, c0), (l1, c1) = (candidates + [(5, -1)])[:2]
        if self.first[l0, l1, min(n, 2), split, across].decode(self.decoder):
            return c0
        if c1 >= 0 and self.second[l1].decode(self.decoder):
            return c1
        others = [copy for copy in reversed(range(n)) if copy not in (c0, c1)]
        if not others or self.new.decode(self.decoder):
            return n
        index = self.which.decode(self.decoder) if len(others) > 1 else 0
        require(index < len(others), 75, "a copy that there is not")
        return others[index]


def decode_copies(
    decoder: RangeDecoder, draco: DracoMesh, triangles: np.ndarray, vertices: int, copies: int
) -> tuple[np.ndarray, np.ndarray]:
    """The copy of each corner [m, 3], and how many copies each vertex has [vertices]. `triangles` are all, by the
    numbers of 5.3 step 1; `copies` is that of the sequence header."""
    coding = CopyDecoder(decoder, triangles.tolist(), corner_kinds(draco, triangles))
    of_corners = np.array(coding.decode(), np.int64).reshape(-1, 3)
    counts = np.array([max(coding.count.get(v, 0), 1) for v in range(vertices)], np.int64)
    require(int(counts.sum()) == vertices + copies, 75, f"{counts.sum()} copies")
    return of_corners, counts
