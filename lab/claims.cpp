// SPDX-License-Identifier: Apache-2.0
#include "lab/claims.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "chart/wording.hpp"
#include "lab/reproduction_views.hpp"

namespace kelpie::lab {
namespace {

// The rules' figures. They stand in the rules' sentences, too.
constexpr double kGood = 0.95;         // R² of a baseline on its own configuration
constexpr double kTransferLoss = 0.1;  // R² lost on another configuration
constexpr double kLevel = 0.03;        // R² below the baseline that still counts as reaching it
constexpr double kDrop = 0.05;         // R² lost at a switch
constexpr double kJittery = 2.0;       // times the jitter of the proposed learner
constexpr double kLivelier = 1.2;
constexpr double kDeep = 0.05;  // R² below the median, of the lowest look
constexpr double kDeeper = 0.15;
constexpr double kClearly = 0.02;  // R² between two learners

Claim claim_of(const StreamStudy& study, const char* paper, std::string rule,
               const char* measured = "") {
  return {
      paper, std::move(rule),
      fmt::format("{}, {} split", study.simulated ? "simulation" : "real log", study.split_kind),
      measured, ClaimState::not_judged};
}

ClaimState by_value(bool holds, bool in_part) {
  return holds ? ClaimState::holds : in_part ? ClaimState::in_part : ClaimState::fails;
}

// From how many of all cases the claim is true in.
ClaimState by_count(std::size_t fine, std::size_t all) {
  if (all == 0) {
    return ClaimState::not_judged;
  }
  return by_value(fine == all, 2 * fine >= all);
}

Claim own_configuration(const StreamStudy& study) {
  Claim claim =
      claim_of(study, "An off-line model predicts its own configuration well.",
               fmt::format("R² ≥ {} in every axis and configuration; in part: in half of them or "
                           "more.",
                           kGood));
  std::vector<double> own;
  for (std::size_t axis = 0; axis < study.offline.size(); ++axis) {
    for (std::size_t i = 0; i < study.configurations.size(); ++i) {
      own.push_back(study.offline[axis].models[i].r2[i]);
    }
  }
  const auto fine = std::ranges::count_if(own, [](double r2) { return r2 >= kGood; });
  claim.measured =
      fmt::format("R² {} to {}; {} of {} reach {}", chart::decimal(*std::ranges::min_element(own)),
                  chart::decimal(*std::ranges::max_element(own)), fine, own.size(), kGood);
  claim.finding = by_count(static_cast<std::size_t>(fine), own.size());
  return claim;
}

Claim transfer(const StreamStudy& study) {
  Claim claim = claim_of(
      study, "A static model of one configuration does not describe the others.",
      fmt::format("Mean over the axes: R² on another configuration lower by {} or more, for "
                  "every pair; in part: for half of them or more.",
                  kTransferLoss));
  std::size_t fine = 0;
  std::size_t pairs = 0;
  double least = HUGE_VAL;
  double most = -HUGE_VAL;
  for (std::size_t from = 0; from < study.configurations.size(); ++from) {
    for (std::size_t to = 0; to < study.configurations.size(); ++to) {
      if (from == to) {
        continue;
      }
      double loss = 0.0;
      for (const OfflineMatrix& matrix : study.offline) {
        loss += (matrix.models[to].r2[to] - matrix.models[from].r2[to]) /
                static_cast<double>(study.offline.size());
      }
      least = std::min(least, loss);
      most = std::max(most, loss);
      fine += loss >= kTransferLoss ? 1U : 0U;
      ++pairs;
    }
  }
  claim.finding = by_count(fine, pairs);
  claim.measured = pairs == 0 ? "the log holds one configuration only"
                              : fmt::format("lower by {} to {} than that configuration's own model",
                                            chart::decimal(least), chart::decimal(most));
  return claim;
}

Claim reaches_baseline(const StreamStudy& study, const ContenderRuns& proposed) {
  Claim claim = claim_of(
      study, "In every configuration the learner reaches the off-line baseline.",
      fmt::format("R² at the end of each configuration (mean of the seeds) at most {} below "
                  "the baseline, in every axis; in part: in half of them or more.",
                  kLevel));
  std::size_t fine = 0;
  std::size_t all = 0;
  double worst = -HUGE_VAL;
  double sum = 0.0;
  for (std::size_t stage = 0; stage < stages_of(study); ++stage) {
    for (std::size_t axis = 0; axis < study.axes.size(); ++axis) {
      const double gap = baseline_r2(study, axis, stage) - stage_r2(proposed, axis, stage);
      fine += gap <= kLevel ? 1U : 0U;
      worst = std::fmax(worst, gap);
      sum += gap;
      ++all;
    }
  }
  claim.finding = by_count(fine, all);
  claim.measured =
      fmt::format("{} of {} within {}; below by {} in the mean, {} at most", fine, all, kLevel,
                  chart::decimal(sum / static_cast<double>(all)), chart::decimal(worst));
  return claim;
}

Claim drops_and_recovers(const StreamStudy& study, const ContenderRuns& proposed) {
  Claim claim = claim_of(
      study, "Accuracy drops when the vehicle changes, and recovers.",
      fmt::format("Mean over the axes: at every switch R² falls by {} or more within 1,000 "
                  "samples, and ends at most {} below where it was; in part: at half of the "
                  "switches or more.",
                  kDrop, kLevel),
      "the log holds one configuration only");
  const std::vector<SwitchEffect> effects = switch_effects(study, proposed);
  std::size_t fine = 0;
  std::string figures;
  for (const SwitchEffect& effect : effects) {
    const bool drops = effect.before - effect.lowest >= kDrop;
    fine += drops && effect.end >= effect.before - kLevel ? 1U : 0U;
    figures +=
        fmt::format("{}{} → {} → {}", figures.empty() ? "" : "; ", chart::decimal(effect.before),
                    chart::decimal(effect.lowest), chart::decimal(effect.end));
  }
  if (!effects.empty()) {
    claim.measured = "before, lowest, at the end: " + figures;
    claim.finding = by_count(fine, effects.size());
  }
  return claim;
}

Claim fifo_unsteady(const StreamStudy& study, const ContenderRuns& proposed,
                    const ContenderRuns& fifo) {
  Claim claim =
      claim_of(study, "FIFO is unstable and jittery once its buffer is full.",
               fmt::format("Once FIFO has begun to forget, its R² jitters {} times as much as the "
                           "proposed learner's or more (root mean square of the change between two "
                           "looks, 1,000 samples after a switch left out); in part: {} times.",
                           kJittery, kLivelier),
               "the buffer never filled: nothing was forgotten");
  claim.where += ", " + fifo.name;
  const Steadiness theirs = steadiness(fifo, fifo);
  const Steadiness ours = steadiness(proposed, fifo);
  if (theirs.looks > 0) {
    const double ratio = theirs.jitter / ours.jitter;
    claim.measured = fmt::format("jitter {:.4f} against {:.4f}: {:.2f} times", theirs.jitter,
                                 ours.jitter, ratio);
    claim.finding = by_value(ratio >= kJittery, ratio >= kLivelier);
  }
  return claim;
}

Claim proposed_steady(const StreamStudy& study, const ContenderRuns& proposed) {
  Claim claim = claim_of(
      study, "With the proposed forgetting the accuracy is stable.",
      fmt::format("Once it has begun to forget, its lowest look lies at most {} below the "
                  "median (mean of axes and seeds, 1,000 samples after a switch left out); "
                  "in part: {}.",
                  kDeep, kDeeper),
      "the buffer never filled: nothing was forgotten");
  claim.where += ", " + proposed.name;
  const Steadiness ours = steadiness(proposed, proposed);
  if (ours.looks > 0) {
    claim.measured = fmt::format("lowest look {} below the median", chart::decimal(ours.deepest));
    claim.finding = by_value(ours.deepest <= kDeep, ours.deepest <= kDeeper);
  }
  return claim;
}

Claim less_accurate(const StreamStudy& study, const ContenderRuns& proposed,
                    const ContenderRuns& other) {
  Claim claim = claim_of(
      study, "SOSVR is significantly less accurate than the proposed learner.",
      fmt::format("R² at the end of the configurations, mean over axes and configurations: "
                  "lower than the proposed learner's by {} or more; in part: lower at all.",
                  kClearly));
  double theirs = 0.0;
  double ours = 0.0;
  const std::size_t stages = stages_of(study);
  for (std::size_t stage = 0; stage < stages; ++stage) {
    theirs += mean_stage_r2(other, stage) / static_cast<double>(stages);
    ours += mean_stage_r2(proposed, stage) / static_cast<double>(stages);
  }
  claim.measured = fmt::format("{} against {}", chart::decimal(theirs), chart::decimal(ours));
  claim.finding = by_value(ours - theirs >= kClearly, ours > theirs);
  return claim;
}

Claim adapts(const StreamStudy& study, const ContenderRuns& other) {
  Claim claim =
      claim_of(study, "SOSVR adapts to changed dynamics.",
               fmt::format("Mean over the axes: at the end of every later configuration R² is at "
                           "most {} below that of the first; in part: in half of them or more.",
                           kDrop),
               "the log holds one configuration only");
  std::size_t fine = 0;
  std::string figures = chart::decimal(mean_stage_r2(other, 0));
  for (std::size_t stage = 1; stage < stages_of(study); ++stage) {
    const double r2 = mean_stage_r2(other, stage);
    fine += r2 >= mean_stage_r2(other, 0) - kDrop ? 1U : 0U;
    figures += ", " + chart::decimal(r2);
  }
  if (stages_of(study) > 1) {
    claim.measured = "at the ends: " + figures;
    claim.finding = by_count(fine, stages_of(study) - 1);
  }
  return claim;
}

Claim values_as_written(const StreamStudy& study, const ContenderRuns& paper) {
  Claim claim = reaches_baseline(study, paper);
  claim.paper =
      "The hyper-parameters of Table I, with the paper's own rules, give that accuracy "
      "(γ read as a reciprocal).";
  return claim;
}

const ContenderRuns& runs_of(const StreamStudy& study, std::string_view key) {
  return *find_contender(study, key);
}

using Judge = Claim (*)(const StreamStudy&);

// In the order of the page; the claims of a row stand together, stream by stream.
const std::vector<std::vector<Judge>> kJudges{
    {own_configuration},
    {transfer},
    {[](const StreamStudy& s) { return reaches_baseline(s, runs_of(s, "proposed")); }},
    {[](const StreamStudy& s) { return drops_and_recovers(s, runs_of(s, "proposed")); }},
    {[](const StreamStudy& s) {
       return fifo_unsteady(s, runs_of(s, "proposed"), runs_of(s, "fifo"));
     },
     [](const StreamStudy& s) {
       return fifo_unsteady(s, runs_of(s, "proposed_small"), runs_of(s, "fifo_small"));
     }},
    {[](const StreamStudy& s) { return proposed_steady(s, runs_of(s, "proposed")); },
     [](const StreamStudy& s) { return proposed_steady(s, runs_of(s, "proposed_small")); }},
    {[](const StreamStudy& s) { return adapts(s, runs_of(s, "sosvr")); }},
    {[](const StreamStudy& s) {
      return less_accurate(s, runs_of(s, "proposed"), runs_of(s, "sosvr"));
    }},
    {[](const StreamStudy& s) { return values_as_written(s, runs_of(s, "paper")); }}};

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

std::vector<Claim> claims_of(const Reproduction& result) {
  std::vector<Claim> claims;
  for (const std::vector<Judge>& judges : kJudges) {
    for (const StreamStudy& study : result.studies) {
      if (!study.offline.empty() && stages_of(study) > 0) {
        std::ranges::transform(judges, std::back_inserter(claims),
                               [&](Judge judge) { return judge(study); });
      }
    }
  }
  return claims;
}

}  // namespace kelpie::lab
