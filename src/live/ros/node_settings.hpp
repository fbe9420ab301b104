// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "dds/names.hpp"
#include "dds/network.hpp"
#include "dds/quality.hpp"
#include "file/toml.hpp"

namespace kelpie::ros {

/// The table [live.dds] of a configuration file (docs/howto/live.md): network, names and quality of
/// service of the node.
struct NodeSettings {
  dds::Network network;
  dds::TopicNames names;
  std::string node = "kelpie";
  std::string frame = "base_link";                        ///< frame_id of predictions
  dds::Quality subscribed = dds::Quality::sensor_data();  ///< requested of publishers
  dds::Quality published = dds::Quality::standard();      ///< offered to subscribers
  dds::Quality commands = dds::Quality::standard();       ///< requested of senders of commands

  bool operator==(const NodeSettings&) const = default;
};

/// Reads the table, with ROS_DOMAIN_ID and CYCLONEDDS_URI as defaults. Throws InputError (file,
/// line, key) on an invalid domain or name, an unknown interface, a missing file.
NodeSettings read_node_settings(const std::optional<file::TomlNode>& table);

}  // namespace kelpie::ros
