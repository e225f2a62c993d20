# SPDX-License-Identifier: Apache-2.0
"""Meshes that follow the time line: before each frame that Blender shows or renders, sub-frames too, the positions of
that time are written into them."""

import math
import os

import bpy
from bpy.app.handlers import persistent

from . import frames, preferences, sac

_cache = frames.FrameCache()
_clips = {}  # by path


def clip_frames(path):
    """The frames of the stream at a path; those of a file that has changed are read again."""
    known = _clips.get(path)
    if known is None or known.signature != frames.signature(path):
        known = _clips[path] = frames.ClipFrames(path, preferences.threads(), _cache)
    return known


def forget():
    """Closes all streams and empties the cache."""
    _clips.clear()
    _cache.clear()


def _changed(settings, context):
    show(settings.id_data, context.scene)


class SacPlayback(bpy.types.PropertyGroup):
    """How a mesh follows a stream."""

    filepath: bpy.props.StringProperty(
        name="File", description="The stream; empty: the mesh stands still", subtype="FILE_PATH", update=_changed
    )
    start: bpy.props.FloatProperty(
        name="Start", description="Frame of the scene that shows the clip's first frame", default=1, update=_changed
    )
    speed: bpy.props.FloatProperty(
        name="Speed",
        description="Frames of the clip for each that passes; negative: backwards",
        default=1,
        update=_changed,
    )
    use_rate: bpy.props.BoolProperty(
        name="Clip's frame rate",
        description="Play in as many seconds as the clip has; off: one frame of the clip for each of the scene",
        default=True,
        update=_changed,
    )
    use_frame: bpy.props.BoolProperty(
        name="Retime", description="Show the frame of the clip that is given, which can be animated", update=_changed
    )
    frame: bpy.props.FloatProperty(
        name="Frame", description="Frame of the clip, from 0; keyframes retime the clip", update=_changed
    )
    interpolate: bpy.props.BoolProperty(
        name="Sub-frames", description="Shapes between the frames of the clip", default=True, update=_changed
    )
    outside: bpy.props.EnumProperty(
        name="Outside",
        description="What is shown before and after the clip",
        items=(("HOLD", "Hold", "The first and the last frame"), ("LOOP", "Loop", "The clip again")),
        update=_changed,
    )
    message: bpy.props.StringProperty(options={"SKIP_SAVE"})


def _animated(mesh, name, time):
    """A property of the playback at a time of the scene: handlers run before Blender evaluates it."""
    action = mesh.animation_data.action if mesh.animation_data else None
    curve = action.fcurves.find(f"sac.{name}") if action else None
    return curve.evaluate(time) if curve else getattr(mesh.sac, name)


def clip_time(mesh, scene, clip):
    """The time of a clip that a scene shows now, in frames of the clip."""
    settings, now = mesh.sac, scene.frame_current_final
    if settings.use_frame:
        time = _animated(mesh, "frame", now)
    else:
        time = (now - _animated(mesh, "start", now)) * _animated(mesh, "speed", now)
        if settings.use_rate and clip.clip.fps:
            time *= clip.clip.fps * scene.render.fps_base / scene.render.fps
    if settings.outside == "LOOP":
        time = math.fmod(time, clip.count)
        time += clip.count if time < 0 else 0
    return time


def show(mesh, scene):
    """Writes the positions of the present time into a mesh. A problem is told in its panel, and on the console once."""
    settings = mesh.sac
    if not settings.filepath or mesh.is_editmode:
        return
    message = ""
    try:
        clip = clip_frames(os.path.normpath(bpy.path.abspath(settings.filepath, library=mesh.library)))
        if clip.clip.vertices != len(mesh.vertices):
            raise sac.InvalidArgumentError(
                f"{settings.filepath}: it has {clip.clip.vertices} vertices, the mesh {mesh.name} has {len(mesh.vertices)}"
            )
        time = clip_time(mesh, scene, clip)
        positions = clip.at(time, settings.interpolate, preferences.cache_bytes())
        mesh.vertices.foreach_set("co", positions.ravel())
        mesh.update()
    except (OSError, sac.Error, IndexError) as error:
        message = str(error)
    if message != settings.message:
        settings.message = message
        if message:
            print(f"sac: {message}")


@persistent
def on_frame(scene, _depsgraph=None):
    for mesh in bpy.data.meshes:
        if mesh.users and mesh.sac.filepath:
            show(mesh, scene)


@persistent
def on_load(*_):
    forget()
    on_frame(bpy.context.scene)


class SAC_OT_reload(bpy.types.Operator):
    """Read the stream again"""

    bl_idname = "sac.reload"
    bl_label = "Reload"

    def execute(self, context):
        forget()
        on_frame(context.scene)
        return {"FINISHED"}


class SAC_PT_playback(bpy.types.Panel):
    """How the mesh follows its stream"""

    bl_label = "sac"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "data"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return isinstance(getattr(context.object, "data", None), bpy.types.Mesh)

    def draw(self, context):
        layout, settings = self.layout, context.object.data.sac
        layout.use_property_split = True
        row = layout.row(align=True)
        row.prop(settings, "filepath")
        row.operator(SAC_OT_reload.bl_idname, text="", icon="FILE_REFRESH")
        if settings.message:
            layout.label(text=settings.message, icon="ERROR")
        layout.prop(settings, "use_frame")
        if settings.use_frame:
            layout.prop(settings, "frame")
        else:
            layout.prop(settings, "start")
            layout.prop(settings, "speed")
            layout.prop(settings, "use_rate")
        layout.prop(settings, "interpolate")
        layout.prop(settings, "outside")


def add_handlers():
    bpy.app.handlers.frame_change_pre.append(on_frame)
    bpy.app.handlers.load_post.append(on_load)


def remove_handlers():
    bpy.app.handlers.load_post.remove(on_load)
    bpy.app.handlers.frame_change_pre.remove(on_frame)
    forget()
