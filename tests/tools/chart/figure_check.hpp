// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <zlib.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "chart/markup_check.hpp"

namespace kelpie {

/// A figure of a page, as a browser reads it.
struct FigureRead {
  nlohmann::json spec;
  std::vector<std::vector<double>> columns;

  /// The series of that name, or null.
  nlohmann::json series(std::string_view name) const {
    for (const nlohmann::json& one : spec["series"]) {
      if (one["name"] == name) {
        return one;
      }
    }
    return nullptr;
  }
  std::vector<double> values(std::string_view name, const char* of = "y") const {
    const nlohmann::json one = series(name);
    return one.is_null() ? std::vector<double>{} : columns.at(one[of].get<std::size_t>());
  }
};

inline std::string from_base64(std::string_view text) {
  constexpr std::string_view kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char letter : text) {
    if (letter != '=') {
      bits = bits << 6U | static_cast<std::uint32_t>(kLetters.find(letter));
      count += 6;
      if (count >= 8) {
        count -= 8;
        bytes += static_cast<char>(bits >> static_cast<unsigned>(count));
      }
    }
  }
  return bytes;
}

inline std::vector<std::vector<double>> unpacked(const nlohmann::json& columns,
                                                 std::string_view base64) {
  std::size_t size = 0;
  for (const nlohmann::json& column : columns) {
    size += column["n"].get<std::size_t>() * column["width"].get<std::size_t>();
  }
  const std::string packed = from_base64(base64);
  std::string bytes(size, '\0');
  uLongf filled = size;
  if (uncompress(reinterpret_cast<Bytef*>(bytes.data()), &filled,
                 reinterpret_cast<const Bytef*>(packed.data()), packed.size()) != Z_OK ||
      filled != size) {
    return {};
  }
  std::vector<std::vector<double>> all;
  std::size_t at = 0;
  for (const nlohmann::json& column : columns) {
    const auto n = column["n"].get<std::size_t>();
    const auto width = column["width"].get<std::size_t>();
    const auto low = column["low"].get<double>();
    const auto high = column["high"].get<double>();
    const std::uint64_t last = (std::uint64_t{1} << (8 * width)) - 1;
    std::vector<double>& values = all.emplace_back();
    std::uint64_t code = 0;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t plane = 0; plane < width; ++plane) {
        code += std::uint64_t{static_cast<unsigned char>(bytes[at + plane * n + i])} << (8 * plane);
      }
      code &= last;
      values.push_back(code == last ? std::numeric_limits<double>::quiet_NaN()
                                    : low + (high - low) * static_cast<double>(code) /
                                                static_cast<double>(last - 1));
    }
    at += n * width;
  }
  return all;
}

/// All figures of a page or a part of it that have something to show, in their order.
inline std::vector<FigureRead> figures_in(const std::string& page) {
  std::vector<FigureRead> figures;
  for (const Element& element : take_apart(page).elements) {
    if (element.name == "script" && element["type"] == "application/json") {
      const nlohmann::json spec = nlohmann::json::parse(element.text);
      figures.push_back({spec, unpacked(spec["columns"], spec["data"].get<std::string>())});
    }
  }
  return figures;
}

}  // namespace kelpie
