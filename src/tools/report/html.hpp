// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "study/result.hpp"

namespace kelpie::report {

/// The result as one HTML file with its own scripts and no network. Readable on a phone, printed,
/// and on dark screens; well-formed XML. Text from the input is escaped.
std::string report_html(const study::StreamResult& result);

}  // namespace kelpie::report
