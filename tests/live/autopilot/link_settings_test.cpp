// SPDX-License-Identifier: Apache-2.0
#include "autopilot/link_settings.hpp"

#include <gtest/gtest.h>

#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::link_settings_test {
namespace {

using autopilot::Connection;
using autopilot::LinkSettings;

LinkSettings settings_of(const std::string& table) {
  const testing::TemporaryFolder folder;
  testing::write_text(folder / "x.toml", "[live.mavlink]\n" + table);
  return autopilot::read_link_settings(file::TomlNode::read(folder / "x.toml")["live"]["mavlink"]);
}

TEST(LinkSettings, ConnectionsReadAsPeopleWriteThem) {
  using Kind = Connection::Kind;
  EXPECT_EQ(autopilot::parse_connection("udp:14550"),
            (Connection{.kind = Kind::udp_listen, .host = "127.0.0.1", .port = 14550}));
  EXPECT_EQ(autopilot::parse_connection("udp:0.0.0.0:14551"),
            (Connection{.kind = Kind::udp_listen, .host = "0.0.0.0", .port = 14551}));
  EXPECT_EQ(autopilot::parse_connection("udpout:192.168.2.2:14550"),
            (Connection{.kind = Kind::udp_send, .host = "192.168.2.2", .port = 14550}));
  EXPECT_EQ(autopilot::parse_connection("udpout:[::1]:14550"),
            (Connection{.kind = Kind::udp_send, .host = "::1", .port = 14550}));
  EXPECT_EQ(
      autopilot::parse_connection("serial:/dev/serial/by-id/usb:1:115200"),
      (Connection{.kind = Kind::serial, .device = "/dev/serial/by-id/usb:1", .baud = 115'200}));
}

TEST(LinkSettings, WhatIsMissingIsAsAComputerOnBoardIs) {
  const LinkSettings settings = settings_of("");
  EXPECT_EQ(settings.connection, autopilot::parse_connection("udp:14550"));
  EXPECT_EQ(settings.system, 0);
  EXPECT_EQ(settings.system_id, 0);
  EXPECT_EQ(settings.component_id, 191);
  const LinkSettings all = settings_of(
      "connection = \"udp:1\"\nsystem = 3\ncomponent = 2\nsystem_id = 4\ncomponent_id = 5\n"
      "rates = {ATTITUDE = 50, SERVO_OUTPUT_RAW = 12.5}\n");
  EXPECT_EQ(all.system, 3);
  EXPECT_EQ(all.component, 2);
  EXPECT_EQ(all.system_id, 4);
  EXPECT_EQ(all.component_id, 5);
  EXPECT_EQ(all.rates.at("SERVO_OUTPUT_RAW"), 12.5);
}

TEST(LinkSettings, WhatCannotBeIsNamedWithFileLineAndKey) {
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"connection = \"tcp:1\"", "has to be a connection"},
      {"connection = \"udp:99999\"", "no port"},
      {"connection = \"udpout:14550\"", "no host and port"},
      {"connection = \"serial:/dev/ttyACM0\"", "no baud rate"},
      {"connection = \"serial:/dev/ttyACM0:12345\"", "there are 9600"},
      {"connection = \"serial::115200\"", "names no device"},
      {"system = 0", "1 to 255"},
      {"component_id = 256", "1 to 255"},
      {"component = 0", "1 to 255"},
      {"key = \"no such file\"", "no such file"},
      {"rates = {ATITUDE = 5}", "did you mean 'ATTITUDE'"},
      {"rates = {ATTITUDE = 0}", "up to 1000 Hz"},
      {"baud = 5", "baud"}};
  for (const auto& [line, why] : wrong) {
    const std::string message =
        testing::message_of<InputError>([&, text = line] { settings_of(text + "\n"); });
    EXPECT_NE(message.find("x.toml:2: "), std::string::npos) << line << ": " << message;
    EXPECT_NE(message.find(why), std::string::npos) << line << ": " << message;
  }
}

}  // namespace
}  // namespace kelpie::link_settings_test
