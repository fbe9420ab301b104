// SPDX-License-Identifier: Apache-2.0
#include "ros/node_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::ros {
namespace {

std::uint32_t domain_of(const file::TomlNode& value) {
  const std::uint64_t domain = value.count();
  if (domain > dds::Network::kMostDomain) {
    value.refuse(fmt::format("is out of range; it has to be 0 to {}", dds::Network::kMostDomain));
  }
  return static_cast<std::uint32_t>(domain);
}

std::string interface_of(const file::TomlNode& value) {
  std::string text = value.text("a network interface, as in \"eth0\", or its address");
  const std::vector<std::string> known = dds::interfaces_here();
  if (std::ranges::find(known, text) == known.end()) {
    value.refuse(unknown_name(text, "interface of this machine", known));
  }
  return text;
}

// XML, or a file of XML.
std::string configuration_of(const file::TomlNode& value) {
  std::string text = value.text("XML of Cyclone DDS, or a file of it");
  if (text.starts_with('<')) {
    return text;
  }
  const std::string_view kScheme = "file://";
  if (text.starts_with(kScheme)) {
    text.erase(0, kScheme.size());
  }
  const std::filesystem::path file = std::filesystem::path(value.place().file).parent_path() / text;
  if (std::error_code none; !std::filesystem::is_regular_file(file, none)) {
    value.refuse("'" + text + "' is no file");
  }
  return std::string(kScheme) + std::filesystem::absolute(file).string();
}

void read_loopback(const file::TomlNode& table, dds::Network& network) {
  for (const char* const key : {"interface", "peers", "multicast"}) {
    if (table.has(key)) {
      table[key].refuse("says nothing where loopback = true");
    }
  }
  std::string more = std::move(network.configuration);
  network = dds::Network::loopback(network.domain);
  network.configuration = std::move(more);
}

dds::Network read_network(const file::TomlNode& table) {
  // The file's domain has precedence over the environment.
  dds::Network network = table.has("domain") ? dds::Network{} : dds::Network::from_environment();
  if (table.has("domain")) {
    network.configuration = dds::Network::configuration_of_environment();
    network.domain = domain_of(table["domain"]);
  }
  if (table.has("configuration")) {
    network.configuration = configuration_of(table["configuration"]);
  }
  if (table.has("loopback") && table["loopback"].flag()) {
    read_loopback(table, network);
    return network;
  }
  if (table.has("interface")) {
    network.interface = interface_of(table["interface"]);
  }
  if (table.has("multicast")) {
    network.multicast = table["multicast"].flag();
  }
  if (table.has("peers")) {
    network.peers = file::texts_of(table["peers"], "a list of addresses, as in [\"192.168.2.2\"]");
    file::located(table["peers"], [&] { return dds::cyclone_configuration(network); });
  }
  return network;
}

dds::TopicNames read_names(const file::TomlNode& table, const std::string& node) {
  const auto text = [&](const char* key) {
    return table.has(key) ? table[key].text() : std::string();
  };
  const auto names = [&](const char* key, const std::vector<std::string>& remappings) {
    const auto make = [&] { return dds::TopicNames(text("namespace"), node, remappings); };
    return table.has(key) ? file::located(table[key], make) : make();
  };
  if (table.has("node")) {
    file::located(table["node"], [&] { return dds::TopicNames("", node, {}); });
  }
  names("namespace", {});
  return names("remap", table.has("remap")
                            ? file::texts_of(table["remap"], "a list, as in [\"/odom:=/dvl/odom\"]")
                            : std::vector<std::string>());
}

}  // namespace

NodeSettings read_node_settings(const std::optional<file::TomlNode>& table) {
  NodeSettings settings;
  if (!table) {
    settings.network = dds::Network::from_environment();
    return settings;
  }
  const file::TomlNode& known =
      table->table({"domain", "interface", "peers", "multicast", "loopback", "configuration",
                    "partition", "namespace", "node", "remap", "reliable", "frame"});
  settings.network = read_network(known);
  const auto text = [&](const char* key, std::string& value) {
    if (known.has(key)) {
      value = known[key].text();
    }
  };
  text("node", settings.node);
  text("frame", settings.frame);
  text("partition", settings.subscribed.partition);
  settings.published.partition = settings.subscribed.partition;
  settings.commands.partition = settings.subscribed.partition;
  settings.names = read_names(known, settings.node);
  settings.subscribed.reliable = known.has("reliable") && known["reliable"].flag();
  return settings;
}

}  // namespace kelpie::ros
