# SPDX-License-Identifier: Apache-2.0
"""Metadata: spec.md 3.3."""

import math
import struct
from collections.abc import Callable
from typing import Any

from .byte_reader import ByteReader
from .errors import StreamError, require

# Nothing of this is an error of the stream, so the rule of the errors here is of no meaning.
_NO_RULE = 0


def _unpacked(layout: str, is_good: Callable[..., bool] = lambda *values: True) -> Callable[[bytes], Any]:
    """What unpacks a value of this layout: a number, or a tuple of more than one."""

    def unpack(value: bytes) -> Any:
        require(len(value) == struct.calcsize(layout), _NO_RULE, "a value of a wrong size")
        values = struct.unpack(layout, value)
        require(is_good(*values), _NO_RULE, "a value out of its range")
        return values if len(values) > 1 else values[0]

    return unpack


def _text(value: bytes) -> str:
    try:
        return value.decode()
    except UnicodeDecodeError as error:
        raise StreamError(_NO_RULE, "a value that is not UTF-8") from error


# The values of the second table, by key; entry 8, boxes of groups, stays bytes like what is not in the table.
_VALUES: dict[int, Callable[[bytes], Any]] = {
    1: _text,
    2: _unpacked("<d", lambda metres: 0 < metres < math.inf),
    3: _unpacked("<B", lambda axis: axis <= 2),
    4: _unpacked("<i"),
    5: _unpacked("<B", lambda loop: loop <= 1),
    6: _text,
    7: _unpacked("<6f", lambda *box: all(map(math.isfinite, box))),
}


def parse_metadata(payload: bytes) -> dict[int, Any]:
    """spec.md 3.3, the entries of a metadata packet by key; none of a malformed packet, which a reader does without."""
    reader = ByteReader(payload, end_rule=_NO_RULE, varint_rule=_NO_RULE)
    entries: dict[int, Any] = {}
    try:
        while reader.remaining() > 0:
            key = reader.varint()
            require(key > max(entries, default=-1), _NO_RULE, "keys do not ascend")
            value = reader.bytes(reader.varint())
            entries[key] = _VALUES.get(key, bytes)(value)
    except StreamError:
        return {}
    return entries
