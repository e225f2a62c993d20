# SPDX-License-Identifier: Apache-2.0
"""scripts/freeze in a repository of its own: what is frozen stays, and a change of it is found.

usage: freeze_test.py SCRIPTS
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SCRIPTS = pathlib.Path(sys.argv.pop() if len(sys.argv) == 2 else "scripts")


class Freeze(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        for name in ("scripts", "include/sac", "conformance/valid", "conformance/invalid", "conformance/golden"):
            (self.root / name).mkdir(parents=True)
        shutil.copy(SCRIPTS / "freeze", self.root / "scripts/freeze")
        (self.root / "conformance/valid/a.sac").write_bytes(b"a stream")
        (self.root / "conformance/invalid/R1.sac").write_bytes(b"none")
        (self.root / "conformance/manifest.json").write_text("{}")
        self.set_version(1, 0)
        self.git("init", "--quiet")
        self.commit()

    def git(self, *words):
        names = {"GIT_AUTHOR_NAME": "a", "GIT_AUTHOR_EMAIL": "a@b", "GIT_COMMITTER_NAME": "a", "GIT_COMMITTER_EMAIL": "a@b"}
        subprocess.run(["git", *words], cwd=self.root, check=True, env={**os.environ, **names})

    def commit(self):
        self.git("add", "--all")
        self.git("commit", "--quiet", "--allow-empty", "--message", "x")

    def set_version(self, major, minor):
        text = f"#define SAC_STREAM_VERSION_MAJOR {major}\n#define SAC_STREAM_VERSION_MINOR {minor}\n"
        (self.root / "include/sac/version.h").write_text(text)

    def freeze(self, *options):
        run = subprocess.run(["scripts/freeze", *options], cwd=self.root, capture_output=True, text=True)
        return run.returncode, run.stdout + run.stderr

    def assert_fails(self, words, *options):
        code, said = self.freeze(*options)
        self.assertEqual(code, 1, said)
        self.assertIn(words, said)

    def test_freezes_once(self):
        self.assertEqual(self.freeze()[0], 0)
        frozen = self.root / "conformance/golden/1.0"
        self.assertEqual((frozen / "valid/a.sac").read_bytes(), b"a stream")
        self.assertEqual(len((frozen / "CHECKSUMS").read_text().splitlines()), 3)
        self.commit()
        self.assertEqual(self.freeze("--check"), (0, ""))
        self.assert_fails("1.0: is frozen already")
        # A later version changes its own vectors.
        (self.root / "conformance/valid/a.sac").write_bytes(b"another")
        self.set_version(1, 1)
        self.assert_fails("uncommitted changes")
        self.commit()
        self.assertEqual(self.freeze()[0], 0)
        self.commit()
        self.assertEqual(self.freeze("--check"), (0, ""))
        self.assertEqual((frozen / "valid/a.sac").read_bytes(), b"a stream")

    def test_drafts_are_not_frozen(self):
        self.set_version(0, 9)
        self.commit()
        self.assert_fails("drafts")

    def test_changes_are_found(self):
        self.freeze()
        self.commit()
        frozen = self.root / "conformance/golden/1.0"
        (frozen / "valid/a.sac").write_bytes(b"A stream")
        self.assert_fails("a frozen file has changed", "--check")
        (frozen / "valid/a.sac").write_bytes(b"a stream")
        (frozen / "valid/b.sac").write_bytes(b"more")
        self.assert_fails("files were added", "--check")
        (frozen / "valid/b.sac").unlink()
        (frozen / "valid/a.sac").unlink()
        self.assertEqual(self.freeze("--check")[0], 1)
        # With checksums that fit, the history tells.
        sums = (frozen / "CHECKSUMS").read_text().splitlines(keepends=True)
        (frozen / "CHECKSUMS").write_text("".join(line for line in sums if "a.sac" not in line))
        self.assertEqual(self.freeze("--check"), (0, ""))
        self.commit()
        self.assert_fails("changed or removed by commit", "--check")

    def test_an_older_command_is_asked(self):
        sac = self.root / "sac"
        sac.write_text('#!/bin/sh\n[ "$1 $(cat "$2")" = "verify a stream" ]\n')
        sac.chmod(0o755)
        self.assertEqual(self.freeze("--old", str(sac)), (0, ""))
        (self.root / "conformance/valid/a.sac").write_bytes(b"what is new")
        self.assert_fails("does not decode conformance/valid/a.sac", "--old", str(sac))


if __name__ == "__main__":
    unittest.main()
