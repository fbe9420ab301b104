// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "log/dataset.hpp"

namespace kelpie::cli {

/// Rows of the simulated vehicle Dagon for `duration_s` at 10 Hz, with noise as recorded; in the
/// second half th2 gives 60 % of its thrust. Equal durations give equal rows. Throws InputError
/// (--duration) on a duration that is no whole number of rows.
log::Dataset demo_rows(double duration_s);

}  // namespace kelpie::cli
