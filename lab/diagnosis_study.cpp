// SPDX-License-Identifier: Apache-2.0
#include "lab/diagnosis_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>

#include "core/quantile.hpp"
#include "jobs/run_all.hpp"
#include "kelpie/core/random.hpp"
#include "kelpie/vehicle/diagnosis.hpp"
#include "lab/json_table.hpp"
#include "simulator/simulation.hpp"

namespace kelpie::lab {
namespace {

constexpr std::size_t kNominalEvery = 5;  // seeds
constexpr double kEarly_s = 15.0;         // that the start of a change may be taken too soon
constexpr std::size_t kSensorLead = 10;   // rows before a change that already feel it (slopes)

Diagnosis fresh_diagnosis() {
  return Diagnosis(6, {0, 1, 2}, {0, 1, 5});
}

void show(Diagnosis& diagnosis, const simulator::LogRow& row) {
  std::array<double, 6> x{};
  std::copy_n(row.velocity.data(), 3, x.begin());
  std::copy_n(row.rotors_rps.data(), 3, x.begin() + 3);
  diagnosis.update(x, {row.acceleration.data(), 3}, row.t_s);
}

// Of the share that is left of each axis, against the true shares of thrust on the nominal matrix.
double authority_error_of(const Diagnosis& diagnosis, const DiagnosisCase& of) {
  constexpr double kFull = 20.0;  // rev/s; thrust goes with the square, so any will do
  const bool is_thrust = std::ranges::all_of(of.truth, [](const Cause& cause) {
    return cause.kind == CauseKind::thruster || cause.kind == CauseKind::all_thrusters;
  });
  if (!is_thrust || !diagnosis.knows_thrust()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const Authority authority(diagnosis,
                            {{3, -kFull, kFull}, {4, -kFull, kFull}, {5, -kFull, kFull}});
  double worst = 0.0;
  for (std::size_t i = 0; i < authority.axes().size(); ++i) {
    double nominal = 0.0;
    double left = 0.0;
    for (const ThrusterEffect& one : authority.thrusters()) {
      const double range = std::max({one.nominal_ahead[i], one.nominal_astern[i], 0.0}) -
                           std::min({one.nominal_ahead[i], one.nominal_astern[i], 0.0});
      const auto cause = std::ranges::find_if(of.truth, [&](const Cause& truth) {
        return truth.kind == CauseKind::all_thrusters || truth.place == one.range.input;
      });
      nominal += range;
      left += cause == of.truth.end() ? range : cause->size * range;
    }
    worst = std::max(worst, std::abs(authority.axes()[i].left() - left / nominal));
  }
  return worst;
}

// All cases of one seed: the same drive up to the change.
class Seed {
 public:
  Seed(const DiagnosisPlan& plan, std::uint64_t seed)
      : scenario_(plan.scenario), diagnosis_(fresh_diagnosis()) {
    RandomStream stream(seed, "diagnosis/change");
    change_s_ = plan.before_s + std::floor(stream.uniform(0.0, 60.0));
    scenario_.seed = seed;
    scenario_.configurations.resize(2);
    scenario_.phases = {{.configuration = 0, .duration_s = change_s_}};
    const std::vector<simulator::LogRow> rows = simulator::simulate(scenario_);
    shown_ = rows.size() - kSensorLead;
    for (std::size_t row = 0; row < shown_; ++row) {
      show(diagnosis_, rows[row]);
    }
    scenario_.phases.push_back({.configuration = 1, .duration_s = plan.after_s});
  }

  DiagnosisRun run(const DiagnosisCase& of, std::size_t index) {
    scenario_.configurations[1] = of.configuration;
    Diagnosis diagnosis = diagnosis_;
    const std::vector<simulator::LogRow> rows = simulator::simulate(scenario_);
    for (std::size_t row = shown_; row < rows.size(); ++row) {
      show(diagnosis, rows[row]);
    }
    DiagnosisRun run{.of = index, .seed = scenario_.seed, .finding = {}};
    run.authority_error = authority_error_of(diagnosis, of);
    if (!diagnosis.findings().empty() &&
        diagnosis.findings().back().since_s > change_s_ - kEarly_s) {
      run.found = true;
      run.finding = diagnosis.findings().back();
      run.found_after_s = run.finding.found_s - change_s_;
      run.named_after_s = run.finding.told_s - change_s_;
    }
    return run;
  }

 private:
  simulator::Scenario scenario_;
  Diagnosis diagnosis_;
  double change_s_ = 0.0;
  std::size_t shown_ = 0;
};

NominalRun nominal_run(const DiagnosisPlan& plan, std::uint64_t seed) {
  simulator::Scenario scenario = plan.scenario;
  scenario.configurations.resize(1);
  scenario.seed = seed;
  scenario.phases = {{.configuration = 0, .duration_s = 3600.0 * plan.nominal_hours}};
  Diagnosis diagnosis = fresh_diagnosis();
  NominalRun run{.seed = seed, .hours = plan.nominal_hours};
  bool was_named = false;
  for (const simulator::LogRow& row : simulator::simulate(scenario)) {
    show(diagnosis, row);
    const bool is_open = !diagnosis.findings().empty() && !diagnosis.findings().back().settled;
    const bool is_named = is_open && diagnosis.findings().back().state == FindingState::named;
    run.named += is_named && !was_named ? 1 : 0;
    was_named = is_named;
  }
  const auto stand = static_cast<std::size_t>(
      std::ranges::count(diagnosis.findings(), FindingState::named, &Finding::state));
  run.taken_back = run.named - std::min(run.named, stand);
  run.unnamed = diagnosis.findings().size() - stand;
  return run;
}

bool same_place(const Cause& truth, const Cause& told) {
  return truth.kind == told.kind && (truth.kind == CauseKind::force || truth.place == told.place);
}

using file::Json;

std::string share_text(std::size_t part, std::size_t all) {
  return all > 0
             ? fmt::format("{:.0f} %", 100.0 * static_cast<double>(part) / static_cast<double>(all))
             : "–";
}

chart::TextTable case_table(const DiagnosisStudy& study) {
  chart::TextTable table{
      .title = fmt::format("One change, {:.0f} s after it", study.after_s),
      .head = {"case", "effect", "right", "wrong\nname", "named after\nmedian", "longest",
               "interval\nholds", "authority\nlargest error"},
      .rows = {},
      .notes = {fmt::format("Simulated vehicle, seeds {} to {}. Right: what was named is what it "
                            "was, and nothing else. Interval: of those right. Authority: of the "
                            "share left of an axis.",
                            study.first_seed, study.first_seed + study.seeds - 1)}};
  const std::vector<CaseSummary> all = summaries(study);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const CaseSummary& one = all[i];
    const DiagnosisCase& of = study.cases[i];
    const bool sized = of.truth.front().kind != CauseKind::frozen;
    table.rows.push_back(
        {of.name, of.effect > 0 ? fmt::format("{} %", of.effect) : "",
         share_text(one.right, one.runs), std::to_string(one.wrong),
         fmt::format("{:.0f} s", one.median_s), fmt::format("{:.0f} s", one.longest_s),
         sized ? share_text(one.held, one.right) : "",
         std::isnan(one.authority_error) ? "" : fmt::format("{:.3f}", one.authority_error)});
  }
  return table;
}

// Runs by effect: single causes only.
chart::TextTable effect_table(const DiagnosisStudy& study) {
  chart::TextTable table{.title = "Single causes by strength",
                         .head = {"effect", "runs", "right", "worst case", "interval holds"},
                         .rows = {},
                         .notes = {}};
  const std::vector<CaseSummary> all = summaries(study);
  for (const int effect : {20, 40, 60, 80}) {
    CaseSummary sum;
    std::size_t least = study.seeds;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (study.cases[i].effect == effect && !study.cases[i].special) {
        sum.runs += all[i].runs;
        sum.right += all[i].right;
        sum.held += all[i].held;
        least = std::min(least, all[i].right);
      }
    }
    table.rows.push_back({fmt::format("{} %", effect), std::to_string(sum.runs),
                          share_text(sum.right, sum.runs), share_text(least, study.seeds),
                          share_text(sum.held, sum.right)});
  }
  return table;
}

Json nominal_json(const DiagnosisStudy& study) {
  return file::list(study.nominal, [](const NominalRun& run) {
    return Json{{"seed", run.seed},
                {"hours", run.hours},
                {"named", run.named},
                {"taken_back", run.taken_back},
                {"unnamed", run.unnamed}};
  });
}

chart::TextTable nominal_table(const Json& nominal) {
  return json_table(
      "Nothing changed",
      {column("seed", "/seed", fixed("{}")), column("hours", "/hours", fixed("{:.0f}")),
       column("named", "/named", fixed("{}")),
       column("of these taken back", "/taken_back", fixed("{}")),
       column("found without a name", "/unnamed", fixed("{}"))},
      nominal);
}

}  // namespace

DiagnosisStudy study_diagnosis(const DiagnosisPlan& plan) {
  DiagnosisStudy study;
  study.cases = diagnosis_cases(plan.scenario.vehicle);
  study.seeds = plan.seeds;
  study.first_seed = plan.first_seed;
  study.after_s = plan.after_s;
  const std::size_t nominal =
      plan.nominal_hours > 0.0 ? (plan.seeds + kNominalEvery - 1) / kNominalEvery : 0;
  study.nominal.resize(nominal);
  study.runs.resize(plan.seeds * study.cases.size());
  std::atomic<std::size_t> done = 0;
  std::mutex telling;
  const auto go_on = [&](std::size_t steps) {
    const std::size_t now = done += steps;
    const std::scoped_lock lock(telling);
    return plan.keep_going(static_cast<double>(now) / static_cast<double>(study.runs.size() * 2));
  };
  jobs::run_all(nominal + plan.seeds, plan.threads, [&](std::size_t job) {
    if (!go_on(0)) {
      return;
    }
    if (job < nominal) {
      study.nominal[job] = nominal_run(plan, plan.first_seed + kNominalEvery * job);
      go_on(study.runs.size() / nominal);
      return;
    }
    const std::size_t index = job - nominal;
    Seed seed(plan, plan.first_seed + index);
    for (std::size_t i = 0; i < study.cases.size(); ++i) {
      study.runs[index * study.cases.size() + i] = seed.run(study.cases[i], i);
      if (!go_on(1)) {
        return;
      }
    }
  });
  return study;
}

bool named_rightly(const DiagnosisCase& of, const DiagnosisRun& run) {
  const Finding& finding = run.finding;
  if (!run.found || finding.state != FindingState::named || finding.count != of.truth.size()) {
    return false;
  }
  return std::ranges::all_of(of.truth, [&](const Cause& truth) {
    return std::any_of(finding.causes.begin(),
                       finding.causes.begin() + static_cast<std::ptrdiff_t>(finding.count),
                       [&](const Cause& told) { return same_place(truth, told); });
  });
}

bool holds_truth(const DiagnosisCase& of, const DiagnosisRun& run) {
  return std::ranges::all_of(of.truth, [&](const Cause& truth) {
    return std::any_of(run.finding.causes.begin(),
                       run.finding.causes.begin() + static_cast<std::ptrdiff_t>(run.finding.count),
                       [&](const Cause& told) {
                         return same_place(truth, told) &&
                                (truth.place != told.place ||
                                 (truth.size >= told.lower && truth.size <= told.upper));
                       });
  });
}

std::string said(const DiagnosisRun& run) {
  const Finding& finding = run.finding;
  if (!run.found || finding.state == FindingState::looking) {
    return "nothing";
  }
  if (finding.state == FindingState::none) {
    return "none of these";
  }
  if (finding.state == FindingState::ambiguous) {
    return "one of two";
  }
  return finding.count == 2 ? "two causes" : case_name(finding.causes[0]);
}

std::vector<CaseSummary> summaries(const DiagnosisStudy& study) {
  std::vector<CaseSummary> all(study.cases.size());
  std::vector<std::vector<double>> delays(study.cases.size());
  for (const DiagnosisRun& run : study.runs) {
    const DiagnosisCase& of = study.cases[run.of];
    CaseSummary& sum = all[run.of];
    sum.authority_error =
        sum.runs == 0 ? run.authority_error : std::fmax(sum.authority_error, run.authority_error);
    ++sum.runs;
    if (named_rightly(of, run)) {
      ++sum.right;
      sum.held += holds_truth(of, run) ? 1 : 0;
      delays[run.of].push_back(run.named_after_s);
    } else if (run.found && run.finding.state == FindingState::named) {
      ++sum.wrong;
    }
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!delays[i].empty()) {
      all[i].longest_s = std::ranges::max(delays[i]);
      all[i].median_s = quantile(delays[i], 0.5);
    }
  }
  return all;
}

std::string diagnosis_table(const DiagnosisStudy& study) {
  return chart::tables_text(
      {case_table(study), effect_table(study), nominal_table(nominal_json(study))});
}

std::string diagnosis_json(const DiagnosisStudy& study) {
  const Json runs = file::list(study.runs, [&](const DiagnosisRun& run) {
    const DiagnosisCase& of = study.cases[run.of];
    const Cause& told = run.finding.causes[0];
    return Json{{"case", of.name},
                {"kind", kind_name(of.truth.front().kind)},
                {"effect", of.effect},
                {"special", of.special},
                {"seed", run.seed},
                {"said", said(run)},
                {"right", named_rightly(of, run)},
                {"same_place", told.place == of.truth.front().place},
                {"holds", holds_truth(of, run)},
                {"found_after_s", run.found_after_s},
                {"named_after_s", run.named_after_s},
                {"authority_error", file::number(run.authority_error)},
                {"truth", of.truth.front().size},
                {"size", told.size},
                {"lower", told.lower},
                {"upper", told.upper}};
  });
  return file::json_text({{"format", "kelpie-diagnosis"},
                          {"seeds", study.seeds},
                          {"first_seed", study.first_seed},
                          {"after_s", study.after_s},
                          {"runs", runs},
                          {"nominal", nominal_json(study)}});
}

}  // namespace kelpie::lab
