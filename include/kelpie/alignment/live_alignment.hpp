// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "kelpie/alignment/alignment.hpp"

namespace kelpie {

/// The alignment of a stream, estimated from rows as they arrive, and the aligned rows. Starts
/// without a lag. Keeps the last rows; a search is due when twice as many rows are kept as at the
/// last search, at the latest when all rows are new. A new lag is adopted on clear evidence only
/// (find_alignment). A search takes long, so the caller chooses the moment:
///
///     rows.push(x, y, t, learn);                   // learn(x, y, t): model.update(x, y, t)
///     if (rows.is_due() && rows.adopt(rows.search())) {
///       model = fresh();                           // learned with other commands; replay,
///       rows.replay(learn);                        // or skip both lines and let the model forget
///     }
///
/// The alignment of a taught model can't change: samples in the model keep their commands.
/// Memory: 8 (inputs + targets + 1) bytes per row kept, about four times as much during a search.
class LiveAlignment {
 public:
  static constexpr std::size_t kFirstSearch = 1500;  ///< rows; enough for the kernel of the search
  static constexpr std::size_t kUsualKeep = 4000;    ///< rows

  /// `rate_hz`: rows per second; `states`, `known` as in AlignmentProblem; `keep`: rows kept.
  /// Throws InputError on a rate that isn't > 0, fewer than kFirstSearch rows, or states that name
  /// no inputs.
  LiveAlignment(std::vector<std::string> inputs, std::size_t targets, double rate_hz,
                std::string states = "auto", std::size_t keep = kUsualKeep,
                std::map<std::string, Actuator> known = {});

  /// Takes one row; calls take(x, y, t) for each row now complete, as AlignedRows. Rows with a
  /// value that isn't finite are skipped. A time that steps back ends the stretch and discards the
  /// kept rows. Throws InputError as AlignedRows. Allocates nothing.
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

  /// Aligns a row as push() does, without keeping the row for a search.
  template <typename Take>
  void pass(std::span<const double> x, std::span<const double> y, double t, Take take) {
    if (is_finite(x, y, t)) {
      rows_.push(x, y, t, take);
    }
  }

  /// Gives out the waiting rows, as AlignedRows::finish.
  template <typename Take>
  void finish(Take take) {
    rows_.finish(take);
  }

  /// Whether a search is due.
  bool is_due() const { return seen_ >= next_search_ && kept_ >= kFirstSearch; }

  /// Searches the kept rows; `afresh`: without regard to the present alignment, as for a log. Cost:
  /// 50 fits, and 50 more per command (find_alignment()). Allocates. A copy can
  /// search in another thread while this object takes rows.
  AlignmentResult search(bool afresh = false) const;

  /// Adopts the result of a search, and schedules the next search. Returns whether the lag is new;
  /// then rows within the lag may be given twice or not at all, and the call allocates.
  bool adopt(const AlignmentResult& found);

  /// Gives all kept rows again, by the alignment in use. Cost: `take` per row.
  template <typename Take>
  void replay(Take take) {
    rows_ = aligned_rows();
    for (std::size_t i = 0; i < kept_; ++i) {
      const std::span<const double> row = kept_row(i);
      rows_.push(row.first(names_.size()), row.subspan(names_.size(), targets_), row.back(), take);
    }
  }

  const Alignment& alignment() const { return alignment_; }  ///< The alignment in use.

 private:
  static bool is_finite(std::span<const double> x, std::span<const double> y, double t);
  void keep(std::span<const double> x, std::span<const double> y, double t);
  std::span<const double> kept_row(std::size_t i) const;  // from the oldest on
  AlignedRows aligned_rows() const;

  std::vector<std::string> names_;
  std::size_t targets_;
  double rate_hz_;
  std::string states_;
  std::map<std::string, Actuator> known_;
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
