// SPDX-License-Identifier: Apache-2.0
#include "mavlink/frame_parser.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <tuple>

#include "mavlink/frame_writer.hpp"
#include "mavlink/frames.hpp"
#include "support.hpp"

namespace kelpie::frame_parser_test {
namespace {

using testing::Bytes;
using testing::bytes_of_hex;
using testing::number_of;
using testing::text_of;

// Written by another implementation: scripts/mavlink_peer.mjs write.
const std::string kAttitude1 =
    "fe1c0307091ed20400000000003f00000000000000c0000000000000000000000000bf69";
const std::string kCommand1 =
    "fe210307094c00001042005043470000000000000000000000000000000000000000ff01010100a816";
const std::string kText1 =
    "fe36030709fd0468756c6c20746f75636865640000000000000000000000"
    "0000000000000000000000000000000000000000000000000000000000002fa5";
const std::string kAttitude2 = "fd1000000307091e0000d20400000000003f00000000000000c0b73b";
const std::string kCommand2 =
    "fd2000000307094c000000001042005043470000000000000000000000000000000000000000ff010101ef48";
const std::string kText2 = "fd0d0000030709fd00000468756c6c20746f75636865643a0a";
const std::string kSigned =
    "fd1001000407091e0000d20400000000003f00000000000000c0809a0100e06f9e75196223fbd406a2";

void append(Bytes& to, const Bytes& from) {
  to.insert(to.end(), from.begin(), from.end());
}

// One short message, as its sender's number `sequence`.
Bytes heartbeat(int sequence, std::uint8_t system = 1) {
  mavlink::FrameWriter writer(system);
  for (int k = 0; k < sequence; ++k) {
    writer.begin("HEARTBEAT").finish();
  }
  const auto frame = writer.begin("HEARTBEAT").set("custom_mode", 19.0).finish();
  return {frame.begin(), frame.end()};
}

TEST(FrameParser, ReadsWhatAnotherImplementationWroteInBothVersions) {
  for (const auto& [attitude, command, text, version] :
       {std::tuple(kAttitude1, kCommand1, kText1, 1),
        std::tuple(kAttitude2, kCommand2, kText2, 2)}) {
    mavlink::FrameParser parser;
    mavlink::Frame frame;
    parser.add(bytes_of_hex(attitude + command));
    ASSERT_TRUE(parser.next(frame));
    EXPECT_EQ(frame.definition->name, "ATTITUDE");
    EXPECT_EQ(frame.version, version);
    EXPECT_EQ(frame.system, 7);
    EXPECT_EQ(frame.component, 9);
    EXPECT_EQ(frame.sequence, 3);
    EXPECT_EQ(number_of(frame, "time_boot_ms"), 1234);
    EXPECT_EQ(number_of(frame, "roll"), 0.5);
    EXPECT_EQ(number_of(frame, "yaw"), -2);
    EXPECT_EQ(number_of(frame, "yawspeed"), 0);  // in version 2 not sent
    ASSERT_TRUE(parser.next(frame));
    EXPECT_EQ(number_of(frame, "command"), 511);
    EXPECT_EQ(number_of(frame, "param2"), 50'000);
    EXPECT_EQ(number_of(frame, "target_component"), 1);
    EXPECT_FALSE(parser.next(frame));
    EXPECT_EQ(frame.definition, nullptr);
    parser.add(bytes_of_hex(text));
    ASSERT_TRUE(parser.next(frame));  // with extensions, which some send in version 1 as well
    EXPECT_EQ(text_of(frame, "text"), "hull touched");
    EXPECT_EQ(number_of(frame, "severity"), 4);
  }
}

TEST(FrameParser, ASignatureIsPassedOver) {
  mavlink::FrameParser parser;
  mavlink::Frame frame;
  parser.add(bytes_of_hex(kSigned + kAttitude2));
  ASSERT_TRUE(parser.next(frame));
  EXPECT_TRUE(frame.is_signed);
  EXPECT_EQ(number_of(frame, "roll"), 0.5);
  ASSERT_TRUE(parser.next(frame));
  EXPECT_FALSE(frame.is_signed);
  EXPECT_EQ(parser.counts().skipped_bytes, 0U);
}

TEST(FrameParser, FramesMayComeInAnyPieces) {
  const Bytes all = bytes_of_hex(kAttitude2 + kSigned + kCommand1 + kText2);
  for (std::size_t piece = 1; piece < 40; ++piece) {
    mavlink::FrameParser parser;
    mavlink::Frame frame;
    for (std::size_t at = 0; at < all.size(); at += piece) {
      parser.add(std::span(all).subspan(at, std::min(piece, all.size() - at)));
      while (parser.next(frame)) {
      }
    }
    EXPECT_EQ(parser.counts().frames, 4U) << piece;
    EXPECT_EQ(parser.counts().skipped_bytes, 0U) << piece;
  }
}

TEST(FrameParser, DamageCostsNoMoreThanTheFrameItIsIn) {
  const Bytes good = bytes_of_hex(kAttitude2);
  for (std::size_t at = 0; at < good.size(); ++at) {
    for (const unsigned flip : {0x01U, 0x80U, 0xFFU}) {
      Bytes bytes = good;
      bytes[at] ^= static_cast<std::byte>(flip);
      for (int k = 0; k < 12; ++k) {  // a length that was damaged may reach so far
        append(bytes, good);
      }
      mavlink::FrameParser parser;
      mavlink::Frame frame;
      parser.add(bytes);
      std::size_t frames = 0;
      while (parser.next(frame)) {
        EXPECT_EQ(number_of(frame, "roll"), 0.5);
        ++frames;
      }
      EXPECT_EQ(frames, 12U) << at << " " << flip;
    }
  }
}

TEST(FrameParser, NoiseBetweenFramesIsSkipped) {
  std::mt19937 random(18);
  mavlink::FrameParser parser;
  mavlink::Frame frame;
  std::size_t found = 0;
  constexpr std::size_t kSent = 400;
  for (std::size_t k = 0; k < kSent; ++k) {
    Bytes bytes(random() % 40);
    // Without the magic bytes, which are the next test's.
    std::ranges::generate(bytes, [&] { return static_cast<std::byte>(random() % 0xFD); });
    append(bytes, bytes_of_hex(k % 2 == 0 ? kAttitude1 : kAttitude2));
    parser.add(bytes);
    while (parser.next(frame)) {
      ++found;
    }
  }
  EXPECT_EQ(found, kSent);
  EXPECT_GT(parser.counts().skipped_bytes, kSent);
  EXPECT_EQ(parser.counts().bad_checksum, 0U);
}

TEST(FrameParser, AnyBytesEndInCounts) {
  std::mt19937 random(19);
  mavlink::FrameParser parser;
  mavlink::Frame frame;
  for (int k = 0; k < 2'000; ++k) {
    Bytes bytes(random() % 300);
    std::ranges::generate(bytes, [&] {
      const auto value = static_cast<unsigned>(random());
      return static_cast<std::byte>(value % 8 == 0 ? 0xFDU + value / 8 % 2 : value % 256);
    });
    parser.add(bytes);
    while (parser.next(frame)) {
      EXPECT_LE(frame.payload.size(), frame.definition->all_bytes);
    }
  }
  EXPECT_GT(parser.counts().bad_checksum + parser.counts().unknown, 0U);
}

TEST(FrameParser, MissingMessagesAreCountedForEverySystemAlone) {
  mavlink::FrameParser parser;
  mavlink::Frame frame;
  for (const auto& [sequence, system] :
       {std::pair(250, 1), std::pair(3, 2), std::pair(251, 1), std::pair(4, 2), std::pair(1, 1),
        std::pair(4, 2), std::pair(7, 2), std::pair(0, 2)}) {
    parser.add(heartbeat(sequence, static_cast<std::uint8_t>(system)));
    ASSERT_TRUE(parser.next(frame));
  }
  // Of the first 252 to 255 and 0, of the second 5 and 6; twice and from anew are no loss.
  EXPECT_EQ(parser.counts().lost, 5U + 2U);
}

TEST(FrameParser, UnknownMessagesOtherDefinitionsAndLaterVersionsArePassedOver) {
  mavlink::FrameParser parser;
  mavlink::Frame frame;
  Bytes bytes = testing::other_frame(29'999, 7, 0);
  append(bytes, testing::other_frame(30, 40, 1));  // ATTITUDE's byte is 39
  append(bytes, testing::other_frame(30, 39, 2, 2));
  append(bytes, heartbeat(3));
  parser.add(bytes);
  ASSERT_TRUE(parser.next(frame));
  EXPECT_EQ(frame.sequence, 3);
  EXPECT_EQ(parser.counts().unknown, 2U);
  EXPECT_EQ(parser.counts().bad_checksum, 1U);  // the other definition
  EXPECT_EQ(parser.counts().lost, 1U);
  EXPECT_EQ(parser.counts().skipped_bytes, 15U);
}

// Datagrams whose every byte, or every sixth or tenth, begins what may be a frame.
TEST(FrameParser, RubbishHidesNoFrame) {
  const auto random = [] {
    std::mt19937 noise(20);
    std::string text;
    while (text.size() < 6'000) {
      text += noise() % 2 == 0 ? "fd" : "fe";
    }
    return text;
  }();
  for (const std::string& pattern :
       {std::string("fd"), std::string("fe"), std::string("feff00000083"),
        std::string("fdff0000000000000000"), std::string("fdfd0000000000830000"), random}) {
    Bytes rubbish;
    while (rubbish.size() < 65'000) {
      append(rubbish, bytes_of_hex(pattern));
    }
    mavlink::FrameParser parser;
    mavlink::Frame frame;
    for (int k = 0; k < 3; ++k) {
      parser.add(rubbish);
      while (parser.next(frame)) {
      }
    }
    const std::uint64_t by_chance = parser.counts().frames;  // of a checksum of 16 bits
    EXPECT_LT(by_chance, rubbish.size() / 500) << pattern.substr(0, 20);
    for (int k = 0; k < 12; ++k) {  // what looked like the begin of a frame may reach so far
      parser.add(bytes_of_hex(kAttitude2));
      while (parser.next(frame)) {
      }
    }
    EXPECT_EQ(parser.counts().frames - by_chance, 12U) << pattern.substr(0, 20);
  }
}

// What is in the frames is asserted in tests/logs/bag/tlog_reader_test.cpp.
TEST(FrameParser, ARealLogIsMadeOfFrames) {
  const std::filesystem::path file = testing::data_file("logs/ardusub_small.tlog");
  if (file.empty()) {
    GTEST_SKIP() << "the log isn't there";
  }
  std::ifstream stream(file, std::ios::binary);
  const std::vector<char> log(std::istreambuf_iterator<char>(stream), {});
  mavlink::FrameParser parser;
  mavlink::Frame frame;
  constexpr std::size_t kStamp = 8;  // before every frame
  for (std::size_t at = kStamp; at < log.size();) {
    const bool second = static_cast<unsigned char>(log[at]) == 0xFD;
    const std::size_t size = (second ? 12U : 8U) + static_cast<unsigned char>(log[at + 1]) +
                             (second && (log[at + 2] & 1) != 0 ? 13U : 0U);
    parser.add(std::as_bytes(std::span(log).subspan(at, size)));
    while (parser.next(frame)) {
    }
    at += size + kStamp;
  }
  EXPECT_EQ(parser.counts().frames, 35'912U);
  // A camera's four, whose checksums are wrong for the other implementation as well.
  EXPECT_EQ(parser.counts().bad_checksum, 4U);
  EXPECT_EQ(parser.counts().skipped_bytes, 279U);
}

}  // namespace
}  // namespace kelpie::frame_parser_test
