// SPDX-License-Identifier: Apache-2.0
#include "lab/claims.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "chart/wording.hpp"

namespace kelpie::lab {
namespace {

using file::Json;

// The rules' figures. They stand in the rules' sentences, too.
constexpr double kGood = 0.95;         // R² of a baseline on its own configuration
constexpr double kTransferLoss = 0.1;  // R² lost on another configuration
constexpr double kLevel = 0.03;        // R² below the baseline that still counts as reaching it
constexpr double kDrop = 0.05;         // R² lost at a switch
constexpr double kJittery = 2.0;       // times the jitter of the paper's learner
constexpr double kLivelier = 1.2;
constexpr double kDeep = 0.05;  // R² below the median, of the lowest look
constexpr double kDeeper = 0.15;
constexpr double kClearly = 0.02;  // R² between two learners
constexpr double kSimilar = 0.1;   // R² between learners at the start

constexpr const char* kOneConfiguration = "the log holds one configuration only";

std::size_t stages_of(const Json& study) {
  return study["stages"].size();
}

ClaimState by_value(bool holds, bool in_part) {
  return holds ? ClaimState::holds : in_part ? ClaimState::in_part : ClaimState::fails;
}

// From how many of all cases the claim is true in.
ClaimState by_count(std::size_t fine, std::size_t all) {
  return all == 0 ? ClaimState::not_judged : by_value(fine == all, 2 * fine >= all);
}

Judgement own_configuration(const Json& study, const Json&) {
  std::vector<double> own;
  for (const Json& matrix : study["offline"]) {
    for (std::size_t i = 0; i < matrix["models"].size(); ++i) {
      own.push_back(number_of(matrix["models"][i]["r2"][i]));
    }
  }
  const auto fine =
      static_cast<std::size_t>(std::ranges::count_if(own, [](double r2) { return r2 >= kGood; }));
  return {
      fmt::format("R² {} to {}; {} of {} reach {}", chart::decimal(*std::ranges::min_element(own)),
                  chart::decimal(*std::ranges::max_element(own)), fine, own.size(), kGood),
      by_count(fine, own.size())};
}

Judgement transfer(const Json& study, const Json&) {
  const std::size_t count = study["configurations"].size();
  std::vector<double> losses;
  for (std::size_t from = 0; from < count; ++from) {
    for (std::size_t to = 0; to < count; ++to) {
      if (from == to) {
        continue;
      }
      double& loss = losses.emplace_back(0.0);
      for (const Json& matrix : study["offline"]) {
        const Json& models = matrix["models"];
        loss += (number_of(models[to]["r2"][to]) - number_of(models[from]["r2"][to])) /
                static_cast<double>(study["offline"].size());
      }
    }
  }
  if (losses.empty()) {
    return {kOneConfiguration};
  }
  const auto [least, most] = std::ranges::minmax(losses);
  const auto fine = std::ranges::count_if(losses, [](double l) { return l >= kTransferLoss; });
  return {fmt::format("lower by {} to {} than that configuration's own model",
                      chart::decimal(least), chart::decimal(most)),
          by_count(static_cast<std::size_t>(fine), losses.size())};
}

Judgement reaches_baseline(const Json& study, const Json& row) {
  std::vector<double> below;
  for (std::size_t stage = 0; stage < stages_of(study); ++stage) {
    for (std::size_t axis = 0; axis < study["axes"].size(); ++axis) {
      below.push_back(end_of(*find_row(study, "offline"), stage, axis) - end_of(row, stage, axis));
    }
  }
  const auto fine = std::ranges::count_if(below, [](double b) { return b <= kLevel; });
  double sum = 0.0;
  for (const double one : below) {
    sum += one;
  }
  return {fmt::format("{} of {} within {}; below by {} in the mean, {} at most", fine, below.size(),
                      kLevel, chart::decimal(sum / static_cast<double>(below.size())),
                      chart::decimal(*std::ranges::max_element(below))),
          by_count(static_cast<std::size_t>(fine), below.size())};
}

Judgement drops_and_recovers(const Json& study, const Json& row) {
  std::size_t fine = 0;
  std::string figures;
  for (const Json& one : row["switches"]) {
    const double before = number_of(one["before"]);
    const double lowest = number_of(one["lowest"]);
    const double end = number_of(one["end"]);
    fine += before - lowest >= kDrop && end >= before - kDrop ? 1U : 0U;
    figures += fmt::format("{}{} → {} → {}", figures.empty() ? "" : "; ", chart::decimal(before),
                           chart::decimal(lowest), chart::decimal(end));
  }
  if (stages_of(study) < 2) {
    return {kOneConfiguration};
  }
  return {"before, lowest, at the end: " + figures, by_count(fine, row["switches"].size())};
}

Judgement fifo_unsteady(const Json& study, const Json& row) {
  const bool small = row["key"] == "paper_small";
  const Json& fifo = *find_row(study, small ? "fifo_small" : "fifo");
  if (fifo["steady"]["looks"] == 0) {
    return {"the buffer never filled: nothing was forgotten"};
  }
  const double theirs = number_of(fifo["steady"]["jitter"]);
  const double ours = number_of(row["steady"]["jitter"]);
  return {fmt::format("jitter {:.4f} against {:.4f}: {:.2f} times", theirs, ours, theirs / ours),
          by_value(theirs >= kJittery * ours, theirs >= kLivelier * ours)};
}

Judgement steady(const Json&, const Json& row) {
  if (row["steady"]["looks"] == 0) {
    return {"the buffer never filled: nothing was forgotten"};
  }
  const double deepest = number_of(row["steady"]["deepest"]);
  return {fmt::format("lowest look {} below the median", chart::decimal(deepest)),
          by_value(deepest <= kDeep, deepest <= kDeeper)};
}

Judgement similar_start(const Json& study, const Json& row) {
  double most = 0.0;
  std::string figures = chart::decimal(number_of(row["start"]));
  for (const char* const other : {"fifo", "sosvr"}) {
    const double start = number_of((*find_row(study, other))["start"]);
    figures += ", " + chart::decimal(start);
    most = std::fmax(most, std::abs(start - number_of(row["start"])));
  }
  return {"R² after 1,000 samples, FIFO, SOSVR: " + figures,
          by_value(most <= kSimilar, most <= 2.0 * kSimilar)};
}

Judgement adapts(const Json& study, const Json& row) {
  std::size_t fine = 0;
  std::string figures = chart::decimal(mean_end(row, 0));
  for (std::size_t stage = 1; stage < stages_of(study); ++stage) {
    const double r2 = mean_end(row, stage);
    fine += r2 >= mean_end(row, 0) - kDrop ? 1U : 0U;
    figures += ", " + chart::decimal(r2);
  }
  if (stages_of(study) < 2) {
    return {kOneConfiguration};
  }
  return {"at the ends: " + figures, by_count(fine, stages_of(study) - 1)};
}

Judgement sosvr_behind(const Json& study, const Json& row) {
  double theirs = 0.0;
  double ours = 0.0;
  for (std::size_t stage = 0; stage < stages_of(study); ++stage) {
    theirs += mean_end(*find_row(study, "sosvr"), stage) / static_cast<double>(stages_of(study));
    ours += mean_end(row, stage) / static_cast<double>(stages_of(study));
  }
  return {fmt::format("SOSVR {} against {}", chart::decimal(theirs), chart::decimal(ours)),
          by_value(ours - theirs >= kClearly, ours > theirs)};
}

// Judges a row of a study; rules of off-line models and of SOSVR alone have no row of kelpie's.
struct Rule {
  const char* claim;
  std::string rule;
  Judgement (*judge)(const Json& study, const Json& row);
  std::vector<const char*> rows{"paper"};
  const char* kelpie = "default";
};

const std::vector<Rule> kRules{
    {"An off-line model predicts its own configuration well.",
     fmt::format("R² ≥ {} in every axis and configuration; in part: in half of them or more.",
                 kGood),
     own_configuration,
     {"paper"},
     ""},
    {"A static model of one configuration does not describe the others.",
     fmt::format("Mean over the axes: R² on another configuration lower by {} or more, for every "
                 "pair; in part: for half of them or more.",
                 kTransferLoss),
     transfer,
     {"paper"},
     ""},
    {"In every configuration the learner reaches the off-line baseline.",
     fmt::format("R² at the end of each configuration (mean of the seeds) at most {} below the "
                 "baseline, in every axis; in part: in half of them or more.",
                 kLevel),
     reaches_baseline},
    {"Accuracy drops when the vehicle changes, and recovers.",
     fmt::format("Mean over the axes: after every switch R² falls by {0} or more within 1,000 "
                 "samples, and ends at most {0} below its value before; in part: at half of the "
                 "switches or more.",
                 kDrop),
     drops_and_recovers},
    {"In the early stages all methods report similar scores.",
     fmt::format("After 1,000 samples, mean over the axes: FIFO and SOSVR within {} of the "
                 "learner; in part: within {}.",
                 kSimilar, 2.0 * kSimilar),
     similar_start},
    {"FIFO is unstable and jittery once its buffer is full.",
     fmt::format("Once FIFO has begun to forget, its R² jitters {} times as much as the learner's "
                 "or more (root mean square of the change between two looks, 1,000 samples after "
                 "a switch left out); in part: {} times.",
                 kJittery, kLivelier),
     fifo_unsteady,
     {"paper", "paper_small"}},
    {"With the proposed forgetting the accuracy is stable.",
     fmt::format("Once FIFO has begun to forget, the learner's lowest look lies at most {} below "
                 "its median (mean of axes and seeds, 1,000 samples after a switch left out); in "
                 "part: {}.",
                 kDeep, kDeeper),
     steady,
     {"paper", "paper_small"}},
    {"SOSVR adapts to changed dynamics.",
     fmt::format("Mean over the axes: at the end of every later configuration R² is at most {} "
                 "below that of the first; in part: in half of them or more.",
                 kDrop),
     adapts,
     {"sosvr"},
     ""},
    {"SOSVR is significantly less accurate than the learner.",
     fmt::format("R² at the end of the configurations, mean over axes and configurations: lower "
                 "than the learner's by {} or more; in part: lower at all.",
                 kClearly),
     sosvr_behind},
    {"The hyper-parameters of Table I give the accuracy of the baseline.",
     "As for the baseline above.",
     reaches_baseline,
     {"paper_readable", "paper_printed"},
     ""}};

}  // namespace

std::string_view finding_text(ClaimState finding) {
  switch (finding) {
    case ClaimState::holds:
      return "holds";
    case ClaimState::in_part:
      return "holds in part";
    case ClaimState::fails:
      return "does not hold";
    case ClaimState::not_judged:
      break;
  }
  return "could not be judged";
}

double number_of(const Json& value) {
  return value.is_null() ? std::nan("") : value.get<double>();
}

double end_of(const Json& row, std::size_t stage, std::size_t axis) {
  double sum = 0.0;
  for (const Json& seed : row["ends"]) {
    sum += number_of(seed[stage][axis]) / static_cast<double>(row["ends"].size());
  }
  return sum;
}

double mean_end(const Json& row, std::size_t stage) {
  const std::size_t axes = row["ends"][0][stage].size();
  double sum = 0.0;
  for (std::size_t axis = 0; axis < axes; ++axis) {
    sum += end_of(row, stage, axis) / static_cast<double>(axes);
  }
  return sum;
}

const Json* find_row(const Json& study, std::string_view key) {
  const auto found =
      std::ranges::find_if(study["rows"], [&](const Json& row) { return row["key"] == key; });
  return found == study["rows"].end() ? nullptr : &*found;
}

std::vector<Claim> claims_of(const Json& document) {
  std::vector<Claim> claims;
  for (const Rule& rule : kRules) {
    for (const Json& study : document["streams"]) {
      for (const char* const key : rule.rows) {
        const Json* const found = find_row(study, key);
        if (study["offline"].empty() || found == nullptr) {
          continue;
        }
        const Json& row = *found;
        std::string where =
            fmt::format("{}, {} split", study["simulated"].get<bool>() ? "simulation" : "real log",
                        study["split"].get<std::string>());
        if (rule.rows.size() > 1) {
          where += ", " + row["name"].get<std::string>();
        }
        const Json* const ours = key == rule.rows.front() ? find_row(study, rule.kelpie) : nullptr;
        claims.push_back({rule.claim, rule.rule, std::move(where), rule.judge(study, row),
                          ours == nullptr ? Judgement{} : rule.judge(study, *ours)});
      }
    }
  }
  return claims;
}

}  // namespace kelpie::lab
