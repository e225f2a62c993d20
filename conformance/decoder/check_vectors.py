#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Decodes the conformance vectors with this decoder and compares the results with conformance/manifest.json.

A valid stream must give the manifest's integers, and its positions within the tolerance of spec.md 8; an invalid one must
be refused with the class of the manifest. Exit code 1 if one does not, 77 if the packages or the program that this needs are missing.
"""

import argparse
import json
import sys
import time
from pathlib import Path

try:
    import numpy as np

    from sacdec.draco_mesh import draco_corners_command
    from sacdec.errors import StreamError
    from sacdec.stream import Clip, decode_stream
    from sacdec.summary import summary, tolerance
except ModuleNotFoundError as missing:
    print(f"skipped: {missing}; scripts/install-packages installs python3-numpy and python3-scipy")
    sys.exit(77)

CONFORMANCE = Path(__file__).resolve().parents[1]


def _differences(clip: Clip, expected: dict) -> list[str]:
    """In what a clip is not what the manifest says."""
    decoded = summary(clip)
    told = {key: value for key, value in expected.items() if key not in ("file", "covers", "positions")}
    wrong = [
        f"{key} is {decoded.get(key)}, not {told.get(key)}"
        for key in sorted(decoded.keys() | told.keys())
        if decoded.get(key) != told.get(key)
    ]
    if wrong:
        return wrong
    for frame, vertex, *position in expected["positions"]:
        away = np.abs(clip.frames[frame][vertex] - position)
        if not np.all(away <= tolerance(clip.segment_of(frame), np.array([vertex]), np.array([position]))):
            wrong.append(f"frame {frame}, vertex {vertex} is {away.max():g} away")
    return wrong


def check_valid(expected: dict) -> str:
    """Nothing if a valid stream decodes as the manifest says, else what is wrong."""
    try:
        clip = decode_stream((CONFORMANCE / expected["file"]).read_bytes())
    except StreamError as error:
        return f"refused: {error}"
    return "; ".join(_differences(clip, expected))


def check_invalid(expected: dict) -> tuple[str, str]:
    """What is wrong, nothing if a malformed stream is refused with its class; and the rule that it was refused by."""
    try:
        decode_stream((CONFORMANCE / expected["file"]).read_bytes())
    except StreamError as error:
        if error.kind != expected["class"]:
            return f"class {error.kind}, not {expected['class']}: {error}", ""
        return "", f"R{error.rule}"
    return "accepted", ""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-v", "--verbose", action="store_true", help="a line for every stream")
    verbose = parser.parse_args().verbose
    try:
        draco_corners_command()
    except FileNotFoundError as missing_program:
        print(f"skipped: {missing_program}")
        return 77
    manifest = json.loads((CONFORMANCE / "manifest.json").read_text())
    failures = 0
    for expected in manifest["valid"]:
        begin = time.perf_counter()
        wrong = check_valid(expected)
        failures += bool(wrong)
        if wrong or verbose:
            print(f"{expected['file']}: {wrong or 'as expected'}, {time.perf_counter() - begin:.2f} s")
    for expected in manifest["invalid"]:
        wrong, rule = check_invalid(expected)
        failures += bool(wrong)
        # "Of a stream that breaks several, any of their classes will do" (spec.md 8).
        by_another = f", by {rule}" if rule not in ("", expected["rule"]) else ""
        if wrong or verbose:
            print(f"{expected['file']}: {wrong or 'refused' + by_another}")
    print(f"{len(manifest['valid'])} valid and {len(manifest['invalid'])} invalid streams, {failures} not as expected")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
