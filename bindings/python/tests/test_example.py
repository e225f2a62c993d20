# SPDX-License-Identifier: Apache-2.0
"""The example that draws draws."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

from clips import ROOT

try:
    import matplotlib.image
except ImportError:
    matplotlib = None


@unittest.skipIf(matplotlib is None, "matplotlib is not there")
class Example(unittest.TestCase):
    def test_it_draws_its_pictures(self):
        with tempfile.TemporaryDirectory() as folder:
            command = [sys.executable, ROOT / "examples" / "draw.py", folder]
            environment = {**os.environ, "MPLCONFIGDIR": folder}
            told = subprocess.run(command, check=True, env=environment, stdout=subprocess.PIPE, text=True).stdout
            self.assertIn("512 vertices", told)
            for name in ("rate", "frames", "between"):
                picture = matplotlib.image.imread(pathlib.Path(folder) / f"{name}.png")
                self.assertGreater(len({tuple(pixel) for pixel in picture[::4, ::4].reshape(-1, 4)}), 20, name)


if __name__ == "__main__":
    unittest.main()
