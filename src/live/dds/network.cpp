// SPDX-License-Identifier: Apache-2.0
#include "dds/network.hpp"

#include <fmt/format.h>
#include <ifaddrs.h>
#include <netdb.h>
#include <netinet/in.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <string_view>

#include "core/text.hpp"
#include "dds/tuning.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::dds {
namespace {

std::string from_environment(const char* name) {
  // NOLINTNEXTLINE(concurrency-mt-unsafe): no thread changes the environment
  const char* const value = std::getenv(name);
  return value == nullptr ? std::string() : std::string(value);
}

// For XML: only characters of an address or a name.
void require_address(const std::string& field, const std::string& address) {
  const bool fits = !address.empty() && std::ranges::all_of(address, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("._:-%@[]").find(c) != std::string_view::npos;
  });
  require(fits, field, "'" + address + "' is neither an address nor a name");
}

bool is_address(const std::string& text) {
  return text.find(':') != std::string::npos ||
         std::ranges::all_of(text, [](char c) { return (c >= '0' && c <= '9') || c == '.'; });
}

std::string interfaces(const Network& network) {
  if (network.interface.empty()) {
    return {};
  }
  require_address("interface", network.interface);
  return fmt::format("<Interfaces><NetworkInterface {}='{}'/></Interfaces>",
                     is_address(network.interface) ? "address" : "name", network.interface);
}

std::string discovery(const Network& network) {
  std::string peers;
  for (const std::string& peer : network.peers) {
    require_address("peers", peer);
    peers += fmt::format("<Peer Address='{}'/>", peer);
  }
  // Unicast discovery finds a participant only at the port of its index.
  return fmt::format(
      "<ParticipantIndex>auto</ParticipantIndex>"
      "<MaxAutoParticipantIndex>{}</MaxAutoParticipantIndex>{}",
      kTuning.participants_per_peer, peers.empty() ? "" : "<Peers>" + peers + "</Peers>");
}

}  // namespace

Network Network::from_environment() {
  Network network;
  network.configuration = configuration_of_environment();
  if (const std::string domain = dds::from_environment("ROS_DOMAIN_ID"); !domain.empty()) {
    double number = -1.0;
    require(parse_number(domain, number) && number >= 0.0 && number <= kMostDomain &&
                number == static_cast<double>(static_cast<std::uint32_t>(number)),
            "ROS_DOMAIN_ID", fmt::format("'{}' is no whole number 0 … {}", domain, kMostDomain));
    network.domain = static_cast<std::uint32_t>(number);
  }
  return network;
}

std::string Network::configuration_of_environment() {
  return dds::from_environment("CYCLONEDDS_URI");
}

Network Network::loopback(std::uint32_t domain) {
  return {.domain = domain, .interface = "lo", .peers = {"127.0.0.1"}, .multicast = false};
}

std::vector<std::string> interfaces_here() {
  ifaddrs* list = nullptr;
  if (::getifaddrs(&list) != 0) {
    return {};
  }
  const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> owner(list, &::freeifaddrs);
  std::vector<std::string> found;
  const auto add = [&](const std::string& text) {
    if (std::ranges::find(found, text) == found.end()) {
      found.push_back(text);
    }
  };
  for (const ifaddrs* one = list; one != nullptr; one = one->ifa_next) {
    add(one->ifa_name);
    const int family = one->ifa_addr == nullptr ? AF_UNSPEC : one->ifa_addr->sa_family;
    const socklen_t size = family == AF_INET    ? sizeof(sockaddr_in)
                           : family == AF_INET6 ? sizeof(sockaddr_in6)
                                                : 0;
    std::array<char, NI_MAXHOST> text{};
    if (size > 0 && ::getnameinfo(one->ifa_addr, size, text.data(), text.size(), nullptr, 0,
                                  NI_NUMERICHOST) == 0) {
      add(text.data());
    }
  }
  return found;
}

std::string cyclone_configuration(const Network& network) {
  require(network.domain <= Network::kMostDomain, "domain",
          fmt::format("{} is above {}", network.domain, Network::kMostDomain));
  require(network.most_message_bytes >= kTuning.least_message_bytes, "most_message_bytes",
          fmt::format("{} is below {}", network.most_message_bytes, kTuning.least_message_bytes));
  const std::string own = fmt::format(
      "<CycloneDDS><Domain Id='any'><General>{}<AllowMulticast>{}</AllowMulticast></General>"
      "<Discovery>{}</Discovery><Internal><MaxSampleSize>{} B</MaxSampleSize></Internal>"
      "</Domain></CycloneDDS>",
      interfaces(network), network.multicast ? "default" : "false", discovery(network),
      network.most_message_bytes);
  return network.configuration.empty() ? own : network.configuration + "," + own;
}

}  // namespace kelpie::dds
