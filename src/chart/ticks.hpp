// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace kelpie::chart {

/// An interval of data values or of pixels; for pixels `low` may lie above `high`.
struct Extent {
  double low = 0.0;
  double high = 1.0;
};

/// From the least to the greatest finite value; [0, 1] without any.
Extent range_of(std::span<const double> values);

/// The range with the share `margin` of its length added at both ends; never empty (a constant
/// series gets room around its value) and never beyond what a double can subtract.
Extent widened(Extent range, double margin);

/// How an axis is divided.
enum class ScaleKind : std::uint8_t { linear, logarithmic };

/// A place on an axis and what stands beside it.
struct Tick {
  double value = 0.0;
  std::string label;
};

/// Ticks at multiples of 1, 2 or 5 times a power of ten, inside `range`, at most `most` (≥ 2) and
/// as many as that allows. Labels all have the same number of decimals, and differ.
std::vector<Tick> linear_ticks(Extent range, int most);

/// Ticks at 1, 2 and 5 times powers of ten; at powers of ten only, or at every few of them, where
/// that would be more than `most`. Requires 0 < low < high.
std::vector<Tick> logarithmic_ticks(Extent range, int most);

/// Maps data to pixels. Values beyond the data range land on its edge.
class Scale {
 public:
  /// Requires data.low < data.high, and data.low > 0 for a logarithmic scale.
  Scale(Extent data, Extent pixels, ScaleKind kind = ScaleKind::linear);

  double operator()(double value) const;  ///< Where a value is on the axis.

 private:
  Extent data_;
  Extent pixels_;
  ScaleKind kind_;
};

}  // namespace kelpie::chart
