# SPDX-License-Identifier: Apache-2.0
"""The add-on in a Blender without a window, installed from its zip as a user does.

usage: blender -b --factory-startup --python-exit-code 1 --python test_addon.py -- ADDON.zip STREAM.sac
"""

import contextlib
import io
import os
import sys
import tempfile
import unittest

import bpy
import numpy as np

ZIP, STREAM = sys.argv[sys.argv.index("--") + 1 :]


def install():
    bpy.ops.preferences.addon_install(filepath=ZIP)
    bpy.ops.preferences.addon_enable(module="sac_animation")


def positions(thing):
    """Evaluated positions of an object (vertices, 3), in the world."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    evaluated = thing.evaluated_get(depsgraph)
    mesh = evaluated.to_mesh()
    values = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", values)
    evaluated.to_mesh_clear()
    matrix = np.array(evaluated.matrix_world)
    return values.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]


def to_author(points):
    """From Blender's axes to those of a stream with y up."""
    return np.stack([points[:, 0], points[:, 2], -points[:, 1]], 1)


class Addon(unittest.TestCase):
    def setUp(self):
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        if "sac_animation" not in bpy.context.preferences.addons:
            install()
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        import sac_animation

        self.addon, self.sac = sac_animation, sac_animation.sac
        self.scene = bpy.context.scene
        self.scene.render.fps = 30
        self.clip = self.sac.open(STREAM)
        if self.clip.order is not None:
            self.clip = self.sac.open(STREAM, order=True)

    def load(self, path=STREAM, **options):
        self.assertEqual(bpy.ops.import_mesh.sac(filepath=path, **options), {"FINISHED"})
        return bpy.context.object

    def save(self, name="out.sac", **options):
        path = os.path.join(self.folder, name)
        self.assertEqual(bpy.ops.export_mesh.sac(filepath=path, **options), {"FINISHED"})
        return path

    def assert_shows(self, thing, expected, tolerance=1e-6):
        np.testing.assert_allclose(to_author(positions(thing)), expected, atol=tolerance)

    def waving_grid(self):
        bpy.ops.mesh.primitive_grid_add(x_subdivisions=9, y_subdivisions=7, size=2)
        thing = bpy.context.object
        wave = thing.modifiers.new("Wave", "WAVE")
        wave.height, wave.width, wave.speed = 0.3, 0.8, 0.1
        thing.location = (1, 2, 3)
        thing.keyframe_insert("location", frame=1)
        thing.location = (2, 2, 3)
        thing.rotation_euler = (0.3, 0.1, 1)
        thing.keyframe_insert("location", frame=20)
        self.scene.frame_start, self.scene.frame_end = 1, 20
        return thing


class Importing(Addon):
    def test_the_time_line_shows_the_frames_of_the_stream(self):
        thing = self.load()
        self.assertEqual(len(thing.data.polygons), len(self.clip.faces))
        for frame in (1, 2, 3, 45, 44, 17, 1, 30):
            self.scene.frame_set(frame)
            self.assert_shows(thing, self.clip[frame - 1])
        for frame, shown in ((-20, 0), (46, 44), (400, 44)):
            self.scene.frame_set(frame)
            self.assert_shows(thing, self.clip[shown])
        self.assertGreater(np.abs(self.clip[0] - self.clip[17]).max(), 0.05)

    def test_sub_frames_are_shapes_between(self):
        thing = self.load()
        for frame, part in ((3, 0.5), (20, 0.25), (3, 0.5), (44, 0.75)):
            self.scene.frame_set(frame, subframe=part)
            self.assert_shows(thing, self.clip.interpolate(frame - 1 + part).positions)
        thing.data.sac.interpolate = False
        self.scene.frame_set(3, subframe=0.5)
        self.assert_shows(thing, self.clip[2])

    def test_the_frame_range_grows(self):
        self.scene.frame_start, self.scene.frame_end = 11, 12
        thing = self.load()
        self.assertEqual(self.scene.frame_end, 55)
        self.scene.frame_set(12)
        self.assert_shows(thing, self.clip[1])

    def test_rate_speed_loop_and_retiming(self):
        faces, frames = self.clip.faces, self.clip[:20]
        path = os.path.join(self.folder, "slow.sac")
        order = self.sac.encode(faces, frames, path, fps=15, keep_order=True).order
        clip = self.sac.open(path, order=order)
        thing = self.load(path)
        self.assertEqual(self.scene.frame_end, 250)
        settings = thing.data.sac
        self.scene.frame_set(5)
        self.assert_shows(thing, clip[2])
        self.scene.frame_set(6)
        self.assert_shows(thing, clip.interpolate(2.5).positions)
        settings.use_rate = False
        self.assert_shows(thing, clip[5])
        settings.speed, settings.outside = -1, "LOOP"
        self.assert_shows(thing, clip[15])
        settings.use_frame = True
        for at, frame in ((1, 18.0), (11, 8.0)):
            settings.frame = frame
            thing.data.keyframe_insert("sac.frame", frame=at)
        for curve in thing.data.animation_data.action.fcurves:
            for point in curve.keyframe_points:
                point.interpolation = "LINEAR"
        self.scene.frame_set(6)
        self.assert_shows(thing, clip[13], 1e-4)
        self.scene.frame_set(6, subframe=0.5)
        self.assert_shows(thing, clip.interpolate(12.5).positions, 1e-4)

    def test_attributes(self):
        faces, frames = self.clip.faces, self.clip[:3]
        count = self.clip.vertices
        random = np.random.default_rng(3)
        uvs = random.random((3 * len(faces), 2))
        colors = random.integers(0, 256, (count, 4)).astype(np.uint8)
        hard = np.array([[0, 0, 1.0], [0, 1, 0]])
        corners = np.repeat((faces.min(axis=1) % 2)[:, None], 3, axis=1)
        path = os.path.join(self.folder, "attributes.sac")
        self.sac.encode(
            faces,
            frames,
            path,
            uvs=uvs,
            uv_faces=np.arange(3 * len(faces)).reshape(-1, 3),
            colors=colors,
            normals=hard,
            normal_faces=corners,
            keep_order=True,
        )
        clip = self.sac.open(path, order=True)
        mesh = self.load(path).data
        loops = np.array([loop.vertex_index for loop in mesh.loops]).reshape(-1, 3)
        np.testing.assert_array_equal(loops, clip.faces)
        got = np.array([tuple(corner.uv) for corner in mesh.uv_layers[0].data]).reshape(-1, 3, 2)
        np.testing.assert_allclose(got, clip.uvs[clip.uv_faces], atol=1e-6)
        got = np.array([tuple(color.color_srgb) for color in mesh.color_attributes[0].data])
        np.testing.assert_allclose(got * 255, colors, atol=1)
        normals = clip.normals[clip.normal_faces].round(2)
        kinds = {}
        for triangle, normal in zip(clip.faces.tolist(), normals):
            for k in range(3):
                edge = tuple(sorted((triangle[k], triangle[(k + 1) % 3])))
                kinds.setdefault(edge, set()).add(tuple(normal[0]))
        expected = {edge for edge, seen in kinds.items() if len(seen) > 1}
        self.assertGreater(len(expected), 20)
        self.assertEqual({tuple(sorted(e.vertices)) for e in mesh.edges if e.use_edge_sharp}, expected)

    def test_a_saved_scene_plays_again(self):
        thing = self.load()
        name, path = thing.name, os.path.join(self.folder, "scene.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        self.scene.frame_set(9)
        bpy.ops.wm.open_mainfile(filepath=path)
        bpy.context.scene.frame_set(33)
        self.assert_shows(bpy.data.objects[name], self.clip[32])

    def test_streams_that_cannot_be_read(self):
        bad = os.path.join(self.folder, "bad.sac")
        with open(bad, "wb") as file:
            file.write(b"no stream")
        for path, text in ((bad, "bad.sac: "), (os.path.join(self.folder, "none.sac"), "No such file")):
            with self.assertRaisesRegex(RuntimeError, text):
                bpy.ops.import_mesh.sac(filepath=path)
        self.assertEqual(len(bpy.data.meshes), 0)

    def test_a_stream_that_goes_is_told(self):
        path = os.path.join(self.folder, "copy.sac")
        with open(STREAM, "rb") as source, open(path, "wb") as copy:
            copy.write(source.read())
        thing = self.load(path)
        self.scene.frame_set(5)
        os.unlink(path)
        told = io.StringIO()
        with contextlib.redirect_stdout(told):
            self.scene.frame_set(6)
            self.scene.frame_set(7)
        self.assertEqual(told.getvalue().count("No such file"), 1)
        self.assertIn("No such file", thing.data.sac.message)
        self.assert_shows(thing, self.clip[4])
        thing.data.sac.filepath = STREAM
        self.assertEqual(thing.data.sac.message, "")
        self.assert_shows(thing, self.clip[6])
        thing.data.vertices.add(1)
        self.scene.frame_set(8)
        self.assertIn("the mesh", thing.data.sac.message)

    def test_the_cache_stays_within_its_size(self):
        cache = self.addon.frames.FrameCache()
        for i in range(10):
            cache.put(i, np.zeros(100, np.uint8), 350)
            cache.get(0)
        self.assertEqual([i for i in range(10) if cache.get(i) is not None], [0, 8, 9])
        cache.put(9, np.zeros(400, np.uint8), 350)
        self.assertIsNone(cache.get(9))


class Exporting(Addon):
    def test_an_imported_clip_goes_out_as_it_came(self):
        self.load()
        self.scene.frame_end = 45
        path = self.save(quality=90, keep_order=True)
        again = self.sac.open(path, order=True)
        self.assertEqual(again.rate, 30)
        distortion = self.sac.compare(self.clip.faces, self.clip, again)
        self.assertEqual(distortion.frames, 45)
        self.assertLess(distortion.kg, 0.3)
        self.assertLess(distortion.sted, 0.02)

    def test_the_evaluated_animation_goes_out(self):
        thing = self.waving_grid()
        self.scene.frame_set(7)
        expected = []
        for frame in range(1, 21):
            self.scene.frame_set(frame)
            expected.append(to_author(positions(thing)))
        self.scene.frame_set(7)
        path = self.save(quality=95, keep_order=True)
        self.assertEqual(self.scene.frame_current, 7)
        clip = self.sac.open(path, order=True)
        self.assertLess(np.abs(clip[:] - np.array(expected)).max(), 0.01)
        self.assertGreater(np.abs(np.diff(expected, axis=0)).max(), 0.02)
        self.assertEqual(len(clip.faces), 2 * len(thing.data.polygons))
        self.assertIsNotNone(clip.uvs)
        # And in again, beside the object itself.
        thing.select_set(False)
        other = self.load(path)
        self.scene.frame_set(12)
        np.testing.assert_allclose(positions(other), positions(thing), atol=0.01)

    def test_axes_unit_and_first_frame_come_back(self):
        thing = self.waving_grid()
        self.scene.frame_start = 5
        path = self.save(quality=95, keep_order=True, axis_forward="Y", axis_up="Z", scale=100)
        metadata = self.sac.open(path).metadata
        self.assertEqual((metadata["up_axis"], metadata["first_frame"]), (2, 5))
        self.assertAlmostEqual(metadata["metres_per_unit"], 0.01)
        self.scene.frame_start = 1
        other = self.load(path)
        self.scene.frame_set(9)
        np.testing.assert_allclose(positions(other), positions(thing), atol=0.01)
        self.assertAlmostEqual(self.load(path, as_told=False).matrix_world.median_scale, 1, places=5)

    def test_samples_between_frames_and_a_wanted_error(self):
        thing = self.waving_grid()
        path = self.save(samples=2, use_sted=True, sted=0.02, keep_order=True, use_scene_range=False, first=3, last=9)
        clip = self.sac.open(path, order=True)
        self.assertEqual((len(clip), clip.rate), (13, 60))
        self.scene.frame_set(4, subframe=0.5)
        self.assertLess(np.abs(clip[3] - to_author(positions(thing))).max(), 0.05)

    def test_several_objects_become_one_mesh(self):
        bpy.ops.mesh.primitive_cube_add(location=(3, 0, 0))
        cube = bpy.context.object
        cube.scale = (1, 1, -1)  # a mirror
        bpy.ops.mesh.primitive_uv_sphere_add(segments=12, ring_count=8)
        sphere = bpy.context.object
        cube.select_set(True)
        self.scene.frame_start, self.scene.frame_end = 1, 3
        path = self.save(quality=90, normals=True)
        clip = self.sac.open(path)
        self.assertEqual(clip.vertices, len(cube.data.vertices) + len(sphere.data.vertices))
        # All triangles look outward, from the middle of their own object.
        corners = clip[0][clip.faces]
        middles = corners.mean(axis=1)
        centers = np.where(middles[:, :1] > 1.5, [[3, 0, 0]], [[0, 0, 0]])
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        self.assertTrue(((normals * (middles - centers)).sum(axis=1) > 0).all())
        self.assertIsNotNone(clip.normal_faces)
        coded = clip.normals[clip.normal_faces].mean(axis=1)
        self.assertTrue(((coded * (middles - centers)).sum(axis=1) > 0).all())

    def test_meshes_that_change_are_refused(self):
        bpy.ops.mesh.primitive_cube_add()
        thing = bpy.context.object
        build = thing.modifiers.new("Build", "BUILD")
        build.frame_start, build.frame_duration = 1, 10
        self.scene.frame_start, self.scene.frame_end = 5, 10
        path = os.path.join(self.folder, "out.sac")
        with self.assertRaisesRegex(RuntimeError, r"frame \d+: Cube has"):
            bpy.ops.export_mesh.sac(filepath=path)
        self.assertEqual(os.listdir(self.folder), [])
        bpy.ops.object.select_all(action="DESELECT")
        bpy.context.view_layer.objects.active = None
        with self.assertRaisesRegex(RuntimeError, "no object"):
            bpy.ops.export_mesh.sac(filepath=path)


class Rendering(Addon):
    def test_motion_blur_sees_the_sub_frames(self):
        """Cycles asks for the positions at the shutter's opening and closing."""
        thing = self.load()
        times = []
        show = self.addon.frames.ClipFrames.at

        def record(frames, time, *rest):
            times.append(time)
            return show(frames, time, *rest)

        bpy.ops.object.camera_add(location=(0, 0, 20))
        self.scene.camera = bpy.context.object
        render = self.scene.render
        render.engine = "CYCLES"
        render.resolution_x = render.resolution_y = 16
        self.scene.cycles.samples = 1
        self.scene.cycles.use_denoising = False  # which needs a library that not every Blender has
        render.use_motion_blur = True
        if bpy.app.version < (4, 2, 0):
            self.scene.cycles.motion_blur_position = "CENTER"
        render.motion_blur_shutter = 0.5
        render.filepath = os.path.join(self.folder, "blur.png")
        self.scene.frame_set(10)
        self.addon.frames.ClipFrames.at = record
        try:
            bpy.ops.render.render(write_still=True)
        finally:
            self.addon.frames.ClipFrames.at = show
        self.assertTrue({8.75, 9.25} <= {round(time, 3) for time in times}, times)
        self.assertTrue(os.path.exists(render.filepath))
        self.assert_shows(thing, self.clip[9])


if __name__ == "__main__":
    result = unittest.main(argv=["test_addon"], exit=False, verbosity=2).result
    # Blender's own exit code tells of exceptions alone.
    bpy.ops.preferences.addon_disable(module="sac_animation")
    sys.exit(0 if result.wasSuccessful() else 1)
