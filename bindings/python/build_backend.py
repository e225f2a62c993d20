# SPDX-License-Identifier: Apache-2.0
"""What pip calls to make a wheel of this checkout (PEP 517), with Python's own library alone.

The wheel holds the module and a libsac that needs nothing but the C library, so that one wheel serves every Python 3 of
the platform. CMake builds it in build/python; SAC_BUILD names another folder, whose configuration is kept.
"""

import base64
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sysconfig
import tarfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
MODULE = ROOT / "bindings" / "python" / "sac"
OPTIONS = [
    "-DCMAKE_BUILD_TYPE=Release",
    "-DSAC_BUILD_SHARED=ON",
    "-DSAC_STANDALONE=ON",
    *(f"-DSAC_BUILD_{part}=OFF" for part in ("CLI", "TESTS", "CONFORMANCE", "EXAMPLES")),
    "-DSAC_INSTALL=OFF",
]
METADATA = """\
Metadata-Version: 2.1
Name: sac
Version: {version}
Summary: Streaming codec for animated triangle meshes
License: Apache-2.0
Requires-Python: >=3.9
Requires-Dist: numpy
"""
WHEEL = """\
Wheel-Version: 1.0
Generator: sac
Root-Is-Purelib: false
Tag: {tag}
"""


def version():
    """The version of the library, which is the module's."""
    text = (ROOT / "include" / "sac" / "version.h").read_text()
    return ".".join(re.search(rf"SAC_VERSION_{part} (\d+)", text)[1] for part in ("MAJOR", "MINOR", "PATCH"))


def build_library():
    """Builds libsac and returns its path."""
    folder = pathlib.Path(os.environ.get("SAC_BUILD", ROOT / "build" / "python"))
    generator = ["-G", "Ninja"] if shutil.which("ninja") and not (folder / "CMakeCache.txt").exists() else []
    subprocess.run(["cmake", "-S", ROOT, "-B", folder, *generator, *OPTIONS], check=True)
    jobs = str(len(os.sched_getaffinity(0)))
    subprocess.run(["cmake", "--build", folder, "--target", "sac_shared", "--parallel", jobs], check=True)
    return folder / f"libsac.so.{version()}"


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):  # pylint: disable=unused-argument
    """Writes the wheel into a folder and returns its name."""
    library = build_library()
    tag = "py3-none-" + re.sub(r"[-.]", "_", sysconfig.get_platform())
    info = f"sac-{version()}.dist-info"
    soname = "libsac.so." + version().rpartition(".")[0]
    files = {f"sac/{path.name}": path.read_bytes() for path in sorted(MODULE.iterdir()) if path.is_file()}
    files[f"sac/{soname}"] = library.read_bytes()
    files[f"{info}/METADATA"] = METADATA.format(version=version()).encode()
    files[f"{info}/WHEEL"] = WHEEL.format(tag=tag).encode()
    files[f"{info}/LICENSE"] = (ROOT / "LICENSE").read_bytes()
    record = "".join(f"{name},{digest(data)},{len(data)}\n" for name, data in files.items())
    files[f"{info}/RECORD"] = f"{record}{info}/RECORD,,\n".encode()
    name = f"sac-{version()}-{tag}.whl"
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / name, "w", zipfile.ZIP_DEFLATED) as wheel:
        for path, data in files.items():
            entry = zipfile.ZipInfo(path, (2020, 1, 1, 0, 0, 0))  # the same bytes of the same sources
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            wheel.writestr(entry, data)
    return name


def build_sdist(sdist_directory, config_settings=None):  # pylint: disable=unused-argument
    """Writes the files that git knows as a source archive and returns its name."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, stdout=subprocess.PIPE).stdout
    folder = f"sac-{version()}"
    info = tarfile.TarInfo(f"{folder}/PKG-INFO")
    metadata = pathlib.Path(sdist_directory) / "PKG-INFO"
    metadata.write_text(METADATA.format(version=version()))
    with tarfile.open(pathlib.Path(sdist_directory) / f"{folder}.tar.gz", "w:gz") as archive:
        for name in filter(None, listed.decode().split("\0")):
            archive.add(ROOT / name, f"{folder}/{name}")
        info.size = metadata.stat().st_size
        with metadata.open("rb") as file:
            archive.addfile(info, file)
    metadata.unlink()
    return f"{folder}.tar.gz"


def digest(data):
    """A hash as RECORD files have it."""
    return "sha256=" + base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
