# SPDX-License-Identifier: Apache-2.0
"""A stream from its first byte to its last: spec.md 3, 5 and 6."""

import zlib
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from . import harmonics
from .byte_reader import ByteReader
from .draco_mesh import decode_draco_mesh
from .end_packet import index_of_groups, parse_end
from .errors import require
from .group import CodedFrame, GroupDecoder, PlaneRows, parse_group, plane_rows
from .group_structure import chain_slot, group_structure
from .i_frame import parse_side_information, split_i_frame
from .limits import Limits
from .packets import GROUP, I_FRAME, SEQUENCE_HEADER, read_packet, read_records, stream_reader
from .positions import PositionDecoder
from .range_coder import RangeDecoder
from .reconstruction import Reconstruction, first_shape
from .sequence_header import SequenceHeader, parse_sequence_header
from .shape import edge_weights, mesh_edges, vertex_masses
from .vertices import Mesh, build_mesh, join_entries


@dataclass
class Clip:
    """What a stream decodes to. `frames` are positions [n, 3] in display order; `coefficients_crc32` is what
    conformance/README.md says of it."""

    header: SequenceHeader
    mesh: Mesh
    frames: list[np.ndarray] = field(default_factory=list)
    coefficients_crc32: int = 0

    def first_diagonal(self) -> float:
        """The diagonal of the bounding box of M'0, in model units (spec.md 8)."""
        shape = first_shape(self.header, self.mesh)
        return float(np.linalg.norm(shape.max(axis=0) - shape.min(axis=0)))


class StreamDecoder:
    """What a decoder knows between packets."""

    def __init__(self, limits: Limits) -> None:
        self.limits = limits
        self.start: dict[int, bytes] = {}  # payloads of the first sequence header and the first I-frame
        self.header: SequenceHeader | None = None
        self.clip: Clip | None = None
        self.rows: PlaneRows | None = None
        self.reconstruction: Reconstruction | None = None
        self.group_begins: list[int] = []  # bytes of the stream before each group's packet
        self.group_frames: list[int] = []

    def decode(self, data: bytes) -> Clip:
        """spec.md 3: the packets of a stream in turn."""
        reader = stream_reader(data)
        before = None  # the type of the packet before
        while True:
            begin = reader.position
            kind, payload = read_packet(reader, self.limits)
            if before == SEQUENCE_HEADER:
                require(kind == I_FRAME, 6, "a sequence header without an I-frame")
            if kind == SEQUENCE_HEADER:
                if self._is_first(kind, payload, 6):
                    self.header = parse_sequence_header(payload, self.limits)
            elif kind == I_FRAME:
                require(before == SEQUENCE_HEADER, 7, "an I-frame that does not follow a sequence header")
                if self._is_first(kind, payload, 7):
                    self._i_frame(payload)
            elif kind == GROUP:
                require(self.clip is not None, 8, "a group before the I-frame")
                self.group_begins.append(begin)
                self._group(payload, reader)
            else:
                require(self.clip is not None, 9, "the end before the I-frame")
                self._end(payload, begin, reader.position)
                require(reader.remaining() == 0, 10, "bytes after the end")
                return self.clip
            before = kind

    def _is_first(self, kind: int, payload: bytes, rule: int) -> bool:
        """spec.md 3, "The start": whether this is the first sequence header or I-frame; others must be equal to it."""
        if kind in self.start:
            require(payload == self.start[kind], rule, "a start that is not the first one again")
            return False
        self.start[kind] = payload
        return True

    def _i_frame(self, payload: bytes) -> None:
        """spec.md 5, and what is derived from it once: the basis (6.4)."""
        header, limits = self.header, self.limits
        parts = split_i_frame(payload)
        side = parse_side_information(parts.side_information, header)
        draco = decode_draco_mesh(parts.mesh, header.triangles)
        vertex, count = join_entries(draco.entries, side.welds)
        coded = np.zeros((0, 3), np.int64)
        if parts.positions is not None:
            coding = PositionDecoder(parts.positions, header.position_bits, parts.position_step, parts.position_slope)
            coded = coding.decode(count, vertex[draco.triangles].reshape(-1, 3))
        mesh = build_mesh(draco, vertex, coded, side, header.vertices, header.triangles, header.patch_size)

        shape = first_shape(header, mesh)
        edges = mesh_edges(mesh.triangles)
        weights = edge_weights(edges, mesh.triangles, shape)
        masses = vertex_masses(mesh.triangles, shape)
        components = harmonics.component_harmonics(mesh, edges, weights, masses, side, header, limits)
        patches = harmonics.patch_harmonics(mesh, edges, weights) if header.detail_step > 0 else []
        harmonics.check_fingerprint(components, patches, side.fingerprint)
        self.rows = plane_rows(header, side.harmonics, np.diff(mesh.patches).tolist())
        self.reconstruction = Reconstruction(header, mesh, edges, masses, components, patches, self.rows)
        self.clip = Clip(header, mesh)

    def _group(self, payload: bytes, reader: ByteReader) -> None:
        """spec.md 6; an open group's records follow the packet."""
        group = parse_group(payload, self.header, self.limits)
        before = len(self.clip.frames)
        require(group.first_frame == before, 66, f"a group from frame {group.first_frame}, not {before}")
        decoder = GroupDecoder(self.header, self.rows)
        if group.is_open:
            self._output(self._open_frames(decoder, reader))
        else:
            values = group.frames * self.rows.coefficients()
            require(values <= self.limits.group_values, 63, f"a group of {values} coefficients")
            code = RangeDecoder(group.code, rule=56)
            coded = [decoder.decode_frame(code, slot) for slot in group_structure(group.frames, group.pyramid)]
            code.finish()
            self._output(sorted(coded, key=lambda frame: frame.display))
        self.group_frames.append(len(self.clip.frames) - before)

    def _open_frames(self, decoder: GroupDecoder, reader: ByteReader) -> Iterator[CodedFrame]:
        """spec.md 3.1 and 6.2: "In an open group each frame is a range code of its own"."""
        for index, frame in enumerate(read_records(reader, self.limits)):
            require(len(self.clip.frames) + 1 < 2**32, 49, "2^32 frames or more")
            code = RangeDecoder(frame, rule=56)
            coded = decoder.decode_frame(code, chain_slot(index))
            code.finish()
            yield coded

    def _output(self, frames: Iterator[CodedFrame] | list[CodedFrame]) -> None:
        """The frames of a group, in display order."""
        for coded in frames:
            self.clip.coefficients_crc32 = zlib.crc32(coded.checked_bytes(), self.clip.coefficients_crc32)
            self.clip.frames.append(self.reconstruction.frame(coded))

    def _end(self, payload: bytes, begin: int, behind: int) -> None:
        """spec.md 3.2: the number of frames and, if there is one, the index; the packet is the bytes from `begin` to
        before `behind`."""
        end = parse_end(payload, behind - begin)
        require(end.frames == len(self.clip.frames), 59, f"{len(self.clip.frames)} frames, {end.frames} expected")
        index = index_of_groups(self.group_begins, self.group_frames, begin)
        require(end.index is None or end.index == index, 67, "the index is not that of the stream")


def decode_stream(data: bytes, limits: Limits = Limits()) -> Clip:
    """Decodes a whole stream; raises StreamError if it breaks a rule of spec.md 11 or exceeds the limits."""
    return StreamDecoder(limits).decode(data)
