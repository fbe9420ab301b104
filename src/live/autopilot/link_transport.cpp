// SPDX-License-Identifier: Apache-2.0
#include "autopilot/link_transport.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "autopilot/tuning.hpp"
#include "bag/topic_columns.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::autopilot {
namespace {

constexpr double kSetMessageInterval = 511.0;  // MAV_CMD_SET_MESSAGE_INTERVAL

// The message of a topic: the part behind its last slash.
const mavlink::Definition& definition_of(const live::Configuration& configuration,
                                         const std::string& topic) {
  const std::string name = topic.substr(topic.rfind('/') + 1);
  const mavlink::Definition* const definition = mavlink::find_definition(name);
  if (definition == nullptr) {
    std::vector<std::string> names;
    for (const mavlink::Definition& one : mavlink::definitions()) {
      names.push_back(one.name);
    }
    throw InputError({.file = configuration.file, .line = 0, .field = "log"},
                     topic + " is no message of MAVLink" + did_you_mean(name, names) +
                         "; columns read as in ATTITUDE:rollspeed");
  }
  return *definition;
}

void check_fields(const live::Configuration& configuration) {
  for (const auto& columns : bag::columns_by_topic(configuration.columns())) {
    const mavlink::Definition& definition = definition_of(configuration, columns->topic());
    try {
      columns->bind({.name = columns->topic(), .type = definition.name, .encoding = "mavlink"},
                    bag::MessageDefinitions(), configuration.log.clock);
    } catch (const InputError& error) {
      throw InputError({.file = configuration.file, .line = 0, .field = "log"}, error.what());
    }
  }
}

// Of the vehicle; other senders get no requests.
std::vector<RateKeeper::MessageRate> wanted_rates(const live::Configuration& configuration,
                                                  const LinkSettings& settings) {
  std::vector<RateKeeper::MessageRate> wanted;
  for (const auto& columns : bag::columns_by_topic(configuration.columns())) {
    if (columns->topic().starts_with('/')) {
      continue;
    }
    const mavlink::Definition& definition = definition_of(configuration, columns->topic());
    const auto given = settings.rates.find(definition.name);
    wanted.push_back({.name = definition.name,
                      .id = definition.id,
                      .rate_hz = given == settings.rates.end()
                                     ? kTuning.rate_factor * configuration.plan.rate_hz
                                     : given->second});
  }
  return wanted;
}

std::int64_t time_now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace

LinkTransport::LinkTransport(const live::Configuration& configuration, const LinkSettings& settings,
                             std::unique_ptr<ByteLine> line)
    : settings_(settings),
      line_(std::move(line)),
      rates_(wanted_rates(configuration, settings)),
      reporter_(configuration.plan.targets),
      writer_(settings.system_id == 0 ? 1 : settings.system_id, settings.component_id) {
  check_fields(configuration);
}

live::Transport::Got LinkTransport::next(bag::Message& message, std::chrono::milliseconds timeout) {
  const Clock::time_point end = Clock::now() + timeout;
  for (mavlink::Frame frame;;) {
    send_due(Clock::now());
    while (parser_.next(frame)) {
      if (accept(frame, message)) {
        return Got::message;
      }
    }
    const Clock::time_point now = Clock::now();
    if (now >= end) {
      return Got::nothing;
    }
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - now);
    const std::span<const std::byte> bytes = line_->read(left);
    received_ns_ = time_now_ns();
    bytes_ += bytes.size();
    parser_.add(bytes);
  }
}

void LinkTransport::send_due(Clock::time_point now) {
  if (now - heartbeat_ >= kTuning.between_heartbeats) {
    heartbeat_ = now;
    send_heartbeat();
  }
  if (!vehicle_) {
    return;
  }
  if (const std::optional<RateKeeper::MessageRate> wanted = rates_.next_request(now)) {
    request_rate(*wanted, *vehicle_);
  }
  if (reports_) {
    const double boot_ms = std::chrono::duration<double, std::milli>(now - began_).count();
    reporter_.send_due(now, std::fmod(std::trunc(boot_ms), 4294967296.0), writer_,
                       [&](std::span<const std::byte> bytes) { line_->write(bytes); });
  }
}

void LinkTransport::send_heartbeat() {
  constexpr double kOnboardController = 18.0;  // MAV_TYPE_ONBOARD_CONTROLLER
  constexpr double kNoAutopilot = 8.0;         // MAV_AUTOPILOT_INVALID
  constexpr double kActive = 4.0;              // MAV_STATE_ACTIVE
  constexpr double kVersion = 3.0;
  writer_.begin("HEARTBEAT").set("type", kOnboardController).set("autopilot", kNoAutopilot);
  writer_.set("system_status", kActive).set("mavlink_version", kVersion);
  line_->write(writer_.finish());
}

void LinkTransport::request_rate(const RateKeeper::MessageRate& wanted,
                                 const bag::MavlinkSender& vehicle) {
  constexpr double kMicroseconds = 1e6;
  writer_.begin("COMMAND_LONG").set("command", kSetMessageInterval);
  writer_.set("target_system", vehicle.system).set("target_component", vehicle.component);
  writer_.set("param1", wanted.id).set("param2", std::floor(kMicroseconds / wanted.rate_hz));
  line_->write(writer_.finish());
}

bool LinkTransport::accept(const mavlink::Frame& frame, bag::Message& message) {
  track_vehicle(frame);
  const bag::MavlinkSender sender{frame.system, frame.component};
  if (!vehicle_) {
    return false;
  }
  if (sender == *vehicle_) {
    const Clock::time_point now = Clock::now();
    rates_.count_message(frame.definition->id, now);
    const auto value = [&](const char* field) {
      return mavlink::number_at(*frame.definition->find(field), frame.payload);
    };
    if (frame.definition->name == "COMMAND_ACK" && value("command") == kSetMessageInterval) {
      rates_.acknowledge(static_cast<int>(value("result")), now);
    }
  }
  const std::optional<std::size_t> topic = topic_of(frame);
  if (!topic) {
    return false;
  }
  message = {.topic = *topic,
             .receive_ns = received_ns_,
             .publish_ns = received_ns_,
             .sequence = frame.sequence,
             .data = frame.payload};
  return true;
}

void LinkTransport::track_vehicle(const mavlink::Frame& frame) {
  if (!bag::is_of_autopilot(frame)) {
    return;
  }
  const bag::MavlinkSender sender{frame.system, frame.component};
  if (!vehicle_ && (settings_.system == 0 || settings_.system == frame.system)) {
    vehicle_ = sender;
    if (settings_.system_id == 0) {
      writer_ = mavlink::FrameWriter(frame.system, settings_.component_id);
    }
  }
  if (vehicle_ == sender) {
    vehicle_heartbeat_ = Clock::now();
    line_->answer_last();
  }
}

std::optional<std::size_t> LinkTransport::topic_of(const mavlink::Frame& frame) {
  const bag::MavlinkSender sender{frame.system, frame.component};
  const auto found = by_frame_.find({frame.definition->id, sender});
  if (found != by_frame_.end()) {
    return found->second;
  }
  if (topics_.size() == kTuning.most_topics) {
    return std::nullopt;
  }
  topics_.push_back(bag::mavlink_topic(*frame.definition, sender, vehicle_));
  return by_frame_[{frame.definition->id, sender}] = topics_.size() - 1;
}

live::TransportHealth LinkTransport::health() const {
  const mavlink::FrameParser::Counts& counts = parser_.counts();
  live::TransportHealth health{
      .lost = counts.lost, .damaged = counts.bad_checksum, .unknown = counts.unknown};
  if (const std::string fault = line_->fault(); !fault.empty()) {
    health.faults.push_back(fault);
  } else if (!vehicle_ && counts.frames == 0 && bytes_ > kTuning.bytes_without_frame) {
    health.faults.push_back(settings_.text +
                            ": bytes come, but no frames of MAVLink; is the baud rate right?");
  } else if (!vehicle_) {
    health.faults.push_back(fmt::format(
        "{}: no HEARTBEAT of an autopilot{}", settings_.text,
        settings_.system == 0 ? "" : fmt::format(" with the system number {}", settings_.system)));
  } else if (Clock::now() - vehicle_heartbeat_ > kTuning.longest_silence) {
    health.faults.push_back(settings_.text + ": the vehicle's HEARTBEAT has ceased");
  } else {
    health.faults = rates_.faults();
  }
  return health;
}

live::Output* LinkTransport::open_output(live::Requests& /*requests*/) {
  reports_ = true;
  return &reporter_;
}

std::vector<std::string> LinkTransport::check() {
  const Clock::time_point end = Clock::now() + kTuning.longest_check;
  while (!vehicle_ && Clock::now() < end) {
    bag::Message message;
    next(message, std::chrono::milliseconds(20));
  }
  std::vector<std::string> lines{"MAVLink over " + settings_.text};
  if (vehicle_) {
    lines.push_back(fmt::format("the vehicle is system {}, component {}", vehicle_->system,
                                vehicle_->component));
  }
  std::ranges::copy(health().faults, std::back_inserter(lines));
  return lines;
}

std::unique_ptr<live::Transport> open_link(const live::Configuration& configuration,
                                           const file::TomlNode& table) {
  const LinkSettings settings = read_link_settings(table);
  std::unique_ptr<ByteLine> line;
  try {
    line = open_line(settings.connection);
  } catch (const InputError& error) {
    (table.has("connection") ? table["connection"] : table).refuse(error.what());
  }
  return std::make_unique<LinkTransport>(configuration, settings, std::move(line));
}

}  // namespace kelpie::autopilot
