// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "kelpie/core/archive.hpp"
#include "kelpie/online/decision.hpp"

namespace kelpie {

/// Totals since the start: the decisions of a stream, summed up. tally_fields() says what each of
/// them means. Every `accepted` or `regained` sample is in the buffer or in `outliers`, `forgotten`
/// or `released`. None of them ever goes down.
struct Tally {
  std::int64_t accepted = 0;
  std::int64_t explained = 0;
  std::int64_t duplicate = 0;
  std::int64_t invalid = 0;
  std::int64_t implausible = 0;
  std::int64_t outliers = 0;
  std::int64_t forgotten = 0;
  std::int64_t released = 0;
  std::int64_t regained = 0;
  std::int64_t rejected_by_tolerance = 0;
  std::int64_t crowded_out = 0;
  std::int64_t unfinished = 0;
  std::int64_t fallbacks = 0;
  std::int64_t suspicions = 0;
  std::int64_t changes = 0;
  std::int64_t recalls = 0;
  std::int64_t withdrawn = 0;

  void add(const Decision& decision);  ///< Counts one step.
  void visit(Archive& archive);        ///< core/archive.hpp
};

/// What a total counts. Pages show the totals in this order.
enum class TallyKind : std::uint8_t {
  arrival,    ///< samples, by what became of them when they came; held back ones aren't counted
  departure,  ///< samples that left the buffer
  trouble,    ///< what a budget or a solver in trouble brings about
  change,     ///< what was done because errors had grown
};

/// One total: the archive, result.json, pages, tables and Python follow from it.
struct TallyField {
  std::string_view key;      ///< in result.json
  std::string_view name;     ///< in Python
  std::string_view label;    ///< in pages and tables
  std::string_view meaning;  ///< in one line
  TallyKind kind;
  std::int64_t Tally::*total;
  std::int64_t (*count)(const Decision& decision);  ///< what one step adds
};

/// All totals, in the order of result.json.
std::span<const TallyField> tally_fields();

}  // namespace kelpie
