#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Decodes a sac stream by the text of spec.md, slowly.

Writes one OBJ file a frame, or a JSON object: what conformance/manifest.json says of a stream, with the positions of all
vertices in all frames as [frame, vertex, x, y, z]. Vertices have the numbers of spec.md 5.3.
"""

import argparse
import json
import sys
from pathlib import Path

from sacdec.errors import StreamError
from sacdec.obj_file import write_frames
from sacdec.stream import Clip, decode_stream
from sacdec.summary import summary


def _json(clip: Clip) -> str:
    result = summary(clip)
    result["positions"] = [
        [frame, vertex, *position]
        for frame, positions in enumerate(clip.frames)
        for vertex, position in enumerate(positions.tolist())
    ]
    return json.dumps(result)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("stream", type=Path, metavar="STREAM")
    output = parser.add_mutually_exclusive_group(required=True)
    output.add_argument("-o", "--output", type=Path, metavar="DIR", help="write frame_0000.obj and so on there")
    output.add_argument("--json", action="store_true", help="write a JSON object to standard output")
    arguments = parser.parse_args()
    try:
        clip = decode_stream(arguments.stream.read_bytes())
        if arguments.json:
            print(_json(clip))
        else:
            write_frames(clip, arguments.output)
    except StreamError as error:
        print(f"{arguments.stream}: {error.kind}: {error}", file=sys.stderr)
        return 1
    except OSError as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
