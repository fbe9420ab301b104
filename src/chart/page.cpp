// SPDX-License-Identifier: Apache-2.0
#include "chart/page.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "chart/figure.hpp"
#include "chart/page_style.hpp"
#include "chart/wording.hpp"
#include "kelpie/core/text.hpp"

namespace kelpie::chart {
namespace {

std::string caption_of(const Panel& panel) {
  return panel.caption.empty()
             ? ""
             : fmt::format("<figcaption>{}</figcaption>\n", escape_markup(panel.caption));
}

std::string lines_of(const std::string& cell) {
  std::vector<std::string> lines = split_text(cell, '\n');
  std::ranges::transform(lines, lines.begin(), escape_markup);
  return join_text(lines, "<br/>");
}

std::string row_of(const std::vector<std::string>& cells, std::string_view tag) {
  std::string text;
  for (const std::string& cell : cells) {
    text += fmt::format("<{0}>{1}</{0}>", tag, lines_of(cell));
  }
  return "<tr>" + text + "</tr>\n";
}

}  // namespace

std::string html_page(const std::string& title, const std::string& body) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
         "<meta name=\"color-scheme\" content=\"light dark\"/>\n<title>" +
         escape_markup(title) + "</title>\n<style>" + std::string(kPageStyle) + figure_style() +
         "</style>\n</head>\n<body>\n" + body + "</body>\n</html>\n";
}

std::string paragraph(std::string_view css_class, const std::string& text) {
  return fmt::format("<p class=\"{}\">{}</p>\n", css_class, escape_markup(text));
}

std::string figure_of(const Panel& panel) {
  return "<figure>\n" + panel.svg + caption_of(panel) + "</figure>\n";
}

// Two drawings of one figure: scaling the wide one to a phone would make its text too small.
std::string figure_of(const Panel& wide, const Panel& narrow) {
  return "<figure>\n<div class=\"wide\">\n" + wide.svg + "</div>\n<div class=\"narrow\">\n" +
         narrow.svg + "</div>\n" + caption_of(wide) + "</figure>\n";
}

std::string facts_table(const Facts& facts) {
  std::string rows;
  for (const auto& [name, value] : facts) {
    rows += "<tr><th scope=\"row\">" + escape_markup(name) + "</th><td>" + escape_markup(value) +
            "</td></tr>\n";
  }
  return "<table class=\"facts\">\n<tbody>\n" + rows + "</tbody>\n</table>\n";
}

std::string html_table(const std::vector<std::string>& head,
                       const std::vector<std::vector<std::string>>& rows,
                       std::string_view css_class) {
  std::string body;
  for (const std::vector<std::string>& cells : rows) {
    body += row_of(cells, "td");
  }
  return fmt::format(
      "<div class=\"scroll\">\n<table class=\"{}\">\n<thead>{}</thead>\n<tbody>\n{}</tbody>\n"
      "</table>\n</div>\n",
      css_class, row_of(head, "th"), body);
}

}  // namespace kelpie::chart
