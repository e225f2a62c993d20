# SPDX-License-Identifier: Apache-2.0
# %% [markdown]
# # A clip in pictures
#
# Makes a clip with numpy, encodes it at several qualities, and draws with matplotlib what is decoded. Editors that know
# `# %%` run it cell by cell; `python3 examples/draw.py pictures` runs all of it and writes the pictures into a folder.

# %%
import pathlib
import sys

import matplotlib
import numpy as np

if __name__ == "__main__" and not hasattr(sys, "ps1"):
    matplotlib.use("Agg")  # files only; a display is not needed
import matplotlib.pyplot as plt

import sac

FOLDER = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")

# %% [markdown]
# A jellyfish: a bell of rings that contract one after the other. Faces are (triangles, 3), frames (frames, vertices, 3).

# %%
RINGS, SPOKES, FRAMES, FPS = 16, 32, 30, 30
ring, spoke = np.meshgrid(np.arange(RINGS), np.arange(SPOKES), indexing="ij")
corner = np.arange(RINGS * SPOKES).reshape(RINGS, SPOKES)
a, b = corner[:-1], corner[1:]
c, d = np.roll(b, -1, axis=1), np.roll(a, -1, axis=1)
faces = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])


def jellyfish(seconds):
    """Positions (vertices, 3) after some seconds, in meters, z up."""
    down = (ring + 1) / RINGS
    beat = np.sin(2 * np.pi * (seconds - 0.4 * down))
    radius = np.sin(2.2 * down) * (1 + 0.25 * down * beat)
    angle = 2 * np.pi * spoke / SPOKES
    height = 0.8 * np.cos(2.2 * down) + 0.1 * np.sin(2 * np.pi * seconds) + 0.03 * np.cos(8 * angle) * down
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), height], -1).reshape(-1, 3).astype(np.float32)


frames = np.stack([jellyfish(f / FPS) for f in range(FRAMES)])

# %% [markdown]
# Encoding gives the stream, and what a decoder makes of it.

# %%
qualities = [10, 50, 90]
# Without rounds of fitting the first shape it is quicker, and the streams are somewhat larger.
encodings = [sac.encode(faces, frames, fps=FPS, quality=quality, reference_rounds=0) for quality in qualities]
for quality, encoding in zip(qualities, encodings):
    print(quality, encoding)

figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
axes.plot([e.bpvf for e in encodings], [e.sted for e in encodings], "o-")
for quality, encoding in zip(qualities, encodings):
    axes.annotate(f" {quality}", (encoding.bpvf, encoding.sted))
axes.set(xlabel="bits a vertex and frame", ylabel="STED", title="Rate and distortion, by quality")
figure.savefig(FOLDER / "rate.png")

# %% [markdown]
# The clip as a sequence. `order` brings the vertices back into ours, so that `faces` fits and errors can be taken.

# %%
clip = sac.open(encodings[1].data, order=encodings[1].order)
print(clip, len(clip), "frames,", clip.duration, "seconds")


def draw(axes, frame, error):
    """One frame, colored by its error."""
    x, y, z = frame.positions.T
    surface = axes.plot_trisurf(x, y, z, triangles=faces, cmap="viridis", linewidth=0)
    surface.set_array(error[faces].mean(axis=1))
    surface.set_clim(0, clip_error)
    axes.set(xlim=(-1, 1), ylim=(-1, 1), zlim=(-1, 1), title=f"{frame.time:.2f} s")
    axes.set_box_aspect((1, 1, 1))
    axes.set_axis_off()
    return surface


errors = np.linalg.norm(clip[:] - frames, axis=2)
clip_error = errors.max()
figure = plt.figure(figsize=(10, 3), layout="constrained")
for place, index in enumerate((0, 8, 16, 24), 1):
    surface = draw(figure.add_subplot(1, 4, place, projection="3d"), clip.frame(index), errors[index])
figure.colorbar(surface, ax=figure.axes, label="error, m", shrink=0.6)
figure.savefig(FOLDER / "frames.png")

# %% [markdown]
# Between frames. The path of a vertex at the rim, at ten times the frame rate: `interpolate` averages what moves the
# surface, not its vertices, so that what turns keeps its size.

# %%
times = np.arange(0, FRAMES - 1, 0.1)
path = np.stack([clip.interpolate(time).positions[-1] for time in times])
figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
axes.plot(times / FPS, path[:, 2], label="interpolated")
axes.plot(np.arange(FRAMES) / FPS, frames[:, -1, 2], ".", label="original")
axes.set(xlabel="s", ylabel="height of a vertex at the rim, m")
axes.legend()
figure.savefig(FOLDER / "between.png")
