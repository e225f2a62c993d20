# SPDX-License-Identifier: Apache-2.0
"""sac play, in the window of a display that draws into memory (Xvfb): it shows a shape that moves, and ends by itself.

usage: show_window.py SAC STREAM [PICTURE.png]: PICTURE gets what the window showed last

Exit code 77: there is no Xvfb, no GLFW or no numpy.
"""

import ctypes.util
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import time

SKIPPED = 77
PATIENCE = 120  # seconds for anything to happen on a busy machine


def screen(path):
    """The pixels of a screen (height, width, 3) from the file that Xvfb keeps, an X window dump."""
    data = path.read_bytes()
    head = struct.unpack(">25I", data[:100])
    size, width, height, row, colors = head[0], head[4], head[5], head[12], head[19]
    begin = size + 12 * colors
    pixels = np.frombuffer(data[begin : begin + row * height], np.uint8).reshape(height, row // 4, 4)
    return pixels[:, :width, 2::-1].copy()


def wait_for(what, found):
    """Calls found() until it gives something true, which is returned."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        value = found()
        if value is not None and value is not False:
            return value
        time.sleep(0.02)
    raise SystemExit(f"failed: no {what} in {PATIENCE} seconds")


def start_display(folder):
    """Starts Xvfb at a number of its own choice; returns the process and the number."""
    read, write = os.pipe()
    command = ["Xvfb", "-displayfd", str(write), "-screen", "0", "640x480x24", "-fbdir", folder, "-nolisten", "tcp"]
    server = subprocess.Popen(command, pass_fds=[write], stderr=subprocess.DEVNULL)
    os.close(write)
    with os.fdopen(read) as pipe:
        return server, pipe.readline().strip()


def shape(pixels):
    """Where something other than the background is, None while the window is not there."""
    background = pixels[2, 2]
    if not background.any():
        return None
    drawn = np.abs(pixels.astype(int) - background).max(axis=2) > 8
    return drawn if drawn.mean() > 0.02 else None


def check(sac, stream, environment, file):
    """Plays a stream; returns the last picture."""
    command = [sac, "play", stream, "--width", "640", "--height", "480"]
    player = subprocess.Popen([*command, "--fps", "10"], env=environment)
    try:
        first = wait_for("picture", lambda: screen(file) if shape(screen(file)) is not None else None)
        drawn = shape(first)
        rows, columns = np.nonzero(drawn)
        assert 160 < columns.mean() < 480 and 120 < rows.mean() < 360, "the shape is in the middle of the window"
        assert len(np.unique(first[drawn], axis=0)) > 30, "the shape is shaded"
        moved = wait_for("motion", lambda: p if ((p := screen(file)) != first).any(axis=2).mean() > 0.005 else None)
        assert player.poll() is None, "the player plays on"
    finally:
        player.terminate()
        player.wait()
    assert subprocess.run([*command, "--once", "--fps", "1000"], env=environment, timeout=PATIENCE).returncode == 0
    return moved


def without_a_display(sac, stream):
    """sac play says what to do where there is no display."""
    environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    result = subprocess.run([sac, "play", stream], env=environment, stderr=subprocess.PIPE, text=True, check=False)
    assert result.returncode == 1, result
    assert result.stderr.startswith("sac: play: there is no display"), result.stderr
    assert result.stderr.count("\n") == 1, result.stderr


def main():
    """Returns the exit code."""
    sac, stream = sys.argv[1:3]
    without_a_display(sac, stream)
    if not shutil.which("Xvfb") or not ctypes.util.find_library("glfw"):
        print("skipped: it takes xvfb and libglfw3")
        return SKIPPED
    with tempfile.TemporaryDirectory() as folder:
        server, number = start_display(folder)
        try:
            environment = {**os.environ, "DISPLAY": f":{number}", "LIBGL_ALWAYS_SOFTWARE": "1"}
            picture = check(sac, stream, environment, pathlib.Path(folder) / "Xvfb_screen0")
        finally:
            server.terminate()
            server.wait()
    if len(sys.argv) > 3:
        import matplotlib.image

        matplotlib.image.imsave(sys.argv[3], picture)
    return 0


if __name__ == "__main__":
    try:
        import numpy as np
    except ImportError:
        print("skipped: it takes numpy")
        sys.exit(SKIPPED)
    sys.exit(main())
