// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "file/json.hpp"
#include "lab/reproduction.hpp"

namespace kelpie::lab {

/// All numbers: the plan, the streams with every row and seed, and the claims. The same plan gives
/// the same document, except for "update_us". NaN is null.
file::Json reproduction_document(const Reproduction& result);

/// Judges the claims of a document anew, by today's rules. Throws InputError on another document.
void judge_claims(file::Json& document);

// Pages of a document. Whatever they say is computed from the document's numbers.

/// The self-contained page with figures: HTML without network access, well-formed XML.
std::string reproduction_html(const file::Json& document);
/// The beginning of docs/measured/reproduction.md: words and tables of the page, without settings
/// and times.
std::string reproduction_markdown(const file::Json& document);
/// For a terminal: verdicts, and R² at the end of each configuration.
std::string reproduction_table(const file::Json& document);

}  // namespace kelpie::lab
