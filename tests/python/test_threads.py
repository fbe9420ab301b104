# SPDX-License-Identifier: Apache-2.0
"""Arrays aren't copied, other threads run meanwhile, Ctrl-C is heard."""

import os
import pickle
import signal
import subprocess
import sys
import threading
import tracemalloc

import numpy as np
from conftest import SMALL

import kelpie
from kelpie import _arrays


def test_arrays_as_wanted_are_not_copied(log):
    assert _arrays.matrix(log.X) is log.X
    assert _arrays.floats(log.y, "y") is log.y
    model = kelpie.OnlineSVR(buffer=2, anchors=1, warmup=2, terms="none")
    model.fit(log.X, log.y[:, 0])
    many = np.tile(log.X, (500, 1))
    readonly = many.view()
    readonly.flags.writeable = False
    tracemalloc.start()
    model.predict(readonly)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    results = len(many) * 8
    finite = many.size  # a byte each, of the look for NaN
    assert results <= peak < results + finite + 100_000 < many.nbytes


def test_other_threads_run_while_one_learns(log):
    X, y = np.tile(log.X, (5, 1)), np.tile(log.y, (5, 1))
    model = kelpie.DynamicsModel(**SMALL).fit(X[:600], y[:600])
    done = threading.Event()
    failures = []

    def watch():
        while not done.is_set():
            if not np.isfinite(model.predict(log.X[:5])).all():
                failures.append("a prediction isn't finite")
            model.status_, model.coef_, model.__getstate__()

    def learn():
        model._model.update(X, y, 1e6 + np.arange(len(X), dtype=float))

    watcher = threading.Thread(target=watch)
    learners = [threading.Thread(target=learn) for _ in range(2)]
    for thread in (watcher, *learners):
        thread.start()
    turns = 0
    while any(thread.is_alive() for thread in learners):
        turns += 1  # would be one or two if learning held the GIL
        learners[0].join(0.001)
        learners[1].join(0.001)
    done.set()
    watcher.join()
    assert not failures
    assert turns > 10
    assert model.n_samples_seen_ == 600 + 2 * len(X)


def test_a_forked_child_refuses_what_another_thread_was_at(log):
    X, y = np.tile(log.X, (50, 1)), np.tile(log.y, (50, 1))
    model = kelpie.DynamicsModel(**SMALL).fit(log.X, log.y)
    stop = threading.Event()

    def learn():
        begin = 1e6
        while not stop.is_set():
            begin += len(X)
            model._model.update(X, y, begin + np.arange(len(X), dtype=float))

    def in_child(call):
        child = os.fork()
        if child == 0:
            signal.alarm(30)  # ends a child that waits
            try:
                call()
                os._exit(0)
            except RuntimeError as error:
                os._exit(3 if "spawn" in str(error) else 4)
            finally:
                os._exit(5)
        return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])

    learner = threading.Thread(target=learn)
    learner.start()
    try:
        calls = [lambda: model.predict(log.X), lambda: model.status_, lambda: pickle.dumps(model),
                 lambda: model.partial_fit(log.X, log.y)]
        codes = [in_child(call) for call in 2 * calls]
        # A model of its own is whole, wherever it was made.
        assert in_child(lambda: kelpie.DynamicsModel(**SMALL).fit(log.X, log.y)) == 0
    finally:
        stop.set()
        learner.join()
    assert set(codes) <= {0, 3} and 3 in codes, codes  # 0: between two turns of the learner
    assert [in_child(call) for call in calls] == [0, 0, 0, 0]


def test_ctrl_c_ends_a_report(tmp_path):
    script = f"""
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)
sys.path.insert(0, {str(__file__.rsplit("/", 1)[0])!r})
import numpy as np
import kelpie
from conftest import INPUTS, TARGETS, drive
log = drive(600)
rows = np.tile(np.column_stack([log.X, log.y]), (200, 1))
table = dict(zip([*INPUTS, *TARGETS], rows.T))
try:
    print("go", flush=True)
    kelpie.report(table, rate=10.0, align="none", accept="implausible")
except KeyboardInterrupt:
    print("stopped", flush=True)
"""
    with subprocess.Popen([sys.executable, "-B", "-c", script], stdout=subprocess.PIPE,
                          text=True, env={**os.environ, "TMPDIR": str(tmp_path)}) as process:
        assert process.stdout.readline() == "go\n"
        timer = threading.Timer(5.0, process.send_signal, [signal.SIGINT])
        timer.start()
        out, _ = process.communicate(timeout=120)
    assert out == "stopped\n"


def test_ctrl_c_ends_a_long_fit():
    script = f"""
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background ignores it
sys.path.insert(0, {str(__file__.rsplit("/", 1)[0])!r})
import numpy as np
import kelpie
from conftest import SMALL, drive
log = drive(600)
X, y = np.tile(log.X, (2000, 1)), np.tile(log.y, (2000, 1))
model = kelpie.DynamicsModel(**SMALL).fit(X[:600], y[:600])
try:
    print("go", flush=True)
    model.partial_fit(X, y)
except KeyboardInterrupt:
    seen = model.n_samples_seen_
    assert 600 <= seen < 600 + len(X)
    model.partial_fit(X[seen:seen + 5], y[seen:seen + 5])
    assert model.n_samples_seen_ == seen + 5
    print("stopped", flush=True)
"""
    with subprocess.Popen([sys.executable, "-B", "-c", script], stdout=subprocess.PIPE,
                          text=True) as process:
        assert process.stdout.readline() == "go\n"
        timer = threading.Timer(0.5, process.send_signal, [signal.SIGINT])
        timer.start()
        out, _ = process.communicate(timeout=60)
    assert out == "stopped\n"
