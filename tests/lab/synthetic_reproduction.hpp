// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lab/reproduction.hpp"
#include "report/synthetic.hpp"

namespace kelpie::synthetic {

/// The numbers a made-up reproduction is made of; the defaults make every claim of the paper hold.
struct Made {
  double own = 0.98;    ///< R² of a baseline at home
  double abroad = 0.6;  ///< and abroad
  double paper = 0.97;  ///< at the end of every configuration
  double kelpie = 0.97;
  double after_switch = 0.7;  ///< right after a switch
  double sosvr = 0.93;
  double fifo_jitter = 0.05;  ///< up and down by half of that
  double paper_jitter = 0.01;
  double table = 0.97;          ///< with the values of Table I
  std::int64_t forgotten = 10;  ///< samples, from the first look on
};

inline study::AxisResult made_axis(const std::string& name, double end, double after_switch,
                                   double jitter, std::int64_t forgotten) {
  constexpr std::size_t kStage = 4000;
  study::AxisResult axis;
  axis.name = name;
  for (std::size_t n = 200; n <= 2 * kStage; n += 200) {
    const std::size_t in_stage = (n - 1) % kStage + 1;
    const double up_or_down = n / 200 % 2 == 0 ? 0.5 * jitter : -0.5 * jitter;
    const double r2 = in_stage < 1000 ? after_switch : end + up_or_down;
    Status status = status_after(n);
    status.tally.forgotten = forgotten;
    axis.validation.push_back({n, static_cast<double>(n), r2, n > kStage ? 1 : 0, status});
    axis.update_us.push_back(20.0);
  }
  for (const int configuration : {0, 1}) {
    study::StageEnd stage{
        configuration, kStage * static_cast<std::size_t>(configuration + 1), end, {}, {}, {}};
    for (int row = 0; row < 40; ++row) {
      stage.time_s.push_back(1.0 * row);
      stage.truth.push_back(std::sin(0.2 * row));
      stage.predicted.push_back(std::sin(0.2 * row) + 0.01);
    }
    axis.stages.push_back(stage);
  }
  axis.r2_final = end;
  axis.status = axis.validation.back().status;
  return axis;
}

inline lab::StreamStudy study(const Made& made, const std::string& key, study::SplitKind kind) {
  lab::StreamStudy study;
  study.key = key;
  study.simulated = key != "real";
  study.source = "scenarios/paper.toml";
  study.split =
      kind == study::SplitKind::random ? "random 20 % of the rows held out" : "blocks of 400 rows";
  study.split_kind = kind;
  study.rate_hz = 1.0;
  study.training_rows = 8000;
  study.held_out_rows = 2000;
  study.configurations = {0, 1};
  study.axes = {"udot", "vdot"};
  const auto add = [&](const std::string& name, lab::RowKind part, double end, double jitter) {
    lab::RowRuns runs{name, part, "the " + name, "gamma=0.1"};
    for (int seed = 0; seed < 2; ++seed) {
      runs.seeds.push_back({{made_axis("udot", end, made.after_switch, jitter, made.forgotten),
                             made_axis("vdot", end, made.after_switch, jitter, made.forgotten)},
                            {}});
    }
    study.rows.push_back(std::move(runs));
  };
  using enum lab::RowKind;
  add("paper", paper, made.paper, made.paper_jitter);
  add("paper_readable", paper, made.table, 0.0);
  add("paper_printed", paper, made.table, 0.0);
  add("fifo", baseline, made.paper, made.fifo_jitter);
  add("sosvr", baseline, made.sosvr, 0.0);
  add("default", kelpie, made.kelpie, made.paper_jitter);
  add("paper_small", paper, made.paper, made.paper_jitter);
  add("fifo_small", baseline, made.paper, made.fifo_jitter);
  for (const std::string& axis : study.axes) {
    study.offline.push_back({axis,
                             {{0, {}, made.own, 4000, {made.own, made.abroad}},
                              {1, {}, made.own, 4000, {made.abroad, made.own}}}});
  }
  study.offline_terms = study.offline;
  study.found.assign(lab::searched_families().size(),
                     std::vector<lab::FoundSettings>(2, {{{"gamma", "0.03"}}, 0.9, 3}));
  return study;
}

inline lab::Reproduction reproduction(const Made& made = {}) {
  lab::Reproduction result;
  result.plan = lab::full_plan();
  for (const study::SplitKind kind : {study::SplitKind::random, study::SplitKind::blocks}) {
    result.studies.push_back(study(made, "simulation", kind));
  }
  return result;
}

}  // namespace kelpie::synthetic
