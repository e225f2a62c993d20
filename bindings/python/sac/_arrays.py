# SPDX-License-Identifier: Apache-2.0
"""The caller's arrays as the library takes them."""

from __future__ import annotations

import numpy as np

from .errors import InvalidArgumentError


def index_array(values, name: str) -> np.ndarray:
    """Indices as a contiguous array (triangles, 3) of uint32."""
    array = np.asarray(values)
    if array.ndim != 2 or array.shape[1] != 3:
        if array.size == 0:
            return np.empty((0, 3), np.uint32)
        hint = ": cut polygons into triangles" if array.ndim == 1 or array.shape[1] > 3 else ""
        raise InvalidArgumentError(f"{name}: shape {array.shape}, where (triangles, 3) is needed{hint}")
    if array.dtype.kind not in "iu":
        raise InvalidArgumentError(f"{name}: integers are needed, these are {array.dtype}")
    if array.size and (array.min() < 0 or array.max() > 0xFFFFFFFF):
        raise InvalidArgumentError(f"{name}: an index of {array.min() if array.min() < 0 else array.max()}")
    return np.ascontiguousarray(array, np.uint32)


def value_array(values, columns: int, kind, name: str, rows=None) -> np.ndarray:
    """Numbers as a contiguous array (rows, columns)."""
    array = np.asarray(values)
    if array.ndim != 2 or array.shape[1] != columns or (rows is not None and len(array) != rows):
        wanted = f"({'count' if rows is None else rows}, {columns})"
        raise InvalidArgumentError(f"{name}: shape {array.shape}, where {wanted} is needed")
    if array.dtype.kind not in "fiu":
        raise InvalidArgumentError(f"{name}: numbers are needed, these are {array.dtype}")
    return np.ascontiguousarray(array, kind)


def position_array(values, vertices: int, name: str) -> np.ndarray:
    """Positions as a contiguous array (vertices, 3) of float32."""
    return value_array(values, 3, np.float32, name, vertices)


def color_array(values, vertices: int) -> np.ndarray:
    """Colors as (vertices, 4) of uint8: bytes, or floats from 0 to 1; alpha is 255 where there are three columns."""
    array = np.asarray(values)
    if array.ndim == 2 and array.shape[1] == 3:
        opaque = np.full((len(array), 1), 255 if array.dtype == np.uint8 else 1, array.dtype)
        array = np.hstack([array, opaque])
    if array.dtype != np.uint8:
        if array.dtype.kind != "f" or not np.all((array >= 0) & (array <= 1)):
            raise InvalidArgumentError("colors: uint8, or floats from 0 to 1, are needed")
        array = np.round(array * 255)
    return value_array(array, 4, np.uint8, "colors", vertices)


def choose_offset(positions: np.ndarray) -> np.ndarray:
    """A point near the vertices that positions in double precision are made relative to before they become float32.

    Zeros where float32 holds them to 2^-20 of the diagonal of their box; else the middle of the box, rounded to a power
    of ten not above the diagonal. It is what ``sac encode`` chooses.
    """
    if positions.dtype != np.float64 or not len(positions) or not np.isfinite(positions).all():
        return np.zeros(3)
    low, high = positions.min(axis=0), positions.max(axis=0)
    diagonal = float(np.linalg.norm(high - low))
    if not diagonal > 0 or np.abs(positions).max() * 2.0**-24 <= diagonal * 2.0**-20:
        return np.zeros(3)
    unit = 10.0 ** np.floor(np.log10(diagonal))
    return np.round((low / 2 + high / 2) / unit) * unit + 0.0
