// SPDX-License-Identifier: Apache-2.0
#include "study/novelty.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace kelpie::study {
namespace {

constexpr std::size_t kBins = 10;

struct Sum {
  double rows = 0.0;
  double square = 0.0;
  double held = 0.0;
};

}  // namespace

std::vector<NoveltyBin> errors_by_novelty(std::span<const double> truth,
                                          std::span<const Prediction> predicted) {
  std::array<Sum, kBins> sums;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Prediction& one = predicted[i];
    if (std::isnan(one.novelty)) {
      continue;
    }
    const auto bin = static_cast<std::size_t>(one.novelty * static_cast<double>(kBins));
    Sum& sum = sums[std::min(bin, kBins - 1)];
    sum.rows += 1.0;
    sum.square += (truth[i] - one.value) * (truth[i] - one.value);
    sum.held += one.lower <= truth[i] && truth[i] <= one.upper ? 1.0 : 0.0;
  }
  if (std::ranges::all_of(sums, [](const Sum& sum) { return sum.rows == 0.0; })) {
    return {};
  }
  std::vector<NoveltyBin> bins;
  for (std::size_t i = 0; i < kBins; ++i) {
    const auto place = static_cast<double>(i);
    const Sum& sum = sums[i];
    bins.push_back({place / kBins, (place + 1.0) / kBins, static_cast<std::size_t>(sum.rows),
                    std::sqrt(sum.square / sum.rows), sum.held / sum.rows});
  }
  return bins;
}

}  // namespace kelpie::study
