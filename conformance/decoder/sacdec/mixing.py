# SPDX-License-Identifier: Apache-2.0
"""Bins that are mixed from several contexts: spec.md 7.4.1 to 7.4.3."""

from bisect import bisect_left
from collections.abc import Sequence

import numpy as np

from .range_coder import BitModel, RangeDecoder

MOST = 2816  # the greatest logit
# spec.md 7.4.1: the probability of the logits 0, 128, 256 to 2816.
LOGISTIC = [
    32768, 40793, 47911, 53581, 57724, 60565, 62428, 63615, 64357, 64816, 65097, 65269,
    65374, 65438, 65476, 65500, 65514, 65523, 65528, 65531, 65533, 65534, 65535,
]  # fmt: skip


def _squash(x: int) -> int:
    """squash of 7.4.1: the probability in 1/65536 of a logit in 1/256."""
    if x < 0:
        return 65536 - _squash(-x)
    if x == MOST:
        return 65535
    k = x // 128
    return LOGISTIC[k] + ((LOGISTIC[k + 1] - LOGISTIC[k]) * (x - 128 * k) + 64) // 128


_SQUASH = [_squash(x) for x in range(-MOST, MOST + 1)]
# stretch depends on p >> 4 only.
_STRETCH = [bisect_left(_SQUASH, 16 * i + 8) - MOST for i in range(4096)]
_CONFIDENCE = [512 * n // (2 * n + 3) for n in range(61)]


def squash(x: int) -> int:
    return _SQUASH[x + MOST]


def stretch(p: int) -> int:
    """The smallest x with squash(x) >= 16 * (p >> 4) + 8."""
    return _STRETCH[p >> 4]


def model_input(model: BitModel) -> int:
    """What a bit model says to a mixer: spec.md 7.4.2."""
    return (_STRETCH[model.p >> 4] * _CONFIDENCE[model.n]) >> 8


class Table(dict):
    """Bit models or mixers by their key, made fresh by `make` when first asked for."""

    def __init__(self, make) -> None:
        super().__init__()
        self.make = make

    def __missing__(self, key):
        self[key] = self.make(key)
        return self[key]


Mixer = list[int]  # a weight in 1/65536 for each input


def _learn(mixer: Mixer, inputs: Sequence[int], x: int, decoded: int) -> None:
    """A mixer's step of 7.4.2. Weights wrap around modulo 2^32."""
    e = (14 * ((65535 if decoded else 0) - _SQUASH[x + MOST]) + 32) >> 6
    for i, value in enumerate(inputs):
        weight = mixer[i] + ((value * e + 2048) >> 12)
        mixer[i] = (weight + 2**31) % 2**32 - 2**31


def decode_mixed(
    decoder: RangeDecoder, models: Sequence[BitModel], features: Sequence[int], first: Mixer, second: Mixer
) -> int:
    """spec.md 7.4.2, `mixed`; the inputs are those of the models and then the features."""
    inputs = [model_input(model) for model in models]
    inputs.extend(features)
    x_1 = min(max(sum(map(int.__mul__, inputs, first)) >> 16, -MOST), MOST)
    x_2 = min(max(sum(map(int.__mul__, inputs, second)) >> 16, -MOST), MOST)
    decoded = decoder.bin(min(max(_SQUASH[((x_1 + x_2) >> 1) + MOST], 24), 65512))
    _learn(first, inputs, x_1, decoded)
    _learn(second, inputs, x_2, decoded)
    for model in models:
        model.update(decoded)
    return decoded


def magnitude_class(x: int) -> int:
    """Q(x) of 7.4.3: x below 4, else two classes an octave."""
    if x < 4:
        return x
    octave = x.bit_length() - 1
    return 2 * octave + ((x >> (octave - 1)) & 1)


def magnitude_classes(x: np.ndarray) -> np.ndarray:
    """Q of each element; integers from 0 to 2^52."""
    octave = np.maximum(np.frexp(x.astype(np.float64))[1].astype(np.int64) - 1, 1)
    return np.where(x < 4, x, 2 * octave + ((x >> (octave - 1)) & 1))
