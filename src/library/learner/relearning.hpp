// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/roomy_vector.hpp"
#include "kelpie/core/archive.hpp"
#include "svr/sample_collector.hpp"

namespace kelpie {

/// Order in which a reset model relearns the samples of a buffer, a few per update. Consecutive
/// samples are spread over the buffer, because neighbours in time are strongly correlated. Samples
/// removed from the buffer meanwhile are skipped. Allocates in the constructor only.
class Relearning {
 public:
  /// For buffers of up to `places` samples; done at first.
  explicit Relearning(std::size_t places) { arrivals_.reserve(places); }

  /// Starts `rounds` rounds over the samples of the buffer. Requires rounds > 0. Cost O(n log n).
  void begin(const SampleCollector& buffer, int rounds);

  /// The place of the next sample in the buffer; empty for a removed sample. Requires
  /// !round_done().
  std::optional<std::size_t> next(const SampleCollector& buffer);

  bool round_done() const { return arrivals_.empty(); }            ///< This round.
  bool done() const { return arrivals_.empty() && rounds_ == 0; }  ///< The last round.

  /// Starts the next round over the buffer's present samples. Requires round_done() and !done().
  void next_round(const SampleCollector& buffer) { begin(buffer, rounds_); }

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  RoomyVector<std::uint64_t> arrivals_;  ///< of this round, in reverse order
  int rounds_ = 0;                       ///< further rounds
};

}  // namespace kelpie
