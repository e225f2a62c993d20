# SPDX-License-Identifier: Apache-2.0
"""One sac_decoder over the bytes of a whole stream."""

from __future__ import annotations

import ctypes
import weakref
from typing import Optional, Tuple

import numpy as np

from . import errors
from ._library import Floats, FrameBuffers, FrameInfo, Indices, Mesh, Metadata, Settings, lib

# Bytes of a settings struct of any later library.
_ROOM = 4096
# The frame that a seek goes to in order to reach the end of a stream without decoding.
_BEYOND = 0xFFFFFFFF


def default_settings(kind, init):
    """A settings struct as the library sets it, which may be longer than the one declared here."""
    memory = ctypes.create_string_buffer(_ROOM)
    settings = kind.from_buffer(memory)
    init(ctypes.byref(settings))
    return settings


class _View:
    """Memory of a decoder as numpy sees it; keeps the decoder alive."""

    def __init__(self, decoder, pointer, shape, kind):
        self._decoder = decoder
        self.__array_interface__ = {
            "data": (ctypes.cast(pointer, ctypes.c_void_p).value, True),
            "shape": shape,
            "typestr": np.dtype(kind).str,
            "version": 3,
        }


def frame_buffers(positions: Optional[np.ndarray], normals: Optional[np.ndarray]) -> FrameBuffers:
    """Describes arrays of shape (vertices, 3), float32, whose rows are contiguous."""
    buffers = FrameBuffers()
    for array, buffer in ((positions, buffers.positions), (normals, buffers.normals)):
        if array is None:
            continue
        if array.dtype != np.float32 or array.ndim != 2 or array.shape[1] != 3 or array.strides[1] != 4:
            raise errors.InvalidArgumentError(
                f"out: an array of shape (vertices, 3) of float32 with contiguous rows is needed, "
                f"this one is {array.shape} of {array.dtype}"
            )
        if not array.flags.writeable or array.strides[0] < 12:
            raise errors.InvalidArgumentError("out: the array cannot be written to")
        buffer.data = array.ctypes.data
        buffer.stride = array.strides[0]
        buffer.size = max(0, (array.shape[0] - 1) * array.strides[0] + 12) if array.shape[0] else 0
    return buffers


class Decoder:
    """A decoder that has read a stream up to its mesh. One thread at a time may call it."""

    def __init__(self, data: bytes, name: str, options: dict):
        self.name = name
        self._data = data
        self._bytes = np.frombuffer(data, np.uint8)
        self._at = 0  # of the next byte to be sent
        self._next: Optional[int] = None  # the frame that is received next; None: seek first
        self._finished = False
        self._skip_damage = bool(options.get("skip_damage"))
        settings = default_settings(Settings, lib.sac_settings_init)
        for key, value in options.items():
            setattr(settings, key, value)
        pointer = ctypes.c_void_p()
        status = lib.sac_decoder_open(ctypes.byref(pointer), ctypes.byref(settings))
        errors.check(status, b"settings that cannot be used" if status != errors.LIMIT else b"", name)
        self._pointer = pointer
        weakref.finalize(self, lib.sac_decoder_close, pointer)
        self.mesh = Mesh()
        while (status := lib.sac_decoder_mesh(pointer, ctypes.byref(self.mesh))) == errors.NEED_MORE_DATA:
            if not self._send():
                self._finish()
                raise errors.CorruptError(f"{name}: it ends before its first frame")
        self.check(status)
        self._next = 0
        self._add_index()

    def check(self, status: int) -> None:
        if status != errors.OK:
            errors.check(status, lib.sac_decoder_message(self._pointer), self.name)

    def view(self, pointer, shape: Tuple[int, ...], kind) -> Optional[np.ndarray]:
        """An array over the decoder's memory, read only; None for a null pointer."""
        if not pointer:
            return None
        return np.asarray(_View(self, pointer, shape, kind)) if 0 not in shape else np.empty(shape, kind)

    def corner_normals(self) -> Tuple[Optional[np.ndarray], Optional[np.ndarray]]:
        """Normals of corners, (count, 3), and their indices, (triangles, 3); Nones without."""
        normals, count, indices = Floats(), ctypes.c_uint32(), Indices()
        self.check(
            lib.sac_decoder_corner_normals(
                self._pointer, ctypes.byref(normals), ctypes.byref(count), ctypes.byref(indices)
            )
        )
        return (
            self.view(normals, (count.value, 3), np.float32),
            self.view(indices, (self.mesh.triangles, 3), np.uint32),
        )

    def offset(self) -> np.ndarray:
        offset = (ctypes.c_double * 3)()
        self.check(lib.sac_decoder_offset(self._pointer, offset))
        return np.array(offset)

    def metadata(self) -> Optional[Metadata]:
        """What the stream has said of its clip so far."""
        metadata = Metadata()
        status = lib.sac_decoder_metadata(self._pointer, ctypes.byref(metadata))
        if status == errors.NEED_MORE_DATA:
            return None
        self.check(status)
        return metadata

    def lost(self) -> list:
        """The runs of frames that damage has cost so far, as ranges."""
        runs = []
        first, count = ctypes.c_uint32(), ctypes.c_uint32()
        for i in range(lib.sac_decoder_lost_count(self._pointer)):
            self.check(lib.sac_decoder_lost(self._pointer, i, ctypes.byref(first), ctypes.byref(count)))
            runs.append(range(first.value, first.value + count.value))
        return runs

    def layers(self) -> int:
        return lib.sac_decoder_layers(self._pointer)

    def frames(self) -> int:
        """How many frames there are; without an index it reads the rest of the stream, decoding nothing."""
        count = ctypes.c_uint32()
        status = lib.sac_decoder_frames(self._pointer, ctypes.byref(count))
        if status == errors.NEED_MORE_DATA:
            self.seek(_BEYOND)
            self._next = None
            while self._send():
                pass
            self._finish()
            status = lib.sac_decoder_frames(self._pointer, ctypes.byref(count))
            if status == errors.NEED_MORE_DATA and self._skip_damage:
                return self._frames_there()
            if status == errors.NEED_MORE_DATA:
                raise errors.CorruptError(f"{self.name}: its end, which tells how many frames there are, is missing")
        self.check(status)
        return count.value

    def _frames_there(self) -> int:
        """How many frames there are up to the last that is there, of a stream whose end is missing."""
        self.seek(0)
        info = FrameInfo()
        count = 0
        while self._receive(FrameBuffers(), info):
            count = info.index + 1
        return count

    def seek(self, frame: int) -> None:
        """The next frame to be received becomes `frame`."""
        byte = ctypes.c_uint64()
        self._next = None
        self.check(lib.sac_decoder_seek(self._pointer, frame, ctypes.byref(byte)))
        self._at, self._next, self._finished = byte.value, frame, False

    def frame_at(self, seconds: float) -> int:
        """The number of the frame that is shown at a time, in seconds from the clip's begin."""
        byte, info = ctypes.c_uint64(), FrameInfo()
        self._next = None
        self.check(lib.sac_decoder_seek_time(self._pointer, seconds, ctypes.byref(byte)))
        self._at, self._finished = byte.value, False
        if not self._receive(FrameBuffers(), info):
            raise errors.InvalidArgumentError(f"{self.name}: {seconds:g} seconds are beyond its end")
        return info.index

    def receive(self, frame: int, buffers: FrameBuffers) -> Optional[FrameInfo]:
        """Decodes a frame into the caller's arrays, seeking where it is not the next. Where damage has cost that frame,
        it is the next one that is there; None where there is none to the end."""
        if self._next != frame:
            self.seek(frame)
        info = FrameInfo()
        return info if self._receive(buffers, info) else None

    def _receive(self, buffers: FrameBuffers, info: FrameInfo) -> bool:
        """Receives the next frame; False at the end."""
        while True:
            status = lib.sac_decoder_receive(self._pointer, ctypes.byref(buffers), ctypes.byref(info))
            if status == errors.OK:
                self._next = info.index + 1
                return True
            self._next = None
            if status != errors.NEED_MORE_DATA:
                self.check(status)
            if not self._send() and not self._finish():
                return False

    def interpolate(self, time: float, buffers: FrameBuffers) -> FrameInfo:
        """The shape at a time in frames, which may lie between two of them."""
        info = FrameInfo()
        self._next = None
        sought = False
        while True:
            status = lib.sac_decoder_interpolate(self._pointer, time, ctypes.byref(buffers), ctypes.byref(info))
            if status == errors.NEED_MORE_DATA and (self._send() or self._finish()):
                continue
            if status != errors.INVALID_ARGUMENT or sought or not 0 <= time <= _BEYOND:
                break
            self.seek(int(time))  # the frame before is gone
            self._next, sought = None, True
        if status == errors.NEED_MORE_DATA:
            raise errors.InvalidArgumentError(f"{self.name}: frame {time:g} is beyond its end")
        self.check(status)
        return info

    def _send(self) -> bool:
        """Sends up to a packet; False at the end of the bytes."""
        left = len(self._data) - self._at
        if left <= 0:
            return False
        start = self._bytes.ctypes.data + self._at
        data, size = ctypes.c_void_p(start), ctypes.c_size_t(left)
        status = lib.sac_decoder_send(self._pointer, ctypes.byref(data), ctypes.byref(size))
        if status != errors.OK:
            self._next = None
        self.check(status)
        segment = ctypes.c_uint32()
        if lib.sac_decoder_segment(self._pointer, ctypes.byref(segment)) == errors.OK and segment.value > 0:
            self._next = None
            raise errors.UnsupportedError(
                f"{self.name}: it goes on with another mesh, which this module does not follow"
            )
        moved = left - size.value
        self._at += moved
        return moved > 0

    def _finish(self) -> bool:
        """Declares the end, an error unless the stream is complete or damage is skipped. True when frames may have come
        of it."""
        if self._finished:
            return False
        self._finished = True
        status = lib.sac_decoder_finish(self._pointer)
        if not self._skip_damage:
            self.check(status)
        return self._skip_damage

    def _add_index(self) -> None:
        """Takes the index at the end of the stream, where there is one."""
        needed = ctypes.c_size_t(8)
        while needed.value <= len(self._data):
            tail = len(self._data) - needed.value
            status = lib.sac_decoder_add_index(
                self._pointer, self._bytes.ctypes.data + tail, needed.value, ctypes.byref(needed)
            )
            if status != errors.NEED_MORE_DATA:
                return
