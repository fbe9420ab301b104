#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures what each mechanism earns: the open benchmark by kelpie without the mechanism.

    lab/without.py data/public.toml data/simulated.toml --out out/without

A copy of the checkout (the last commit) in OUT/tree is built as it stands, then once for each row
of MECHANISMS, with one place of the source replaced. Prints a table and writes without.json. Wants
what the Python package wants (docs/howto/install.md). `--check` only tells whether each place
still stands in the source.
"""
import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

CHECKOUT = Path(__file__).resolve().parent.parent
DEFAULTS = "settings.axes.assign(axes, OnlineSvrSettings{});"


def without_member(member):
    text = "shares_[k] = std::exp(shares_[k] - most);"
    return ("learner/member_shares.cpp", text, text.replace("std", f"k == {member} ? 0.0 : std"))


def with_setting(setting):
    return ("model/settings.cpp", DEFAULTS, DEFAULTS.replace("{}", f"{{{setting}}}"))


# Name: file below src/library, the text there, the text in its place.
MECHANISMS = {
    "member learner": without_member(0),
    "member precise": without_member(1),
    "member memory": without_member(2),
    "member physics": without_member(3),
    "member line": without_member(4),
    "shares by errors": ("learner/member_shares.cpp",
                         "rate * losses_.of[k]", "0.0 * losses_.of[k]"),
    "calibration slope": ("learner/member_shares.cpp",
                          "slope_ = losses_.calibration.value();", "slope_ = 1.0;"),
    "limits of predictions": ("learner/committee.cpp", "return {.low = low,\n          .high = high,",
                              "return {.low = std::min(low, -1e9), .high = std::max(high, 1e9),"),
    "ranges of terms": ("learner/tuning.hpp", "term_margin = 0.5;", "term_margin = 1e9;"),
    "prior in units of noise": ("learner/sparse_regression.cpp",
                                "std::min(settings_.term_prior, noise", "std::max(1.0, 0.0 * noise"),
    "caution": ("learner/committee.cpp", "outgrown ? 0.0 : kOnline.members.caution",
                "outgrown ? 0.0 : 0.0"),
    "fine part of the kernel": with_setting(".fine = 0.0"),
    "outliers of the learner": with_setting(".outlier = OutlierRule::none"),
    "robust members": ("learner/sparse_regression.cpp",
                       "return share * share;", "return share > 0.0 ? 1.0 : share;"),
    "independent samples": ("learner/error_correlation.cpp",
                            "rows_per_sample_ = (1.0 + next) / (1.0 - next);",
                            "rows_per_sample_ = next > 2.0 ? next : 1.0;"),
    "alarms of an axis": ("learner/change_detector.cpp",
                          "if (!std::isfinite(misfit) ||", "if (misfit < 1e300 ||"),
    "second round of relearning": ("learner/committee.cpp",
                                   "relearn_buffer(kOnline.members.rounds);", "relearn_buffer(1);"),
    "precise's past as a prior": ("learner/committee.cpp",
                                  "fits_->precise.weaken();", "fits_->precise.clear();"),
    "past models": with_setting(".memory = 0"),
    "monitor of changes": ("model/dynamics_model.cpp", "if (adapts(settings) && !states.empty()",
                           "if (false && adapts(settings) && !states.empty()"),
    "one command by its scale": ("model/change_monitor.cpp",
                                 "gained_ = clear_command(start).value_or(commands_);",
                                 "gained_ = commands_;"),
    "changes that the diagnosis names": ("model/dynamics_model.cpp",
                                         "if (change) {\n    believe_diagnosis();",
                                         "if (false) {\n    believe_diagnosis();"),
    "guard against garbage": ("model/guarded_axis.cpp",
                              "  const bool implausible = trusted().scaling() != nullptr && ",
                              "  const bool implausible = false && "),
    "expected targets": ("model/guarded_axis.cpp", "return implausible ? !expected(x, y) :",
                         "return implausible ? true :"),
    "changes beside constant errors": ("model/change_monitor.cpp",
                                       "(start.over_constant > kChange.over_constant &&",
                                       "(start.over_constant >= 0.0 &&"),
    "errors by the size of effects": ("model/errors_by_effect.cpp",
                                      "const std::size_t last = octave(effect);",
                                      "const std::size_t last = 0 * octave(effect);"),
}


def misplaced(source):
    """The mechanisms whose place does not stand in its file exactly once."""
    texts = {name: (source / name).read_text(encoding="utf-8")
             for name, _, _ in MECHANISMS.values()}
    return [mechanism for mechanism, (name, text, _) in MECHANISMS.items()
            if texts[name].count(text) != 1]


def make_tree(tree):
    """The last commit, configured for the Python package alone; files that stay are not touched."""
    def git(folder, *words):
        return subprocess.run(["git", "-C", folder, *words], check=True, stdout=subprocess.PIPE,
                              text=True).stdout.strip()

    if not (tree / ".git").exists():
        subprocess.run(["git", "clone", "-q", "--no-checkout", CHECKOUT, tree], check=True)
    git(tree, "fetch", "-q")
    git(tree, "checkout", "-q", "--force", "--detach", git(CHECKOUT, "rev-parse", "HEAD"))
    subprocess.run(["cmake", "--preset", "minimal", "-DKELPIE_BUILD_PYTHON=ON",
                    "-DKELPIE_JOIN_SOURCES=OFF"], cwd=tree, check=True, stdout=subprocess.DEVNULL)


def build(tree):
    subprocess.run(["cmake", "--build", "--preset", "minimal", "--target", "kelpie_python"],
                   cwd=tree, check=True, stdout=subprocess.DEVNULL)


def benchmark(tree, options, out):
    """R² by data set and figure."""
    command = [sys.executable, "-m", "kelpie.benchmark", "run", *options.manifest, "--only",
               "kelpie", "--rows", str(options.rows), "--tracks", "anytime,changes,hostile",
               "--jobs", str(options.jobs), "--out", out]
    command += ["--data", options.data] if options.data else []
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL,
                   env={**os.environ, "PYTHONPATH": str(tree / "build/minimal/python")})
    results = json.loads((out / "benchmark.json").read_text(encoding="utf-8"))["results"]
    found = {}
    for result in results:
        if result["entry"] == "kelpie":
            anytime = result["anytime"]
            figures = {"stream": anytime["area"], "end": anytime["final"]}
            figures |= {track: result[track]["mean"] for track in ("changes", "hostile")
                        if result.get(track)}
            found[result["data"]] = figures
    return found


def measure(options):
    tree = options.out / "tree"
    make_tree(tree)
    build(tree)
    found = {"": benchmark(tree, options, options.out / "whole")}
    for mechanism in options.only or MECHANISMS:
        print(mechanism, file=sys.stderr, flush=True)
        name, text, instead = MECHANISMS[mechanism]
        source = tree / "src/library" / name
        whole = source.read_text(encoding="utf-8")
        source.write_text(whole.replace(text, instead), encoding="utf-8")
        try:
            build(tree)
            found[mechanism] = benchmark(tree, options, options.out / mechanism.replace(" ", "_"))
        finally:
            source.write_text(whole, encoding="utf-8")
    return found


def table(found):
    """What each mechanism earns in R²: the mean over data sets, the least and the most."""
    whole = found[""]
    figures = ["stream", "end", "changes", "hostile"]
    lines = [f"{'without':34s}" + "".join(f"{figure:>28s}" for figure in figures),
             " " * 34 + "".join(f"{'mean    least     most':>28s}" for _ in figures)]
    for mechanism, results in list(found.items())[1:]:
        line = f"{mechanism:34s}"
        for figure in figures:
            earned = [whole[data][figure] - here[figure] for data, here in results.items()
                      if figure in here]
            line += (f"{sum(earned) / len(earned):+12.4f}{min(earned):+8.3f}{max(earned):+8.3f}"
                     if earned else f"{'–':>28s}")
        lines.append(line)
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("manifest", nargs="*", type=Path, help="of the benchmark's data")
    parser.add_argument("--out", type=Path, default=Path("out/without"), help="(%(default)s)")
    parser.add_argument("--data", metavar="NAMES", help="data sets, separated by commas; else all")
    parser.add_argument("--rows", type=int, default=2000, help="of each data set (%(default)s)")
    parser.add_argument("--jobs", type=int, default=1, help="processes at a time (%(default)s)")
    parser.add_argument("--only", action="append", choices=MECHANISMS, metavar="MECHANISM")
    parser.add_argument("--check", action="store_true", help="only look for the places")
    options = parser.parse_args()
    wrong = misplaced(CHECKOUT / "src/library")
    for mechanism in wrong:
        print(f"without.py: '{mechanism}': {MECHANISMS[mechanism][0]} does not have its text once",
              file=sys.stderr)
    if wrong or options.check:
        return 2 if wrong else 0
    if not options.manifest:
        parser.error("a manifest is wanted (python/kelpie/benchmark/README.md)")
    options.out = options.out.resolve()
    options.manifest = [path.resolve() for path in options.manifest]
    found = measure(options)
    (options.out / "without.json").write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    print(table(found))
    return 0


if __name__ == "__main__":
    sys.exit(main())
