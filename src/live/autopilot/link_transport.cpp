// SPDX-License-Identifier: Apache-2.0
#include "autopilot/link_transport.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <string_view>

#include "autopilot/tuning.hpp"
#include "bag/topic_columns.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "motion/states.hpp"

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

// Outputs of the vehicle that [log] names.
std::vector<std::size_t> named_outputs(const live::Configuration& configuration) {
  std::vector<std::size_t> outputs;
  for (const std::string& column : configuration.columns()) {
    if (const std::size_t output = log::output_of(column); output > 0 && column[0] != '/') {
      outputs.push_back(output);
    }
  }
  return outputs;
}

// Senders that [log] names by numbers: "/mavlink/2/1/ODOMETRY".
std::vector<Senders::Id> named_senders(const live::Configuration& configuration) {
  std::vector<Senders::Id> named;
  for (const auto& columns : bag::columns_by_topic(configuration.columns())) {
    unsigned system = 0;
    unsigned component = 0;
    // NOLINTNEXTLINE(cert-err34-c): what isn't of this form names the vehicle
    if (std::sscanf(columns->topic().c_str(), "/mavlink/%3u/%3u/", &system, &component) == 2) {
      named.push_back({static_cast<std::uint8_t>(system), static_cast<std::uint8_t>(component)});
    }
  }
  return named;
}

// Velocities of the model along the axes of the body, as inputs; an empty name: none.
std::array<std::string, 3> body_velocities(const live::Configuration& configuration) {
  const std::vector<std::string>& inputs = configuration.plan.inputs;
  std::array<std::string, 3> names;
  for (const std::size_t state : find_states(configuration.settings.shared.states, inputs,
                                             configuration.plan.targets.size())) {
    if (const auto axis = velocity_axis(inputs[state]); axis && *axis < names.size()) {
      names[*axis] = inputs[state];
    }
  }
  return names;
}

// Told to the autopilot, its filter's output would come back to the filter as a measurement.
void refuse_filtered_velocity(const live::Configuration& configuration,
                              const file::TomlNode& velocity) {
  constexpr std::array<std::string_view, 6> kOfFilter{"LOCAL_POSITION_NED",
                                                      "LOCAL_POSITION_NED_COV",
                                                      "GLOBAL_POSITION_INT",
                                                      "GLOBAL_POSITION_INT_COV",
                                                      "ODOMETRY",
                                                      "VFR_HUD"};
  const std::array<std::string, 3> names = body_velocities(configuration);
  for (const StreamPlan::Source& source : configuration.plan.sources) {
    if (std::ranges::find(names, source.name) != names.end() &&
        std::ranges::find(kOfFilter, bag::parse_column(source.from).topic) != kOfFilter.end()) {
      velocity.refuse(fmt::format(
          "tells velocities to the autopilot's filter, and {} is {}, what this filter makes of "
          "them; take the velocities of the velocity log's own message, as in "
          "\"/mavlink/255/0/VISION_POSITION_DELTA:position_delta[0]/time_delta_usec\" (system and "
          "component of its sender), or \"none\"",
          source.name, source.from));
    }
  }
}

std::string number_text(const Senders::Id& id) {
  return fmt::format("system {}, component {}", id.system, id.component);
}

std::string verdict_text(Signing::Verdict verdict) {
  switch (verdict) {
    case Signing::Verdict::absent:
      return "unsigned messages are refused";
    case Signing::Verdict::wrong:
      return "messages with a wrong signature are refused; is the key the vehicle's?";
    case Signing::Verdict::old:
      return "messages with an old signature are refused; is a clock wrong, or are these repeats?";
    default:
      return "messages of too many signing senders are refused";
  }
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
      wanted_(wanted_rates(configuration, settings)),
      line_(std::move(line)),
      signing_(settings.key ? std::optional<Signing>(*settings.key) : std::nullopt),
      senders_({.system = settings.system, .component = settings.component},
               named_senders(configuration)),
      outputs_(named_outputs(configuration)),
      rates_(wanted_),
      parameters_(outputs_),
      mirrors_(configuration.log.mirror_motors),
      reporter_(configuration.plan.targets, settings.velocity, settings.is_frd),
      writer_(writer_of(1)) {
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
    if (bytes.empty()) {
      continue;
    }
    received_ns_ = time_now_ns();
    bytes_ += bytes.size();
    if (const Address source = line_->source(); source != source_) {
      parser_.drop_rest();
      source_ = source;
    }
    parser_.add(bytes);
  }
}

void LinkTransport::send_due(Clock::time_point now) {
  if (now - heartbeat_ >= kTuning.between_heartbeats) {
    heartbeat_ = now;
    send_heartbeat();
  }
  const Senders::Sender* const asked = senders_.asked(now);
  if (asked == nullptr) {
    return;
  }
  if (asked_ != asked->id) {
    ask(*asked);
  }
  if (const std::optional<RateKeeper::MessageRate> wanted = rates_.next_request(now)) {
    request_rate(*wanted);
  }
  // The answers of an autopilot on trial would not be passed on.
  const std::optional<std::string> name =
      senders_.vehicle() ? parameters_.next_request(now) : std::nullopt;
  if (name) {
    request_parameter(*name);
  }
  if (reports_) {
    const double boot_ms = std::chrono::duration<double, std::milli>(now - began_).count();
    reporter_.send_due(now, std::fmod(std::trunc(boot_ms), 4294967296.0), writer_,
                       [&](std::span<const std::byte> bytes) { line_->write(bytes); });
  }
}

mavlink::FrameWriter LinkTransport::writer_of(std::uint8_t system) {
  mavlink::FrameWriter::Signer signer;
  if (signing_) {
    signer = [this](std::vector<std::byte>& frame) { signing_->sign(frame, signing_time_now()); };
  }
  return mavlink::FrameWriter(settings_.system_id == 0 ? system : settings_.system_id,
                              settings_.component_id, std::move(signer));
}

void LinkTransport::ask(const Senders::Sender& autopilot) {
  asked_ = autopilot.id;
  rates_ = RateKeeper(wanted_);
  parameters_ = ParameterKeeper(outputs_);
  line_->answer(autopilot.from);
  if (settings_.system_id == 0) {
    writer_ = writer_of(autopilot.id.system);
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

void LinkTransport::request_rate(const RateKeeper::MessageRate& wanted) {
  constexpr double kMicroseconds = 1e6;
  writer_.begin("COMMAND_LONG").set("command", kSetMessageInterval);
  writer_.set("target_system", asked_->system).set("target_component", asked_->component);
  writer_.set("param1", wanted.id).set("param2", std::floor(kMicroseconds / wanted.rate_hz));
  line_->write(writer_.finish());
}

void LinkTransport::request_parameter(const std::string& name) {
  constexpr double kByName = -1.0;
  writer_.begin("PARAM_REQUEST_READ").set("param_id", name).set("param_index", kByName);
  writer_.set("target_system", asked_->system).set("target_component", asked_->component);
  line_->write(writer_.finish());
}

bool LinkTransport::is_signed_well(const mavlink::Frame& frame) {
  const Signing::Verdict verdict =
      signing_ ? signing_->check(frame, signing_time_now()) : Signing::Verdict::right;
  if (verdict != Signing::Verdict::right) {
    ++unsigned_;
    signature_ = verdict;
    signature_at_ = Clock::now();
  }
  return verdict == Signing::Verdict::right;
}

bool LinkTransport::accept(const mavlink::Frame& frame, bag::Message& message) {
  const auto is_frames = [&](const RateKeeper::MessageRate& one) {
    return one.id == frame.definition->id;
  };
  const bool has_data = wanted_.empty() || std::ranges::any_of(wanted_, is_frames);
  if (!is_signed_well(frame) || !senders_.accept(frame, source_, has_data, Clock::now())) {
    return false;
  }
  const Senders::Id sender{frame.system, frame.component};
  if (sender == asked_) {
    hear_vehicle(frame);
  }
  const std::optional<std::size_t> topic =
      senders_.vehicle() ? topic_of(frame) : std::optional<std::size_t>();
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

// From the vehicle, or from the autopilot on trial.
void LinkTransport::hear_vehicle(const mavlink::Frame& frame) {
  const Clock::time_point now = Clock::now();
  line_->answer(source_);
  rates_.count_message(frame.definition->id, now);
  if (bag::is_of_autopilot(frame)) {
    vehicle_heartbeat_ = now;
  }
  const auto value = [&](const char* field) {
    return mavlink::number_at(*frame.definition->find(field), frame.payload);
  };
  if (frame.definition->name == "COMMAND_ACK" && value("command") == kSetMessageInterval) {
    rates_.acknowledge(static_cast<int>(value("result")), now);
  }
  if (frame.definition->name == "PARAM_VALUE" && senders_.vehicle()) {
    parameters_.hear(mavlink::text_at(*frame.definition->find("param_id"), frame.payload),
                     value("param_value"));
  }
}

std::optional<std::size_t> LinkTransport::topic_of(const mavlink::Frame& frame) {
  const bag::MavlinkSender sender{frame.system, frame.component};
  const auto found = by_frame_.find({frame.definition->id, sender});
  if (found != by_frame_.end()) {
    return found->second;
  }
  if (topics_.size() >= kTuning.most_topics && !senders_.is_kept(sender)) {
    return std::nullopt;
  }
  topics_.push_back(bag::mavlink_topic(*frame.definition, sender, senders_.vehicle()));
  return by_frame_[{frame.definition->id, sender}] = topics_.size() - 1;
}

std::vector<std::string> LinkTransport::vehicle_faults() const {
  if (const std::string fault = line_->fault(); !fault.empty()) {
    return {fault};
  }
  if (!asked_) {
    if (parser_.counts().frames == 0 && bytes_ > kTuning.bytes_without_frame) {
      return {settings_.text + ": bytes come, but no frames of MAVLink; is the baud rate right?"};
    }
    const std::string system =
        settings_.system == 0 ? "" : fmt::format(" with the system number {}", settings_.system);
    return {settings_.text + ": no HEARTBEAT of an autopilot" + system};
  }
  if (Clock::now() - vehicle_heartbeat_ > kTuning.longest_silence) {
    return {settings_.text + ": the vehicle's HEARTBEAT has ceased"};
  }
  std::vector<std::string> faults = rates_.faults();
  if (mirrors_) {
    std::ranges::copy(parameters_.faults(), std::back_inserter(faults));
  }
  return faults;
}

live::TransportHealth LinkTransport::health() const {
  const mavlink::FrameParser::Counts& counts = parser_.counts();
  const Clock::time_point now = Clock::now();
  live::TransportHealth health{.lost = counts.lost,
                               .damaged = counts.bad_checksum,
                               .unknown = counts.unknown,
                               .refused = senders_.refused() + unsigned_,
                               .faults = vehicle_faults()};
  std::ranges::copy(senders_.faults(now), std::back_inserter(health.faults));
  if (unsigned_ > 0 && now - signature_at_ <= kTuning.fault_memory) {
    health.faults.push_back(verdict_text(signature_));
  }
  return health;
}

live::Output* LinkTransport::open_output(live::Requests& /*requests*/) {
  reports_ = true;
  return &reporter_;
}

std::vector<std::string> LinkTransport::check() {
  const Clock::time_point end = Clock::now() + kTuning.longest_check;
  while (!senders_.vehicle() && Clock::now() < end) {
    bag::Message message;
    next(message, std::chrono::milliseconds(20));
  }
  std::vector<std::string> lines{"MAVLink over " + settings_.text};
  if (const std::optional<Senders::Id>& vehicle = senders_.vehicle()) {
    lines.push_back("the vehicle is " + number_text(*vehicle));
  } else if (asked_) {
    lines.push_back(number_text(*asked_) + " sends none of the messages that [log] names");
  }
  std::ranges::copy(health().faults, std::back_inserter(lines));
  return lines;
}

std::unique_ptr<live::Transport> open_link(const live::Configuration& configuration,
                                           const file::TomlNode& table) {
  const LinkSettings settings = read_link_settings(table);
  if (configuration.plan.pose && settings.velocity != VelocityMessage::none) {
    table["velocity"].refuse(
        "tells measured velocities to the autopilot; from a pose a velocity is known half a window "
        "late, and reckoned until then, so leave it out or take \"none\"");
  }
  if (settings.velocity != VelocityMessage::none) {
    refuse_filtered_velocity(configuration, table["velocity"]);
  }
  if (settings.velocity == VelocityMessage::delta &&
      std::ranges::count(body_velocities(configuration), std::string()) > 0) {
    table["velocity"].refuse(
        "VISION_POSITION_DELTA tells the way ahead, to the right and down, which takes surge, sway "
        "and heave among the velocities of the model; ODOMETRY can leave one open");
  }
  auto line = file::located(table.has("connection") ? table["connection"] : table,
                            [&] { return open_line(settings.connection); });
  return std::make_unique<LinkTransport>(configuration, settings, std::move(line));
}

}  // namespace kelpie::autopilot
