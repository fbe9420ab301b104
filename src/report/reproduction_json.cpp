// SPDX-License-Identifier: Apache-2.0

#include "json_parts.hpp"
#include "kelpie/report/claims.hpp"
#include "kelpie/report/reproduction_report.hpp"
#include "kelpie/report/summary.hpp"

namespace kelpie {
namespace {

Json plan_json(const ReproductionPlan& plan) {
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

Json studied_axis_json(const AxisResult& axis) {
  const UpdateTimes times = update_times(axis);
  return {{"name", axis.name},
          {"r2",
           {{"final", number(axis.r2_final)},
            {"mean", number(axis.r2_mean)},
            {"min_after_1000", number(axis.r2_min_after_1000)}}},
          {"stages", list(axis.stages,
                          [](const StageEnd& stage) {
                            return Json{{"configuration", stage.configuration},
                                        {"samples", stage.samples},
                                        {"r2", number(stage.r2)}};
                          })},
          {"support_vectors", axis.status.support_vectors},
          {"buffer", axis.status.buffer},
          {"forgotten", axis.status.tally.forgotten},
          {"unserved", axis.status.tally.unserved},
          {"samples", list(axis.validation, [](const auto& p) { return Json(p.samples); })},
          {"validation_r2", list(axis.validation, [](const auto& p) { return number(p.r2); })},
          {"update_us", {{"median", number(times.median)}, {"p99", number(times.p99)}}}};
}

Json contender_json(const ContenderRuns& runs) {
  return {
      {"key", runs.key},
      {"name", runs.name},
      {"settings", runs.settings},
      {"seeds", list(runs.seeds, [](const auto& axes) { return list(axes, studied_axis_json); })}};
}

Json offline_json(const OfflineMatrix& matrix) {
  return {{"axis", matrix.axis}, {"models", list(matrix.models, [](const OfflineModel& model) {
                                    return Json{
                                        {"trained_on", model.trained_on},
                                        {"training_rows", model.training_rows},
                                        {"gamma", model.settings.gamma},
                                        {"c", model.settings.c},
                                        {"epsilon", model.settings.epsilon},
                                        {"cross_validated_r2", number(model.cross_validated_r2)},
                                        {"r2", numbers(model.r2)}};
                                  })}};
}

Json study_json(const StreamStudy& study) {
  return {{"stream", study.key},
          {"simulated", study.simulated},
          {"source", study.source},
          {"split", study.split},
          {"note", study.note},
          {"training_rows", study.training_rows},
          {"held_out_rows", study.held_out_rows},
          {"configurations", study.configurations},
          {"offline", list(study.offline, offline_json)},
          {"contenders", list(study.contenders, contender_json)}};
}

Json published_json(const PublishedRun& run) {
  return {{"name", run.name},
          {"settings", run.settings},
          {"mean", number(run.mean)},
          {"minimum", number(run.minimum)},
          {"end", number(run.end)},
          {"mean_from_1000", number(run.mean_late)},
          {"minimum_from_1000", number(run.minimum_late)},
          {"steps", run.steps},
          {"r2", numbers(run.r2)}};
}

Json peer_json(const PeerRun& run) {
  Json r2 = Json::object();
  for (std::size_t i = 0; i < kPeerMarks.size(); ++i) {
    r2[std::string(kPeerMarks[i])] = number(run.r2[i]);
  }
  return {{"stream", run.stream},
          {"learner", run.learner},
          {"r2", r2},
          {"update_us", {{"median", number(run.median_us)}, {"p99", number(run.p99_us)}}}};
}

Json claim_json(const Claim& claim) {
  return {{"claim", claim.paper},
          {"rule", claim.rule},
          {"where", claim.where},
          {"measured", claim.measured},
          {"finding", finding_text(claim.finding)}};
}

}  // namespace

std::string reproduction_json(const Reproduction& result) {
  const Json document = {{"format", "kelpie-reproduction"},
                         {"version", 1},
                         {"plan", plan_json(result.plan)},
                         {"real_log", result.real_log},
                         {"claims", list(claims_of(result), claim_json)},
                         {"streams", list(result.studies, study_json)},
                         {"published", list(result.published, published_json)},
                         {"peers", list(result.peers, peer_json)}};
  return document.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace kelpie
