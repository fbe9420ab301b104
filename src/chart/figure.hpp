// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "chart/ticks.hpp"

namespace kelpie::chart {

/// A point in data coordinates. A NaN or infinity in either breaks the line it is part of.
struct Point {
  double x = 0.0;
  double y = 0.0;
};

/// A rectangle in data coordinates, y0 ≤ y1.
struct Box {
  double x0 = 0.0;
  double x1 = 0.0;
  double y0 = 0.0;
  double y1 = 0.0;
};

/// What an axis is called (with its unit) and which data it covers; any finite range will do.
struct PlotAxis {
  std::string label;
  Extent range;
  ScaleKind kind = ScaleKind::linear;
  std::vector<Tick> names{};  ///< words at places of a linear axis, instead of numbers
};

/// Pixels of the plot with its axis labels; the legend comes on top of that.
struct PlotSize {
  int width = 400;
  int height = 230;
};

/// An SVG drawing: two axes with ticks, series on them and a legend. Looks come from CSS classes
/// (figure_style), so that light, dark and print need one drawing. Series are told apart by
/// colour (Okabe-Ito) and by dash pattern and marker; `style` ≥ 0 chooses all three.
/// Without anything to show, the plot says so.
class Figure {
 public:
  /// `description` is what a screen reader says. Text is escaped here.
  Figure(PlotSize size, PlotAxis x, PlotAxis y, const std::string& description);

  /// Points joined in the order given; more than the pixels can show are thinned. A name enters
  /// the legend; an empty one doesn't.
  void line(std::span<const Point> points, std::size_t style, const std::string& name);
  /// Points with the series' marker.
  void markers(std::span<const Point> points, std::size_t style, const std::string& name);
  /// Small dots for clouds of points.
  void dots(std::span<const Point> points, std::size_t style, const std::string& name);
  /// Filled rectangles, such as the bars of a histogram.
  void boxes(std::span<const Box> boxes, std::size_t style, const std::string& name);
  /// The area between two lines over the same x, lightly filled. Left out where either breaks.
  void band(std::span<const Point> low, std::span<const Point> high, std::size_t style,
            const std::string& name = "");
  /// A vertical line with a label above the plot; labels never overlap.
  void mark(double x, const std::string& label);
  /// A thin line for the eye, such as the diagonal.
  void reference(Point from, Point to);

  std::string svg() const;

 private:
  // What is known before the first series: ticks, and the plot's edges in pixels.
  struct Frame {
    std::vector<Tick> x_ticks;
    std::vector<Tick> y_ticks;
    double left = 0.0;
    double right = 0.0;
    double top = 0.0;
    double bottom = 0.0;
  };
  struct Entry {
    std::string name;
    std::string sample;  // SVG around the origin, 24 pixels wide
  };
  struct Label {
    double x = 0.0;
    std::string text;
  };

  static Frame frame_of(PlotSize size, const PlotAxis& x, const PlotAxis& y);
  std::vector<Point> placed(std::span<const Point> points) const;
  void draw(const std::string& shape, const std::string& name, const std::string& sample);
  std::string axes() const;
  std::string legend(double& height) const;
  std::string mark_labels(double& height) const;

  PlotSize size_;
  PlotAxis x_axis_;
  PlotAxis y_axis_;
  std::string description_;
  Frame frame_;
  Scale x_scale_;
  Scale y_scale_;
  std::string body_;
  std::vector<Entry> entries_;
  std::vector<Label> marks_;
  bool has_data_ = false;
};

/// The style sheet all figures of a page share.
std::string figure_style();

/// At most four points (first, least, greatest, last) per pixel column, in their order, so that
/// the drawn line looks the same. Points are in pixels; breaks (NaN) stay breaks.
std::vector<Point> thinned(std::span<const Point> points);

/// A drawing and the sentence below it (plain text, not yet escaped).
struct Panel {
  std::string svg;
  std::string caption;
};

}  // namespace kelpie::chart
