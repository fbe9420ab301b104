// SPDX-License-Identifier: Apache-2.0
#include "autopilot/reporter.hpp"

#include <algorithm>
#include <utility>

#include "autopilot/tuning.hpp"
#include "live/health_table.hpp"

namespace kelpie::autopilot {
namespace {

constexpr std::size_t kLongestName = 10;  // of NAMED_VALUE_FLOAT
constexpr std::size_t kPiece = 50;        // of a text, in one STATUSTEXT
constexpr std::size_t kLongestText = kTuning.pieces * kPiece;
constexpr double kNotice = 5.0;  // MAV_SEVERITY_NOTICE

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

}  // namespace

Reporter::Reporter(const std::vector<std::string>& targets) : names_(short_names(targets)) {}

void Reporter::predicted(const live::PredictedSample& sample) {
  const std::lock_guard lock(mutex_);
  predictions_.clear();
  for (std::size_t i = 0; i < sample.predictions.size(); ++i) {
    predictions_.emplace_back(names_[i], sample.predictions[i].value);
  }
}

void Reporter::health(const live::Health& health) {
  const std::lock_guard lock(mutex_);
  health_.clear();
  for (const auto& field : live::health_fields<live::Health>()) {
    if (!field.names.brief.empty()) {
      health_.emplace_back(field.names.brief, field.value(health));
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

// In pieces of 50 bytes; readers join pieces by their number.
void Reporter::send_text(mavlink::FrameWriter& writer, const Send& send) {
  const std::string text = std::move(texts_.front());
  texts_.pop_front();
  text_id_ =
      text.size() > kPiece ? static_cast<std::uint16_t>(text_id_ % UINT16_MAX + 1) : text_id_;
  // A last piece that fills its message has no end of its own.
  for (std::size_t at = 0, piece = 0; at == 0 || at <= text.size(); at += kPiece, ++piece) {
    writer.begin("STATUSTEXT").set("severity", kNotice).set("text", text.substr(at, kPiece));
    if (text.size() <= kPiece) {
      send(writer.finish());
      return;
    }
    writer.set("id", text_id_).set("chunk_seq", static_cast<double>(piece));
    send(writer.finish());
  }
}

}  // namespace kelpie::autopilot
