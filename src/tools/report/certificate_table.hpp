// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "chart/text_table.hpp"
#include "study/certificate.hpp"

namespace kelpie::report {

/// A row per engine: its step, R² after 1, 10 and 40 s on the axes that move, the largest stable
/// step and what bounds it.
chart::TextTable certificate_view(const study::CertificateList& list);

/// One sentence per engine whose own step is unstable, with the term to blame.
std::vector<std::string> certificate_remarks(const study::CertificateList& list);

}  // namespace kelpie::report
