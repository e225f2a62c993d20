# SPDX-License-Identifier: Apache-2.0
"""Exceptions with the library's own messages, one for each kind of failure."""


class Error(Exception):
    """The base of all exceptions that the library raises; its text is one line for a person."""


class InvalidArgumentError(Error, ValueError):
    """Arrays, settings or a time that cannot be used; targets that cannot be met."""


class UnsupportedError(Error):
    """A stream of another version, or what a stream cannot give."""


class CorruptError(Error):
    """Bytes that break a rule of the format, or end too early."""


class LimitError(Error):
    """A stream that asks for more than the limits allow, or memory that is short."""


class CancelledError(Error):
    """The progress callback asked to stop."""


class LossWarning(UserWarning):
    """Part of the input is not in the stream."""


# Values of sac_status in sac.h.
OK, NEED_MORE_DATA, INVALID_ARGUMENT, LIMIT = 0, 1, 2, 5
_KINDS = {
    INVALID_ARGUMENT: InvalidArgumentError,
    3: UnsupportedError,
    4: CorruptError,
    LIMIT: LimitError,
    6: CancelledError,
}
_TEXTS = {NEED_MORE_DATA: "more bytes are needed", LIMIT: "not enough memory", 6: "cancelled"}


def check(status: int, message: bytes = b"", where: str = "") -> None:
    """Raises the exception of a sac_status that is not SAC_OK, with its message and what it is about."""
    if status == OK:
        return
    text = message.decode(errors="replace") or _TEXTS.get(status, "the arguments cannot be used")
    raise _KINDS.get(status, Error)(f"{where}: {text}" if where else text)
