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
#include "kelpie/learner/regressor.hpp"
#include "kelpie/model/settings.hpp"

namespace kelpie::lab {

/// A learner that enters a comparison: how it is called and how one of its axes is made.
struct Contender {
  std::string key;       ///< for files: "proposed", "fifo", "sosvr", "rls", "paper"
  std::string name;      ///< for people
  std::string settings;  ///< "name=value name=value …"
  /// Makes a fresh learner of target number `axis`. Without a scaling it finds its own from the
  /// first samples. Safe from many threads.
  std::function<std::unique_ptr<OnlineRegressor>(
      std::span<const std::string> inputs, std::size_t axis, std::optional<AxisScaling> scaling)>
      make;
  SharedSettings shared{};  ///< what a scaling that is given has to be made for
  std::string twin{};  ///< key of the contender it can't differ from before something is forgotten
};

/// The learner of the paper under some settings, which have values for every axis it is made for.
Contender online_svr_contender(std::string key, std::string name, const ModelSettings& settings);

Contender sosvr_contender();                              ///< With its own default settings.
Contender rls_contender(std::string key, double lambda);  ///< λ of forgetting, in (0, 1]

/// The proposed learner (the paper's, alone, with the default preset's values) and the same with
/// FIFO forgetting, the committee that the default preset is, SOSVR, recursive least squares with
/// three forgetting factors, and, last, the paper's preset as written; for at most three axes.
std::vector<Contender> paper_contenders(std::size_t axes);

/// For the opponents' streams: the proposed learner and FIFO with settings found on their training
/// rows, the committee, SOSVR, recursive least squares; for one axis.
std::vector<Contender> peer_contenders();

/// The proposed learner and FIFO with a buffer so small that it fills up: only then does it matter
/// who is forgotten.
std::vector<Contender> small_buffer_contenders(std::size_t axes, int buffer);

}  // namespace kelpie::lab
