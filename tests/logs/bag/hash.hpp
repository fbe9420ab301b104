// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bag/decoding.hpp"

namespace kelpie::testing {

/// FNV-1a over the bytes of all numbers, as doubles; what isn't a number counts as 0.
class Hash final : public bag::NumberVisitor {
 public:
  bool wants(std::size_t /*leaf*/) const override { return true; }
  void number(std::size_t /*leaf*/, std::span<const std::uint32_t> /*indices*/,
              double value) override {
    add(value);
  }
  void add(double value) {
    auto bits = std::bit_cast<std::uint64_t>(std::isnan(value) ? 0.0 : value);
    for (int k = 0; k < 8; ++k, bits >>= 8U) {
      state = (state ^ static_cast<std::uint32_t>(bits & 0xFFU)) * 0x01000193U;
    }
  }

  std::uint32_t state = 0x811C9DC5U;
};

/// A topic's messages, a hash of all their values, and one of their times as seconds and
/// nanoseconds.
struct TopicHash {
  int messages = 0;
  std::uint32_t values = 0;
  std::uint32_t times = 0;

  bool operator==(const TopicHash&) const = default;
};

/// Shows every message of a bag with its topic's name and decoder: show(name, decoder, message).
template <typename Show>
void show_messages(bag::MessageReader& bag, const Show& show) {
  std::vector<bag::Decoder> decoders;
  for (bag::Message message; bag.next(message);) {
    for (std::size_t k = decoders.size(); k < bag.topics().size(); ++k) {
      decoders.emplace_back(bag.topics()[k], bag::MessageDefinitions());
    }
    show(bag.topics()[message.topic].name, decoders[message.topic], message);
  }
}

/// Those of all topics of a bag, in the order in which it tells them.
inline std::map<std::string, TopicHash> hashes_of(bag::MessageReader& bag) {
  std::map<std::string, Hash> values;
  std::map<std::string, Hash> times;
  std::map<std::string, TopicHash> found;
  show_messages(
      bag, [&](const std::string& name, const bag::Decoder& decoder, const bag::Message& message) {
        decoder.visit(message.data, values[name]);
        const std::int64_t whole_s = message.receive_ns / 1'000'000'000;
        times[name].add(static_cast<double>(whole_s));
        times[name].add(static_cast<double>(message.receive_ns % 1'000'000'000));
        ++found[name].messages;
        found[name].values = values[name].state;
        found[name].times = times[name].state;
      });
  return found;
}

/// Of every topic its messages and the sum of their hashes, which doesn't go by their order.
using HashSums = std::map<std::string, std::pair<int, std::uint32_t>>;

inline HashSums hash_sums_of(bag::MessageReader& bag) {
  HashSums found;
  show_messages(
      bag, [&](const std::string& name, const bag::Decoder& decoder, const bag::Message& message) {
        Hash hash;
        decoder.visit(message.data, hash);
        auto& [count, sum] = found[name];
        ++count;
        sum += hash.state;
      });
  return found;
}

}  // namespace kelpie::testing
