// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bag/bags.hpp"
#include "bag/hash.hpp"
#include "bag/inspect.hpp"
#include "bag/mcap_reader.hpp"
#include "bag/mcap_writer.hpp"
#include "bag/open_bag.hpp"
#include "bag/packed_bytes.hpp"
#include "bag/series.hpp"
#include "support.hpp"

namespace kelpie::testing {

/// A reader of one kind of file, for bytes.
class BytesReader {
 public:
  using Read = std::unique_ptr<bag::MessageReader> (*)(std::span<const std::byte>,
                                                       const std::string&, bag::ReadMode);

  /// `name` is what messages call the file.
  BytesReader(Read read, std::string name) : read_(read), name_(std::move(name)) {}

  std::vector<bag::Series> series_of(const PackedBytes& log,
                                     const std::vector<std::string>& columns,
                                     bag::Clock clock = bag::Clock::receive,
                                     bag::ReadMode mode = bag::ReadMode::strict) const {
    const auto bag = read_(log.bytes(), name_, mode);
    return bag::read_series(*bag, bag::MessageDefinitions(), columns, clock);
  }

  bag::BagReport report_of(const std::vector<std::byte>& bytes,
                           bag::ReadMode mode = bag::ReadMode::recover) const {
    const auto bag = read_(bytes, name_, mode);
    return bag::inspect_bag(*bag, bag::MessageDefinitions());
  }

  /// Why bytes are refused.
  std::string refusal(const std::vector<std::byte>& bytes) const {
    return message_of<InputError>([&] { report_of(bytes, bag::ReadMode::strict); });
  }

  /// A copy of the messages as MCAP holds the same numbers.
  void expect_same_as_mcap(const PackedBytes& log) const {
    const auto bag = read_(log.bytes(), name_, bag::ReadMode::strict);
    bag::McapWriter writer;
    std::size_t known = 0;
    for (bag::Message next; bag->next(next); writer.write(next)) {
      for (; known < bag->topics().size(); ++known) {
        writer.add_topic(bag->topics()[known]);
      }
    }
    const std::string copy = writer.finish();
    const auto original = read_(log.bytes(), name_, bag::ReadMode::strict);
    const auto read = bag::read_mcap(as_bytes(copy), "x.mcap", bag::ReadMode::strict);
    EXPECT_EQ(hash_sums_of(*read), hash_sums_of(*original));
  }

  /// Files of this content are recognised, whatever their name, and have so many messages.
  // NOLINTNEXTLINE(readability-convert-member-functions-to-static): used like the others
  void expect_recognised(const PackedBytes& log, std::size_t messages) const {
    const TemporaryFolder folder;
    write_text(folder / "a.bin", log.text());
    EXPECT_TRUE(bag::is_bag(folder / "a.bin"));
    const auto bag = bag::open_bag(folder / "a.bin");
    EXPECT_EQ(bag::inspect_bag(*bag, bag::MessageDefinitions()).messages, messages);
  }

  /// Damage of a byte of a message, `within` bytes behind `offset`, is named; the rest is read.
  void expect_damage_costs_one(const PackedBytes& log, std::size_t offset,
                               std::initializer_list<std::size_t> within,
                               std::size_t messages_left) const {
    for (const std::size_t at : within) {
      std::vector<std::byte> bytes = log.bytes();
      bytes[offset + at] ^= std::byte{0x55};
      const std::string message = refusal(bytes);
      EXPECT_NE(message.find(name_ + ": offset " + std::to_string(offset)), std::string::npos)
          << at << " " << message;
      const bag::BagReport report = report_of(bytes);
      EXPECT_EQ(report.messages, messages_left) << at;
      EXPECT_EQ(report.loss_count, 1U) << at;
    }
  }

  /// Whatever bytes are changed, reading ends in messages or an InputError.
  void expect_any_bytes_end(const PackedBytes& log) const {
    std::mt19937 random(19);
    for (int round = 0; round < 3'000; ++round) {
      std::vector<std::byte> bytes = log.bytes();
      for (int k = 0; k < 6; ++k) {
        bytes[random() % bytes.size()] = static_cast<std::byte>(random() % 256);
      }
      report_of(bytes);
      refusal(bytes);
    }
  }

 private:
  Read read_;
  std::string name_;
};

}  // namespace kelpie::testing
