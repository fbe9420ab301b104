// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "live/configuration.hpp"
#include "live/output.hpp"
#include "live/requests.hpp"
#include "web/access.hpp"
#include "web/feed.hpp"
#include "web/server.hpp"

namespace kelpie::web {

/// The page of a live run, with its metrics and buttons (docs/live.md). What it is told it keeps,
/// and a Server shows it: nobody who tells it anything waits for a browser.
class Page final : public live::Output {
 public:
  /// At the address in `configuration.live.page`, which isn't empty, with its token, or where it
  /// isn't on the loopback interface one made up. Both have to outlive it. Throws InputError
  /// (live.page) where the port can't be had, or there is no such host.
  Page(const live::Configuration& configuration, live::Requests& requests);

  /// As it is opened, token and all.
  std::string address() const;

  void learned(const live::LearnedSample& sample) override { feed_.add(sample); }
  void health(const live::Health& health) override { feed_.add(health); }
  void event(const std::string& line) override { feed_.add(line); }

 private:
  live::Endpoint endpoint_;
  Access access_;
  Feed feed_;
  Server server_;
};

}  // namespace kelpie::web
