# SPDX-License-Identifier: Apache-2.0
"""File > Export: the evaluated animation of objects as one stream."""

import fractions
import tempfile

import bpy
import numpy as np
from bpy_extras.io_utils import ExportHelper, axis_conversion, orientation_helper
from mathutils import Matrix

from . import sac
from .sac._arrays import choose_offset

KINDS = {"MESH", "CURVE", "SURFACE", "META", "FONT"}


def _get(collection, name, width, kind):
    values = np.empty(len(collection) * width, kind)
    collection.foreach_get(name, values)
    return values.reshape(-1, width) if width > 1 else values


class Evaluated:
    """The meshes of objects at the present frame, as one."""

    def __init__(self, objects, depsgraph, place):
        self._parts, self._place = [], place
        for thing in objects:
            evaluated = thing.evaluated_get(depsgraph)
            mesh = evaluated.to_mesh()
            if mesh is not None:
                self._parts.append((thing.name, evaluated, mesh))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for _, evaluated, _mesh in self._parts:
            evaluated.to_mesh_clear()

    def positions(self):
        """(vertices, 3), float64, in the axes and the unit of the stream."""
        parts = [np.empty((0, 3))]
        for _, evaluated, mesh in self._parts:
            matrix = np.array(self._place @ evaluated.matrix_world)
            local = _get(mesh.vertices, "co", 3, np.float32).astype(np.float64)
            parts.append(local @ matrix[:3, :3].T + matrix[:3, 3])
        return np.concatenate(parts)

    def topology(self):
        """What has to stay the same: of each object its name, the number of its vertices, and its polygons."""
        return [
            (
                name,
                len(mesh.vertices),
                _get(mesh.polygons, "loop_total", 1, np.int32),
                _get(mesh.loops, "vertex_index", 1, np.int32),
            )
            for name, _, mesh in self._parts
        ]

    def triangles(self, attributes):
        """Triangles (count, 3) of the polygons, and arguments of sac.encode() for the attributes that are asked for."""
        faces, uvs, normals, colors, first = [], [], [], [], 0
        for _, evaluated, mesh in self._parts:
            mesh.calc_loop_triangles()
            corners = _get(mesh.loop_triangles, "loops", 3, np.int32)
            if (self._place @ evaluated.matrix_world).determinant() < 0:  # a mirror turns triangles inside out
                corners = corners[:, ::-1]
            faces.append(_get(mesh.loops, "vertex_index", 1, np.int32)[corners].astype(np.int64) + first)
            first += len(mesh.vertices)
            if attributes["uvs"]:
                uvs.append(_corner_uvs(mesh)[corners])
            if attributes["normals"]:
                turn = np.linalg.inv(np.array((self._place @ evaluated.matrix_world).to_3x3()))
                normals.append(_corner_normals(mesh)[corners] @ turn)
            if attributes["colors"]:
                colors.append(_vertex_colors(mesh))
        faces = np.concatenate([np.empty((0, 3), np.int64), *faces])
        given = {}
        if attributes["uvs"] and any(mesh.uv_layers.active for _, _, mesh in self._parts):
            given["uvs"], given["uv_faces"] = _indexed(np.concatenate(uvs))
        if attributes["normals"]:
            given.update(_normals(faces, np.concatenate(normals), first))
        if attributes["colors"] and any(c is not None for c in colors):
            white = [np.ones((len(mesh.vertices), 4), np.float32) for _, _, mesh in self._parts]
            given["colors"] = np.clip(np.concatenate([w if c is None else c for c, w in zip(colors, white)]), 0, 1)
        return faces, given


def _corner_uvs(mesh):
    layer = mesh.uv_layers.active
    return _get(layer.data, "uv", 2, np.float32) if layer else np.zeros((len(mesh.loops), 2), np.float32)


def _corner_normals(mesh):
    if bpy.app.version >= (4, 1, 0):
        return _get(mesh.corner_normals, "vector", 3, np.float32)
    mesh.calc_normals_split()
    return _get(mesh.loops, "normal", 3, np.float32)


def _vertex_colors(mesh):
    """Colors of vertices, (vertices, 4); those of corners are averaged. None where there are none."""
    layer = mesh.color_attributes.active_color
    if layer is None or not len(layer.data):
        return None
    colors = _get(layer.data, "color_srgb" if hasattr(layer.data[0], "color_srgb") else "color", 4, np.float32)
    if layer.domain == "POINT":
        return colors
    of = _get(mesh.loops, "vertex_index", 1, np.int32)
    sums = np.stack([np.bincount(of, colors[:, k], len(mesh.vertices)) for k in range(4)], 1)
    return (sums / np.maximum(np.bincount(of, minlength=len(mesh.vertices)), 1)[:, None]).astype(np.float32)


def _indexed(corners):
    """Values (triangles, 3, n) as different values and (triangles, 3) indices of them."""
    values, indices = np.unique(corners.reshape(-1, corners.shape[-1]), axis=0, return_inverse=True)
    return values, indices.reshape(-1, 3)


def _normals(faces, corners, vertices):
    """Normals of vertices where all corners of each agree, else of corners."""
    corners = corners / np.maximum(np.linalg.norm(corners, axis=2, keepdims=True), 1e-30)
    corners = np.round(corners, 4)  # what differs by less is the same
    values, indices = _indexed(corners)
    of_vertex = np.full(vertices, -1)
    of_vertex[faces] = indices
    if np.array_equal(of_vertex[faces], indices) and (of_vertex >= 0).all():
        return {"normals": values[of_vertex]}
    return {"normals": values, "normal_faces": indices}


def _same(first, now):
    """What differs between two topologies, None where nothing does."""
    if [part[0] for part in first] != [part[0] for part in now]:
        return "other objects have a mesh"
    for (name, vertices, *polygons), (_, count, *others) in zip(first, now):
        if vertices != count:
            return f"{name} has {count} vertices, {vertices} in the first frame"
        if not all(map(np.array_equal, polygons, others)):
            return f"{name} has other polygons than in the first frame"
    return None


@orientation_helper(axis_forward="-Z", axis_up="Y")
class EXPORT_MESH_OT_sac(bpy.types.Operator, ExportHelper):
    """Export the animation of the selected objects, as it is evaluated, as one stream"""

    bl_idname = "export_mesh.sac"
    bl_label = "Export sac"
    bl_options = {"PRESET"}
    filename_ext = ".sac"

    filter_glob: bpy.props.StringProperty(default="*.sac", options={"HIDDEN"})
    scale: bpy.props.FloatProperty(name="Scale", default=1, min=1e-6, max=1e6)
    use_scene_range: bpy.props.BoolProperty(name="Frames of the scene", default=True)
    first: bpy.props.IntProperty(name="First frame", default=1)
    last: bpy.props.IntProperty(name="Last frame", default=250)
    samples: bpy.props.IntProperty(
        name="Samples", description="Frames of the clip for each of the scene", default=1, min=1, max=64
    )
    quality: bpy.props.FloatProperty(
        name="Quality", description="0: smallest, 100: nearest", default=50, min=0, max=100
    )
    use_sted: bpy.props.BoolProperty(name="Wanted STED", description="Search the smallest stream with that error")
    sted: bpy.props.FloatProperty(name="STED", default=0.05, min=1e-4, max=1, precision=3)
    uvs: bpy.props.BoolProperty(name="Texture coordinates", default=True)
    colors: bpy.props.BoolProperty(name="Colors", description="Active color attribute", default=True)
    normals: bpy.props.BoolProperty(
        name="Normals", description="Of the first frame, with hard edges; off: players compute smooth ones"
    )
    keep_order: bpy.props.BoolProperty(
        name="Keep order", description="Store the order of the vertices, for some bits a vertex"
    )

    def draw(self, _context):
        layout = self.layout
        layout.use_property_split = True
        for name in ("axis_forward", "axis_up", "scale", "use_scene_range"):
            layout.prop(self, name)
        if not self.use_scene_range:
            layout.prop(self, "first")
            layout.prop(self, "last")
        layout.prop(self, "samples")
        layout.prop(self, "use_sted")
        layout.prop(self, "sted" if self.use_sted else "quality")
        for name in ("uvs", "colors", "normals", "keep_order"):
            layout.prop(self, name)

    def execute(self, context):
        scene = context.scene
        objects = [o for o in context.selected_objects if o.type in KINDS]
        if not objects and context.object and context.object.type in KINDS:
            objects = [context.object]
        if not objects:
            self.report({"ERROR"}, "no object with a mesh is selected")
            return {"CANCELLED"}
        now, subframe = scene.frame_current, scene.frame_subframe
        context.window_manager.progress_begin(0, 2)
        try:
            with tempfile.TemporaryFile() as file:
                encoding = self._encode(context, objects, file)
        except (OSError, sac.Error) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        finally:
            context.window_manager.progress_end()
            scene.frame_set(now, subframe=subframe)
        self.report(
            {"INFO"},
            f"{self.filepath}: {encoding.bytes} bytes, {encoding.frames} frames, KG {encoding.kg:.4g} %, "
            f"STED {encoding.sted:.4g}",
        )
        return {"FINISHED"}

    def _encode(self, context, objects, file):
        scene = context.scene
        first, last = (scene.frame_start, scene.frame_end) if self.use_scene_range else (self.first, self.last)
        if last < first:
            raise sac.InvalidArgumentError(f"the last frame, {last}, is before the first, {first}")
        count = (last - first) * self.samples + 1
        faces, given, frames, offset = self._evaluate(context, objects, file, first, count)
        rate = fractions.Fraction(scene.render.fps) / fractions.Fraction(scene.render.fps_base).limit_denominator(10000)
        wanted = {"target_sted": self.sted} if self.use_sted else {"quality": self.quality}

        def progress(trial, done):
            context.window_manager.progress_update(1 + done / count)

        return sac.encode(
            faces,
            frames,
            self.filepath,
            fps=rate * self.samples,
            offset=offset,
            keep_order=self.keep_order,
            progress=progress,
            first_frame=first,
            metres_per_unit=scene.unit_settings.scale_length / self.scale,
            up_axis={"X": 0, "Y": 1, "Z": 2}.get(self.axis_up),
            **wanted,
            **given,
        )

    def _evaluate(self, context, objects, file, first, count):
        """Triangles, attributes, frames (float32, in a temporary file, relative to the offset) and the offset."""
        place = axis_conversion(to_forward=self.axis_forward, to_up=self.axis_up).to_4x4()
        place = Matrix.Scale(self.scale, 4) @ place
        wanted = {"uvs": self.uvs, "normals": self.normals, "colors": self.colors}
        for number in range(count):
            whole, part = divmod(number, self.samples)
            context.scene.frame_set(first + whole, subframe=part / self.samples)
            with Evaluated(objects, context.evaluated_depsgraph_get(), place) as now:
                positions = now.positions()
                if number == 0:
                    topology = now.topology()
                    faces, given = now.triangles(wanted)
                    offset = choose_offset(positions)
                    shape = (count, *positions.shape)
                    frames = np.memmap(file, np.float32, shape=shape) if positions.size else np.empty(shape, np.float32)
                elif (problem := _same(topology, now.topology())) is not None:
                    raise sac.InvalidArgumentError(f"frame {context.scene.frame_float:g}: {problem}")
            frames[number] = positions - offset
            context.window_manager.progress_update(number / count)
        return faces, given, _relative(frames, offset), offset


def _relative(frames, offset):
    """Frames as sac.encode() takes them, which subtracts the offset itself."""
    if not offset.any():
        return frames

    class Absolute:
        def __iter__(self):
            return (frame.astype(np.float64) + offset for frame in frames)

    return Absolute()
