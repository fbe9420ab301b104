// SPDX-License-Identifier: Apache-2.0
#include "live/heading_reader.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/angle.hpp"
#include "live/tuning.hpp"

namespace kelpie::live {

HeadingReader::HeadingReader(const Configuration& configuration)
    : name_(configuration.live.heading), gap_s_(configuration.plan.gap_s) {
  if (!name_.empty()) {
    source_ = configuration.plan.source(name_);
  }
}

std::optional<double> HeadingReader::next(const Receiver& receiver, double t, double yaw_rate,
                                          Output& output) {
  if (!source_) {
    return std::nullopt;
  }
  const SignalHistory& signal = receiver.stream().signal(*source_);
  const std::size_t after = signal.first_after(t);
  if (after == 0 || signal.time_s(after - 1) <= last_s_) {
    return std::nullopt;
  }
  const double read_s = signal.time_s(after - 1);
  const double reading = signal.value(after - 1);
  if (sense_ == 0.0) {
    turn(reading, read_s, yaw_rate, output);
  }
  last_s_ = read_s;
  last_ = reading;
  return sense_ == 0.0 ? std::nullopt : std::optional(sense_ * reading + yaw_rate * (t - read_s));
}

// A turn by the yaw rate alone is its bias.
void HeadingReader::turn(double reading, double t, double yaw_rate, Output& output) {
  if (t - last_s_ > gap_s_) {
    turned_ = yawed_ = 0.0;
    return;
  }
  turned_ += wrapped(reading - last_);
  yawed_ += yaw_rate * (t - last_s_);
  if (std::abs(yawed_) < kTuning.heading_turn_rad) {
    return;
  }
  const double ratio = turned_ / yawed_;
  if (1.0 / kTuning.heading_ratio <= std::abs(ratio) && std::abs(ratio) <= kTuning.heading_ratio) {
    sense_ = std::copysign(1.0, ratio);
  } else if (std::abs(ratio) > kTuning.heading_ratio && !has_told_) {
    has_told_ = true;
    output.event(fmt::format(
        "at {:.1f} s: {}{} turns {:.1f} times as fast as the vehicle, and isn't used as a heading; "
        "units in [log] tells its unit",
        t, kWarning, name_, std::abs(ratio)));
  }
  turned_ = yawed_ = 0.0;
}

bool HeadingReader::is_known(double t) const {
  return sense_ != 0.0 && t - last_s_ <= kTuning.longest_heading_silence_s;
}

double HeadingReader::reading_of(const std::array<double, 2>& velocity) const {
  const double reading = sense_ * std::atan2(velocity[1], velocity[0]);
  return reading < 0.0 ? reading + kFullTurn : reading;
}

}  // namespace kelpie::live
