# SPDX-License-Identifier: Apache-2.0
"""sac: a streaming codec for animated triangle meshes.

    import sac

    encoding = sac.encode(faces, frames, "walk.sac", fps=30, target_sted=0.05)
    clip = sac.open("walk.sac")
    clip[17]                     # frame 17, (vertices, 3), float32
    clip[::10]                   # every tenth, (frames, vertices, 3)
    clip.at(1.5).positions       # the frame that is shown after 1.5 seconds
    clip.interpolate(2.5)        # the shape between frames 2 and 3
    for positions in clip: ...
    sac.compare(faces, frames, sac.open("walk.sac", order=encoding.order))

Positions are in model units. Arrays of frames are those that the decoder writes into: nothing is copied. Calls of the
library let other threads run. Exceptions are :class:`Error` with the library's message.
"""

from ._library import lib as _lib
from .clip import Clip, Frame
from .clip import open_clip as open  # pylint: disable=redefined-builtin
from .encode import Encoding, encode
from .encoder import Encoder
from .errors import (
    CancelledError,
    CorruptError,
    Error,
    InvalidArgumentError,
    LimitError,
    LossWarning,
    UnsupportedError,
)
from .measure import Distortion, Meter, compare

#: The version of the library, and of the streams that it reads and writes.
__version__: str = _lib.sac_version().decode()
stream_version: str = _lib.sac_stream_version().decode()

__all__ = [
    "CancelledError",
    "Clip",
    "CorruptError",
    "Distortion",
    "Encoder",
    "Encoding",
    "Error",
    "Frame",
    "InvalidArgumentError",
    "LimitError",
    "LossWarning",
    "Meter",
    "UnsupportedError",
    "compare",
    "encode",
    "open",
    "stream_version",
]
