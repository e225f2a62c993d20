# SPDX-License-Identifier: Apache-2.0
"""The sequence header: spec.md 4."""

import math
from dataclasses import dataclass

from .byte_reader import ByteReader
from .errors import require
from .limits import Limits

VERSION = (0, 9)


@dataclass(frozen=True)
class SequenceHeader:
    """The elements of spec.md 4, by their names there."""

    reference_shape: int
    position_bits: int
    level_growth: int
    vertices: int
    copies: int
    triangles: int
    harmonics: int
    patch_size: int
    frame_rate_numerator: int
    frame_rate_denominator: int
    origin: tuple[float, float, float]
    cell: float
    motion_step: float
    displacement_step: float
    detail_step: float
    correction_step: float
    rotation_step: float
    translation_step: float
    offset: tuple[float, float, float]


def parse_sequence_header(payload: bytes, limits: Limits) -> SequenceHeader:
    """spec.md 4, in the order of the table there; the rules are R11 to R23, R61, R62, R68 and R74."""
    reader = ByteReader(payload, end_rule=12, varint_rule=12)
    version = (reader.u8(), reader.u8())
    require(version == VERSION, 11, "version %d.%d" % version)
    header = SequenceHeader(
        reference_shape=reader.u8(),
        position_bits=reader.u8(),
        level_growth=reader.u8(),
        vertices=reader.varint(),
        copies=reader.varint(),
        triangles=reader.varint(),
        harmonics=reader.varint(),
        patch_size=reader.varint(),
        frame_rate_numerator=reader.varint(),
        frame_rate_denominator=reader.varint(),
        origin=(reader.f32(), reader.f32(), reader.f32()),
        cell=reader.f32(),
        motion_step=reader.f32(),
        displacement_step=reader.f32(),
        detail_step=reader.f32(),
        correction_step=reader.f32(),
        rotation_step=reader.f32(),
        translation_step=reader.f32(),
        offset=_offset(reader),
    )
    require(reader.remaining() == 0, 12, "bytes after the sequence header")
    _check(header, limits)
    return header


def _offset(reader: ByteReader) -> tuple[float, float, float]:
    """The last three elements, or three zeros where they are left out."""
    if reader.remaining() == 0:
        return (0.0, 0.0, 0.0)
    offset = (reader.f64(), reader.f64(), reader.f64())
    require(all(map(math.isfinite, offset)), 68, "the offset is not finite")
    require(any(x != 0 for x in offset), 68, "an offset of three zeros")
    return offset


def _check(header: SequenceHeader, limits: Limits) -> None:
    """The ranges of the table in spec.md 4."""
    require(header.reference_shape <= 1, 13, "reference_shape is above 1")
    require(1 <= header.position_bits <= 24, 14, "position_bits is not from 1 to 24")
    require(64 <= header.level_growth <= 128, 15, "level_growth is not from 64 to 128")
    require(header.vertices >= 1, 16, "no vertices")
    require(header.copies <= 3 * header.triangles, 74, f"{header.copies} copies")
    require(header.harmonics >= 1, 17, "no harmonics")
    require(header.harmonics <= header.vertices, 18, "more harmonics than vertices")
    require(1 <= header.patch_size <= 1024, 61, "patch_size is not from 1 to 1024")
    require(header.frame_rate_denominator >= 1, 19, "frame_rate_denominator is 0")
    require(all(map(math.isfinite, header.origin)), 20, "the origin is not finite")
    steps = (header.cell, header.motion_step, header.displacement_step, header.rotation_step, header.translation_step)
    for step in steps:
        require(math.isfinite(step) and step > 0, 21, "cell or a step is not finite or not above 0")
    for step in (header.detail_step, header.correction_step):
        require(math.isfinite(step) and step >= 0, 62, "detail_step or correction_step is not finite or below 0")
    given_out = header.vertices + header.copies
    require(given_out <= limits.vertices, 22, f"{given_out} vertices")
    require(header.triangles <= limits.triangles, 23, f"{header.triangles} triangles")
