# SPDX-License-Identifier: Apache-2.0
"""The residuals of one plane: spec.md 7.4."""

from dataclasses import dataclass

import numpy as np

from .errors import require
from .mixing import Table, decode_mixed, magnitude_class, magnitude_classes
from .range_coder import BitModel, RangeDecoder

MOTION, DISPLACEMENT, DETAIL, CORRECTION = range(4)
CHANNELS = (9, 3, 3, 3)

# spec.md 7.4.4: the first weights of the mixers, in 1/64, by plane (2 is detail and correction) and kind of bin.
_FIRST_WEIGHTS = {
    (0, 0): (23, 22, 18, 9, 17, 32, 113, 26, 0, -6, 64, -74),
    (0, 1): (19, 14, 9, 15, 4, 14, -6, 16, 3, 8, 32, -32),
    (0, 2): (8, 2, -4, 14, 6, 18, -2, 16, 8, 4, 12, -55),
    (1, 0): (26, 12, 16, 14, 7, 17, 42, 13, 8, 3, 34, -22),
    (1, 1): (22, 14, 21, 8, 2, 7, -20, 20, -8, 2, 13, -30),
    (1, 2): (12, 9, 14, 6, -8, 1, -23, 26, -5, -7, 6, -42),
    (2, 0): (42, 13, 16, -7, -13, 11, 51, 7, 30, -11, 47, -55),
    (2, 1): (45, 27, 2, 5, 10, 1, 12, 8, 5, -1, 25, -11),
    (2, 2): (31, 16, 5, 5, -11, 5, -30, 13, 6, 1, 19, -17),
}


def first_weights(plane: int, kind: int) -> list[int]:
    """A fresh mixer of a plane and a kind of bin, in 1/65536."""
    return [1024 * weight for weight in _FIRST_WEIGHTS[min(plane, 2), kind]]


@dataclass
class PlaneFrame:
    """A plane of a frame: residuals and coefficients, [rows, channels] of 64 bits."""

    residuals: np.ndarray
    coefficients: np.ndarray


@dataclass
class PlaneContext:
    """What spec.md 7.4.3 knows of a plane before its residuals are decoded.

    `references` are none, one or two planes of earlier frames, `bend` [rows, channels] is the bend of each residual,
    `level` and `step` those of the frame (6.3).
    """

    references: list[PlaneFrame]
    bend: np.ndarray
    level: int
    step: int


def _shifted(x: np.ndarray, by: int) -> np.ndarray:
    """The element at (i + by, j) at each (i, j), 0 outside of the plane; `by` is 1 or -1."""
    result = np.zeros_like(x)
    if by > 0:
        result[:-1] = x[1:]
    else:
        result[1:] = x[:-1]
    return result


class PlaneDecoder:
    """The models and memories of one plane in one group, all fresh at its beginning."""

    def __init__(self, plane: int, row_classes: np.ndarray) -> None:
        """`row_classes`: the row class (7.4.3) of each row, which also says how many there are."""
        self.row_classes = row_classes.tolist()
        self.shape = (len(self.row_classes), CHANNELS[plane])
        self.recent = np.zeros(self.shape, np.int64)  # h of 7.4.3
        self.models = Table(lambda key: BitModel())
        self.depth_mixers = Table(lambda key: first_weights(plane, key[0]))
        self.activity_mixers = Table(lambda key: first_weights(plane, key[0]))
        self.sign_mixers = Table(lambda key: [40 * 1024, 40 * 1024])
        self.escape = [BitModel() for _ in range(20)]

    def decode(self, decoder: RangeDecoder, context: PlaneContext) -> np.ndarray:
        """The residuals [rows, channels] of a plane that is not empty."""
        return FrameOfPlane(self, decoder, context).decode()

    def remember(self, residuals: np.ndarray, step: int) -> None:
        """spec.md 7.4.3, "Recent magnitude": after each plane of each frame, empty or not."""
        magnitudes = np.minimum(np.abs(residuals) * step, 2**20)
        self.recent += (4 * magnitudes - self.recent) >> 3


class FrameOfPlane:
    """Decodes a plane of one frame. The table of 7.4.3 is computed for the whole plane where that is possible."""

    def __init__(self, models: PlaneDecoder, decoder: RangeDecoder, context: PlaneContext) -> None:
        self.models = models
        self.decoder = decoder
        self.depth = min(context.level, 4)
        rows, channels = models.shape
        zero = np.zeros(models.shape, np.int64)
        step, h = context.step, models.recent

        # With one reference, "all of these are of that one".
        frames = context.references
        a, b = (frames[0], frames[-1]) if frames else (PlaneFrame(zero, zero), PlaneFrame(zero, zero))
        magnitudes = np.abs(a.residuals) + np.abs(b.residuals)
        around = 4 * magnitudes + 2 * (_shifted(magnitudes, -1) + _shifted(magnitudes, 1))
        recent = np.minimum(magnitude_classes(16 * h // step // 4), 19)
        recent_around = magnitude_classes((16 * h + 4 * (_shifted(h, -1) + _shifted(h, 1))) // step)
        spread = magnitude_classes(16 * np.abs(a.coefficients - b.coefficients) // step)
        bend_class = np.minimum(magnitude_classes(np.abs(context.bend) // (2 * step)), 11)
        signed_bend = np.sign(context.bend) * np.minimum(bend_class, 8)
        reference_sign = np.sign(np.sign(a.residuals) + np.sign(b.residuals))

        self.quiet = (magnitudes == 0).tolist()
        self.around = around.tolist()
        self.recent = recent.tolist()
        self.recent_around = recent_around.tolist()
        self.spread = spread.tolist()
        self.bend_class = bend_class.tolist()
        self.signed_bend = signed_bend.tolist()
        self.reference_sign = reference_sign.tolist()
        # r and m, with four rows of zeros before the first.
        self.r = [[0] * channels for _ in range(rows + 4)]
        self.m = [[0] * channels for _ in range(rows + 4)]

    def decode(self) -> np.ndarray:
        rows, channels = self.models.shape
        for i in range(rows):
            for j in range(channels):
                value = self.residual(i, j)
                self.r[i + 4][j] = value
                self.m[i + 4][j] = abs(value)
        return np.array(self.r[4:], np.int64).reshape(rows, channels)

    def residual(self, i: int, j: int) -> int:
        """spec.md 7.4, the residual of row i in channel j."""
        models, decoder = self.models, self.decoder
        m = self.m
        near = 12 * m[i + 3][j] + 6 * m[i + 2][j] + 3 * m[i + 1][j] + 3 * m[i][j]
        before = 24 * sum(m[i + 4][:j]) // j if j else 0
        activity = min(magnitude_class((near + self.around[i][j] + before) // 2), 23)
        contexts = (
            (0, self.recent[i][j], self.depth, self.quiet[i][j]),
            (1, min(magnitude_class(near // 3), 15), min(magnitude_class(before // 6), 13)),
            (2, models.row_classes[i], j, self.depth),
            (3, min(i, 1023), self.depth),
            (4, j, self.depth),
            (5, min(i, 1023), j),
        )
        features = (
            256,
            64 * self.recent_around[i][j] - 512,
            64 * self.spread[i][j] - 512,
            64 * magnitude_class(near) - 256,
            64 * self.bend_class[i][j] - 256,
            128 * self.depth - 256,
        )

        def mixed_bin(number: int) -> int:
            kind = min(number, 2)
            chosen = [models.models[(number, *context)] for context in contexts]
            first = models.depth_mixers[kind, self.depth]
            return decode_mixed(decoder, chosen, features, first, models.activity_mixers[kind, activity])

        if not mixed_bin(0):
            return 0
        negative = self._sign(i, j)
        magnitude = 1
        while magnitude < 15 and mixed_bin(magnitude):
            magnitude += 1
        if magnitude == 15:
            width = 0
            while width < 20 and models.escape[width].decode(decoder):
                width += 1
            magnitude = 14 + 2**width + decoder.raw(width)
            require(magnitude <= 2**20, 52, f"a residual of magnitude {magnitude}")
        return -magnitude if negative else magnitude

    def _sign(self, i: int, j: int) -> int:
        """The sign bin of 7.4.4."""
        above = self.r[i + 3][j]
        contexts = (
            ("bend", self.signed_bend[i][j], self.depth),
            ("sign", self.reference_sign[i][j], (above > 0) - (above < 0), self.depth),
        )
        models = [self.models.models[context] for context in contexts]
        mixers = self.models.sign_mixers
        return decode_mixed(self.decoder, models, (), mixers["depth", self.depth], mixers["plane"])
