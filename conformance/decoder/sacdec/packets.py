# SPDX-License-Identifier: Apache-2.0
"""Packets and records: spec.md 3."""

import zlib
from collections.abc import Iterator

from .byte_reader import ByteReader
from .errors import require
from .limits import Limits

MAGIC = bytes.fromhex("5341431A")
SEQUENCE_HEADER, I_FRAME, GROUP, LAYER, END = range(5)
RESERVED = range(5, 8)
METADATA = 8  # from here on they are skippable


def stream_reader(data: bytes) -> ByteReader:
    """A reader of a stream's packets, behind the four bytes of every stream."""
    require(data[:4] == MAGIC[: len(data)], 1, "not a sac stream")
    reader = ByteReader(data, end_rule=5, varint_rule=2)
    reader.bytes(4)
    return reader


def read_packet(reader: ByteReader, limits: Limits) -> tuple[int, bytes]:
    """spec.md 3: a packet's type and payload, its CRC checked."""
    begin = reader.position
    tag = reader.varint()
    size = tag >> 4
    require(size <= limits.packet_bytes, 3, f"a packet of {size} bytes")
    payload = reader.bytes(size)
    crc = zlib.crc32(reader.data[begin : reader.position])
    require(reader.u32() == crc, 4, "the CRC of a packet is wrong")
    return tag & 15, payload


def read_records(reader: ByteReader, limits: Limits) -> Iterator[bytes]:
    """spec.md 3.1: the range codes of the frames of an open group, as far as the record that ends it."""
    crc = 0
    reader.varint_rule = 64
    while True:
        begin = reader.position
        record = reader.varint()
        require(record <= limits.packet_bytes + 1, 3, f"a frame of {record - 1} bytes")
        frame = reader.bytes(max(record - 1, 0))
        crc = zlib.crc32(reader.data[begin : reader.position], crc)
        if record == 0:
            require(reader.u32() == crc, 65, "the CRC of an open group is wrong")
            reader.varint_rule = 2
            return
        require(reader.u8() == crc & 0xFF, 65, "the check of a frame is wrong")
        yield frame
