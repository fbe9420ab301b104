// SPDX-License-Identifier: Apache-2.0
#include "report/provenance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "chart/page.hpp"
#include "chart/wording.hpp"
#include "core/text.hpp"
#include "kelpie/motion/attitude.hpp"
#include "kelpie/motion/term_set.hpp"
#include "motion/states.hpp"
#include "study/alignment.hpp"
#include "study/current.hpp"

namespace kelpie::report {
namespace {

std::string setting(const study::StreamResult& result, std::string_view name) {
  const auto found =
      std::ranges::find(result.settings, name, [](const auto& s) { return s.first; });
  return found == result.settings.end() ? "" : found->second;
}

std::string meaning_of(const std::string& terms, const TermSet& set,
                       std::span<const std::string> inputs) {
  const bool automatic = terms == TermSet::kAuto || terms == TermSet::kAutoDegrees;
  if (!automatic && terms != "quadratic") {
    return "";
  }
  const std::size_t factors = inputs.size() - set.attitude().size();
  const bool all = set.size() >= 2 * factors + factors * (factors - 1) / 2;
  std::string text = all ? ": x, x|x|, all products" : ": x, x|x|, products of velocities";
  const Attitude attitude = find_attitude(inputs);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (attitude.contains(i)) {
      names.push_back(inputs[i]);
    }
  }
  if (names.empty()) {
    return text;
  }
  return text + (automatic ? ", restoring terms of " : "; as commands: ") + join_text(names, ", ") +
         (terms == TermSet::kAutoDegrees ? " in degrees" : "");
}

}  // namespace

std::string terms_text(const study::StreamResult& result) {
  const std::string terms = setting(result, "terms");
  const std::string states = setting(result, "states");
  if (terms.empty() || states.empty()) {
    return "";
  }
  const TermSet set = TermSet::from(terms, result.input_names, result.axes.size());
  std::vector<std::string> names;
  for (const std::size_t state : find_states(states, result.input_names, result.axes.size())) {
    names.push_back(result.input_names[state]);
  }
  const std::string velocities = names.empty() ? "velocities: none known (states = " + states + ")"
                                               : "velocities: " + join_text(names, ", ") +
                                                     (states == "auto" ? " (by their names)" : "");
  return fmt::format("{} physics terms (terms = {}{}); {}", set.size(), terms,
                     meaning_of(terms, set, result.input_names), velocities);
}

std::string data_section(const study::StreamResult& result) {
  const chart::Facts data = {
      {"log", result.source},
      {"rows", fmt::format("{} read, {} skipped (a NaN or infinity in a column in use)",
                           chart::grouped(result.rows_read), chart::grouped(result.rows_skipped))},
      {"rate", result.rate_hz > 0.0 ? fmt::format("{:.4g} Hz", result.rate_hz) : "unknown"},
      {"inputs", join_text(result.input_names, ", ")},
      {"split", result.split},
      {"rows for training", chart::grouped(result.training_rows)},
      {"rows held out", chart::grouped(result.held_out_rows)},
      {"alignment", result.alignment.why.empty()
                        ? "–"
                        : study::alignment_text(result.alignment, result.rate_hz)},
      {"current", result.current.why.empty() ? "–" : study::current_text(result.current)},
      {"physics terms", terms_text(result).empty() ? "–" : terms_text(result)},
      {"goes on from", result.from.empty() ? "–" : result.from},
      {"scales from", result.scales},
      {"seed", fmt::format("{}", result.seed)},
      {"ran to the end", result.interrupted ? fmt::format("no, interrupted after {} samples",
                                                          chart::grouped(result.samples_shown))
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
