// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kelpie/model/open_loop.hpp"
#include "kelpie/model/trained_model.hpp"
#include "log/dataset.hpp"
#include "study/open_loop_study.hpp"
#include "study/split.hpp"

namespace kelpie::study {

/// What open-loop accuracy is measured of.
struct OpenLoopContender {
  std::string name;
  OpenLoop loop;
};

/// The model as `loop` rolls it out; the learned model alone, where `loop` fades into the steady
/// part after `fade_s`; recursive least squares trained on the same rows in their order, where the
/// velocities are the first inputs; and the velocity held.
std::vector<OpenLoopContender> open_loop_contenders(const TrainedModel& model, const OpenLoop& loop,
                                                    const log::Dataset& data, const Split& split,
                                                    double fade_s);

/// Fills in the result's example: of the rollouts over the longest horizon, begun every ten
/// seconds, the one whose velocities move most.
void add_example(OpenLoopResult& result, const OpenLoop& loop, const log::Dataset& data,
                 std::span<const Stretch> stretches, const OpenLoopStudy& study);

}  // namespace kelpie::study
