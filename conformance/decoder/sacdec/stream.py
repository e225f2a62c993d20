# SPDX-License-Identifier: Apache-2.0
"""A stream from its first byte to its last: spec.md 3 and 6."""

import zlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .byte_reader import ByteReader
from .end_packet import IndexedGroup, index_of_groups, parse_end
from .errors import require
from .group import CodedFrame, GroupDecoder, GroupHeader, parse_group
from .group_structure import chain_slot, group_structure
from .layers import LayeredGroup, parse_layer
from .limits import Limits
from .metadata import parse_metadata
from .packets import END, GROUP, I_FRAME, LAYER, METADATA, RESERVED, SEQUENCE_HEADER
from .packets import read_packet, read_records, stream_reader
from .range_coder import RangeDecoder
from .segment import Segment, SegmentDecoder
from .sequence_header import SequenceHeader, parse_sequence_header
from .vertices import Mesh


@dataclass
class Clip:
    """What a stream decodes to. `coefficients_crc32` is what conformance/README.md says of it.

    `segments` are those with groups, or the last one if none has any.
    """

    segments: list[Segment] = field(default_factory=list)
    coefficients_crc32: int = 0
    metadata: dict[int, Any] = field(default_factory=dict)

    @property
    def header(self) -> SequenceHeader:
        """The last segment's."""
        return self.segments[-1].header

    @property
    def mesh(self) -> Mesh:
        """The last segment's."""
        return self.segments[-1].mesh

    @property
    def frames(self) -> list[np.ndarray]:
        """The frames of all segments."""
        return [frame for segment in self.segments for frame in segment.frames]

    def segment_of(self, frame: int) -> Segment:
        """The segment of the frame of this number."""
        return next(s for s in self.segments if s.first_frame <= frame < s.first_frame + len(s.frames))


@dataclass(frozen=True)
class Start:
    """A sequence header and the I-frame after it, as bytes; `begin` is the first byte of the header's packet."""

    begin: int
    header_payload: bytes
    i_frame_payload: bytes
    header: SequenceHeader

    def is_repetition_of(self, other: "Start") -> bool:
        return (self.header_payload, self.i_frame_payload) == (other.header_payload, other.i_frame_payload)


class StreamDecoder:
    """What a decoder knows between packets."""

    def __init__(self, limits: Limits) -> None:
        self.limits = limits
        self.clip = Clip()
        self.frames = 0  # so far
        self.first_header: SequenceHeader | None = None
        self.start: Start | None = None  # the last one
        self.used: Start | None = None  # that of the last group
        self.segment = 0  # of the last group
        self.decoder: SegmentDecoder | None = None  # of this segment, from its first group on
        self.layered: LayeredGroup | None = None  # a group that layers may follow
        self.groups: list[IndexedGroup] = []

    def decode(self, data: bytes) -> Clip:
        """spec.md 3: the packets of a stream in turn."""
        reader = stream_reader(data)
        header_begin, header_payload = 0, b""
        before = None  # the type of the packet before
        while before != END:
            begin = reader.position
            kind, payload = read_packet(reader, self.limits)
            require(kind not in RESERVED, 69, f"a packet of type {kind}")
            # This leaves nothing of R8 and R9.
            require(before is not None or kind == SEQUENCE_HEADER, 70, "a packet before the first sequence header")
            require(before != SEQUENCE_HEADER or kind == I_FRAME, 6, "a sequence header without an I-frame")
            if kind == SEQUENCE_HEADER:
                header_begin, header_payload = begin, payload
            elif kind == I_FRAME:
                require(before == SEQUENCE_HEADER, 7, "an I-frame that does not follow a sequence header")
                self._start(header_begin, header_payload, payload)
            elif kind == GROUP:
                self._group(payload, begin, reader)
            elif kind == LAYER:
                require(self.layered is not None, 73, "a layer that does not follow a layered group")
                self.layered.add(parse_layer(payload))
            elif kind == METADATA:
                self.clip.metadata |= parse_metadata(payload)
            elif kind == END:
                self._end(payload, begin, reader.position)
            before = kind
        require(reader.remaining() == 0, 10, "bytes after the end")
        return self.clip

    def _start(self, begin: int, header_payload: bytes, i_frame_payload: bytes) -> None:
        """spec.md 3, "A start". Its I-frame is decoded when the first group of its segment comes; the last one's, when
        the end of a stream without groups does."""
        self._finish_layers()
        header = parse_sequence_header(header_payload, self.limits)
        first = self.first_header = self.first_header or header
        for name in ("frame_rate_numerator", "frame_rate_denominator", "offset"):
            require(getattr(header, name) == getattr(first, name), 71, f"{name} is not that of the first segment")
        self.start = Start(begin, header_payload, i_frame_payload, header)

    def _segment_decoder(self) -> SegmentDecoder:
        """That of the segment of the last start."""
        if self.decoder is None:
            start = self.start
            self.decoder = SegmentDecoder(start.header, start.i_frame_payload, self.limits, self.frames)
            self.clip.segments.append(self.decoder.segment)
        return self.decoder

    def _group(self, payload: bytes, begin: int, reader: ByteReader) -> None:
        """spec.md 6; an open group's records follow the packet, a layered one's layers in packets."""
        self._finish_layers()
        header = self.start.header
        group = parse_group(payload, header, self.limits)
        if self.used is None or not self.start.is_repetition_of(self.used):
            self.segment += self.used is not None
            self.decoder = None
        self.used = self.start
        require(group.segment == self.segment, 72, f"a group of segment {group.segment}, not {self.segment}")
        before = self.frames
        require(group.first_frame == before, 66, f"a group from frame {group.first_frame}, not {before}")
        decoder = GroupDecoder(header, self._segment_decoder().rows)
        self._check_coefficients(group.frames)
        if group.is_open:
            self._output(self._open_frames(decoder, reader))
        elif group.is_layered:
            self.layered = LayeredGroup(group, decoder)
        else:
            self._output(self._whole_group(group, decoder))
        frames = group.frames or self.frames - before
        self.groups.append(IndexedGroup(begin, self.start.begin, self.segment, frames))

    def _check_coefficients(self, frames: int) -> None:
        """spec.md 9, group_values, for a group of so many frames."""
        values = frames * self.decoder.rows.coefficients()
        require(values <= self.limits.group_values, 63, f"a group of {values} coefficients")

    def _whole_group(self, group: GroupHeader, decoder: GroupDecoder) -> list[CodedFrame]:
        """spec.md 6.2: the frames of a group that is neither open nor layered, in coding order."""
        code = RangeDecoder(group.code, rule=56)
        for slot in group_structure(group.frames, group.pyramid):
            decoder.decode_frame(code, slot, decoder.planes)
        code.finish()
        return decoder.frames

    def _open_frames(self, decoder: GroupDecoder, reader: ByteReader) -> Iterator[CodedFrame]:
        """spec.md 3.1 and 6.2: "In an open group each frame is a range code of its own"."""
        for index, frame in enumerate(read_records(reader, self.limits)):
            require(self.frames + 1 < 2**32, 49, "2^32 frames or more")
            require(index < self.limits.frames_per_group, 48, f"an open group of more than {index} frames")
            self._check_coefficients(index + 1)
            code = RangeDecoder(frame, rule=56)
            coded = decoder.decode_frame(code, chain_slot(index), decoder.planes)
            code.finish()
            yield coded

    def _finish_layers(self) -> None:
        """Puts out the frames of a layered group when what comes is no layer of it."""
        if self.layered is not None:
            self._output(self.layered.frames())
            self.layered = None

    def _output(self, frames: Iterable[CodedFrame]) -> None:
        """The frames of a group: a list in coding order, or one after the other in display order."""
        if isinstance(frames, list):
            frames = sorted(frames, key=lambda frame: frame.display)
        for coded in frames:
            self.clip.coefficients_crc32 = zlib.crc32(coded.checked_bytes(), self.clip.coefficients_crc32)
            self.decoder.output(coded)
            self.frames += 1

    def _end(self, payload: bytes, begin: int, behind: int) -> None:
        """spec.md 3.2: the number of frames and, if there is one, the index; the packet is the bytes from `begin` to
        before `behind`."""
        self._finish_layers()
        if not self.groups:
            self._segment_decoder()
        end = parse_end(payload, behind - begin)
        require(end.frames == self.frames, 59, f"{self.frames} frames, {end.frames} expected")
        index = index_of_groups(self.groups, begin)
        require(end.index is None or end.index == index, 67, "the index is not that of the stream")


def decode_stream(data: bytes, limits: Limits = Limits()) -> Clip:
    """Decodes a whole stream; raises StreamError if it breaks a rule of spec.md 11 or exceeds the limits."""
    return StreamDecoder(limits).decode(data)
