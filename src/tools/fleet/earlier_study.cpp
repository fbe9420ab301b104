// SPDX-License-Identifier: Apache-2.0
#include "fleet/earlier_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <tuple>
#include <utility>

#include "file/content.hpp"
#include "file/json.hpp"
#include "file/tuning.hpp"
#include "fleet/study_json.hpp"
#include "fleet/tuning.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::fleet {
namespace {

using file::Json;
using file::JsonNode;

// What is known of a learner on a vehicle's axis.
struct Differences {
  std::vector<double> values;
  Gain gain;
};

void take_run(const JsonNode& run, EarlierStudy& study) {
  for (const JsonNode& axis : run["axes"].items()) {
    study.r2[run_name(run["log"].text(), run["split"].text(),
                      static_cast<std::uint64_t>(run["seed"].number()), run["learner"].text(),
                      axis["name"].text())] = number_or_none(axis["r2"]["final"]);
  }
}

// The least difference first; who has lost its R² before all. Who never had one has lost nothing.
double order_of(const ChangedRun& run) {
  if (std::isnan(run.now)) {
    return std::isnan(run.then) ? 0.0 : -HUGE_VAL;
  }
  return run.now - run.then;
}

}  // namespace

std::string run_name(const std::string& log, const std::string& split, std::uint64_t seed,
                     const std::string& learner, const std::string& axis) {
  return fmt::format("{}\n{}\n{}\n{}\n{}", log, split, seed, learner, axis);
}

EarlierStudy read_earlier_study(const std::filesystem::path& file) {
  EarlierStudy study{.file = file.string(), .kelpie = {}, .r2 = {}};
  const std::string text =
      file::read_content(file, "the study.json of an earlier study", file::kTuning.study_bytes);
  // A run is taken as soon as it is read, and not kept: there are thousands.
  std::string list;
  const Json rest =
      file::parse_json(text, study.file, [&](int depth, Json::parse_event_t event, Json& value) {
        if (depth == 1 && event == Json::parse_event_t::key) {
          list = value.get<std::string>();
        }
        if (depth != 2 || event != Json::parse_event_t::object_end || list != kRunsKey) {
          return true;
        }
        take_run(JsonNode(value, study.file, kRunsKey), study);
        return false;
      });
  const JsonNode root(rest, study.file, "");
  root.require_format(kStudyFormat, kStudyVersion);
  study.kelpie = root["kelpie"].text();
  return study;
}

StudyChange compare_studies(const Results& results, EarlierStudy earlier) {
  const Plan& plan = results.plan();
  StudyChange change{.file = earlier.file, .kelpie = earlier.kelpie};
  std::map<std::tuple<std::string, std::string, std::size_t>, Differences> found;
  for (std::size_t i = 0; i < results.combinations().size(); ++i) {
    const Combination one = results.combinations()[i];
    const Mission& mission = results.missions()[one.mission];
    const SplitOptions& split = plan.splits[one.split];
    const std::string& learner = plan.learners[one.learner].name;
    const std::optional<Outcome> outcome = results.outcome(i);
    for (const AxisOutcome& axis : outcome ? outcome->axes : std::vector<AxisOutcome>{}) {
      const auto then =
          earlier.r2.extract(run_name(mission.log, split.split, split.seed, learner, axis.name));
      if (then.empty()) {
        ++change.only_now;
        continue;
      }
      ++change.matched;
      const ChangedRun run{i, axis.name, then.mapped(), axis[Measure::r2_final]};
      Differences& own = found[{mission.vehicle, axis.name, one.learner}];
      own.values.push_back(run.now - run.then);
      own.gain.now.better += run.now > run.then + kTuning.clear_difference ? 1 : 0;
      own.gain.now.worse += run.now < run.then - kTuning.clear_difference ? 1 : 0;
      own.gain.lost += std::isnan(run.now) && !std::isnan(run.then) ? 1 : 0;
      if (order_of(run) < 0.0) {
        change.worst.push_back(run);
      }
    }
  }
  if (change.matched == 0) {
    throw InputError({.file = earlier.file, .line = 0, .field = "--against"},
                     "has no run in common with this study: runs are matched by log, split, seed, "
                     "learner and axis");
  }
  change.only_then = earlier.r2.size();
  std::ranges::stable_sort(change.worst, {}, order_of);
  change.worst.resize(std::min(change.worst.size(), kTuning.worst_runs));
  for (auto& [name, own] : found) {
    own.gain.vehicle = std::get<0>(name);
    own.gain.axis = std::get<1>(name);
    own.gain.learner = plan.learners[std::get<2>(name)].name;
    own.gain.difference = spread_of(own.values);
    change.gains.push_back(own.gain);
  }
  std::ranges::stable_sort(change.gains, {},
                           [](const Gain& gain) { return gain.difference.median; });
  return change;
}

std::vector<Gain> losses(const StudyChange& change, double most) {
  std::vector<Gain> found;
  std::ranges::copy_if(change.gains, std::back_inserter(found), [&](const Gain& gain) {
    return gain.lost > 0 || gain.difference.median < -most;
  });
  return found;
}

}  // namespace kelpie::fleet
