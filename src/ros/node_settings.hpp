// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "dds/names.hpp"
#include "dds/network.hpp"
#include "dds/quality.hpp"
#include "file/toml.hpp"

namespace kelpie::ros {

/// The table [live.dds] of a configuration file (docs/live.md): where kelpie is among the nodes of
/// ROS 2, and what it is called there.
struct NodeSettings {
  dds::Network network;
  dds::TopicNames names;
  std::string node = "kelpie";
  std::string frame = "base_link";                        ///< frame_id of predictions
  dds::Quality subscribed = dds::Quality::sensor_data();  ///< asked of publishers
  dds::Quality published = dds::Quality::standard();      ///< offered to subscribers
  dds::Quality commands = dds::Quality::standard();       ///< asked of who sends commands

  bool operator==(const NodeSettings&) const = default;
};

/// What the table says, over ROS_DOMAIN_ID and CYCLONEDDS_URI. Throws InputError (file, line, key)
/// on what it can't be: no domain, no name, no interface of this machine, no file.
NodeSettings read_node_settings(const std::optional<file::TomlNode>& table);

}  // namespace kelpie::ros
