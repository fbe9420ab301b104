# SPDX-License-Identifier: Apache-2.0
"""pip install works, here with the module that is already built."""

import os
import shutil
import subprocess
import sys

from conftest import SOURCE_DIR

TAKEN = ["CMakeLists.txt", "pyproject.toml", "setup.py", "python", "docs/python.md"]


def test_pip_installs_the_package(build_dir, tmp_path):
    source = tmp_path / "source"
    (source / "docs").mkdir(parents=True)
    for name in TAKEN:
        copy = shutil.copytree if (SOURCE_DIR / name).is_dir() else shutil.copy
        copy(SOURCE_DIR / name, source / name)
    target = tmp_path / "site"
    subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--no-build-isolation",
                    "--no-index", "--no-deps", "--target", target, source],
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
