// SPDX-License-Identifier: Apache-2.0
#include "learner/relearning.hpp"

#include <algorithm>
#include "learner/tuning.hpp"

namespace kelpie {
namespace {

// Puts any first few of consecutive numbers evenly among them: a golden section of their range.
std::uint64_t spread(std::uint64_t number) {
  return number * 0x9E3779B97F4A7C15U;
}

}  // namespace

void Relearning::begin(const SampleCollector& buffer, int rounds) {
  rounds_ = rounds - 1;
  arrivals_.assign(buffer.arrivals().begin(), buffer.arrivals().end());
  std::ranges::sort(arrivals_, {}, &spread);
}

std::optional<std::size_t> Relearning::next(const SampleCollector& buffer) {
  const std::uint64_t arrival = arrivals_.back();
  arrivals_.pop_back();
  const auto found = std::ranges::find(buffer.arrivals(), arrival);
  return found == buffer.arrivals().end()
             ? std::nullopt
             : std::optional(static_cast<std::size_t>(found - buffer.arrivals().begin()));
}

void Relearning::visit(Archive& archive) {
  archive.list(arrivals_, arrivals_.capacity(),
               [&](std::uint64_t& arrival) { archive.whole(arrival); });
  archive.whole(rounds_, 0, kOnline.members.rounds - 1);
}

}  // namespace kelpie
