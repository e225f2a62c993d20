# SPDX-License-Identifier: Apache-2.0
"""What is known around a vertex, and where it would bend the surface least: spec.md 5.5.3 and 5.5.4."""

from dataclasses import dataclass, field
from math import isqrt
from operator import mul

from .position_graph import PositionGraph

Vector = list[int]  # of the three axes, in 1/16 of a grid cell


def tdiv(a: int, b: int) -> int:
    """tdiv of spec.md 2.1 for b above 0."""
    return a // b if a >= 0 else -(-a // b)


def clamp(x: int, low: int, high: int) -> int:
    return min(max(x, low), high)


def floor_mean(vectors: list[Vector]) -> Vector:
    return [sum(axis) // len(vectors) for axis in zip(*vectors)]


def distance(a: Vector, b: Vector) -> int:
    return isqrt(sum((p - q) ** 2 for p, q in zip(a, b)))


@dataclass
class Known:
    """spec.md 5.5.3, by the names there; `count` is the number of K."""

    count: int
    mean: Vector
    wide_mean: Vector
    parallelogram: Vector
    relaxed: Vector
    length: int
    near_miss: int = 0
    far_miss: int = 0
    disagreement: int = 0
    support: int = 0
    normal: Vector = field(default_factory=lambda: [0, 0, 0])


class Surroundings:
    """The vertices coded so far: X (None of those that are not known), miss, and the last `length`."""

    def __init__(self, graph: PositionGraph, position_bits: int) -> None:
        self.graph = graph
        self.x: list[Vector | None] = [None] * len(graph.neighbours)
        self.miss = [0] * len(graph.neighbours)
        self.length = 0
        self.last: Vector = [2 ** (position_bits - 1) * 16] * 3

    def around(self, v: int) -> Known:
        """spec.md 5.5.3 and 5.5.4 for the vertex v."""
        x = self.x
        known = [b for b in self.graph.neighbours[v] if x[b] is not None]
        if not known:
            last = self.last
            return Known(0, last, last, last, last, self.length)
        pairs = [(b, w) for b in known for w in self.graph.neighbours[b] if x[w] is not None]
        mean = floor_mean([x[b] for b in known])
        near_miss = sum(self.miss[b] for b in known) // len(known)
        wide_mean, far_miss = mean, 0
        if pairs:
            wide_mean = floor_mean([x[w] for _, w in pairs])
            far_miss = sum(self.miss[w] for _, w in pairs) // len(pairs)
            self.length = sum(distance(x[b], x[w]) for b, w in pairs) // len(pairs)
        result = Known(len(known), mean, wide_mean, mean, mean, self.length, near_miss, far_miss)
        self._add_parallelograms(v, known, result)
        result.relaxed = self._relaxed(v, result.parallelogram)
        return result

    def _parallelograms(self, v: int, known: list[int]) -> list[tuple[int, int, int]]:
        """The first 16 triples (a, b, c) of 5.5.3."""
        across = self.graph.across
        triples = []
        for a in known:
            for b in known:
                if a < b and v in across.get((a, b), ()):
                    triples += [(a, b, c) for c in across[a, b] if self.x[c] is not None]
        return triples[:16]

    def _add_parallelograms(self, v: int, known: list[int], result: Known) -> None:
        """`parallelogram`, `disagreement`, `support` and `normal` of 5.5.3."""
        triples = self._parallelograms(v, known)
        if not triples:
            return
        x = self.x
        points = []
        normal = [0, 0, 0]
        for a, b, c in triples:
            points.append([p + q - r for p, q, r in zip(x[a], x[b], x[c])])
            n = _normal([(p - r) // 16 for p, r in zip(x[a], x[c])], [(q - r) // 16 for q, r in zip(x[b], x[c])])
            sign = -1 if sum(map(mul, n, normal)) < 0 else 1
            normal = [p + sign * q for p, q in zip(normal, n)]
        result.support = min(len(points), 4)
        result.parallelogram = floor_mean(points)
        differences = sum(abs(p - q) for point in points for p, q in zip(point, result.parallelogram))
        result.disagreement = differences // (3 * len(points))
        size = isqrt(sum(map(mul, normal, normal)))
        result.normal = [tdiv(n * 1024, size) for n in normal] if size else normal

    def _relaxed(self, v: int, parallelogram: Vector) -> Vector:
        """`relaxed` of 5.5.4.

        The numerator there is a sum of Y with weights that stay through the 8 rounds, so they are collected first.
        """
        graph, x = self.graph.neighbours, self.x
        moving = [v]
        begin = 0
        for _ in range(2):
            end = len(moving)
            for u in moving[begin:end]:
                for c in graph[u]:
                    if x[c] is None and c not in moving and len(moving) < 24:
                        moving.append(c)
            begin = end

        y: dict[int, Vector] = {v: list(parallelogram)}
        for u in moving[1:]:
            around = [x[c] for c in graph[u] if x[c] is not None]
            m = floor_mean(around) if around else parallelogram
            y[u] = [(p + q) // 2 for p, q in zip(parallelogram, m)]

        rows = []
        for u in moving:
            weights, denominator = self._row(u, set(moving))
            for c in weights:
                if c not in y:
                    y[c] = x[c]
            rows.append((u, list(weights), list(weights.values()), denominator))
        for _ in range(8):
            for u, others, weights, denominator in rows:
                for axis in range(3):
                    numerator = sum(map(mul, weights, [y[c][axis] for c in others]))
                    y[u][axis] = clamp(numerator // denominator, -(2**30), 2**30)
        return y[v]

    def _row(self, u: int, moving: set[int]) -> tuple[dict[int, int], int]:
        """The weights of the Y in the numerator of 5.5.4 for u, and the denominator."""
        graph, x = self.graph.neighbours, self.x

        def given(c: int) -> bool:
            return x[c] is not None or c in moving

        weights: dict[int, int] = {}
        denominator = 0
        for c in [u, *filter(given, graph[u])]:
            degree = len(graph[c])
            if all(map(given, graph[c])):
                weight = 65536 // (degree * degree)
                if c == u:
                    for other in graph[u]:
                        weights[other] = weights.get(other, 0) + weight * degree
                    denominator += weight * degree * degree
                else:
                    weights[c] = weights.get(c, 0) + weight * degree
                    for other in graph[c]:
                        if other != u:
                            weights[other] = weights.get(other, 0) - weight
                    denominator += weight
            if c != u:
                weight = 39322 // (len(graph[u]) + degree)
                weights[c] = weights.get(c, 0) + weight
                denominator += weight
        return weights, denominator


def _normal(p: Vector, q: Vector) -> Vector:
    """A cross product, halved until no component is 2^15 or more in magnitude."""
    n = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
    while max(map(abs, n)) >= 2**15:
        n = [tdiv(component, 2) for component in n]
    return n
