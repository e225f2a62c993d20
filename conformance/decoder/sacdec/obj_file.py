# SPDX-License-Identifier: Apache-2.0
"""Writes frames as Wavefront OBJ files."""

from pathlib import Path

import numpy as np

from .stream import Clip
from .vertices import Mesh


def _lines(keyword: str, rows: np.ndarray) -> list[str]:
    # Nine digits tell every binary32 apart; this is the one rounding of spec.md 8.
    return [" ".join([keyword, *(f"{x:.9g}" for x in row)]) for row in rows.astype(np.float32).tolist()]


def _faces(mesh: Mesh, with_normals: bool) -> list[str]:
    normals = mesh.copy_triangles if mesh.normal_triangles is None else mesh.normal_triangles
    columns = [mesh.copy_triangles]
    pattern = "%d"
    if mesh.uv_triangles is not None:
        columns.append(mesh.uv_triangles)
        pattern += "/%d"
    if with_normals:
        columns.append(normals)
        pattern += "/%d" if mesh.uv_triangles is not None else "//%d"
    line = "f " + " ".join([pattern] * 3)
    return [line % tuple(corners) for corners in (np.stack(columns, 2) + 1).reshape(-1, 3 * len(columns)).tolist()]


def write_frames(clip: Clip, directory: Path) -> None:
    """frame_0000.obj and so on, vertices by their final numbers (spec.md 5.3), without the offset. Normals are those of
    the first frame of a segment, so only that one has them."""
    directory.mkdir(parents=True, exist_ok=True)
    for segment in clip.segments:
        mesh = segment.mesh
        still = [] if mesh.uvs is None else _lines("vt", mesh.uvs)
        for index, positions in enumerate(segment.frames):
            with_normals = index == 0 and mesh.normals is not None
            normals = _lines("vn", mesh.normals) if with_normals else []
            text = "\n".join([*_lines("v", positions), *still, *normals, *_faces(mesh, with_normals)]) + "\n"
            (directory / f"frame_{segment.first_frame + index:04d}.obj").write_text(text)
