# SPDX-License-Identifier: Apache-2.0
"""Writes frames as Wavefront OBJ files."""

from pathlib import Path

import numpy as np

from .stream import Clip


def _lines(keyword: str, rows: np.ndarray) -> list[str]:
    # Nine digits tell every binary32 apart; this is the one rounding of spec.md 8.
    return [" ".join([keyword, *(f"{x:.9g}" for x in row)]) for row in rows.astype(np.float32).tolist()]


def _faces(clip: Clip, with_normals: bool) -> list[str]:
    mesh = clip.mesh
    normals = mesh.triangles if mesh.normal_triangles is None else mesh.normal_triangles
    columns = [mesh.triangles]
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
    """frame_0000.obj and so on, vertices by their final numbers (spec.md 5.3), without the offset. Normals are the first
    frame's, so only that one has them."""
    directory.mkdir(parents=True, exist_ok=True)
    still = [] if clip.mesh.uvs is None else _lines("vt", clip.mesh.uvs)
    for index, positions in enumerate(clip.frames):
        with_normals = index == 0 and clip.mesh.normals is not None
        normals = _lines("vn", clip.mesh.normals) if with_normals else []
        text = "\n".join([*_lines("v", positions), *still, *normals, *_faces(clip, with_normals)]) + "\n"
        (directory / f"frame_{index:04d}.obj").write_text(text)
