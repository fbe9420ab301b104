// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "kelpie/core/archive.hpp"
#include "kelpie/online/sample_collector.hpp"

namespace kelpie {

/// Which samples of a buffer are still to be learned anew, by somebody who has forgotten all, a few
/// at a time. Any few on end are spread over the buffer, since neighbours in time tell less than
/// nothing. Samples that leave the buffer meanwhile are passed over. Allocates in the constructor
/// only.
class Relearning {
 public:
  /// For buffers of up to so many samples; nothing is to be learned.
  explicit Relearning(std::size_t places) { arrivals_.reserve(places); }

  /// All samples of the buffer, so many rounds. Requires rounds > 0. Cost O(n log n).
  void begin(const SampleCollector& buffer, int rounds);

  /// The place of the next one in the buffer; none where it has left. Requires !round_done().
  std::optional<std::size_t> next(const SampleCollector& buffer);

  bool round_done() const { return arrivals_.empty(); }            ///< This round.
  bool done() const { return arrivals_.empty() && rounds_ == 0; }  ///< The last round.

  /// Begins the next round, with what the buffer holds now. Requires round_done() and !done().
  void next_round(const SampleCollector& buffer) { begin(buffer, rounds_); }

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  std::vector<std::uint64_t> arrivals_;  ///< of this round, in the order of their spread
  int rounds_ = 0;                       ///< that follow
};

}  // namespace kelpie
