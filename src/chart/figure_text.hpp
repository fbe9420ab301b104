// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "chart/figure.hpp"

namespace kelpie::chart {

/// A coordinate: one decimal at most, finite.
std::string pixels(double value);

/// Room that text takes in a figure; fonts differ, so this errs on the wide side.
double text_width(std::string_view text);

/// An SVG text element; `anchor` is start, middle or end. The text is escaped here.
std::string text_at(std::string_view css_class, std::string_view anchor, Point place,
                    std::string_view text);

}  // namespace kelpie::chart
