# SPDX-License-Identifier: Apache-2.0
"""Layered groups: spec.md 6.1, "Layers"."""

from dataclasses import dataclass

from .byte_reader import ByteReader
from .errors import require
from .group import CodedFrame, GroupDecoder, GroupHeader
from .group_structure import group_structure, layered_order, slot_layer
from .range_coder import RangeDecoder
from .residuals import CORRECTION, DETAIL


@dataclass(frozen=True)
class Layer:
    """The payload of a layer packet."""

    first_frame: int
    number: int
    code: bytes


def parse_layer(payload: bytes) -> Layer:
    """spec.md 6.1, the payload of a layer packet; rule R73."""
    reader = ByteReader(payload, end_rule=73, varint_rule=73)
    return Layer(reader.varint(), reader.varint(), reader.rest())


class LayeredGroup:
    """A layered group, whose layers come one by one."""

    def __init__(self, group: GroupHeader, decoder: GroupDecoder) -> None:
        self.first_frame = group.first_frame
        self.decoder = decoder
        slots = layered_order(group_structure(group.frames, group.pyramid), group.base_levels)
        self.frame_layers = [
            [slot for slot in slots if slot_layer(slot, group.base_levels) == layer]
            for layer in range(slot_layer(slots[-1], group.base_levels) + 1)
        ]
        self.frame_planes = [plane for plane in decoder.planes if plane not in (DETAIL, CORRECTION)]
        self.plane_layers = [plane for plane in (DETAIL, CORRECTION) if plane in decoder.planes]
        self.decoded = 0  # layers
        self._decode(group.code)  # layer 0

    def _all_layers(self) -> int:
        return len(self.frame_layers) + len(self.plane_layers)

    def add(self, layer: Layer) -> None:
        """The next layer, from its packet."""
        require(layer.first_frame == self.first_frame, 73, "a layer of another group")
        require(layer.number == self.decoded, 73, f"layer {layer.number} instead of {self.decoded}")
        require(layer.number < self._all_layers(), 73, f"a layer more than {self._all_layers()}")
        self._decode(layer.code)

    def frames(self) -> list[CodedFrame]:
        """The frames in coding order. No layer comes after this: those that are missing are without residuals."""
        while self.decoded < self._all_layers():
            self._decode(None)
        return self.decoder.frames

    def _decode(self, code: bytes | None) -> None:
        """The next layer, a range code, or a missing one."""
        range_decoder = None if code is None else RangeDecoder(code, rule=56)
        if self.decoded < len(self.frame_layers):
            for slot in self.frame_layers[self.decoded]:
                self.decoder.decode_frame(range_decoder, slot, self.frame_planes)
        else:
            plane = self.plane_layers[self.decoded - len(self.frame_layers)]
            for index in range(len(self.decoder.frames)):
                self.decoder.decode_plane(range_decoder, index, plane)
        if range_decoder is not None:
            range_decoder.finish()
        self.decoded += 1
