// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cli/output.hpp"
#include "core/quantile.hpp"
#include "core/text.hpp"
#include "file/atomic_file.hpp"
#include "format/settings_file.hpp"
#include "jobs/run_all.hpp"
#include "kelpie/learner/recursive_least_squares.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/motion/term_set.hpp"
#include "lab/commands.hpp"
#include "lab/hostile_streams.hpp"
#include "lab/json_table.hpp"
#include "model/axis_list.hpp"
#include "study/baselines.hpp"
#include "study/metrics.hpp"

namespace kelpie::lab {
namespace {

using Eigen::Index;
using file::Json;

// The last block of every five is held out; held-out samples after 70 % of the stream are scored.
constexpr Index kBlock = 50;
constexpr Index kHeldOutOf = 5;
constexpr Index kLateFrom = 7 * kHostileSamples / 10;
constexpr double kMargin = 0.1;         // of the range of targets, around the range
constexpr Eigen::Index kFewRows = 100;  // of the stream, whose margin is the whole range
constexpr double kHuber = 3.0;          // usual errors that least squares believes
constexpr double kForget = 0.998;       // memory of 500 samples
constexpr double kMostBehind = 0.03;    // R², wanted: behind the best yardstick, and of every axis
constexpr double kLeastR2 = -0.3;

constexpr std::array kLearners{"kelpie", "least_squares", "forgetting", "mean"};

struct HostileArguments {
  std::vector<std::string> kinds;
  std::size_t seeds = 3;
  std::uint64_t seed = 1;
  std::size_t threads = 0;
  std::vector<std::string> set;
  std::string json;
};

// One stream or several.
struct HostileRun {
  // By seed and axis; −∞ where not finite.
  std::array<std::vector<double>, kLearners.size()> late_r2;
  // Of kelpie: samples with a prediction beyond the targets so far and the true one; with a
  // prediction that is not finite; reported changes of the vehicle, of all axes.
  std::int64_t beyond = 0;
  std::int64_t not_finite = 0;
  std::int64_t changes = 0;

  void join(const HostileRun& other) {
    for (std::size_t i = 0; i < late_r2.size(); ++i) {
      late_r2[i].insert(late_r2[i].end(), other.late_r2[i].begin(), other.late_r2[i].end());
    }
    beyond += other.beyond;
    not_finite += other.not_finite;
    changes += other.changes;
  }
  double median(std::size_t learner) const {
    std::vector<double> values = late_r2[learner];
    return quantile(values, 0.5);
  }
  // NaN where kelpie has no finite median.
  double behind() const {
    return std::fmax(std::fmax(median(1), median(2)), median(3)) - median(0);
  }
};

bool held_out(Index sample) {
  return sample / kBlock % kHeldOutOf == kHeldOutOf - 1;
}

std::span<const double> inputs_at(const HostileStream& stream, Index sample) {
  return {stream.x.col(sample).data(), stream.inputs.size()};
}

std::unique_ptr<OnlineModel> each_axis(const HostileStream& stream,
                                       const study::LearnerFactory& make) {
  std::vector<std::unique_ptr<OnlineRegressor>> axes(stream.targets.size());
  std::ranges::generate(axes, make);
  return std::make_unique<AxisList>(std::move(axes));
}

// Least squares on targets within some usual errors of the prediction. The usual error moves by a
// hundredth per sample, so that a burst of outliers stays unusual.
class ClippedLeastSquares final : public OnlineRegressor {
 public:
  ClippedLeastSquares(const HostileStream& stream, double lambda)
      : fit_(stream.inputs.size(), TermSet::baseline(stream.inputs, stream.velocities),
             {.lambda = lambda}) {}

  Decision update(std::span<const double> x, double y, double t) override {
    const double predicted = predict(x);
    const double error = y - predicted;
    if (first_.size() < kFirst) {
      first_.push_back(std::abs(y));
      usual_ = quantile(first_, 0.5);
      return fit_.update(x, y, t);
    }
    const double clipped = std::clamp(error, -kHuber * usual_, kHuber * usual_);
    usual_ += 0.01 * (std::min(std::abs(error), 5.0 * usual_) - usual_);
    return fit_.update(x, predicted + clipped, t);
  }
  double predict(std::span<const double> x) const override { return fit_.predict(x); }
  Status status() const override { return fit_.status(); }

 private:
  static constexpr std::size_t kFirst = 30;  // samples that give the first usual error

  RecursiveLeastSquares fit_;
  std::vector<double> first_;
  double usual_ = 0.0;
};

std::unique_ptr<OnlineModel> least_squares(const HostileStream& stream, double lambda) {
  return each_axis(stream, [&] { return std::make_unique<ClippedLeastSquares>(stream, lambda); });
}

void teach(OnlineModel& model, const HostileStream& stream, HostileRun& run) {
  Eigen::ArrayXd least = stream.y.col(0);
  Eigen::ArrayXd greatest = least;
  Eigen::ArrayXd predicted(stream.y.rows());
  for (Index i = 0; i < kHostileSamples; ++i) {
    const std::span<const double> x = inputs_at(stream, i);
    if (!held_out(i)) {
      model.update(x, {stream.y.col(i).data(), stream.targets.size()}, stream.times_s[i]);
    }
    for (std::size_t axis = 0; axis < model.axes(); ++axis) {
      predicted[static_cast<Index>(axis)] =
          held_out(i) ? model.axis(axis).predict(x) : model.decisions()[axis].prediction.value;
    }
    // Few targets tell little about the range (SeenRange).
    const Eigen::ArrayXd margin = (i < kFewRows ? 1.0 : kMargin) * (greatest - least);
    run.not_finite += predicted.allFinite() ? 0 : 1;
    const Eigen::ArrayXd low = least.min(stream.y.col(i).array()) - margin;
    const Eigen::ArrayXd high = greatest.max(stream.y.col(i).array()) + margin;
    run.beyond += i > 0 && (predicted < low || predicted > high).any() ? 1 : 0;
    if (!held_out(i)) {
      least = least.min(stream.y.col(i));
      greatest = greatest.max(stream.y.col(i));
    }
  }
  model.learn_held_back();
  for (std::size_t axis = 0; axis < model.axes(); ++axis) {
    run.changes += model.axis(axis).status().tally.changes;
  }
}

std::vector<double> late_r2(const OnlineModel& model, const HostileStream& stream) {
  std::vector<double> scores;
  for (std::size_t axis = 0; axis < model.axes(); ++axis) {
    std::vector<double> truth;
    std::vector<double> predicted;
    for (Index i = kLateFrom; i < kHostileSamples; ++i) {
      if (held_out(i) && !stream.hidden[static_cast<std::size_t>(i)]) {
        truth.push_back(stream.truth(static_cast<Index>(axis), i));
        predicted.push_back(model.axis(axis).predict(inputs_at(stream, i)));
      }
    }
    const double r2 = study::r_squared(truth, predicted);
    scores.push_back(std::isfinite(r2) ? r2 : -std::numeric_limits<double>::infinity());
  }
  return scores;
}

HostileRun run_stream(const HostileStream& stream, const std::vector<std::string>& set) {
  DynamicsModel kelpie(stream.inputs, stream.targets,
                       format::make_settings({}, set, stream.targets.size()));
  HostileRun run;
  teach(kelpie, stream, run);
  run.late_r2[0] = late_r2(kelpie, stream);
  const std::array yardsticks{least_squares(stream, 1.0), least_squares(stream, kForget),
                              each_axis(stream, study::mean_of_one_axis())};
  for (std::size_t i = 0; i < yardsticks.size(); ++i) {
    HostileRun ignored;
    teach(*yardsticks[i], stream, ignored);
    run.late_r2[i + 1] = late_r2(*yardsticks[i], stream);
  }
  return run;
}

// By kind, then by seed.
std::vector<HostileRun> run_streams(const std::vector<HostileKind>& kinds,
                                    const HostileArguments& options,
                                    const std::function<bool(double)>& keep_going) {
  std::vector<HostileRun> runs(kinds.size() * options.seeds);
  jobs::run_while(keep_going, runs.size(), options.threads, [&](std::size_t job) {
    runs[job] = run_stream(kinds[job / options.seeds].stream(options.seed + job % options.seeds),
                           options.set);
  });
  return runs;
}

Json run_json(const HostileRun& run) {
  return {{"beyond", run.beyond}, {"not_finite", run.not_finite}, {"changes", run.changes}};
}

Json kind_json(const HostileKind& kind, const HostileRun& run) {
  Json json = run_json(run);
  json["name"] = kind.name;
  json["meaning"] = kind.meaning;
  for (std::size_t i = 0; i < kLearners.size(); ++i) {
    json["late_r2"][kLearners[i]] = file::number(run.median(i));
  }
  json["behind"] = file::number(run.behind());
  json["worst_axis"] = file::number(std::ranges::min(run.late_r2[0]));
  json["axes"] = file::numbers(run.late_r2[0]);
  return json;
}

Json study_json(const std::vector<HostileKind>& kinds, const std::vector<HostileRun>& runs,
                const HostileArguments& options) {
  Json json = {{"format", "kelpie-hostile"}, {"version", 1},
               {"simulated", true},          {"seeds", options.seeds},
               {"first_seed", options.seed}, {"settings", options.set}};
  HostileRun all;
  std::size_t behind = 0;
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    HostileRun run;
    for (std::size_t seed = 0; seed < options.seeds; ++seed) {
      run.join(runs[i * options.seeds + seed]);
    }
    behind += run.behind() <= kMostBehind ? 0 : 1;
    json["kinds"].push_back(kind_json(kinds[i], run));
    all.join(run);
  }
  json["all"] = run_json(all);
  json["all"]["kinds_behind"] = behind;
  json["all"]["axes"] = all.late_r2[0].size();
  json["all"]["axes_too_low"] =
      std::ranges::count_if(all.late_r2[0], [](double r2) { return r2 < kLeastR2; });
  return json;
}

std::string study_table(const Json& json) {
  chart::TextTable table = json_table(
      "R² of the last rows held out, median of axes and seeds (simulation)",
      {column("kind", "/name"), column("kelpie", "/late_r2/kelpie"),
       column("least squares\nλ 1", "/late_r2/least_squares"),
       column("\nλ 0.998", "/late_r2/forgetting"), column("mean", "/late_r2/mean"),
       column("behind", "/behind"), column("worst\naxis", "/worst_axis"),
       column("beyond\nrange", "/beyond", count_text),
       column("not\nfinite", "/not_finite", count_text), column("changes", "/changes", count_text)},
      json["kinds"]);
  const auto total = [&](const char* name) { return json["all"][name].get<int>(); };
  table.notes = {fmt::format(
      "{} of {} kinds more than {} behind the best yardstick; {} of {} axes below {}; {} "
      "predictions beyond the targets so far and the true one, {} not finite",
      total("kinds_behind"), json["kinds"].size(), kMostBehind, total("axes_too_low"),
      total("axes"), chart::decimal(kLeastR2), total("beyond"), total("not_finite"))};
  table.whole = true;
  return chart::table_text(table);
}

std::vector<HostileKind> chosen_kinds(const std::vector<std::string>& names) {
  std::vector<HostileKind> all = hostile_kinds();
  if (names.empty()) {
    return all;
  }
  std::vector<std::string> known;
  std::ranges::transform(all, std::back_inserter(known), &HostileKind::name);
  std::vector<HostileKind> chosen;
  for (const std::string& name : names) {
    chosen.push_back(all[require_name("--kinds", name, "kind", known)]);
  }
  return chosen;
}

void learn_hostile_streams(const HostileArguments& options) {
  const std::vector<HostileKind> kinds = chosen_kinds(options.kinds);
  if (!options.json.empty()) {
    cli::check_output("--json", options.json, {});
  }
  const std::vector<HostileRun> runs = run_watched(
      "learning", [&](const auto& keep_going) { return run_streams(kinds, options, keep_going); });
  const Json json = study_json(kinds, runs, options);
  if (!options.json.empty()) {
    file::write_file_whole(options.json, file::json_text(json, 1));
  }
  cli::say("{}", study_table(json));
}

}  // namespace

void add_hostile(CLI::App& app) {
  const auto [command, options] = cli::add_command<HostileArguments>(
      app, "hostile", "Learn streams made to be hard, beside least squares and the mean",
      learn_hostile_streams);
  cli::add_list(command, "--kinds", options->kinds, "of streams, else all");
  add_seeds(command, options->seeds, "streams of each kind");
  cli::add_seed(command, options->seed, "the first of them");
  cli::add_threads(command, options->threads);
  cli::add_set(command, options->set, "key=value, a setting of the model (repeatable)");
  cli::add_file(command, "--json", options->json, "write all numbers to this file, too");
}

}  // namespace kelpie::lab
