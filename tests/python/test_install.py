# SPDX-License-Identifier: Apache-2.0
"""pip install and python3 -m build work, here with the module that is already built."""

import importlib.util
import os
import shutil
import subprocess
import sys
import tarfile
import zipfile

import pytest
from conftest import SOURCE_DIR

TAKEN = ["CMakeLists.txt", "LICENSE", "MANIFEST.in", "pyproject.toml", "setup.py", "cmake",
         "include", "python", "src", "docs/howto/python.md"]
PIP = [sys.executable, "-m", "pip"]
OFFLINE = ["--no-build-isolation", "--no-index", "--no-deps"]


@pytest.fixture
def source(tmp_path):
    folder = tmp_path / "source"
    (folder / "docs/howto").mkdir(parents=True)
    for name in TAKEN:
        copy = shutil.copytree if (SOURCE_DIR / name).is_dir() else shutil.copy
        copy(SOURCE_DIR / name, folder / name)
    return folder


def files_below(folder):
    return {str(file.relative_to(folder)) for file in folder.rglob("*")
            if file.is_file() and "__pycache__" not in file.parts
            and not any(part.endswith(".egg-info") for part in file.parts)}


def test_pip_installs_the_package(build_dir, source, tmp_path):
    target = tmp_path / "site"
    subprocess.run([*PIP, "install", "--quiet", *OFFLINE, "--target", target, source],
                   check=True, env={**os.environ, "KELPIE_BUILD_DIR": str(build_dir)})
    script = """
import kelpie, numpy, importlib.metadata
X = numpy.random.default_rng(1).standard_normal((300, 2))
assert kelpie.OnlineSVR().fit(X, X[:, 0]).score(X, X[:, 0]) > 0.9
assert importlib.metadata.version("kelpie") == kelpie.__version__
print(kelpie.__file__)
"""
    found = subprocess.run([sys.executable, "-B", "-c", script], check=True, text=True,
                           stdout=subprocess.PIPE, env={**os.environ, "PYTHONPATH": str(target)})
    assert found.stdout.strip() == str(target / "kelpie" / "__init__.py")
    assert {"py.typed", "_kelpie.pyi"} <= {file.name for file in (target / "kelpie").iterdir()}


def test_build_makes_a_wheel_and_a_source_that_is_whole(build_dir, source, tmp_path):
    if importlib.util.find_spec("build") is None:
        pytest.skip("there is no python3-build")
    wanted = {name for name in files_below(source) if not name.startswith("docs/")}
    subprocess.run([sys.executable, "-m", "build", "--no-isolation", "--outdir", tmp_path / "dist",
                    source], check=True, stdout=subprocess.DEVNULL,
                   env={**os.environ, "KELPIE_BUILD_DIR": str(build_dir)})
    archive, = (tmp_path / "dist").glob("kelpie-*.tar.gz")
    with tarfile.open(archive) as opened:
        opened.extractall(tmp_path / "archive")
    unpacked, = (tmp_path / "archive").iterdir()
    assert wanted - files_below(unpacked) == set()
    wheel, = (tmp_path / "dist").glob("kelpie-*.whl")
    names = zipfile.ZipFile(wheel).namelist()
    assert {name.split("/")[0] for name in names if ".dist-info" not in name} == {"kelpie"}
    assert any(name.startswith("kelpie/_kelpie.cpython-") for name in names)
    subprocess.run(["cmake", "-S", unpacked, "-B", tmp_path / "configured",
                    "-DKELPIE_BUILD_PYTHON=ON", "-DKELPIE_BUILD_LIVE=OFF",
                    "-DKELPIE_BUILD_TESTS=OFF", "-DKELPIE_INSTALL=OFF",
                    f"-DPython3_EXECUTABLE={sys.executable}"],
                   check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def test_pip_compiles_on_as_many_jobs_as_there_are_cores(build_dir, source, tmp_path):
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
    environment = {name: value for name, value in os.environ.items() if name != "KELPIE_BUILD_DIR"}
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
