# SPDX-License-Identifier: Apache-2.0
"""Bytes, varints and floats: spec.md 2.2 and 2.3."""

import struct

from .errors import StreamError


class ByteReader:
    """Reads elements from the front of bytes.

    Past the end it raises StreamError of the rule `end_rule`, at a malformed varint that of `varint_rule`.
    """

    def __init__(self, data: bytes, end_rule: int, varint_rule: int) -> None:
        self.data = data
        self.position = 0
        self.end_rule = end_rule
        self.varint_rule = varint_rule

    def remaining(self) -> int:
        return len(self.data) - self.position

    def bytes(self, size: int) -> bytes:
        if size > self.remaining():
            raise StreamError(self.end_rule, f"{size} bytes expected, {self.remaining()} left")
        self.position += size
        return self.data[self.position - size : self.position]

    def rest(self) -> bytes:
        return self.bytes(self.remaining())

    def u8(self) -> int:
        return self.bytes(1)[0]

    def u32(self) -> int:
        return int.from_bytes(self.bytes(4), "little")

    def f32(self) -> float:
        """spec.md 2.3: a binary32, converted to binary64."""
        return struct.unpack("<f", self.bytes(4))[0]

    def f64(self) -> float:
        """spec.md 2.3: a binary64."""
        return struct.unpack("<d", self.bytes(8))[0]

    def varint(self) -> int:
        """spec.md 2.2: 7 bits a byte, least significant first, 5 bytes at most, one spelling for every value."""
        value = 0
        for index in range(5):
            byte = self.u8()
            value |= (byte & 0x7F) << (7 * index)
            if byte & 0x80:
                continue
            if byte == 0 and index > 0:
                raise StreamError(self.varint_rule, "a varint with a superfluous zero")
            if value >= 2**32:
                raise StreamError(self.varint_rule, "a varint of 2^32 or more")
            return value
        raise StreamError(self.varint_rule, "a varint of more than 5 bytes")
