# SPDX-License-Identifier: Apache-2.0
"""The range decoder, bit models and integers: spec.md 7.1 to 7.3."""

from .errors import StreamError


class RangeDecoder:
    """spec.md 7.1: turns bytes into bins. `rule` is the rule that a wrong end breaks."""

    def __init__(self, data: bytes, rule: int) -> None:
        self.data = data
        self.rule = rule
        self.position = 0
        self.range = 0xFFFFFFFF
        self.code = 0
        for _ in range(4):
            self.code = self.code << 8 | self._next_byte()

    def _next_byte(self) -> int:
        """The next byte, 0 past the end. "A decoder may reject as soon as its position is more than 4 beyond"."""
        byte = self.data[self.position] if self.position < len(self.data) else 0
        self.position += 1
        if self.position > len(self.data) + 4:
            raise StreamError(self.rule, "a range code ends too early")
        return byte

    def bin_below(self, bound: int) -> int:
        """A bin that is 1 if `code` is below the bound."""
        if self.code < bound:
            decoded = 1
            self.range = bound
        else:
            decoded = 0
            self.code -= bound
            self.range -= bound
        while self.range < 2**24:
            self.code = (self.code << 8 | self._next_byte()) & 0xFFFFFFFF
            self.range = (self.range << 8) & 0xFFFFFFFF
        return decoded

    def raw(self, bits: int) -> int:
        """raw(n): n bins of equal probability, most significant first."""
        value = 0
        for _ in range(bits):
            value = value << 1 | self.bin_below(self.range >> 1)
        return value

    def finish(self) -> None:
        """ "The end" of 7.1: the bytes are the only ones that say what was decoded."""
        if self.position < len(self.data):
            raise StreamError(self.rule, "bytes are left after a range code")
        if self.position < len(self.data) + 4 and self.data[-1] == 0:
            raise StreamError(self.rule, "a range code ends with a zero")
        last = int.from_bytes((self.data + bytes(4))[self.position - 4 : self.position], "big")
        low = (last - self.code) % 2**32
        end = low + self.code
        power = end & -end if end else 2**32
        rounder = -(-low // (2 * power)) * 2 * power  # the first multiple of the next power
        if self.code >= self.range or (end and rounder < low + self.range):
            raise StreamError(self.rule, "a range code has another end than it should")


class BitModel:
    """spec.md 7.2: the probability that a bin is 1, from two estimates of different speed."""

    __slots__ = ("fast", "slow", "count")

    def __init__(self) -> None:
        self.fast = 32768
        self.slow = 32768
        self.count = 0

    def probability(self) -> int:
        return min(max((self.fast + self.slow) >> 2, 8), 32760)

    def decode(self, decoder: RangeDecoder) -> int:
        decoded = decoder.bin_below((decoder.range >> 15) * self.probability())
        young = 131072 // (2 * self.count + 3)
        fast_rate = max(young, 4096)
        slow_rate = max(young, 512)
        if decoded:
            self.fast += ((65535 - self.fast) * fast_rate) >> 16
            self.slow += ((65535 - self.slow) * slow_rate) >> 16
        else:
            self.fast -= (self.fast * fast_rate) >> 16
            self.slow -= (self.slow * slow_rate) >> 16
        self.count = min(self.count + 1, 127)
        return decoded


class UnsignedModels:
    """spec.md 7.3, ue: 31 bit models, prefix 0 to prefix 30."""

    def __init__(self) -> None:
        self.prefix = [BitModel() for _ in range(31)]

    def decode(self, decoder: RangeDecoder) -> int:
        width = 0
        while width < 31 and self.prefix[width].decode(decoder):
            width += 1
        return 2**width + decoder.raw(width) - 1


class SignedModels:
    """spec.md 7.3, se: a bit model `nonzero` and the models of one ue."""

    def __init__(self) -> None:
        self.nonzero = BitModel()
        self.magnitude = UnsignedModels()

    def decode(self, decoder: RangeDecoder) -> int:
        if not self.nonzero.decode(decoder):
            return 0
        negative = decoder.raw(1)
        magnitude = 1 + self.magnitude.decode(decoder)
        return -magnitude if negative else magnitude
