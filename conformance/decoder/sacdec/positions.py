# SPDX-License-Identifier: Apache-2.0
"""The I-frame's positions: spec.md 5.5, the parts 5.5.5 to 5.5.7."""

from dataclasses import dataclass

import numpy as np

from .errors import require
from .mixing import Table, decode_mixed, magnitude_class
from .position_graph import PositionGraph
from .position_prediction import Known, Surroundings, Vector, clamp, tdiv
from .range_coder import BitModel, RangeDecoder, UnsignedModels


def bounded(x: int) -> int:
    return clamp(x, -(2**20), 2**20)


@dataclass
class Centre:
    """spec.md 5.5.5 of one vertex: the centre, and the three differences f of each axis that it was made of."""

    centre: Vector
    differences: list[tuple[int, int, int]]


class PositionDecoder:
    """Everything that learns in spec.md 5.5."""

    def __init__(self, decoder: RangeDecoder, position_bits: int, position_step: int, position_slope: int) -> None:
        self.decoder = decoder
        self.position_bits = position_bits
        self.position_step = position_step
        self.position_slope = position_slope
        self.blend = [[32768, 0, 0] for _ in range(5)]
        self.tangent = 32768
        self.models = Table(lambda key: BitModel())
        self.mixers = Table(lambda key: [16384, 16384, 16384, 0])
        self.signs = Table(lambda key: BitModel())
        self.rest = UnsignedModels()

    def decode(self, vertices: int, triangles: np.ndarray) -> np.ndarray:
        """The grid positions [vertices, 3] of vertices that have these triangles [m, 3]."""
        graph = PositionGraph(vertices, map(tuple, triangles.tolist()))
        surroundings = Surroundings(graph, self.position_bits)
        grid = np.zeros((vertices, 3), np.int64)
        for v in graph.coding_order():
            position, miss = self.vertex(surroundings.around(v))
            grid[v] = position
            surroundings.x[v] = surroundings.last = [16 * coordinate for coordinate in position]
            surroundings.miss[v] = miss
        return grid

    def centre(self, known: Known) -> Centre:
        """spec.md 5.5.5, the centre."""
        if known.count == 0:
            return Centre(known.parallelogram, [])
        weights = self.blend[known.support]
        centre, differences = [], []
        for axis in range(3):
            origin = known.parallelogram[axis]
            f = tuple(bounded(of[axis] - origin) for of in (known.relaxed, known.mean, known.wide_mean))
            differences.append(f)
            centre.append(origin + (sum(w * d for w, d in zip(weights, f)) >> 16))
        return Centre(centre, differences)

    def vertex(self, known: Known) -> tuple[list[int], int]:
        """spec.md 5.5.5 to 5.5.7: the grid position of a vertex, and its miss."""
        around = self.centre(known)
        centre = around.centre
        step = clamp(
            (self.position_step + ((self.position_slope * known.length) >> 12)) >> 4, 1, 2 ** (self.position_bits - 1)
        )
        axes = sorted(range(3), key=lambda axis: abs(known.normal[axis]))  # equal ones x before y before z
        t = known.normal[axes[2]]
        grid = [0, 0, 0]
        offsets: list[int] = []
        along = 0
        for j, axis in enumerate(axes):
            towards = centre[axis]
            if j == 2:
                along = self._along(known.normal, axes, offsets)
                towards += (self.tangent * along) >> 16
            expected = clamp((towards + 8) >> 4, 0, 2**self.position_bits - 1)
            axis_miss = [known.near_miss, *map(abs, offsets)][j] if j < 2 else (abs(offsets[0]) + abs(offsets[1])) // 2
            lean = known.relaxed[axis] - 16 * expected
            grid[axis] = expected + step * self._residual(known, step, j, axis_miss, lean)
            require(0 <= grid[axis] < 2**self.position_bits, 35, "a position off the grid")
            offsets.append(16 * grid[axis] - centre[axis])
        if known.count:
            self._learn(known, around, [16 * g for g in grid], step, t, along, offsets[2])
        return grid, sum(map(abs, offsets)) // 3

    @staticmethod
    def _along(normal: Vector, axes: list[int], offsets: list[int]) -> int:
        """`along` of 5.5.6."""
        t = normal[axes[2]]
        if abs(t) <= 307:
            return 0
        s = 1 if t > 0 else -1
        return bounded(-s * (normal[axes[0]] * offsets[0] + normal[axes[1]] * offsets[1]) // abs(t))

    def _residual(self, known: Known, step: int, j: int, axis_miss: int, lean: int) -> int:
        """The residual of 5.5.6."""

        def size(x: int) -> int:
            return min(magnitude_class(x // step), 23)

        contexts = (
            (0, size((known.near_miss + known.far_miss + axis_miss) // 3) if known.count else 23, j),
            (1, size(known.disagreement), known.support),
            (2, min(known.count, 7), known.support),
        )

        def mixed_bin(number: int) -> int:
            kind = min(number, 2)
            return decode_mixed(
                self.decoder,
                [self.models[(number, *context)] for context in contexts],
                [256],
                self.mixers[kind],
                self.mixers[kind, j],
            )

        if not mixed_bin(0):
            return 0
        negative = self.signs[size(abs(lean)), lean < 0].decode(self.decoder)
        magnitude = 1
        while magnitude < 15 and mixed_bin(magnitude):
            magnitude += 1
        if magnitude == 15:
            rest = self.rest.decode(self.decoder)
            require(rest < 2**self.position_bits, 35, "a residual of a position is too large")
            magnitude += rest
        return -magnitude if negative else magnitude

    def _learn(self, known: Known, around: Centre, x: Vector, step: int, t: int, along: int, o2: int) -> None:
        """spec.md 5.5.7, for a vertex whose K is not empty."""
        unit = bounded(16 * step)
        if abs(t) > 307:
            error = bounded(o2 - ((self.tangent * along) >> 16))
            change = tdiv(error * along * 655, unit * unit + along * along)
            self.tangent = clamp(self.tangent + change, -(2**17), 2**17)
        weights = self.blend[known.support]
        for axis in range(3):
            f = around.differences[axis]
            said = sum(w * d for w, d in zip(weights, f)) >> 16
            error = bounded(x[axis] - known.parallelogram[axis] - said)
            size = unit * unit + sum(d * d for d in f)
            for i in range(3):
                weights[i] = clamp(weights[i] + tdiv(error * f[i] * 655, size), -(2**18), 2**18)
