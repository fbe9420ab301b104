// SPDX-License-Identifier: Apache-2.0
#include "model/first_moves.hpp"

#include <cmath>
#include <utility>

#include "model/tuning.hpp"

namespace kelpie {

FirstMoves::FirstMoves(std::vector<std::size_t> commands)
    : commands_(std::move(commands)), moments_(commands_.size()), values_(commands_.size()) {}

bool FirstMoves::update(std::span<const double> x) {
  bool moves = false;
  for (std::size_t i = 0; i < commands_.size(); ++i) {
    values_[i] = x[commands_[i]];
    const double usual = std::sqrt(moments_.covariance(i, i));
    moves = moves || (moments_.count() > 0 &&
                      std::abs(values_[i] - moments_.mean()[i]) > kModelTuning.scale.far * usual);
  }
  moments_.add(values_);
  return moves;
}

void FirstMoves::visit(Archive& archive) {
  archive.part("commands", moments_);
}

}  // namespace kelpie
