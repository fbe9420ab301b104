// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "bag/bag.hpp"
#include "bag/cdr.hpp"
#include "bag/column.hpp"

namespace kelpie::bag {

/// The layout of a topic's messages. Throws InputError (type) when there is no definition or they
/// aren't CDR.
MessageType cdr_type_of(const Topic& topic, const MessageDefinitions& definitions);

/// Decodes the message given last; what is wrong is handed to the bag with its place. Returns
/// whether the message was whole.
bool decode(BagReader& bag, const Message& message, const MessageType& type,
            NumberVisitor& visitor);

/// Puts header.stamp together from its two numbers.
class StampReader {
 public:
  StampReader() = default;
  explicit StampReader(const MessageType& type) : leaves_(stamp_of(type)) {}

  bool exists() const { return leaves_.has_value(); }
  bool wants(std::size_t leaf) const {
    return leaves_ && (leaf == leaves_->sec || leaf == leaves_->nanosec);
  }
  void number(std::size_t leaf, double value) {
    if (leaves_ && leaf == leaves_->sec) {
      sec_ = static_cast<std::int64_t>(value);
    } else if (leaves_ && leaf == leaves_->nanosec) {
      nanosec_ = static_cast<std::int64_t>(value);
    }
  }
  std::int64_t time_ns() const { return sec_ * kNanoseconds + nanosec_; }

 private:
  static constexpr std::int64_t kNanoseconds = 1'000'000'000;
  std::optional<StampLeaves> leaves_;
  std::int64_t sec_ = 0;
  std::int64_t nanosec_ = 0;
};

}  // namespace kelpie::bag
