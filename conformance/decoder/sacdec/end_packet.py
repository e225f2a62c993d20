# SPDX-License-Identifier: Apache-2.0
"""The end packet and its index of groups: spec.md 3.2."""

from dataclasses import dataclass

from .byte_reader import ByteReader
from .errors import require


@dataclass(frozen=True)
class Index:
    """spec.md 3.2: where the first group begins, and each group's `group_bytes` and `group_frames`."""

    first_group: int
    groups: list[tuple[int, int]]


@dataclass(frozen=True)
class End:
    """The payload of an end packet; `index` is None if there is none."""

    frames: int
    index: Index | None


def parse_end(payload: bytes, packet_bytes: int) -> End:
    """spec.md 3.2; `packet_bytes` is the size of the packet from its tag to its CRC-32. Rule R58."""
    reader = ByteReader(payload, end_rule=58, varint_rule=58)
    frames = reader.varint()
    if reader.remaining() == 0:
        return End(frames, None)
    first_group = reader.varint()
    groups = []
    while reader.remaining() > 4:
        group_bytes = reader.varint()
        groups.append((group_bytes, reader.varint()))
    require(reader.u32() == packet_bytes, 58, "end_size is wrong")
    require(reader.remaining() == 0, 58, "bytes after the index")
    require(sum(group_frames for _, group_frames in groups) == frames, 58, "the frames of the index do not add up")
    return End(frames, Index(first_group, groups))


def index_of_groups(begins: list[int], frames: list[int], end: int) -> Index:
    """The index that a stream should have: of the packets that begin groups, their frames, and the end packet's begin."""
    bounds = [*begins, end]
    sizes = [after - before for before, after in zip(bounds, bounds[1:])]
    return Index(bounds[0], list(zip(sizes, frames)))
