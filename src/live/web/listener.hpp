// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "live/configuration.hpp"

namespace kelpie::web {

/// A listening TCP socket, for the caller to close. No other program can listen at the same port.
/// Throws InputError (field) on an unknown host or a port in use.
int listen_at(const live::Endpoint& endpoint, const std::string& field);

/// Whether all addresses of a host are loopback addresses. Throws InputError (field) on an unknown
/// host.
bool is_loopback(const std::string& host, const std::string& field);

}  // namespace kelpie::web
