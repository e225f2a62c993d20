# SPDX-License-Identifier: Apache-2.0
"""Encoding of whole clips, with targets."""

from __future__ import annotations

import ctypes
import os
import tempfile
import warnings
from typing import Callable, Dict, Iterable, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from . import errors
from ._arrays import position_array
from ._input import MeshInput, Rate, encoder_settings
from ._library import NEXT, PROGRESS, REWIND, SINK, ClipDetails, ClipResult, FrameSource, lib
from .clip import Clip
from .measure import Distortion


class Encoding:
    """What an encoding came to."""

    def __init__(self, data: Optional[bytes], result: ClipResult, details: ClipDetails, order, offset, measured: bool):
        self.data: Optional[bytes] = data  #: the stream; None where it went to a file
        self.bytes: int = result.bytes  #: of the stream
        self.frames: int = result.frames
        self.trials: int = result.trials  #: trial encodings, for targets and for the shape of the mesh
        self.bpvf: float = result.bpvf  #: bits a vertex and frame
        #: the distortion of what a decoder shows; None where it was not measured
        self.distortion: Optional[Distortion] = None
        if measured:
            self.distortion = Distortion(
                result.kg,
                result.sted,
                details.sted_spatial,
                details.sted_temporal,
                result.max_error,
                details.seam_gap,
                result.frames,
            )
        #: bytes of the stream by what they say
        self.parts: Dict[str, float] = {name: getattr(result.parts, name) for name, _ in result.parts._fields_}
        self.order: np.ndarray = order  #: (vertices,): per decoded vertex its index in the input
        self.offset: np.ndarray = offset  #: (3,): what to add to decoded positions for the input's coordinates

    @property
    def kg(self) -> Optional[float]:
        """Percent; None where it was not measured."""
        return self.distortion.kg if self.distortion else None

    @property
    def sted(self) -> Optional[float]:
        """None where it was not measured."""
        return self.distortion.sted if self.distortion else None

    @property
    def max_error(self) -> Optional[float]:
        """Model units; None where it was not measured."""
        return self.distortion.max_error if self.distortion else None

    def __repr__(self) -> str:
        measured = f", KG {self.kg:.4g} %, STED {self.sted:.4g}" if self.distortion else ""
        return f"<sac.Encoding of {self.frames} frames: {self.bytes} bytes, {self.bpvf:.4g} bpvf{measured}>"


class _Calls:
    """The functions that the library calls back; the first exception in one of them ends the encoding."""

    def __init__(self, frames, mesh: MeshInput, progress, sink):
        self.error: Optional[BaseException] = None
        self._frames, self._mesh, self._progress, self._sink = frames, mesh, progress, sink
        self._iterator = iter(frames)
        self._number = 0
        self.source = FrameSource(None, NEXT(self._guard(self._next)), REWIND(self._guard(self._rewind)))
        self.sink = SINK(self._guard(self._write))
        self.progress = PROGRESS(self._guard(self._tell) if progress else 0)

    def _guard(self, function):
        def call(_user, *arguments):
            try:
                return function(*arguments) or 0
            except BaseException as error:  # pylint: disable=broad-except  # it goes on in encode()
                self.error = error
                return 1

        return call

    def _next(self, positions, end):
        frame = next(self._iterator, None)
        if frame is None:
            end[0] = 1
            return
        vertices = self._mesh.vertices
        given = self._mesh.relative(position_like(frame, vertices, f"frame {self._number}"))
        self._number += 1
        if vertices:
            np.ctypeslib.as_array(positions, (vertices, 3))[...] = given

    def _rewind(self):
        self._iterator, self._number = iter(self._frames), 0

    def _write(self, data, size):
        self._sink(ctypes.string_at(data, size))

    def _tell(self, trial, frames):
        return 1 if self._progress(trial, frames) is False else 0


def position_like(frame, vertices: int, name: str) -> np.ndarray:
    """A frame of the clip, (vertices, 3), of float32 or, where the input is, of float64."""
    array = np.asarray(frame)
    return (
        array if array.dtype == np.float64 and array.shape == (vertices, 3) else position_array(array, vertices, name)
    )


def encode(
    faces: ArrayLike,
    frames: Union[np.ndarray, Clip, Iterable[ArrayLike]],
    path: Union[str, "os.PathLike[str]", None] = None,
    *,
    fps: Rate = None,
    quality: Optional[float] = None,
    target_kg: Optional[float] = None,
    target_sted: Optional[float] = None,
    target_bpvf: Optional[float] = None,
    max_error: Optional[float] = None,
    keep_order: bool = False,
    uvs: Optional[ArrayLike] = None,
    uv_faces: Optional[ArrayLike] = None,
    normals: Optional[ArrayLike] = None,
    normal_faces: Optional[ArrayLike] = None,
    colors: Optional[ArrayLike] = None,
    offset: Optional[ArrayLike] = None,
    measure: bool = True,
    progress: Optional[Callable[[int, int], Optional[bool]]] = None,
    **settings: Union[None, float, str],
) -> Encoding:
    """Encodes a clip: ``sac.encode(faces, frames, "walk.sac", fps=30, target_sted=0.05)``.

    Args:
        faces: (triangles, 3) indices of vertices.
        frames: (frames, vertices, 3) positions in model units, or a sequence of (vertices, 3), or a :class:`Clip`. It is
            read several times; an iterator, which can be read once, is held in memory. float64 is rounded to float32,
            relative to ``offset`` where that is needed to keep them exact.
        path: the file to write, which is there only when it is complete; None: ``Encoding.data`` has the stream.
        fps: frames per second: a number, a fraction, or (numerator, denominator).
        quality: 0 (smallest) to 100 (nearest to the input); 50 by default.
        target_kg, target_sted: find the smallest stream with at most this KG (percent) or STED.
        target_bpvf: find the best quality within so many bits a vertex and frame.
        max_error: of any vertex in any frame, model units.
        keep_order: whether the stream holds the order of the vertices (``Clip.order``); else ``Encoding.order`` has it.
        uvs, uv_faces: (count, 2) texture coordinates and (triangles, 3) their indices; without ``uv_faces`` there is
            one for each vertex.
        normals, normal_faces: of the first frame, one for each vertex, or (count, 3) and (triangles, 3) indices of those
            of corners.
        colors: (vertices, 3 or 4) of uint8, or of floats from 0 to 1.
        offset: 3 numbers to take from all positions; chosen where they are float64 that float32 cannot hold.
        measure: whether to decode the stream and measure it; targets always do.
        progress: called as ``progress(trial, frames)`` between frames; the encoding ends when it returns False.
        settings: any other member of ``sac_encoder_settings``: ``group``, ``pyramid``, ``harmonics``, ``low_delay``,
            ``motion_step``, ``displacement_step``, ``detail_step``, ``position_bits``, ``reference_rounds``, ... and what the
            stream says of the clip: ``name``, ``json`` (texts), ``metres_per_unit``, ``up_axis`` (0, 1, 2: x, y, z),
            ``first_frame``, ``loops``, ``bounds`` (whether it holds the box of all frames); ``join=0`` codes
            vertices apart that coincide in all frames; ``threads``, how many groups are coded at the same time [as many
            as the machine has processors].

    Other threads run meanwhile, but for the moments in which a frame is fetched.

    Raises:
        InvalidArgumentError: arrays or settings that cannot be used, targets that cannot be met.
        LimitError: decoders would refuse the stream. CancelledError: ``progress`` returned False.

    Warns:
        LossWarning: texture coordinates or normals could not be coded.
    """
    if not isinstance(frames, np.ndarray) and iter(frames) is iter(frames):
        frames = list(frames)
    first = next(iter(frames), None)
    if first is None:
        raise errors.InvalidArgumentError("frames: there are none")
    mesh = MeshInput(faces, first, uvs, uv_faces, normals, normal_faces, colors, offset)
    given = dict(quality=quality, target_kg=target_kg, target_sted=target_sted, target_bpvf=target_bpvf)
    given.update(max_error=max_error, keep_order=keep_order, unmeasured=not measure, **settings)
    chosen = encoder_settings(given, fps, mesh.offset)
    with _Output(path) as output:
        calls = _Calls(frames, mesh, progress, output.write)
        chosen.progress = calls.progress
        result, order = ClipResult(), np.empty(mesh.vertices, np.uint32)
        details = ClipDetails(order=order.ctypes.data)
        status = lib.sac_encode_clip_details(
            ctypes.byref(mesh.struct),
            ctypes.byref(calls.source),
            ctypes.byref(chosen),
            calls.sink,
            None,
            ctypes.byref(result),
            ctypes.byref(details),
        )
        if calls.error is not None:
            raise calls.error
        errors.check(status, result.message)
        data = output.finish()
    for lost, what in ((details.lost_texture_coordinates, "texture coordinates"), (details.lost_normals, "normals")):
        if lost:
            warnings.warn(f"{what} of this mesh cannot be coded: the stream has none", errors.LossWarning, stacklevel=2)
    targets = any(target is not None for target in (target_kg, target_sted, target_bpvf))
    return Encoding(data, result, details, order, mesh.offset, measure or targets)


class _Output:
    """The bytes of a stream, in memory or in a file that takes its place when it is complete."""

    def __init__(self, path):
        self._path = None if path is None else os.fspath(path)
        self._parts = []
        self._file = None

    def __enter__(self):
        if self._path is not None:
            folder = os.path.dirname(self._path) or "."
            name = os.path.basename(self._path)
            self._file = tempfile.NamedTemporaryFile(dir=folder, prefix=f".{name}.", delete=False)
        return self

    def __exit__(self, *_):
        if self._file is not None:
            self._file.close()
            os.unlink(self._file.name)

    def write(self, data: bytes) -> None:
        if self._file is not None:
            self._file.write(data)
        else:
            self._parts.append(data)

    def finish(self) -> Optional[bytes]:
        if self._file is None:
            return b"".join(self._parts)
        self._file.close()
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(self._file.name, 0o666 & ~mask)
        os.replace(self._file.name, self._path)
        self._file = None
        return None
