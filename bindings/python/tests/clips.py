# SPDX-License-Identifier: Apache-2.0
"""Clips to test with, and where the streams of the conformance tests are."""

import pathlib

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[3]
VALID = ROOT / "conformance" / "valid"


def waving_sheet(frames=20, side=8, dtype=np.float32):
    """Faces (triangles, 3) and frames (frames, vertices, 3) of a square sheet that waves; width 1."""
    u, v = np.meshgrid(np.linspace(0, 1, side), np.linspace(0, 1, side), indexing="ij")
    corner = np.arange(side * side).reshape(side, side)
    a, b, c, d = corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]
    faces = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    time = np.arange(frames)[:, None, None]
    wave = 0.2 * np.sin(2 * u + 3 * v + 0.3 * time)
    positions = np.stack([np.broadcast_to(u, wave.shape), np.broadcast_to(v, wave.shape), wave], -1)
    return faces, positions.reshape(frames, -1, 3).astype(dtype)


def sheet_uvs(side=8):
    """A texture coordinate for each vertex of the sheet."""
    u, v = np.meshgrid(np.linspace(0, 1, side), np.linspace(0, 1, side), indexing="ij")
    return np.stack([u, v], -1).reshape(-1, 2)
