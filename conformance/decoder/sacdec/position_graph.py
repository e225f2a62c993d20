# SPDX-License-Identifier: Apache-2.0
"""What the triangles say about positions: spec.md 5.5.1 and 5.5.2."""

from collections import deque
from collections.abc import Iterable, Iterator

MOST_EDGES = 32  # more make a vertex a hub


class PositionGraph:
    """spec.md 5.5.1. `neighbours[v]` is N(v); `across[a, b]`, a < b, the vertices across the edge; both ascending."""

    def __init__(self, vertices: int, triangles: Iterable[tuple[int, int, int]]) -> None:
        triangles = list(triangles)
        joined: list[set[int]] = [set() for _ in range(vertices)]
        for triangle in triangles:
            for a in triangle:
                joined[a].update(triangle)
        for v in range(vertices):
            joined[v].discard(v)
        hubs = {v for v in range(vertices) if len(joined[v]) > MOST_EDGES}
        self.neighbours = [[] if v in hubs else sorted(joined[v] - hubs) for v in range(vertices)]

        across: dict[tuple[int, int], set[int]] = {}
        for triangle in triangles:
            if len(set(triangle)) == 3 and not hubs.intersection(triangle):
                a, b, c = sorted(triangle)
                across.setdefault((a, b), set()).add(c)
                across.setdefault((a, c), set()).add(b)
                across.setdefault((b, c), set()).add(a)
        self.across = {edge: sorted(thirds) for edge, thirds in across.items()}

    def coding_order(self) -> Iterator[int]:
        """spec.md 5.5.2: the vertices in the order in which they are coded."""
        vertices = len(self.neighbours)
        coded = [False] * vertices
        count = [0] * vertices
        queues = [deque[int]() for _ in range(5)]  # 1 to 4
        lowest = 0

        def from_queues() -> int | None:
            for number in range(4, 0, -1):
                while queues[number]:
                    vertex = queues[number].popleft()
                    if not coded[vertex]:
                        return vertex
            return None

        for _ in range(vertices):
            vertex = from_queues()
            if vertex is None:
                while coded[lowest]:
                    lowest += 1
                vertex = lowest
            coded[vertex] = True
            yield vertex
            for w in self.neighbours[vertex]:
                if not coded[w] and count[w] < 4:
                    count[w] += 1
                    queues[count[w]].append(w)
