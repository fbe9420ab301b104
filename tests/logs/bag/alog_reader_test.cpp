// SPDX-License-Identifier: Apache-2.0
#include "bag/alog_reader.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bag/bags.hpp"
#include "bag/hash.hpp"
#include "bag/inspect.hpp"
#include "bag/mcap_writer.hpp"
#include "bag/open_bag.hpp"
#include "bag/series.hpp"
#include "support.hpp"
#include "wire/scalar.hpp"

namespace kelpie::alog_reader_test {
namespace {

using bag::ReadMode;

constexpr const char* kHead =
    "%%%%%%%%\n%% LOG FILE:  x.alog\n%% FILE OPENED ON  Mon Jun  2 01:38:39 2008\n"
    "%% LOGSTART                1000.5\n%%%%%%%%\n";

std::unique_ptr<bag::MessageReader> open(const std::string& text,
                                         ReadMode mode = ReadMode::strict) {
  return bag::read_alog(testing::as_bytes(text), "x.alog", mode);
}

bag::BagReport report_of(const std::string& text, ReadMode mode = ReadMode::strict) {
  return bag::inspect_bag(*open(text, mode), bag::MessageDefinitions());
}

std::string refusal(const std::string& text) {
  return testing::message_of<InputError>([&] { report_of(text); });
}

// The text of a message of text.
std::string text_of(const bag::Message& message) {
  const auto length = wire::number_at<std::uint32_t>(message.data, std::endian::little);
  const auto bytes = message.data.subspan(4, length);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};  // NOLINT: bytes as text
}

TEST(AlogReader, VariablesAreTopicsWhoeverWroteThem) {
  const std::string text = std::string(kHead) +
                           "0.25  NAV_X  pNav   1.5  \r\n"
                           "% a comment\n\n"
                           "0.750 NAV_X  pOther:1  -2e1\n"
                           "0.5   NAV_X  pNav   unknown\n"
                           "0.5   MODE   pHelm  1\n"
                           "0.6   MODE   pHelm  DRIVE all the way\n"
                           "0.7   MODE   pHelm\n";
  const auto bag = open(text);
  const std::vector<bag::Series> series =
      bag::read_series(*bag, bag::MessageDefinitions(), std::vector<std::string>{"NAV_X:value"},
                       bag::Clock::receive);
  EXPECT_EQ(series[0].times_ns,
            (std::vector<std::int64_t>{1'000'750'000'000, 1'001'000'000'000, 1'001'250'000'000}));
  EXPECT_EQ(series[0].values[0][0], 1.5);
  EXPECT_TRUE(std::isnan(series[0].values[0][1]));
  EXPECT_EQ(series[0].values[0][2], -20.0);
  const auto report = report_of(text);
  ASSERT_EQ(report.topics.size(), 2U);
  EXPECT_EQ(report.topics[0].name, "MODE");
  EXPECT_EQ(report.topics[0].type, "moos/Text");
  EXPECT_EQ(report.topics[0].messages, 3U);
  EXPECT_EQ(report.topics[1].type, "moos/Number");
  EXPECT_THROW(bag::read_series(*open(text), bag::MessageDefinitions(),
                                std::vector<std::string>{"MODE:value"}, bag::Clock::receive),
               InputError);
}

TEST(AlogReader, ATextMayGoOnInTheLinesThatFollow) {
  const std::string text =
      std::string(kHead) +
      "1 WARNING pApp  first\n  second line \n\nthird\n\n"
      "2 WARNING pApp <MOOS_BINARY>File=a.blog,Offset=0,Bytes=9</MOOS_BINARY>\n";
  const auto bag = open(text);
  bag::Message message;
  ASSERT_TRUE(bag->next(message));
  EXPECT_EQ(text_of(message), "first\n  second line \n\nthird");
  ASSERT_TRUE(bag->next(message));
  EXPECT_EQ(text_of(message), "<MOOS_BINARY>File=a.blog,Offset=0,Bytes=9</MOOS_BINARY>");
  EXPECT_FALSE(bag->next(message));
}

TEST(AlogReader, WhatIsNoLineIsNamedAndLeftOut) {
  const std::string text = std::string(kHead) +
                           "1 NAV_X pNav 1\nrubbish\n2 NAV_X\n1e300 NAV_X pNav 1\n\1\2 NAV_X a 1\n"
                           "3 NAV_X pNav 3\n4 NAV_X pNav 12.3";
  EXPECT_NE(refusal(text).find("x.alog:7: is no line"), std::string::npos) << refusal(text);
  const auto report = report_of(text, ReadMode::recover);
  EXPECT_EQ(report.messages, 2U);
  EXPECT_EQ(report.loss_count, 5U);
  EXPECT_NE(report.losses.back().find("x.alog:12: the file is cut off"), std::string::npos)
      << report.losses.back();
  EXPECT_NE(refusal("%% LOGSTART soon\n").find("LOGSTART"), std::string::npos);
}

TEST(AlogReader, IsRecognisedByItsContentAndKeptAsMcap) {
  const testing::TemporaryFolder folder;
  const std::string text = std::string(kHead) + "1 A pA 1.5\n2 B pB on\n";
  testing::write_text(folder / "a.txt", text);
  EXPECT_TRUE(bag::is_bag(folder / "a.txt"));
  EXPECT_FALSE(bag::begins_as_alog("% a comment\nt,u\n1,2\n"));
  const auto bag = bag::open_bag(folder / "a.txt");
  const std::string copy = bag::copy_to_mcap(*bag, bag::MessageDefinitions()).content;
  const auto back = bag::read_mcap(testing::as_bytes(copy), "x.mcap", ReadMode::strict);
  EXPECT_EQ(testing::hashes_of(*back), testing::hashes_of(*open(text)));
}

TEST(AlogReader, AnyBytesEndInMessagesOrAnInputError) {
  std::mt19937 random(19);
  const std::string good =
      std::string(kHead) + "1 A pA 1.5\n2 B pB on\nand on\n3 A pA 2\n4 B pB off\n";
  for (int round = 0; round < 2'000; ++round) {
    std::string text = good;
    for (int k = 0; k < 5; ++k) {
      text[random() % text.size()] = static_cast<char>(random() % 256);
    }
    text.resize(text.size() - random() % 20);
    EXPECT_LE(report_of(text, ReadMode::recover).messages, 5U);
  }
}

// Counted by awk.
TEST(AlogReader, ARealLogIsReadWhole) {
  const std::filesystem::path file = testing::data_file("logs/moos_test.alog");
  if (file.empty()) {
    GTEST_SKIP() << "the log isn't there";
  }
  const auto report = bag::inspect_bag(*bag::open_bag(file), bag::MessageDefinitions());
  EXPECT_EQ(report.messages, 124U);
  const std::vector<std::pair<std::string, std::size_t>> expected{
      {"DESIRED_RUDDER", 4}, {"DESIRED_THRUST", 3}, {"MOOS_DEBUG", 12},
      {"NAV_X", 52},         {"NAV_Y", 52},         {"THIS_IS_A_REALLY_LONG_VARIABLE_OK", 1}};
  ASSERT_EQ(report.topics.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_EQ(report.topics[k].name, expected[k].first);
    EXPECT_EQ(report.topics[k].messages, expected[k].second);
    EXPECT_EQ(report.topics[k].type, k == 2 ? "moos/Text" : "moos/Number");
  }
  EXPECT_EQ(report.start_ns, 1'212'385'119'125'000'000);
}

}  // namespace
}  // namespace kelpie::alog_reader_test
