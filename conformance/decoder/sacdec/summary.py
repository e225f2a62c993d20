# SPDX-License-Identifier: Apache-2.0
"""What conformance/manifest.json says of a stream, from a decoded clip."""

import zlib

import numpy as np

from .segment import Segment
from .stream import Clip


def words_crc32(values) -> str:
    """The CRC-32 of integers, 4 bytes each, little-endian, as eight hexadecimal digits."""
    return f"{zlib.crc32(np.asarray(values, np.int64).astype('<u4').tobytes()):08x}"


def summary(clip: Clip) -> dict:
    """The integers of a clip by the keys of conformance/README.md, without positions."""
    mesh = clip.mesh
    result = {
        "frames": len(clip.frames),
        "vertices": len(mesh.vertex_of_copy),
        "triangles": len(mesh.triangles),
        "triangles_crc32": words_crc32(mesh.copy_triangles),
        "coefficients_crc32": f"{clip.coefficients_crc32:08x}",
    }
    if len(clip.segments) > 1:
        result["segments"] = [[segment.first_frame, len(segment.mesh.vertex_of_copy)] for segment in clip.segments]
    if any(clip.header.offset):
        result["offset"] = list(clip.header.offset)
    if mesh.uvs is not None:
        result["uvs"] = len(mesh.uvs)
        result["uv_triangles_crc32"] = words_crc32(mesh.uv_triangles)
    if mesh.normals is not None:
        result["normals"] = len(mesh.normals)
    if mesh.normal_triangles is not None:
        result["normal_triangles_crc32"] = words_crc32(mesh.normal_triangles)
    if mesh.colors is not None:
        result["colors_crc32"] = words_crc32(mesh.colors)
    if mesh.order is not None:
        result["order_crc32"] = words_crc32(mesh.order)
    return result


def tolerance(segment: Segment, vertices: np.ndarray, coordinates: np.ndarray) -> np.ndarray:
    """How far coordinates [.., n, 3] of these vertices [n], by their final numbers, that were rounded to binary32 may be
    from this decoder's: spec.md 8."""
    mesh = segment.mesh
    components = np.searchsorted(mesh.components, mesh.vertex_of_copy[vertices], side="right") - 1
    near = 1e-6 * max(segment.first_diagonal(), segment.header.cell) / 2.0 ** mesh.scales[components]
    exact = np.maximum(near, 1e-12 * np.abs(coordinates).max(initial=0))
    return exact[:, None] + 2.0**-24 * np.abs(coordinates)
