#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the worked examples of spec.md, read from its text, through this decoder.

Exit code 1 if one is not as the text says, 77 if the packages that this needs are missing.
"""

import re
import sys
import unittest
import zlib
from collections.abc import Iterator
from pathlib import Path

try:
    import numpy as np

    from sacdec import copies, group_structure, handles, harmonics, mixing, positions, residuals, shape, vertices
    from sacdec.byte_reader import ByteReader
    from sacdec.end_packet import End, Index, parse_end
    from sacdec.errors import StreamError
    from sacdec.limits import Limits
    from sacdec.packets import END, read_packet, read_records
    from sacdec.position_graph import PositionGraph
    from sacdec.position_prediction import Surroundings
    from sacdec.range_coder import BitModel, RangeDecoder, SignedModels, UnsignedModels
    from sacdec.reconstruction import deformation_gradients
    from sacdec.stream import decode_stream
except ModuleNotFoundError as missing:
    print(f"skipped: {missing}; scripts/install-packages installs python3-numpy and python3-scipy")
    sys.exit(77)

SPEC = (Path(__file__).resolve().parents[2] / "spec.md").read_text()


def example(name: str) -> list[str]:
    """The lines of the example of this name."""
    found = re.search(rf"^```example {name}\n(.*?)^```$", SPEC, re.MULTILINE | re.DOTALL)
    assert found, f"spec.md has no example {name}"
    return found[1].splitlines()


def pairs(name: str, separator: str = " = ") -> Iterator[tuple[str, str]]:
    """The two sides of each line of an example."""
    for line in example(name):
        left, right = line.split(separator, 1)
        yield left.strip(), right.strip()


def keyed(name: str) -> dict[str, list[str]]:
    """The words of each line of an example, by the first one."""
    return {line.split()[0]: line.split()[1:] for line in example(name)}


def integers(words: list[str]) -> list[int]:
    return list(map(int, words))


def slot_line(slot: group_structure.Slot) -> str:
    """A slot as the examples of spec.md 6.1 have it."""
    return " ".join(map(str, ["display", slot.display, "level", slot.level, "references", *slot.references]))


class Bytes(unittest.TestCase):
    def test_varint(self) -> None:
        for value, text in pairs("varint"):
            reader = ByteReader(bytes.fromhex(text), end_rule=5, varint_rule=2)
            if value == "malformed":
                with self.assertRaises(StreamError):
                    reader.varint()
            else:
                self.assertEqual((reader.varint(), reader.remaining()), (int(value), 0))

    def test_crc32(self) -> None:
        for text, crc in pairs("crc32"):
            self.assertEqual(zlib.crc32(text.strip('"').encode()), int(crc, 16))

    def test_packet(self) -> None:
        for frames, text in pairs("packet"):
            reader = ByteReader(bytes.fromhex(text), end_rule=5, varint_rule=2)
            kind, payload = read_packet(reader, Limits())
            self.assertEqual((kind, reader.remaining()), (END, 0))
            self.assertEqual(parse_end(payload, reader.position), End(int(frames), None))

    def test_index(self) -> None:
        first, text = example("index")
        words = first.split()
        reader = ByteReader(bytes.fromhex(text.split("=")[1]), end_rule=5, varint_rule=2)
        kind, payload = read_packet(reader, Limits())
        self.assertEqual((kind, reader.remaining()), (END, 0))
        groups = integers(words[5:])
        index = Index(int(words[3]), [], list(zip(groups[::2], groups[1::2])))
        self.assertEqual(parse_end(payload, reader.position), End(int(words[1]), index))

    def test_records(self) -> None:
        reader = ByteReader(b"".join(bytes.fromhex(text) for _, text in pairs("records")), end_rule=5, varint_rule=2)
        self.assertEqual(list(read_records(reader, Limits())), [bytes.fromhex("7680"), b""])
        self.assertEqual(reader.remaining(), 0)


class EntropyCoder(unittest.TestCase):
    def test_range_coder(self) -> None:
        lines = keyed("range-coder")
        decoder = RangeDecoder(bytes.fromhex("".join(lines["bytes"])), rule=56)
        model = BitModel()
        probabilities, bins = [], []
        for _ in lines["bins"]:
            probabilities.append(model.p)
            bins.append(model.decode(decoder))
        self.assertEqual(bins, integers(lines["bins"]))
        self.assertEqual(probabilities, integers(lines["probabilities"]))
        bits, value = integers(lines["raw"])
        self.assertEqual(decoder.raw(bits), value)
        decoder.finish()

    def test_integers(self) -> None:
        for left, text in pairs("integers"):
            kind, value = left.split()
            decoder = RangeDecoder(bytes.fromhex(text), rule=56)
            models = UnsignedModels() if kind == "ue" else SignedModels()
            self.assertEqual(models.decode(decoder), int(value))
            decoder.finish()

    def test_logistic(self) -> None:
        self.assertEqual(mixing.LOGISTIC, integers(" ".join(example("logistic")).split()))
        for p in range(0, 65536, 16):
            x = mixing.stretch(p)
            self.assertGreaterEqual(mixing.squash(x), p + 8)
            self.assertTrue(x == -mixing.MOST or mixing.squash(x - 1) < p + 8)

    def test_bit_model(self) -> None:
        lines = keyed("bit-model")
        model = BitModel()
        probabilities, inputs = [], []
        for decoded in integers(lines["bins"]):
            probabilities.append(model.p)
            inputs.append(mixing.model_input(model))
            model.update(decoded)
        self.assertEqual(probabilities, integers(lines["probabilities"]))
        self.assertEqual(inputs, integers(lines["inputs"]))

    def test_mixed(self) -> None:
        class Recorder:
            """Gives the bins that are asked for, and keeps their probabilities."""

            def __init__(self, bins: list[int]) -> None:
                self.bins = iter(bins)
                self.probabilities: list[int] = []

            def bin(self, p: int) -> int:
                self.probabilities.append(p)
                return next(self.bins)

        lines = {name: integers(numbers) for name, numbers in keyed("mixed").items()}
        recorder = Recorder(lines["bins"])
        models = [BitModel(), BitModel()]
        first, second = list(lines["weights"]), list(lines["weights"])
        for _ in lines["bins"]:
            mixing.decode_mixed(recorder, models, lines["feature"], first, second)
        self.assertEqual(recorder.probabilities, lines["probabilities"])

    def test_classes(self) -> None:
        lines = keyed("classes")
        x, classes = integers(lines["x"]), integers(lines["Q"])
        self.assertEqual([mixing.magnitude_class(value) for value in x], classes)
        self.assertEqual(mixing.magnitude_classes(np.array(x)).tolist(), classes)

    def test_weights(self) -> None:
        for line in example("weights")[1:]:
            plane, kind, *weights = integers(line.split())
            self.assertEqual(residuals.first_weights(plane, kind), [1024 * weight for weight in weights])

    def test_coefficients(self) -> None:
        zero = np.zeros((1, 3), np.int64)
        for value, text in pairs("coefficients"):
            models = residuals.PlaneDecoder(residuals.DISPLACEMENT, np.ones(1, np.int64))
            decoder = RangeDecoder(bytes.fromhex(text), rule=56)
            plane = residuals.FrameOfPlane(models, decoder, residuals.PlaneContext([], zero, level=0, step=16))
            self.assertEqual(plane.residual(0, 0), int(value))
            decoder.finish()


class Positions(unittest.TestCase):
    def test_positions(self) -> None:
        first, *lines = example("positions")
        position_bits, step, slope = integers(first.split()[1:])
        triangles = [tuple(integers(line.split()[1:])) for line in lines if line.startswith("triangle")]
        *told, code = lines[len(triangles) :]
        decoder = RangeDecoder(bytes.fromhex(code.removeprefix("bytes")), rule=30)
        coding = positions.PositionDecoder(decoder, position_bits, step, slope)
        graph = PositionGraph(6, triangles)
        surroundings = Surroundings(graph, position_bits)
        for v, line in zip(graph.coding_order(), told, strict=True):
            words = line.split()
            known = surroundings.around(v)
            self.assertEqual(v, int(words[1]))
            self.assertEqual(known.relaxed, integers(words[5:8]))
            self.assertEqual(coding.centre(known).centre, integers(words[9:12]))
            position, surroundings.miss[v] = coding.vertex(known)
            self.assertEqual(position, integers(words[17:20]))
            surroundings.x[v] = surroundings.last = [16 * coordinate for coordinate in position]
        decoder.finish()


class Copies(unittest.TestCase):
    def test_copies(self) -> None:
        *lines, code = example("copies")
        triangles = [integers(line.split()[1:4]) for line in lines]
        decoder = RangeDecoder(bytes.fromhex(code.removeprefix("bytes")), rule=30)
        decoded = copies.CopyDecoder(decoder, triangles, [[None] * 3 for _ in triangles]).decode()
        self.assertEqual(decoded, [integers(line.split()[5:8]) for line in lines])
        decoder.finish()


class Structure(unittest.TestCase):
    def test_groups(self) -> None:
        for name in ("group-structure", "group-structure-cut"):
            first, *lines = example(name)
            frames, pyramid = integers(first.split()[1::2])
            slots = group_structure.group_structure(frames, pyramid)
            self.assertEqual([slot_line(slot) for slot in slots], lines)

    def test_layered_order(self) -> None:
        first, *lines = example("layered-order")
        frames, pyramid, base_levels = integers(first.split()[1::2])
        slots = group_structure.layered_order(group_structure.group_structure(frames, pyramid), base_levels)
        told = [f"layer {group_structure.slot_layer(slot, base_levels)} {slot_line(slot)}" for slot in slots]
        self.assertEqual(told, lines)

    def test_harmonic_order(self) -> None:
        lines = keyed("harmonic-order")
        order = group_structure.harmonic_order(integers(lines["counts"]))
        self.assertEqual([f"({c},{k})" for c, k in order], lines["order"])

    def test_level_steps(self) -> None:
        for name in ("level-steps", "level-steps-capped"):
            lines = keyed(name)
            steps = integers(lines["steps"])
            growth = int(lines["growth"][0])
            self.assertEqual([group_structure.level_step(level, growth) for level in range(len(steps))], steps)

    def test_patches(self) -> None:
        lines = keyed("patches")
        x = integers(lines["x"])
        joined = [{w for w in (v - 1, v + 1) if 0 <= w < len(x)} for v in range(len(x))]
        grid = np.array([(coordinate, 0, 0) for coordinate in x])
        patches = vertices.cut_patches(list(range(len(x))), grid, joined, int(lines["size"][0]))
        self.assertEqual(" | ".join(" ".join(map(str, patch)) for patch in patches), " ".join(lines["patches"]))


class Geometry(unittest.TestCase):
    def test_inhomogeneity(self) -> None:
        rng = np.random.default_rng(1)
        at = dict(zip("xyz", rng.uniform(size=(3, 5))))
        total = np.zeros(5)
        for line in example("inhomogeneity"):
            factor, *variables = line.split()
            total += float(factor) * np.prod([at[variable] for variable in variables], axis=0)
        np.testing.assert_allclose(shape.inhomogeneity(**at), total, rtol=0, atol=1e-15)

    def test_generic_numbers(self) -> None:
        for i, number in pairs("generic"):
            self.assertEqual(harmonics.generic_numbers(np.array([int(i)]))[0], float(number))

    def test_handles(self) -> None:
        lines = keyed("handles")
        grid = np.array([(v * v, 0, 0) for v in range(10)])
        line = handles.length_neighbours(np.array([(v, v + 1) for v in range(9)]), grid)
        chosen, covering = handles.farthest_vertices(line, 3)
        self.assertEqual(chosen, integers(lines["handles"]))
        self.assertEqual(covering, int(lines["covering"][0]))
        nearest = handles.nearest_sources(line, chosen, handles.MOST_FOLLOWED + 1)
        followed, weights = handles.followed_handles(nearest[7], covering)
        self.assertEqual(followed, integers(lines["followed"]))
        np.testing.assert_allclose(weights, list(map(float, lines["weights"])), rtol=0, atol=5e-7)

    def test_deformation_gradient(self) -> None:
        channels, *rows = [list(map(float, line.split()[1:])) for line in example("deformation-gradient")]
        gradient = deformation_gradients(np.array([channels]))[0]
        np.testing.assert_allclose(gradient, rows, rtol=0, atol=5e-7)


class WholeStream(unittest.TestCase):
    def test_appendix(self) -> None:
        data = bytes.fromhex("".join(line.split("|")[0] for line in example("stream")))
        clip = decode_stream(data)
        expected = [line.split()[1:] for line in example("stream-positions")]
        self.assertEqual(len(clip.frames) * len(clip.frames[0]), len(expected))
        for frame, vertex, *position in expected:
            decoded = clip.frames[int(frame)][int(vertex)]
            np.testing.assert_allclose(decoded, list(map(float, position)), rtol=0, atol=6e-7)


if __name__ == "__main__":
    unittest.main()
