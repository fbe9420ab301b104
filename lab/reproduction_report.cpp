// SPDX-License-Identifier: Apache-2.0
#include "lab/reproduction_report.hpp"

#include <fmt/format.h>

#include <array>
#include <string>
#include <vector>

#include "chart/text_table.hpp"
#include "chart/wording.hpp"
#include "file/json.hpp"
#include "lab/claims.hpp"
#include "lab/reproduction_views.hpp"
#include "study/summary.hpp"

namespace kelpie::lab {
namespace {

std::string study_text(const StreamStudy& study) {
  chart::TextTable table{
      fmt::format("{}, {}: R² at the end of each configuration, mean of the axes", study.key,
                  study.split),
      {""},
      {}};
  const auto add_row = [&](const std::string& name, auto r2_of_stage) {
    std::vector<std::string>& row = table.rows.emplace_back(1, name);
    for (std::size_t stage = 0; stage < stages_of(study); ++stage) {
      row.push_back(chart::decimal(r2_of_stage(stage)));
    }
  };
  for (std::size_t stage = 0; stage < stages_of(study); ++stage) {
    table.head.push_back(fmt::format("{}", stage + 1));
  }
  if (!study.offline.empty()) {
    add_row("off-line baseline", [&](std::size_t stage) { return mean_baseline_r2(study, stage); });
  }
  for (const ContenderRuns& runs : study.contenders) {
    add_row(runs.name, [&](std::size_t stage) { return mean_stage_r2(runs, stage); });
  }
  return chart::table_text(table);
}

file::Json plan_json(const ReproductionPlan& plan) {
  return {{"quick", plan.quick},
          {"scenario", plan.scenario},
          {"further", plan.further},
          {"first_seed", plan.first_seed},
          {"seeds", plan.seeds},
          {"further_seeds", plan.further_seeds},
          {"paper_seeds", plan.paper_seeds},
          {"scenario_share", plan.scenario_share},
          {"further_share", plan.further_share},
          {"real_rows", plan.real_rows},
          {"validate_every", plan.validate_every},
          {"published_every", plan.published_every},
          {"small_buffer", plan.small_buffer},
          {"grid",
           {{"gamma", plan.grid.gamma},
            {"c", plan.grid.c},
            {"epsilon", plan.grid.epsilon},
            {"folds", plan.grid.folds},
            {"thin", plan.grid.thin}}}};
}

file::Json studied_axis_json(const study::AxisResult& axis) {
  const study::Quantiles times = study::quantiles_of(axis.update_us);
  return {
      {"name", axis.name},
      {"r2",
       {{"final", file::number(axis.r2_final)},
        {"mean", file::number(axis.r2_mean)},
        {"min_after_1000", file::number(axis.r2_min_after_1000)}}},
      {"stages", file::list(axis.stages,
                            [](const study::StageEnd& stage) {
                              return file::Json{{"configuration", stage.configuration},
                                                {"samples", stage.samples},
                                                {"r2", file::number(stage.r2)}};
                            })},
      {"support_vectors", axis.status.support_vectors},
      {"buffer", axis.status.buffer},
      {"forgotten", axis.status.tally.forgotten},
      {"unserved", axis.status.tally.rejected_by_tolerance},
      {"samples", file::list(axis.validation, [](const auto& p) { return file::Json(p.samples); })},
      {"validation_r2",
       file::list(axis.validation, [](const auto& p) { return file::number(p.r2); })},
      {"update_us", {{"median", file::number(times.median)}, {"p99", file::number(times.p99)}}}};
}

file::Json contender_json(const ContenderRuns& runs) {
  return {{"key", runs.key},
          {"name", runs.name},
          {"settings", runs.settings},
          {"seeds", file::list(runs.seeds, [](const auto& axes) {
             return file::list(axes, studied_axis_json);
           })}};
}

file::Json offline_json(const OfflineMatrix& matrix) {
  return {{"axis", matrix.axis},
          {"models", file::list(matrix.models, [](const OfflineModel& model) {
             return file::Json{{"trained_on", model.trained_on},
                               {"training_rows", model.training_rows},
                               {"gamma", model.settings.gamma},
                               {"c", model.settings.c},
                               {"epsilon", model.settings.epsilon},
                               {"cross_validated_r2", file::number(model.cross_validated_r2)},
                               {"r2", file::numbers(model.r2)}};
           })}};
}

file::Json study_json(const StreamStudy& study) {
  return {{"stream", study.key},
          {"simulated", study.simulated},
          {"source", study.source},
          {"split", study.split},
          {"note", study.note},
          {"training_rows", study.training_rows},
          {"held_out_rows", study.held_out_rows},
          {"configurations", study.configurations},
          {"offline", file::list(study.offline, offline_json)},
          {"contenders", file::list(study.contenders, contender_json)}};
}

file::Json published_json(const PublishedRun& run) {
  return {{"name", run.name},
          {"settings", run.settings},
          {"mean", file::number(run.mean)},
          {"minimum", file::number(run.minimum)},
          {"end", file::number(run.end)},
          {"mean_from_1000", file::number(run.mean_late)},
          {"minimum_from_1000", file::number(run.minimum_late)},
          {"steps", run.steps},
          {"r2", file::numbers(run.r2)}};
}

file::Json peer_json(const PeerRun& run) {
  file::Json r2 = file::Json::object();
  for (std::size_t i = 0; i < kPeerMarks.size(); ++i) {
    r2[std::string(kPeerMarks[i])] = file::number(run.r2[i]);
  }
  return {
      {"stream", run.stream},
      {"learner", run.learner},
      {"r2", r2},
      {"update_us", {{"median", file::number(run.median_us)}, {"p99", file::number(run.p99_us)}}}};
}

file::Json claim_json(const Claim& claim) {
  return {{"claim", claim.paper},
          {"rule", claim.rule},
          {"where", claim.where},
          {"measured", claim.measured},
          {"finding", finding_text(claim.finding)}};
}

}  // namespace

std::string reproduction_table(const Reproduction& result) {
  std::string text;
  for (const StreamStudy& study : result.studies) {
    text += study_text(study);
  }
  for (const PublishedRun& run : result.published) {
    text += fmt::format("published protocol, buffer {}: {} mean {}, minimum {}, end {}\n",
                        kPublishedBuffer, run.name, chart::decimal(run.mean),
                        chart::decimal(run.minimum), chart::decimal(run.end));
  }
  std::array<std::size_t, 4> counts{};
  for (const Claim& claim : claims_of(result)) {
    ++counts.at(static_cast<std::size_t>(claim.finding));
  }
  return text + fmt::format(
                    "claims of the paper, each on each stream and split:\n"
                    "{} hold, {} hold in part, {} do not hold, {} could not be judged\n",
                    counts[0], counts[1], counts[2], counts[3]);
}

std::string reproduction_json(const Reproduction& result) {
  const file::Json document = {{"format", "kelpie-reproduction"},
                               {"version", 1},
                               {"plan", plan_json(result.plan)},
                               {"real_log", result.real_log},
                               {"claims", file::list(claims_of(result), claim_json)},
                               {"streams", file::list(result.studies, study_json)},
                               {"published", file::list(result.published, published_json)},
                               {"peers", file::list(result.peers, peer_json)}};
  return file::json_text(document, 1);
}

}  // namespace kelpie::lab
