# SPDX-License-Identifier: Apache-2.0
"""Preferences of the add-on."""

import bpy


class SacPreferences(bpy.types.AddonPreferences):
    """What all clips share."""

    bl_idname = __package__

    cache_megabytes: bpy.props.IntProperty(
        name="Cache",
        description="Megabytes of decoded frames that are kept, so that dragging the time line is fluid",
        default=512,
        min=0,
        max=1 << 20,
    )
    threads: bpy.props.IntProperty(
        name="Threads", description="Frames that are decoded at the same time", default=1, min=1, max=64
    )

    def draw(self, _context):
        self.layout.prop(self, "cache_megabytes")
        self.layout.prop(self, "threads")


def get():
    """The preferences, or the defaults where the add-on is not enabled as one."""
    addon = bpy.context.preferences.addons.get(__package__)
    return addon.preferences if addon else None


def cache_bytes():
    preferences = get()
    return (preferences.cache_megabytes if preferences else 512) << 20


def threads():
    preferences = get()
    return preferences.threads if preferences else 1
