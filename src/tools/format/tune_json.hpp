// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "study/tune.hpp"

namespace kelpie::format {

/// A search as JSON: header, chosen values, scores by target and log, every evaluation
/// (docs/howto/studies.md). The same search gives the same bytes; NaN becomes null.
std::string tune_json(const study::TuneResult& result, const study::TuneJournal::Header& header);

}  // namespace kelpie::format
