# SPDX-License-Identifier: Apache-2.0
"""The frames of a group: spec.md 6.2 and 6.3."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from .byte_reader import ByteReader
from .errors import require
from .group_structure import Slot, harmonic_order, level_step
from .limits import Limits
from .mixing import magnitude_class
from .range_coder import BitModel, RangeDecoder, SignedModels, UnsignedModels
from .residuals import CHANNELS, CORRECTION, DETAIL, DISPLACEMENT, MOTION, PlaneContext, PlaneDecoder, PlaneFrame
from .sequence_header import SequenceHeader

MOST_COEFFICIENT = 2**28


@dataclass(frozen=True)
class GroupHeader:
    """The first elements of a group's payload: spec.md 6. `code` is the range code of its frames or of layer 0,
    `base_levels` is 0 in a group that is not layered."""

    frames: int
    first_frame: int
    pyramid: int
    segment: int
    base_levels: int
    code: bytes

    @property
    def is_open(self) -> bool:
        return self.frames == 0

    @property
    def is_layered(self) -> bool:
        return self.base_levels > 0


def parse_group(payload: bytes, header: SequenceHeader, limits: Limits) -> GroupHeader:
    """spec.md 6, the payload of a group; rules R47 to R50."""
    reader = ByteReader(payload, end_rule=47, varint_rule=47)
    frames = reader.varint()
    first_frame = reader.varint()
    structure = reader.varint()
    pyramid, is_later, is_layered = structure >> 2, structure >> 1 & 1, structure & 1
    require(pyramid >= 1, 47, "pyramid is 0")
    segment = base_levels = 0
    if is_later:
        segment = reader.varint()
        require(segment >= 1, 47, "a later segment 0")
    if is_layered:
        base_levels = reader.varint()
        require(base_levels >= 1, 47, "base_levels is 0")
    if frames == 0:
        require(pyramid == 1 and not is_layered, 47, "an open group with a pyramid or layers")
        require(reader.remaining() == 0, 47, "bytes follow the beginning of an open group")
    require(first_frame + frames < 2**32, 49, "2^32 frames or more")
    if header.reference_shape == 1:
        require(pyramid == 1 and not is_layered, 50, "reference_shape is 1, but there is a pyramid or are layers")
    require(frames <= limits.frames_per_group, 48, f"a group of {frames} frames")
    return GroupHeader(frames, first_frame, pyramid, segment, base_levels, reader.rest())


@dataclass(frozen=True)
class PlaneRows:
    """The rows of the planes (6.2): pairs (c, k) in harmonic order of components and patches, and the vertices."""

    harmonics: list[tuple[int, int]]
    patch_harmonics: list[tuple[int, int]]
    planes: list[int]  # which are present
    vertices: int

    def row_classes(self, plane: int) -> np.ndarray:
        """The row class (7.4.3) of each row of a plane."""
        if plane == CORRECTION:
            return np.ones(self.vertices, np.int64)
        pairs = self.patch_harmonics if plane == DETAIL else self.harmonics
        return np.array([min(magnitude_class(k + 1), 23) for _, k in pairs], np.int64)

    def coefficients(self) -> int:
        """Coefficients of planes a frame."""
        rows = {MOTION: len(self.harmonics), DISPLACEMENT: len(self.harmonics)}
        return sum(rows.get(plane, self.vertices) * CHANNELS[plane] for plane in self.planes)


def plane_rows(header: SequenceHeader, harmonics: list[int], patch_sizes: list[int]) -> PlaneRows:
    """spec.md 6.2, the planes of a stream with so many harmonics a component and vertices a patch."""
    planes = [MOTION, DISPLACEMENT]
    if header.detail_step > 0:
        planes.append(DETAIL)
    if header.correction_step > 0:
        planes.append(CORRECTION)
    detail = harmonic_order(patch_sizes) if DETAIL in planes else []
    return PlaneRows(harmonic_order(harmonics), detail, planes, header.vertices)


@dataclass
class CodedFrame:
    """A frame's integers: rigid coefficients [6], the planes by number; `references` are indices of earlier slots."""

    slot: Slot
    references: tuple[int, ...]
    rigid: list[int]
    planes: dict[int, PlaneFrame]

    @property
    def display(self) -> int:
        """Its number within the group."""
        return self.slot.display

    @property
    def is_intra(self) -> bool:
        return not self.references

    def checked_bytes(self) -> bytes:
        """The coefficients as conformance/README.md takes their CRC."""
        parts = [np.array(self.rigid, "<i4")]
        parts += [self.planes[plane].coefficients.astype("<i4").ravel() for plane in sorted(self.planes)]
        return b"".join(part.tobytes() for part in parts)


class GroupDecoder:
    """The models of a group and the frames that it has decoded so far, in coding order.

    Its methods take no range decoder for what is in a missing layer (6.1).
    """

    def __init__(self, header: SequenceHeader, rows: PlaneRows) -> None:
        self.header = header
        self.frames: list[CodedFrame] = []
        self.places: dict[int, int] = {}  # the index of the slot of each display index
        self.planes = {plane: PlaneDecoder(plane, rows.row_classes(plane)) for plane in rows.planes}
        self.explicit = BitModel()
        self.count = [BitModel(), BitModel()]
        self.reference = UnsignedModels()
        self.moves = [BitModel() for _ in range(3)]
        self.empty = {(plane, level): BitModel() for plane in rows.planes for level in range(3)}
        self.rotation = [SignedModels() for _ in range(3)]
        self.translation = [SignedModels() for _ in range(3)]

    def decode_frame(self, decoder: RangeDecoder | None, slot: Slot, planes: Iterable[int]) -> CodedFrame:
        """spec.md 6.2: the next frame in coding order, which the structure gives this slot, with these planes."""
        index = len(self.frames)
        references = self._references(decoder, slot)
        frame = CodedFrame(slot, references, self._rigid(decoder, slot, references), {})
        self.frames.append(frame)
        self.places[slot.display] = index
        for plane in planes:
            self.decode_plane(decoder, index, plane)
        return frame

    def decode_plane(self, decoder: RangeDecoder | None, index: int, plane: int) -> None:
        """A plane of the frame of the slot `index`: its residuals (7.4) and coefficients (6.3)."""
        models = self.planes[plane]
        slot = self.frames[index].slot
        step = 16 if plane == CORRECTION else level_step(slot.level, self.header.level_growth)
        bend = self._bend(index, plane)
        if decoder is None or self.empty[plane, min(slot.level, 2)].decode(decoder):
            residuals = np.zeros(models.shape, np.int64)
        else:
            earlier = [self.frames[reference].planes[plane] for reference in self.frames[index].references]
            residuals = models.decode(decoder, PlaneContext(earlier, bend, slot.level, step))
        models.remember(residuals, step)
        coefficients = self._prediction(index, plane, bend) + residuals * step
        require(bool(np.all(np.abs(coefficients) <= MOST_COEFFICIENT)), 55, "a coefficient is too large")
        self.frames[index].planes[plane] = PlaneFrame(residuals, coefficients)

    def _references(self, decoder: RangeDecoder | None, slot: Slot) -> tuple[int, ...]:
        """The slots that a frame is predicted from."""
        index = len(self.frames)
        if decoder is None or index == 0 or not self.explicit.decode(decoder):
            return slot.references
        count = 0
        if self.count[0].decode(decoder):
            count = 2 if self.count[1].decode(decoder) else 1
        references = []
        for _ in range(count):
            distance = self.reference.decode(decoder)
            require(distance < index, 51, f"a reference {distance} slots before slot {index - 1}")
            references.append(index - 1 - distance)
        if self.header.reference_shape == 1:
            require(not references or tuple(references) == slot.references, 54, "references of another frame")
        return tuple(references)

    def _rigid(self, decoder: RangeDecoder | None, slot: Slot, references: tuple[int, ...]) -> list[int]:
        """The rigid coefficients, predicted as in 6.3 by frames and means of frames."""
        level = min(slot.level, 2)
        residuals = [0] * 6
        if decoder is not None and self.moves[level].decode(decoder):
            for i in range(6):
                models = self.rotation if i < 3 else self.translation
                residuals[i] = models[level].decode(decoder)
                require(abs(residuals[i]) <= 2**28, 53, "a residual of the rigid motion is too large")
        if not references:
            predicted = [0] * 6
        elif len(references) == 1:
            predicted = self.frames[references[0]].rigid
        else:
            first, second = (self.frames[reference].rigid for reference in references)
            predicted = [(a + b + 1) >> 1 for a, b in zip(first, second)]
        rigid = [p + r for p, r in zip(predicted, residuals)]
        require(max(map(abs, rigid)) <= MOST_COEFFICIENT, 55, "a rigid coefficient is too large")
        return rigid

    def _bend(self, index: int, plane: int) -> np.ndarray:
        """The bend of 6.3 of a plane of the frame of the slot `index`."""
        bend = np.zeros(self.planes[plane].shape, np.int64)
        frame = self.frames[index]
        references = [self.frames[reference] for reference in frame.references]
        if len(references) == 1:
            (a,) = references
            beyond = self._coefficients_at(2 * a.display - frame.display, index, plane)
            if beyond is not None:
                bend += 8 * (a.planes[plane].coefficients - beyond)
        elif len(references) == 2:
            for near, far in (references, references[::-1]):
                beyond = self._coefficients_at(2 * near.display - far.display, index, plane)
                if beyond is not None:
                    bend += 2 * near.planes[plane].coefficients - far.planes[plane].coefficients - beyond
        return bend

    def _coefficients_at(self, display: int, index: int, plane: int) -> np.ndarray | None:
        """The coefficients of the frame displayed then, if its slot is before the slot `index`: spec.md 6.1, "frames
        coded before are always those of earlier slots"."""
        place = self.places.get(display, index)
        return self.frames[place].planes[plane].coefficients if place < index else None

    def _prediction(self, index: int, plane: int, bend: np.ndarray) -> np.ndarray:
        """spec.md 6.3, "Prediction", of a plane of the frame of the slot `index`."""
        references = self.frames[index].references
        if plane == CORRECTION or self.header.reference_shape == 1 or not references:
            return np.zeros(self.planes[plane].shape, np.int64)
        a = self.frames[references[0]].planes[plane].coefficients
        if len(references) == 1:
            return a
        b = self.frames[references[1]].planes[plane].coefficients
        if plane in (MOTION, DISPLACEMENT) and self.frames[index].slot.level >= 3:
            return (8 * (a + b) + bend + 8) >> 4
        return (a + b + 1) >> 1
