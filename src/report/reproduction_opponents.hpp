// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kelpie/study/reproduction.hpp"

namespace kelpie {

/// The part of the page on the published experiment with a buffer of 100.
std::string published_section(const Reproduction& result);

/// The part of the page on the opponents' streams.
std::string peers_section(const Reproduction& result);

}  // namespace kelpie
