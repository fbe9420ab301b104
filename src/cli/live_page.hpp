// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "live/configuration.hpp"
#include "live/output.hpp"
#include "live/requests.hpp"

namespace kelpie::cli {

/// The page of a configuration, listening, its address printed; null without live.page. Requires
/// that both arguments outlive the page. Throws InputError (live.page) where no page is possible.
std::unique_ptr<live::Output> page_of(const live::Configuration& configuration,
                                      live::Requests& requests);

}  // namespace kelpie::cli
