// SPDX-License-Identifier: Apache-2.0
#include "lab/reproduction_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/quantile.hpp"
#include "kelpie/core/error.hpp"
#include "lab/claims.hpp"
#include "study/summary.hpp"

namespace kelpie::lab {
namespace {

using file::Json;

constexpr std::size_t kSettling = 1000;  // samples after the start and after a switch
constexpr std::size_t kShownRows = 200;  // of predictions, at the end of a configuration
constexpr std::array kRowKinds{"paper", "baseline", "addition", "kelpie", "entry"};

// Four digits, which is more than the seeds agree on.
Json rounded(double value) {
  return file::number(std::round(1e4 * value) / 1e4);
}

// Mean of the finite values, NaN without any.
double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const double value : values) {
    if (std::isfinite(value)) {
      sum += value;
      ++count;
    }
  }
  return count > 0 ? sum / static_cast<double>(count) : study::kUnknown;
}

// Mean, least and greatest R² of the seeds at every look of an axis.
Json curve_json(const RowRuns& runs, std::size_t axis) {
  Json curve{{"r2", Json::array()}, {"low", Json::array()}, {"high", Json::array()}};
  std::size_t looks = std::numeric_limits<std::size_t>::max();
  for (const SeedRun& seed : runs.seeds) {
    looks = std::min(looks, seed.axes[axis].validation.size());
  }
  for (std::size_t look = 0; look < looks; ++look) {
    std::vector<double> r2;
    for (const SeedRun& seed : runs.seeds) {
      r2.push_back(study::served_r2(seed.axes[axis].validation[look]));
    }
    const bool known = std::ranges::all_of(r2, [](double one) { return std::isfinite(one); });
    curve["r2"].push_back(rounded(known ? mean_of(r2) : study::kUnknown));
    if (runs.seeds.size() > 1) {
      curve["low"].push_back(rounded(known ? std::ranges::min(r2) : study::kUnknown));
      curve["high"].push_back(rounded(known ? std::ranges::max(r2) : study::kUnknown));
    }
  }
  return curve;
}

// R² at a switch, mean of axes and seeds: at the last look before, the lowest within 1,000 samples
// after, and at the end of the new stage.
Json switches_json(const RowRuns& runs) {
  Json switches = Json::array();
  const std::vector<study::StageEnd>& stages = runs.seeds.front().axes.front().stages;
  for (std::size_t stage = 1; stage < stages.size(); ++stage) {
    const std::size_t from = stages[stage - 1].samples;
    std::vector<double> before;
    std::vector<double> lowest;
    std::vector<double> end;
    for (const SeedRun& seed : runs.seeds) {
      for (const study::AxisResult& axis : seed.axes) {
        double least = HUGE_VAL;
        for (const study::ValidationPoint& point : axis.validation) {
          if (point.samples > from && point.samples <= from + kSettling) {
            least = std::fmin(least, point.r2);
          }
        }
        before.push_back(axis.stages[stage - 1].r2);
        lowest.push_back(least);
        end.push_back(axis.stages[stage].r2);
      }
    }
    switches.push_back({{"before", rounded(mean_of(before))},
                        {"lowest", rounded(mean_of(lowest))},
                        {"end", rounded(mean_of(end))}});
  }
  return switches;
}

// Whether a look lies in the settled part of its stage.
bool settled(const study::AxisResult& axis, std::size_t samples) {
  std::size_t begin = 0;
  for (const study::StageEnd& stage : axis.stages) {
    if (samples <= stage.samples) {
      break;
    }
    begin = stage.samples;
  }
  return samples >= begin + kSettling;
}

// Movement of R² from the first sample forgotten by `reference` on, without the 1,000 samples after
// the start and after each switch; mean of seeds and axes: root mean square of the change from look
// to look, and median less lowest look.
Json steadiness_json(const RowRuns& runs, const RowRuns& reference) {
  std::size_t looks = 0;
  std::vector<double> jitter;
  std::vector<double> deepest;
  for (std::size_t seed = 0; seed < runs.seeds.size(); ++seed) {
    for (std::size_t axis = 0; axis < runs.seeds[seed].axes.size(); ++axis) {
      const study::AxisResult& run = runs.seeds[seed].axes[axis];
      const auto& other = reference.seeds[seed].axes[axis].validation;
      std::vector<double> values;
      double squares = 0.0;
      std::size_t steps = 0;
      bool follows = false;
      for (std::size_t look = 0; look < std::min(run.validation.size(), other.size()); ++look) {
        const study::ValidationPoint& point = run.validation[look];
        const bool counts = other[look].status.tally.forgotten > 0 && settled(run, point.samples) &&
                            std::isfinite(point.r2);
        if (counts && follows) {
          squares += std::pow(point.r2 - values.back(), 2);
          ++steps;
        }
        if (counts) {
          values.push_back(point.r2);
        }
        follows = counts;
      }
      if (steps > 0) {
        looks += values.size();
        jitter.push_back(std::sqrt(squares / static_cast<double>(steps)));
        deepest.push_back(quantile(values, 0.5) - std::ranges::min(values));
      }
    }
  }
  return {{"looks", looks},
          {"jitter", file::number(mean_of(jitter))},
          {"deepest", rounded(mean_of(deepest))}};
}

double r2_after(const RowRuns& runs, std::size_t samples) {
  std::vector<double> values;
  for (const SeedRun& seed : runs.seeds) {
    for (const study::AxisResult& axis : seed.axes) {
      const auto found =
          std::ranges::find(axis.validation, samples, &study::ValidationPoint::samples);
      values.push_back(found == axis.validation.end() ? study::kUnknown : found->r2);
    }
  }
  return mean_of(values);
}

// The last rows of each configuration as predicted when it ended, with the first seed.
Json predictions_json(const RowRuns& runs) {
  return file::list(runs.seeds.front().axes, [](const study::AxisResult& axis) {
    return file::list(axis.stages, [](const study::StageEnd& stage) {
      const auto last = [](const std::vector<double>& values) {
        const std::size_t count = std::min(values.size(), kShownRows);
        return file::list(
            std::vector<double>(values.end() - static_cast<std::ptrdiff_t>(count), values.end()),
            [](double value) { return file::number(std::round(1e6 * value) / 1e6); });
      };
      return Json{{"time_s", last(stage.time_s)},
                  {"truth", last(stage.truth)},
                  {"predicted", last(stage.predicted)}};
    });
  });
}

Json row_json(const StreamStudy& study, const RowRuns& runs) {
  const SeedRun& first = runs.seeds.front();
  const bool small = runs.key.ends_with("_small");
  const auto fifo = std::ranges::find(study.rows, small ? "fifo_small" : "fifo", &RowRuns::key);
  const auto& looks = first.axes.front().validation;
  const auto of_axes = [&](auto value) {
    return file::list(first.axes,
                      [&](const study::AxisResult& axis) { return Json(value(axis.status)); });
  };
  // The curves that figures show.
  const bool shown = runs.kind == RowKind::paper || runs.kind == RowKind::kelpie ||
                     runs.kind == RowKind::entry || runs.key.starts_with("fifo") ||
                     runs.key == "sosvr";
  Json curves = Json::array();
  for (std::size_t axis = 0; shown && axis < first.axes.size(); ++axis) {
    curves.push_back(curve_json(runs, axis));
  }
  Json row{
      {"key", runs.key},
      {"kind", kRowKinds.at(static_cast<std::size_t>(runs.kind))},
      {"name", runs.name},
      {"settings", runs.settings},
      {"ends", file::list(runs.seeds,
                          [&](const SeedRun& seed) {
                            Json stages = Json::array();
                            for (std::size_t i = 0; i < first.axes.front().stages.size(); ++i) {
                              stages.push_back(file::list(seed.axes, [&](const auto& axis) {
                                return rounded(axis.stages[i].r2);
                              }));
                            }
                            return stages;
                          })},
      {"samples", file::list(looks, [](const auto& look) { return Json(look.samples); })},
      {"time_s", file::list(looks, [](const auto& look) { return Json(look.time_s); })},
      {"curves", curves},
      {"start", rounded(r2_after(runs, kSettling))},
      {"switches", switches_json(runs)},
      {"steady", steadiness_json(runs, fifo == study.rows.end() ? runs : *fifo)},
      {"support_vectors", of_axes([](const Status& status) { return status.support_vectors; })},
      {"buffer", of_axes([](const Status& status) { return status.buffer; })},
      {"forgotten", of_axes([](const Status& status) { return status.tally.forgotten; })},
      {"update_us",
       {{"median", file::number(first.update_us.median)},
        {"p99", file::number(first.update_us.p99)}}}};
  if (runs.key == "paper") {
    row["predictions"] = predictions_json(runs);
  }
  return row;
}

Json offline_json(const OfflineMatrix& matrix) {
  return {{"axis", matrix.axis},
          {"models", file::list(matrix.models, [](const OfflineModel& model) {
             return Json{{"trained_on", model.trained_on},
                         {"training_rows", model.training_rows},
                         {"gamma", model.settings.gamma},
                         {"c", model.settings.c},
                         {"epsilon", model.settings.epsilon},
                         {"cross_validated_r2", rounded(model.cross_validated_r2)},
                         {"r2", file::list(model.r2, rounded)}};
           })}};
}

Json found_json(const StreamStudy& study) {
  Json found = Json::object();
  for (std::size_t family = 0; family < study.found.size(); ++family) {
    found[searched_families()[family].key] =
        file::list(study.found[family], [](const FoundSettings& one) {
          return Json{{"values", file::object(one.values)},
                      {"cross_validated_r2", rounded(one.r2)},
                      {"runs", one.runs}};
        });
  }
  return found;
}

// Off-line models as a row: each on its own configuration.
Json offline_row(const StreamStudy& study, const char* key, const char* name,
                 const std::vector<OfflineMatrix>& matrices) {
  const auto& stages = study.rows.front().seeds.front().axes.front().stages;
  return {{"key", key},
          {"kind", "baseline"},
          {"name", name},
          {"settings", "γ, C and ε of each axis and configuration: the matrix of Fig. 3"},
          {"ends",
           Json::array({file::list(stages,
                                   [&](const study::StageEnd& stage) {
                                     const auto at = std::ranges::find(study.configurations,
                                                                       stage.configuration) -
                                                     study.configurations.begin();
                                     const auto place = static_cast<std::size_t>(at);
                                     return file::list(matrices, [&](const OfflineMatrix& matrix) {
                                       return rounded(matrix.models[place].r2[place]);
                                     });
                                   })})},
          {"update_us", {{"median", nullptr}, {"p99", nullptr}}}};
}

Json rows_json(const StreamStudy& study) {
  Json rows = file::list(study.rows, [&](const RowRuns& runs) { return row_json(study, runs); });
  if (!study.offline.empty()) {
    rows.push_back(offline_row(study, "offline", "off-line SVR", study.offline));
    rows.push_back(offline_row(study, "offline_terms", "off-line SVR with physics terms",
                               study.offline_terms));
  }
  return rows;
}

Json study_json(const StreamStudy& study) {
  const auto& stages = study.rows.front().seeds.front().axes.front().stages;
  return {{"stream", study.key},
          {"simulated", study.simulated},
          {"source", study.source},
          {"split", study::to_string(study.split_kind)},
          {"split_rule", study.split},
          {"note", study.note},
          {"rate_hz", study.rate_hz},
          {"training_rows", study.training_rows},
          {"held_out_rows", study.held_out_rows},
          {"configurations", study.configurations},
          {"axes", study.axes},
          {"stages", file::list(stages, [](const auto& s) { return Json(s.configuration); })},
          {"stage_samples", file::list(stages, [](const auto& s) { return Json(s.samples); })},
          {"found", found_json(study)},
          {"offline", file::list(study.offline, offline_json)},
          {"offline_terms", file::list(study.offline_terms, offline_json)},
          {"rows", rows_json(study)}};
}

Json plan_json(const ReproductionPlan& plan) {
  return {{"quick", plan.quick},
          {"scenario", plan.scenario},
          {"further", plan.further},
          {"first_seed", plan.first_seed},
          {"seeds", plan.seeds},
          {"further_seeds", std::min(plan.seeds, plan.further_seeds)},
          {"scenario_share", plan.scenario_share},
          {"further_share", plan.further_share},
          {"real_rows", plan.real_rows},
          {"validate_every", plan.validate_every},
          {"folds", plan.folds},
          {"entries", plan.entries},
          {"grid",
           {{"gamma", plan.grid.gamma},
            {"c", plan.grid.c},
            {"epsilon", plan.grid.epsilon},
            {"folds", plan.grid.folds},
            {"thin", plan.grid.thin}}}};
}

Json judgement_json(const Judgement& judged) {
  return {{"measured", judged.measured}, {"finding", finding_text(judged.finding)}};
}

}  // namespace

Json reproduction_document(const Reproduction& result) {
  Json document{{"format", "kelpie-reproduction"},
                {"version", 2},
                {"kelpie", result.plan.version},
                {"command", result.plan.command},
                {"plan", plan_json(result.plan)},
                {"real_log", result.real_log},
                {"streams", file::list(result.studies, study_json)}};
  judge_claims(document);
  return document;
}

void judge_claims(Json& document) {
  if (document.value("format", "") != "kelpie-reproduction" || document.value("version", 0) != 2) {
    throw InputError("format", "has to be kelpie-reproduction, version 2");
  }
  document["claims"] = file::list(claims_of(document), [](const Claim& claim) {
    return Json{
        {"claim", claim.text},
        {"rule", claim.rule},
        {"where", claim.where},
        {"paper", judgement_json(claim.paper)},
        {"kelpie", claim.kelpie.measured.empty() ? Json(nullptr) : judgement_json(claim.kelpie)}};
  });
}

}  // namespace kelpie::lab
