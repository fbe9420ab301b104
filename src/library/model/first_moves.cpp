// SPDX-License-Identifier: Apache-2.0
#include "model/first_moves.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/tuning.hpp"

namespace kelpie {

FirstMoves::FirstMoves(std::vector<std::size_t> commands, std::size_t axes)
    : commands_(std::move(commands)),
      moments_(commands_.size()),
      values_(commands_.size()),
      axes_(axes) {}

bool FirstMoves::update(std::span<const double> x, std::span<const double> y,
                        std::span<const Decision> decisions) {
  bool moves = false;
  for (std::size_t i = 0; i < commands_.size(); ++i) {
    values_[i] = x[commands_[i]];
    const double usual = std::sqrt(moments_.covariance(i, i));
    moves = moves || (moments_.count() > 0 && std::abs(values_[i] - moments_.mean()[i]) >
                                                  kModelTuning.first_moves.far * usual);
  }
  moments_.add(values_);
  const bool known = explains();
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (Explained& axis = axes_[i]; decisions[i].had_model) {
      const double error = y[i] - decisions[i].prediction.value;
      const double before = y[i] - axis.mean;
      axis.samples += 1.0;
      axis.mean += before / axis.samples;
      axis.spread += before * (y[i] - axis.mean);
      axis.unexplained += error * error;
    }
  }
  return moves && !known;
}

bool FirstMoves::explains() const {
  return std::ranges::any_of(axes_, [](const Explained& axis) {
    return axis.unexplained < (1.0 - kModelTuning.first_moves.explained) * axis.spread;
  });
}

void FirstMoves::visit(Archive& archive) {
  archive.part("commands", moments_);
  for (Explained& axis : axes_) {
    for (double* const number : {&axis.samples, &axis.mean, &axis.spread, &axis.unexplained}) {
      archive.number(*number);
    }
  }
}

}  // namespace kelpie
