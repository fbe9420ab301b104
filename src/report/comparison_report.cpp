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

constexpr chart::PlotSize kStreamNarrow{400, 250};
constexpr chart::PlotSize kStreamWide{980, 330};
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

std::string comparison_section(const study::Comparison& comparison, const ComparedR2& r2) {
  const chart::TextTable table = comparison_view(comparison, r2);
  return "<h3>" + chart::escape_markup(table.title) + "</h3>\n" +
         chart::html_table(table.head, table.rows);
}

std::string comparison_figure(const study::Comparison& comparison, const ComparedR2& r2) {
  return chart::figure_of(comparison_panel(comparison, r2, kStreamWide.width),
                          comparison_panel(comparison, r2, kStreamNarrow.width));
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
  const std::string title =
      chart::shortened("kelpie beside simpler models on " + log, kLongestHeading);
  std::string body = "<h1>" + chart::escape_markup(title) + "</h1>\n";
  for (const std::string& paragraph : recommendation(comparison)) {
    body += chart::paragraph("lead", paragraph);
  }
  body += chart::paragraph("note", contenders_note(comparison)) +
          "<h2>At the end of the stream</h2>\n" + comparison_figure(comparison, kHeldOutR2) +
          comparison_section(comparison, kHeldOutR2) + comparison_section(comparison, kMeanR2) +
          "<h2>One step ahead</h2>\n" + comparison_figure(comparison, kOneStepR2) +
          comparison_section(comparison, kOneStepR2) + "<h2>Over the stream</h2>\n";
  for (std::size_t axis = 0; axis < kelpie.axes.size(); ++axis) {
    body += "<h3>" +
            chart::escape_markup(chart::shortened(kelpie.axes[axis].name, kLongestHeading)) +
            "</h3>\n" +
            chart::figure_of(contenders_panel(comparison, axis, kStreamWide),
                             contenders_panel(comparison, axis, kStreamNarrow));
  }
  return chart::html_page(title, body + provenance(kelpie));
}

}  // namespace kelpie::report
