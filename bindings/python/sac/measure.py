# SPDX-License-Identifier: Apache-2.0
"""How near a decoded clip is to its original."""

from __future__ import annotations

import ctypes
import itertools
from typing import TYPE_CHECKING, Any, Iterable, NamedTuple, Union

import numpy as np
from numpy.typing import ArrayLike

from . import errors
from ._arrays import index_array, position_array
from ._library import Distortion as _Distortion
from ._library import lib

if TYPE_CHECKING:
    from .clip import Clip


class Distortion(NamedTuple):
    """The distortion of a decoded clip against its original."""

    kg: float  # percent of the original's own spread (Karni and Gotsman 2004); infinite where it has none
    sted: float  # spatio-temporal edge difference, without unit (Vasa and Skala 2011), of the next two
    sted_spatial: float  # how wrongly edges are stretched
    sted_temporal: float  # how wrongly that changes; 0 with a single frame
    max_error: float  # the largest distance between a vertex and its decoded position, model units
    seam_gap: float  # the largest distance between decoded vertices that coincide in every frame, model units
    frames: int


class Meter:
    """Measures frame by frame; memory does not depend on the number of frames.

    Args:
        faces: (triangles, 3) indices of vertices.
        vertices: how many there are.
    """

    def __init__(self, faces: ArrayLike, vertices: int):
        self._faces = index_array(faces, "faces")
        self._vertices = vertices
        self._pointer = ctypes.c_void_p()
        status = lib.sac_meter_open(ctypes.byref(self._pointer), vertices, self._faces.ctypes.data, len(self._faces))
        self._check(status)

    def add(self, original: ArrayLike, decoded: ArrayLike) -> None:
        """Takes the next frame, as it was and as it was decoded: (vertices, 3), in the same order of vertices."""
        pair = [position_array(p, self._vertices, n) for p, n in ((original, "original"), (decoded, "decoded"))]
        self._check(lib.sac_meter_add(self._pointer, pair[0].ctypes.data, pair[1].ctypes.data))

    def result(self) -> Distortion:
        """The distortion of the frames so far, all zeros before the first."""
        distortion = _Distortion()
        self._check(lib.sac_meter_result(self._pointer, ctypes.byref(distortion)))
        return Distortion(*(getattr(distortion, name) for name, _ in _Distortion._fields_))

    def _check(self, status: int) -> None:
        if status != errors.OK:
            errors.check(status, lib.sac_meter_message(self._pointer))

    def __del__(self):
        if getattr(self, "_pointer", None):
            lib.sac_meter_close(self._pointer)


Frames = Union[np.ndarray, "Clip", Iterable[ArrayLike]]


def compare(faces: ArrayLike, original: Frames, decoded: Frames) -> Distortion:
    """Measures a clip against another of the same mesh.

    Args:
        faces: (triangles, 3) indices of vertices.
        original: frames, such as an array (frames, vertices, 3), a :class:`Clip` or an iterator.
        decoded: as many, in the same order of vertices: ``open(path, order=encoding.order)``.

    Raises:
        InvalidArgumentError: the clips differ in frames or vertices, or a face has a vertex that they do not have.
    """
    meter = None
    nothing: Any = object()
    for number, (first, second) in enumerate(itertools.zip_longest(original, decoded, fillvalue=nothing)):
        if first is nothing or second is nothing:
            raise errors.InvalidArgumentError(f"compare: one clip has {number} frames, the other more")
        if meter is None:
            meter = Meter(faces, len(first))
        meter.add(first, second)
    return meter.result() if meter else Distortion(0, 0, 0, 0, 0, 0, 0)
