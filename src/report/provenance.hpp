// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "study/result.hpp"

namespace kelpie::report {

/// The end of a page: the data, how they were used, and the settings.
std::string provenance(const study::StreamResult& result);

}  // namespace kelpie::report
