// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bag/packed_bytes.hpp"
#include "bag/tlogs.hpp"

namespace kelpie::testing {

/// A drive of 140 s of a vehicle with ArduSub, armed from 20 s to 120 s, as a ground station
/// (.tlog) and as the autopilot (.BIN) record the drive. Velocities of the body are FRD.
class ArdusubDrive {
 public:
  static constexpr double kEnd_s = 140.0;
  static constexpr double kArmed_s = 20.0;
  static constexpr double kDisarmed_s = 120.0;

  /// Motors 1 and 2 are on outputs 2 and 1; motor 2 is reversed; output 9 has the lights.
  static std::vector<std::pair<std::string, double>> parameters() {
    return {{"FRAME_CONFIG", 1},     {"SERVO1_FUNCTION", 34},  {"SERVO2_FUNCTION", 33},
            {"SERVO3_FUNCTION", 35}, {"SERVO4_FUNCTION", 36},  {"SERVO5_FUNCTION", 37},
            {"SERVO6_FUNCTION", 38}, {"SERVO9_FUNCTION", 181}, {"MOT_1_DIRECTION", 1},
            {"MOT_2_DIRECTION", -1}, {"MOT_3_DIRECTION", 1},   {"MOT_4_DIRECTION", 1},
            {"MOT_5_DIRECTION", 1},  {"MOT_6_DIRECTION", 1},   {"LOG_DISARMED", 1}};
  }

  static std::array<double, 3> velocity(double t) {
    return {0.5 * std::sin(0.7 * t), 0.2 * std::sin(0.5 * t + 1.0), 0.1 * std::sin(0.9 * t)};
  }
  static std::array<double, 3> rates(double t) {
    return {0.03 * std::cos(0.3 * t), -0.02 * std::sin(0.4 * t), 0.2 * std::sin(0.35 * t)};
  }
  static std::array<double, 3> angles(double t) {
    return {0.1 * std::sin(0.3 * t), 0.05 * std::cos(0.4 * t), 1.0 + 0.3 * std::sin(0.35 * t)};
  }
  /// Pulse of an output, 1 to 9.
  static double pulse(double t, int output) {
    const bool is_armed = t >= kArmed_s && t < kDisarmed_s;
    return !is_armed ? 1500.0
           : output == 9
               ? 1100.0 + std::round(5.0 * t)
               : 1500.0 + std::round(150.0 * std::sin((0.4 + 0.13 * output) * t + output));
  }
  /// The velocity turned by the attitude: yaw, pitch, roll (Fossen 2011, eq. 2.18).
  static std::array<double, 3> velocity_ned(double t) {
    const auto [u, v, w] = velocity(t);
    const auto [phi, theta, psi] = angles(t);
    const double y = v * std::cos(phi) - w * std::sin(phi);
    const double z = v * std::sin(phi) + w * std::cos(phi);
    const double x = u * std::cos(theta) + z * std::sin(theta);
    return {x * std::cos(psi) - y * std::sin(psi), x * std::sin(psi) + y * std::cos(psi),
            -u * std::sin(theta) + z * std::cos(theta)};
  }

  /// `with_dvl`: a companion computer, system 255, sends VISION_POSITION_DELTA ten times a second.
  static Tlog tlog(bool with_dvl = false) {
    mavlink::FrameWriter writer(1, 1);
    mavlink::FrameWriter companion(255, 0);
    Tlog log;
    const auto add = [&](double t) {
      log.add(kTlogBeginUs + static_cast<std::uint64_t>(std::llround(1e6 * t)) + 2'000,
              writer.finish());
    };
    for (int k = 0; k < static_cast<int>(20.0 * kEnd_s); ++k) {
      const double t = 0.05 * k;
      if (k % 20 == 0) {
        const bool is_armed = t >= kArmed_s && t < kDisarmed_s;
        writer.begin("HEARTBEAT").set("type", 12).set("autopilot", 3).set("mavlink_version", 3);
        writer.set("base_mode", is_armed ? 209 : 81);
        add(t);
      }
      if (k == 1) {
        for (const auto& [name, value] : parameters()) {
          writer.begin("PARAM_VALUE").set("param_id", name).set("param_value", value);
          add(t);
        }
      }
      add_motion(writer, t, add, k);
      if (with_dvl && k % 2 == 0) {
        log.add(kTlogBeginUs + static_cast<std::uint64_t>(std::llround(1e6 * t)) + 2'000,
                delta(companion, t));
      }
    }
    return log;
  }

  /// `with_dvl`: the autopilot records the same as VISO.
  static std::string bin(bool with_dvl = false) {
    PackedBytes log = definitions();
    for (const auto& [name, value] : parameters()) {
      log.add(head(16)).add(std::uint64_t{1'000}).add(name, 16).add(static_cast<float>(value));
    }
    for (int k = 0; k < static_cast<int>(20.0 * kEnd_s); ++k) {
      const double t = 0.05 * k;
      if (t == kArmed_s || t == kDisarmed_s) {
        log.add(head(17)).add(stamp(t)).add(static_cast<std::uint8_t>(t == kArmed_s ? 1 : 0));
      }
      add_records(log, t, k);
      if (with_dvl && k % 2 == 0) {
        log.add(head(18)).add(stamp(t)).add(static_cast<float>(kDelta_s));
        log.add(0.0F).add(0.0F).add(0.0F);
        for (const double velocity : velocity(t)) {
          log.add(static_cast<float>(kDelta_s * velocity));
        }
        log.add(100.0F);
      }
    }
    return log.text();
  }

 private:
  static constexpr double kDegrees = 57.29577951308232;
  static constexpr double kDelta_s = 0.1;

  static std::span<const std::byte> delta(mavlink::FrameWriter& companion, double t) {
    companion.begin("VISION_POSITION_DELTA").set("time_usec", std::round(1e6 * t));
    companion.set("time_delta_usec", std::round(1e6 * kDelta_s)).set("confidence", 100);
    const std::array<double, 3> speed = velocity(t);
    for (std::size_t axis = 0; axis < speed.size(); ++axis) {
      companion.set("position_delta", kDelta_s * speed[axis], axis);
    }
    return companion.finish();
  }

  template <typename Add>
  static void add_motion(mavlink::FrameWriter& writer, double t, const Add& add, int k) {
    const auto with_stamp = [&](const char* name) -> mavlink::FrameWriter& {
      return writer.begin(name).set("time_boot_ms", std::round(1e3 * t));
    };
    const auto [p, q, r] = rates(t);
    const auto [phi, theta, psi] = angles(t);
    with_stamp("ATTITUDE").set("roll", phi).set("pitch", theta).set("yaw", psi);
    writer.set("rollspeed", p).set("pitchspeed", q).set("yawspeed", r);
    add(t);
    if (k % 2 == 0) {
      const auto [north, east, down] = velocity_ned(t);
      with_stamp("LOCAL_POSITION_NED").set("vx", north).set("vy", east).set("vz", down);
      add(t);
      writer.begin("SERVO_OUTPUT_RAW").set("time_usec", std::round(1e6 * t));
      for (int output = 1; output <= 9; ++output) {
        writer.set("servo" + std::to_string(output) + "_raw", pulse(t, output));
      }
      add(t);
    }
    if (k % 10 == 0) {
      writer.begin("SYS_STATUS").set("voltage_battery", 16'000.0 - std::round(10.0 * t));
      add(t);
    }
  }

  static PackedBytes head(std::uint8_t number) {
    return PackedBytes().add(std::uint8_t{0xA3}).add(std::uint8_t{0x95}).add(number);
  }
  static std::uint64_t stamp(double t) { return static_cast<std::uint64_t>(std::llround(1e6 * t)); }
  static PackedBytes format(std::uint8_t number, std::uint8_t bytes, std::string_view name,
                            std::string_view letters, std::string_view columns) {
    return head(128).add(number).add(bytes).add(name, 4).add(letters, 16).add(columns, 64);
  }

  static PackedBytes definitions() {
    PackedBytes log = format(128, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns");
    log.add(format(1, 76, "UNIT", "QbZ", "TimeUS,Id,Label"));
    log.add(format(3, 44, "FMTU", "QBNN", "TimeUS,FmtType,UnitIds,MultIds"));
    log.add(format(12, 29, "XKF1", "QccCfff", "TimeUS,Roll,Pitch,Yaw,VN,VE,VD"));
    log.add(format(13, 23, "RATE", "Qfff", "TimeUS,R,P,Y"));
    log.add(format(14, 29, "RCOU", "QHHHHHHHHH", "TimeUS,C1,C2,C3,C4,C5,C6,C7,C8,C9"));
    log.add(format(15, 15, "BAT", "Qf", "TimeUS,Volt"));
    log.add(format(16, 31, "PARM", "QNf", "TimeUS,Name,Value"));
    log.add(format(17, 12, "ARM", "QB", "TimeUS,ArmState"));
    log.add(
        format(18, 43, "VISO", "Qffffffff", "TimeUS,dt,AngDX,AngDY,AngDZ,PosDX,PosDY,PosDZ,conf"));
    for (const auto& [id, label] :
         {std::pair('s', "s"), std::pair('d', "deg"), std::pair('k', "deg/s"),
          std::pair('n', "m/s"), std::pair('v', "V"), std::pair('Y', "us"), std::pair('m', "m"),
          std::pair('r', "rad")}) {
      log.add(head(1)).add(std::uint64_t{0}).add(id).add(label, 64);
    }
    for (const auto& [number, units] :
         {std::pair(12, "sdddnnn"), std::pair(13, "skkk"), std::pair(14, "sYYYYYYYYY"),
          std::pair(15, "sv"), std::pair(18, "ssrrrmmm-")}) {
      log.add(head(3)).add(std::uint64_t{0}).add(static_cast<std::uint8_t>(number));
      log.add(units, 16).add("----------", 16);
    }
    return log;
  }

  static void add_records(PackedBytes& log, double t, int k) {
    const auto cdeg = [](double angle) {
      return static_cast<std::int16_t>(std::lround(100.0 * kDegrees * angle));
    };
    const auto [p, q, r] = rates(t);
    log.add(head(13)).add(stamp(t)).add(static_cast<float>(kDegrees * p));
    log.add(static_cast<float>(kDegrees * q)).add(static_cast<float>(kDegrees * r));
    if (k % 2 == 0) {
      const auto [phi, theta, psi] = angles(t);
      log.add(head(12)).add(stamp(t)).add(cdeg(phi)).add(cdeg(theta));
      log.add(static_cast<std::uint16_t>(cdeg(psi)));
      for (const double velocity : velocity_ned(t)) {
        log.add(static_cast<float>(velocity));
      }
      log.add(head(14)).add(stamp(t));
      for (int output = 1; output <= 9; ++output) {
        log.add(static_cast<std::uint16_t>(pulse(t, output)));
      }
    }
    if (k % 10 == 0) {
      log.add(head(15)).add(stamp(t)).add(static_cast<float>(16.0 - 0.01 * t));
    }
  }
};

}  // namespace kelpie::testing
