// SPDX-License-Identifier: Apache-2.0
#include "chart/figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "chart/columns.hpp"
#include "chart/wording.hpp"

namespace kelpie::chart {
namespace {

using nlohmann::json;

constexpr std::size_t kLongestText = 120;

json axis_json(const PlotAxis& axis) {
  json object = {{"label", shortened(axis.label, kLongestText)},
                 {"log", axis.kind == ScaleKind::logarithmic}};
  if (axis.range) {
    object["range"] = {axis.range->low, axis.range->high};
  }
  for (const std::string& name : axis.names) {
    object["names"].push_back(shortened(name, kLongestText));
  }
  return object;
}

std::vector<double> part(std::span<const Point> points, double Point::*of) {
  std::vector<double> values(points.size());
  std::ranges::transform(points, values.begin(), of);
  return values;
}

}  // namespace

Extent range_of(std::span<const double> values) {
  bool any = false;
  Extent range;
  for (const double value : values) {
    if (std::isfinite(value)) {
      range = any ? Extent{std::min(range.low, value), std::max(range.high, value)}
                  : Extent{value, value};
      any = true;
    }
  }
  return range;
}

struct Figure::Parts {
  json* add(const char* kind, std::span<const Point> points, std::size_t style,
            const std::string& name);

  json spec;
  Columns columns{};
  std::string said{};  // what stands in the figure's place
};

Figure::Figure(const PlotAxis& x, const PlotAxis& y, const std::string& description)
    : parts_(std::make_unique<Parts>(
          Parts{.spec = {{"label", shortened(description, kLongestText) + "."},
                         {"x", axis_json(x)},
                         {"y", axis_json(y)},
                         {"series", json::array()},
                         {"marks", json::array()},
                         {"guides", json::array()}}})) {}
Figure::Figure(Figure&&) noexcept = default;
Figure& Figure::operator=(Figure&&) noexcept = default;
Figure::~Figure() = default;

void Figure::link(const std::string& group) {
  parts_->spec["link"] = group;
}

void Figure::make_square() {
  parts_->spec["square"] = true;
}

void Figure::begin_at(Extent window) {
  parts_->spec["start"] = {window.low, window.high};
}

void Figure::errors_below(const std::string& a, const std::string& b, const std::string& label) {
  parts_->spec["errors"] = {{"of", a}, {"from", b}, {"label", shortened(label, kLongestText)}};
}

json* Figure::Parts::add(const char* kind, std::span<const Point> points, std::size_t style,
                         const std::string& name) {
  std::vector<Point> kept;
  std::ranges::copy_if(points, std::back_inserter(kept),
                       [](const Point& point) { return std::isfinite(point.x); });
  std::vector<double> y = part(kept, &Point::y);
  if (std::ranges::none_of(y, [](double value) { return std::isfinite(value); })) {
    return nullptr;
  }
  const Extent range = range_of(y);
  said += fmt::format("{}{}from {} to {}", said.empty() ? "" : "; ",
                      name.empty() ? "" : shortened(name, kLongestText) + " ",
                      significant(range.low), significant(range.high));
  const std::size_t x = columns.add(part(kept, &Point::x), true);
  return &spec["series"].emplace_back(json{{"kind", kind},
                                           {"name", shortened(name, kLongestText)},
                                           {"style", style},
                                           {"x", x},
                                           {"y", columns.add(std::move(y))}});
}

void Figure::line(std::span<const Point> points, std::size_t style, const std::string& name) {
  parts_->add("line", points, style, name);
}

void Figure::markers(std::span<const Point> points, std::size_t style, const std::string& name) {
  parts_->add("points", points, style, name);
}

void Figure::dots(std::span<const Point> points, std::size_t style, const std::string& name) {
  std::vector<Point> sorted(points.begin(), points.end());
  std::ranges::stable_sort(sorted, {}, &Point::x);
  if (json* const series = parts_->add("points", sorted, style, name)) {
    (*series)["small"] = true;
  }
}

void Figure::bars(std::span<const Point> points, std::size_t style, const std::string& name) {
  parts_->add("bars", points, style, name);
}

void Figure::band(std::span<const Point> middle, std::span<const double> half, std::size_t style,
                  const std::string& name) {
  std::vector<Point> shown(middle.begin(), middle.end());
  std::vector<double> halves;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    if (std::isfinite(shown[i].x)) {
      halves.push_back(half[i]);
    }
  }
  if (std::ranges::none_of(halves, [](double value) { return std::isfinite(value); })) {
    return;
  }
  const std::string before = parts_->said;
  if (json* const series = parts_->add("band", shown, style, name)) {
    (*series)["half"] = parts_->columns.add(std::move(halves));
  }
  parts_->said = before;  // its middle is a line's
}

void Figure::mark(double x, const std::string& label) {
  if (std::isfinite(x)) {
    parts_->spec["marks"].push_back({{"x", x}, {"name", shortened(label, kLongestText)}});
  }
}

void Figure::reference(Point from, Point to) {
  parts_->spec["guides"].push_back({from.x, from.y, to.x, to.y});
}

std::string Figure::html(const std::string& caption) const {
  json spec = parts_->spec;
  std::stable_sort(spec["marks"].begin(), spec["marks"].end(),
                   [](const json& a, const json& b) { return a["x"] < b["x"]; });
  const std::string below =
      caption.empty() ? "" : "<figcaption>" + escape_markup(caption) + "</figcaption>\n";
  const std::string name = escape_markup(spec["label"].get<std::string>());
  if (parts_->said.empty()) {
    return fmt::format("<figure>\n<p class=\"still\">{} There is no data.</p>\n{}</figure>\n", name,
                       below);
  }
  spec["columns"] = parts_->columns.description();
  spec["data"] = parts_->columns.base64();
  return fmt::format(
      "<figure class=\"chart\">\n<div class=\"plot\"></div>\n"
      "<p class=\"still\">{} {}, over {}: {}.</p>\n{}"
      "<script type=\"application/json\">{}</script>\n</figure>\n",
      name, escape_markup(spec["y"]["label"].get<std::string>()),
      escape_markup(spec["x"]["label"].get<std::string>()), escape_markup(parts_->said), below,
      script_text(spec));
}

std::string script_text(const json& value) {
  std::string safe;
  for (const char letter : value.dump(-1, ' ', false, json::error_handler_t::replace)) {
    if (letter == '<' || letter == '>' || letter == '&') {
      safe += fmt::format("\\u{:04x}", static_cast<unsigned>(letter));
    } else {
      safe += letter;
    }
  }
  return safe;
}

}  // namespace kelpie::chart
