# SPDX-License-Identifier: Apache-2.0
"""Malformed streams: spec.md 11."""

LIMIT_RULES = {3, 22, 23, 44, 48, 60, 63}
UNSUPPORTED_RULES = {11, 46, 69}


class StreamError(Exception):
    """A stream that a decoder refuses.

    `rule` is the number of the rule of spec.md 11 that it breaks, `kind` the class of that rule: "corrupt",
    "unsupported" or "limit".
    """

    def __init__(self, rule: int, reason: str) -> None:
        super().__init__(f"{reason} (spec.md 11, R{rule})")
        self.rule = rule
        if rule in LIMIT_RULES:
            self.kind = "limit"
        elif rule in UNSUPPORTED_RULES:
            self.kind = "unsupported"
        else:
            self.kind = "corrupt"


def require(condition: bool, rule: int, reason: str) -> None:
    """Raises StreamError of the rule unless the condition holds."""
    if not condition:
        raise StreamError(rule, reason)
