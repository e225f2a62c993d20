# SPDX-License-Identifier: Apache-2.0
"""Writes frames as Wavefront OBJ files."""

from pathlib import Path

import numpy as np

from .stream import Clip


def _lines(keyword: str, rows: np.ndarray) -> list[str]:
    # Nine digits tell every binary32 apart; this is the one rounding of spec.md 8.
    return [" ".join([keyword, *(f"{x:.9g}" for x in row)]) for row in rows.astype(np.float32).tolist()]


def _faces(clip: Clip) -> list[str]:
    corners = (clip.mesh.triangles + 1).tolist()
    if clip.mesh.uv_triangles is None:
        return ["f %d %d %d" % tuple(corner) for corner in corners]
    uvs = (clip.mesh.uv_triangles + 1).tolist()
    return ["f %d/%d %d/%d %d/%d" % tuple(sum(zip(a, b), ())) for a, b in zip(corners, uvs)]


def write_frames(clip: Clip, directory: Path) -> None:
    """frame_0000.obj and so on, vertices by their final numbers (spec.md 5.3). Normals are the first frame's, so only
    that one has them."""
    directory.mkdir(parents=True, exist_ok=True)
    still = [] if clip.mesh.uvs is None else _lines("vt", clip.mesh.uvs)
    faces = _faces(clip)
    for index, positions in enumerate(clip.frames):
        normals = _lines("vn", clip.mesh.normals) if index == 0 and clip.mesh.normals is not None else []
        text = "\n".join([*_lines("v", positions), *still, *normals, *faces]) + "\n"
        (directory / f"frame_{index:04d}.obj").write_text(text)
