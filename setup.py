# SPDX-License-Identifier: Apache-2.0
"""Builds the Python package with CMake: pip install --no-build-isolation .

With KELPIE_BUILD_DIR set to a build folder (build/release), its module is taken instead of
building another one.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parent


def version() -> str:
    """The version that CMake knows."""
    text = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"project\(kelpie VERSION ([0-9.]+)", text).group(1)


class CMakeBuild(build_ext):
    """Has CMake make the module."""

    def build_extension(self, ext: Extension) -> None:
        ready = os.environ.get("KELPIE_BUILD_DIR")
        folder = Path(ready) if ready else self.build_module()
        name = Path(self.get_ext_filename(ext.name)).name
        target = Path(self.get_ext_fullpath(ext.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(folder / "python" / "kelpie" / name, target)

    def build_module(self) -> Path:
        folder = Path(self.build_temp).resolve()
        jobs = len(os.sched_getaffinity(0))
        say(f"kelpie: compiling on {jobs} core(s), some {round(10 / jobs) + 1} minutes; "
            "pip install -v shows each step")
        ninja = ["-G", "Ninja"] if shutil.which("ninja") else []
        subprocess.run(
            ["cmake", "-S", str(ROOT), "-B", str(folder), *ninja, "-DCMAKE_BUILD_TYPE=Release",
             "-DKELPIE_BUILD_PYTHON=ON", "-DKELPIE_BUILD_LIVE=OFF", "-DKELPIE_BUILD_TESTS=OFF",
             "-DKELPIE_INSTALL=OFF", "-DKELPIE_JOIN_SOURCES=ON", "-DBUILD_SHARED_LIBS=OFF",
             f"-DPython3_EXECUTABLE={sys.executable}"],
            check=True)
        subprocess.run(["cmake", "--build", str(folder), "--target", "kelpie_python",
                        "--parallel", str(jobs)], check=True)
        return folder


def say(text: str) -> None:
    """Tells the terminal: pip keeps what a build prints to itself."""
    print(text, flush=True)
    try:
        with open("/dev/tty", "w", encoding="utf-8") as terminal:
            terminal.write(f"\n{text}\n")
    except OSError:
        pass  # there is none


setup(version=version(), ext_modules=[Extension("kelpie._kelpie", sources=[])],
      cmdclass={"build_ext": CMakeBuild})
