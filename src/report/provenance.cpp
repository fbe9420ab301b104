// SPDX-License-Identifier: Apache-2.0
#include "report/provenance.hpp"

#include <fmt/format.h>

#include <cstdint>

#include "chart/page.hpp"
#include "chart/wording.hpp"
#include "kelpie/core/text.hpp"
#include "report/terms_text.hpp"
#include "study/alignment.hpp"

namespace kelpie::report {

std::string data_section(const study::StreamResult& result) {
  const auto rows = [](std::size_t n) { return chart::grouped(static_cast<std::int64_t>(n)); };
  const chart::Facts data = {
      {"log", result.source},
      {"rows", fmt::format("{} read, {} skipped (a NaN or infinity in a column in use)",
                           rows(result.rows_read), rows(result.rows_skipped))},
      {"rate", result.rate_hz > 0.0 ? fmt::format("{:.4g} Hz", result.rate_hz) : "unknown"},
      {"inputs", join_text(result.input_names, ", ")},
      {"split", result.split},
      {"rows for training", rows(result.training_rows)},
      {"rows held out", rows(result.held_out_rows)},
      {"alignment", result.alignment.why.empty()
                        ? "–"
                        : study::alignment_text(result.alignment, result.rate_hz)},
      {"physics terms", terms_text(result).empty() ? "–" : terms_text(result)},
      {"goes on from", result.from.empty() ? "–" : result.from},
      {"scales from", result.scales},
      {"seed", fmt::format("{}", result.seed)},
      {"ran to the end", result.interrupted ? fmt::format("no, interrupted after {} samples",
                                                          rows(result.samples_shown))
                                            : "yes"}};
  return chart::facts_table(data) +
         chart::paragraph(
             "note",
             "R² depends on how rows are held out. With rows picked at random, their "
             "neighbours in time are in the training data, which flatters every model; "
             "whole blocks of rows are the harder and more honest test.");
}

std::string settings_section(const study::StreamResult& result) {
  return result.settings.empty()
             ? ""
             : chart::facts_table({result.settings.begin(), result.settings.end()});
}

}  // namespace kelpie::report
