# SPDX-License-Identifier: Apache-2.0
"""Decoded frames by time, with a cache. Nothing here knows Blender."""

import collections
import os

import numpy as np

from . import sac

# Times this near to a frame are the frame.
_NEAR = 1e-4


class FrameCache:
    """The positions that were used last, up to a number of bytes."""

    def __init__(self):
        self._arrays = collections.OrderedDict()
        self._bytes = 0

    def get(self, key):
        array = self._arrays.get(key)
        if array is not None:
            self._arrays.move_to_end(key)
        return array

    def put(self, key, array, limit):
        """Keeps an array; those that were used longest ago go where there is no room."""
        old = self._arrays.pop(key, None)
        self._bytes += array.nbytes - (0 if old is None else old.nbytes)
        self._arrays[key] = array
        while self._bytes > limit and self._arrays:
            self._bytes -= self._arrays.popitem(last=False)[1].nbytes

    def clear(self):
        self._arrays.clear()
        self._bytes = 0


class ClipFrames:
    """The frames of a stream at any times, from the cache where they are there."""

    def __init__(self, path, threads, cache):
        self.signature = signature(path)
        self.clip = sac.open(path, threads=threads)
        if self.clip.order is not None:
            self.clip = sac.open(path, threads=threads, order=True)
        self.count = len(self.clip)
        self._cache = cache

    def at(self, time, interpolate, limit):
        """Positions (vertices, 3), float32, at a time in frames of the clip."""
        time = min(max(time, 0.0), self.count - 1.0)
        whole = int(np.floor(time + _NEAR))
        between = time - whole if interpolate and time - whole > _NEAR else 0.0
        key = (id(self), whole, round(between, 4))
        positions = self._cache.get(key)
        if positions is None:
            positions = self._between(whole, between, limit) if between else self.clip[whole]
            self._cache.put(key, positions, limit)
        return positions

    def _between(self, whole, part, limit):
        try:
            return self.clip.interpolate(whole + part).positions
        except sac.UnsupportedError:  # frames that are measured against the frame before
            first, second = self.at(whole, False, limit), self.at(whole + 1, False, limit)
            return first + np.float32(part) * (second - first)


def signature(path):
    """What tells a file from what it was."""
    status = os.stat(path)
    return status.st_mtime_ns, status.st_size, status.st_ino
