# SPDX-License-Identifier: Apache-2.0
"""The programs of a build, by other ways than a user's."""

import re
import subprocess
import sys
from pathlib import Path

import kelpie
from conftest import SOURCE_DIR


def test_libraries_in_the_users_folder_are_not_loaded(build_dir, tmp_path):
    for program, command in ((build_dir / "kelpie", [build_dir / "kelpie", "--version"]),
                             (kelpie._kelpie.__file__, [sys.executable, "-c", "import kelpie"])):
        told = subprocess.run(["ldd", program], check=True, text=True, stdout=subprocess.PIPE)
        libraries = re.findall(r"^\s*(\S+) => /", told.stdout, re.M)
        assert any(name.startswith("libz.") for name in libraries)
        folder = tmp_path / Path(program).name
        folder.mkdir()
        for name in libraries:
            (folder / name).touch()
        done = subprocess.run(command, cwd=folder, check=False, text=True, stderr=subprocess.PIPE)
        assert (done.returncode, done.stderr) == (0, "")


def test_mutants_for_the_wrong_program_are_refused(build_dir):
    done = subprocess.run([sys.executable, SOURCE_DIR / "scripts/mutate.py", build_dir / "kelpie"],
                          check=False, text=True, stderr=subprocess.PIPE)
    assert done.returncode == 2
    assert "has to be the program kelpie_in_a_row" in done.stderr
