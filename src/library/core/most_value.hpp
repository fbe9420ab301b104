// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kelpie {

/// The largest value of a valid sample: sums of products stay finite.
inline constexpr double kMostValue = 1e50;

}  // namespace kelpie
