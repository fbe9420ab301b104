// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "live/configuration.hpp"
#include "live/requests.hpp"
#include "web/access.hpp"
#include "web/feed.hpp"

namespace kelpie::web {

/// Answers browsers, in threads of its own:
///
///     GET  /         the page
///     GET  /events   EventStream, at most 10 texts per second
///     GET  /metrics  metrics_text
///     POST /save, /freeze, /resume, /reset
///
/// Limits: kStreams readers of events, kOthers other requests at a time (further ones wait to be
/// accepted), 16 kB and 10 s per request, one request per connection.
class Server {
 public:
  static constexpr std::size_t kStreams = 8;
  static constexpr std::size_t kOthers = 4;

  /// What it needs; all have to outlive it.
  struct Parts {
    const live::Configuration& configuration;
    const Feed& feed;
    live::Requests& requests;
    const Access& access;
    std::string page;  ///< HTML
  };

  /// Listens from now on. Throws InputError (field) where the port can't be had.
  Server(const live::Endpoint& endpoint, const std::string& field, Parts parts);
  /// Hangs up on everybody: within a second.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

 private:
  class Http;

  std::unique_ptr<Http> http_;
};

}  // namespace kelpie::web
