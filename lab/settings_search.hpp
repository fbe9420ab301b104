// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kelpie/svr/regressor.hpp"
#include "lab/cross_validation.hpp"
#include "log/dataset.hpp"

namespace kelpie::lab {

using NamedValues = std::vector<std::pair<std::string, std::string>>;
using AxisValues = std::vector<NamedValues>;  ///< settings by axis

/// Settings to search, in this order, each with its values; the search starts from the first.
using SettingsGrid = std::vector<std::pair<std::string, std::vector<std::string>>>;

/// Makes a learner of target number `axis` with these settings. Safe from many threads.
using AxisFactory = std::function<std::unique_ptr<OnlineRegressor>(
    const log::Dataset& data, std::size_t axis, const NamedValues& values)>;

struct FoundSettings {
  NamedValues values;
  double r2 = 0.0;       ///< cross-validated
  std::size_t runs = 0;  ///< streams learned
};

/// Searches one setting after the other, the others held at the best values so far, by
/// cross-validation on `rows`: a learner is shown the rows of all folds but one in the order of
/// time, and then predicts the rows of that fold. R² is pooled over the folds. Of equal values the
/// first wins. Reads no other rows. `keep_going` after every stream; false stops the search.
/// Requires more rows than folds.
FoundSettings search_settings(const log::Dataset& data, std::span<const std::size_t> rows,
                              std::size_t axis, const Folds& folds, const SettingsGrid& grid,
                              const AxisFactory& make, const std::function<bool()>& keep_going);

}  // namespace kelpie::lab
