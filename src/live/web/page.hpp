// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "live/configuration.hpp"
#include "live/output.hpp"
#include "live/requests.hpp"
#include "web/access.hpp"
#include "web/feed.hpp"
#include "web/server.hpp"

namespace kelpie::web {

/// The page of a live run, with metrics and buttons (howto/live.md). Results go into a Feed,
/// which a Server shows; a slow browser delays no result.
class Page final : public live::Output {
 public:
  /// Listens at `configuration.live.page`, with the configuration's token; away from the loopback
  /// interface with a new one. Requires that both outlive this. Throws InputError (live.page) on a
  /// port in use or an unknown host.
  Page(const live::Configuration& configuration, live::Requests& requests);

  std::string address() const;  ///< To open in a browser, with the token.

  void learned(const live::LearnedSample& sample) override { feed_.add(sample); }
  void health(const live::Health& health) override { feed_.add(health); }
  void event(const std::string& line) override { feed_.add(line); }
  void ended() override { feed_.end(); }

 private:
  live::Endpoint endpoint_;
  Access access_;
  Feed feed_;
  Server server_;
};

}  // namespace kelpie::web
