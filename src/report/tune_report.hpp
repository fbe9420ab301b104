// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "study/tune.hpp"

namespace kelpie::report {

/// For a terminal: the tuned values of each axis, those of Table I first, beside those of the
/// reference "paper" (where there is one); then the scores of references and tuned settings.
std::string tune_table(const study::TuneResult& result);

/// Everything as JSON: header, rungs, chosen values, scores, all evaluations (docs/tuning.md).
/// The same search gives the same bytes. NaN is written as null.
std::string tune_json(const study::TuneResult& result, const study::TuneJournal::Header& header);

/// The tuned settings for `--config`, with comments on where they come from.
std::string tuned_toml(const study::TuneResult& result, const study::TuneJournal::Header& header);

}  // namespace kelpie::report
