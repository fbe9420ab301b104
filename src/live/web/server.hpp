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

/// HTTP server of the page, in one thread of low priority:
///
///     GET  /         the page
///     GET  /events   EventStream, at most 10 texts per second
///     GET  /metrics  metrics_text
///     POST /save, /freeze, /resume, /reset
///
/// A connection serves one request. Before any work the server refuses a long or coded body, and
/// drops a short body unread. Ranges and codings have no effect: every answer is whole. Tuning
/// limits bytes, seconds, readers of /events and other connections; a further connection closes the
/// oldest connection without an answer.
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

  /// Starts to listen. Throws InputError (field) on a port in use or an unknown host, and Failure.
  Server(const live::Endpoint& endpoint, const std::string& field, Parts parts);
  ~Server();  ///< Closes all connections within a second.
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

 private:
  class Http;

  std::unique_ptr<Http> http_;
};

}  // namespace kelpie::web
