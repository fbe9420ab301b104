// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "kelpie/core/archive.hpp"
#include "kelpie/learner/decision.hpp"

namespace kelpie {

/// Sums of the decisions of a stream since the start; tally_fields() has the meanings. Every
/// `accepted` or `regained` sample is in the buffer or in `outliers`, `forgotten` or `released`. No
/// total ever decreases.
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

/// Kind of a total. Pages show the totals in this order.
enum class TallyKind : std::uint8_t {
  arrival,    ///< arriving samples by verdict, without held samples
  departure,  ///< samples removed from the buffer
  trouble,    ///< effects of a budget, and solver failures
  change,     ///< reactions to grown errors
};

/// A total: the source of archive, result.json, pages, tables and Python.
struct TallyField {
  std::string_view key;      ///< in result.json
  std::string_view name;     ///< in Python
  std::string_view label;    ///< in pages and tables
  std::string_view meaning;  ///< a line of help
  TallyKind kind;
  std::int64_t Tally::*total;
  std::int64_t (*count)(const Decision& decision);  ///< contribution of a step
};

/// The totals, in the order of result.json.
std::span<const TallyField> tally_fields();

}  // namespace kelpie
