// SPDX-License-Identifier: Apache-2.0
#include "autopilot/link_settings.hpp"

#include <charconv>
#include <filesystem>
#include <limits>
#include <vector>

#include "autopilot/byte_line.hpp"
#include "autopilot/tuning.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "mavlink/definition.hpp"

namespace kelpie::autopilot {
namespace {

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  throw InputError("'" + text + "' " + why);
}

unsigned number_of(const std::string& text, const std::string& digits, unsigned most,
                   const char* what) {
  unsigned value = 0;
  const char* const end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, value);
  if (error != std::errc{} || stop != end || value > most) {
    refuse(text, std::string("has no ") + what + " at its end");
  }
  return value;
}

// Number of a system or component; 0 means "not given".
std::uint8_t identity_of(const file::TomlNode& value) {
  const std::uint64_t number = value.count();
  if (number < 1 || number > std::numeric_limits<std::uint8_t>::max()) {
    value.refuse("is out of range; it has to be 1 to 255");
  }
  return static_cast<std::uint8_t>(number);
}

void read_rates(const file::TomlNode& value, std::map<std::string, double>& rates) {
  for (const file::TomlNode& rate : value.members("a table, as in {ATTITUDE = 50}")) {
    if (mavlink::find_definition(rate.key()) == nullptr) {
      std::vector<std::string> names;
      for (const mavlink::Definition& definition : mavlink::definitions()) {
        names.push_back(definition.name);
      }
      rate.refuse("is no message of MAVLink" + did_you_mean(rate.key(), names));
    }
    const double hz = rate.number("a number of messages per second");
    if (!(hz > 0.0) || hz > kTuning.most_rate_hz) {
      rate.refuse("is out of range; it has to be more than 0, up to 1000 Hz");
    }
    rates[rate.key()] = hz;
  }
}

VelocityMessage velocity_message_of(const file::TomlNode& value) {
  const std::string text = value.text();
  if (text == "ODOMETRY") {
    return VelocityMessage::odometry;
  }
  if (text == "VISION_POSITION_DELTA") {
    return VelocityMessage::delta;
  }
  if (text != "none") {
    value.refuse("'" + text + R"(' has to be "ODOMETRY", "VISION_POSITION_DELTA" or "none")");
  }
  return VelocityMessage::none;
}

}  // namespace

Connection parse_connection(const std::string& text) {
  const std::size_t first = text.find(':');
  const std::size_t last = text.rfind(':');
  const std::string kind = text.substr(0, first);
  Connection connection;
  if ((kind != "udp" && kind != "udpout" && kind != "serial") || first == std::string::npos) {
    refuse(text,
           "has to be a connection, as in \"udp:14550\", \"udpout:192.168.2.2:14550\" or "
           "\"serial:/dev/ttyACM0:115200\"");
  }
  const std::string middle = last > first ? text.substr(first + 1, last - first - 1) : "";
  const std::string end = text.substr(last + 1);
  if (kind == "serial") {
    connection = {.kind = Connection::Kind::serial, .device = middle};
    connection.baud =
        number_of(text, end, std::numeric_limits<unsigned>::max(), "baud rate, as in :115200,");
    if (middle.empty()) {
      refuse(text, "names no device, as in \"serial:/dev/ttyACM0:115200\"");
    }
    if (!is_baud_rate(connection.baud)) {
      refuse(text, "has a baud rate that serial lines don't have; there are " + baud_rates_text());
    }
    return connection;
  }
  connection.port = static_cast<std::uint16_t>(
      number_of(text, end, std::numeric_limits<std::uint16_t>::max(), "port"));
  if (kind == "udpout") {
    connection.kind = Connection::Kind::udp_send;
    if (middle.empty() || connection.port == 0) {
      refuse(text, "names no host and port, as in \"udpout:192.168.2.2:14550\"");
    }
  }
  connection.host = middle.empty() ? connection.host : without_brackets(middle);
  return connection;
}

LinkSettings read_link_settings(const file::TomlNode& table) {
  table.table({"connection", "system", "component", "key", "system_id", "component_id", "rates",
               "velocity", "frame"});
  LinkSettings settings;
  if (table.has("connection")) {
    settings.text = table["connection"].text();
  }
  try {
    settings.connection = parse_connection(settings.text);
  } catch (const InputError& error) {
    table["connection"].refuse(error.what());
  }
  const auto identity = [&](const char* key, std::uint8_t& value) {
    if (table.has(key)) {
      value = identity_of(table[key]);
    }
  };
  identity("system", settings.system);
  identity("component", settings.component);
  identity("system_id", settings.system_id);
  identity("component_id", settings.component_id);
  if (table.has("key")) {
    const file::TomlNode key = table["key"];
    const std::filesystem::path folder = std::filesystem::path(key.place().file).parent_path();
    const std::filesystem::path place = folder / key.text();
    settings.key = file::located(key, [&] { return read_signing_key(place); });
  }
  if (table.has("velocity")) {
    settings.velocity = velocity_message_of(table["velocity"]);
  }
  if (table.has("frame")) {
    const std::string frame = table["frame"].text();
    if (frame != "FRD" && frame != "FLU") {
      table["frame"].refuse("'" + frame + R"(' has to be "FRD" or "FLU")");
    }
    settings.is_frd = frame == "FRD";
  }
  if (table.has("rates")) {
    read_rates(table["rates"], settings.rates);
  }
  return settings;
}

}  // namespace kelpie::autopilot
