// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "chart/text_table.hpp"
#include "study/tune.hpp"

namespace kelpie::report {

/// The tuned values of each axis, those of Table I first, beside those of the reference "paper"
/// (where there is one); then the scores of references and tuned settings; and of several logs each
/// one's.
std::vector<chart::TextTable> tune_tables(const study::TuneResult& result);
std::string tune_table(const study::TuneResult& result);  ///< These for a terminal.

/// On how many logs the tuned settings are worse than those the search started from, and where
/// most; empty: on none.
std::string worse_text(const study::TuneResult& result);

/// One page: the candidates of each axis by score and by the solver's work, and these tables. The
/// same search gives the same bytes.
std::string tune_html(const study::TuneResult& result, const study::TuneJournal::Header& header);

/// The tuned settings for `--config`, with comments on where they come from.
std::string tuned_toml(const study::TuneResult& result, const study::TuneJournal::Header& header);

}  // namespace kelpie::report
