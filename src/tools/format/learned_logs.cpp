// SPDX-License-Identifier: Apache-2.0
#include "format/learned_logs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "file/crc32.hpp"

namespace kelpie::format {
namespace {

constexpr double kMostRows = 1e15;

std::string checksum_of_rows(const log::Dataset& data) {
  const std::uint32_t sum = file::crc32_of(std::as_bytes(std::span(data.inputs)));
  return fmt::format("{:08x}", file::crc32_of(std::as_bytes(std::span(data.targets)), sum));
}

std::size_t row_number(const file::JsonNode& node, double value) {
  node.require(value >= 0.0 && value == std::trunc(value) && value < kMostRows,
               "has to be a whole number, 0 or more");
  return static_cast<std::size_t>(value);
}

}  // namespace

bool LearnedLog::is_of(const log::Dataset& data) const {
  return rows == data.rows() && checksum == checksum_of_rows(data);
}

LearnedLog learned_log(const log::Dataset& data) {
  return {.rows = data.rows(), .checksum = checksum_of_rows(data)};
}

std::vector<LearnedLog> with_held_out(std::vector<LearnedLog> logs,
                                      std::span<const std::size_t> held_out) {
  std::size_t begin = 0;
  auto next = held_out.begin();
  for (LearnedLog& log : logs) {
    for (; next != held_out.end() && *next < begin + log.rows; ++next) {
      const std::size_t row = *next - begin;
      if (log.held_out.empty() || row != log.held_out.back().second + 1) {
        log.held_out.emplace_back(row, row);
      }
      log.held_out.back().second = row;
    }
    begin += log.rows;
  }
  return logs;
}

std::vector<bool> held_out_rows(std::span<const LearnedLog> logs, const log::Dataset& data) {
  std::vector<std::size_t> times_held_out(data.rows());
  std::size_t times_met = 0;
  for (const LearnedLog& log : logs) {
    if (!log.is_of(data)) {
      continue;
    }
    ++times_met;
    for (const auto& [first, last] : log.held_out) {
      for (std::size_t row = first; row <= last; ++row) {
        ++times_held_out[row];
      }
    }
  }
  std::vector<bool> rows;
  if (times_met > 0) {
    std::ranges::transform(times_held_out, std::back_inserter(rows),
                           [&](std::size_t times) { return times == times_met; });
  }
  return rows;
}

file::Json learned_json(std::span<const LearnedLog> logs) {
  return file::list(logs, [](const LearnedLog& log) {
    return file::Json{{"rows", log.rows},
                      {"checksum", log.checksum},
                      {"held_out", file::list(log.held_out, [](const auto& range) {
                         return file::Json{range.first, range.second};
                       })}};
  });
}

std::vector<LearnedLog> read_learned(const file::JsonNode& node) {
  std::vector<LearnedLog> logs;
  for (const file::JsonNode& item : node.items()) {
    LearnedLog& log = logs.emplace_back();
    log.rows = row_number(item["rows"], item["rows"].number());
    log.checksum = item["checksum"].text();
    std::size_t from = 0;
    for (const file::JsonNode& range : item["held_out"].items()) {
      const std::vector<double> ends = range.numbers(2);
      const std::size_t first = row_number(range, ends[0]);
      const std::size_t last = row_number(range, ends[1]);
      range.require(from <= first && first <= last && last < log.rows,
                    "has to be first and last of the log's rows, behind those before");
      log.held_out.emplace_back(first, last);
      from = last + 1;
    }
  }
  return logs;
}

}  // namespace kelpie::format
