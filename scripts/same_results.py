#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Shows whether two builds of kelpie compute the same numbers, to the last bit.

Usage, after a release build of each commit, with the Python that kelpie's module was built for:
  scripts/same_results.py record BUILD_FOLDER OUT_FOLDER [PART]
                          learns every log at hand with one build; PART: only names that contain PART;
                          exit code 1 where a command fails
  scripts/same_results.py compare OUT_FOLDER OTHER_FOLDER
                          lists the numbers that differ; exit code 1 where some do
Logs: $KELPIE_DATA_DIR, else ../shared/data beside the checkout; simulated logs where both lack.
Compared are result.json and model.json of `kelpie learn`, the files of `identify`, `rollout` and
`live`, predictions of the Python class, and what the C++ and C examples print. Not compared: times,
memory, paths and the version.
"""

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DATA = Path(os.environ.get("KELPIE_DATA_DIR") or ROOT.parent / "shared/data")
VOLATILE = re.compile(r"second|_us\b|duration|memory_bytes|version|path|created|^file$|^state$")

DAGON = ["--rate", "4"]
PLANAR = ["--targets", "udot,vdot,rdot", "--time", "t"]
HOVER = ["--time", "t", "--inputs", "u,v,r,m1,m2,m3,m4,m5,m6", "--targets", "du,dv,dr"]
PLANTS = {
    "otter": ("u,v,r,n1,n2", "udot,vdot,rdot"),
    "supply": ("u,v,r,n1,n2,n3,n4,n5,n6", "udot,vdot,rdot"),
    "tanker": ("u,v,r,delta,n", "udot,vdot,rdot"),
    "remus100": ("u,v,w,p,q,r,dr,ds,n", "udot,vdot,wdot,pdot,qdot,rdot"),
    "dsrv": ("w,q,delta", "wdot,qdot"),
}


def learning_cases():
    """Names, logs and options of `kelpie learn`."""
    dagon = DATA / "dagon_config1.csv"
    for split in ("blocks", "random", "tail"):
        yield f"dagon_{split}", dagon, [*DAGON, "--split", split]
    yield "dagon_svr", dagon, [*DAGON, "--set", "learner=svr"]
    yield "dagon_paper", dagon, [*DAGON, "--set", "preset=paper", "--align", "none"]
    yield "dagon_memory", dagon, [*DAGON, "--memory", "{out}/past.json"]
    vehicles = DATA / "vehicles"
    thrusters = ",".join(f"fx{i},fy{i}" for i in range(1, 5))
    yield "ship", vehicles / "ship_kvlcc2_hsva.csv", [*PLANAR, "--inputs", "u,v,r,delta"]
    yield "ferry", vehicles / "ferry_nlp1.csv", [*PLANAR, "--inputs", f"u,v,r,{thrusters}"]
    yield "kingfisher", vehicles / "kingfisher_5hz.csv", [
        "--time", "t", "--inputs", "u,v,w,r,fx,fy,fz,tz", "--targets", "udot,vdot,wdot,rdot"]
    yield "haizhe", vehicles / "haizhe_faults.csv", [
        "--time", "t", "--inputs", "w,roll,pitch,p,q,r,pwm,voltage",
        "--targets", "wdot,pdot,qdot,rdot", "--configuration", "condition"]
    for log in sorted((DATA / "holohover").glob("*.csv")):
        yield "holohover_" + log.stem.split("_")[-1], log, HOVER
    for log in sorted((DATA / "peer_streams").glob("*.csv")):
        yield "peer_" + log.stem, log, ["--rate", "1"]
    for log in sorted((DATA / "plants").glob("*.csv.gz")):
        inputs, targets = PLANTS[log.name.split("_")[0].removesuffix("lawn")]
        yield "plant_" + log.name[:-7], log, [
            "--time", "t", "--inputs", inputs, "--targets", targets, "--split", "column:held",
            "--configuration", "conf"]
    yield "flatfish", DATA / "flatfish_bag", [
        "--config", str(ROOT / "examples/flatfish.toml"), "--split", "tail"]
    for scenario in ("small", "aba"):
        yield f"simulated_{scenario}", Path(f"{{simulated}}/{scenario}.csv"), []


def live_configuration(out):
    """examples/flatfish.toml for a live run: lags in seconds in place of "auto"."""
    folder = out / "live_configuration"
    shutil.copytree(ROOT / "examples/msg", folder / "msg", dirs_exist_ok=True)
    text = (ROOT / "examples/flatfish.toml").read_text(encoding="utf-8")
    file = folder / "live.toml"
    file.write_text(text.replace('"auto"', "0.1").replace('"centred"', '"causal"'), encoding="utf-8")
    return file


def other_commands(kelpie, out):
    """Names and words of commands beside `learn`."""
    dagon, bag = DATA / "dagon_config1.csv", DATA / "flatfish_bag"
    if dagon.exists():
        yield "identify", [kelpie, "identify", dagon, *DAGON, "--out", out / "identify"]
        yield "rollout", [kelpie, "rollout", dagon, *DAGON, "--model",
                          out / "dagon_blocks/model.json", "--out", out / "rollout"]
        yield "compare", [kelpie, "compare", dagon, *DAGON, "--out", out / "compare"]
    if bag.exists():
        yield "live", [kelpie, "live", "--config", live_configuration(out), "--replay", bag,
                       "--speed", "max", "--out", out / "live"]


def python_predictions(build, log):
    """Hash of what the Python class predicts of every block of rows before it learns the block."""
    sys.path.insert(0, str(build / "python"))
    import numpy as np  # pylint: disable=import-outside-toplevel

    import kelpie  # pylint: disable=import-outside-toplevel

    rows = np.genfromtxt(log, delimiter=",", skip_header=1)[:4000]
    model = kelpie.DynamicsModel(inputs=["u", "v", "r", "th1", "th2", "th3"],
                                 targets=["udot", "vdot", "rdot"], rate=4.0)
    said = []
    for k in range(0, len(rows), 200):
        part = rows[k : k + 200]
        if k:
            said.append(model.predict(part[:, :6]))
        model.partial_fit(part[:, :6], part[:, 6:9])
    return hashlib.sha256(np.concatenate(said).tobytes()).hexdigest()


def run(words, log, failed):
    """Runs a command; notes one that fails in the list `failed`."""
    words = [str(word) for word in words]
    done = subprocess.run(words, capture_output=True, text=True, errors="replace", check=False)
    log.write(f"{' '.join(words)}\n-> {done.returncode} {done.stderr[-500:]}\n")
    print(f"exit code {done.returncode}: {' '.join(words[1:3])}", flush=True)
    if done.returncode != 0:
        failed.append(" ".join(words))
    return done


def record(build, out, part):
    kelpie = build / "kelpie"
    failed = []
    (out / "simulated").mkdir(parents=True, exist_ok=True)
    with open(out / "commands.log", "w", encoding="utf-8") as log:
        for scenario in ("small", "aba"):
            run([kelpie, "simulate", ROOT / f"scenarios/{scenario}.toml", "--out",
                 out / f"simulated/{scenario}.csv"], log, failed)
        for name, source, options in learning_cases():
            source = Path(str(source).format(simulated=out / "simulated"))
            if part not in name or not source.exists():
                continue
            folder = out / name
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir()
            words = [str(option).format(out=folder) for option in options]
            run([kelpie, "learn", source, *words, "--out", folder], log, failed)
        for name, words in other_commands(kelpie, out):
            if part in name:
                shutil.rmtree(out / name, ignore_errors=True)
                run(words, log, failed)
        if part in "programs":
            (out / "programs.json").write_text(json.dumps(programs(build, log, failed),
                                                          indent=1), encoding="utf-8")
    for words in failed:
        print(f"failed: {words}", file=sys.stderr)
    return 1 if failed else 0


def programs(build, log, failed):
    """What the Python class and the examples say."""
    said = {}
    if (DATA / "dagon_config1.csv").exists():
        said["python"] = python_predictions(build, DATA / "dagon_config1.csv")
    for name in ("01_learner", "02_vehicle_model", "07_in_c", "08_messages"):
        program = build / "examples" / name
        if program.exists():
            said[name] = run([program], log, failed).stdout
    return said


def differences(a, b, where=""):
    """Places where two JSON values differ, without those that may."""
    if isinstance(a, dict) and isinstance(b, dict):
        for key in sorted(a.keys() | b.keys()):
            if not VOLATILE.search(key):
                yield from differences(a.get(key), b.get(key), f"{where}.{key}")
    elif isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
        for k, (x, y) in enumerate(zip(a, b)):
            yield from differences(x, y, f"{where}[{k}]")
    elif a != b and not are_paths_of_one_file(a, b):
        yield f"{where}: {str(a)[:60]} / {str(b)[:60]}"


def are_paths_of_one_file(a, b):
    return all(isinstance(x, str) and x.startswith("/") for x in (a, b)) and (
        Path(a).name == Path(b).name)


def compare(one, other):
    files = {path.relative_to(folder) for folder in (one, other) for path in folder.rglob("*.json")}
    differing = 0
    for file in sorted(files):
        if not ((one / file).exists() and (other / file).exists()):
            found = ["it is in one folder alone"]
        else:
            texts = [(folder / file).read_text(encoding="utf-8") for folder in (one, other)]
            found = list(differences(*map(json.loads, texts)))
        differing += bool(found)
        for line in found[:5]:
            print(f"{file}{line if line.startswith(('.', '[')) else ': ' + line}")
        if len(found) > 5:
            print(f"{file}: {len(found)} differences in all")
    print(f"{len(files)} files, {differing} with a difference")
    return 1 if differing else 0


def main():
    words = sys.argv[1:]
    if len(words) not in (3, 4) or words[0] not in ("record", "compare"):
        print(__doc__, file=sys.stderr)
        return 2
    folders = [Path(word).resolve() for word in words[1:3]]
    if words[0] == "record":
        return record(*folders, "".join(words[3:]))
    return compare(*folders)


if __name__ == "__main__":
    sys.exit(main())
