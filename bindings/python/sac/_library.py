# SPDX-License-Identifier: Apache-2.0
"""Finds and loads libsac, whose interface of C is declared in sac.h, sac_encode.h and sac_measure.h.

ctypes lets go of the interpreter's lock (GIL) during every call.
"""

from __future__ import annotations

import ctypes
import os
import pathlib
from ctypes import c_char, c_char_p, c_double, c_float, c_int, c_int32, c_size_t, c_uint8, c_uint32, c_uint64, c_void_p

# The version of the library whose structs are declared here: major and minor, which its file name ends with.
ABI = "0.2"

Floats = ctypes.POINTER(c_float)
Indices = ctypes.POINTER(c_uint32)
Bytes = ctypes.POINTER(c_uint8)


class Settings(ctypes.Structure):
    """sac_settings."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("max_vertices", c_uint32),
        ("max_memory", c_uint64),
        ("max_work", c_double),
        ("skip_damage", c_uint32),
        ("frame_step", c_uint32),
        ("threads", c_uint32),
        ("run_jobs", c_void_p),
        ("run_jobs_user", c_void_p),
        ("max_triangles", c_uint32),
        ("max_harmonics", c_uint32),
        ("max_frames_per_group", c_uint32),
        ("max_packet_bytes", c_uint32),
        ("max_group_values", c_uint64),
        ("max_basis_values", c_uint64),
        ("max_factor_values", c_uint64),
        ("max_free_work", c_double),
        ("max_work_per_byte", c_double),
        ("max_frame_work", c_double),
        ("layers", c_uint32),
    ]


class VertexBuffer(ctypes.Structure):
    """sac_vertex_buffer."""

    _fields_ = [("data", c_void_p), ("size", c_size_t), ("stride", c_size_t), ("format", c_uint32)]


class FrameBuffers(ctypes.Structure):
    """sac_frame_buffers."""

    _fields_ = [("positions", VertexBuffer), ("normals", VertexBuffer)]


class FrameInfo(ctypes.Structure):
    """sac_frame_info."""

    _fields_ = [
        ("index", c_uint32),
        ("intra", c_uint32),
        ("time", c_double),
        ("box_low", c_double * 3),
        ("box_high", c_double * 3),
    ]


class Mesh(ctypes.Structure):
    """sac_mesh."""

    _fields_ = [
        ("vertices", c_uint32),
        ("triangles", c_uint32),
        ("uvs", c_uint32),
        ("frame_rate_numerator", c_uint32),
        ("frame_rate_denominator", c_uint32),
        ("triangle_vertices", Indices),
        ("uv_values", Floats),
        ("triangle_uvs", Indices),
        ("normals", Floats),
        ("colors", Bytes),
        ("order", Indices),
    ]


class Metadata(ctypes.Structure):
    """sac_metadata."""

    _fields_ = [
        ("name", c_char_p),
        ("json", c_char_p),
        ("metres_per_unit", c_double),
        ("up_axis", c_int32),
        ("first_frame", c_int32),
        ("loops", c_int32),
        ("has_bounds", c_uint32),
        ("box_low", c_double * 3),
        ("box_high", c_double * 3),
    ]


PROGRESS = ctypes.CFUNCTYPE(c_int, c_void_p, c_uint32, c_uint32)
NEXT = ctypes.CFUNCTYPE(c_int, c_void_p, Floats, ctypes.POINTER(c_int))
REWIND = ctypes.CFUNCTYPE(c_int, c_void_p)
SINK = ctypes.CFUNCTYPE(c_int, c_void_p, Bytes, c_size_t)


class EncoderSettings(ctypes.Structure):
    """sac_encoder_settings."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("quality", c_double),
        ("max_error", c_double),
        ("target_kg", c_double),
        ("target_sted", c_double),
        ("target_bpvf", c_double),
        ("motion_step", c_double),
        ("displacement_step", c_double),
        ("detail_step", c_double),
        ("position_bits", c_double),
        ("level_growth", c_double),
        ("harmonics", c_uint32),
        ("handles_per_harmonic", c_uint32),
        ("group", c_uint32),
        ("pyramid", c_uint32),
        ("low_delay", c_uint32),
        ("reference_previous", c_uint32),
        ("frame_rate_numerator", c_uint32),
        ("frame_rate_denominator", c_uint32),
        ("keep_order", c_uint32),
        ("index", c_uint32),
        ("repeat_start", c_uint32),
        ("unmeasured", c_uint32),
        ("max_memory", c_uint64),
        ("progress", PROGRESS),
        ("user", c_void_p),
        ("offset", c_double * 3),
        ("reference_rounds", c_int32),
        ("base_levels", c_uint32),
        ("name", c_char_p),
        ("json", c_char_p),
        ("metres_per_unit", c_double),
        ("up_axis", c_int32),
        ("loops", c_int32),
        ("first_frame", c_int32),
        ("has_first_frame", c_uint32),
        ("bounds", c_uint32),
        ("join", c_int32),
        ("threads", c_uint32),
        ("run_jobs", c_void_p),
        ("run_jobs_user", c_void_p),
        ("reach", c_double),
    ]


class InputMesh(ctypes.Structure):
    """sac_input_mesh."""

    _fields_ = [
        ("vertices", c_uint32),
        ("triangles", c_uint32),
        ("uvs", c_uint32),
        ("positions", c_void_p),
        ("position_stride", c_size_t),
        ("triangle_vertices", c_void_p),
        ("uv_values", c_void_p),
        ("triangle_uvs", c_void_p),
        ("normals", c_void_p),
        ("colors", c_void_p),
        ("corner_normals", c_uint32),
        ("triangle_normals", c_void_p),
    ]


class StreamBytes(ctypes.Structure):
    """sac_stream_bytes."""

    _fields_ = [
        (name, c_double) for name in ("header", "i_frame", "motion", "displacement", "detail", "correction", "side")
    ]


class FrameSource(ctypes.Structure):
    """sac_frame_source."""

    _fields_ = [("user", c_void_p), ("next", NEXT), ("rewind", REWIND)]


class ClipResult(ctypes.Structure):
    """sac_clip_result."""

    _fields_ = [
        ("bytes", c_uint64),
        ("frames", c_uint32),
        ("trials", c_uint32),
        ("bpvf", c_double),
        ("kg", c_double),
        ("sted", c_double),
        ("max_error", c_double),
        ("parts", StreamBytes),
        ("message", c_char * 256),
    ]


class ClipDetails(ctypes.Structure):
    """sac_clip_details."""

    _fields_ = [
        ("order", c_void_p),
        ("lost_texture_coordinates", c_uint32),
        ("lost_normals", c_uint32),
        ("sted_spatial", c_double),
        ("sted_temporal", c_double),
        ("seam_gap", c_double),
    ]


class Distortion(ctypes.Structure):
    """sac_distortion."""

    _fields_ = [
        ("kg", c_double),
        ("sted", c_double),
        ("sted_spatial", c_double),
        ("sted_temporal", c_double),
        ("max_error", c_double),
        ("seam_gap", c_double),
        ("frames", c_uint32),
    ]


# The names of the structs in the headers; bindings/python/tests/check_structs.py compares their layouts.
STRUCTS = {
    "sac_settings": Settings,
    "sac_vertex_buffer": VertexBuffer,
    "sac_frame_buffers": FrameBuffers,
    "sac_frame_info": FrameInfo,
    "sac_mesh": Mesh,
    "sac_metadata": Metadata,
    "sac_encoder_settings": EncoderSettings,
    "sac_input_mesh": InputMesh,
    "sac_stream_bytes": StreamBytes,
    "sac_frame_source": FrameSource,
    "sac_clip_result": ClipResult,
    "sac_clip_details": ClipDetails,
    "sac_distortion": Distortion,
}

_TO = ctypes.POINTER
# What each function gives and takes.
_FUNCTIONS = {
    "sac_version": (c_char_p,),
    "sac_stream_version": (c_char_p,),
    "sac_settings_init": (None, _TO(Settings)),
    "sac_decoder_open": (c_int, _TO(c_void_p), _TO(Settings)),
    "sac_decoder_close": (None, c_void_p),
    "sac_decoder_send": (c_int, c_void_p, _TO(c_void_p), _TO(c_size_t)),
    "sac_decoder_receive": (c_int, c_void_p, _TO(FrameBuffers), _TO(FrameInfo)),
    "sac_decoder_finish": (c_int, c_void_p),
    "sac_decoder_mesh": (c_int, c_void_p, _TO(Mesh)),
    "sac_decoder_segment": (c_int, c_void_p, _TO(c_uint32)),
    "sac_decoder_metadata": (c_int, c_void_p, _TO(Metadata)),
    "sac_decoder_corner_normals": (c_int, c_void_p, _TO(Floats), _TO(c_uint32), _TO(Indices)),
    "sac_decoder_offset": (c_int, c_void_p, c_double * 3),
    "sac_decoder_seek": (c_int, c_void_p, c_uint32, _TO(c_uint64)),
    "sac_decoder_seek_time": (c_int, c_void_p, c_double, _TO(c_uint64)),
    "sac_decoder_add_index": (c_int, c_void_p, c_void_p, c_size_t, _TO(c_size_t)),
    "sac_decoder_interpolate": (c_int, c_void_p, c_double, _TO(FrameBuffers), _TO(FrameInfo)),
    "sac_decoder_layers": (c_uint32, c_void_p),
    "sac_decoder_frames": (c_int, c_void_p, _TO(c_uint32)),
    "sac_decoder_lost_count": (c_size_t, c_void_p),
    "sac_decoder_lost": (c_int, c_void_p, c_size_t, _TO(c_uint32), _TO(c_uint32)),
    "sac_decoder_message": (c_char_p, c_void_p),
    "sac_encoder_settings_init": (None, _TO(EncoderSettings)),
    "sac_encoder_open": (c_int, _TO(c_void_p), _TO(InputMesh), _TO(EncoderSettings)),
    "sac_encoder_close": (None, c_void_p),
    "sac_encoder_send": (c_int, c_void_p, c_void_p, c_size_t),
    "sac_encoder_finish": (c_int, c_void_p),
    "sac_encoder_take": (c_int, c_void_p, _TO(c_void_p), _TO(c_size_t)),
    "sac_encoder_order": (c_int, c_void_p, _TO(Indices)),
    "sac_encoder_stream_bytes": (c_int, c_void_p, _TO(StreamBytes)),
    "sac_encoder_message": (c_char_p, c_void_p),
    "sac_encode_clip_details": (
        c_int,
        _TO(InputMesh),
        _TO(FrameSource),
        _TO(EncoderSettings),
        SINK,
        c_void_p,
        _TO(ClipResult),
        _TO(ClipDetails),
    ),
    "sac_meter_open": (c_int, _TO(c_void_p), c_uint32, c_void_p, c_uint32),
    "sac_meter_close": (None, c_void_p),
    "sac_meter_add": (c_int, c_void_p, c_void_p, c_void_p),
    "sac_meter_result": (c_int, c_void_p, _TO(Distortion)),
    "sac_meter_message": (c_char_p, c_void_p),
}


def _load() -> ctypes.CDLL:
    """Loads the library that SAC_LIBRARY names, or the one beside this file, or the system's."""
    name = f"libsac.so.{ABI}"
    given = os.environ.get("SAC_LIBRARY")
    beside = pathlib.Path(__file__).with_name(name)
    path = given or (str(beside) if beside.exists() else name)
    try:
        library = ctypes.CDLL(path)
    except OSError as error:
        raise ImportError(f"{path}: {error}. The module needs {name}: install the package libsac0") from error
    for function, (result, *arguments) in _FUNCTIONS.items():
        try:
            entry = getattr(library, function)
        except AttributeError:
            raise ImportError(f"{path}: it has no {function}; the module needs {name}") from None
        entry.restype, entry.argtypes = result, arguments
    version = library.sac_version().decode()
    if version.split(".")[:2] != ABI.split("."):
        raise ImportError(f"{path}: it is version {version}; the module needs {name}")
    return library


lib = _load()
