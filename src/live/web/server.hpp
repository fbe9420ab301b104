// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "live/configuration.hpp"
#include "live/requests.hpp"
#include "web/access.hpp"
#include "web/feed.hpp"
#include "web/tuning.hpp"

namespace kelpie::web {

/// HTTP server of the page, in threads of its own:
///
///     GET  /         the page
///     GET  /events   EventStream, at most 10 texts per second
///     GET  /metrics  metrics_text
///     POST /save, /freeze, /resume, /reset
///
/// Tuning limits readers, other requests (further connections wait), bytes and seconds of a
/// request; a connection serves one request.
class Server {
 public:
  static constexpr std::size_t kStreams = kTuning.streams;

  /// Requires that all references outlive the server.
  struct Parts {
    const live::Configuration& configuration;
    const Feed& feed;
    live::Requests& requests;
    const Access& access;
    std::string page;  ///< HTML
  };

  /// Starts to listen. Throws InputError (field) on a port in use.
  Server(const live::Endpoint& endpoint, const std::string& field, Parts parts);
  ~Server();  ///< Closes all connections within a second.
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

 private:
  class Http;

  std::unique_ptr<Http> http_;
};

}  // namespace kelpie::web
