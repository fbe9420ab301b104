// SPDX-License-Identifier: Apache-2.0
#include "learner/seen_range.hpp"

#include <algorithm>
#include <functional>

#include "learner/tuning.hpp"

namespace kelpie {
namespace {

// Puts a value in its place among the first ones by `before`; the last of them leaves.
template <typename Ends, typename Before>
void insert(Ends& ends, std::size_t count, double y, Before before) {
  const std::size_t last = std::min(count, ends.size() - 1);
  if (count < ends.size() || before(y, ends[last])) {
    ends[last] = y;
    std::sort(ends.begin(), ends.begin() + static_cast<std::ptrdiff_t>(last) + 1, before);
  }
}

}  // namespace

void SeenRange::add(double y) {
  insert(least_, count_, y, std::less<>());
  insert(greatest_, count_, y, std::greater<>());
  ++count_;
}

ValueRange SeenRange::range() const {
  if (count_ == 0) {
    return {};
  }
  if (count_ < kLeast) {
    return {.low = least_.front() - kOnline.range.early_margin,
            .high = greatest_.front() + kOnline.range.early_margin};
  }
  const double margin = margin_ * (greatest_.back() - least_.back());
  return {.low = least_.back() - margin, .high = greatest_.back() + margin};
}

void SeenRange::rescale(double gain, double offset) {
  for (auto* const ends : {&least_, &greatest_}) {
    for (double& end : *ends) {
      end = gain * end + offset;
    }
  }
}

void SeenRange::visit(Archive& archive) {
  archive.numbers(least_);
  archive.numbers(greatest_);
  archive.whole(count_);
}

SeenTermRanges::SeenTermRanges(std::size_t terms)
    : seen_(terms, SeenRange(kOnline.range.term_margin)), ranges_(terms) {}

void SeenTermRanges::measure() {
  std::ranges::transform(seen_, ranges_.begin(), &SeenRange::range);
}

void SeenTermRanges::add(std::span<const double> z) {
  const std::span<const double> terms = z.last(seen_.size());
  for (std::size_t k = 0; k < terms.size(); ++k) {
    seen_[k].add(terms[k]);
  }
  measure();
}

void SeenTermRanges::rescale(std::span<const double> factors) {
  for (std::size_t k = 0; k < seen_.size(); ++k) {
    seen_[k].rescale(factors[k], 0.0);
  }
  measure();
}

void SeenTermRanges::visit(Archive& archive) {
  std::size_t terms = seen_.size();
  archive.whole(terms);
  archive.require(terms == seen_.size(), "limits of other terms");
  for (SeenRange& seen : seen_) {
    archive.part("seen term", seen);
  }
  if (archive.loading()) {
    measure();
  }
}

}  // namespace kelpie
