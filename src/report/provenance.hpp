// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "study/result.hpp"

namespace kelpie::report {

/// Which physics terms a run had, and which inputs it took for velocities, with why; empty where
/// the settings aren't known.
std::string terms_text(const study::StreamResult& result);

/// The end of a page: the data and how they were used; and the settings, empty where not known.
std::string data_section(const study::StreamResult& result);
std::string settings_section(const study::StreamResult& result);  ///< As above.

}  // namespace kelpie::report
