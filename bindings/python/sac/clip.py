# SPDX-License-Identifier: Apache-2.0
"""Reading of streams: a clip is a sequence of frames, decoded when they are asked for."""

from __future__ import annotations

import dataclasses
import fractions
import operator
import os
import threading
from typing import Any, BinaryIO, Dict, Iterator, List, Optional, Tuple, Union

import numpy as np

from . import errors
from ._decoder import Decoder, frame_buffers
from ._library import FrameBuffers

Source = Union[str, "os.PathLike[str]", bytes, bytearray, memoryview, BinaryIO]


@dataclasses.dataclass(frozen=True)
class Frame:
    """A decoded frame."""

    index: int  # in the clip, from 0
    time: float  # seconds from the clip's begin; 0 where the stream has no frame rate
    positions: np.ndarray  # (vertices, 3), float32, model units
    normals: Optional[np.ndarray]  # (vertices, 3), float32, of length 1; None where they were not asked for


class Clip:
    """An animated mesh, decoded frame by frame as it is asked for.

    ``clip[i]`` is the array (vertices, 3) of float32 that the decoder has written frame ``i`` into; ``clip[a:b:c]`` is
    one array (frames, vertices, 3). Going forward decodes each frame once; going to another group of frames reads that
    group's bytes, which takes some milliseconds. Nothing is kept of frames that were given out.

    Positions are in model units, in the stream's own order of vertices (but see ``order`` of :func:`open`), and relative
    to ``offset``. The mesh does not change: ``faces`` (triangles, 3); ``uvs`` (count, 2) and ``uv_faces`` (triangles, 3);
    ``normals`` of the first frame, (vertices, 3), or (count, 3) with ``normal_faces`` (triangles, 3) where corners have
    normals of their own; ``colors`` (vertices, 4), uint8; ``order`` (vertices,), per decoded vertex its index in the
    encoder's input. What a stream does not have is None. A clip may be used
    by several threads, which wait for each other; several clips of the same stream decode side by side.

    Every method that decodes raises :class:`CorruptError` for damage and :class:`LimitError` where memory is short.
    """

    def __init__(
        self,
        source: Source,
        *,
        order: Union[bool, np.ndarray] = False,
        threads: int = 1,
        skip_damage: bool = False,
        layers: Optional[int] = None,
        **limits: Union[int, float],
    ):
        data, self.name = _read(source)
        options: Dict[str, Union[int, float]] = {
            "threads": operator.index(threads),
            "skip_damage": int(bool(skip_damage)),
        }
        if layers is not None:
            options["layers"] = operator.index(layers)
            if not 0 < options["layers"] <= 0xFFFFFFFF:
                raise errors.InvalidArgumentError(f"{self.name}: {layers} layers cannot be decoded")
        for key, value in limits.items():
            if key not in _LIMITS:
                raise TypeError(f"open() has no argument {key!r}")
            options[key] = value
        try:
            self._decoder = Decoder(data, self.name, options)
        except TypeError as error:
            raise errors.InvalidArgumentError(f"{self.name}: a limit that is no number: {error}") from error
        self._lock = threading.RLock()
        self._frames: Optional[int] = None
        mesh, view = self._decoder.mesh, self._decoder.view
        self.vertices: int = mesh.vertices
        self.bytes: int = len(data)
        triangles = mesh.triangles
        faces = view(mesh.triangle_vertices, (triangles, 3), np.uint32)
        self.faces: np.ndarray = np.empty((0, 3), np.uint32) if faces is None else faces
        self.uvs: Optional[np.ndarray] = view(mesh.uv_values, (mesh.uvs, 2), np.float32)
        self.uv_faces: Optional[np.ndarray] = view(mesh.triangle_uvs, (triangles, 3), np.uint32)
        self.normals: Optional[np.ndarray] = view(mesh.normals, (mesh.vertices, 3), np.float32)
        self.normal_faces: Optional[np.ndarray] = None
        if self.normals is None:
            self.normals, self.normal_faces = self._decoder.corner_normals()
        self.colors: Optional[np.ndarray] = view(mesh.colors, (mesh.vertices, 4), np.uint8)
        self.order: Optional[np.ndarray] = view(mesh.order, (mesh.vertices,), np.uint32)
        self.offset: np.ndarray = self._decoder.offset()
        self._order = None if order is False else self._author_order(order)
        if self._order is not None:
            self._take_order(self._order)
        self.rate: Optional[fractions.Fraction] = None
        if mesh.frame_rate_numerator:
            self.rate = fractions.Fraction(mesh.frame_rate_numerator, mesh.frame_rate_denominator)

    @property
    def fps(self) -> Optional[float]:
        """Frames per second, None where the stream does not tell; ``rate`` is the same as a fraction."""
        return None if self.rate is None else float(self.rate)

    @property
    def duration(self) -> Optional[float]:
        """Seconds, None where the stream has no frame rate."""
        return None if self.rate is None else float(len(self) / self.rate)

    @property
    def metadata(self) -> Dict[str, Any]:
        """What the stream says of its clip, some of it at its end, which is read for this without decoding.

        Of ``name``, ``json`` (texts), ``metres_per_unit``, ``up_axis`` (0, 1, 2: x, y, z), ``first_frame``, ``loops`` and
        ``box`` (2, 3), the box of all frames in model units, those that the stream has.
        """
        with self._lock:
            try:
                len(self)
            except errors.Error:  # without its end, what came before it
                pass
            said = self._decoder.metadata()
            if said is None:
                return {}
            given: Dict[str, Any] = {"first_frame": said.first_frame}
            if said.name is not None:
                given["name"] = said.name.decode(errors="replace")
            if said.json is not None:
                given["json"] = said.json.decode(errors="replace")
            if said.metres_per_unit > 0:
                given["metres_per_unit"] = said.metres_per_unit
            if said.up_axis >= 0:
                given["up_axis"] = said.up_axis
            if said.loops >= 0:
                given["loops"] = bool(said.loops)
            if said.has_bounds:
                given["box"] = np.array([said.box_low, said.box_high])
            return given

    @property
    def layers(self) -> int:
        """The most layers that a group decoded so far may have: 1 without layers, 0 before the first frame."""
        with self._lock:
            return self._decoder.layers()

    @property
    def lost(self) -> List[range]:
        """The frames that damage has cost so far, with ``skip_damage``."""
        with self._lock:
            return self._decoder.lost()

    def __len__(self) -> int:
        """How many frames there are. A stream without an index is read to its end for this, without decoding."""
        with self._lock:
            if self._frames is None:
                self._frames = self._decoder.frames()
            return self._frames

    def __getitem__(self, key: Union[int, slice]) -> np.ndarray:
        """Frame ``key`` as (vertices, 3), or the frames of a slice as (frames, vertices, 3). IndexError beyond the end."""
        if isinstance(key, slice):
            numbers = range(*key.indices(len(self)))
            out = np.empty((len(numbers), self.vertices, 3), np.float32)
            # Forward, whatever the step: that reads each group of frames once.
            for i in sorted(range(len(numbers)), key=numbers.__getitem__):
                self.frame(numbers[i], out=out[i])
            return out
        return self.frame(key).positions

    def __iter__(self) -> Iterator[np.ndarray]:
        """The positions of all frames in order; with ``skip_damage`` of those that are there."""
        return (frame.positions for frame in self.frames())

    def frame(self, index: int, *, normals: bool = False, out: Optional[np.ndarray] = None) -> Frame:
        """Decodes a frame.

        Args:
            index: the number of the frame; negative numbers count from the end.
            normals: whether to compute normals of the vertices, too.
            out: the array (vertices, 3) of float32 to decode into, such as a part of a larger one.

        Raises:
            IndexError: the clip ends before.
        """
        index = operator.index(index)
        with self._lock:
            number = index + len(self) if index < 0 else index
            if number < 0 or (self._frames is not None and number >= self._frames):
                raise IndexError(f"{self.name}: frame {index} of {len(self)}")
            positions, directions, buffers = self._arrays(out, normals)
            try:
                info = self._decoder.receive(number, buffers)
            except errors.InvalidArgumentError:
                if number < len(self):
                    raise
                info = None
            if info is None and number >= len(self):
                raise IndexError(f"{self.name}: frame {index} of {len(self)}")
        if info is None or info.index != number:
            raise errors.CorruptError(f"{self.name}: frame {number} is lost")
        return self._deliver(number, info, positions, directions)

    def frames(self, start: int = 0, stop: Optional[int] = None, *, normals: bool = False) -> Iterator[Frame]:
        """Frames in order, each in arrays of its own; with ``skip_damage`` those that are there."""
        number = operator.index(start)
        if number < 0 or (stop is not None and stop < 0):
            raise errors.InvalidArgumentError("frames: numbers count from 0")
        while stop is None or number < stop:
            with self._lock:
                if self._frames is not None and number >= self._frames:
                    return
                positions, directions, buffers = self._arrays(None, normals)
                info = self._decoder.receive(number, buffers)
            if info is None or (stop is not None and info.index >= stop):
                return
            number = info.index + 1
            yield self._deliver(info.index, info, positions, directions)

    def frame_at(self, seconds: float) -> int:
        """The number of the frame that is shown at a time. InvalidArgumentError beyond the end and without a rate."""
        with self._lock:
            return self._decoder.frame_at(float(seconds))

    def at(self, seconds: float, *, normals: bool = False) -> Frame:
        """The frame that is shown at a time, in seconds from the clip's begin."""
        return self.frame(self.frame_at(seconds), normals=normals)

    def interpolate(self, index: float, *, normals: bool = False, out: Optional[np.ndarray] = None) -> Frame:
        """The shape between frames, such as at 2.5: coefficients are averaged, so that what turns keeps its size.

        The last frame is held for its time. The result's ``index`` is the frame before. InvalidArgumentError beyond the
        end; UnsupportedError where frames are measured against the frame before.
        """
        with self._lock:
            positions, directions, buffers = self._arrays(out, normals)
            info = self._decoder.interpolate(float(index), buffers)
        return self._deliver(info.index, info, positions, directions)

    def interpolate_at(self, seconds: float, *, normals: bool = False, out: Optional[np.ndarray] = None) -> Frame:
        """The shape at a time in seconds, between frames where it falls between them."""
        if self.rate is None:
            raise errors.InvalidArgumentError(f"{self.name}: the stream has no frame rate")
        return self.interpolate(float(seconds) * float(self.rate), normals=normals, out=out)

    def _arrays(
        self, out: Optional[np.ndarray], normals: bool
    ) -> Tuple[np.ndarray, Optional[np.ndarray], FrameBuffers]:
        positions = np.empty((self.vertices, 3), np.float32) if out is None else out
        if positions.shape != (self.vertices, 3):
            raise errors.InvalidArgumentError(f"out: an array of shape {(self.vertices, 3)} is needed")
        directions = np.empty((self.vertices, 3), np.float32) if normals else None
        return positions, directions, frame_buffers(positions, directions)

    def _deliver(self, index: int, info, positions: np.ndarray, normals: Optional[np.ndarray]) -> Frame:
        if self._order is not None:
            for array in (positions, normals):
                if array is not None:
                    array[self._order] = array.copy()
        return Frame(index, info.time, positions, normals)

    def _author_order(self, order: Union[bool, np.ndarray]) -> np.ndarray:
        """The order to give vertices out in, checked to be one."""
        if order is True:
            if self.order is None:
                raise errors.InvalidArgumentError(f"{self.name}: the stream does not keep the order of its vertices")
            return self.order
        array = np.asarray(order)
        if array.shape != (self.vertices,) or not np.array_equal(np.sort(array), np.arange(self.vertices)):
            raise errors.InvalidArgumentError(f"order: the numbers 0 to {self.vertices - 1} in some order are needed")
        return array

    def _take_order(self, order: np.ndarray) -> None:
        """Brings the mesh into an order; what belongs to corners stays where it is."""
        self.faces = order[self.faces].astype(np.uint32)
        back = np.argsort(order)
        if self.normals is not None and self.normal_faces is None:
            self.normals = self.normals[back]
        if self.colors is not None:
            self.colors = self.colors[back]

    def __repr__(self) -> str:
        return f"<sac.Clip {self.name}: {self.vertices} vertices, {len(self.faces)} triangles>"


_LIMITS = ("max_vertices", "max_memory", "max_work", "max_triangles")


def _read(source: Source) -> Tuple[bytes, str]:
    """All bytes of a stream, and what messages call it."""
    if isinstance(source, (bytes, bytearray, memoryview)):
        return bytes(source), "stream"
    if isinstance(source, (str, os.PathLike)):
        with open(source, "rb") as file:  # pylint: disable=unspecified-encoding
            return file.read(), os.fspath(source)
    data = source.read()
    if not isinstance(data, bytes):
        raise TypeError("open: a file in binary mode is needed")
    return data, str(getattr(source, "name", "stream"))


def open_clip(
    source: Source,
    *,
    order: Union[bool, np.ndarray] = False,
    threads: int = 1,
    skip_damage: bool = False,
    layers: Optional[int] = None,
    **limits: Union[int, float],
) -> Clip:
    """Opens a stream: ``sac.open("walk.sac")[17]``.

    Args:
        source: a path, the bytes themselves, or a file in binary mode. All of it is read at once.
        order: the order of vertices to give out: that of the stream; True: the author's, which the stream has to keep;
            or per decoded vertex its index, such as :attr:`Encoding.order`. Frames are copied once then.
        threads: frames of a group that are reconstructed at the same time, 1 to 1024.
        skip_damage: whether to go on after damage at the next sound group; ``Clip.lost`` tells what is lost.
        layers: how many layers of each group to decode, in streams that have them; fewer are coarser. None: all.
        limits: what the stream may ask for, finite by default: ``max_vertices``, ``max_triangles``, ``max_memory``
            (bytes) and ``max_work`` (multiplications for what is derived from the first frame).

    The first frame and all that is derived from it are decoded at once, which may take a second for a large mesh.

    Raises:
        OSError: the file cannot be read.
        CorruptError, UnsupportedError, LimitError: the stream is damaged, of another version, or asks for too much.
    """
    return Clip(source, order=order, threads=threads, skip_damage=skip_damage, layers=layers, **limits)
