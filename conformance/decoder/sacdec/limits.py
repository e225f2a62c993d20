# SPDX-License-Identifier: Apache-2.0
"""What this decoder refuses as too large: the defaults of spec.md 9."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Limits:
    """Limits, with the defaults of the table in spec.md 9.

    Those on a factor are left out, and its part of the work: SuperLU, which solves the systems here, does not tell
    beforehand how much it needs. The limit on memory is left out too, and the work along edges.
    """

    vertices: int = 4_000_000
    triangles: int = 8_000_000
    harmonics: int = 8_192
    basis_values: int = 2**28
    basis_work: int = 5 * 10**11
    free_work: int = 4 * 10**10
    work_per_byte: int = 4 * 10**6
    frame_work: int = 10**11
    frames_per_group: int = 4_096
    group_values: int = 2**27
    packet_bytes: int = 2**27
