// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "chart/text_table.hpp"
#include "study/result.hpp"

namespace kelpie::report {

/// How much each member of an axis' committee is believed at the end, with a note on what they are.
/// No rows where every axis has one learner.
chart::TextTable member_table(const study::StreamResult& result);

}  // namespace kelpie::report
