// SPDX-License-Identifier: Apache-2.0
// Everything of a figure that is text: its frame (as wide as the tick labels need), the axes, the
// legend, the labels of marks; and the style sheet.
#include "chart/figure_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "chart/wording.hpp"

namespace kelpie::chart {
namespace {

constexpr double kLetter = 6.9;      // width of a letter at the figures' 12 pixels
constexpr double kRow = 18.0;        // height of a row of text
constexpr double kTickPitch = 26.0;  // least distance of ticks on the y axis
constexpr std::size_t kLongestEntry = 28;

std::vector<Tick> ticks_of(const PlotAxis& axis, int most) {
  if (!axis.names.empty()) {
    return axis.names;
  }
  return axis.kind == ScaleKind::linear ? linear_ticks(axis.range, most)
                                        : logarithmic_ticks(axis.range, most);
}

double widest(const std::vector<Tick>& ticks) {
  double width = 0.0;
  for (const Tick& tick : ticks) {
    width = std::max(width, text_width(tick.label));
  }
  return width;
}

// As many ticks as fit with their labels side by side.
std::vector<Tick> fitting_ticks(const PlotAxis& axis, double length) {
  int most = 9;
  std::vector<Tick> ticks = ticks_of(axis, most);
  while (most > 2 && static_cast<double>(ticks.size()) * (widest(ticks) + 14.0) > length) {
    ticks = ticks_of(axis, --most);
  }
  return ticks;
}

std::string fitted(const std::string& text, double length) {
  return shortened(text, static_cast<std::size_t>(length / kLetter));
}

}  // namespace

std::string pixels(double value) {
  const double tenths = std::round(10.0 * value);
  return fmt::format("{}", tenths == 0.0 ? 0.0 : tenths / 10.0);
}

double text_width(std::string_view text) {
  return kLetter * static_cast<double>(code_points(text));
}

std::string text_at(std::string_view css_class, std::string_view anchor, Point place,
                    std::string_view text) {
  return fmt::format("<text class=\"{}\" text-anchor=\"{}\" x=\"{}\" y=\"{}\">{}</text>\n",
                     css_class, anchor, pixels(place.x), pixels(place.y), escape_markup(text));
}

Figure::Frame Figure::frame_of(PlotSize size, const PlotAxis& x, const PlotAxis& y) {
  Frame frame;
  frame.top = 8.0;
  frame.bottom = size.height - 42.0;
  frame.y_ticks =
      ticks_of(y, std::max(2, static_cast<int>((frame.bottom - frame.top) / kTickPitch)));
  frame.left = 26.0 + widest(frame.y_ticks);
  frame.right = size.width - 12.0;
  frame.x_ticks = fitting_ticks(x, frame.right - frame.left);
  if (!frame.x_ticks.empty()) {
    // The last label is centred on its tick, which may be the right edge.
    frame.right = size.width - std::max(12.0, text_width(frame.x_ticks.back().label) / 2 + 2.0);
  }
  return frame;
}

std::string Figure::axes() const {
  std::string grid;
  std::string labels;
  for (const Tick& tick : frame_.y_ticks) {
    const double y = y_scale_(tick.value);
    grid += fmt::format("M{} {}H{}", pixels(frame_.left), pixels(y), pixels(frame_.right));
    labels += text_at("tick", "end", {frame_.left - 6.0, y + 4.0}, tick.label);
  }
  for (const Tick& tick : frame_.x_ticks) {
    const double x = x_scale_(tick.value);
    grid += fmt::format("M{} {}v5", pixels(x), pixels(frame_.bottom));
    labels += text_at("tick", "middle", {x, frame_.bottom + 18.0}, tick.label);
  }
  const Point middle{(frame_.left + frame_.right) / 2, (frame_.top + frame_.bottom) / 2};
  labels += text_at("label", "middle", {middle.x, size_.height - 5.0},
                    fitted(x_axis_.label, frame_.right - frame_.left));
  labels +=
      fmt::format("<g transform=\"translate(13,{}) rotate(-90)\">\n{}</g>\n", pixels(middle.y),
                  text_at("label", "middle", {0.0, 0.0},
                          fitted(y_axis_.label, frame_.bottom - frame_.top + 8.0)));
  return fmt::format(
      "<path class=\"grid\" d=\"{}\"/>\n<path class=\"axis\" d=\"M{} {}V{}H{}\"/>\n{}", grid,
      pixels(frame_.left), pixels(frame_.top), pixels(frame_.bottom), pixels(frame_.right), labels);
}

std::string Figure::legend(double& height) const {
  std::string text;
  double x = frame_.left;
  double y = entries_.empty() ? 0.0 : kRow;
  for (const Entry& entry : entries_) {
    const std::string name = shortened(entry.name, kLongestEntry);
    const double width = 30.0 + text_width(name);
    if (x > frame_.left && x + width > size_.width) {
      x = frame_.left;
      y += kRow;
    }
    text +=
        fmt::format("<g transform=\"translate({},{})\">\n{}{}</g>\n", pixels(x),
                    pixels(y - kRow / 2), entry.sample, text_at("key", "start", {30.0, 4.0}, name));
    x += width + 12.0;
  }
  height = y;
  return text;
}

std::string Figure::mark_labels(double& height) const {
  std::vector<Label> sorted = marks_;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Label& a, const Label& b) { return a.x < b.x; });
  // Two rows above the plot; where marks crowd more than that, the line alone has to do.
  std::array<double, 2> taken = {-kRow, -kRow};
  std::vector<std::pair<std::size_t, Label>> kept;
  std::size_t rows = 0;
  for (const Label& label : sorted) {
    const double width = text_width(label.text);
    const double left = std::max(0.0, std::min(label.x - width / 2, size_.width - width));
    std::size_t row = 0;
    while (row < taken.size() && taken[row] + 8.0 > left) {
      ++row;
    }
    if (row < taken.size()) {
      taken[row] = left + width;
      rows = std::max(rows, row + 1);
      kept.emplace_back(row, Label{left + width / 2, label.text});
    }
  }
  height = kRow * static_cast<double>(rows);
  std::string text;
  for (const auto& [row, label] : kept) {
    text += text_at("tick", "middle", {label.x, height - kRow * static_cast<double>(row) - 1.0},
                    label.text);
  }
  return text;
}

}  // namespace kelpie::chart
