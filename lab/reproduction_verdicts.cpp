// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "chart/page.hpp"
#include "chart/wording.hpp"
#include "kelpie/model/settings.hpp"
#include "lab/claims.hpp"
#include "lab/reproduction_sections.hpp"

namespace kelpie::lab {

std::string parameters_section() {
  constexpr std::array kTableOne{"epsilon", "c", "gamma", "buffer", "k", "a", "b", "xi"};
  constexpr std::array kPrinted{"0.1, 0.001, 0.1", "10, 10, 10", "100, 40, 20", "900, 900, 900",
                                "10, 10, 1",       "0.99",       "0.01",        "0.99"};
  std::vector<std::vector<std::string>> rows;
  const auto paper = std::ranges::find(preset_names(), "paper") - preset_names().begin();
  for (const SettingText& doc : setting_docs()) {
    const auto* const found = std::ranges::find(kTableOne, doc.name);
    rows.push_back({doc.name, doc.presets.at(0), doc.presets.at(static_cast<std::size_t>(paper)),
                    found == kTableOne.end()
                        ? "–"
                        : kPrinted.at(static_cast<std::size_t>(found - kTableOne.begin()))});
  }
  return chart::paragraph(
             "note",
             "Surge, sway, yaw. γ as eq. (6) has it, κ = exp(−γ d²); the table's 100, 40, 20 "
             "make a kernel so narrow that only neighbours in time help, and work when read "
             "as κ = exp(−d²/γ): the preset holds the reciprocals.") +
         chart::html_table({"setting", "ours (default)", "paper's preset", "printed in Table I"},
                           rows, "words");
}

std::string claims_section(const Reproduction& result) {
  std::string body;
  std::string last;
  for (const Claim& claim : claims_of(result)) {
    if (claim.paper != last) {
      body += fmt::format("<tr><td colspan=\"3\"><strong>{}</strong><br/>{}</td></tr>\n",
                          chart::escape_markup(claim.paper),
                          chart::escape_markup("Rule: " + claim.rule));
      last = claim.paper;
    }
    const char* const css = claim.finding == ClaimState::holds     ? "holds"
                            : claim.finding == ClaimState::in_part ? "part"
                            : claim.finding == ClaimState::fails   ? "fails"
                                                                   : "note";
    body += fmt::format("<tr><td>{}</td><td>{}</td><td class=\"verdict {}\">{}</td></tr>\n",
                        chart::escape_markup(claim.where), chart::escape_markup(claim.measured),
                        css, finding_text(claim.finding));
  }
  return chart::paragraph(
             "note",
             "The verdicts are computed from the figures by the rule beside each claim; the "
             "rules are ours, the paper gives no thresholds.") +
         "<div class=\"scroll\">\n<table class=\"words\">\n<thead><tr><th>where</th>"
         "<th>measured</th><th>verdict</th></tr></thead>\n<tbody>\n" +
         body + "</tbody>\n</table>\n</div>\n";
}

}  // namespace kelpie::lab
