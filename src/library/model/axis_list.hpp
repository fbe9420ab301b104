// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "kelpie/model/online_model.hpp"
#include "kelpie/svr/regressor.hpp"
#include "model/update_state.hpp"

namespace kelpie {

/// A model of any learners, one per axis.
class AxisList final : public OnlineModel {
 public:
  /// Requires that no learner is null.
  explicit AxisList(std::vector<std::unique_ptr<OnlineRegressor>> axes)
      : axes_(std::move(axes)), state_(axes_.size()) {}
  /// Of one axis.
  explicit AxisList(std::unique_ptr<OnlineRegressor> axis) : state_(1) {
    axes_.push_back(std::move(axis));
  }

  using OnlineModel::update;
  void update(std::span<const double> x, std::span<const double> y, double t,
              const AxisDone& done) override;
  void learn_held_back() override;
  std::span<const Decision> decisions() const override { return state_.decisions; }
  const OnlineRegressor& axis(std::size_t i) const override { return *axes_[i]; }

 private:
  std::vector<std::unique_ptr<OnlineRegressor>> axes_;
  UpdateState state_;
};

}  // namespace kelpie
