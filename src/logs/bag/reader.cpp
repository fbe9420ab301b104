// SPDX-License-Identifier: Apache-2.0
#include "bag/reader.hpp"

namespace kelpie::bag {

bool MessageReader::next(Message& message) {
  while (!at_end()) {
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
  std::string text;
  for (const std::string& loss : losses_) {
    text += "lost: " + loss + "\n";
  }
  if (loss_count_ > losses_.size()) {
    text += "lost: " + std::to_string(loss_count_ - losses_.size()) + " more\n";
  }
  return text;
}

void MessageReader::lose(const InputError& damage) {
  if (mode_ == ReadMode::strict) {
    throw damage;  // NOLINT(cert-err60-cpp): a copy of texts fails only without memory
  }
  if (losses_.size() < kShownLosses) {
    losses_.emplace_back(damage.what());
  }
  ++loss_count_;
}

void MessageReader::take_losses(MessageReader& other) {
  for (std::string& loss : other.losses_) {
    if (losses_.size() < kShownLosses) {
      losses_.push_back(std::move(loss));
    }
  }
  loss_count_ += std::exchange(other.loss_count_, 0);
  other.losses_.clear();
}

std::size_t MessageReader::add_topic(const Topic& topic, const std::string& file) {
  const auto [found, is_new] = index_by_name_.emplace(topic.name, topics_.size());
  if (is_new) {
    topics_.push_back(topic);
  } else if (topics_[found->second].type != topic.type) {
    throw InputError({.file = file, .field = topic.name},
                     "has two types, " + topics_[found->second].type + " and " + topic.type);
  }
  return found->second;
}

}  // namespace kelpie::bag
