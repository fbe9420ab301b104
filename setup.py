# SPDX-License-Identifier: Apache-2.0
"""Builds the Python package with CMake: pip install --no-build-isolation .

With KELPIE_BUILD_DIR set to a build folder (build/release), its module is taken instead of
building another one. With KELPIE_PORTABLE=1, `pip wheel` makes a wheel for machines that have none
of the libraries below kelpie.
"""

import hashlib
import os
import platform
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parent
PORTABLE = os.environ.get("KELPIE_PORTABLE") == "1"
# What every Linux with the C library of the wheel's tag has (PEP 600).
COMMON = re.compile(r"(ld-linux.*|lib(c|m|dl|rt|pthread|gcc_s|stdc\+\+|resolv))\.so\.\d+$")


def version() -> str:
    """The version that CMake knows."""
    text = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"project\(kelpie VERSION ([0-9.]+)", text).group(1)


class CMakeBuild(build_ext):
    """Has CMake make the module."""

    def build_extension(self, ext: Extension) -> None:
        name = Path(self.get_ext_filename(ext.name)).name
        target = Path(self.get_ext_fullpath(ext.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(self.build_folder() / "python" / "kelpie" / name, target)

    def build_folder(self) -> Path:
        """The folder of the build with the module."""
        ready = os.environ.get("KELPIE_BUILD_DIR")
        return Path(ready) if ready else self.build_module()

    def build_module(self) -> Path:
        folder = Path(self.build_temp).resolve()
        jobs = len(os.sched_getaffinity(0))
        say(f"kelpie: compiling on {jobs} core(s), some {round(10 / jobs) + 1} minutes; "
            "pip install -v shows each step")
        ninja = ["-G", "Ninja"] if shutil.which("ninja") else []
        # libmatio would bring a client of HTTP, Kerberos and LDAP into a portable wheel.
        without = ["-DKELPIE_WITH_MATLAB=OFF"] if PORTABLE else []
        # The same bytes from any folder.
        roots = ((ROOT, "."), (folder, "build"))
        flags = " ".join([os.environ.get("CXXFLAGS", ""),
                          *(f"-ffile-prefix-map={shlex.quote(str(path))}={name}"
                            for path, name in roots)])
        subprocess.run(
            ["cmake", "-S", str(ROOT), "-B", str(folder), *ninja, "-DCMAKE_BUILD_TYPE=Release",
             "-DKELPIE_BUILD_PYTHON=ON", "-DKELPIE_BUILD_LIVE=OFF", "-DKELPIE_BUILD_TESTS=OFF",
             "-DKELPIE_INSTALL=OFF", "-DKELPIE_JOIN_SOURCES=ON", "-DBUILD_SHARED_LIBS=OFF",
             f"-DPython3_EXECUTABLE={sys.executable}", "-DCMAKE_BUILD_RPATH_USE_ORIGIN=ON",
             f"-DCMAKE_CXX_FLAGS={flags.strip()}", *without],
            check=True)
        subprocess.run(["cmake", "--build", str(folder), "--target", "kelpie_python",
                        "--parallel", str(jobs)], check=True)
        return folder


def libraries_below(module: Path) -> "dict[str, Path]":
    """The shared libraries that a module needs and not every Linux has, by name."""
    told = subprocess.run(["ldd", str(module)], check=True, capture_output=True, text=True).stdout
    found = dict(re.findall(r"^\s*(\S+) => (\S+) \(", told, re.M))
    return {name: Path(path).resolve() for name, path in found.items() if not COMMON.match(name)}


def take_libraries(module: Path) -> None:
    """Puts copies of a module's libraries into the folder _libraries beside the module.

    A copy has a name that no other package's copy has, because the loader keeps one library per
    name in a process; the licences of the copies stand beside the copies.
    """
    folder = module.parent / "_libraries"
    folder.mkdir()
    libraries = libraries_below(module)
    names = {}
    for name, path in libraries.items():
        stem, _, rest = name.partition(".so")
        names[name] = f"{stem}-{hashlib.sha256(path.read_bytes()).hexdigest()[:8]}.so{rest}"
        shutil.copyfile(path, folder / names[name])
        (folder / names[name]).chmod(0o644)
    take_licences(libraries.values(), folder)
    subprocess.run(["strip", "--strip-unneeded", str(module)], check=True)
    replacements = [word for pair in names.items() for word in ("--replace-needed", *pair)]
    for file in [module, *(folder / name for name in names.values())]:
        rpath = "$ORIGIN/_libraries" if file == module else "$ORIGIN"
        soname = [] if file == module else [["--set-soname", file.name]]
        # One change a call: patchelf 0.14 damages names otherwise.
        for change in [replacements, *soname, ["--set-rpath", rpath]]:
            subprocess.run(["patchelf", *change, str(file)], check=True)


def take_licences(libraries: Iterable[Path], folder: Path) -> None:
    """Puts the licences of libraries' Debian packages beside the libraries' copies."""
    paths = {spelling for library in libraries  # /usr/lib is /lib, too
             for spelling in (str(library), str(Path("/", *library.parts[2:])))}
    # One call for all libraries: a call reads the list of every installed file.
    told = subprocess.run(["dpkg-query", "--search", *sorted(paths)], check=False,
                          capture_output=True, text=True).stdout
    for package in set(re.findall(r"^([^:,\s]+)[:,]", told, re.M)):
        shutil.copyfile(f"/usr/share/doc/{package}/copyright", folder / f"{package}.copyright")


def portable_wheel() -> type:
    """The command that makes a wheel with everything below the module but the C library."""
    from wheel.bdist_wheel import bdist_wheel

    class PortableWheel(bdist_wheel):
        """A wheel for every Linux with this C library or a newer one."""

        def finalize_options(self) -> None:
            super().finalize_options()
            libc = platform.libc_ver()[1].replace(".", "_")
            self.plat_name = f"manylinux_{libc}_{platform.machine()}"

        def write_wheelfile(self, wheelfile_base: str, *args: str) -> None:
            super().write_wheelfile(wheelfile_base, *args)
            module, = (Path(self.bdist_dir) / "kelpie").glob("_kelpie.*.so")
            build = self.get_finalized_command("build_ext")
            folder = os.environ.get("KELPIE_BUILD_DIR") or Path(build.build_temp).resolve()
            bills = Path(wheelfile_base) / "sboms"  # PEP 770
            bills.mkdir()
            subprocess.run([sys.executable, str(ROOT / "scripts" / "sbom.py"), str(folder),
                            str(module), str(bills / "kelpie.spdx.json")], check=True)
            take_libraries(module)
            for file in Path(self.bdist_dir).rglob("*"):  # whatever the builder's umask is
                file.chmod(0o755 if file.is_dir() else 0o644)

    return PortableWheel


def say(text: str) -> None:
    """Tells the terminal: pip keeps what a build prints to itself."""
    print(text, flush=True)
    try:
        with open("/dev/tty", "w", encoding="utf-8") as terminal:
            terminal.write(f"\n{text}\n")
    except OSError:
        pass  # there is none


setup(version=version(), ext_modules=[Extension("kelpie._kelpie", sources=[])],
      cmdclass={"build_ext": CMakeBuild, **({"bdist_wheel": portable_wheel()} if PORTABLE else {})})
