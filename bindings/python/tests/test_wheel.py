# SPDX-License-Identifier: Apache-2.0
"""pip install . of the checkout, without a network, into an environment that has nothing but Debian's numpy.

usage: test_wheel.py BUILD: BUILD is the folder that the library of the wheel is built in
"""

import os
import pathlib
import subprocess
import sys
import tempfile

from clips import ROOT, VALID

PROGRAM = """
import pathlib, sys, numpy, sac
folder = pathlib.Path(sac.__file__).parent
assert sys.prefix in str(folder), folder
loaded = {line.split()[-1] for line in open("/proc/self/maps") if "libsac" in line or "libdraco" in line}
assert loaded == {str(folder / ("libsac.so." + sac.__version__.rpartition(".")[0]))}, loaded
assert sac.open(sys.argv[1])[:].shape == (45, 204, 3)
assert (folder / "py.typed").exists()
"""


def main():
    """Installs, runs a program, uninstalls."""
    environment = {**os.environ, "SAC_BUILD": sys.argv[1], "PIP_NO_INDEX": "1", "PIP_DISABLE_PIP_VERSION_CHECK": "1"}
    for name in ("PYTHONPATH", "SAC_LIBRARY"):
        environment.pop(name, None)

    def run(*command):
        result = subprocess.run(
            command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False
        )
        if result.returncode:
            sys.exit(f"failed: {' '.join(map(str, command))}\n{result.stdout}")
        return result.stdout

    with tempfile.TemporaryDirectory() as folder:
        run(sys.executable, "-m", "venv", "--system-site-packages", folder)
        python = pathlib.Path(folder) / "bin" / "python"
        run(python, "-m", "pip", "install", ROOT)
        run(python, "-c", PROGRAM, VALID / "pyramids.sac")
        print(run(python, "-m", "pip", "show", "--files", "sac"))
        run(python, "-m", "pip", "uninstall", "--yes", "sac")


if __name__ == "__main__":
    main()
