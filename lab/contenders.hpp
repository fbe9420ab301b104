// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kelpie/core/scaling.hpp"
#include "kelpie/model/settings.hpp"
#include "kelpie/svr/regressor.hpp"

namespace kelpie::lab {

/// A learner in a comparison: names, settings and a factory.
struct Contender {
  std::string key;       ///< for files: "proposed", "fifo", "sosvr", "rls", "paper"
  std::string name;      ///< for people
  std::string settings;  ///< "name=value name=value …"
  /// Makes a fresh learner of target number `axis`; an empty scaling is found from the first
  /// samples. Safe from many threads.
  std::function<std::unique_ptr<OnlineRegressor>(
      std::span<const std::string> inputs, std::size_t axis, std::optional<AxisScaling> scaling)>
      make;
  SharedSettings shared{};  ///< of a given scaling
  std::string twin{};       ///< key of the contender with equal results until a sample is forgotten
};

/// The learner of the paper under settings with values for every axis.
Contender online_svr_contender(std::string key, std::string name, const ModelSettings& settings);

Contender sosvr_contender();                              ///< With its own default settings.
Contender rls_contender(std::string key, double lambda);  ///< λ of forgetting, in (0, 1]

/// The proposed learner (the paper's, alone, with the default preset's values), FIFO forgetting,
/// the committee of the default preset, SOSVR, recursive least squares with three forgetting
/// factors, and, last, the paper's preset as written; for at most three axes.
std::vector<Contender> paper_contenders(std::size_t axes);

/// For the opponents' streams, a single axis: the proposed learner and FIFO with settings found on
/// training rows, the committee, SOSVR, recursive least squares.
std::vector<Contender> peer_contenders();

/// The proposed learner and FIFO with a buffer small enough to fill up, so that forgetting matters.
std::vector<Contender> small_buffer_contenders(std::size_t axes, int buffer);

}  // namespace kelpie::lab
