# SPDX-License-Identifier: Apache-2.0
"""The residuals of one plane: spec.md 7.4."""

from dataclasses import dataclass

import numpy as np

from .errors import require
from .mixing import State, Table, decode_mixed, magnitude_class, magnitude_classes
from .range_coder import BitModel, RangeDecoder

MOTION, DISPLACEMENT, DETAIL, CORRECTION = range(4)
CHANNELS = (9, 3, 3, 3)

# spec.md 7.4.4: the first weights in 1/64, by plane (2 is detail and correction), kind (2 is 2 to 5) and L.
_ANY = -1
_FIRST_WEIGHTS = {
    (0, 0, 0): (14, 16, 20, 25, 27, 30, 41, 37, -34, 18, 50, -40),
    (0, 0, 1): (23, 22, 18, 9, 17, 32, 113, 26, 0, -6, 64, -74),
    (0, 0, 2): (26, 21, -1, 6, 12, 66, 158, -3, 4, -11, 72, -73),
    (0, 1, _ANY): (19, 14, 9, 15, 4, 14, -6, 16, 3, 8, 32, -32),
    (0, 2, _ANY): (8, 2, -4, 14, 6, 18, -2, 16, 8, 4, 12, -55),
    (1, 0, 0): (9, 7, 20, 12, 9, 15, 12, 19, -21, 10, 39, -11),
    (1, 0, 1): (26, 12, 16, 14, 7, 17, 42, 13, 8, 3, 34, -22),
    (1, 0, 2): (36, 11, 9, 12, 11, 27, 101, 3, 1, 6, 19, -34),
    (1, 1, _ANY): (22, 14, 21, 8, 2, 7, -20, 20, -8, 2, 13, -30),
    (1, 2, _ANY): (12, 9, 14, 6, -8, 1, -23, 26, -5, -7, 6, -42),
    (2, 0, 0): (21, 21, 29, -12, -14, 8, 55, 38, 13, -6, 43, -53),
    (2, 0, 1): (42, 13, 16, -7, -13, 11, 51, 7, 30, -11, 47, -55),
    (2, 0, 2): (40, 22, 8, 2, -7, 5, 56, 2, 15, 13, 20, -13),
    (2, 1, _ANY): (45, 27, 2, 5, 10, 1, 12, 8, 5, -1, 25, -11),
    (2, 2, _ANY): (31, 16, 5, 5, -11, 5, -30, 13, 6, 1, 19, -17),
}


def first_weights(plane: int, kind: int, level: int) -> list[int]:
    """The fresh mixer of a plane, a kind of bin and L, in 1/65536."""
    plane, kind = min(plane, 2), min(kind, 2)
    weights = _FIRST_WEIGHTS.get((plane, kind, level)) or _FIRST_WEIGHTS[plane, kind, _ANY]
    return [1024 * weight for weight in weights]


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
        self.states = Table(lambda key: State())
        self.level_mixers = Table(lambda key: first_weights(plane, *key))
        self.activity_mixers = Table(lambda key: first_weights(plane, key[0], 1))
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
        self.v = min(context.level, 4)
        self.l = min(context.level, 2)
        rows, channels = models.shape
        zero = np.zeros(models.shape, np.int64)
        step, h = context.step, models.recent

        # With one reference, "all of these are of that one".
        frames = context.references
        a, b = (frames[0], frames[-1]) if frames else (PlaneFrame(zero, zero), PlaneFrame(zero, zero))
        magnitudes = np.minimum(np.abs(a.residuals), 2**15) + np.minimum(np.abs(b.residuals), 2**15)
        around = 4 * magnitudes + 2 * (_shifted(magnitudes, -1) + _shifted(magnitudes, 1))
        recent = np.minimum(magnitude_classes(16 * h // step // 4), 19)
        wide = magnitude_classes((16 * h + 4 * (_shifted(h, -1) + _shifted(h, 1))) // step)
        spread = magnitude_classes(16 * np.minimum(np.abs(a.coefficients - b.coefficients), 2**26) // step)
        bend = np.minimum(magnitude_classes(np.minimum(np.abs(context.bend), 2**30) // (2 * step)), 11)
        bend_sign = np.where(bend > 0, np.sign(context.bend), 0)
        reference_sign = np.sign(np.sign(a.residuals) + np.sign(b.residuals))

        self.quiet = (magnitudes == 0).tolist()
        self.around = around.tolist()
        self.recent = recent.tolist()
        self.wide = wide.tolist()
        self.spread = spread.tolist()
        self.bend = bend.tolist()
        self.bend_sign = bend_sign.tolist()
        self.reference_sign = reference_sign.tolist()
        # r and M, with four rows of zeros before the first.
        self.r = [[0] * channels for _ in range(rows + 4)]
        self.m = [[0] * channels for _ in range(rows + 4)]

    def decode(self) -> np.ndarray:
        rows, channels = self.models.shape
        for i in range(rows):
            for j in range(channels):
                value = self.residual(i, j)
                self.r[i + 4][j] = value
                self.m[i + 4][j] = min(abs(value), 2**15)
        return np.array(self.r[4:], np.int64).reshape(rows, channels)

    def residual(self, i: int, j: int) -> int:
        """spec.md 7.4, the residual of row i in channel j."""
        models, decoder = self.models, self.decoder
        m = self.m
        near = 12 * m[i + 3][j] + 6 * m[i + 2][j] + 3 * m[i + 1][j] + 3 * m[i][j]
        before = 24 * sum(m[i + 4][:j]) // j if j else 0
        activity = min(magnitude_class((near + self.around[i][j] + before) // 2), 23)
        contexts = (
            (1, self.recent[i][j], self.v, self.quiet[i][j]),
            (2, min(magnitude_class(near // 3), 15), min(magnitude_class(before // 6), 13)),
            (3, models.row_classes[i], j, self.v),
            (4, min(i, 1023), self.l),
            (5, j, self.v),
            (6, min(i, 1023), j),
        )
        features = (
            256,
            64 * self.wide[i][j] - 512,
            64 * self.spread[i][j] - 512,
            64 * magnitude_class(near) - 256,
            64 * self.bend[i][j] - 256,
            128 * self.v - 256,
        )

        def mixed_bin(number: int) -> int:
            kind = min(number, 5)
            states = [models.states[(number, *context)] for context in contexts]
            first = models.level_mixers[kind, self.l]
            return decode_mixed(decoder, states, features, first, models.activity_mixers[kind, activity])

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
            ("bend", self.bend_sign[i][j], min(self.bend[i][j], 8), self.v),
            ("sign", self.reference_sign[i][j], (above > 0) - (above < 0), self.l),
        )
        states = [self.models.states[context] for context in contexts]
        mixers = self.models.sign_mixers
        return decode_mixed(self.decoder, states, (), mixers["V", self.v], mixers["plane"])
