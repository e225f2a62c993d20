# SPDX-License-Identifier: Apache-2.0
"""Which frames a group has in which order, and steps of levels: spec.md 6.1 and 6.3."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction


@dataclass(frozen=True)
class Slot:
    """spec.md 6.1: a frame's place in the coding order; `references` are indices of earlier slots."""

    display: int
    level: int
    references: tuple[int, ...]


def group_structure(frames: int, pyramid: int) -> list[Slot]:
    """spec.md 6.1: the slots of a group in coding order."""
    slots = [Slot(0, 0, ())]

    def halve(before: int, after: int, level: int) -> None:
        begin, end = slots[before].display, slots[after].display
        if end - begin < 2:
            return
        middle = len(slots)
        slots.append(Slot(begin + (end - begin) // 2, level, (before, after)))
        halve(before, middle, level + 1)
        halve(middle, after, level + 1)

    last = 0
    while slots[last].display + 1 < frames:
        following = len(slots)
        slots.append(Slot(min(slots[last].display + pyramid, frames - 1), 0, (last,)))
        halve(last, following, 1)
        last = following
    return slots


def layered_order(slots: Sequence[Slot], base_levels: int) -> list[Slot]:
    """spec.md 6.1, "Layers": the slots of a group in the coding order of a layered one."""
    order = sorted(range(len(slots)), key=lambda index: slot_layer(slots[index], base_levels))
    number = {index: place for place, index in enumerate(order)}
    return [
        replace(slots[index], references=tuple(number[reference] for reference in slots[index].references))
        for index in order
    ]


def slot_layer(slot: Slot, base_levels: int) -> int:
    """spec.md 6.1, "Layers": the number of the layer that a slot's frame is in."""
    return max(slot.level - base_levels + 1, 0)


def chain_slot(index: int) -> Slot:
    """spec.md 6.1: slot `index` of an open group, a chain of P-frames."""
    return Slot(index, 0, (index - 1,) if index else ())


def level_step(level: int, level_growth: int) -> int:
    """spec.md 6.3, "Level steps"."""
    step = 16
    for _ in range(level):
        if step < 4096:
            step = (step * level_growth + 32) // 64
    return min(step, 4096)


def harmonic_order(counts: Sequence[int]) -> list[tuple[int, int]]:
    """spec.md 6.3, "Harmonic order": pairs (c, k) by ascending k / l_c, then c, for the l_c in `counts`."""
    pairs = [(c, k) for c, count in enumerate(counts) for k in range(count)]
    return sorted(pairs, key=lambda pair: (Fraction(pair[1], counts[pair[0]]), pair[0]))
