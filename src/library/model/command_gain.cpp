// SPDX-License-Identifier: Apache-2.0
#include "model/command_gain.hpp"

#include <cmath>

namespace kelpie {

double term_gain(const TermSet& terms, std::size_t k, std::span<const CommandGain> gains) {
  double product = 1.0;
  for (const CommandGain& gain : gains) {
    const double power = gain.factor != 1.0 ? terms.power(k, gain.input) : 0.0;
    product *= std::isfinite(power) ? std::pow(gain.factor, power) : 1.0;
  }
  return product;
}

}  // namespace kelpie
