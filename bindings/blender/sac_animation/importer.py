# SPDX-License-Identifier: Apache-2.0
"""File > Import: a stream as a mesh that plays."""

import math
import os

import bpy
import numpy as np
from bpy_extras.io_utils import ImportHelper, axis_conversion, orientation_helper
from mathutils import Matrix

from . import player, sac


def _sharp_edges(faces, normal_faces):
    """The edges (count, 2) at which triangles have different normals at a vertex, each with the smaller vertex first."""
    ends = np.stack([faces, np.roll(faces, -1, axis=1)], -1).reshape(-1, 2)
    normals = np.stack([normal_faces, np.roll(normal_faces, -1, axis=1)], -1).reshape(-1, 2)
    swap = ends[:, 0] > ends[:, 1]
    ends[swap], normals[swap] = ends[swap][:, ::-1], normals[swap][:, ::-1]
    kinds = np.unique(np.hstack([ends, normals]), axis=0)
    edges, count = np.unique(kinds[:, :2], axis=0, return_counts=True)
    return edges[count > 1]


def _mark_sharp(mesh, edges):
    """Marks edges sharp."""
    vertices = np.empty(2 * len(mesh.edges), np.int32)
    mesh.edges.foreach_get("vertices", vertices)
    vertices = np.sort(vertices.reshape(-1, 2).astype(np.int64), axis=1)
    keys = vertices[:, 0] << 32 | vertices[:, 1]
    wanted = edges[:, 0].astype(np.int64) << 32 | edges[:, 1].astype(np.int64)
    mesh.edges.foreach_set("use_edge_sharp", np.isin(keys, wanted))
    if bpy.app.version < (4, 1, 0):
        mesh.use_auto_smooth = True
        mesh.auto_smooth_angle = math.pi


def _add_attributes(mesh, clip):
    if clip.uv_faces is not None:
        layer = mesh.uv_layers.new(name="UVMap")
        layer.data.foreach_set("uv", clip.uvs[clip.uv_faces].ravel())
    if clip.colors is not None:
        layer = mesh.color_attributes.new(name="Color", type="BYTE_COLOR", domain="POINT")
        layer.data.foreach_set("color_srgb", (clip.colors / np.float32(255)).ravel())


def make_mesh(name, clip, positions, smooth=True):
    """A mesh of a clip's triangles and attributes. Returns it and how many triangles Blender cannot have."""
    mesh = bpy.data.meshes.new(name)
    count = len(clip.faces)
    mesh.vertices.add(clip.vertices)
    mesh.vertices.foreach_set("co", positions.ravel())
    mesh.loops.add(3 * count)
    mesh.loops.foreach_set("vertex_index", clip.faces.astype(np.int32).ravel())
    mesh.polygons.add(count)
    mesh.polygons.foreach_set("loop_start", np.arange(0, 3 * count, 3, dtype=np.int32))
    if bpy.app.version < (3, 6, 0):  # later it follows from the starts
        mesh.polygons.foreach_set("loop_total", np.full(count, 3, np.int32))
    mesh.polygons.foreach_set("use_smooth", np.full(count, smooth))
    mesh.update(calc_edges=True)
    _add_attributes(mesh, clip)
    if clip.normal_faces is not None and smooth:
        _mark_sharp(mesh, _sharp_edges(clip.faces, clip.normal_faces))
    mesh.validate(clean_customdata=False)
    return mesh, count - len(mesh.polygons)


@orientation_helper(axis_forward="-Z", axis_up="Y")
class IMPORT_MESH_OT_sac(bpy.types.Operator, ImportHelper):
    """Import a stream as a mesh that plays on the time line"""

    bl_idname = "import_mesh.sac"
    bl_label = "Import sac"
    bl_options = {"UNDO", "PRESET"}
    filename_ext = ".sac"

    filter_glob: bpy.props.StringProperty(default="*.sac", options={"HIDDEN"})
    files: bpy.props.CollectionProperty(type=bpy.types.OperatorFileListElement, options={"HIDDEN", "SKIP_SAVE"})
    directory: bpy.props.StringProperty(subtype="DIR_PATH", options={"HIDDEN", "SKIP_SAVE"})
    scale: bpy.props.FloatProperty(name="Scale", default=1, min=1e-6, max=1e6)
    as_told: bpy.props.BoolProperty(
        name="As the stream tells",
        description="Axis up, unit and first frame are those that the stream tells of, where it does",
        default=True,
    )
    set_range: bpy.props.BoolProperty(
        name="Set frame range", description="Have the scene end with the clip where that is later", default=True
    )
    smooth: bpy.props.BoolProperty(
        name="Shade smooth", description="Smooth, with sharp edges where the stream has hard ones", default=True
    )

    def execute(self, context):
        names = [os.path.join(self.directory, f.name) for f in self.files if f.name] or [self.filepath]
        for path in names:
            try:
                self._import(context, path)
            except (OSError, sac.Error) as error:
                self.report({"ERROR"}, str(error))
                return {"CANCELLED"}
        return {"FINISHED"}

    def _import(self, context, path):
        source = player.clip_frames(os.path.normpath(path))
        clip, scene = source.clip, context.scene
        name = os.path.splitext(os.path.basename(path))[0]
        mesh, lost = make_mesh(name, clip, clip[0], self.smooth)
        if lost:
            self.report({"WARNING"}, f"{path}: {lost} degenerate or duplicate triangles are left out")
        relative = bpy.data.filepath and context.preferences.filepaths.use_relative_paths
        try:
            mesh.sac.filepath = bpy.path.relpath(path) if relative else os.path.abspath(path)
        except ValueError:  # another drive
            mesh.sac.filepath = os.path.abspath(path)
        told = clip.metadata if self.as_told else {}
        # 0 is also what streams have that do not tell.
        mesh.sac.start = told.get("first_frame") or scene.frame_start
        thing = bpy.data.objects.new(name, mesh)
        thing.matrix_world = self._place(told, scene) @ Matrix.Translation(clip.offset.tolist())
        context.collection.objects.link(thing)
        for other in context.selected_objects:
            other.select_set(False)
        thing.select_set(True)
        context.view_layer.objects.active = thing
        if self.set_range:
            rate = scene.render.fps / scene.render.fps_base
            length = (source.count - 1) * (rate / clip.fps if clip.fps else 1)
            scene.frame_end = max(scene.frame_end, math.ceil(mesh.sac.start + length - 1e-6))
        player.show(mesh, scene)
        self.report({"INFO"}, f"{path}: {source.count} frames of {clip.vertices} vertices")

    def _place(self, told, scene):
        """The matrix from the stream's axes and unit to those of the scene."""
        forward, up = {1: ("-Z", "Y"), 2: ("Y", "Z")}.get(told.get("up_axis"), (self.axis_forward, self.axis_up))
        scale = self.scale
        if "metres_per_unit" in told:
            scale *= told["metres_per_unit"] / scene.unit_settings.scale_length
        return axis_conversion(from_forward=forward, from_up=up).to_4x4() @ Matrix.Scale(scale, 4)
