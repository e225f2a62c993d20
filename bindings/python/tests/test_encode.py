# SPDX-License-Identifier: Apache-2.0
"""Encoding of clips, measuring, and what is refused."""

import fractions
import os
import pathlib
import stat
import tempfile
import unittest
import warnings

import numpy as np
from clips import sheet_uvs, waving_sheet

import sac


class Encoding(unittest.TestCase):
    def test_what_is_measured_is_what_a_decoder_shows(self):
        faces, frames = waving_sheet()
        encoding = sac.encode(faces, frames, fps=24, quality=70)
        clip = sac.open(encoding.data, order=encoding.order)
        again = sac.compare(faces, frames, clip)
        self.assertEqual((again.frames, encoding.frames, len(clip)), (20, 20, 20))
        for one, other in zip(again, encoding.distortion):
            self.assertAlmostEqual(one, other, places=6)
        self.assertAlmostEqual(encoding.max_error, np.linalg.norm(clip[:] - frames, axis=2).max(), places=6)
        self.assertEqual(encoding.bytes, len(encoding.data))
        self.assertAlmostEqual(sum(encoding.parts.values()), encoding.bytes)
        self.assertAlmostEqual(encoding.bpvf, 8 * encoding.bytes / frames[:, :, 0].size)

    def test_targets_are_kept(self):
        faces, frames = waving_sheet()
        encoding = sac.encode(faces, frames, target_sted=0.03, target_kg=2)
        self.assertLessEqual(encoding.sted, 0.03)
        self.assertLessEqual(encoding.kg, 2)
        self.assertGreater(encoding.trials, 1)
        looser = sac.encode(faces, frames, target_sted=0.1)
        self.assertLess(looser.bytes, encoding.bytes)
        with self.assertRaises(sac.InvalidArgumentError):
            sac.encode(faces, frames, target_bpvf=1e-9)

    def test_max_error_and_other_settings(self):
        faces, frames = waving_sheet()
        self.assertLessEqual(sac.encode(faces, frames, max_error=0.001).max_error, 0.001)
        few = sac.encode(faces, frames, group=4, low_delay=True, reference_rounds=0, harmonics=12)
        self.assertEqual(len(sac.open(few.data)), 20)
        for name in ("groups", "user", "struct_size"):
            with self.assertRaisesRegex(TypeError, name):
                sac.encode(faces, frames, **{name: 3})
        for bad in (dict(quality=101), dict(group=0), dict(group=-1), dict(harmonics=1 << 40), dict(quality="high")):
            with self.assertRaises(sac.InvalidArgumentError):
                sac.encode(faces, frames, **bad)

    def test_any_source_of_frames(self):
        faces, frames = waving_sheet()
        expected = sac.encode(faces, frames).data
        self.assertEqual(sac.encode(faces.tolist(), list(frames)).data, expected)
        self.assertEqual(sac.encode(faces, (frame for frame in frames)).data, expected)
        self.assertEqual(sac.encode(faces, frames[:, :, ::-1][:, :, ::-1]).data, expected)
        clip = sac.open(expected)
        self.assertEqual(len(sac.open(sac.encode(clip.faces, clip).data)), 20)

    def test_rates(self):
        faces, frames = waving_sheet(3)
        for fps, rate in (
            (25, 25),
            (23.976, fractions.Fraction(24000, 1001)),
            (29.97, fractions.Fraction(30000, 1001)),
            (12.34, fractions.Fraction(617, 50)),
            ((30000, 1001), fractions.Fraction(30000, 1001)),
            (30000 / 1001, fractions.Fraction(30000, 1001)),
            (np.float32(12.5), 12.5),
            (None, None),
        ):
            self.assertEqual(sac.open(sac.encode(faces, frames, fps=fps).data).rate, rate)
        for fps in (0, -1, "fast", float("nan"), (1, 0)):
            with self.assertRaisesRegex(sac.InvalidArgumentError, "^fps: "):
                sac.encode(faces, frames, fps=fps)

    def test_attributes(self):
        faces, frames = waving_sheet(4)
        colors = np.random.default_rng(1).random((64, 3))
        normals = np.tile([0, 0, 1.0], (64, 1))
        encoding = sac.encode(faces, frames, uvs=sheet_uvs(), normals=normals, colors=colors)
        clip = sac.open(encoding.data, order=encoding.order)
        np.testing.assert_array_equal(clip.colors, np.hstack([np.round(colors * 255), np.full((64, 1), 255)]))
        np.testing.assert_allclose(clip.normals, normals, atol=0.01)
        hard = np.array([[0, 0, 1.0], [0, 1, 0]])
        corners = np.repeat(np.arange(len(faces)) % 2, 3).reshape(-1, 3)
        clip = sac.open(sac.encode(faces, frames, normals=hard, normal_faces=corners).data)
        got = clip.normals[clip.normal_faces]
        self.assertTrue(np.allclose(got.min(axis=1), got.max(axis=1)))
        self.assertEqual(np.count_nonzero(got[:, 0, 1] > 0.9), np.count_nonzero(corners[:, 0]))

    def test_what_is_said_of_the_clip(self):
        faces, frames = waving_sheet(4)
        said = dict(name="Wäsche", json='{"shot": 7}', metres_per_unit=0.01, up_axis=2, first_frame=1001, loops=True)
        clip = sac.open(sac.encode(faces, frames, bounds=True, **said).data)
        got = clip.metadata
        np.testing.assert_allclose(got.pop("box"), [frames.min(axis=(0, 1)), frames.max(axis=(0, 1))], atol=1e-6)
        self.assertEqual(got, said)
        self.assertEqual(set(sac.open(sac.encode(faces, frames).data).metadata) - {"first_frame"}, set())

    def test_double_precision_far_from_the_origin(self):
        faces, frames = waving_sheet(5, dtype=np.float64)
        far = frames + [4e6, -7e6, 100]
        encoding = sac.encode(faces, far, quality=95)
        clip = sac.open(encoding.data, order=encoding.order)
        self.assertTrue(clip.offset.any())
        np.testing.assert_array_equal(clip.offset, encoding.offset)
        self.assertLess(np.abs(clip[:] + clip.offset - far).max(), 0.01)
        given = sac.open(sac.encode(faces, far, offset=(4e6, -7e6, 0), quality=95).data)
        np.testing.assert_array_equal(given.offset, [4e6, -7e6, 0])


class Refusals(unittest.TestCase):
    def test_arrays_that_do_not_fit(self):
        faces, frames = waving_sheet(4)
        nan = frames.copy()
        nan[2, 5, 1] = np.nan
        for arguments, text in (
            ((faces + 64, frames), "triangle"),
            ((faces.astype(float), frames), "^faces: integers"),
            ((-faces, frames), "^faces: an index"),
            ((np.hstack([faces, faces[:, :1]]), frames), "cut polygons into triangles"),
            ((faces, frames[:, :, :2]), "vertices, 3"),
            ((faces, frames[0]), "vertices, 3"),
            ((faces, []), "there are none"),
            ((faces, [*frames, frames[0][:-1]]), "^frame 4: "),
            ((faces, nan), "frame 2"),
            ((faces, frames.astype(str)), "numbers are needed"),
        ):
            with self.subTest(text=text), self.assertRaisesRegex(sac.InvalidArgumentError, text):
                sac.encode(*arguments)
        for attributes, text in (
            (dict(uvs=np.zeros((5, 2))), "^uvs: "),
            (dict(uv_faces=faces), "there are no uvs"),
            (dict(uvs=np.zeros((64, 2)), uv_faces=faces[1:]), "^uv_faces: "),
            (dict(normals=np.zeros((64, 2))), "^normals: "),
            (dict(colors=np.full((64, 3), 2.0)), "^colors: "),
            (dict(colors=np.zeros((63, 4), np.uint8)), "^colors: "),
        ):
            with self.subTest(text=text), self.assertRaisesRegex(sac.InvalidArgumentError, text):
                sac.encode(faces, frames, **attributes)

    def test_exceptions_of_the_caller_come_through(self):
        faces, frames = waving_sheet()

        class Frames:
            def __iter__(self):
                yield frames[0]
                raise KeyError("the seventh")

        with self.assertRaisesRegex(KeyError, "the seventh"):
            sac.encode(faces, Frames())

        def interrupt(*_):
            raise KeyboardInterrupt

        with self.assertRaises(KeyboardInterrupt):
            sac.encode(faces, frames, progress=interrupt)
        calls = []
        with self.assertRaises(sac.CancelledError):
            sac.encode(faces, frames, progress=lambda trial, done: calls.append((trial, done)) or done < 5)
        self.assertEqual(calls[-1][1], 5)

    def test_a_file_is_there_when_it_is_complete(self):
        faces, frames = waving_sheet()
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "clip.sac"
            with self.assertRaises(sac.CancelledError):
                sac.encode(faces, frames, path, progress=lambda *_: False)
            self.assertEqual(os.listdir(folder), [])
            encoding = sac.encode(faces, frames, path, reference_rounds=0)
            self.assertIsNone(encoding.data)
            self.assertEqual(path.stat().st_size, encoding.bytes)
            self.assertEqual(os.listdir(folder), ["clip.sac"])
            mask = os.umask(0)
            os.umask(mask)
            self.assertEqual(stat.S_IMODE(path.stat().st_mode), 0o666 & ~mask)
            with self.assertRaises(FileNotFoundError):
                sac.encode(faces, frames, os.path.join(folder, "no", "clip.sac"))

    def test_what_is_lost_is_told(self):
        # Draco, which codes texture coordinates, codes no degenerate triangle.
        faces, frames = np.array([[0, 1, 1], [1, 0, 0]]), np.eye(2, 3, dtype=np.float32)[None]
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            encoding = sac.encode(faces, frames, uvs=np.eye(2))
        self.assertIsNone(sac.open(encoding.data).uvs)
        self.assertEqual([w.category for w in told], [sac.LossWarning])
        self.assertIn("texture coordinates", str(told[0].message))


class FrameByFrame(unittest.TestCase):
    def test_the_stream_is_that_of_the_clip(self):
        faces, frames = waving_sheet()
        expected = sac.encode(faces, frames, fps=30, group=5, reference_rounds=0)
        encoder = sac.Encoder(faces, frames[0], fps=30, group=5)
        pieces = [encoder.send(frame) for frame in frames]
        pieces.append(encoder.finish())
        self.assertEqual(b"".join(pieces), expected.data)
        self.assertGreater(sum(map(bool, pieces)), 3)
        np.testing.assert_array_equal(encoder.order, expected.order)
        self.assertAlmostEqual(sum(encoder.parts.values()), expected.bytes)

    def test_refusals(self):
        faces, frames = waving_sheet(2)
        encoder = sac.Encoder(faces, frames[0])
        with self.assertRaisesRegex(sac.InvalidArgumentError, "^frame 0: "):
            encoder.send(frames[0][1:])
        with self.assertRaises(sac.InvalidArgumentError):
            encoder.send(np.full((64, 3), np.inf))
        self.assertTrue(encoder.send(frames[0]) + encoder.finish())
        with self.assertRaisesRegex(sac.InvalidArgumentError, "targets"):
            sac.Encoder(faces, frames[0], target_kg=1.0)


class Comparing(unittest.TestCase):
    def test_known_answers(self):
        faces, frames = waving_sheet()
        self.assertEqual(sac.compare(faces, frames, frames), sac.Distortion(0, 0, 0, 0, 0, 0, 20))
        moved = sac.compare(faces, frames, frames + np.float32([0, 0, 0.25]))
        self.assertAlmostEqual(moved.max_error, 0.25, places=6)
        self.assertAlmostEqual(moved.sted, 0, places=5)  # edges are as they were
        spread = frames - frames.mean(axis=1, keepdims=True)
        self.assertAlmostEqual(moved.kg, 100 * 0.25 * np.sqrt(64 * 20) / np.linalg.norm(spread), places=3)

    def test_clips_that_differ(self):
        faces, frames = waving_sheet(3)
        with self.assertRaisesRegex(sac.InvalidArgumentError, "one clip has 2 frames"):
            sac.compare(faces, frames, frames[:2])
        with self.assertRaisesRegex(sac.InvalidArgumentError, "^decoded: "):
            sac.compare(faces, frames, frames[:, 1:])
        with self.assertRaisesRegex(sac.InvalidArgumentError, "triangle 1 has vertex 99 of 64"):
            sac.compare([[0, 1, 2], [0, 1, 99]], frames, frames)


if __name__ == "__main__":
    unittest.main()
