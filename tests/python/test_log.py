# SPDX-License-Identifier: Apache-2.0
"""Logs of all kinds as columns."""

import os
import re
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
from conftest import SOURCE_DIR

import kelpie

FIXTURES = SOURCE_DIR / "tests" / "logs" / "bag" / "fixtures"


def real_log(name):
    for folder in (os.environ.get("KELPIE_DATA_DIR"), SOURCE_DIR.parent / "shared" / "data"):
        if folder and (Path(folder) / name).exists():
            return Path(folder) / name
    pytest.skip(f"there is no {name}")


def test_a_csv_file_is_read_as_it_is(tmp_path):
    file = tmp_path / "log.csv"
    file.write_text("t;u;n;note;udot\n0;0.1;1;;0.5\n0.1;0.2;2;dive 7;nan\n0.2;;3;8;0.7\n")
    log = kelpie.read_log(file, frame=False)
    assert list(log) == ["t", "u", "n", "note", "udot"]
    assert np.array_equal(log["u"], [0.1, 0.2, np.nan], equal_nan=True)
    assert log["note"][1] == "dive 7" and log["note"][2] == 8.0
    assert log.attrs["time"] == "t" and log.attrs["targets"] == ["udot"]
    assert log.attrs["inputs"] == ["u", "n", "note"] or log.attrs["inputs"] == ["u", "n"]
    assert log.attrs["source"] == str(file) and log.attrs["losses"] == []


def test_a_data_frame_is_learned_as_the_command_learns(build_dir, tmp_path):
    pandas = pytest.importorskip("pandas")
    command = build_dir / "kelpie"
    if not command.exists():
        pytest.skip("the command isn't built")
    csv = tmp_path / "log.csv"
    subprocess.run([command, "simulate", SOURCE_DIR / "scenarios/small.toml", "--out", csv],
                   check=True, capture_output=True)
    (tmp_path / "log.toml").write_text("[log]\nrate = 2.0\ntime = 't'\n"
                                       "states = {v = 'v', u = 'u', r = 'r'}\n"
                                       "commands = {th2 = 'th2', th1 = 'th1'}\n"
                                       "derived = {vdot = 'd(v)', udot = 'd(u)', rdot = 'd(r)'}\n"
                                       "units = {u = 'm/s'}\n")
    subprocess.run([command, "learn", csv, "--config", tmp_path / "log.toml", "--split", "none",
                    "--align", "none", "--set", "buffer=60", "--out", tmp_path],
                   check=True, capture_output=True)
    frame = kelpie.read_log(csv, tmp_path / "log.toml")
    assert isinstance(frame, pandas.DataFrame)
    assert list(frame) == ["t", "v", "u", "r", "th2", "th1", "vdot", "udot", "rdot"]
    assert frame.attrs["inputs"] == ["v", "u", "r", "th2", "th1"]
    assert frame.attrs["units"] == {"u": "m/s"}
    model = kelpie.DynamicsModel(inputs=frame.attrs["inputs"], buffer=60).fit(frame)
    theirs = kelpie.DynamicsModel.load(tmp_path / "model.json")
    assert np.array_equal(model.predict(frame.dropna()), theirs.predict(frame.dropna()))


def test_a_log_without_accelerations_is_learned_as_the_command_learns(build_dir, tmp_path):
    pytest.importorskip("pandas")
    command = build_dir / "kelpie"
    if not command.exists():
        pytest.skip("the command isn't built")
    velocities = tmp_path / "velocities.csv"
    frame = drive()
    np.savetxt(velocities, np.column_stack([0.2 * np.arange(len(frame)), frame[:, :4]]),
               delimiter=",", comments="", header="t,surge [kn],yaw_rate,rpm,rudder")
    subprocess.run([command, "learn", velocities, "--split", "none", "--align", "none",
                    "--set", "buffer=60", "--out", tmp_path], check=True, capture_output=True)
    theirs = kelpie.DynamicsModel.load(tmp_path / "model.json")
    log = kelpie.read_log(velocities, draft=True)
    assert "derived" in log.attrs["draft"] and log.attrs["targets"] == theirs.targets_
    model = kelpie.DynamicsModel(buffer=60).fit(log)
    assert model.inputs_ == theirs.inputs_ == log.attrs["inputs"]
    assert np.array_equal(model.predict(log.dropna()), theirs.predict(log.dropna()))


def test_a_log_without_accelerations_is_refused_in_words_of_python(tmp_path):
    pytest.importorskip("pandas")
    file = tmp_path / "log.csv"
    np.savetxt(file, drive()[:, :4], delimiter=",", comments="", header="u,r,n,m")
    log = kelpie.read_log(file)
    assert log.attrs["draft"] is None and list(log) == ["u", "r", "n", "m"]
    with pytest.raises(ValueError, match=r"targets=.*read_log\(file, draft=True\)") as told:
        kelpie.DynamicsModel(rate=5.0).fit(log)
    assert "--" not in str(told.value)
    with pytest.raises(ValueError, match="draft: is guessed where"):
        kelpie.read_log(file, draft=True, pose=["x", "y"])


def test_columns_of_messages_with_units():
    columns = ["ATTITUDE:rollspeed", "VFR_HUD:groundspeed"]
    log = kelpie.read_log(real_log("logs/ardusub_small.tlog"), columns=columns, frame=False)
    assert len(log["t"]) > 100 and np.isfinite(log[columns[0]]).all()
    assert list(log) == ["t", *columns] and log.attrs["time"] == "t"
    assert log.attrs["units"] == {columns[0]: "rad/s", columns[1]: "m/s"}


def test_messages_with_a_wrong_checksum_are_counted_or_refused():
    file = real_log("logs/blueos_badcrc.tlog")
    log = kelpie.read_log(file, columns=["ATTITUDE:roll"], frame=False)
    assert len(log["t"]) > 6000
    assert [line.split(",")[0] for line in log.attrs["losses"]] == [
        "passed over: 1953 messages with a wrong checksum"]
    with pytest.raises(ValueError, match="the checksum of message 132 is wrong"):
        kelpie.read_log(file, columns=["ATTITUDE:roll"], strict=True)
    with pytest.raises(ValueError, match="strict: "):
        kelpie.read_log(file, strict=True, recover=True)


def test_what_is_wrong_is_named(tmp_path):
    bag = FIXTURES / "zstd.mcap"
    (tmp_path / "bad.csv").write_text("u,u\n1,2\n")
    for arguments, message in ((("bad.csv",), "bad.csv:1: u: two columns"),
                               (("none.csv",), "No such file.*none.csv"),
                               (("bad.csv", "none.toml"), "No such file.*none.toml")):
        with pytest.raises((ValueError, FileNotFoundError), match=message):
            kelpie.read_log(*(tmp_path / name for name in arguments))
    for given, message in (({"columns": []}, "columns: names"), ({"clock": "mine"}, "clock: 'mine'"),
                           ({"columns": ["/a:b"], "config": "c.toml"}, "no config beside"),
                           ({"columns": "/a:b"}, "there is no such topic")):
        with pytest.raises(ValueError, match=message):
            kelpie.read_log(bag, **given)
    (tmp_path / "cut.mcap").write_bytes(bag.read_bytes()[:-100])
    with pytest.raises(ValueError, match="cut.mcap: offset .* --recover"):
        kelpie.read_log(tmp_path / "cut.mcap", columns="/a:b")


def test_what_never_ends_or_breaks_a_library_is_a_value_error(tmp_path):
    corpus = SOURCE_DIR / "tests/fuzz/corpus_mat"
    crashes = sorted(corpus.glob("crash*.mat"))
    assert crashes
    for crash in crashes:
        with pytest.raises(ValueError, match=f"{crash.name}: is "):
            kelpie.read_log(crash)
    with pytest.raises(ValueError, match="/dev/zero: is a device"):
        kelpie.read_log("/dev/zero")
    with pytest.raises(ValueError, match="/dev/zero: is a device"):
        kelpie.DynamicsModel.load("/dev/zero")


def test_without_pandas(tmp_path):
    (tmp_path / "log.csv").write_text("t,u\n0,1\n1,2\n")
    script = f"""
import sys
import warnings
sys.modules["pandas"] = None
import kelpie
log = kelpie.read_log({str(tmp_path / "log.csv")!r})
assert type(log) is kelpie.LogArrays and log["u"].tolist() == [1.0, 2.0]
try:
    kelpie.read_log("log.csv", frame=True)
except ImportError as error:
    assert "pandas isn't installed" in str(error)
else:
    raise AssertionError("a frame without pandas")
"""
    subprocess.run([sys.executable, "-B", "-c", script], check=True)


def test_a_python_that_kelpie_is_not_for_is_told_so():
    def said(hidden):
        script = f"""
import importlib.util, sys
find = importlib.util.find_spec
importlib.util.find_spec = lambda name, package=None: None if name == {hidden!r} else find(name)
import kelpie
"""
        done = subprocess.run([sys.executable, "-B", "-c", script], text=True,
                              stderr=subprocess.PIPE)
        assert done.returncode == 1
        return done.stderr.splitlines()[-1]

    for hidden, what in (("numpy", "needs numpy"),
                         ("kelpie._kelpie", "needs its module for this Python")):
        words = said(hidden)
        assert words.startswith(f"ImportError: kelpie: {what}, and this Python, {sys.executable} ")
        assert "kelpie was built for cpython-3" in words and "/usr/bin/python3" in words


def test_a_recording_without_a_configuration_is_read_by_its_draft():
    file = real_log("logs/ros1_usv_sim.bag")
    log = kelpie.read_log(file, frame=False)
    assert log.attrs["inputs"] == ["u", "u_speed", "u_heading"]
    assert log.attrs["targets"] == ["udot"] and log.attrs["draft"]
    assert len(log["u"]) == 1001 and np.nanmax(log["u_speed"]) == pytest.approx(24.4, abs=0.1)


def test_a_recording_that_may_be_read_in_two_ways_is_refused():
    file = real_log("logs/moos_test.alog")
    with pytest.raises(ValueError, match="the signals to use are unclear"):
        kelpie.read_log(file)


def drive(rows=1500, step=0.2):
    """Five minutes of a vehicle in surge and yaw, whose accelerations are slopes of velocities."""
    random = np.random.default_rng(3)
    u, r, n, m = 0.0, 0.0, 0.0, 0.0
    found = []
    for _ in range(rows):
        n += (0.3 * random.normal() - n) * step
        m += (0.3 * random.normal() - m) * step
        udot, rdot = n - 0.3 * u, m - 0.3 * r
        found.append((u, r, n, m, udot, rdot))
        u, r = u + step * udot, r + step * rdot
    return np.array(found)


@pytest.mark.parametrize("mistake, rate, words", [
    (lambda f: f.assign(r=np.rad2deg(f.r)), None, "r is in degrees per second, rdot in rad/s²"),
    (lambda f: f.assign(udot=-f.udot), None, "udot has the sign opposite to the slope of u"),
    (lambda f: f.drop(columns="t"), 1.0, "times as many rows per second as said"),
])
def test_fit_warns_of_a_log_that_cannot_be_right(mistake, rate, words):
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame(drive(), columns=["u", "r", "n", "m", "udot", "rdot"])
    frame.insert(0, "t", 0.2 * np.arange(len(frame)))
    small = {"preset": "paper", "buffer": 20}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        kelpie.DynamicsModel(**small).fit(frame)
    with pytest.warns(kelpie.PlausibilityWarning, match=re.escape(words)):
        kelpie.DynamicsModel(**small, rate=rate).fit(mistake(frame))


def drive_of_known_parameters(seconds, step=0.01):
    """t, pose and commands of u' = n|n| - 0.5 u - 0.8 u|u| + v r, v' = -0.9 v - u r,
    r' = 0.6 m - 0.7 r, at 10 Hz."""
    random = np.random.default_rng(3)
    wishes = random.uniform(-1.0, 1.0, (int(seconds / 4.0) + 1, 2))
    u = v = r = x = y = psi = 0.0
    rows = []
    for k in range(int(seconds / step)):
        n, m = wishes[int(k * step / 4.0)]
        if k % round(0.1 / step) == 0:
            rows.append((k * step, x, y, psi, n, m))
        x += step * (u * np.cos(psi) - v * np.sin(psi))
        y += step * (u * np.sin(psi) + v * np.cos(psi))
        psi += step * r
        u, v, r = (u + step * (n * abs(n) - 0.5 * u - 0.8 * u * abs(u) + v * r),
                   v + step * (-0.9 * v - u * r), r + step * (0.6 * m - 0.7 * r))
    rows = np.array(rows)
    rows[:, 1:3] += 0.01 * random.standard_normal((len(rows), 2))
    return rows


def test_poses_are_learned_without_a_velocity_in_the_log(tmp_path):
    np.savetxt(tmp_path / "log.csv", drive_of_known_parameters(600.0), delimiter=",", comments="",
               header="t,x,y,psi,n,m")
    inputs = ["u", "v", "r", "n", "m"]
    log = kelpie.read_log(tmp_path / "log.csv", pose=["x", "y", "psi"], inputs=inputs, rate=5.0,
                          frame=False)
    assert log.attrs["targets"] == ["udot", "vdot", "rdot"]
    (tmp_path / "log.toml").write_text(
        "[log]\ntime = 't'\nrate = 5\npose = {x = 'x', y = 'y', yaw = 'psi'}\n"
        "commands = {n = 'n', m = 'm'}\n")
    same = kelpie.read_log(tmp_path / "log.csv", tmp_path / "log.toml", frame=False)
    for name in [*inputs, *log.attrs["targets"]]:
        assert np.array_equal(same[name], log[name], equal_nan=True), name
    X = np.column_stack([log[name] for name in inputs])
    Y = np.column_stack([log[name] for name in log.attrs["targets"]])
    whole = np.isfinite(X).all(axis=1) & np.isfinite(Y).all(axis=1)
    X, Y = X[whole], Y[whole]
    # The yaw equation is linear and holds for the means of a window.
    found = np.linalg.lstsq(X[:, [4, 2]], Y[:, 2], rcond=None)[0]
    assert found == pytest.approx([0.6, -0.7], rel=0.05)
    first = slice(0, 2000)
    model = kelpie.DynamicsModel(inputs=inputs, rate=5.0, buffer=100)
    model.fit(X[first], Y[first])
    left = Y[2000:] - model.predict(X[2000:])
    r2 = 1.0 - (left**2).sum(axis=0) / ((Y[2000:] - Y[2000:].mean(axis=0))**2).sum(axis=0)
    assert r2.min() > 0.8, r2


def test_poses_that_cannot_be_are_named(tmp_path):
    np.savetxt(tmp_path / "log.csv", drive_of_known_parameters(20.0), delimiter=",", comments="",
               header="t,x,y,psi,n,m")
    with pytest.raises(ValueError, match="x and y belong together"):
        kelpie.read_log(tmp_path / "log.csv", pose=["x", "psi"], inputs=["u", "n", "m"])
    with pytest.raises(ValueError, match="neither config nor columns"):
        kelpie.read_log(tmp_path / "log.csv", tmp_path / "log.toml", pose=["x"])
