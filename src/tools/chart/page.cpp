// SPDX-License-Identifier: Apache-2.0
#include "chart/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "chart/page_assets.hpp"
#include "chart/wording.hpp"
#include "core/text.hpp"

namespace kelpie::chart {
namespace {

constexpr std::size_t kLongestTitle = 120;

// Whatever a page holds, it loads nothing and sends nothing, but for what `allowed` says.
constexpr const char* kPage =
    "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
    "script-src 'unsafe-inline'; style-src 'unsafe-inline'{allowed}\"/>\n"
    "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
    "<meta name=\"color-scheme\" content=\"light dark\"/>\n"
    "<title>{title}</title>\n<style>{library}{style}</style>\n</head>\n<body>\n"
    "{body}</body>\n</html>\n";

std::string lines_of(const std::string& cell) {
  std::vector<std::string> lines = split_text(cell, '\n');
  std::ranges::transform(lines, lines.begin(), escape_markup);
  return join_text(lines, "<br/>");
}

std::string row_of(const std::vector<std::string>& cells, std::string_view tag,
                   std::span<const std::size_t> left) {
  std::string text;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const bool is_left = i > 0 && std::ranges::find(left, i) != left.end();  // the first always is
    text +=
        fmt::format("<{0}{1}>{2}</{0}>", tag, is_left ? " class=\"left\"" : "", lines_of(cells[i]));
  }
  return "<tr>" + text + "</tr>\n";
}

std::string scripts() {
  return kLibraryScript.empty()
             ? paragraph("note", "This kelpie was built without uPlot, which draws the figures.")
             : fmt::format(
                   "<details><summary class=\"note\">Figures are drawn with uPlot</summary>\n"
                   "<p "
                   "class=\"note\">{}</p></details>\n<script>{}</script>\n<script>\n{}</script>\n",
                   lines_of(std::string(kLibraryLicence)), kLibraryScript, kFigureScript);
}

std::string whole_page(const std::string& title, const std::string& body, const char* allowed) {
  return fmt::format(kPage, fmt::arg("allowed", allowed),
                     fmt::arg("title", escape_markup(shortened(title, kLongestTitle))),
                     fmt::arg("library", kLibraryStyle), fmt::arg("style", kPageStyle),
                     fmt::arg("body", body));
}

}  // namespace

std::string html_page(const std::string& title, const std::string& opening,
                      const std::vector<Section>& sections) {
  std::string links;
  std::string body;
  bool has_folded = false;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    if (!sections[i].body.empty()) {
      const auto& [name, html, folded] = sections[i];
      if (!folded || !has_folded) {  // the folded sections are their own table of contents
        links +=
            fmt::format("<a href=\"#s{}\">{}</a>\n", i, folded ? "Details" : escape_markup(name));
      }
      has_folded = has_folded || folded;
      body +=
          folded ? fmt::format(
                       "<details class=\"section\" id=\"s{}\">\n<summary>{}</summary>\n"
                       "{}</details>\n",
                       i, escape_markup(name), html)
                 : fmt::format("<section id=\"s{}\">\n{}{}</section>\n", i, heading(2, name), html);
    }
  }
  return whole_page(title,
                    fmt::format("{}<nav aria-label=\"contents\">\n{}</nav>\n{}{}", opening, links,
                                body, scripts()),
                    "");
}

std::string live_page(const std::string& title, const std::string& body, std::string_view script) {
  return whole_page(title, fmt::format("{}{}<script>\n{}</script>\n", body, scripts(), script),
                    "; connect-src 'self'; base-uri 'none'; form-action 'none'");
}

std::string heading(int level, std::string_view text) {
  return fmt::format("<h{0} dir=\"auto\">{1}</h{0}>\n", level,
                     escape_markup(shortened(text, kLongestTitle)));
}

std::string paragraph(std::string_view css_class, const std::string& text) {
  return fmt::format("<p class=\"{}\">{}</p>\n", css_class, escape_markup(text));
}

std::string panels(const std::vector<std::string>& figures) {
  std::string text;
  for (const std::string& figure : figures) {
    text += "<div>\n" + figure + "</div>\n";
  }
  return "<div class=\"panels\">\n" + text + "</div>\n";
}

std::string columns(const std::string& left, const std::string& right) {
  return "<div class=\"columns\">\n<div>\n" + left + "</div>\n<div>\n" + right + "</div>\n</div>\n";
}

std::string command_lines(const Facts& commands) {
  std::string items;
  for (const auto& [command, purpose] : commands) {
    items += R"(<li><div class="scroll" tabindex="0"><code>)" + escape_markup(command) +
             "</code></div> " + escape_markup(purpose) + "</li>\n";
  }
  return items.empty() ? "" : "<ul class=\"next\">\n" + items + "</ul>\n";
}

std::string folded(const std::string& summary, const std::string& html) {
  return "<details><summary>" + escape_markup(summary) + "</summary>\n" + html + "</details>\n";
}

std::string facts_table(const Facts& facts) {
  std::string rows;
  for (const auto& [name, value] : facts) {
    rows += "<tr><th scope=\"row\">" + escape_markup(name) + "</th><td dir=\"auto\">" +
            escape_markup(value) + "</td></tr>\n";
  }
  return "<table class=\"facts\">\n<tbody>\n" + rows + "</tbody>\n</table>\n";
}

std::string html_table(const std::vector<std::string>& head,
                       const std::vector<std::vector<std::string>>& rows,
                       std::string_view css_class, std::span<const std::size_t> left) {
  std::string body;
  for (const std::vector<std::string>& cells : rows) {
    body += row_of(cells, "td", left);
  }
  return fmt::format(
      "<div class=\"scroll\" tabindex=\"0\">\n<table class=\"{}\">\n<thead>{}</thead>\n<tbody>\n{}"
      "</tbody>\n</table>\n</div>\n",
      css_class, row_of(head, "th", left), body);
}

std::string interval_table(const std::vector<IntervalRow>& rows) {
  std::string body;
  for (const IntervalRow& row : rows) {
    // In % of the bar's length; the value itself is in its middle.
    const auto place = [&](double value) {
      return std::clamp(50.0 * value / row.value, 0.0, 100.0);
    };
    const auto [from, to] = std::minmax({place(row.low), place(row.high)});
    const bool is_known = row.value != 0.0 && std::isfinite(row.low) && std::isfinite(row.high);
    const std::string bar =
        is_known
            ? fmt::format(R"(<span class="bar"><i style="left:{:.1f}%;width:{:.1f}%"></i></span>)",
                          from, std::max(to - from, 1.0))
            : "";
    body += fmt::format(
        "<tr><th scope=\"row\" dir=\"auto\">{}</th><td>{}</td><td>{}</td><td "
        "class=\"left\">{}</td></tr>\n",
        escape_markup(row.name), escape_markup(row.text), bar, escape_markup(row.note));
  }
  return "<div class=\"scroll\" tabindex=\"0\">\n<table class=\"intervals\">\n<thead><tr><th></th>"
         "<th>value</th><th class=\"left\">90 % interval, from 0 to twice the "
         "value</th><th></th></tr>"
         "</thead>\n<tbody>\n" +
         body + "</tbody>\n</table>\n</div>\n";
}

std::string html_table(const TextTable& table) {
  if (table.rows.empty()) {
    return "";
  }
  const bool words = table.left.size() == table.head.size();
  std::string text = html_table(table.head, table.rows, words ? "words" : "", table.left);
  for (const std::string& note : table.notes) {
    text += paragraph("note", note);
  }
  return text;
}

std::string html_tables(const std::vector<TextTable>& tables) {
  std::string text;
  for (const TextTable& table : tables) {
    text += (table.title.empty() ? "" : heading(3, table.title)) + html_table(table);
  }
  return text;
}

}  // namespace kelpie::chart
