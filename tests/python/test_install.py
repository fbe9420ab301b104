# SPDX-License-Identifier: Apache-2.0
"""pip install and python3 -m build work, here with the module that is already built."""

import importlib.util
import json
import os
import platform
import re
import shutil
import subprocess
import sys
import tarfile
import zipfile

import pytest
from conftest import SOURCE_DIR

TAKEN = ["CMakeLists.txt", "LICENSE", "MANIFEST.in", "pyproject.toml", "setup.py", "cmake",
         "include", "python", "src", "docs/howto/python.md", "scripts/sbom.py"]
PIP = [sys.executable, "-m", "pip"]
OFFLINE = ["--no-build-isolation", "--no-index", "--no-deps"]


@pytest.fixture
def source(tmp_path):
    folder = tmp_path / "source"
    (folder / "docs/howto").mkdir(parents=True)
    (folder / "scripts").mkdir()
    for name in TAKEN:
        copy = shutil.copytree if (SOURCE_DIR / name).is_dir() else shutil.copy
        copy(SOURCE_DIR / name, folder / name)
    return folder


def files_below(folder):
    return {str(file.relative_to(folder)) for file in folder.rglob("*")
            if file.is_file() and "__pycache__" not in file.parts
            and not any(part.endswith(".egg-info") for part in file.parts)}


@pytest.fixture
def quick(tmp_path):
    """The environment of a build that does not compress."""
    (tmp_path / "quick.cfg").write_text("[bdist_wheel]\ncompression = stored\n")
    return {**os.environ, "DIST_EXTRA_CONFIG": str(tmp_path / "quick.cfg")}


def learns_from(site, wish="True"):
    """The folder that a Python with `site` imports kelpie from, once it has learned."""
    script = f"""
import kelpie, numpy, importlib.metadata
X = numpy.random.default_rng(1).standard_normal((300, 2))
assert kelpie.OnlineSVR().fit(X, X[:, 0]).score(X, X[:, 0]) > 0.9
assert importlib.metadata.version("kelpie") == kelpie.__version__
assert {wish}
print(kelpie.__path__[0])
"""
    return subprocess.run([sys.executable, "-B", "-c", script], check=True, text=True,
                          stdout=subprocess.PIPE,
                          env={**os.environ, "PYTHONPATH": str(site)}).stdout.strip()


def test_build_makes_a_source_that_is_whole_and_a_wheel_that_pip_installs(build_dir, source,
                                                                          quick, tmp_path):
    if importlib.util.find_spec("build") is None:
        pytest.skip("there is no python3-build")
    wanted = {name for name in files_below(source) if not name.startswith("docs/")}
    subprocess.run([sys.executable, "-m", "build", "--no-isolation", "--outdir", tmp_path / "dist",
                    source], check=True, stdout=subprocess.DEVNULL,
                   env={**quick, "KELPIE_BUILD_DIR": str(build_dir)})
    archive, = (tmp_path / "dist").glob("kelpie-*.tar.gz")
    with tarfile.open(archive) as opened:
        opened.extractall(tmp_path / "archive")
    unpacked, = (tmp_path / "archive").iterdir()
    assert wanted - files_below(unpacked) == set()
    wheel, = (tmp_path / "dist").glob("kelpie-*.whl")
    names = zipfile.ZipFile(wheel).namelist()
    assert {name.split("/")[0] for name in names if ".dist-info" not in name} == {"kelpie"}
    assert any(name.startswith("kelpie/_kelpie.cpython-") for name in names)
    target = tmp_path / "site"
    subprocess.run([*PIP, "install", "--quiet", *OFFLINE, "--target", target, wheel], check=True)
    assert learns_from(target) == str(target / "kelpie")
    assert {"py.typed", "_kelpie.pyi"} <= {file.name for file in (target / "kelpie").iterdir()}
    subprocess.run(["cmake", "-S", unpacked, "-B", tmp_path / "configured",
                    "-DKELPIE_BUILD_PYTHON=ON", "-DKELPIE_BUILD_LIVE=OFF",
                    "-DKELPIE_BUILD_TESTS=OFF", "-DKELPIE_INSTALL=OFF",
                    f"-DPython3_EXECUTABLE={sys.executable}"],
                   check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def test_pip_compiles_on_as_many_jobs_as_there_are_cores(build_dir, source, quick, tmp_path):
    """With a cmake that notes its arguments and hands out the module that is already built."""
    module, = (build_dir / "python" / "kelpie").glob("_kelpie.*.so")
    tools = tmp_path / "tools"
    tools.mkdir()
    (tools / "cmake").write_text(f"""#!/bin/sh
echo "$*" >> '{tmp_path}/calls'
case "$1" in
  -S) mkdir -p "$4/python/kelpie" && cp '{module}' "$4/python/kelpie/" ;;
esac
""")
    (tools / "cmake").chmod(0o755)
    environment = {name: value for name, value in quick.items() if name != "KELPIE_BUILD_DIR"}
    done = subprocess.run([*PIP, "-v", "wheel", *OFFLINE, "--wheel-dir", tmp_path / "wheels",
                           source], check=True, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, start_new_session=True,
                          env={**environment, "PATH": f"{tools}:{os.environ['PATH']}"})
    configure, build = (tmp_path / "calls").read_text().splitlines()
    cores = len(os.sched_getaffinity(0))
    assert build.endswith(f"--target kelpie_python --parallel {cores}")
    assert "-DKELPIE_JOIN_SOURCES=ON" in configure
    assert f"compiling on {cores} core(s)" in done.stdout
    assert list((tmp_path / "wheels").glob("kelpie-*.whl"))


def test_a_portable_wheel_needs_the_c_library_and_numpy_alone(build_dir, source, quick, tmp_path):
    for tool in ("patchelf", "dpkg-query", "ninja"):
        if shutil.which(tool) is None:
            pytest.skip(f"there is no {tool}")
    environment = {**quick, "KELPIE_BUILD_DIR": str(build_dir), "KELPIE_PORTABLE": "1"}
    subprocess.run([*PIP, "wheel", "--quiet", *OFFLINE, "--wheel-dir", tmp_path, source],
                   check=True, env=environment)
    wheel, = tmp_path.glob("kelpie-*.whl")
    libc = platform.libc_ver()[1].replace(".", "_")
    assert wheel.name.endswith(f"-manylinux_{libc}_{platform.machine()}.whl")
    site = tmp_path / "site"
    with zipfile.ZipFile(wheel) as opened:
        opened.extractall(site)
    libraries = {file.name for file in (site / "kelpie/_libraries").glob("*.so*")}
    module, = (site / "kelpie").glob("_kelpie.*.so")
    common = re.compile(r"(ld-linux|lib(c|m|gcc_s|stdc\+\+|resolv|asan|ubsan)\.so)")
    for file in [module, *(site / "kelpie/_libraries").glob("*.so*")]:
        told = subprocess.run(["readelf", "-d", file], check=True, text=True,
                              stdout=subprocess.PIPE).stdout
        needed = re.findall(r"\(NEEDED\).*\[(.*)\]", told)
        assert {name for name in needed if not common.match(name)} <= libraries, file
        assert re.findall(r"\(RUNPATH\).*\[(.*)\]", told) in (
            ["$ORIGIN/_libraries"], ["$ORIGIN"]), file
        newest = max((tuple(map(int, version.split("."))) for version in re.findall(
            r"GLIBC_(2\.\d+)", subprocess.run(["readelf", "-V", file], check=True, text=True,
                                               stdout=subprocess.PIPE).stdout)), default=(2, 0))
        assert newest <= tuple(map(int, libc.split("_"))), file
    assert {file.name for file in (site / "kelpie/_libraries").glob("*.copyright")} >= {
        "libhwy1.copyright", "libsqlite3-0.copyright"}
    bill, = site.glob("kelpie-*.dist-info/sboms/kelpie.spdx.json")
    assert "pybind11-dev" in {p["name"] for p in json.loads(bill.read_text())["packages"]}
    maps = 'open("/proc/self/maps").read()'
    learns_from(site, f'"{site}/kelpie/_libraries/libsqlite3-" in {maps} and '
                      f'"/libsqlite3.so" not in {maps}')
