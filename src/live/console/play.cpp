// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>

#include "cli/interrupt.hpp"
#include "cli/options.hpp"
#include "cli/output.hpp"
#include "console/commands.hpp"
#include "kelpie/core/error.hpp"
#include "live/replay.hpp"
#include "log/read_log.hpp"
#ifdef KELPIE_WITH_DDS
#include "ros/player.hpp"
#endif

namespace kelpie::cli {
namespace {

struct PlayArguments {
  log::LogSource bag;
  std::string config;
  std::string speed = "1";
};

#ifdef KELPIE_WITH_DDS

ros::NodeSettings node_of(const std::string& config) {
  std::optional<file::TomlNode> table;
  if (!config.empty()) {
    const file::TomlNode root = file::TomlNode::read(config);
    if (root.has("live") && root["live"].has("dds")) {
      table = root["live"]["dds"];
    }
  }
  return ros::read_node_settings(table);
}

void play(const PlayArguments& options) {
  const double speed = live::parse_speed(options.speed);
  const ros::NodeSettings settings = node_of(options.config);
  const std::unique_ptr<bag::MessageReader> bag = options.bag.open_bag();
  const InterruptGuard interrupt;
  ros::Player player(*bag, settings, speed);
  player.play([] { return InterruptGuard::asked(); });
  for (const std::string& topic : player.left_out()) {
    warn("kelpie: {}\n", topic);
  }
  if (player.messages() == 0 && !player.left_out().empty() && !InterruptGuard::asked()) {
    throw InputError({.file = options.bag.path, .line = 0, .field = {}},
                     "has no message that can be published");
  }
  say("{}: {} messages published in DDS domain {}\n", options.bag.path, player.messages(),
      settings.network.domain);
}

#else

void play(const PlayArguments&) {
  throw InputError("kelpie play",
                   "this kelpie was built without Cyclone DDS, so it has no topics of ROS 2");
}

#endif

}  // namespace

void add_play(CLI::App& app) {
  const auto [command, options] = add_command(
      app, "play", "Publish a recording as topics of ROS 2, in place of the vehicle", play);
  add_file(command, "bag", options->bag.path, "a rosbag2 folder, or one .db3 or .mcap file")
      ->required();
  add_file(command, "--config", options->config,
           "TOML file whose [live.dds] says on which network (docs/howto/live.md)");
  command
      ->add_option("--speed", options->speed,
                   "times as quick as recorded, or max: without a pause, which loses messages")
      ->capture_default_str();
  add_examples(command, "play dive.bag", "play dive.bag --config vehicle.toml --speed 2");
}

}  // namespace kelpie::cli
