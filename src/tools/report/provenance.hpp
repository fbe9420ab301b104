// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "study/result.hpp"

namespace kelpie::report {

/// The physics terms of a run, the inputs used as velocities, and the reason; empty without known
/// settings.
std::string terms_text(const study::StreamResult& result);

/// The data and their use, for the end of a page.
std::string data_section(const study::StreamResult& result);
std::string settings_section(const study::StreamResult& result);  ///< Empty where unknown.

}  // namespace kelpie::report
