// SPDX-License-Identifier: Apache-2.0
#include "study/split.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <string_view>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "study/tuning.hpp"

namespace kelpie::study {
namespace {

using Rows = std::vector<std::size_t>;

constexpr std::array<std::string_view, 7> kKindNames{
    "random", "blocks", "pieces", "tail", "column", "none", "auto"};  // as SplitKind counts
constexpr std::size_t kPieces = kTuning.split.pieces;

[[noreturn]] void refuse(const std::string& source, const std::string& field,
                         const std::string& message) {
  throw InputError({.file = source, .line = 0, .field = field}, message);
}

std::string label_of(const SplitSettings& settings) {
  if (settings.kind == SplitKind::none) {
    return "no rows held out";
  }
  if (settings.kind == SplitKind::blocks) {
    return fmt::format("blocks of {} rows, the last of every {} held out", settings.block_rows,
                       settings.every);
  }
  if (settings.kind == SplitKind::pieces) {
    return fmt::format("{} pieces of equal length, the last of every {} held out", kPieces,
                       settings.every);
  }
  if (settings.kind == SplitKind::column) {
    return fmt::format("rows marked in column '{}' held out", settings.column);
  }
  const double percent = 100.0 * settings.held_out;
  return settings.kind == SplitKind::tail
             ? fmt::format("last {:.6g} % of the rows held out", percent)
             : fmt::format("random {:.6g} % of the rows held out (neighbours in time leak)",
                           percent);
}

std::size_t share_of(std::size_t rows, double held_out) {
  return static_cast<std::size_t>(std::floor(held_out * static_cast<double>(rows)));
}

// Which of a configuration's rows, counted within it, are held out.
std::vector<bool> choose(const log::Dataset& data, const Rows& rows_of_it,
                         const SplitSettings& settings, RandomStream& random) {
  const std::size_t rows = rows_of_it.size();
  std::vector<bool> held_out(rows, false);
  const std::size_t share = share_of(rows, settings.held_out);
  switch (settings.kind) {
    case SplitKind::random: {
      Rows order(rows);
      std::iota(order.begin(), order.end(), std::size_t{0});
      random.shuffle(std::span(order));
      for (const std::size_t row : std::span(order).first(share)) {
        held_out[row] = true;
      }
      break;
    }
    case SplitKind::blocks:
      for (std::size_t row = 0; row < rows; ++row) {
        held_out[row] = row / settings.block_rows % settings.every == settings.every - 1;
      }
      break;
    case SplitKind::pieces:
      for (std::size_t row = 0; row < rows; ++row) {
        held_out[row] = row * kPieces / rows % settings.every == settings.every - 1;
      }
      break;
    case SplitKind::tail:
      std::fill(held_out.end() - static_cast<std::ptrdiff_t>(share), held_out.end(), true);
      break;
    case SplitKind::column:
      std::transform(rows_of_it.begin(), rows_of_it.end(), held_out.begin(),
                     [&](std::size_t row) { return data.held_out[row]; });
      break;
    case SplitKind::none:
    case SplitKind::automatic:
      break;
  }
  return held_out;
}

// As a real number: settings may ask for more rows than can be counted.
double rows_needed(const SplitSettings& settings) {
  if (settings.kind == SplitKind::pieces) {
    return static_cast<double>(kPieces);
  }
  return settings.kind == SplitKind::blocks
             ? static_cast<double>(settings.every - 1) * static_cast<double>(settings.block_rows) +
                   1.0
             : std::ceil(1.0 / settings.held_out);
}

void check_both_sides(const std::string& source, int configuration,
                      const std::vector<bool>& held_out, const SplitSettings& settings) {
  const auto count = static_cast<std::size_t>(std::ranges::count(held_out, true));
  if (count > 0 && count < held_out.size()) {
    return;
  }
  if (settings.kind == SplitKind::column) {
    refuse(source, settings.column,
           fmt::format("marks {} of the {} rows of configuration {}; both 0 (to learn) and 1 (held "
                       "out) are needed",
                       count, held_out.size(), configuration));
  } else {
    refuse(source, "split",
           fmt::format("configuration {} has {} rows; '{}' needs {:.0f} or more", configuration,
                       held_out.size(), label_of(settings), rows_needed(settings)));
  }
}

}  // namespace

void SplitSettings::validate() const {
  if (std::isnan(held_out) || held_out <= 0.0 || held_out >= 1.0) {
    refuse({}, "held_out",
           fmt::format("{} is out of range; a share has to lie between 0 and 1", held_out));
  }
  if (block_rows == 0) {
    refuse({}, "block_rows", "0 is out of range; a block has to have a row or more");
  }
  if (every < 2) {
    refuse({}, "every",
           fmt::format("{} is out of range; with fewer than 2 nothing is left to train on", every));
  }
}

SplitSettings parse_split(const std::string& text, std::uint64_t seed) {
  const std::size_t colon = text.find(':');
  const std::string name = text.substr(0, colon);
  const std::string column = colon == std::string::npos ? "" : text.substr(colon + 1);
  const auto* const found = std::ranges::find(kKindNames, name);
  if (found == kKindNames.end()) {
    std::vector<std::string> names(kKindNames.begin(), kKindNames.end());
    names[static_cast<std::size_t>(SplitKind::column)] += ":NAME";
    refuse({}, "split", unknown_name(name, "split", names));
  }
  SplitSettings settings{
      .kind = static_cast<SplitKind>(found - kKindNames.begin()), .seed = seed, .column = column};
  if ((settings.kind == SplitKind::column) == column.empty()) {
    refuse({}, "split",
           settings.kind == SplitKind::column
               ? "'column' needs the name of a column of 0 and 1, as in column:held"
               : fmt::format("'{}' takes nothing after a colon", name));
  }
  return settings;
}

std::string to_string(SplitKind kind) {
  return std::string(kKindNames[static_cast<std::size_t>(kind)]);
}

Split make_split(const log::Dataset& data, const SplitSettings& wanted) {
  wanted.validate();
  if (data.rows() == 0) {
    refuse(data.source, "split", "there are no rows to split");
  }
  std::map<int, Rows> rows_by_configuration;
  for (std::size_t row = 0; row < data.rows(); ++row) {
    rows_by_configuration[data.configurations[row]].push_back(row);
  }
  SplitSettings settings = wanted;
  if (wanted.kind == SplitKind::automatic) {
    settings.kind = SplitKind::blocks;
    const bool suffices = std::ranges::all_of(rows_by_configuration, [&](const auto& one) {
      return static_cast<double>(one.second.size()) >= rows_needed(settings);
    });
    settings.kind = suffices ? SplitKind::blocks : SplitKind::pieces;
  }
  Split split{.label = label_of(settings), .training = {}, .held_out = {}};
  RandomStream random(settings.seed, "split");
  for (const auto& [configuration, rows] : rows_by_configuration) {
    const std::vector<bool> held_out = choose(data, rows, settings, random);
    if (settings.kind != SplitKind::none) {
      check_both_sides(data.source, configuration, held_out, settings);
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
      (held_out[i] ? split.held_out : split.training).push_back(rows[i]);
    }
  }
  std::ranges::sort(split.training);
  std::ranges::sort(split.held_out);
  return split;
}

std::vector<std::size_t> of_configuration(const log::Dataset& data, std::vector<std::size_t> rows,
                                          int wanted) {
  std::erase_if(rows, [&](std::size_t row) { return data.configurations[row] != wanted; });
  return rows;
}

std::vector<std::size_t> training_rows(const log::Dataset& data, const Split& split,
                                       std::optional<int> only) {
  const int wanted = only.value_or(data.configurations[split.training.front()]);
  Rows rows = of_configuration(data, split.training, wanted);
  if (rows.empty()) {
    std::set<int> known;
    for (const std::size_t row : split.training) {
      known.insert(data.configurations[row]);
    }
    refuse("--only", "",
           fmt::format("{} has no configuration {}; it has {}", data.source, wanted,
                       fmt::join(known, ", ")));
  }
  return rows;
}

void require_held_out(const Split& split) {
  if (split.held_out.empty()) {
    refuse({}, "split", "'none' holds out no rows to judge by; choose another one");
  }
}

}  // namespace kelpie::study
