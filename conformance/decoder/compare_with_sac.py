#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Decodes streams with this decoder and with the sac command and compares triangles and positions, by the tolerance of spec.md 8.

Exit code 1 if a stream is decoded differently.
"""

import argparse
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from sacdec.errors import StreamError
from sacdec.stream import Clip, decode_stream
from sacdec.summary import tolerance

CACHE_HEADER = struct.Struct("<12siiffi")  # PC2: "POINTCACHE2", version, points, start, rate, samples


def sac_decode(sac: str, stream: Path) -> tuple[np.ndarray, np.ndarray]:
    """What `sac decode` gives: positions [frames, n, 3], binary32, and triangles [m, 3]."""
    with tempfile.TemporaryDirectory() as directory:
        cache = Path(directory) / "clip.pc2"
        subprocess.run([sac, "decode", stream, "-o", cache], check=True, capture_output=True, text=True)
        data = cache.read_bytes()
        faces = [line for line in cache.with_suffix(".obj").read_text().splitlines() if line.startswith("f ")]
    _, _, points, _, _, samples = CACHE_HEADER.unpack_from(data)
    triangles = [[int(corner.split("/")[0]) - 1 for corner in face.split()[1:]] for face in faces]
    positions = np.frombuffer(data, "<f4", offset=CACHE_HEADER.size).reshape(samples, points, 3)
    return positions, np.array(triangles, np.int64).reshape(-1, 3)


def own_decode(clip: Clip) -> tuple[np.ndarray, np.ndarray]:
    """This decoder's, in the author's order if the stream keeps that, as `sac decode` gives them."""
    mesh = clip.mesh
    positions = np.array(clip.frames).reshape(-1, len(mesh.vertex_of_copy), 3)
    if mesh.order is None:
        return positions, mesh.copy_triangles
    return positions[:, np.argsort(mesh.order)], np.array(mesh.order)[mesh.copy_triangles]


def compare(sac: str, stream: Path) -> bool:
    """Whether both decoders agree; prints by how much."""
    begin = time.perf_counter()
    try:
        clip = decode_stream(stream.read_bytes())
        seconds = time.perf_counter() - begin
        theirs, their_triangles = sac_decode(sac, stream)
    except StreamError as error:
        print(f"{stream}: refused here: {error}")
        return False
    except subprocess.CalledProcessError as error:
        print(f"{stream}: {error.stderr.strip()}")
        return False
    if len(clip.segments) > 1:
        print(f"{stream}: {len(clip.segments)} segments, which have no place in one file of positions")
        return False
    own, own_triangles = own_decode(clip)
    if own.shape != theirs.shape:
        print(f"{stream}: {own.shape[:2]} frames and vertices here, {theirs.shape[:2]} from sac")
        return False
    if not np.array_equal(own_triangles, their_triangles):
        print(f"{stream}: other triangles than from sac")
        return False
    away = np.abs(own - theirs)
    mesh = clip.mesh
    vertices = np.arange(own.shape[1]) if mesh.order is None else np.argsort(mesh.order)
    agrees = bool(np.all(away <= tolerance(clip.segments[0], vertices, theirs)))
    beyond_rounding = np.maximum(away - 2.0**-24 * np.abs(theirs), 0).max(initial=0)
    size = max(clip.segments[0].first_diagonal(), clip.header.cell)
    print(
        f"{stream}: {'the same' if agrees else 'DIFFERENT'}, {len(own)} frames, {own.shape[1]} vertices, "
        f"{len(clip.mesh.components) - 1} components, {beyond_rounding / size:.1e} diagonals apart, {seconds:.1f} s"
    )
    return agrees


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sac", default="sac", help="the sac command [sac]")
    parser.add_argument("streams", type=Path, nargs="+", metavar="STREAM")
    arguments = parser.parse_args()
    results = [compare(arguments.sac, stream) for stream in arguments.streams]
    return 0 if all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
