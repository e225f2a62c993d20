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

    def bin(self, p: int) -> int:
        """A bin that is 1 with the probability p / 65536."""
        return self._bin_below((self.range >> 16) * p)

    def _bin_below(self, bound: int) -> int:
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
            value = value << 1 | self._bin_below(self.range >> 1)
        return value

    def finish(self) -> None:
        """ "The end" of 7.1. That the position is not more than 4 beyond the end was checked with each byte."""
        beyond = self.position - len(self.data)
        if beyond < 0:
            raise StreamError(self.rule, "bytes are left after a range code")
        if beyond < 4 and self.data[-1] == 0:
            raise StreamError(self.rule, "a range code ends with a zero")


class BitModel:
    """spec.md 7.2: the probability p that a bin is 1, in 1/65536, and the number n of bins it has seen."""

    __slots__ = ("p", "n")

    def __init__(self) -> None:
        self.p = 32768
        self.n = 0

    def decode(self, decoder: RangeDecoder) -> int:
        decoded = decoder.bin(self.p)
        self.update(decoded)
        return decoded

    def update(self, decoded: int) -> None:
        rate = 655360 // (10 * self.n + 16)
        if decoded:
            self.p += ((65535 - self.p) * rate) >> 16
        else:
            self.p -= (self.p * rate) >> 16
        self.n = min(self.n + 1, 60)


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
