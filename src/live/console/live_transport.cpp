// SPDX-License-Identifier: Apache-2.0
#include "console/live_transport.hpp"

#include "autopilot/link_transport.hpp"
#include "cli/output.hpp"
#include "kelpie/core/error.hpp"
#include "live/replay.hpp"
#ifdef KELPIE_WITH_DDS
#include "ros/topic_transport.hpp"
#endif
#ifdef KELPIE_WITH_WEB
#include "web/page.hpp"
#endif

namespace kelpie::cli {
namespace {

std::unique_ptr<live::Transport> recording(const log::LogSource& from, const std::string& speed,
                                           const live::Configuration& configuration,
                                           const std::optional<live::SavedRun>& saved) {
  auto replay = std::make_unique<live::Replay>(from, configuration, live::parse_speed(speed));
  if (saved && saved->progress.recording == replay->reach()) {
    replay->hurry_until(saved->progress.received_ns);
  }
  return replay;
}

#ifdef KELPIE_WITH_DDS

std::unique_ptr<live::Transport> topics(const live::Configuration& configuration) {
  return std::make_unique<ros::TopicTransport>(configuration,
                                               ros::read_node_settings(configuration.live.dds));
}

#else

std::unique_ptr<live::Transport> topics(const live::Configuration& configuration) {
  const std::string why = "this kelpie was built without Cyclone DDS, so it has no topics of ROS 2";
  if (configuration.live.dds) {
    configuration.live.dds->refuse(why);
  }
  throw InputError("--replay", "is missing: a recording to be replayed; " + why);
}

#endif

}  // namespace

std::unique_ptr<live::Transport> transport_of(const log::LogSource& from, const std::string& speed,
                                              const live::Configuration& configuration,
                                              const std::optional<live::SavedRun>& saved) {
  if (!from.path.empty() || configuration.rows) {
    return recording(from, speed, configuration, saved);
  }
  if (const auto& mavlink = configuration.live.mavlink) {
    if (configuration.live.dds) {
      mavlink->refuse("stands beside [live.dds]; messages come by one of them");
    }
    return autopilot::open_link(configuration, *mavlink);
  }
  return topics(configuration);
}

bool connects_alike(const live::Configuration& now, const live::Configuration& next) {
  if (now.live.mavlink && next.live.mavlink) {
    return autopilot::read_link_settings(*now.live.mavlink) ==
           autopilot::read_link_settings(*next.live.mavlink);
  }
  if (now.live.mavlink || next.live.mavlink) {
    return false;
  }
#ifdef KELPIE_WITH_DDS
  return ros::read_node_settings(now.live.dds) == ros::read_node_settings(next.live.dds);
#else
  return true;
#endif
}

bool has_pages() {
#ifdef KELPIE_WITH_WEB
  return true;
#else
  return false;
#endif
}

std::unique_ptr<live::Output> page_of(const live::Configuration& configuration,
                                      [[maybe_unused]] live::Requests& requests) {
  if (configuration.live.page.empty()) {
    return nullptr;
  }
#ifdef KELPIE_WITH_WEB
  auto page = std::make_unique<web::Page>(configuration, requests);
  warn("kelpie: page: {}\n", page->address());
  return page;
#else
  throw InputError("live.page", "this kelpie was built without libmicrohttpd and has no page");
#endif
}

}  // namespace kelpie::cli
