// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kelpie/model/alignment.hpp"

namespace kelpie {

/// The alignment of a stream, estimated as its rows come, and the rows as it aligns them. It begins
/// with none. The last rows are kept, and looked at when there are twice as many as the last time,
/// at the latest when all of them are new; another shift is taken on clear evidence only
/// (find_alignment). Looking takes long, so the caller says when, and what follows:
///
///     rows.push(x, y, t, learn);                   // learn(x, y, t): model.update(x, y, t)
///     if (rows.is_due() && rows.adopt(rows.search())) {
///       model = fresh();                           // it has learned with other commands …
///       rows.replay(learn);                        // … or skip both lines, and it forgets them
///     }
///
/// A model can't be shifted afterwards: what it has learned belongs to the commands it was shown.
/// Memory: 8 (inputs + targets + 1) bytes per row kept, some four times that while
/// looking.
class LiveAlignment {
 public:
  static constexpr std::size_t kFirstSearch = 1500;  ///< rows: the search's kernel has all it wants
  static constexpr std::size_t kUsualKeep = 4000;    ///< rows

  /// Of rows with these inputs, so many targets and `rate_hz` rows per second; `states` as in
  /// AlignmentProblem. Keeps the last `keep` rows. Throws InputError on a rate that isn't > 0,
  /// fewer than kFirstSearch rows, or states that name no inputs.
  LiveAlignment(std::vector<std::string> inputs, std::size_t targets, double rate_hz,
                std::string states = "auto", std::size_t keep = kUsualKeep);

  /// Shows one row; calls take(x, y, t) for each row that is complete now, as AlignedRows. One with
  /// a value that isn't finite is passed over. Where time steps back, a stretch ends and what is
  /// kept is forgotten. Throws InputError as AlignedRows. Allocates nothing.
  template <typename Take>
  void push(std::span<const double> x, std::span<const double> y, double t, Take take) {
    if (!is_finite(x, y, t)) {
      return;
    }
    if (kept_ > 0 && t < newest_s_) {
      rows_.finish(take);
      kept_ = 0;
    }
    keep(x, y, t);
    rows_.push(x, y, t, take);
  }

  /// Aligns a row as push() does, and neither keeps nor counts it: no shift is found by it.
  template <typename Take>
  void pass(std::span<const double> x, std::span<const double> y, double t, Take take) {
    if (is_finite(x, y, t)) {
      rows_.push(x, y, t, take);
    }
  }

  /// Gives out the rows that wait, as AlignedRows::finish.
  template <typename Take>
  void finish(Take take) {
    rows_.finish(take);
  }

  /// Whether it is time to look.
  bool is_due() const { return seen_ >= next_search_ && kept_ >= kFirstSearch; }

  /// What the kept rows say of the shift; `afresh`: as if none were in use, as a log of them is
  /// looked at. Cost: 21 fits to them, and 50 by kernel: up to 0.3 s for
  /// 4000 rows of 9 columns. Allocates. It may look at a copy in another thread while rows go on
  /// coming here.
  AlignmentFound search(bool afresh = false) const;

  /// Takes what was found into use, and puts the next look off. Returns whether it is another
  /// shift. If so, up to as many rows as it is long are given twice, or not at all. Allocates then.
  bool adopt(const AlignmentFound& found);

  /// Gives all rows kept anew, by the alignment in use. Cost: that of `take` for each.
  template <typename Take>
  void replay(Take take) {
    rows_ = aligned_rows();
    for (std::size_t i = 0; i < kept_; ++i) {
      const std::span<const double> row = kept_row(i);
      rows_.push(row.first(names_.size()), row.subspan(names_.size(), targets_), row.back(), take);
    }
  }

  const Alignment& alignment() const { return alignment_; }  ///< In use.

 private:
  static bool is_finite(std::span<const double> x, std::span<const double> y, double t);
  void keep(std::span<const double> x, std::span<const double> y, double t);
  std::span<const double> kept_row(std::size_t i) const;  // from the oldest on
  AlignedRows aligned_rows() const;

  std::vector<std::string> names_;
  std::size_t targets_;
  double rate_hz_;
  std::string states_;
  std::size_t most_;
  Alignment alignment_;
  AlignedRows rows_;
  std::vector<double> ring_;  // x, y, t
  std::size_t kept_ = 0;
  std::size_t written_ = 0;  // rows, ever
  double newest_s_ = 0.0;
  std::size_t seen_ = 0;
  std::size_t next_search_ = kFirstSearch;
};

}  // namespace kelpie
