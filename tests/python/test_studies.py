# SPDX-License-Identifier: Apache-2.0
"""Held-out blocks, and the commands as functions."""

import json
import pickle
import subprocess
import sys

import numpy as np
import pytest
from conftest import INPUTS, SMALL, SOURCE_DIR, TARGETS, drive

import kelpie

pandas = pytest.importorskip("pandas")
QUICK = {"buffer": 60, "anchors": 15}


@pytest.fixture(scope="module")
def table():
    long = drive(2100)
    return pandas.DataFrame(np.column_stack([long.t, long.y, long.X]),
                            columns=["t", *TARGETS, *INPUTS])


@pytest.fixture(scope="module")
def compared(table):
    return kelpie.compare(table, settings=QUICK, split="pieces")


@pytest.fixture(scope="module")
def command(build_dir):
    def run(*words):
        return subprocess.run([build_dir / "kelpie", *map(str, words)], check=True, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE).stdout
    return run


def learned(result):
    """Without the times that the computer took."""
    return [{name: value for name, value in axis.items() if "us" not in name and name != "time"}
            for axis in result["axes"]]


def test_blocks_are_those_of_learn(table, command, tmp_path):
    table.to_csv(tmp_path / "log.csv", index=False)
    for kind in ("blocks", "pieces", "tail"):
        (training, held_out), = kelpie.BlockSplit(kind).split(table)
        found = kelpie.report(tmp_path / "log.csv", split=kind, settings=QUICK, align="none")
        assert (found["training_rows"], found["held_out_rows"]) == (len(training), len(held_out))
    (training, held_out), = kelpie.BlockSplit().split(table)
    rows = np.arange(2100)
    assert np.array_equal(held_out, rows[rows // 400 % 5 == 4])
    assert np.array_equal(training, rows[rows // 400 % 5 != 4])
    (_, held_out), = kelpie.BlockSplit(block_rows=10, every=3).split(rows, groups=rows // 1000)
    assert np.array_equal(held_out, [row for row in rows if row % 1000 // 10 % 3 == 2])
    with pytest.raises(ValueError, match="'bloks'.*did you mean 'blocks'"):
        next(kelpie.BlockSplit("bloks").split(table))
    with pytest.raises(ValueError, match="kind: 5 is no kind of split such as 'blocks'"):
        next(kelpie.BlockSplit(5).split(table))
    with pytest.raises(ValueError, match="configuration 0 has 100 rows"):
        next(kelpie.BlockSplit().split(table[:100]))
    with pytest.raises(ValueError, match="a whole number per row"):
        next(kelpie.BlockSplit().split(table, groups=[1.5]))


def test_blocks_work_in_scikit_learn(log):
    selection = pytest.importorskip("sklearn.model_selection")
    split = kelpie.BlockSplit("pieces")
    scores = selection.cross_val_score(kelpie.DynamicsModel(**SMALL), log.X, log.y, cv=split)
    (training, held_out), = split.split(log.X)
    model = kelpie.DynamicsModel(**SMALL).fit(log.X[training], log.y[training])
    assert list(scores) == [model.score(log.X[held_out], log.y[held_out])]


def test_a_report_is_that_of_learn(table, command, tmp_path):
    table.to_csv(tmp_path / "log.csv", index=False)
    sets = [word for name, value in QUICK.items() for word in ("--set", f"{name}={value}")]
    said = command("learn", tmp_path / "log.csv", "--split", "tail", *sets, "--out",
                   tmp_path / "out")
    found = kelpie.report(tmp_path / "log.csv", split="tail", settings=QUICK)
    assert learned(found) == learned(json.loads((tmp_path / "out" / "result.json").read_text()))
    assert found.page.count("<figure") == (tmp_path / "out" / "report.html").read_text().count(
        "<figure") > 0
    assert found.text.splitlines()[0] == said.splitlines()[0]
    assert "kelpie-" not in found.text  # no file that is gone
    saved = kelpie.DynamicsModel.load(tmp_path / "out" / "model.json")
    assert np.array_equal(found.model.predict(table), saved.predict(table))
    r2 = found.table.loc[("udot", "kelpie"), "r2_final"]
    assert r2 == found["axes"][0]["r2"]["final"] > 0.8
    assert "least_squares" in found.table.index.get_level_values("model")


def test_a_data_frame_gives_the_numbers_of_its_file(table, tmp_path):
    table.to_csv(tmp_path / "log.csv", index=False)
    of_file = kelpie.report(tmp_path / "log.csv", settings=QUICK)
    of_frame = kelpie.report(table, settings=QUICK)
    assert learned(of_frame) == learned(of_file)
    assert of_frame["dataset"]["path"] == "the data frame"
    assert "of the data frame" in of_frame.text and "0.csv" not in of_frame.text + of_frame.page
    stamped = table.drop(columns="t").set_index(
        pandas.Timestamp("2026-03-01", tz="Europe/Berlin") + pandas.to_timedelta(table.t, unit="s"))
    assert kelpie.report(stamped, settings=QUICK)["axes"][0]["r2"] == of_file["axes"][0]["r2"]
    arrays = kelpie.read_log(tmp_path / "log.csv", frame=False)
    again = kelpie.report(arrays, settings=QUICK, out=tmp_path / "kept")
    assert learned(again) == learned(of_file)
    assert again["dataset"]["path"] == str(tmp_path / "log.csv")
    assert (tmp_path / "kept" / "model.json").exists() and str(tmp_path / "kept") in again.text
    with pytest.raises(ValueError, match="the data frame: time: is unknown"):
        kelpie.report(table.drop(columns="t"))


def test_missing_values_of_pandas_are_empty(table):
    missing = table.copy()
    missing.loc[700, "u"] = np.nan
    nullable = missing.astype("Float64")
    assert nullable.u.isna()[700]
    assert learned(kelpie.report(nullable, settings=QUICK)) == learned(
        kelpie.report(missing, settings=QUICK))
    stamped = table.assign(t=pandas.Timestamp("2026-03-01") + pandas.to_timedelta(table.t, unit="s"))
    stamped.loc[700, "t"] = pandas.NaT
    assert kelpie.report(stamped, settings=QUICK)["axes"][0]["r2"]["final"] > 0.8


def test_units_and_doubt_of_a_model_are_kept(table, command, tmp_path):
    table.to_csv(tmp_path / "log.csv", index=False)
    sets = [word for name, value in QUICK.items() for word in ("--set", f"{name}={value}")]
    command("learn", tmp_path / "log.csv", "--units", "n1=rev/s", *sets, "--out", tmp_path / "out")
    told = json.loads((tmp_path / "out" / "model.json").read_text())
    told["doubt"] = "udot is in g"
    (tmp_path / "doubt.json").write_text(json.dumps(told))
    with pytest.warns(UserWarning, match="doubt.json: the model is doubtful: udot is in g"):
        model = kelpie.DynamicsModel.load(tmp_path / "doubt.json")
    assert set(told) >= {"doubt", "units", "learned"}

    def saved(model):
        model.save(tmp_path / "copy.json")
        return json.loads((tmp_path / "copy.json").read_text())

    assert saved(model) == told == saved(pickle.loads(pickle.dumps(model)))
    model.partial_fit(table[INPUTS].iloc[:50], table[TARGETS].iloc[:50], t=table.t.iloc[:50])
    again = saved(pickle.loads(pickle.dumps(model)))
    assert (again["doubt"], again["units"]) == (told["doubt"], told["units"])
    assert "learned" not in again
    assert "doubt" not in saved(model.fit(table[INPUTS], table[TARGETS], t=table.t))


def test_comparisons_and_searches(table, compared):
    assert [one["kind"] for one in compared["contenders"]][0] == "kelpie"
    assert compared.table.loc[("udot", "kelpie"), "r2_final"] > 0.8
    assert compared["recommendation"] and "<html" in compared.page
    tuned = kelpie.tune(table, candidates=2, settings={**QUICK, "C": 0.2, "lambda_terms": 1e-4},
                        split="pieces")
    assert tuned["tuned"]["buffer"] == "60" and float(tuned["tuned"]["lambda"]) == 1e-4
    assert tuned.table.loc[("gamma", "vdot"), "value"] == tuned["tuned"]["gamma"].split(",")[-1]


def test_options_may_be_lists(table, tmp_path):
    tuned = kelpie.tune(table, candidates=2, settings=QUICK, split="pieces", accept=["implausible"],
                        search=["gamma=0.1,0.2", "k=5:10"])
    assert set(tuned["tuned"]["gamma"].split(",")) <= {"0.1", "0.2"}
    models = [tmp_path / "a.json", tmp_path / "b.json"]
    for file in models:
        kelpie.report(table, settings=QUICK).model.save(file)
    found = kelpie.report(table, settings=QUICK, nominal=models, inputs=INPUTS)
    assert all(str(file) in json.dumps(found) for file in models)


def test_a_call_leaves_nothing_behind_for_the_next(table, capfd):
    brief = kelpie.report(table, settings=QUICK)
    whole = kelpie.report(table, settings=QUICK, verbose=True)
    assert len(whole.text) > len(brief.text)
    document = kelpie.report(table, settings=QUICK, json=True)
    assert learned(json.loads(document.text)) == learned(document)
    assert kelpie.report(table, settings=QUICK).text.splitlines()[0] == brief.text.splitlines()[0]
    assert capfd.readouterr().out == ""


def test_a_vehicle_is_identified(command, tmp_path):
    (tmp_path / "scenario.toml").write_text(
        f'vehicle = "{SOURCE_DIR}/vehicles/dagon.toml"\nrate_hz = 4.0\nnoise = "as_recorded"\n'
        '[[configurations]]\nname = "nominal"\n[[phases]]\nconfiguration = "nominal"\n'
        'duration_s = 600.0\n')
    command("simulate", tmp_path / "scenario.toml", "--out", tmp_path / "log.csv")
    found = kelpie.identify(tmp_path / "log.csv", mass=32.0, units={"th1": "rev/s"})
    parameters = found.table
    sway = parameters.loc["sway_inertia"]
    assert sway["unit"] == "kg" and sway["low90"] < sway["value"] < sway["high90"]
    assert found["parameters"]["th1.forward"]["unit"] == "N/(rev s^-1)^2"
    assert min(axis["vehicle"] for axis in found["held_out_r2"].values()) > 0.5


def test_mistakes_are_told_as_by_the_command(table, tmp_path):
    for options, message in (({"splt": "tail"}, r"no option --splt \(did you mean '--split'"),
                             ({"split": "tial"}, "'tial' is no split"),
                             ({"settings": {"buffr": 3}}, "did you mean 'buffer'"),
                             ({"settings": {"buffer": object()}}, "neither a number nor a text"),
                             ({"rate": "4 Hz"}, "--rate")):
        with pytest.raises(ValueError, match=message):
            kelpie.report(table, **options)
    with pytest.raises(FileNotFoundError):
        kelpie.compare(tmp_path / "none.csv")
    wrong = table.assign(udot=100.0 * table.udot)
    with pytest.raises(ValueError, match="udot"):
        kelpie.report(wrong, settings=QUICK)


def test_figures(table, compared):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    axes = kelpie.plot.comparison(compared)
    assert [tick.get_text() for tick in axes.get_yticklabels()] == TARGETS
    shown = dict(zip((line.get_label() for line in axes.lines),
                     (line.get_xdata() for line in axes.lines)))
    kelpie_r2 = [axis["r2"]["final"] for axis in compared["contenders"][0]["axes"]]
    assert list(shown["kelpie"]) == kelpie_r2
    axes = kelpie.plot.learning(compared, target="vdot")
    assert len(axes.lines) == len(compared["contenders"])
    names = [text.get_text() for text in axes.get_legend().get_texts()]
    assert "least squares" in names and "last value" not in names, "nothing is drawn of it"
    assert len(kelpie.plot.learning(kelpie.report(table, settings=QUICK)).lines) == 1
    validation = {"samples": [100, 200, 300], "r2": [-4000.0, 0.9, 0.95]}
    wild = {"axes": [{"name": "udot", "validation": validation, "r2": {"final": 0.95}}]}
    low, high = kelpie.plot.learning(wild).get_ylim()
    assert low == -0.2 and 1.0 <= high < 1.1, "R² ends at 1, whatever lies far below"
    model = kelpie.DynamicsModel(**QUICK).fit(table)
    axes = kelpie.plot.predictions(model, table[TARGETS], table.t, target="vdot")
    measured, predicted = (line.get_ydata() for line in axes.lines)
    assert np.array_equal(measured, table.vdot)
    assert np.array_equal(predicted, model.decisions_["predicted"]["vdot"], equal_nan=True)
    with pytest.raises(ValueError, match="there is no 'wdot'"):
        kelpie.plot.predictions(model, table[TARGETS], target="wdot")


def test_importing_kelpie_imports_no_matplotlib():
    script = "import sys, kelpie; assert not any(m.startswith('matplotlib') for m in sys.modules)"
    subprocess.run([sys.executable, "-B", "-c", script], check=True)
