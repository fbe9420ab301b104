// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kelpie::chart {

/// A point in data coordinates. A NaN or infinity in y breaks the line it is part of.
struct Point {
  double x = 0.0;
  double y = 0.0;
};

/// An interval of data values.
struct Extent {
  double low = 0.0;
  double high = 1.0;
};

/// From the least to the greatest finite value; [0, 1] without any.
Extent range_of(std::span<const double> values);

/// How an axis is divided.
enum class ScaleKind : std::uint8_t { linear, logarithmic };

/// Label and range of an axis.
struct PlotAxis {
  std::string label;              ///< with its unit
  std::optional<Extent> range{};  ///< default: the range of the points in view
  ScaleKind kind = ScaleKind::linear;
  std::vector<std::string> names{};  ///< words at 0, 1, 2 …, in place of numbers
};

/// An interactive figure, drawn by figure.js from a description and columns of numbers
/// (src/tools/chart/README.md). Series differ in colour, dash pattern and marker, chosen by `style`
/// ≥ 0. Without JavaScript a sentence with the range of each series replaces the figure; a figure
/// without data says "no data".
class Figure {
 public:
  /// `description` is for screen readers. Text is escaped here.
  Figure(const PlotAxis& x, const PlotAxis& y, const std::string& description);
  Figure(Figure&& other) noexcept;
  Figure& operator=(Figure&& other) noexcept;
  ~Figure();

  /// Figures of one group show the same range of x and the same cursor.
  void link(const std::string& group);
  void make_square();            ///< As high as wide.
  void begin_at(Extent window);  ///< What of x the figure, and its group, show at first.

  /// A low figure below: the line `a` less the line `b`, by their names, with the band around 0.
  /// `label`: its y axis, with unit. Requires both lines and one band, all of the same x.
  void errors_below(const std::string& a, const std::string& b, const std::string& label);

  // Series: x ascending; points without a finite x are left out. Named series appear in the legend,
  // which can hide them.

  /// Points joined in the order given.
  void line(std::span<const Point> points, std::size_t style, const std::string& name);
  /// Points with the marker of the series; dots are small, for clouds of points (sorted here).
  void markers(std::span<const Point> points, std::size_t style, const std::string& name);
  void dots(std::span<const Point> points, std::size_t style, const std::string& name);
  /// Bars from 0, each around its x.
  void bars(std::span<const Point> points, std::size_t style, const std::string& name);
  /// The area around a middle line, `half` to each side. Requires as many halves as points.
  void band(std::span<const Point> middle, std::span<const double> half, std::size_t style,
            const std::string& name = "");
  /// A vertical line with a label above the plot; labels never overlap.
  void mark(double x, const std::string& label);
  /// A thin line for the eye, such as the diagonal.
  void reference(Point from, Point to);

  /// The whole figure, with a sentence below it (plain text).
  std::string html(const std::string& caption = "") const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// JSON for a script element of a page: without tags and entities.
std::string script_text(const nlohmann::json& value);

}  // namespace kelpie::chart
