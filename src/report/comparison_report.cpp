// SPDX-License-Identifier: Apache-2.0
#include "report/comparison_report.hpp"

#include <filesystem>

#include "chart/page.hpp"
#include "chart/text_table.hpp"
#include "chart/wording.hpp"
#include "report/comparison_views.hpp"
#include "report/provenance.hpp"
#include "report/recommendation.hpp"
#include "report/table.hpp"

namespace kelpie::report {
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
  return chart::html_page(title, opening,
                          {{"At the end of the stream", section(kHeldOutR2)},
                           {"Mean over the stream", section(kMeanR2)},
                           {"One step ahead", section(kOneStepR2)},
                           {"Over the stream", over_time},
                           {"Data", data_section(kelpie)},
                           {"Settings", settings_section(kelpie)}});
}

}  // namespace kelpie::report
