# SPDX-License-Identifier: Apache-2.0
"""Draco's part of the I-frame: spec.md 5.1. The bytes are decoded by Draco itself, through `draco_corners`."""

import json
import os
import shutil
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from .byte_reader import ByteReader
from .errors import require

POSITION, NORMAL, COLOR, TEX_COORD, GENERIC = range(5)
INT32, UINT8, FLOAT32 = 5, 2, 9
# spec.md 5.1, "Attributes": Draco's att_type, its data_type and components.
WANTED = {POSITION: (INT32, 3), NORMAL: (FLOAT32, 3), COLOR: (UINT8, 4), TEX_COORD: (FLOAT32, 2)}


@dataclass
class DracoMesh:
    """Entries and triangles of spec.md 5.1; no entries and no triangles if there is no Draco mesh.

    `triangles` [m, 3] are entries. `normals` [m, 3, 3] and `colors` [m, 3, 4], those of the corners, with the indices of
    their values `normal_indices` and `color_indices` [m, 3], `uvs` [values, 2] and `uv_triangles` [m, 3] are None if the
    mesh has none.
    """

    entries: int = 0
    triangles: np.ndarray = field(default_factory=lambda: np.zeros((0, 3), np.int64))
    normals: np.ndarray | None = None
    normal_indices: np.ndarray | None = None
    colors: np.ndarray | None = None
    color_indices: np.ndarray | None = None
    uvs: np.ndarray | None = None
    uv_triangles: np.ndarray | None = None


def draco_corners_command() -> Path:
    """The helper that is built with sac's tests: $DRACO_CORNERS, or one in PATH, or the newest in build/."""
    if given := os.environ.get("DRACO_CORNERS"):
        return Path(given)
    if found := shutil.which("draco_corners"):
        return Path(found)
    built = (Path(__file__).parents[3] / "build").glob("*/tests/draco_corners")
    for path in sorted(built, key=lambda path: path.stat().st_mtime, reverse=True):
        return path
    raise FileNotFoundError("draco_corners is not built: cmake --build BUILD --target draco_corners")


def _check_header(data: bytes, triangles: int) -> None:
    """spec.md 5.1, the beginning of `mesh`, checked before Draco allocates for it (spec.md 10)."""
    reader = ByteReader(data, end_rule=32, varint_rule=32)
    # "DRACO", version 2.2, TRIANGULAR_MESH, MESH_EDGEBREAKER_ENCODING, flags 0
    beginning = b"DRACO" + bytes([2, 2, 1, 1, 0, 0])
    require(data[: len(beginning)] == beginning[: len(data)], 31, "not a Draco mesh of the kind that sac uses")
    reader.bytes(len(beginning))
    reader.u8()  # edgebreaker_traversal_type
    vertices = reader.varint()
    faces = reader.varint()
    require(faces <= triangles, 32, f"Draco says {faces} triangles")
    require(vertices <= 3 * faces, 32, f"Draco says {vertices} vertices")
    require(reader.u8() <= 3, 32, "Draco says more attributes than there are kinds")


def _run_draco(data: bytes) -> dict:
    done = subprocess.run([draco_corners_command()], input=data, capture_output=True, timeout=300, check=False)
    message = done.stderr.decode(errors="replace").strip()
    require(done.returncode != 3, 33, message)
    if done.returncode != 0:
        raise RuntimeError(f"draco_corners ended with {done.returncode}: {message}")
    return json.loads(done.stdout)


def _corner_indices(attribute: dict, points: np.ndarray) -> np.ndarray:
    """The index of each corner's value."""
    indices = np.array(attribute["indices"], np.int64)[points].reshape(-1, 3)
    require(not np.any(indices >= len(attribute["values"])), 36, "a corner without a value")
    return indices


def _floats(attribute: dict) -> np.ndarray:
    bits = np.array(attribute["values"], np.uint32).reshape(-1, attribute["components"])
    return bits.view(np.float32)


def decode_draco_mesh(data: bytes, triangles: int) -> DracoMesh:
    """spec.md 5.1; `triangles` is that of the sequence header. The rules are R31 to R34 and R36."""
    if not data:
        return DracoMesh()
    _check_header(data, triangles)
    decoded = _run_draco(data)
    require(decoded["remaining"] == 0, 33, "bytes follow Draco's mesh")

    attributes: dict[int, dict] = {}
    for attribute in decoded["attributes"]:
        kind = attribute["type"]
        require(kind != GENERIC, 36, "a GENERIC attribute")
        if kind not in WANTED:
            continue
        form = (attribute["data_type"], attribute["components"])
        if kind not in attributes:
            require(form == WANTED[kind], 34 if kind == POSITION else 36, f"an attribute {kind} of type {form}")
            attributes[kind] = attribute
    require(POSITION in attributes, 34, "Draco's mesh has no positions")

    points = np.array(decoded["faces"], np.int64).reshape(-1, 3)
    mesh = DracoMesh(
        entries=len(attributes[POSITION]["values"]), triangles=_corner_indices(attributes[POSITION], points)
    )
    if normals := attributes.get(NORMAL):
        mesh.normal_indices = _corner_indices(normals, points)
        mesh.normals = _floats(normals)[mesh.normal_indices]
    if colors := attributes.get(COLOR):
        mesh.color_indices = _corner_indices(colors, points)
        mesh.colors = np.array(colors["values"], np.uint8).reshape(-1, 4)[mesh.color_indices]
    if uvs := attributes.get(TEX_COORD):
        mesh.uvs = _floats(uvs)
        mesh.uv_triangles = _corner_indices(uvs, points)
    return mesh
