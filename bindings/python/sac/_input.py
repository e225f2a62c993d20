# SPDX-License-Identifier: Apache-2.0
"""The mesh and the settings of an encoding as structs of C."""

from __future__ import annotations

import fractions
import numbers
from ctypes import c_char_p
from typing import Any, Dict, Tuple, Union

import numpy as np

from . import errors
from ._arrays import choose_offset, color_array, index_array, position_array, value_array
from ._decoder import default_settings
from ._library import EncoderSettings, InputMesh, lib

# Members of the settings that have arguments of their own, or none.
_NOT_OPTIONS = {
    "struct_size",
    "frame_rate_numerator",
    "frame_rate_denominator",
    "progress",
    "user",
    "run_jobs",
    "run_jobs_user",
    "offset",
    "has_first_frame",
}


def _address(array):
    return None if array is None or not array.size else array.ctypes.data


class MeshInput:
    """A mesh with the arrays that its struct points to."""

    def __init__(self, faces, first, uvs, uv_faces, normals, normal_faces, colors, offset):
        first = np.asarray(first)
        if first.ndim != 2 or first.shape[1] != 3:
            raise errors.InvalidArgumentError(f"frames: a frame of shape {first.shape}, where (vertices, 3) is needed")
        self.vertices = len(first)
        if offset is None:
            self.offset = choose_offset(first)
        else:
            self.offset = np.asarray(offset, np.float64)
            if self.offset.shape != (3,):
                raise errors.InvalidArgumentError("offset: three numbers are needed")
        self._faces = index_array(faces, "faces")
        self._positions = position_array(self.relative(first), self.vertices, "frame 0")
        triangles = len(self._faces)
        self._uvs = self._uv_faces = self._normals = self._normal_faces = self._colors = None
        if uvs is not None:
            rows = self.vertices if uv_faces is None else None
            self._uvs = value_array(uvs, 2, np.float32, "uvs", rows)
            self._uv_faces = self._indices(self._faces if uv_faces is None else uv_faces, triangles, "uv_faces")
        elif uv_faces is not None:
            raise errors.InvalidArgumentError("uv_faces: there are no uvs")
        if normals is not None:
            rows = self.vertices if normal_faces is None else None
            self._normals = value_array(normals, 3, np.float32, "normals", rows)
            if normal_faces is not None:
                self._normal_faces = self._indices(normal_faces, triangles, "normal_faces")
        elif normal_faces is not None:
            raise errors.InvalidArgumentError("normal_faces: there are no normals")
        if colors is not None:
            self._colors = color_array(colors, self.vertices)
        self.struct = InputMesh(
            vertices=self.vertices,
            triangles=triangles,
            uvs=0 if self._uvs is None else len(self._uvs),
            positions=_address(self._positions),
            triangle_vertices=_address(self._faces),
            uv_values=_address(self._uvs),
            triangle_uvs=_address(self._uv_faces),
            normals=_address(self._normals),
            colors=_address(self._colors),
            corner_normals=0 if self._normal_faces is None else len(self._normals),
            triangle_normals=_address(self._normal_faces),
        )

    @staticmethod
    def _indices(values, triangles: int, name: str) -> np.ndarray:
        array = index_array(values, name)
        if len(array) != triangles:
            raise errors.InvalidArgumentError(f"{name}: {len(array)} triangles, the mesh has {triangles}")
        return array

    def relative(self, positions: np.ndarray) -> np.ndarray:
        """Positions relative to the offset."""
        return positions - self.offset if self.offset.any() else positions


#: Frames per second: a number, a fraction, or (numerator, denominator).
Rate = Union[None, float, numbers.Rational, Tuple[int, int]]


def _decimal_rate(fps: float) -> fractions.Fraction:
    """The nearest fraction over at most 1001; 29.97 and the like are 30000/1001, as in ``sac encode --fps``."""
    of_broadcast = fractions.Fraction(round(fps * 1.001) * 1000, 1001)
    if fps in (round(float(of_broadcast), 2), round(float(of_broadcast), 3)):
        return of_broadcast
    return fractions.Fraction(fps).limit_denominator(1001)


def frame_rate(fps: Rate) -> Tuple[int, int]:
    """Numerator and denominator of frames per second; a number is taken as the nearest fraction over at most 1001."""
    if fps is None:
        return 0, 1
    try:
        if isinstance(fps, tuple):
            rate = fractions.Fraction(*fps)
        elif isinstance(fps, numbers.Rational):
            rate = fractions.Fraction(fps)
        else:
            rate = _decimal_rate(float(fps))
    except (TypeError, ValueError, OverflowError, ZeroDivisionError) as error:
        raise errors.InvalidArgumentError(f"fps: {fps!r} is no rate: {error}") from error
    if not 0 < rate or max(rate.numerator, rate.denominator) > 0xFFFFFFFF:
        raise errors.InvalidArgumentError(f"fps: {fps!r} is no rate")
    return rate.numerator, rate.denominator


def encoder_settings(given: dict, fps, offset: np.ndarray) -> EncoderSettings:
    """The settings of an encoder; members that are None keep the library's default."""
    settings = default_settings(EncoderSettings, lib.sac_encoder_settings_init)
    kinds: Dict[str, Any] = dict(EncoderSettings._fields_)
    for name, value in given.items():
        if name not in kinds or name in _NOT_OPTIONS:
            raise TypeError(f"there is no setting {name!r}")
        if value is None:
            continue
        if kinds[name] is c_char_p:
            setattr(settings, name, value.encode() if isinstance(value, str) else bytes(value))
            continue
        whole = not isinstance(kinds[name](0).value, float)
        try:
            setattr(settings, name, int(value) if isinstance(value, (bool, np.bool_)) else value)
        except TypeError as error:
            raise errors.InvalidArgumentError(f"{name}: {value!r} is no number") from error
        if whole and getattr(settings, name) != value:
            raise errors.InvalidArgumentError(f"{name}: {value!r} is out of range")
    settings.frame_rate_numerator, settings.frame_rate_denominator = frame_rate(fps)
    settings.offset[:] = offset
    settings.has_first_frame = given.get("first_frame") is not None
    return settings
