# SPDX-License-Identifier: Apache-2.0
"""The end packet and its index of segments and groups: spec.md 3.2."""

from collections.abc import Sequence
from dataclasses import dataclass

from .byte_reader import ByteReader
from .errors import require


@dataclass(frozen=True)
class Index:
    """spec.md 3.2: where the first group begins, `segment_groups` and `start_bytes` of each later segment, and each
    group's `group_bytes` and `group_frames`."""

    first_group: int
    later_segments: list[tuple[int, int]]
    groups: list[tuple[int, int]]


@dataclass(frozen=True)
class End:
    """The payload of an end packet; `index` is None if there is none."""

    frames: int
    index: Index | None


@dataclass(frozen=True)
class IndexedGroup:
    """A group as the index sees it: where its packet and the start before that begin, its segment and its frames."""

    begin: int
    start: int
    segment: int
    frames: int


def parse_end(payload: bytes, packet_bytes: int) -> End:
    """spec.md 3.2; `packet_bytes` is the size of the packet from its tag to its CRC-32. Rule R58."""
    reader = ByteReader(payload, end_rule=58, varint_rule=58)
    frames = reader.varint()
    if reader.remaining() == 0:
        return End(frames, None)
    first_group = reader.varint()
    later_segments: list[tuple[int, int]] = []
    for _ in range(reader.varint()):
        segment_groups = reader.varint()
        require(segment_groups >= 1, 58, "a segment that begins with the same group as the one before")
        later_segments.append((segment_groups, reader.varint()))
    groups: list[tuple[int, int]] = []
    while reader.remaining() > 4:
        group_bytes = reader.varint()
        groups.append((group_bytes, reader.varint()))
    require(reader.u32() == packet_bytes, 58, "end_size is wrong")
    require(reader.remaining() == 0, 58, "bytes after the index")
    require(sum(group_frames for _, group_frames in groups) == frames, 58, "the frames of the index do not add up")
    behind = sum(segment_groups for segment_groups, _ in later_segments)
    require(not later_segments or behind < len(groups), 58, "a segment that begins behind the groups of the index")
    return End(frames, Index(first_group, later_segments, groups))


def index_of_groups(groups: Sequence[IndexedGroup], end: int) -> Index:
    """The index that a stream of these groups should have, whose end packet begins at the byte `end`."""
    bounds = [*(group.begin for group in groups), end]
    later_segments: list[tuple[int, int]] = []
    first = 0  # group of the segment
    for number, (before, group) in enumerate(zip(groups, groups[1:]), start=1):
        if group.segment != before.segment:
            later_segments.append((number - first, group.begin - group.start))
            first = number
    sizes = [after - before for before, after in zip(bounds, bounds[1:])]
    return Index(bounds[0], later_segments, list(zip(sizes, (group.frames for group in groups))))
