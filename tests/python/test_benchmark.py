# SPDX-License-Identifier: Apache-2.0
"""The open benchmark: what learners are shown and asked, naive rows, manifests, the page."""

import functools
import http.server
import json
import os
import re
import shutil
import subprocess
import sys
import threading

import numpy as np
import pytest
from conftest import INPUTS, SOURCE_DIR, TARGETS, drive

from kelpie import benchmark
from kelpie.benchmark import Entry, ManifestError
from kelpie.benchmark import _data, _entries, _fetch, _origins, _tracks
from kelpie.benchmark.__main__ import main

README = SOURCE_DIR / "python/kelpie/benchmark/README.md"
RUNS, ROWS = 10, 60  # of each stretch, and of each run
MANIFEST = """# a comment
[[data]]
name = "small"
files = ["small.csv"]
inputs = ["u", "v", "n1", "n2"]
targets = ["udot", "vdot"]
time = "t"
run = "run"
configuration = "conf"
simulated = true
tracks = ["anytime", "open_loop", "changes", "rates", "hostile", "cost"]
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A log of two vehicles, ten runs each, and its manifest."""
    folder = tmp_path_factory.mktemp("benchmark")
    log = drive(2 * RUNS * ROWS)
    run = np.arange(len(log.t)) // ROWS
    conf = run // RUNS
    y = log.y + conf[:, None] * 0.05 * log.X[:, 2:3]  # the second vehicle accelerates otherwise
    columns = np.column_stack([log.t, run, conf, log.X, y])
    np.savetxt(folder / "small.csv", columns, delimiter=",", comments="",
               header=",".join(["t", "run", "conf", *INPUTS, *TARGETS]))
    (folder / "small.toml").write_text(MANIFEST)
    return folder


@pytest.fixture(scope="module")
def data(folder):
    source, = benchmark.read_manifest(folder / "small.toml")
    return _data.load(source, 10_000, seed=1)


def entry(made, name="spy", offline=False):
    return Entry(name, "yours", made, "", offline)


class Spy:
    """Remembers whatever the benchmark shows."""

    seen = []

    def __init__(self, task):
        Spy.seen = []
        self.targets = len(task.targets)

    def partial_fit(self, X, y, t):
        Spy.seen.append(("learn", X, y, t))

    def predict(self, X):
        Spy.seen.append(("predict", X))
        return np.zeros((len(X), self.targets))


def test_whole_runs_are_left_out_of_every_stretch(data):
    for stretch in (0, 1):
        here = data.stretch == stretch
        assert np.unique(data.run[here & data.left_out]).tolist() == [
            stretch * RUNS + 4, stretch * RUNS + 9]
        assert not set(data.run[data.left_out]) & set(data.run[~data.left_out])


def test_a_learner_is_shown_no_row_before_its_time(data):
    _tracks.stream(entry(Spy), data)
    rows = data.rows(~data.left_out)
    left_out = {row.tobytes() for row in data.X[data.left_out]}
    learned = 0
    for kind, *given in Spy.seen:
        # Copies: the base of a view would have the rows to come.
        assert all(values.base is None and values.flags.owndata for values in given)
        if kind == "learn":
            X, y, t = given
            assert len(X) <= _tracks.BLOCK
            for values, of in ((X, rows.X), (y, rows.y), (t, rows.t)):
                np.testing.assert_array_equal(values, of[learned:learned + len(X)])
            learned += len(X)
        elif len(given[0]) == 1 and given[0][0].tobytes() not in left_out:  # one step ahead
            np.testing.assert_array_equal(given[0][0], rows.X[learned])
        else:
            assert {row.tobytes() for row in given[0]} <= left_out
    assert learned == len(rows.t)


def test_questions_are_in_an_order_that_tells_nothing(data):
    """Neighbours in time would tell the acceleration: it is the difference of velocities."""
    _tracks.stream(entry(Spy), data)
    asked = [given[0] for kind, *given in Spy.seen if kind == "predict" and len(given[0]) > 16]
    place = {row.tobytes(): i for i, row in enumerate(data.X)}
    for X in asked:
        rows = np.array([place[row.tobytes()] for row in X])
        assert (np.diff(rows) == 1).mean() < 0.1


def test_an_answer_by_neighbours_is_refused(data):
    class Neighbours(_entries.VelocityHeld):
        def predict(self, X):
            step = np.diff(X[:, :2], axis=0, prepend=X[:1, :2])
            return 10.0 * step

    with pytest.raises(_tracks.EntryError, match="depend on its row only"):
        _tracks.stream(entry(Neighbours), data)


def test_open_loop_shows_no_later_velocity(data):
    shown = []

    class Rollout(_entries.VelocityHeld):
        def rollout(self, X, t):
            shown.append(X)
            return X[:, :2]

    made = entry(Rollout)
    learner, _ = _tracks.stream(made, data)
    found = _tracks.open_loop(made, learner, data)
    assert found["steps"] == [1, 10, 50]  # runs are too short for 100 steps
    for X in shown:
        assert (X[:, :2] == X[0, :2]).all()
        assert (X[:, 2:] != X[0, 2:]).any()
    held = entry(_entries.VelocityHeld, "velocity-held")
    learner, _ = _tracks.stream(held, data)
    assert _tracks.open_loop(held, learner, data)["error"] == pytest.approx(found["error"])


# The paper's protocol.

@pytest.fixture(scope="module")
def whole(folder):
    """The same log for the track paper, with its own splits, and with splits of columns."""
    text = MANIFEST.replace('["anytime", "open_loop", "changes", "rates", "hostile", "cost"]',
                            '["paper"]')
    (folder / "paper.toml").write_text(text)
    (folder / "columns.toml").write_text(text + 'held_out = ["conf", "odd"]\n')
    names, *lines = (folder / "small.csv").read_text().splitlines()
    odd = [f"{line},{i % 2}" for i, line in enumerate(lines)]
    (folder / "small.csv").write_text("\n".join([f"{names},odd", *odd, ""]))
    return [_data.load(benchmark.read_manifest(folder / name)[0], 200, seed=1)
            for name in ("paper.toml", "columns.toml")]


def test_the_papers_track_has_all_rows_and_both_splits(whole):
    data = whole[0].whole
    assert len(data.t) == 2 * RUNS * ROWS  # of which 200 are learned on other tracks
    for vehicle in (0, 1):
        here = data.vehicle == vehicle
        assert data.splits["random"][here].mean() == pytest.approx(0.2)
    assert np.diff(np.flatnonzero(np.diff(data.splits["blocks"]))).min() > 10  # whole blocks
    assert list(whole[1].whole.splits) == ["conf", "odd"]


def test_the_papers_track_shows_learned_rows_and_asks_held_out_rows(whole):
    data = whole[0].whole
    found = _tracks.paper(entry(Spy), whole[0])["splits"]
    assert [split["name"] for split in found] == ["random", "blocks"]
    learned = np.concatenate([given[0] for kind, *given in Spy.seen if kind == "learn"])
    np.testing.assert_array_equal(learned, data.X[data.splits["blocks"] == 0])  # the last split
    ends = [look for look in found[1]["looks"] if look["ends"]]
    assert [look["vehicle"] for look in ends] == [0, 1]
    assert ends[-1]["rows"] == len(learned)
    assert found[1]["looks"][0]["rows"] == _tracks.LOOK


def test_the_papers_track_scores_the_present_vehicle(whole):
    data = whole[0].whole
    for split in _tracks.paper(entry(_entries.Mean), whole[0])["splits"]:
        marks = data.splits[split["name"]]
        look, = [look for look in split["looks"] if look["ends"] and look["vehicle"] == 0]
        rows = (data.vehicle == 0) & (marks == 1)
        said = data.y[(data.vehicle == 0) & (marks == 0)].mean(axis=0)
        y = data.y[rows]
        r2 = 1 - ((y - said) ** 2).sum(axis=0) / ((y - y.mean(axis=0)) ** 2).sum(axis=0)
        assert look["r2"] == pytest.approx(r2)


def test_fifo_and_sosvr_learn_the_papers_track(whole):
    entries = {one.name: one for one in benchmark.builtin_entries()}
    for name in ("kelpie-paper", "fifo", "sosvr"):
        if name in entries:  # sosvr needs scikit-learn
            found = _tracks.paper(entries[name], whole[0])["splits"]
            assert found[0]["final"] > 0.3, name


def test_sosvr_keeps_independent_rows(data):
    pytest.importorskip("sklearn")
    learner = _entries.Sosvr(data.task)
    learner.ROWS = 40
    rows = data.rows(~data.left_out)
    learner.partial_fit(rows.X, rows.y, rows.t)
    assert len(learner.X) == 40
    apart = ((learner.X[:, None] - learner.X) ** 2).sum(axis=2)
    kernel = np.exp(-learner.GAMMA * apart) + learner.RIDGE * np.eye(40)
    np.testing.assert_allclose(learner.inverse @ kernel, np.eye(40), atol=1e-5)
    learner.partial_fit(rows.X[:1], rows.y[:1], rows.t[-1:])
    again = len(learner.t[learner.t == rows.t[-1]])
    learner.partial_fit(rows.X[:1], rows.y[:1], rows.t[-1:])  # the same row is dependent
    assert len(learner.t[learner.t == rows.t[-1]]) == again


# Naive rows against numpy.

def scores(data, predicted):
    last = data.left_out & (data.vehicle == data.vehicle[-1])
    y = data.y[last]
    r2 = 1 - ((y - predicted(last)) ** 2).sum(axis=0) / ((y - y.mean(axis=0)) ** 2).sum(axis=0)
    return np.maximum(r2, -1.0).mean()


def test_naive_rows_are_as_numpy_has_them(data):
    entries = {one.name: one for one in benchmark.builtin_entries()}
    final = {name: _tracks.stream(entries[name], data)[1]["anytime"]["final"]
             for name in ("mean", "last-value", "velocity-held", "least-squares")}
    learned = ~data.left_out
    assert final["mean"] == pytest.approx(scores(data, lambda rows: data.y[learned].mean(axis=0)))
    assert final["last-value"] == pytest.approx(scores(data, lambda rows: data.y[learned][-1]))
    assert final["velocity-held"] == pytest.approx(scores(data, lambda rows: 0.0))
    u, v, n1, n2 = data.X.T
    F = np.column_stack([np.ones(len(u)), u, v, u * abs(u), v * abs(v), u * v, n1, n2,
                         n1 * abs(n1), n2 * abs(n2)])
    fitted, *_ = np.linalg.lstsq(F[learned], data.y[learned], rcond=None)
    assert final["least-squares"] == pytest.approx(scores(data, lambda rows: F[rows] @ fitted),
                                                   abs=1e-4)


def test_forgetting_is_that_of_recursive_least_squares(data):
    """The textbook's recursion, row by row, from a vague beginning."""
    forget = 0.98
    X, y = data.X[:300], data.y[:300]
    F = _entries.physics_terms(X, data.task.states)
    P, w = 1e9 * np.eye(F.shape[1]), np.zeros((F.shape[1], 2))
    for f, target in zip(F, y):
        gain = P @ f / (forget + f @ P @ f)
        w = w + np.outer(gain, target - f @ w)
        P = (P - np.outer(gain, f @ P)) / forget
    learner = _entries.LeastSquares(data.task, forget)
    for at in range(0, 300, 7):
        learner.partial_fit(X[at:at + 7], y[at:at + 7])
    np.testing.assert_allclose(learner.predict(X[-50:]), F[-50:] @ w, atol=2e-3)


def test_velocity_and_acceleration_held_in_open_loop(data):
    last = data.rows(data.left_out & (data.vehicle == data.vehicle[-1]))
    starts = _tracks._starts(last, 10)
    usual = last.X[:, :2].std(axis=0)
    for name, made, ends in (
            ("velocity-held", _entries.VelocityHeld, last.X[starts][:, :2]),
            ("last-value", _entries.LastValue, last.X[starts][:, :2] + 1.0 * last.y[starts - 1])):
        learner, _ = _tracks.stream(entry(made, name), data)
        found = _tracks.open_loop(entry(made, name), learner, data)
        wrong = np.sqrt(((ends - last.X[starts + 10][:, :2]) ** 2).mean(axis=0)) / usual
        assert found["error"][1] == pytest.approx(wrong.mean(), rel=1e-6)


def test_integration_follows_the_exact_motion(data):
    """v' = -v, whose answer is known."""
    rows = data.rows(data.left_out)
    starts = _tracks._starts(rows, 10)
    ends = _tracks.integrate(lambda X: -X[:, :2], rows, starts, 10)
    np.testing.assert_allclose(ends, np.exp(-1.0) * rows.X[starts][:, :2], rtol=3e-3)


def test_rates_keep_the_drive(data):
    half, twice = _data.thinned(data, 2), _data.doubled(data)
    assert (half.task.rate, twice.task.rate) == pytest.approx((5.0, 20.0))
    assert len(half.t) == len(data.t) / 2
    assert len(twice.t) == 2 * len(data.t) - len(np.unique(data.run))  # no row between two runs
    assert (np.diff(twice.t) > 0).all()
    kept = np.isin(twice.t, data.t)
    np.testing.assert_array_equal(twice.X[kept], data.X)
    assert set(twice.run[twice.left_out]) == set(data.run[data.left_out])


@pytest.mark.parametrize("kind", _tracks.SPOILT)
def test_hostile_rows_differ_and_stay_finite(kind, data):
    X, y = data.X.copy(), data.y.copy()
    _tracks.SPOILT[kind](np.random.default_rng(1), X, y, data.task.states)
    changed = ((X != data.X).any(axis=1) | (y != data.y).any(axis=1)).mean()
    assert 0.01 < changed < 0.15
    assert np.isfinite(X).all() and np.isfinite(y).all()


def test_left_out_rows_stay_sound_under_hostile_rows(data):
    class Checks(Spy):
        def predict(self, X):
            sound = {row.tobytes() for row in data.X[data.left_out]}
            assert {row.tobytes() for row in X} <= sound
            return super().predict(X)

    assert _tracks.hostile(entry(Checks), data)["kinds"] == list(_tracks.SPOILT)


# The command.

def run(*arguments):
    return main([str(argument) for argument in arguments])


def without_cost(file):
    found = json.loads(file.read_text())
    for result in found["results"]:
        result.pop("cost", None)
    return {key: value for key, value in found.items()
            if key not in ("seconds", "computing_seconds", "command")}


def test_a_seed_gives_the_same_figures_with_any_number_of_processes(folder, tmp_path, capsys):
    manifest = folder / "small.toml"
    options = ["--only", "kelpie-small,rls-0.99", "--rows", "500"]
    assert run("run", manifest, "--out", tmp_path / "one", *options) == 0
    assert run("run", manifest, "--out", tmp_path / "two", *options, "--jobs", "2") == 0
    one, two = (without_cost(tmp_path / name / "benchmark.json") for name in ("one", "two"))
    for found in (one, two):
        found["limits"].pop("jobs")
    assert one == two
    said = capsys.readouterr().out
    assert re.search(r"^kelpie-small +0\.[0-9]{3} ", said, re.M)
    results = {one["entry"]: one for one in one["results"]}
    assert results["kelpie-small"]["anytime"]["final"] > 0.6
    assert results["kelpie-small"]["changes"]["after_rows"] == [50, 100, 200]  # of some 250
    assert results["mean"]["hostile"]["not_finite"] == 0
    assert (tmp_path / "one/index.html").read_text().startswith("<!DOCTYPE html>")


def test_tracks_are_those_of_the_data_set_and_of_the_command(folder, tmp_path):
    assert run("run", folder / "small.toml", "--out", tmp_path, "--only", "none", "--rows", "500",
               "--tracks", "anytime,changes") == 0
    record = json.loads((tmp_path / "benchmark.json").read_text())
    assert {"anytime", "changes"} <= record["results"][0].keys()
    assert not {"open_loop", "rates", "hostile", "cost"} & record["results"][0].keys()
    assert "--tracks anytime,changes" in record["command"]


def test_the_page_is_whole_and_escapes(folder, tmp_path):
    learner = tmp_path / "wild.py"
    learner.write_text('class Wild:\n    "<script>alert(1)</script>"\n'
                       "    def partial_fit(self, X, y): self.n = y.shape[1]\n"
                       "    def predict(self, X): return 0.0 * X[:, :self.n] + 1e300\n")
    assert run("run", folder / "small.toml", "--out", tmp_path / "out", "--only", "none",
               "--entry", f"{learner}:Wild", "--rows", "300") == 0
    page = (tmp_path / "out/index.html").read_text()
    assert "&lt;script&gt;" in page and "<script" not in page
    assert not re.search(r'(src|href)="(?!https://)', page)  # no other file
    assert page.count("<table>") == page.count("</table>") > 5
    found = json.loads((tmp_path / "out/benchmark.json").read_text())
    wild, = [one for one in found["results"] if one["entry"] == "Wild"]
    assert wild["anytime"]["final"] == -1.0
    again = tmp_path / "again.html"
    assert run("page", tmp_path / "out/benchmark.json", "--out", again) == 0
    assert again.read_text() == page
    (tmp_path / "other.json").write_text("[1]")
    assert run("page", tmp_path / "other.json", "--out", again) == 2


def test_an_entry_that_fails_says_why_and_the_others_go_on(folder, tmp_path, capsys):
    learner = tmp_path / "broken.py"
    learner.write_text("class Raises:\n    def partial_fit(self, X, y): raise KeyError('u')\n"
                       "    def predict(self, X): return X\n"
                       "class Dies(Raises):\n    def partial_fit(self, X, y):\n"
                       "        import os; os._exit(7)\n")
    assert run("run", folder / "small.toml", "--out", tmp_path / "out", "--only", "none", "--rows",
               "300", "--entry", f"{learner}:Raises", "--entry", f"{learner}:Dies") == 1
    said = capsys.readouterr().err
    assert "Raises on small: partial_fit raised KeyError: 'u'" in said
    assert "Dies on small: its process ended with code 7" in said
    found = json.loads((tmp_path / "out/benchmark.json").read_text())
    assert [one["entry"] for one in found["results"] if "failed" in one] == ["Raises", "Dies"]


def test_a_number_that_rounds_to_zero_has_no_sign():
    from kelpie.benchmark._page import columns
    column = columns()[0]
    assert column.text(-0.0001) == "0.000" and column.text(-0.0123) == "−0.012"


def test_the_page_says_how_sgd_regressor_enters(folder, tmp_path, monkeypatch):
    """The lines of the page, by which a newcomer enters scikit-learn's SGDRegressor."""
    pytest.importorskip("sklearn")
    lines, = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.S)
    assert len([line for line in lines.splitlines() if line.strip()]) <= 20
    (tmp_path / "my_learner.py").write_text(lines)
    monkeypatch.chdir(tmp_path)
    assert run("run", folder / "small.toml", "--out", "out", "--only", "none", "--rows", "900",
               "--entry", "my_learner.py:Sgd") == 0
    found = json.loads((tmp_path / "out/benchmark.json").read_text())
    mine, = [one for one in found["results"] if one["entry"] == "Sgd"]
    assert mine["anytime"]["final"] > 0.5
    monkeypatch.syspath_prepend(tmp_path)
    assert benchmark.load_entry("my_learner:Sgd").name == "Sgd"


BAD = {
    "name = 1": (3, "name of '1': a text is wanted, not 1"),
    'inptus = ["u"]': (3, "inptus of 'small': is not known; did you mean 'inputs'?"),
    'targets = "udot"': (6, "targets of 'small': a list of texts is wanted"),
    "rate = -4": (3, "rate of 'small': a number above 0 is wanted, not -4"),
    'inputs = ["u", "th9"]': (5, "inputs of 'small': 'th9' is no column of"),
    'files = ["none.csv"]': (4, "none.csv is not there"),
    'sha256 = ["00"]': (3, "has SHA-256"),
    'tracks = ["speed"]': (11, "'speed' is no track; the tracks are anytime, open_loop"),
    'states = ["u"]': (3, "has 1 names for 2 targets"),
    'states = ["u", "w"]': (3, "'w' is no input"),
    "gap = 5.0": (3, "gap of 'small': stands beside run"),
    'run = "conf"': (8, "a single run"),
    'time = "n1"': (7, "goes back at row"),
    "name =": (3, "is not TOML"),
}


@pytest.mark.parametrize("line", BAD)
def test_a_bad_manifest_names_file_line_and_key(line, folder, tmp_path, capsys):
    key = line.split(" ")[0]
    text = MANIFEST
    if re.search(rf"^{key} = ", text, re.M):
        text = re.sub(rf"^{key} = .*$", line.replace("\\", r"\\"), text, flags=re.M)
    else:
        text = text.replace("[[data]]\n", f"[[data]]\n{line}\n")
    (tmp_path / "bad.toml").write_text(text)
    (tmp_path / "small.csv").symlink_to(folder / "small.csv")
    assert run("run", tmp_path / "bad.toml", "--out", tmp_path / "out", "--only", "none") == 2
    said = capsys.readouterr().err
    number, message = BAD[line]
    assert message in said
    if message != "a single run":
        assert f"bad.toml:{number}:" in said


def test_other_bad_manifests(tmp_path):
    for text in ("", "data = 3", "[data]\nname = 'a'"):
        (tmp_path / "bad.toml").write_text(text)
        with pytest.raises(ManifestError, match=r"bad.toml:1: has no table \[\[data\]\]"):
            benchmark.read_manifest(tmp_path / "bad.toml")
    (tmp_path / "bad.toml").write_text("[[data]]\nname = 'a'\nfiles = ['a']\ninputs = ['u']\n")
    with pytest.raises(ManifestError, match="bad.toml:1: targets of 'a': is missing"):
        benchmark.read_manifest(tmp_path / "bad.toml")
    (tmp_path / "bad.toml").write_text("data = [{name = 'a'}]")
    with pytest.raises(ManifestError, match=r"bad.toml:1: has to write each .* \[\[data\]\]"):
        benchmark.read_manifest(tmp_path / "bad.toml")
    (tmp_path / "bad.toml").write_text(2 * MANIFEST)
    with pytest.raises(ManifestError, match="names two data sets"):
        benchmark.read_manifest(tmp_path / "bad.toml")
    with pytest.raises(ManifestError, match="none.toml: is no file"):
        benchmark.read_manifest(tmp_path / "none.toml")


@pytest.mark.parametrize("place,message", {
    "numpy": "has no ':'; give module:Class, or file.py:Class",
    "no_such_module:Learner": "cannot be imported: ModuleNotFoundError",
    "none.py:Learner": "none.py is no file",
    "kelpie.benchmark:Nothing": "has no class Nothing",
    "kelpie:BlockSplit": "has no method partial_fit",
}.items())
def test_a_bad_entry_says_what_would_be_right(place, message, folder, tmp_path, capsys):
    assert run("run", folder / "small.toml", "--out", tmp_path / "out", "--entry", place) == 2
    assert message in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_names_that_are_not_known(folder, tmp_path, capsys):
    for option, message in (("--only", "'river' is not known; there are kelpie"),
                            ("--tracks", "'river' is not known; there are anytime"),
                            ("--data", "'river' is not known; there are small")):
        assert run("run", folder / "small.toml", "--out", tmp_path / "out", option, "river") == 2
        assert message in capsys.readouterr().err


def test_the_module_is_a_command(build_dir):
    found = subprocess.run([sys.executable, "-B", "-m", "kelpie.benchmark", "entries"], check=True,
                           text=True, stdout=subprocess.PIPE).stdout
    for name in ("mean", "last-value", "velocity-held", "least-squares", "kelpie", "kelpie-small",
                 "kelpie-paper", "fifo", "rls-0.99", "rls-0.999", "rls-0.9999"):
        assert re.search(rf"^{re.escape(name)} ", found, re.M)


# The public data sets.

def test_public_data_have_origins_licences_and_checksums():
    sources = benchmark.read_manifest(_fetch.PUBLIC)
    assert {one.name: one.license for one in sources} == {
        "holohover": "BSD-2-Clause", "fish": "MIT", "husky": "BSD-3-Clause",
        "haizhe": "CC-BY-4.0", "slocum": "MIT", "sea035": "Apache-2.0"}
    for source in sources:
        assert source.origin.startswith("https://") and source.conversion
        assert len(source.sha256) == len(source.files)
        assert all(re.fullmatch("[0-9a-f]{64}", digits) for digits in source.sha256)


@pytest.fixture
def two_files(tmp_path, monkeypatch):
    """A public manifest of two small files, and a folder with them."""
    copies = tmp_path / "copies/below"
    copies.mkdir(parents=True)
    public = tmp_path / "public.toml"
    text = ""
    for name in "ab":
        (copies / f"{name}.csv").write_text(f"t,{name}\n0,1\n")
        text += (f"[[data]]\nname = '{name}'\nfiles = ['{name}.csv']\ninputs = ['{name}']\n"
                 f"targets = ['{name}']\norigin = 'https://example.org'\nlicense = 'MIT'\n"
                 f"sha256 = ['{benchmark._manifest.checksum(copies / f'{name}.csv')}']\n")
    public.write_text(text)
    monkeypatch.setattr(_fetch, "PUBLIC", public)
    return copies


def test_fetch_takes_checked_files_from_a_folder(two_files, tmp_path, capsys):
    assert run("fetch", tmp_path / "data", "--from", two_files.parent) == 0
    said = capsys.readouterr().out
    assert "a: 1 file(s), checked; licence MIT; from https://example.org" in said
    assert sorted(file.name for file in (tmp_path / "data").iterdir()) == [
        "a.csv", "b.csv", "public.toml"]
    (two_files / "b.csv").write_text("t,b\n0,2\n")
    assert run("fetch", tmp_path / "data", "--from", two_files.parent) == 0  # they are there
    assert run("fetch", tmp_path / "other", "--from", two_files.parent) == 2
    assert "b.csv: has SHA-256" in capsys.readouterr().err
    assert not list((tmp_path / "other").glob("*b.csv*"))
    assert run("fetch", tmp_path / "other", "--from", tmp_path / "none") == 2


@pytest.mark.parametrize("place", ["below", None])
def test_fetch_tells_what_is_not_there(place, two_files, tmp_path, capsys):
    (two_files / "b.csv").unlink()
    options = [] if place is None else ["--from", two_files]
    assert run("fetch", tmp_path / "other", *options) == 1
    said = capsys.readouterr().err
    assert "b: no b.csv, which is a converted file: give --from" in said
    assert ("a: no a.csv" in said) == (place is None)


def test_fetch_takes_checked_files_from_the_web(two_files, tmp_path, capsys):
    handler = functools.partial(http.server.SimpleHTTPRequestHandler, directory=two_files)
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        address = f"http://127.0.0.1:{server.server_port}"
        assert run("fetch", tmp_path / "data", "--from", address) == 0
        assert (tmp_path / "data/a.csv").read_text() == "t,a\n0,1\n"
        assert run("fetch", tmp_path / "other", "--from", f"{address}/none") == 1
        server.shutdown()
    assert "a: no a.csv" in capsys.readouterr().err


def test_fish_is_made_of_its_origins_file(tmp_path, capsys):
    pytest.importorskip("scipy")
    origin = _origins.ORIGINS["fish_20hz.csv"]
    shared = [SOURCE_DIR / folder / "logs/matlab_v5_fish.mat" for folder in
              (os.environ.get("KELPIE_DATA_DIR", "none"), "../shared/data")]
    copy = next((file for file in shared if file.exists()), None)
    if copy is None:
        pytest.skip("matlab_v5_fish.mat is not there (KELPIE_DATA_DIR)")
    (tmp_path / "copies").mkdir()
    shutil.copyfile(copy, tmp_path / "copies" / origin.name)
    assert run("fetch", tmp_path / "data", "--from", tmp_path / "copies") == 1
    said = capsys.readouterr()
    assert "fish: 1 file(s), checked" in said.out
    assert "husky: no husky_20hz.csv" in said.err
    (tmp_path / "copies" / origin.name).write_bytes(b"another file")
    assert run("fetch", tmp_path / "other", "--from", tmp_path / "copies") == 2
    assert f"{origin.name}: has SHA-256" in capsys.readouterr().err


# The record of the figures in docs/measured/accuracy.md, which the site shows.

RECORD = SOURCE_DIR / "scripts/site/benchmark.json"


def test_the_table_of_the_docs_is_that_of_the_record():
    from kelpie.benchmark._page import columns, summary
    results = json.loads(RECORD.read_text(encoding="utf-8"))
    assert results["protocol"] == benchmark.PROTOCOL
    text = (SOURCE_DIR / "docs/measured/accuracy.md").read_text(encoding="utf-8")
    section = text.split("\n## The open benchmark\n")[1].split("\n## ")[0]
    assert results["command"] in section
    rows = [[cell.strip().strip("*") for cell in line.strip("| ").split("|")]
            for line in section.splitlines() if line.startswith("|")]
    names = {column.short: i for i, column in enumerate(columns())}
    shown = rows[0][1:]
    wanted = [[entry["name"], *(columns()[names[name]].text(means[names[name]]) for name in shown)]
              for entry, means in summary(results)]
    assert rows[2:2 + len(wanted)] == wanted


def test_the_record_is_of_the_public_data_and_of_every_entry():
    results = json.loads(RECORD.read_text(encoding="utf-8"))
    names = {one["name"] for one in results["data"]}
    assert {source.name for source in benchmark.read_manifest(_fetch.PUBLIC)} <= names
    assert sum(name.startswith("sim-") for name in names) == 7
    recorded = {entry["name"] for entry in results["entries"]}
    # Entries of the track paper, younger than the record; the next record has both.
    assert {one.name for one in benchmark.builtin_entries()} - recorded <= {"fifo", "sosvr"}
    assert not [one for one in results["results"] if "failed" in one]
