// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "live/configuration.hpp"
#include "live/output.hpp"
#include "live/requests.hpp"

namespace kelpie::cli {

/// The page that a configuration asks for, listening, its address said; null: it asks for none.
/// Both have to outlive it. Throws InputError (live.page) where it can't be.
std::unique_ptr<live::Output> page_of(const live::Configuration& configuration,
                                      live::Requests& requests);

}  // namespace kelpie::cli
