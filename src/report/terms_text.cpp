// SPDX-License-Identifier: Apache-2.0
#include "report/terms_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "kelpie/core/text.hpp"
#include "kelpie/physics/states.hpp"
#include "kelpie/physics/term_set.hpp"

namespace kelpie::report {
namespace {

std::string setting(const study::StreamResult& result, std::string_view name) {
  const auto found =
      std::ranges::find(result.settings, name, [](const auto& s) { return s.first; });
  return found == result.settings.end() ? "" : found->second;
}

std::string meaning_of(const std::string& terms, const TermSet& set, std::size_t inputs) {
  if (terms != "auto" && terms != "quadratic") {
    return "";
  }
  const bool all = set.size() == 2 * inputs + inputs * (inputs - 1) / 2;
  return all ? ": x, x|x|, all products" : ": x, x|x|, products of velocities";
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
                     meaning_of(terms, set, result.input_names.size()), velocities);
}

}  // namespace kelpie::report
