# SPDX-License-Identifier: Apache-2.0
"""Reading of streams."""

import gc
import io
import threading
import unittest

import numpy as np
from clips import VALID, sheet_uvs, waving_sheet

import sac


class Reading(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.data = (VALID / "pyramids.sac").read_bytes()
        cls.all = sac.open(cls.data)[:]

    def test_the_frames_are_those_of_the_conformance_manifest(self):
        self.assertEqual(self.all.shape, (45, 204, 3))
        self.assertEqual(self.all.dtype, np.float32)

    def test_any_way_to_a_frame_gives_the_same(self):
        clip = sac.open(VALID / "pyramids.sac")
        self.assertEqual(len(clip), 45)
        for i, positions in enumerate(clip):
            np.testing.assert_array_equal(positions, self.all[i])
        for i in (44, 3, 2, 41, 0, -1, -45, np.int64(7)):
            np.testing.assert_array_equal(clip[i], self.all[i])
        for part in (slice(3, 9), slice(None, None, -7), slice(40, 100), slice(9, 3), slice(-3, None)):
            np.testing.assert_array_equal(clip[part], self.all[part])
        self.assertEqual([f.index for f in clip.frames(40)], [40, 41, 42, 43, 44])
        self.assertEqual([f.index for f in clip.frames(2, 4)], [2, 3])

    def test_two_iterations_of_one_clip_do_not_disturb_each_other(self):
        clip = sac.open(self.data)
        for i, (one, other) in enumerate(zip(clip, clip)):
            np.testing.assert_array_equal(one, self.all[i])
            np.testing.assert_array_equal(other, self.all[i])

    def test_beyond_the_end_is_an_index_error(self):
        for clip in (sac.open(self.data), sac.open(self.data)):
            for i in (45, -46, 1 << 31):
                with self.assertRaisesRegex(IndexError, f"frame {i} of 45"):
                    clip[i]
        with self.assertRaises(TypeError):
            clip[1.5]

    def test_the_count_in_the_middle_does_not_disturb(self):
        clip = sac.open(self.data)
        frames = iter(clip)
        next(frames)
        self.assertEqual(len(clip), 45)
        np.testing.assert_array_equal(next(frames), self.all[1])

    def test_paths_bytes_and_files_are_sources(self):
        for source in (str(VALID / "pyramids.sac"), bytearray(self.data), memoryview(self.data), io.BytesIO(self.data)):
            np.testing.assert_array_equal(sac.open(source)[44], self.all[44])
        with self.assertRaises(FileNotFoundError):
            sac.open("no such file.sac")
        with self.assertRaises(TypeError):
            sac.open(io.StringIO("text"))

    def test_a_frame_is_decoded_into_the_given_array(self):
        clip = sac.open(self.data)
        interleaved = np.zeros((204, 8), np.float32)
        frame = clip.frame(5, out=interleaved[:, :3], normals=True)
        self.assertTrue(np.shares_memory(frame.positions, interleaved))
        np.testing.assert_array_equal(interleaved[:, :3], self.all[5])
        self.assertFalse(interleaved[:, 3:].any())
        np.testing.assert_allclose(np.linalg.norm(frame.normals, axis=1), 1, atol=1e-5)
        for bad in (np.zeros((203, 3), np.float32), np.zeros((204, 3)), np.zeros((3, 204), np.float32).T):
            with self.assertRaisesRegex(sac.InvalidArgumentError, "^out: "):
                clip.frame(5, out=bad)

    def test_the_mesh_is_the_decoders_memory_and_outlives_the_clip(self):
        clip = sac.open(self.data)
        faces, copy = clip.faces, clip.faces.copy()
        self.assertFalse(faces.flags.owndata)
        self.assertFalse(faces.flags.writeable)
        del clip
        gc.collect()
        junk = [sac.open(self.data) for _ in range(3)]
        np.testing.assert_array_equal(faces, copy)
        self.assertEqual(len(junk), 3)


class Times(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        faces, frames = waving_sheet(20)
        cls.clip = sac.open(sac.encode(faces, frames, fps=10, quality=90).data)
        cls.all = cls.clip[:]

    def test_a_frame_is_shown_from_its_time_on(self):
        self.assertEqual((self.clip.fps, self.clip.duration), (10, 2))
        for seconds, frame in ((0, 0), (0.35, 3), (0.1999, 1), (0.2, 2), (1.99, 19)):
            got = self.clip.at(seconds)
            self.assertEqual(got.index, frame)
            self.assertAlmostEqual(got.time, frame / 10)
            np.testing.assert_array_equal(got.positions, self.all[frame])
        for seconds in (2.0, -0.1, float("nan")):
            with self.assertRaises(sac.InvalidArgumentError):
                self.clip.at(seconds)

    def test_between_frames_the_shape_is_between(self):
        for time in (0.5, 7.25, 3.5, 18.75, 3.5):
            low = int(time)
            got = self.clip.interpolate(time)
            mean = self.all[low] + (time - low) * (self.all[low + 1] - self.all[low])
            self.assertEqual(got.index, low)
            # The sheet is 1 wide and moves by 0.06 a frame.
            self.assertLess(np.abs(got.positions - mean).max(), 0.004)
            self.assertGreater(np.abs(got.positions - self.all[low]).max(), 0.008)
        np.testing.assert_array_equal(self.clip.interpolate(4).positions, self.all[4])
        np.testing.assert_array_equal(self.clip.interpolate(19.5).positions, self.all[19])
        np.testing.assert_array_equal(
            self.clip.interpolate_at(0.55).positions, self.clip.interpolate(0.55 * 10).positions
        )
        np.testing.assert_array_equal(self.clip[5], self.all[5])
        for time in (20, -1, float("nan"), float("inf")):
            with self.assertRaises(sac.InvalidArgumentError):
                self.clip.interpolate(time)

    def test_without_a_rate_there_are_no_times(self):
        clip = sac.open(VALID / "pyramids.sac")
        self.assertIsNone(clip.fps)
        self.assertIsNone(clip.duration)
        with self.assertRaisesRegex(sac.InvalidArgumentError, "no frame rate"):
            clip.at(1)
        with self.assertRaisesRegex(sac.InvalidArgumentError, "no frame rate"):
            clip.interpolate_at(1)


class Damage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        faces, frames = waving_sheet(30)
        cls.data = sac.encode(faces, frames, group=10, measure=False).data
        cls.all = sac.open(cls.data)[:]

    def test_bytes_that_are_no_stream(self):
        with self.assertRaisesRegex(sac.CorruptError, "^stream: "):
            sac.open(b"no stream at all")
        with self.assertRaisesRegex(sac.CorruptError, "^stream: "):
            sac.open(b"")
        with self.assertRaises(sac.Error):
            sac.open((VALID / "pyramids.sac").read_bytes()[:200])

    def test_a_stream_that_is_cut_off(self):
        clip = sac.open(self.data[: len(self.data) * 9 // 10])
        got = []
        with self.assertRaises(sac.CorruptError):
            for positions in clip:
                got.append(positions)
        self.assertIn(len(got), (10, 20))
        np.testing.assert_array_equal(np.array(got), self.all[: len(got)])
        np.testing.assert_array_equal(clip[2], self.all[2])

    def test_damage_costs_the_groups_that_it_hits(self):
        # The second group begins where a decoder that seeks frame 10 goes on.
        clip = sac.open(self.data)
        clip._decoder.seek(10)
        damaged = bytearray(self.data)
        damaged[clip._decoder._at + 40] ^= 0xFF
        with self.assertRaises(sac.CorruptError):
            list(sac.open(bytes(damaged)))
        clip = sac.open(bytes(damaged), skip_damage=True)
        shown = list(clip.frames())
        self.assertEqual([f.index for f in shown], [*range(10), *range(20, 30)])
        self.assertEqual(clip.lost, [range(10, 20)])
        np.testing.assert_array_equal(shown[10].positions, self.all[20])
        with self.assertRaisesRegex(sac.CorruptError, "frame 12 is lost"):
            clip[12]
        np.testing.assert_array_equal(clip[25], self.all[25])

    def test_fewer_layers_are_coarser(self):
        clip = sac.open(VALID / "layers.sac")
        self.assertEqual(clip.layers, 0)
        fine = clip[:]
        self.assertGreaterEqual(clip.layers, 3)
        coarse = sac.open(VALID / "layers.sac", layers=1)[:]
        self.assertEqual(coarse.shape, fine.shape)
        self.assertGreater(np.abs(coarse - fine).max(), 0)
        np.testing.assert_array_equal(sac.open(VALID / "layers.sac", layers=clip.layers)[:], fine)
        for bad in (0, -1, 1 << 32):
            with self.assertRaisesRegex(sac.InvalidArgumentError, "layers cannot be decoded"):
                sac.open(self.data, layers=bad)

    def test_a_second_mesh_is_told(self):
        got = []
        with self.assertRaisesRegex(sac.UnsupportedError, "another mesh"):
            for positions in sac.open(VALID / "segments.sac"):
                got.append(positions)
        self.assertGreater(len(got), 0)

    def test_limits(self):
        with self.assertRaises(sac.LimitError):
            sac.open(self.data, max_vertices=10)
        with self.assertRaises(sac.LimitError):
            sac.open(self.data, max_memory=1000)
        with self.assertRaises(sac.InvalidArgumentError):
            sac.open(self.data, max_work=-1.0)
        with self.assertRaises(sac.InvalidArgumentError):
            sac.open(self.data, threads=5000)
        with self.assertRaisesRegex(TypeError, "max_length"):
            sac.open(self.data, max_length=3)


class Orders(unittest.TestCase):
    def test_vertices_come_in_the_order_that_is_asked_for(self):
        faces, frames = waving_sheet(6)
        colors = np.arange(64 * 4).reshape(64, 4).astype(np.uint8)
        kept = sac.encode(faces, frames, quality=95, keep_order=True, colors=colors, uvs=sheet_uvs())
        plain = sac.encode(faces, frames, quality=95, colors=colors, uvs=sheet_uvs())
        for encoding, order in ((kept, True), (kept, kept.order), (plain, plain.order)):
            clip = sac.open(encoding.data, order=order)
            self.assertLess(np.abs(clip[:] - frames).max(), 0.01)
            self.assertLess(np.abs(clip.interpolate(2).positions - frames[2]).max(), 0.01)
            np.testing.assert_array_equal(clip.colors, colors)
            ways = {tuple(np.roll(f, -np.argmin(f))) for f in clip.faces.tolist()}
            self.assertEqual(ways, {tuple(np.roll(f, -np.argmin(f))) for f in faces.tolist()})
            uvs = np.empty((64, 2))
            uvs[clip.faces] = clip.uvs[clip.uv_faces]
            np.testing.assert_allclose(uvs, sheet_uvs(), atol=1e-3)
        self.assertIsNone(sac.open(plain.data).order)
        np.testing.assert_array_equal(sac.open(kept.data).order, kept.order)
        with self.assertRaisesRegex(sac.InvalidArgumentError, "does not keep the order"):
            sac.open(plain.data, order=True)
        with self.assertRaisesRegex(sac.InvalidArgumentError, "^order: "):
            sac.open(plain.data, order=np.zeros(64, int))


class Threads(unittest.TestCase):
    def test_others_run_while_the_library_works(self):
        """A thread sees the other's calls in progress only if those let go of the interpreter."""
        faces, frames = waving_sheet(12, side=20)
        working, seen = threading.Event(), []
        done = threading.Event()

        def watch():
            working.wait()
            while not done.is_set():
                seen.append(None)

        def slow(*_):
            working.set()

        watcher = threading.Thread(target=watch)
        watcher.start()
        sac.encode(faces, frames, reference_rounds=0, progress=slow)
        before = len(seen)
        list(sac.open(sac.encode(faces, frames, measure=False).data))
        done.set()
        watcher.join()
        self.assertGreater(before, 1000)

    def test_one_clip_serves_several_threads(self):
        data = (VALID / "pyramids.sac").read_bytes()
        clip, expected, wrong = sac.open(data, threads=2), sac.open(data)[:], []

        def read(seed):
            for i in np.random.default_rng(seed).integers(0, 45, 60):
                if not np.array_equal(clip[int(i)], expected[i]):
                    wrong.append(i)

        threads = [threading.Thread(target=read, args=(seed,)) for seed in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(wrong, [])


if __name__ == "__main__":
    unittest.main()
