# SPDX-License-Identifier: Apache-2.0
"""Runs the codecs as programs that get nothing but files, measures the decoded clips, and keeps the results.

A result is a dict: bytes, bpvf (bits per vertex and frame, all bytes counted), kg (percent), sted with its parts sted_s
and sted_t, max_error (model units), vertices, frames. Results of the published method also have `encode` and `decode`,
its program's reports on steps and parts. A codec that fails gives {"error": its message}.
"""
import collections
import functools
import hashlib
import json
import os
import subprocess
import tempfile

import numpy as np

Clip = collections.namedtuple("Clip", "name mesh cache")


class Failed(Exception):
    """A codec ended with an error, whose message this is."""


def run(*command):
    """-> standard output"""
    process = subprocess.run(
        command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    if process.returncode != 0:
        raise Failed(process.stderr.strip().rsplit(": ", 1)[-1] or f"{command[0]}: {process.returncode}")
    return process.stdout


@functools.lru_cache(maxsize=None)
def digest(path):
    """-> the SHA-256 of a file's bytes, in hexadecimal"""
    with open(path, "rb") as f:
        return hashlib.sha256(f.read()).hexdigest()


def frames_of(path):
    """-> the positions of a PC2 file, an array of frames x vertices x 3"""
    with open(path, "rb") as f:
        head = np.frombuffer(f.read(32)[16:], "<i4")
        return np.frombuffer(f.read(), "<f4").reshape(head[3], head[0], 3).astype(float)


def error_by_frame(original, decoded):
    """-> the KG error of each frame by itself, percent"""
    a, b = frames_of(original), frames_of(decoded)
    extent = np.linalg.norm(a - a.mean(axis=1, keepdims=True), axis=(1, 2))
    return list(100 * np.linalg.norm(a - b, axis=(1, 2)) / extent)


def histogram(report, bits, bins=128):
    """Replaces the counts of single levels in an encoder's report by a histogram for each channel, in `bins` bins."""
    width = 2**bits / bins
    channels, all_levels = [], collections.Counter()
    for channel in report.pop("levels"):
        level, count = np.array(channel["level"]), np.array(channel["count"])
        channels.append(np.bincount((level / width).astype(int), count, bins).astype(int).tolist())
        all_levels.update(dict(zip(channel["level"], channel["count"])))
    count = np.array(list(all_levels.values()), float)
    report["histogram"] = channels
    report["distinct"], report["coefficients"] = len(count), int(count.sum())
    report["entropy"] = float(-(count / count.sum() * np.log2(count / count.sum())).sum())


class Laboratory:
    def __init__(self, data, sac, peers, work):
        self.data, self.sac_program, self.peers, self.work = data, sac, peers, work
        os.makedirs(work, exist_ok=True)

    def clip(self, name):
        """-> the clip `name` of the data, None when it does not exist"""
        clip = Clip(name, *(os.path.join(self.data, name + e) for e in (".obj", ".pc2")))
        return clip if os.path.exists(clip.mesh) and os.path.exists(clip.cache) else None

    def synth(self, kind, vertices, frames):
        name = f"{kind}_{vertices}_{frames}"
        clip = Clip(kind, *(os.path.join(self.work, name + e) for e in (".obj", ".pc2")))
        size = ("--vertices", str(vertices), "--frames", str(frames))
        run(self.sac_program, "synth", kind, "--force", "-o", clip.cache, *size)
        return clip

    def peer(self, name, clip, setting, by_frame=False):
        """-> the result of a peer at a setting; `by_frame` adds the KG error of each frame"""
        program = os.path.join(self.peers, "sac-peer-" + name)
        return self._kept(
            (program,), clip, (setting, by_frame), lambda work: self._peer(program, clip, setting, by_frame, work)
        )

    def sac(self, clip, *options):
        """-> the result of sac itself with options of `sac encode`; `said` is its own report on the stream"""
        return self._kept((), clip, options, lambda work: self._sac(clip, options, work))

    def _kept(self, programs, clip, options, measure):
        files = (self.sac_program, *programs, clip.mesh, clip.cache)
        key = hashlib.sha256(json.dumps([[digest(f) for f in files], options]).encode()).hexdigest()[:24]
        path = os.path.join(self.work, key + ".json")
        if not os.path.exists(path):
            print(f"{clip.name}: {os.path.basename((programs or files)[0])} {' '.join(map(str, options))}", flush=True)
            with tempfile.TemporaryDirectory(dir=self.work) as work:
                try:
                    result = measure(work)
                except Failed as failure:
                    result = {"error": str(failure)}
            with open(path + ".new", "w") as f:
                json.dump(result, f)
            os.replace(path + ".new", path)
        with open(path) as f:
            return json.load(f)

    def _compare(self, clip, stream, decoded):
        result = json.loads(
            run(self.sac_program, "compare", clip.mesh, clip.cache, "--with", clip.mesh, decoded, "--json")
        )
        result["bytes"] = os.path.getsize(stream)
        result["bpvf"] = 8 * result["bytes"] / result["vertices"] / result["frames"]
        return result

    def _peer(self, program, clip, setting, by_frame, work):
        stream, order, decoded, *reports = (os.path.join(work, n) for n in ("s", "map", "d.pc2", "e.json", "d.json"))
        reported = os.path.basename(program) == "sac-peer-sac2015"
        extra = [["--report", report] if reported else [] for report in reports]
        run(
            program,
            "encode",
            clip.mesh,
            clip.cache,
            "-o",
            stream,
            "--order-map",
            order,
            "--setting",
            setting,
            *extra[0],
        )
        run(program, "decode", stream, "-o", decoded, "--order-map", order, *extra[1])
        result = self._compare(clip, stream, decoded)
        for part, path in zip(("encode", "decode"), reports if reported else ()):
            with open(path) as f:
                result[part] = json.load(f)
        if reported:
            histogram(result["encode"], int(setting.split("/")[1]))
            parts = result["encode"]["bytes"]
            result["i_frame"] = parts["connectivity"] + parts["first_frame"]
        if by_frame:
            result["by_frame"] = error_by_frame(clip.cache, decoded)
        return result

    def _sac(self, clip, options, work):
        stream, order, decoded = (os.path.join(work, n) for n in ("s", "map", "d.pc2"))
        said = run(
            self.sac_program, "encode", clip.mesh, clip.cache, "-o", stream, "--order-map", order, "--json", *options
        )
        run(self.sac_program, "decode", "--force", stream, "-o", decoded, "--order-map", order)
        return {**self._compare(clip, stream, decoded), "said": json.loads(said)}


def good(results):
    """-> the results, by key, without those that failed"""
    return {key: result for key, result in results.items() if "error" not in result}


def times_the_bits(ours, theirs, error):
    """-> the ratio of the bits of `theirs` to those of `ours` (both results) at equal `error`, None when they reach no
    error in common. It is the geometric mean over the errors that both reach. Between points, log bits are linear in
    log error; points that another point of the same codec beats in both are left out.
    """

    def curve(results):
        points = []
        for r in sorted(results, key=lambda r: r["bpvf"]):
            if not points or r[error] < points[-1][0]:
                points.append((r[error], r["bpvf"]))
        return np.log(points[::-1]).T

    a, b = curve(ours), curve(theirs)
    low, high = max(a[0][0], b[0][0]), min(a[0][-1], b[0][-1])
    if low >= high:
        return None
    at = np.linspace(low, high, 200)
    return float(np.exp(np.mean(np.interp(at, *b) - np.interp(at, *a))))
