// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "chart/text_table.hpp"
#include "study/tune.hpp"

namespace kelpie::report {

/// The tuned values of each axis, the settings of Table I first, beside the reference "paper"
/// (where given); the scores of references and tuned settings; and the scores by log.
std::vector<chart::TextTable> tune_tables(const study::TuneResult& result);
std::string tune_table(const study::TuneResult& result);  ///< tune_tables() for a terminal.

/// Whether the settings of an axis score higher on all rows than those at the start; the gains of
/// all axes in one sentence.
bool any_gain(const study::TuneResult& result);
std::string gain_sentence(const study::TuneResult& result);

/// The number of logs with worse scores than the initial settings, and the worst log; empty: no
/// log.
std::string worse_text(const study::TuneResult& result);

/// One page: the candidates of each axis by score and by the work of the solver, and the tables.
/// The same search gives the same bytes.
std::string tune_html(const study::TuneResult& result, const study::TuneJournal::Header& header);

/// The tuned settings for `--config`, with comments on their origin.
std::string tuned_toml(const study::TuneResult& result, const study::TuneJournal::Header& header);

}  // namespace kelpie::report
