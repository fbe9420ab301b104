// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lab/reproduction.hpp"

namespace kelpie::lab {

// Parts of the reproduction's page.

/// What of the paper holds, and what does not.
std::string claims_section(const Reproduction& result);

/// The settings beside the paper's Table I.
std::string parameters_section();

/// The published experiment with a buffer of 100.
std::string published_section(const Reproduction& result);

/// The opponents' streams.
std::string peers_section(const Reproduction& result);

}  // namespace kelpie::lab
