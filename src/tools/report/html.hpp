// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "report/next_steps.hpp"
#include "study/result.hpp"

namespace kelpie::report {

/// The result as one HTML file with its own scripts and no network. The first screen has the
/// headline, how good each axis is, the inputs and `next`; parts for developers are folded.
/// Readable on a phone, printed, and on dark screens; well-formed XML. Text from the input is
/// escaped.
std::string report_html(const study::StreamResult& result, const std::vector<NextStep>& next = {});

}  // namespace kelpie::report
