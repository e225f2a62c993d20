# SPDX-License-Identifier: Apache-2.0
"""A segment: spec.md 3, "A start", and what its I-frame gives, once for all of its frames (5, 6.4)."""

from dataclasses import dataclass, field

import numpy as np

from . import harmonics
from .copies import decode_copies
from .draco_mesh import decode_draco_mesh
from .group import CodedFrame, plane_rows
from .i_frame import SideInformation, parse_side_information, split_i_frame
from .limits import Limits
from .positions import PositionDecoder
from .reconstruction import Reconstruction, first_shape
from .sequence_header import SequenceHeader
from .shape import edge_weights, mesh_edges, vertex_masses
from .vertices import Joined, Mesh, all_triangles, build_mesh, check_parts, join_entries


@dataclass
class Segment:
    """Frames that share a mesh: positions of its copies [.., 3] in display order, the first is frame `first_frame` of the clip."""

    header: SequenceHeader
    mesh: Mesh
    first_frame: int
    frames: list[np.ndarray] = field(default_factory=list)

    def first_diagonal(self) -> float:
        """The diagonal of the bounding box of M'0, in model units (spec.md 8)."""
        shape = first_shape(self.header, self.mesh)
        return float(np.linalg.norm(shape.max(axis=0) - shape.min(axis=0)))


class SegmentDecoder:
    """What is derived from a segment's start, and its frames so far."""

    def __init__(self, header: SequenceHeader, i_frame: bytes, limits: Limits, first_frame: int) -> None:
        """`i_frame` is the I-frame's payload, `first_frame` the number of frames before the segment."""
        mesh, side = _decode_mesh(header, i_frame)
        shape = first_shape(header, mesh)
        edges = mesh_edges(mesh.triangles)
        weights = edge_weights(edges, mesh.triangles, shape)
        masses = vertex_masses(mesh.triangles, shape)
        blends, components = harmonics.component_harmonics(
            mesh, edges, weights, masses, shape, side, header, limits, len(i_frame)
        )
        patches = harmonics.patch_harmonics(mesh, edges, weights) if header.detail_step > 0 else []
        harmonics.check_fingerprint(components, patches, side.fingerprint)
        self.rows = plane_rows(header, side.harmonics, np.diff(mesh.patches).tolist())
        self.reconstruction = Reconstruction(header, mesh, edges, masses, blends, components, patches, self.rows)
        self.segment = Segment(header, mesh, first_frame)

    def output(self, coded: CodedFrame) -> None:
        """The next frame in display order."""
        self.segment.frames.append(self.reconstruction.frame(coded))


def _decode_mesh(header: SequenceHeader, i_frame: bytes) -> tuple[Mesh, SideInformation]:
    """spec.md 5, the parts of the I-frame in the order that it says."""
    mesh_bytes, decoder = split_i_frame(i_frame)
    side = parse_side_information(decoder, header, len(mesh_bytes) > 0)
    draco = decode_draco_mesh(mesh_bytes, header.triangles)
    vertex, count = join_entries(draco.entries, side.welds)
    coded = np.zeros((0, 3), np.int64)
    if mesh_bytes:
        coding = PositionDecoder(decoder, header.position_bits, side.position_step, side.position_slope)
        coded = coding.decode(count, vertex[draco.triangles].reshape(-1, 3))
    triangles = all_triangles(draco, vertex, side)
    check_parts(draco, side, count + len(side.loose_vertices), len(triangles), header)
    copies, counts = np.zeros_like(triangles), np.ones(header.vertices, np.int64)
    if header.copies:
        copies, counts = decode_copies(decoder, draco, triangles, header.vertices, header.copies)
    decoder.finish()
    return build_mesh(draco, Joined(coded, triangles, copies, counts), side, header.patch_size), side
