// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kelpie/core/scaling.hpp"
#include "kelpie/model/online_model.hpp"
#include "kelpie/model/settings.hpp"
#include "lab/settings_search.hpp"
#include "log/dataset.hpp"

namespace kelpie::lab {

/// A learner in a comparison: names, settings and a factory.
struct Contender {
  std::string key;       ///< for files: "paper", "fifo", "sosvr", "default", …
  std::string name;      ///< for people
  std::string settings;  ///< "name=value name=value …"
  /// Makes a fresh model of the log's targets; without scales, the first samples give the scale.
  /// Safe from many threads.
  std::function<std::unique_ptr<OnlineModel>(const log::Dataset& data,
                                             std::span<const AxisScaling> scales)>
      make;
  SharedSettings shared{};  ///< of given scales
};

/// The learner of one axis of `learner = svr`, for every axis, without a bound of work.
Contender online_svr_contender(std::string key, std::string name, const ModelSettings& settings);

/// A DynamicsModel with these settings, as every user has it.
Contender model_contender(std::string key, std::string name, const ModelSettings& settings);

/// SOSVR with a dictionary of this size; `values` are settings for every axis.
Contender sosvr_contender(int dictionary, const AxisValues& values = {});
Contender rls_contender(std::string key, double lambda);  ///< λ of forgetting, in (0, 1]

/// The part of a row in the reproduction.
enum class RowKind {
  paper,     ///< the paper's learner, by the paper's rules
  baseline,  ///< another learner, with the buffer and kernel of the paper's
  addition,  ///< the paper's learner with additions of kelpie's
  kelpie,    ///< ModelSettings as they are by default
  entry,     ///< a learner of the reader's
};

/// A row of the reproduction. Rows with searched settings take the values found for `family`.
struct Row {
  const char* key;
  RowKind kind;
  const char* name;
  std::string_view family = {};  ///< of searched_families(); empty: nothing is searched
  std::function<Contender(const Row& row, const AxisValues& found, std::size_t axes)> make;
  bool slow = false;  ///< run with the first seed on the paper's streams alone
};

/// All rows, in the order of the tables.
const std::vector<Row>& reproduction_rows();

/// Learners with searched settings: the paper's, and SOSVR.
struct Family {
  const char* key;
  SettingsGrid grid;
  SettingsGrid quick;  ///< with fewer values
  AxisFactory make;
};
const std::vector<Family>& searched_families();

/// For the opponents' streams, a single axis: the learner of one axis and FIFO with settings found
/// on training rows, the default, SOSVR, recursive least squares.
std::vector<Contender> peer_contenders();

}  // namespace kelpie::lab
