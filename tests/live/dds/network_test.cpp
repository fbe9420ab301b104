// SPDX-License-Identifier: Apache-2.0
#include "dds/network.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "dds/loopback.hpp"
#include "dds/participant.hpp"
#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::network_test {
namespace {

using testing::message_of;

TEST(Network, TheDomainIsThatOfTheEnvironment) {
  ::setenv("ROS_DOMAIN_ID", "42", 1);  // NOLINT: one thread
  EXPECT_EQ(dds::Network::from_environment().domain, 42U);
  for (const char* const text : {"233", "-1", "1.5", "x", "nan", "1e9"}) {
    ::setenv("ROS_DOMAIN_ID", text, 1);  // NOLINT: one thread
    EXPECT_NE(message_of<InputError>([] {
                dds::Network::from_environment();
              }).find("ROS_DOMAIN_ID: '" + std::string(text)),
              std::string::npos);
  }
  ::unsetenv("ROS_DOMAIN_ID");  // NOLINT: one thread
  EXPECT_EQ(dds::Network::from_environment().domain, 0U);
}

TEST(Network, NothingButAddressesAndNamesGetsIntoTheConfiguration) {
  for (const char* const text : {"lo'/><x", "a b", "", "<", "&amp;"}) {
    dds::Network network = dds::Network::loopback(0);
    network.peers = {text};
    EXPECT_THROW(dds::cyclone_configuration(network), InputError) << text;
    network.peers = {};
    network.interface = text;
    if (!network.interface.empty()) {
      EXPECT_THROW(dds::cyclone_configuration(network), InputError) << text;
    }
  }
  EXPECT_THROW(dds::cyclone_configuration({.domain = 233}), InputError);
  EXPECT_THROW(dds::cyclone_configuration({.most_message_bytes = 9'999}), InputError);
}

TEST(Network, WhatTheLibraryRefusesIsSaidInItsWords) {
  dds::Network network = dds::Network::loopback(testing::own_domain());
  network.interface = "nosuch0";
  EXPECT_NE(
      message_of<Failure>([&] { const dds::Participant participant(network); }).find("nosuch0"),
      std::string::npos);
  network = dds::Network::loopback(testing::own_domain());
  network.configuration = "<CycloneDDS><Domain><Nonsense/></Domain></CycloneDDS>";
  const std::string refused =
      message_of<InputError>([&] { const dds::Participant participant(network); });
  EXPECT_NE(refused.find("configuration of Cyclone DDS: is refused"), std::string::npos) << refused;
  EXPECT_NE(refused.find("Nonsense"), std::string::npos) << refused;
}

TEST(Network, AnInterfaceIsGivenByNameOrAddressAndGoneAfterUse) {
  for (const char* const text : {"lo", "127.0.0.1", "lo"}) {
    dds::Network network = dds::Network::loopback(testing::own_domain());
    network.interface = text;
    const dds::Participant participant(network);
    EXPECT_TRUE(participant.published().empty());
    EXPECT_NE(message_of<Failure>([&] { const dds::Participant second(network); }).find("already"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace kelpie::network_test
