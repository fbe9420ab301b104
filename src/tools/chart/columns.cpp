// SPDX-License-Identifier: Apache-2.0
#include "chart/columns.hpp"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "chart/figure.hpp"

namespace kelpie::chart {
namespace {

constexpr std::size_t kFineBytes = 4;

bool same(double a, double b) {
  return a == b || (!std::isfinite(a) && !std::isfinite(b));
}

// Steps from value to value; all lowest bytes first, then all second ones: most of the higher are
// 0.
void append(std::string& bytes, const std::vector<double>& values, double low, double high,
            std::size_t width) {
  const std::uint64_t last = (std::uint64_t{1} << (8 * width)) - 1;  // stands for what isn't finite
  const double scale = high > low ? static_cast<double>(last - 1) / (high - low) : 0.0;
  const std::size_t begin = bytes.size();
  bytes.resize(begin + width * values.size());
  std::uint64_t before = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::uint64_t code =
        std::isfinite(values[i])
            ? std::min(static_cast<std::uint64_t>(std::llround((values[i] - low) * scale)),
                       last - 1)
            : last;
    const std::uint64_t step = (code - before) & last;
    for (std::size_t plane = 0; plane < width; ++plane) {
      bytes[begin + plane * values.size() + i] = static_cast<char>(step >> (8 * plane));
    }
    before = code;
  }
}

std::string in_base64(const std::string& bytes) {
  constexpr std::string_view kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(bytes.size() / 3 * 4 + 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) {
      return k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0U;
    };
    const std::uint32_t three = byte(i) << 16U | byte(i + 1) << 8U | byte(i + 2);
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? kLetters[three >> (18 - 6 * k) & 63U] : '=';
    }
  }
  return text;
}

}  // namespace

std::size_t Columns::add(std::vector<double> values, bool fine) {
  const std::size_t width = fine ? kFineBytes : 2;
  const auto found = std::ranges::find_if(columns_, [&](const Column& column) {
    return column.width == width && std::ranges::equal(column.values, values, same);
  });
  if (found == columns_.end()) {
    const auto [low, high] = range_of(values);
    columns_.push_back({std::move(values), low, high, width});
    return columns_.size() - 1;
  }
  return static_cast<std::size_t>(found - columns_.begin());
}

nlohmann::json Columns::description() const {
  nlohmann::json list = nlohmann::json::array();
  for (const Column& column : columns_) {
    list.push_back({{"n", column.values.size()},
                    {"width", column.width},
                    {"low", column.low},
                    {"high", column.high}});
  }
  return list;
}

std::string Columns::base64() const {
  std::string bytes;
  for (const Column& column : columns_) {
    append(bytes, column.values, column.low, column.high, column.width);
  }
  uLongf size = compressBound(bytes.size());
  std::string packed(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(),
                Z_BEST_COMPRESSION) != Z_OK) {
    throw std::bad_alloc();
  }
  packed.resize(size);
  return in_base64(packed);
}

}  // namespace kelpie::chart
