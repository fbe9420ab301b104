// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "autopilot/link_settings.hpp"
#include "live/output.hpp"
#include "mavlink/frame_writer.hpp"

namespace kelpie::autopilot {

/// Reports to the vehicle and a ground station behind: predictions, with the health's main numbers,
/// as NAMED_VALUE_FLOAT, events as STATUSTEXT. LinkTransport sends the frames. For any thread; a
/// flood of events is dropped.
class Reporter final : public live::Output {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Send = std::function<void(std::span<const std::byte>)>;

  /// `targets` are the axes' names; a message holds ten letters. `velocity`: the message of
  /// velocities, with the frame `is_frd` of the log (LinkSettings).
  explicit Reporter(const std::vector<std::string>& targets,
                    VelocityMessage velocity = VelocityMessage::none, bool is_frd = true);

  bool wants_predictions() const override { return true; }
  void predicted(const live::PredictedSample& sample) override;
  void reckoned(const live::ReckonedSample& sample) override;
  void health(const live::Health& health) override;
  void event(const std::string& line) override;

  /// Sends the frames due now. `boot_ms` is the time since the own start.
  void send_due(Time now, double boot_ms, mavlink::FrameWriter& writer, const Send& send);

  const std::vector<std::string>& names() const { return names_; }  ///< As sent.

 private:
  static void send_values(const std::vector<std::pair<std::string, double>>& values, double boot_ms,
                          mavlink::FrameWriter& writer, const Send& send);
  // Of surge, sway, heave, roll, pitch and yaw, forward, right, down.
  struct Twist {
    std::int64_t stamp_ns = 0;
    std::array<double, 6> value{};        // NaN: unknown
    std::array<double, 36> covariance{};  // row-major; NaN: unknown
  };

  void send_odometry(mavlink::FrameWriter& writer, const Send& send) const;
  void send_delta(mavlink::FrameWriter& writer, const Send& send);
  void send_text(mavlink::FrameWriter& writer, const Send& send);

  std::vector<std::string> names_;
  std::mutex mutex_;
  std::vector<std::pair<std::string, double>> predictions_;  // not sent yet
  std::vector<std::pair<std::string, double>> health_;       // the same
  VelocityMessage velocity_;
  bool is_frd_;
  std::optional<Twist> twist_;  // not sent yet
  std::optional<Twist> told_;   // sent last
  std::deque<std::string> texts_;
  std::uint16_t text_id_ = 0;
  Time sent_values_;
  Time sent_velocity_;
  Time sent_text_;
};

}  // namespace kelpie::autopilot
