# SPDX-License-Identifier: Apache-2.0
"""Animated meshes as .sac streams in Blender: imported ones play on the time line, any object's animation is exported."""

bl_info = {
    "name": "sac animated meshes",
    "author": "The sac authors",
    "version": (0, 2, 0),
    "blender": (3, 4, 0),
    "location": "File > Import, File > Export; Properties > Object Data > sac",
    "description": "Import and export streams of animated meshes",
    "category": "Import-Export",
}

import bpy  # noqa: E402

from . import exporter, importer, player, preferences  # noqa: E402

_CLASSES = (
    preferences.SacPreferences,
    player.SacPlayback,
    player.SAC_OT_reload,
    player.SAC_PT_playback,
    importer.IMPORT_MESH_OT_sac,
    exporter.EXPORT_MESH_OT_sac,
)


def _import_entry(self, _context):
    self.layout.operator(importer.IMPORT_MESH_OT_sac.bl_idname, text="Animated mesh (.sac)")


def _export_entry(self, _context):
    self.layout.operator(exporter.EXPORT_MESH_OT_sac.bl_idname, text="Animated mesh (.sac)")


def register():
    for kind in _CLASSES:
        bpy.utils.register_class(kind)
    bpy.types.Mesh.sac = bpy.props.PointerProperty(type=player.SacPlayback)
    bpy.types.TOPBAR_MT_file_import.append(_import_entry)
    bpy.types.TOPBAR_MT_file_export.append(_export_entry)
    player.add_handlers()


def unregister():
    player.remove_handlers()
    bpy.types.TOPBAR_MT_file_export.remove(_export_entry)
    bpy.types.TOPBAR_MT_file_import.remove(_import_entry)
    del bpy.types.Mesh.sac
    for kind in reversed(_CLASSES):
        bpy.utils.unregister_class(kind)
