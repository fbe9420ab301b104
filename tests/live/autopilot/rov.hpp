// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bag/tlogs.hpp"
#include "mavlink/frame_parser.hpp"
#include "mavlink/frame_writer.hpp"

namespace kelpie::testing {

/// A little vehicle with ArduSub's manners: its messages come at the rates of its streams, too slow
/// for anybody, until they are asked for faster. It moves along one axis by one thruster.
class Rov {
 public:
  using Send = std::function<void(std::span<const std::byte>)>;

  explicit Rov(std::uint8_t system = 1, mavlink::FrameWriter::Signer signer = {})
      : writer_(system, 1, std::move(signer)) {}

  /// So much of its time goes by; what it says goes to `send`.
  void go(double seconds, const Send& send) {
    for (const double end = t_s_ + seconds; t_s_ < end;) {
      ++step_;
      t_s_ = kStep * static_cast<double>(step_);
      const double n = 8.0 * std::sin(0.37 * t_s_) + 2.0 * std::sin(1.3 * t_s_);
      u_ += kStep * (0.01 * n * std::abs(n) - 2.0 * u_ * std::abs(u_) - 0.3 * u_);
      if (is_due(1.0)) {
        send(heartbeat_of_vehicle(writer_, is_armed));
      }
      if (is_due(rates_hz["ATTITUDE"])) {
        writer_.begin("ATTITUDE").set("time_boot_ms", of_32_bits(1e3 * t_s_));
        for (const char* const field : {"roll", "rollspeed", "pitch", "pitchspeed", "yawspeed"}) {
          writer_.set(field, 0.1 * std::sin(t_s_ + static_cast<double>(field[0])));
        }
        send(writer_.finish());
      }
      if (is_due(rates_hz["LOCAL_POSITION_NED"])) {
        writer_.begin("LOCAL_POSITION_NED").set("time_boot_ms", of_32_bits(1e3 * t_s_));
        send(writer_.set("vx", u_).set("vy", 0.5 * u_).set("vz", 0.1 * u_).finish());
      }
      if (is_due(rates_hz["ODOMETRY"])) {
        writer_.begin("ODOMETRY").set("time_usec", std::round(1e6 * t_s_)).set("vx", u_);
        send(writer_.set("q", 1.0).finish());
      }
      if (is_due(rates_hz["SERVO_OUTPUT_RAW"])) {
        writer_.begin("SERVO_OUTPUT_RAW").set("time_usec", of_32_bits(1e6 * t_s_));
        send(writer_.set("servo1_raw", std::round(1500.0 + 40.0 * n)).finish());
      }
    }
  }

  bool is_armed = false;

  /// What comes to it.
  void hear(std::span<const std::byte> bytes, const Send& send) {
    parser_.add(bytes);
    for (mavlink::Frame frame; parser_.next(frame);) {
      const auto value = [&](const char* field) {
        return mavlink::number_at(*frame.definition->find(field), frame.payload);
      };
      const std::string& name = frame.definition->name;
      all_are_signed &= frame.is_signed;
      ++heard[name];
      last[name] = {frame.definition, {frame.payload.begin(), frame.payload.end()}};
      if (name == "STATUSTEXT") {
        texts += mavlink::text_at(*frame.definition->find("text"), frame.payload) + "\n";
      } else if (name == "NAMED_VALUE_FLOAT") {
        const std::string what = mavlink::text_at(*frame.definition->find("name"), frame.payload);
        values[what] = value("value");
        ++heard[what];
      } else if (name == "COMMAND_LONG" && value("command") == 511) {
        const auto* const asked =
            mavlink::find_definition(static_cast<std::uint32_t>(value("param1")));
        const bool refuses = asked->name == refuses_message;
        if (!refuses) {
          rates_hz[asked->name] = 1e6 / value("param2");
        }
        writer_.begin("COMMAND_ACK").set("command", 511).set("result", refuses ? 3 : 0);
        send(writer_.finish());
      } else if (name == "PARAM_REQUEST_READ") {
        const std::string what =
            mavlink::text_at(*frame.definition->find("param_id"), frame.payload);
        asked_parameters.push_back(what);
        if (const auto found = parameters.find(what); found != parameters.end()) {
          writer_.begin("PARAM_VALUE").set("param_id", what).set("param_value", found->second);
          send(writer_.finish());
        }
      }
    }
  }

  double t_s() const { return t_s_; }
  void restart() { step_ = 0, t_s_ = 0.0; }  ///< The autopilot boots: its time begins anew.
  /// It has been up for so long.
  void be_up(double seconds) {
    step_ = static_cast<std::size_t>(std::round(seconds / kStep));
    t_s_ = kStep * static_cast<double>(step_);
  }

  std::map<std::string, double> rates_hz{{"ODOMETRY", 4.0}, {"SERVO_OUTPUT_RAW", 2.0}};
  std::map<std::string, int> heard;  ///< messages, by name
  /// The last message of each name.
  std::map<std::string, std::pair<const mavlink::Definition*, std::vector<std::byte>>> last;
  /// A field of the last message of this name.
  double field(const std::string& name, const char* of, std::size_t index = 0) const {
    const auto& [definition, payload] = last.at(name);
    return mavlink::number_at(*definition->find(of), payload, index);
  }
  std::map<std::string, double> values;         ///< the last of each NAMED_VALUE_FLOAT
  std::string texts;                            ///< of STATUSTEXTs, a line each
  bool all_are_signed = true;                   ///< what it has heard
  std::map<std::string, double> parameters;     ///< that it tells when asked
  std::vector<std::string> asked_parameters{};  ///< names, in order
  std::string refuses_message;                  ///< that it won't send faster

 private:
  static constexpr double kStep = 0.005;

  static double of_32_bits(double count) { return std::fmod(std::round(count), 4'294'967'296.0); }

  bool is_due(double rate_hz) const {
    return std::floor(t_s_ * rate_hz) > std::floor((t_s_ - kStep) * rate_hz);
  }

  mavlink::FrameWriter writer_;
  mavlink::FrameParser parser_;
  std::size_t step_ = 0;
  double t_s_ = 0.0;
  double u_ = 0.0;
};

/// A configuration for it; `log` and `live` are more lines of these tables, `mavlink` the table
/// [live.mavlink].
inline std::string rov_config(const std::string& mavlink, const std::string& live = "",
                              const std::string& log = "") {
  return "buffer = 60\nanchors = 20\n[log]\ninputs = [\"u\", \"n\"]\ntargets = [\"udot\"]\n"
         "rate = 10\nclock = \"header\"\n" +
         log +
         "\n[log.states]\nu = \"ODOMETRY:vx\"\n[log.commands]\nn = "
         "\"SERVO_OUTPUT_RAW:servo1_raw\"\n"
         "[log.derived]\nudot = \"d(u)\"\n[live]\nalign = \"none\"\n" +
         live + "\n[live.mavlink]\n" + mavlink + "\n";
}

}  // namespace kelpie::testing
