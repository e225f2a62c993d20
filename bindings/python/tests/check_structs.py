# SPDX-License-Identifier: Apache-2.0
"""Has a C compiler compare the structs that ctypes declares with those of the headers.

usage: check_structs.py COMPILER INCLUDE
"""

import subprocess
import sys

from sac import _library

# These know their size, so that a later library may add members at their end.
GROWING = {"sac_settings", "sac_encoder_settings"}


def assertions():
    """Lines of C that compile only where sizes, offsets and numbers of members agree."""
    yield "#include <stddef.h>"
    for header in ("sac.h", "sac_encode.h", "sac_measure.h"):
        yield f"#include <sac/{header}>"
    for name, struct in _library.STRUCTS.items():
        relation = ">=" if name in GROWING else "=="
        size = _library.ctypes.sizeof(struct)
        yield f'_Static_assert(sizeof({name}) {relation} {size}, "size of {name}, {size} in Python");'
        for field, _ in struct._fields_:
            member = getattr(struct, field)
            yield (
                f"_Static_assert(offsetof({name}, {field}) == {member.offset} && "
                f'sizeof((({name}*)0)->{field}) == {member.size}, "{name}.{field}");'
            )


def main():
    """Returns the exit code."""
    compiler, include = sys.argv[1:]
    source = "\n".join(assertions()) + "\n"
    command = [compiler, "-std=c11", f"-I{include}", "-fsyntax-only", "-x", "c", "-"]
    result = subprocess.run(command, input=source, text=True, check=False)
    print(f"{source.count('_Static_assert')} comparisons")
    return result.returncode


if __name__ == "__main__":
    sys.exit(main())
