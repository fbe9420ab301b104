# SPDX-License-Identifier: Apache-2.0
"""Names of columns and files, written into the files of other programs: each file is read by a
parser of its own kind, and no name becomes code."""

import ast
import csv
import io
import json
import re
import shutil
import subprocess
import tomllib
import zipfile
from html.parser import HTMLParser
from xml.etree import ElementTree

import pytest
from conftest import SOURCE_DIR

try:
    import yaml
except ImportError:
    yaml = None

NAMES = ['quote" evil "', "apo' evil '", "back\\", "*/ int evil; /*", "??/",
         "]] evil() --[[ ]==] evil()", "--> <evil/> <!--", "</script><evil>", "]]><evil/>", "&evil;",
         "${evil}", "$(arg evil)", "$${evil}", "line\nevil: 1", "line\revil()", "line\u2028evil()",
         "ü€\U0001F6A2", "\u202eevil", "\x85evil: 1", "\x7fevil", "-evil", "=evil()", "%s%n%evil",
         "# evil", "a: {evil}", '""" evil() """', "''' evil() '''", "int", "k" * 300]
THRUSTERS = ["th1", "th2", "th3"]


def threes(names):
    return [(names + THRUSTERS)[k:k + 3] for k in range(0, len(names), 3)]


def no_evil(text):
    assert "evil" not in text


def check_c(text, folder):
    compiler = shutil.which("cc")
    if compiler:
        (folder / "checked.c").write_text(text)
        for words in (["-fsyntax-only"], ["-E", "-P"]):
            done = subprocess.run(
                [compiler, "-std=c99", "-Wall", "-Werror", "-Wno-unused", *words,
                 folder / "checked.c"], capture_output=True, text=True, check=True)
        no_evil(re.sub(r'"(\\.|[^"\\])*"', "", done.stdout))


def check_xml(text, _folder):
    for element in ElementTree.fromstring(text).iter():
        assert element.tag != "evil"


def check_xacro(text, folder):
    """xacro runs ${...} and $(...) of texts and attributes, without a dollar before."""
    check_xml(text, folder)
    for element in ElementTree.fromstring(text).iter():
        for value in (element.text or "", *element.attrib.values()):
            no_evil("".join(re.findall(r"(?<!\$)\$[{(].*", value)))


def check_python(text, _folder):
    for node in ast.walk(ast.parse(text)):
        no_evil(getattr(node, "id", ""))


def check_matlab(text, _folder):
    for line in re.split("[\n\r\u2028]", text):
        no_evil(re.sub(r"'[^']*'", "", line).partition("%")[0])


def check_csv(text, _folder):
    assert len({len(row) for row in csv.reader(io.StringIO(text))}) == 1


def check_yaml(text, _folder):
    if yaml:
        assert "evil" not in yaml.safe_load(text)


class Page(HTMLParser):
    def handle_starttag(self, tag, attrs):
        assert tag != "evil" and "evil" not in dict(attrs)


def check_html(text, _folder):
    Page().feed(text)


CHECKS = {".c": check_c, ".h": check_c, ".xml": check_xml, ".sdf": check_xml,
          ".xacro": check_xacro, ".py": check_python, ".m": check_matlab, ".csv": check_csv,
          ".yaml": check_yaml, ".html": check_html,
          ".toml": lambda text, _: no_evil("".join(tomllib.loads(text))),
          ".json": lambda text, _: json.loads(text)}


def check(folder, kinds):
    """Every file of the folder; these kinds have to be among them."""
    files = list(folder.iterdir())
    assert kinds <= {file.suffix for file in files}
    for file in files:
        if file.suffix in CHECKS:
            CHECKS[file.suffix](file.read_bytes().decode(), folder.parent)


@pytest.fixture(scope="module")
def run(build_dir, tmp_path_factory):
    """Runs kelpie in a folder with whole.csv."""
    kelpie, folder = build_dir / "kelpie", tmp_path_factory.mktemp("names")
    if not kelpie.exists():
        pytest.skip("the command isn't built")

    def run(*words, code=0):
        done = subprocess.run([kelpie, *words], cwd=folder, capture_output=True, check=False)
        assert done.returncode == code, done.stderr
    run.folder = folder
    run("simulate", SOURCE_DIR / "scenarios/small.toml", "--out", "whole.csv")
    return run


def learn(run, thrusters, file="log.csv"):
    """Learns a log whose thrusters are called so. Returns the options of the log."""
    rows = list(csv.reader(io.StringIO((run.folder / "whole.csv").read_text())))[:800]
    for k, name in enumerate(thrusters, 1):
        rows[0][rows[0].index(f"th{k}")] = name
    with open(run.folder / file, "w", newline="", encoding="utf-8") as log:
        csv.writer(log, lineterminator="\n").writerows(rows)
    inputs = json.dumps(["u", "v", "r", *thrusters], ensure_ascii=False).replace("\x7f", "\\u007f")
    (run.folder / "log.toml").write_text(
        f'[log]\ntime = "t"\ninputs = {inputs}\ntargets = ["udot", "vdot", "rdot"]\n')
    log = [file, "--config", "log.toml", "--align", "none"]
    shutil.rmtree(run.folder / "out", ignore_errors=True)
    run("learn", *log, "--set", "preset=small", "--out", "out")
    return log


def check_identified(run, log, thrusters):
    known = next(name for name in thrusters if "=" not in name)
    of_log = [*log, "--thrusters", ",".join(thrusters), "--thrust", f"{known}=0.0262"]
    run("identify", *of_log, "--vehicle", SOURCE_DIR / "vehicles/dagon.toml", "--out", "out")
    run("plan", *of_log, "--tell", "sway_drag", "--seconds", "10", "--out", "out/plan")
    run("predict", log[0], "--model", "out/model.json", "--out", "out/predictions.csv")
    check(run.folder / "out",
          {".sdf", ".xacro", ".xml", ".m", ".py", ".yaml", ".json", ".html", ".csv"})
    check(run.folder / "out/plan", {".csv", ".json", ".html"})


@pytest.mark.parametrize("names", threes([n for n in NAMES if not re.search("[\n\r]", n)]))
def test_of_columns(run, names):
    check_identified(run, learn(run, names), names)


@pytest.mark.parametrize("name", [name[:200] for name in (*NAMES, "\udcffevil")
                                  if "/" not in name])
def test_of_files(run, name):
    check_identified(run, learn(run, THRUSTERS, "./" + name), THRUSTERS)


@pytest.mark.parametrize("names", threes(NAMES))
def test_of_models(run, names):
    """Names that no log has are among these."""
    if not (run.folder / "plain.json").exists():
        learn(run, THRUSTERS)
        shutil.copy(run.folder / "out/model.json", run.folder / "plain.json")
    model = json.loads((run.folder / "plain.json").read_text())
    model["inputs"][3:] = names
    for axis, name in zip(model["axes"], names):
        axis["target"] = name + "_dot"
    out = run.folder / "exported"
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir()
    (out / "model.json").write_text(json.dumps(model))
    run("export", "exported/model.json", "--c", "exported/m.c", "--header", "exported/m.h", "--fmu",
        "exported/m.fmu", "--assess", "--casadi")
    with zipfile.ZipFile(out / "m.fmu") as unit:
        (out / "modelDescription.xml").write_bytes(unit.read("modelDescription.xml"))
    check(out, {".c", ".h", ".json", ".xml"})
