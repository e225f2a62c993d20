# SPDX-License-Identifier: Apache-2.0
"""Encoding frame by frame, of what is not known beforehand."""

from __future__ import annotations

import ctypes
import weakref
from typing import Dict, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from . import errors
from ._arrays import position_array
from ._input import MeshInput, Rate, encoder_settings
from ._library import EncoderSettings, Indices, StreamBytes, lib


class Encoder:
    """Turns frames into a stream as they come: ``send()`` each, write what it returns, then what ``finish()`` returns.

    Nothing is searched or measured; :func:`encode` does both. It holds one group of frames a thread, with ``low_delay``
    one frame. One thread at a time may use it.

    Args:
        faces: (triangles, 3) indices of vertices.
        first: (vertices, 3), the first frame, which is the shape that motion is measured from. It is still to be sent.
        settings: as for :func:`encode`, without targets, ``measure`` and ``progress``.

    Raises:
        InvalidArgumentError: a mesh or settings that cannot be coded. LimitError: decoders would refuse the stream.
    """

    def __init__(
        self,
        faces: ArrayLike,
        first: ArrayLike,
        *,
        fps: Rate = None,
        uvs: Optional[ArrayLike] = None,
        uv_faces: Optional[ArrayLike] = None,
        normals: Optional[ArrayLike] = None,
        normal_faces: Optional[ArrayLike] = None,
        colors: Optional[ArrayLike] = None,
        offset: Optional[ArrayLike] = None,
        **settings: Union[None, float, str],
    ):
        self._mesh = MeshInput(faces, first, uvs, uv_faces, normals, normal_faces, colors, offset)
        chosen: EncoderSettings = encoder_settings(settings, fps, self._mesh.offset)
        pointer = ctypes.c_void_p()
        status = lib.sac_encoder_open(ctypes.byref(pointer), ctypes.byref(self._mesh.struct), ctypes.byref(chosen))
        self._pointer = pointer
        if pointer:
            weakref.finalize(self, lib.sac_encoder_close, pointer)
        self._check(status)
        self.offset: np.ndarray = self._mesh.offset
        self.frames = 0

    def send(self, positions: ArrayLike) -> bytes:
        """Takes the next frame, (vertices, 3), the first one first; returns the bytes that are ready, often none."""
        name = f"frame {self.frames}"
        given = np.asarray(positions)
        if given.shape == (self._mesh.vertices, 3):
            given = self._mesh.relative(given)
        given = position_array(given, self._mesh.vertices, name)
        self._check(lib.sac_encoder_send(self._pointer, given.ctypes.data if given.size else None, 0))
        self.frames += 1
        return self._take()

    def finish(self) -> bytes:
        """Ends the stream and returns its last bytes."""
        self._check(lib.sac_encoder_finish(self._pointer))
        return self._take()

    @property
    def order(self) -> np.ndarray:
        """(vertices,): per decoded vertex its index in the input."""
        order = Indices()
        self._check(lib.sac_encoder_order(self._pointer, ctypes.byref(order)))
        return np.ctypeslib.as_array(order, (self._mesh.vertices,)).copy()

    @property
    def parts(self) -> Dict[str, float]:
        """Bytes of the stream so far by what they say."""
        parts = StreamBytes()
        self._check(lib.sac_encoder_stream_bytes(self._pointer, ctypes.byref(parts)))
        return {name: getattr(parts, name) for name, _ in StreamBytes._fields_}

    def _take(self) -> bytes:
        data, size = ctypes.c_void_p(), ctypes.c_size_t()
        self._check(lib.sac_encoder_take(self._pointer, ctypes.byref(data), ctypes.byref(size)))
        return ctypes.string_at(data, size.value) if size.value else b""

    def _check(self, status: int) -> None:
        if status != errors.OK:
            message: Optional[bytes] = lib.sac_encoder_message(self._pointer) if self._pointer else b""
            errors.check(status, message or b"")
