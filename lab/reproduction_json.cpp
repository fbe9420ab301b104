// SPDX-License-Identifier: Apache-2.0

#include "format/json_parts.hpp"
#include "lab/claims.hpp"
#include "lab/reproduction_report.hpp"
#include "study/summary.hpp"

namespace kelpie::lab {
namespace {

format::Json plan_json(const ReproductionPlan& plan) {
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

format::Json studied_axis_json(const study::AxisResult& axis) {
  const study::Quantiles times = study::quantiles_of(axis.update_us);
  return {{"name", axis.name},
          {"r2",
           {{"final", format::number(axis.r2_final)},
            {"mean", format::number(axis.r2_mean)},
            {"min_after_1000", format::number(axis.r2_min_after_1000)}}},
          {"stages", format::list(axis.stages,
                                  [](const study::StageEnd& stage) {
                                    return format::Json{{"configuration", stage.configuration},
                                                        {"samples", stage.samples},
                                                        {"r2", format::number(stage.r2)}};
                                  })},
          {"support_vectors", axis.status.support_vectors},
          {"buffer", axis.status.buffer},
          {"forgotten", axis.status.tally.forgotten},
          {"unserved", axis.status.tally.unserved},
          {"samples",
           format::list(axis.validation, [](const auto& p) { return format::Json(p.samples); })},
          {"validation_r2",
           format::list(axis.validation, [](const auto& p) { return format::number(p.r2); })},
          {"update_us",
           {{"median", format::number(times.median)}, {"p99", format::number(times.p99)}}}};
}

format::Json contender_json(const ContenderRuns& runs) {
  return {{"key", runs.key},
          {"name", runs.name},
          {"settings", runs.settings},
          {"seeds", format::list(runs.seeds, [](const auto& axes) {
             return format::list(axes, studied_axis_json);
           })}};
}

format::Json offline_json(const OfflineMatrix& matrix) {
  return {{"axis", matrix.axis},
          {"models", format::list(matrix.models, [](const OfflineModel& model) {
             return format::Json{{"trained_on", model.trained_on},
                                 {"training_rows", model.training_rows},
                                 {"gamma", model.settings.gamma},
                                 {"c", model.settings.c},
                                 {"epsilon", model.settings.epsilon},
                                 {"cross_validated_r2", format::number(model.cross_validated_r2)},
                                 {"r2", format::numbers(model.r2)}};
           })}};
}

format::Json study_json(const StreamStudy& study) {
  return {{"stream", study.key},
          {"simulated", study.simulated},
          {"source", study.source},
          {"split", study.split},
          {"note", study.note},
          {"training_rows", study.training_rows},
          {"held_out_rows", study.held_out_rows},
          {"configurations", study.configurations},
          {"offline", format::list(study.offline, offline_json)},
          {"contenders", format::list(study.contenders, contender_json)}};
}

format::Json published_json(const PublishedRun& run) {
  return {{"name", run.name},
          {"settings", run.settings},
          {"mean", format::number(run.mean)},
          {"minimum", format::number(run.minimum)},
          {"end", format::number(run.end)},
          {"mean_from_1000", format::number(run.mean_late)},
          {"minimum_from_1000", format::number(run.minimum_late)},
          {"steps", run.steps},
          {"r2", format::numbers(run.r2)}};
}

format::Json peer_json(const PeerRun& run) {
  format::Json r2 = format::Json::object();
  for (std::size_t i = 0; i < kPeerMarks.size(); ++i) {
    r2[std::string(kPeerMarks[i])] = format::number(run.r2[i]);
  }
  return {{"stream", run.stream},
          {"learner", run.learner},
          {"r2", r2},
          {"update_us",
           {{"median", format::number(run.median_us)}, {"p99", format::number(run.p99_us)}}}};
}

format::Json claim_json(const Claim& claim) {
  return {{"claim", claim.paper},
          {"rule", claim.rule},
          {"where", claim.where},
          {"measured", claim.measured},
          {"finding", finding_text(claim.finding)}};
}

}  // namespace

std::string reproduction_json(const Reproduction& result) {
  const format::Json document = {{"format", "kelpie-reproduction"},
                                 {"version", 1},
                                 {"plan", plan_json(result.plan)},
                                 {"real_log", result.real_log},
                                 {"claims", format::list(claims_of(result), claim_json)},
                                 {"streams", format::list(result.studies, study_json)},
                                 {"published", format::list(result.published, published_json)},
                                 {"peers", format::list(result.peers, peer_json)}};
  return document.dump(1, ' ', false, format::Json::error_handler_t::replace) + "\n";
}

}  // namespace kelpie::lab
