// SPDX-License-Identifier: Apache-2.0
#include "autopilot/vehicle_configuration.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstddef>
#include <vector>

#include "autopilot/link_transport.hpp"
#include "autopilot/tuning.hpp"
#include "bag/autopilot_state.hpp"
#include "core/text.hpp"
#include "file/toml.hpp"
#include "kelpie/core/error.hpp"
#include "live/configuration.hpp"
#include "mavlink/definition.hpp"

namespace kelpie::autopilot {
namespace {

constexpr const char* kOption = "--mavlink";
constexpr std::size_t kOutputs = 16;  // of SERVO_OUTPUT_RAW
constexpr const char* kLocal = "LOCAL_POSITION_NED";
constexpr const char* kGlobal = "GLOBAL_POSITION_INT";

// Names what is asked for; rows are not made.
live::Configuration listening() {
  std::string text = fmt::format(
      "[log]\nrate = 10\ninputs = [\"u\", \"m1\"]\ntargets = [\"udot\"]\n"
      "[log.derived]\nudot = \"d(u)\"\n[log.states]\nu = \"{}:vx\"\nglobal = \"{}:vx\"\n"
      "phi = \"ATTITUDE:roll\"\n[log.commands]\n",
      kLocal, kGlobal);
  for (std::size_t output = 1; output <= kOutputs; ++output) {
    text += fmt::format("m{0} = \"SERVO_OUTPUT_RAW:servo{0}_raw\"\n", output);
  }
  const char* const name = "the messages of ArduSub";
  return live::read_configuration(file::TomlNode::parse(text, name), name, {});
}

bool is_whole(const HeardVehicle& heard) {
  for (std::size_t output = 1; output <= kOutputs; ++output) {
    if (!log::next_parameter(heard.parameters, output).empty()) {
      return false;
    }
  }
  return heard.parameters.contains("FRAME_CONFIG") && heard.messages.contains("ATTITUDE") &&
         heard.messages.contains("SERVO_OUTPUT_RAW") && heard.messages.contains(kLocal);
}

void take(const bag::Topic& topic, const bag::Message& message, HeardVehicle& heard) {
  if (topic.name.starts_with('/')) {
    return;  // another sender's
  }
  heard.messages.insert(topic.name);
  if (topic.name == "PARAM_VALUE") {
    const mavlink::Definition& definition = *mavlink::find_definition(topic.name);
    bag::keep_parameter(heard.parameters,
                        mavlink::text_at(*definition.find("param_id"), message.data),
                        mavlink::number_at(*definition.find("param_value"), message.data));
  }
}

LinkTransport link_of(const live::Configuration& configuration, const std::string& connection) {
  try {
    const LinkSettings settings{.text = connection, .connection = parse_connection(connection)};
    return {configuration, settings, open_line(settings.connection)};
  } catch (const InputError& error) {
    throw InputError(kOption, error.what());
  }
}

// A table of columns, a line each.
std::string table_of(const std::string& name, const std::vector<std::string>& lines) {
  return "\n[" + name + "]\n" + join_text(lines, "\n") + "\n";
}

}  // namespace

HeardVehicle hear_vehicle(const std::string& connection,
                          const std::function<bool(const std::string& fault)>& keep_going) {
  using Clock = std::chrono::steady_clock;
  const live::Configuration configuration = listening();
  LinkTransport link = link_of(configuration, connection);
  HeardVehicle heard;
  Clock::time_point end = Clock::time_point::max();
  const auto fault = [&] {
    return heard.messages.empty() ? join_text(link.health().faults, "; ") : std::string();
  };
  while (!is_whole(heard) && Clock::now() < end && keep_going(fault())) {
    bag::Message message;
    if (link.next(message, std::chrono::milliseconds(20)) == live::Transport::Got::message) {
      end = heard.messages.empty() ? Clock::now() + kTuning.longest_introduction : end;
      take(link.topics()[message.topic], message, heard);
    }
  }
  return heard;
}

std::string configuration_text(const std::string& connection, const HeardVehicle& heard) {
  const std::vector<log::MotorActuator> motors = log::motor_outputs(heard.parameters);
  if (heard.messages.empty()) {
    throw InputError(kOption, "no vehicle was heard at " + connection);
  }
  const bool is_local = heard.messages.contains(kLocal);
  const char* const velocity = is_local ? kLocal : kGlobal;
  if (motors.empty()) {
    throw InputError(kOption,
                     "the vehicle names no output as a motor (SERVOn_FUNCTION); --config "
                     "takes a file that names the commands");
  }
  for (const char* const message : {"ATTITUDE", velocity}) {
    if (!heard.messages.contains(message)) {
      throw InputError(kOption, std::string("the vehicle sends no ") + message);
    }
  }
  std::string inputs;
  std::vector<std::string> commands;
  std::vector<std::string> neutral;
  for (const log::MotorActuator& motor : motors) {
    inputs += fmt::format(", \"m{}\"", motor.motor);
    commands.push_back(
        fmt::format("m{} = \"SERVO_OUTPUT_RAW:servo{}_raw\"", motor.motor, motor.output));
    neutral.push_back(fmt::format("m{} = {{neutral = 1500}}", motor.motor));
  }
  const std::string frame = log::sub_frame_name(heard.parameters);
  std::string text = fmt::format(
      "# The vehicle at {0}, by its own parameters{1}{2}; docs/howto/bluerov2.md.\n\n[log]\n"
      "inputs = [\"u\", \"v\", \"w\", \"p\", \"q\", \"r\", \"phi\", \"theta\"{3}]\n"
      "targets = [\"udot\", \"vdot\", \"wdot\", \"pdot\", \"qdot\", \"rdot\"]\n"
      "rate = 10\nclock = \"header\"\narmed_only = true\nmirror_motors = true\n"
      "vectors = [{{columns = [\"u\", \"v\", \"w\"], from = \"NED\", to = \"FRD\", "
      "attitude = [\"phi\", \"theta\", \"psi\"]}}]\n"
      "units = {{u = \"m/s\", v = \"m/s\", w = \"m/s\", p = \"rad/s\", q = \"rad/s\", "
      "r = \"rad/s\", phi = \"rad\", theta = \"rad\", psi = \"rad\"}}\n",
      connection, frame.empty() ? "" : ": ", frame, inputs);
  text += table_of(
      "log.states",
      {fmt::format("u = \"{}:vx\"", velocity), fmt::format("v = \"{}:vy\"", velocity),
       fmt::format("w = \"{}:vz\"", velocity), "phi = \"ATTITUDE:roll\"",
       "theta = \"ATTITUDE:pitch\"", "psi = \"ATTITUDE:yaw\"", "p = \"ATTITUDE:rollspeed\"",
       "q = \"ATTITUDE:pitchspeed\"", "r = \"ATTITUDE:yawspeed\""});
  text += table_of("log.commands", commands) + table_of("log.actuators", neutral);
  if (!is_local) {
    text += table_of("log.scale", {"u = 0.01  # cm/s", "v = 0.01", "w = 0.01"});
  }
  text += table_of("log.derived", {"udot = \"d(u)\"", "vdot = \"d(v)\"", "wdot = \"d(w)\"",
                                   "pdot = \"d(p)\"", "qdot = \"d(q)\"", "rdot = \"d(r)\""});
  return text + table_of("live.mavlink", {"connection = \"" + connection + "\""});
}

}  // namespace kelpie::autopilot
