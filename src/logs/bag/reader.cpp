// SPDX-License-Identifier: Apache-2.0
#include "bag/reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bag/tuning.hpp"
#include "core/text.hpp"

namespace kelpie::bag {
namespace {

// One line, with the topic that most of the messages belong to.
std::string passed_over_text(const std::map<std::string, std::size_t>& by_topic) {
  if (by_topic.empty()) {
    return "";
  }
  using Entry = std::map<std::string, std::size_t>::value_type;
  const auto most = std::ranges::max_element(by_topic, {}, &Entry::second);
  std::size_t all = 0;
  for (const auto& [topic, count] : by_topic) {
    all += count;
  }
  return fmt::format(
      "passed over: {} message{} with a wrong checksum, {} of {} (--strict refuses)\n", all,
      all == 1 ? "" : "s", most->second, printable(most->first));
}

}  // namespace

bool MessageReader::next(Message& message) {
  while (definitions_ <= kTuning.most_definitions && !at_end()) {
    try {
      if (step(message)) {
        return true;
      }
    } catch (const InputError& error) {
      lose(error);
      pass_damage();
    }
  }
  return false;
}

std::string MessageReader::losses_text() const {
  std::string text = passed_over_text(passed_over_);
  for (const std::string& loss : losses_) {
    text += "lost: " + loss + "\n";
  }
  if (loss_count_ > losses_.size()) {
    text += "lost: " + std::to_string(loss_count_ - losses_.size()) + " more\n";
  }
  for (const std::string& what : left_out_) {
    text += "left out: " + what + "\n";
  }
  return text;
}

void MessageReader::lose(const InputError& damage) {
  if (mode_ != ReadMode::recover) {
    throw damage;  // NOLINT(cert-err60-cpp): a copy of texts fails only without memory
  }
  if (losses_.size() < kShownLosses) {
    losses_.emplace_back(damage.what());
  }
  ++loss_count_;
}

void MessageReader::leave_out(const std::string& what) {
  if (left_out_.size() < kShownLosses) {
    left_out_.push_back(what);
  }
}

void MessageReader::take_losses(MessageReader& other) {
  for (std::string& loss : other.losses_) {
    if (losses_.size() < kShownLosses) {
      losses_.push_back(std::move(loss));
    }
  }
  loss_count_ += std::exchange(other.loss_count_, 0);
  for (const auto& [topic, count] : std::exchange(other.passed_over_, {})) {
    passed_over_[topic] += count;
  }
  other.losses_.clear();
}

std::size_t MessageReader::add_topic(const Topic& topic, const std::string& file) {
  const auto [found, is_new] = index_by_name_.emplace(topic.name, topics_.size());
  if (is_new) {
    topics_.push_back(topic);
    count_definition(topic.definition.size(), file);
  } else if (topics_[found->second].type != topic.type) {
    throw InputError({.file = file, .field = topic.name},
                     "has two types, " + topics_[found->second].type + " and " + topic.type);
  }
  return found->second;
}

void MessageReader::count_definition(std::size_t cost, const std::string& file) {
  definitions_ += cost;
  if (definitions_ > kTuning.most_definitions) {
    throw InputError({.file = file}, fmt::format("defines its topics by more than {} MB",
                                                 kTuning.most_definitions / 1'000'000));
  }
}

}  // namespace kelpie::bag
