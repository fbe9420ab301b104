// SPDX-License-Identifier: Apache-2.0
#include "model/model_axis.hpp"

#include "kelpie/core/error.hpp"
#include "model/posterior_axis.hpp"
#include "model/svr_axis.hpp"

namespace kelpie {

std::unique_ptr<ModelAxis> make_axis(std::size_t inputs, const SharedSettings& shared,
                                     const OnlineSvrSettings& settings, const TermSet& terms,
                                     std::span<const std::size_t> states,
                                     std::optional<AxisScaling> scaling) {
  if (shared.learner == LearnerKind::svr) {
    return std::make_unique<SvrAxis>(inputs, shared, settings, terms, std::move(scaling));
  }
  require(!scaling, "scaling", "'learner = posterior' takes no scale");
  return std::make_unique<PosteriorAxis>(inputs, shared, settings, terms, states);
}

}  // namespace kelpie
