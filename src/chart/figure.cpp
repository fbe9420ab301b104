// SPDX-License-Identifier: Apache-2.0
#include "chart/figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "chart/figure_text.hpp"
#include "chart/wording.hpp"

namespace kelpie::chart {
namespace {

constexpr std::size_t kMarkersOnLine = 8;

// Relative paths around the current point, in the order of the styles.
constexpr std::array<std::string_view, 7> kShapes = {
    "m-3 0a3 3 0 1 0 6 0a3 3 0 1 0-6 0",  // circle
    "m-3-3l6 6m0-6l-6 6",                 // cross
    "m-3-3h6v6h-6z",                      // square
    "m0-4l4 6.5h-8z",                     // triangle
    "m0-4l4 4-4 4-4-4z",                  // diamond
    "m-4 0h8m-4-4v8",                     // plus
    "m0 4l4-6.5h-8z",                     // triangle upside down
};

bool finite(Point point) {
  return std::isfinite(point.x) && std::isfinite(point.y);
}

std::string at(Point point) {
  return pixels(point.x) + " " + pixels(point.y);
}

std::string marker(Point point, std::size_t style) {
  return fmt::format("M{}{}", at(point), kShapes[style % kShapes.size()]);
}

std::string path(const std::string& classes, const std::string& shape) {
  return shape.empty() ? "" : fmt::format("<path class=\"{}\" d=\"{}\"/>\n", classes, shape);
}

// The next run of points without a break, starting at or after `first`.
std::span<const Point> next_run(std::span<const Point> points, std::size_t first) {
  const auto from =
      std::find_if(points.begin() + static_cast<std::ptrdiff_t>(first), points.end(), finite);
  return {from, std::find_if_not(from, points.end(), finite)};
}

std::string line_classes(std::size_t style) {
  const std::size_t colours = kShapes.size();
  return fmt::format("line s{} d{}", style % colours, (style + style / colours) % colours);
}

std::string marker_classes(std::size_t style) {
  return fmt::format("marker s{}", style % kShapes.size());
}

Scale scale_for(const PlotAxis& axis, double from, double to) {
  return {axis.range, {from, to}, axis.kind};
}

PlotAxis with_room(PlotAxis axis) {
  if (axis.kind == ScaleKind::linear) {
    axis.range = widened(axis.range, 0.0);
  }
  return axis;
}

}  // namespace

Figure::Figure(PlotSize size, PlotAxis x, PlotAxis y, const std::string& description)
    : size_(size),
      x_axis_(with_room(std::move(x))),
      y_axis_(with_room(std::move(y))),
      description_(escape_markup(description)),
      frame_(frame_of(size_, x_axis_, y_axis_)),
      x_scale_(scale_for(x_axis_, frame_.left, frame_.right)),
      y_scale_(scale_for(y_axis_, frame_.bottom, frame_.top)) {}

std::vector<Point> Figure::placed(std::span<const Point> points) const {
  std::vector<Point> result;
  result.reserve(points.size());
  for (const Point& point : points) {
    result.push_back(finite(point) ? Point{x_scale_(point.x), y_scale_(point.y)}
                                   : Point{point.x, std::numeric_limits<double>::quiet_NaN()});
  }
  return result;
}

void Figure::draw(const std::string& shape, const std::string& name, const std::string& sample) {
  has_data_ = has_data_ || !shape.empty();
  body_ += shape;
  if (!name.empty()) {
    entries_.push_back({name, sample});
  }
}

void Figure::line(std::span<const Point> points, std::size_t style, const std::string& name) {
  const std::vector<Point> drawn = thinned(placed(points));
  std::string lines;
  std::string shapes;
  // Markers of different lines stand at different points, so that they don't hide each other.
  const std::size_t stride = std::max<std::size_t>(1, drawn.size() / kMarkersOnLine);
  std::size_t count = style * stride / kShapes.size();
  for (std::span run = next_run(drawn, 0); !run.empty();) {
    for (std::size_t i = 0; i < run.size(); ++i, ++count) {
      if (run.size() > 1) {
        lines += fmt::format("{}{}", i == 0 ? "M" : i == 1 ? "L" : " ", at(run[i]));
      }
      if (run.size() == 1 || count % stride == stride / 2) {
        shapes += marker(run[i], style);
      }
    }
    run = next_run(drawn, static_cast<std::size_t>(run.data() - drawn.data()) + run.size());
  }
  draw(path(line_classes(style), lines) + path(marker_classes(style), shapes), name,
       path(line_classes(style), "M0 0h24") + path(marker_classes(style), marker({12, 0}, style)));
}

void Figure::markers(std::span<const Point> points, std::size_t style, const std::string& name) {
  std::string shapes;
  for (const Point& point : placed(points)) {
    shapes += finite(point) ? marker(point, style) : "";
  }
  draw(path(marker_classes(style), shapes), name,
       path(marker_classes(style), marker({12, 0}, style)));
}

void Figure::dots(std::span<const Point> points, std::size_t style, const std::string& name) {
  const std::string classes = fmt::format("dot s{}", style % kShapes.size());
  std::string shapes;
  for (const Point& point : placed(points)) {
    shapes += finite(point) ? fmt::format("M{}h0", at(point)) : "";
  }
  draw(path(classes, shapes), name, path(classes, "M12 0h0"));
}

void Figure::boxes(std::span<const Box> boxes, std::size_t style, const std::string& name) {
  const std::string classes = fmt::format("box f{}", style % kShapes.size());
  std::string shapes;
  for (const Box& box : boxes) {
    const Point low{x_scale_(box.x0), y_scale_(box.y0)};
    const Point high{x_scale_(box.x1), y_scale_(box.y1)};
    if (finite(low) && finite(high) && box.y1 > box.y0) {
      shapes +=
          fmt::format("M{}H{}V{}H{}z", at(low), pixels(high.x), pixels(high.y), pixels(low.x));
    }
  }
  draw(path(classes, shapes), name, path(classes, "M6-5h12v10h-12z"));
}

void Figure::band(std::span<const Point> low, std::span<const Point> high, std::size_t style,
                  const std::string& name) {
  const std::string classes = fmt::format("band f{}", style % kShapes.size());
  const std::vector<Point> below = placed(low);
  const std::vector<Point> above = placed(high);
  std::string shapes;
  for (std::size_t i = 1; i < std::min(below.size(), above.size()); ++i) {
    if (finite(below[i - 1]) && finite(above[i - 1]) && finite(below[i]) && finite(above[i])) {
      shapes += fmt::format("M{}L{} {} {}z", at(below[i - 1]), at(below[i]), at(above[i]),
                            at(above[i - 1]));
    }
  }
  draw(path(classes, shapes), name, path(classes, "M2-5h20v10h-20z"));
}

void Figure::mark(double x, const std::string& label) {
  if (!std::isfinite(x)) {
    return;
  }
  const double place = x_scale_(x);
  body_ += path("mark", fmt::format("M{}V{}", at({place, frame_.top}), pixels(frame_.bottom)));
  marks_.push_back({place, label});
}

void Figure::reference(Point from, Point to) {
  const std::vector<Point> ends = placed(std::array{from, to});
  body_ += path("mark", fmt::format("M{}L{}", at(ends[0]), at(ends[1])));
}

std::string Figure::svg() const {
  double legend_height = 0.0;
  double marks_height = 0.0;
  const std::string legend_text = legend(legend_height);
  const std::string marks_text = mark_labels(marks_height);
  const std::string empty =
      has_data_ ? ""
                : text_at("tick", "middle",
                          {(frame_.left + frame_.right) / 2, (frame_.top + frame_.bottom) / 2},
                          "no data");
  return fmt::format(
      "<svg class=\"figure\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n{}"
      "<g transform=\"translate(0,{})\">\n{}</g>\n<g transform=\"translate(0,{})\">\n{}{}{}</g>\n"
      "</svg>\n",
      size_.width, pixels(size_.height + legend_height + marks_height), description_, legend_text,
      pixels(legend_height), marks_text, pixels(legend_height + marks_height), axes(), body_,
      empty);
}

}  // namespace kelpie::chart
