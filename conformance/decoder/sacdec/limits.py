# SPDX-License-Identifier: Apache-2.0
"""What this decoder refuses as too large: the defaults of spec.md 9."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Limits:
    """Limits, with the defaults of the table in spec.md 9."""

    vertices: int = 4_000_000
    triangles: int = 8_000_000
    harmonics: int = 8_192
    basis_values: int = 2**28
    basis_work: int = 10**12
    frames_per_group: int = 4_096
    group_values: int = 2**27
    packet_bytes: int = 2**28
