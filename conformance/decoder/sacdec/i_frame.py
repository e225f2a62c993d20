# SPDX-License-Identifier: Apache-2.0
"""The parts of the I-frame and its side information: spec.md 5 and 5.2."""

import struct
from dataclasses import dataclass

from .byte_reader import ByteReader
from .errors import require
from .range_coder import RangeDecoder, SignedModels, UnsignedModels
from .sequence_header import SequenceHeader


def split_i_frame(payload: bytes) -> tuple[bytes, RangeDecoder]:
    """spec.md 5, the table: the mesh and the range code after it."""
    reader = ByteReader(payload, end_rule=24, varint_rule=24)
    mesh = reader.bytes(reader.varint())
    return mesh, RangeDecoder(reader.rest(), rule=30)


@dataclass
class LooseVertex:
    """A vertex of none of Draco's triangles: spec.md 5.2."""

    position: tuple[int, int, int]
    normal: tuple[float, ...] | None
    color: tuple[int, ...] | None


@dataclass
class SideInformation:
    """spec.md 5.2. `order` is None unless the author's order is kept; welds are pairs (point, onto)."""

    position_step: int
    position_slope: int
    welds: list[tuple[int, int]]
    has_normals: int
    has_colors: int
    loose_vertices: list[LooseVertex]
    loose_triangles: list[tuple[int, ...]]
    harmonics: list[int]
    scales: list[int]
    part_origins: list[tuple[int, int, int]]
    handles_per_harmonic: int
    fingerprint: tuple[float, float]
    order: list[int] | None


def _raw_f32(decoder: RangeDecoder) -> float:
    return struct.unpack("<f", struct.pack("<I", decoder.raw(32)))[0]


def _welds(decoder: RangeDecoder, header: SequenceHeader) -> list[tuple[int, int]]:
    """spec.md 5.2, "Welds"."""
    count = UnsignedModels().decode(decoder)
    require(count <= 3 * header.triangles, 25, f"{count} welds")
    skip, distance = UnsignedModels(), UnsignedModels()
    welds = []
    following = 1
    for _ in range(count):
        point = following + skip.decode(decoder)
        require(point < 3 * header.triangles, 25, f"a weld of entry {point}")
        weld_distance = distance.decode(decoder)
        require(weld_distance < point, 25, "a weld onto nothing")
        welds.append((point, point - 1 - weld_distance))
        following = point + 1
    return welds


def _loose_vertices(
    decoder: RangeDecoder, header: SequenceHeader, has_normals: int, has_colors: int
) -> list[LooseVertex]:
    """spec.md 5.2, "Loose vertices"."""
    count = UnsignedModels().decode(decoder)
    require(count <= header.vertices, 26, f"{count} loose vertices")
    models = [SignedModels(), SignedModels(), SignedModels()]
    position = [0, 0, 0]
    vertices = []
    for _ in range(count):
        for axis in range(3):
            position[axis] += models[axis].decode(decoder)
            require(0 <= position[axis] < 2**header.position_bits, 26, "a loose vertex off the grid")
        normal = tuple(_raw_f32(decoder) for _ in range(3)) if has_normals else None
        color = tuple(decoder.raw(8) for _ in range(4)) if has_colors else None
        vertices.append(LooseVertex((position[0], position[1], position[2]), normal, color))
    return vertices


def _loose_triangles(decoder: RangeDecoder, header: SequenceHeader) -> list[tuple[int, ...]]:
    """spec.md 5.2, "Loose triangles"."""
    count = UnsignedModels().decode(decoder)
    require(count <= header.triangles, 27, f"{count} loose triangles")
    difference = SignedModels()
    corner = 0
    triangles = []
    for _ in range(count):
        corners = []
        for _ in range(3):
            corner += difference.decode(decoder)
            require(0 <= corner < header.vertices, 27, "a corner that is no vertex")
            corners.append(corner)
        triangles.append(tuple(corners))
    return triangles


def _harmonics(decoder: RangeDecoder, header: SequenceHeader) -> list[int]:
    """spec.md 5.2, "Harmonics per component"."""
    count = UnsignedModels().decode(decoder)
    require(count <= header.vertices, 28, f"{count} components")
    difference = SignedModels()
    harmonics: list[int] = []
    previous = header.harmonics
    for _ in range(count):
        previous += difference.decode(decoder)
        require(1 <= previous <= header.harmonics, 28, f"a component of {previous} harmonics")
        harmonics.append(previous)
    require(sum(harmonics) == header.harmonics, 28, "the components' harmonics do not add up")
    return harmonics


def _scales(decoder: RangeDecoder, header: SequenceHeader, components: int) -> tuple[list[int], list]:
    """spec.md 5.2, "Scales": s and p of each component."""
    scales, origins = [0] * components, [(0, 0, 0)] * components
    if not decoder.raw(1):
        return scales, origins
    models = UnsignedModels()
    for component in range(components):
        scales[component] = models.decode(decoder)
        require(scales[component] <= 20, 76, f"a scale of {scales[component]}")
        if scales[component]:
            origins[component] = tuple(decoder.raw(header.position_bits) for _ in range(3))
    return scales, origins


def _order(decoder: RangeDecoder, header: SequenceHeader) -> list[int]:
    """spec.md 5.2, "Order"."""
    difference = SignedModels()
    order: list[int] = []
    seen = set()
    count = header.vertices + header.copies
    for _ in range(count):
        expected = order[-1] + 1 if order else 0
        if expected == count:
            expected = 0
        index = expected + difference.decode(decoder)
        require(0 <= index < count and index not in seen, 29, "the order is no permutation")
        seen.add(index)
        order.append(index)
    return order


def parse_side_information(decoder: RangeDecoder, header: SequenceHeader, has_mesh: bool) -> SideInformation:
    """spec.md 5.2. Every row of its table has models of its own, all fresh."""
    position_step = UnsignedModels().decode(decoder) if has_mesh else 0
    position_slope = UnsignedModels().decode(decoder) if has_mesh else 0
    welds = _welds(decoder, header)
    has_normals = decoder.raw(1)
    has_colors = decoder.raw(1)
    loose_vertices = _loose_vertices(decoder, header, has_normals, has_colors)
    loose_triangles = _loose_triangles(decoder, header)
    harmonics = _harmonics(decoder, header)
    scales, part_origins = _scales(decoder, header, len(harmonics))
    handles_per_harmonic = UnsignedModels().decode(decoder)
    fingerprint = (_raw_f32(decoder), _raw_f32(decoder))
    order = _order(decoder, header) if decoder.raw(1) else None
    return SideInformation(
        position_step,
        position_slope,
        welds,
        has_normals,
        has_colors,
        loose_vertices,
        loose_triangles,
        harmonics,
        scales,
        part_origins,
        handles_per_harmonic,
        fingerprint,
        order,
    )
