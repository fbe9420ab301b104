// SPDX-License-Identifier: Apache-2.0
#include "autopilot/reporter.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "autopilot/tuning.hpp"
#include "core/seconds.hpp"
#include "live/health_table.hpp"
#include "motion/states.hpp"

namespace kelpie::autopilot {
namespace {

constexpr std::size_t kLongestName = 10;  // of NAMED_VALUE_FLOAT
constexpr std::size_t kPiece = 50;        // of a text, in one STATUSTEXT
constexpr std::size_t kLongestText = kTuning.pieces * kPiece;
constexpr std::size_t kAxes = 6;
constexpr double kSeverityWarning = 4.0;  // MAV_SEVERITY_WARNING
constexpr double kSeverityNotice = 5.0;   // MAV_SEVERITY_NOTICE

// Ten letters each, without repeats.
std::vector<std::string> short_names(const std::vector<std::string>& targets) {
  std::vector<std::string> names;
  for (const std::string& target : targets) {
    std::string name = target.substr(0, kLongestName);
    for (std::size_t number = 2; std::ranges::find(names, name) != names.end(); ++number) {
      const std::string end = std::to_string(number);
      name = target.substr(0, kLongestName - end.size()) + end;
    }
    names.push_back(name);
  }
  return names;
}

double microseconds_of(std::int64_t stamp_ns) {
  return std::floor(static_cast<double>(std::max<std::int64_t>(stamp_ns, 0)) / 1e3);
}

}  // namespace

Reporter::Reporter(const std::vector<std::string>& targets, VelocityMessage velocity, bool is_frd)
    : names_(short_names(targets)), velocity_(velocity), is_frd_(is_frd) {}

void Reporter::predicted(const live::PredictedSample& sample) {
  const std::lock_guard lock(mutex_);
  predictions_.clear();
  for (std::size_t i = 0; i < sample.predictions.size(); ++i) {
    predictions_.emplace_back(names_[i], sample.predictions[i].value);
  }
}

void Reporter::reckoned(const live::ReckonedSample& sample) {
  if (velocity_ == VelocityMessage::none) {
    return;
  }
  constexpr std::array<double, kAxes> kFlu{1.0, -1.0, -1.0, 1.0, -1.0, -1.0};
  Twist twist{.stamp_ns = sample.data_ns};
  twist.value.fill(std::numeric_limits<double>::quiet_NaN());
  twist.covariance.fill(std::numeric_limits<double>::quiet_NaN());
  std::vector<std::optional<std::size_t>> axes;
  std::ranges::transform(sample.names, std::back_inserter(axes), velocity_axis);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (!axes[i]) {
      continue;
    }
    const double sign = is_frd_ ? 1.0 : kFlu[*axes[i]];
    twist.value[*axes[i]] = sign * sample.reckoning.velocity(i);
    for (std::size_t k = 0; k < axes.size(); ++k) {
      if (axes[k]) {
        twist.covariance[kAxes * *axes[i] + *axes[k]] =
            sign * (is_frd_ ? 1.0 : kFlu[*axes[k]]) * sample.reckoning.covariance(i, k);
      }
    }
  }
  const std::lock_guard lock(mutex_);
  twist_ = twist;
}

void Reporter::health(const live::Health& health) {
  const std::lock_guard lock(mutex_);
  health_.clear();
  for (const auto& field : live::health_fields<live::Health>()) {
    if (const double value = field.names.brief.empty() ? std::nan("") : field.value(health);
        std::isfinite(value)) {
      health_.emplace_back(field.names.brief, value);
    }
  }
}

void Reporter::event(const std::string& line) {
  const std::lock_guard lock(mutex_);
  if (texts_.size() < kTuning.most_texts) {
    texts_.push_back(("kelpie: " + line).substr(0, kLongestText));
  }
}

void Reporter::send_due(Time now, double boot_ms, mavlink::FrameWriter& writer, const Send& send) {
  const std::lock_guard lock(mutex_);
  if (!(predictions_.empty() && health_.empty()) && now - sent_values_ >= kTuning.between_values) {
    sent_values_ = now;
    send_values(std::exchange(predictions_, {}), boot_ms, writer, send);
    send_values(std::exchange(health_, {}), boot_ms, writer, send);
  }
  if (twist_ && now - sent_velocity_ >= kTuning.between_velocities) {
    sent_velocity_ = now;
    if (velocity_ == VelocityMessage::odometry) {
      send_odometry(writer, send);
    } else {
      send_delta(writer, send);
    }
    told_ = std::exchange(twist_, std::nullopt);
  }
  if (!texts_.empty() && now - sent_text_ >= kTuning.between_texts) {
    sent_text_ = now;
    send_text(writer, send);
  }
}

void Reporter::send_values(const std::vector<std::pair<std::string, double>>& values,
                           double boot_ms, mavlink::FrameWriter& writer, const Send& send) {
  for (const auto& [name, value] : values) {
    writer.begin("NAMED_VALUE_FLOAT").set("time_boot_ms", boot_ms).set("name", name);
    send(writer.set("value", value).finish());
  }
}

// The velocity alone: a position, an attitude and a component of the velocity of NaN are unknown.
void Reporter::send_odometry(mavlink::FrameWriter& writer, const Send& send) const {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  constexpr double kLocalFrd = 20.0;  // MAV_FRAME_LOCAL_FRD
  constexpr double kBodyFrd = 12.0;   // MAV_FRAME_BODY_FRD
  constexpr std::array<const char*, kAxes> kFields{"vx",        "vy",         "vz",
                                                   "rollspeed", "pitchspeed", "yawspeed"};
  writer.begin("ODOMETRY").set("time_usec", microseconds_of(twist_->stamp_ns));
  writer.set("frame_id", kLocalFrd).set("child_frame_id", kBodyFrd);
  for (const char* const field : {"x", "y", "z"}) {
    writer.set(field, kUnknown);
  }
  writer.set("q", kUnknown).set("pose_covariance", kUnknown);
  std::size_t entry = 0;  // of the upper right triangle
  for (std::size_t i = 0; i < kAxes; ++i) {
    writer.set(kFields[i], twist_->value[i]);
    for (std::size_t k = i; k < kAxes; ++k, ++entry) {
      writer.set("velocity_covariance", twist_->covariance[kAxes * i + k], entry);
    }
  }
  send(writer.finish());
}

// The way since the message before, as a velocity log sends; ArduPilot takes a standard deviation
// of 0.05 to 0.9 m/s from the confidence (EK3's parameters VISO_VEL_ERR of its EKF).
void Reporter::send_delta(mavlink::FrameWriter& writer, const Send& send) {
  constexpr double kBest = 0.05;
  constexpr double kWorst = 0.9;
  if (!told_ || twist_->stamp_ns <= told_->stamp_ns) {
    return;
  }
  const double time_s = seconds(twist_->stamp_ns - told_->stamp_ns);
  if (time_s > kTuning.longest_delta_s) {
    return;
  }
  writer.begin("VISION_POSITION_DELTA").set("time_usec", microseconds_of(twist_->stamp_ns));
  writer.set("time_delta_usec", std::floor(1e6 * time_s));
  double variance = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    // The message has no unknown angle.
    const auto way = [&](std::size_t axis) {
      const double sum = told_->value[axis] + twist_->value[axis];
      return std::isnan(sum) ? 0.0 : 0.5 * time_s * sum;
    };
    writer.set("angle_delta", way(3 + i), i).set("position_delta", way(i), i);
    variance = std::fmax(variance, twist_->covariance[(kAxes + 1) * i]);
  }
  const double confidence = 100.0 * (kWorst - std::sqrt(variance)) / (kWorst - kBest);
  writer.set("confidence", std::clamp(confidence, 1.0, 100.0));
  send(writer.finish());
}

// In pieces of 50 bytes; readers join pieces by their number.
void Reporter::send_text(mavlink::FrameWriter& writer, const Send& send) {
  const std::string text = std::move(texts_.front());
  texts_.pop_front();
  const double severity =
      text.find(live::kWarning) == std::string::npos ? kSeverityNotice : kSeverityWarning;
  text_id_ =
      text.size() > kPiece ? static_cast<std::uint16_t>(text_id_ % UINT16_MAX + 1) : text_id_;
  // A last piece that fills its message has no end of its own.
  for (std::size_t at = 0, piece = 0; at == 0 || at <= text.size(); at += kPiece, ++piece) {
    writer.begin("STATUSTEXT").set("severity", severity).set("text", text.substr(at, kPiece));
    if (text.size() <= kPiece) {
      send(writer.finish());
      return;
    }
    writer.set("id", text_id_).set("chunk_seq", static_cast<double>(piece));
    send(writer.finish());
  }
}

}  // namespace kelpie::autopilot
