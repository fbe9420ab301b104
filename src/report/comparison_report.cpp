// SPDX-License-Identifier: Apache-2.0
#include "report/comparison_report.hpp"

#include <array>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "chart/page.hpp"
#include "chart/text_table.hpp"
#include "chart/wording.hpp"
#include "file/json.hpp"
#include "format/result_json.hpp"
#include "report/comparison_views.hpp"
#include "report/provenance.hpp"
#include "report/recommendation.hpp"
#include "report/table.hpp"
#include "study/summary.hpp"

namespace kelpie::report {
namespace {

constexpr std::size_t kLongestHeading = 80;
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
  return {{"name", contest.name},
          {"kind", kContenderKinds[static_cast<std::size_t>(contest.kind)]},
          {"axes", file::list(contest.stream.axes, contest_axis_json)}};
}

}  // namespace

std::string comparison_table(const study::Comparison& comparison) {
  std::string text = heading_text(comparison.contests.front().stream);
  for (const ComparedR2& r2 : {kHeldOutR2, kMeanR2, kOneStepR2}) {
    text += chart::table_text(comparison_view(comparison, r2));
  }
  text += chart::wrapped(chart::printable(contenders_note(comparison))) + "\n\nRecommendation\n";
  for (const std::string& paragraph : recommendation(comparison)) {
    text += chart::wrapped(chart::printable(paragraph)) + "\n";
  }
  return text + "\n";
}

std::string comparison_json(const study::Comparison& comparison) {
  const study::StreamResult& kelpie = comparison.contests.front().stream;
  const file::Json document = {{"format", "kelpie-compare"},
                               {"version", 1},
                               {"dataset", format::dataset_json(kelpie)},
                               {"split", kelpie.split},
                               {"seed", kelpie.seed},
                               {"training_rows", kelpie.training_rows},
                               {"held_out_rows", kelpie.held_out_rows},
                               {"settings", file::object(kelpie.settings)},
                               {"contenders", file::list(comparison.contests, contest_json)},
                               {"one_step_samples", comparison.one_step_samples},
                               {"left_out", file::object(comparison.left_out)},
                               {"recommendation", recommendation(comparison)}};
  return file::json_text(document);
}

std::string comparison_html(const study::Comparison& comparison) {
  const study::StreamResult& kelpie = comparison.contests.front().stream;
  const std::string log = std::filesystem::path(kelpie.source).filename().string();
  const std::string title = "kelpie beside simpler models on " + log;
  std::string opening = chart::heading(1, title);
  for (const std::string& paragraph : recommendation(comparison)) {
    opening += chart::paragraph("lead", paragraph);
  }
  opening += chart::paragraph("note", contenders_note(comparison));
  const auto section = [&](const ComparedR2& r2) {
    return comparison_figure(comparison, r2) + chart::html_table(comparison_view(comparison, r2));
  };
  std::string over_time;
  for (std::size_t axis = 0; axis < kelpie.axes.size(); ++axis) {
    over_time += chart::heading(3, kelpie.axes[axis].name) + contenders_figure(comparison, axis);
  }
  return chart::html_page(chart::shortened(title, kLongestHeading), opening,
                          {{"At the end of the stream", section(kHeldOutR2)},
                           {"Mean over the stream", section(kMeanR2)},
                           {"One step ahead", section(kOneStepR2)},
                           {"Over the stream", over_time},
                           {"Data", data_section(kelpie)},
                           {"Settings", settings_section(kelpie)}});
}

}  // namespace kelpie::report
