// SPDX-License-Identifier: Apache-2.0
#include "kelpie/data/split.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>

#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "kelpie/core/setting.hpp"

namespace kelpie {
namespace {

constexpr std::array<std::string_view, 3> kKinds{"random", "blocks", "tail"};

void require(bool good, const char* field, const std::string& message) {
  if (!good) {
    throw InputError({.file = {}, .line = 0, .field = field}, message);
  }
}

std::string label(const SplitSettings& settings) {
  const std::string share = number_text(100.0 * settings.held_out) + " %";
  switch (settings.kind) {
    case SplitKind::random:
      return "random " + share + " of the rows held out (neighbours in time leak)";
    case SplitKind::blocks:
      return "blocks of " + std::to_string(settings.block_rows) + " rows, one in " +
             std::to_string(settings.every) + " held out";
    case SplitKind::tail:
      return "last " + share + " of the rows held out";
  }
  return {};
}

// Which rows of one configuration are held out.
std::vector<bool> choose(std::size_t rows, const SplitSettings& settings, RandomStream& random) {
  std::vector<bool> held_out(rows, false);
  const auto share =
      static_cast<std::size_t>(std::floor(settings.held_out * static_cast<double>(rows)));
  if (settings.kind == SplitKind::random) {
    std::vector<std::size_t> order(rows);
    for (std::size_t i = 0; i < rows; ++i) {
      order[i] = i;
    }
    random.shuffle(std::span(order));
    for (std::size_t i = 0; i < share; ++i) {
      held_out[order[i]] = true;
    }
  } else {
    for (std::size_t i = 0; i < rows; ++i) {
      held_out[i] = settings.kind == SplitKind::tail
                        ? i >= rows - share
                        : i / settings.block_rows % settings.every == settings.every - 1;
    }
  }
  return held_out;
}

void check_both_sides(const Dataset& data, int configuration, const std::vector<bool>& held_out,
                      const SplitSettings& settings) {
  const auto out = static_cast<std::size_t>(std::ranges::count(held_out, true));
  if (out > 0 && out < held_out.size()) {
    return;
  }
  const std::size_t needed = settings.kind == SplitKind::blocks
                                 ? (settings.every - 1) * settings.block_rows + 1
                                 : static_cast<std::size_t>(std::ceil(1.0 / settings.held_out));
  throw InputError({.file = data.source, .line = 0, .field = "split"},
                   "configuration " + std::to_string(configuration) + " has " +
                       std::to_string(held_out.size()) + " rows; " + label(settings) + " needs " +
                       std::to_string(needed) + " or more");
}

}  // namespace

void SplitSettings::validate() const {
  require(held_out > 0.0 && held_out < 1.0, "held_out",
          number_text(held_out) + " is out of range; it has to be between 0 and 1");
  require(block_rows >= 1, "block_rows", "0 is out of range; it has to be >= 1");
  require(every >= 2, "every", std::to_string(every) + " is out of range; it has to be >= 2");
}

SplitKind split_kind_from(const std::string& name) {
  return static_cast<SplitKind>(choice_setting("split", name, kKinds));
}

std::string to_string(SplitKind kind) {
  return std::string(kKinds[static_cast<std::size_t>(kind)]);
}

Split make_split(const Dataset& data, const SplitSettings& settings) {
  settings.validate();
  std::map<int, std::vector<std::size_t>> rows_of;
  for (std::size_t row = 0; row < data.rows(); ++row) {
    rows_of[data.configurations[row]].push_back(row);
  }
  RandomStream random(settings.seed, "split");
  std::vector<bool> held_out(data.rows(), false);
  for (const auto& [configuration, rows] : rows_of) {
    const std::vector<bool> chosen = choose(rows.size(), settings, random);
    check_both_sides(data, configuration, chosen, settings);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      held_out[rows[i]] = chosen[i];
    }
  }
  Split split{label(settings), {}, {}};
  for (std::size_t row = 0; row < data.rows(); ++row) {
    (held_out[row] ? split.held_out : split.training).push_back(row);
  }
  return split;
}

}  // namespace kelpie
