// SPDX-License-Identifier: Apache-2.0
#include "format/comparison_json.hpp"

#include <array>
#include <string_view>

#include "file/json.hpp"
#include "format/result_json.hpp"
#include "study/summary.hpp"

namespace kelpie::format {
namespace {

constexpr std::array<std::string_view, 5> kContenderKinds{
    "kelpie", "variant", "least_squares", "mean", "last_value"};  // as ContenderKind counts

file::Json contest_axis_json(const study::AxisResult& axis) {
  using Point = study::ValidationPoint;
  return {{"name", axis.name},
          {"r2", {{"final", file::number(axis.r2_final)}, {"mean", file::number(axis.r2_mean)}}},
          {"prequential_r2", file::number(axis.prequential_r2)},
          {"validation",
           {{"samples",
             file::list(axis.validation, [](const Point& p) { return file::Json(p.samples); })},
            {"r2", file::list(axis.validation,
                              [](const Point& p) { return file::number(study::served_r2(p)); })}}}};
}

file::Json contest_json(const study::Contest& contest) {
  file::Json json = {{"name", contest.name},
                     {"kind", kContenderKinds[static_cast<std::size_t>(contest.kind)]},
                     {"axes", file::list(contest.stream.axes, contest_axis_json)}};
  if (!contest.inner_gains.empty()) {
    json["inner_gains"] = file::list(contest.inner_gains, file::number);
  }
  return json;
}

}  // namespace

std::string comparison_json(const study::Comparison& comparison,
                            const std::vector<std::string>& recommendation) {
  const study::StreamResult& kelpie = comparison.contests.front().stream;
  const file::Json document = {{"format", "kelpie-compare"},
                               {"version", 1},
                               {"dataset", dataset_json(kelpie)},
                               {"split", kelpie.split},
                               {"seed", kelpie.seed},
                               {"training_rows", kelpie.training_rows},
                               {"held_out_rows", kelpie.held_out_rows},
                               {"settings", file::object(kelpie.settings)},
                               {"contenders", file::list(comparison.contests, contest_json)},
                               {"one_step_samples", comparison.one_step_samples},
                               {"left_out", file::object(comparison.left_out)},
                               {"recommendation", recommendation}};
  return file::json_text(document);
}

}  // namespace kelpie::format
