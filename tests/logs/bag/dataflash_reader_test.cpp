// SPDX-License-Identifier: Apache-2.0
#include "bag/dataflash_reader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "bag/bags.hpp"
#include "bag/hash.hpp"
#include "bag/inspect.hpp"
#include "bag/open_bag.hpp"
#include "bag/packed_bytes.hpp"
#include "bag/read_bytes.hpp"
#include "bag/series.hpp"
#include "support.hpp"

namespace kelpie::dataflash_reader_test {
namespace {

using bag::ReadMode;
using testing::PackedBytes;

PackedBytes message(std::uint8_t number) {
  return PackedBytes().add(std::uint8_t{0xA3}).add(std::uint8_t{0x95}).add(number);
}

PackedBytes fmt(std::uint8_t number, std::uint8_t bytes, std::string_view name,
                std::string_view letters, std::string_view columns) {
  return message(128).add(number).add(bytes).add(name, 4).add(letters, 16).add(columns, 64);
}

PackedBytes fmtu(std::uint8_t number, std::string_view units, std::string_view factors) {
  return message(3).add(std::uint64_t{0}).add(number).add(units, 16).add(factors, 16);
}

PackedBytes definitions() {
  PackedBytes log = fmt(128, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns");
  log.add(fmt(1, 76, "UNIT", "QbZ", "TimeUS,Id,Label"));
  log.add(fmt(2, 20, "MULT", "Qbd", "TimeUS,Id,Mult"));
  log.add(fmt(3, 44, "FMTU", "QBNN", "TimeUS,FmtType,UnitIds,MultIds"));
  log.add(fmt(10, 27, "ATT", "QcCeEL", "TimeUS,Roll,Yaw,Alt,Far,Lat"));
  log.add(fmt(11, 20, "IMU", "QBfhh", "TimeUS,I,Gyr,Acc,T"));
  for (const auto& [id, label] : {std::pair('s', "s"), std::pair('d', "deg"), std::pair('m', "m"),
                                  std::pair('D', "deglatitude"), std::pair('#', "instance"),
                                  std::pair('k', "deg/s"), std::pair('?', "UNKNOWN")}) {
    log.add(message(1).add(std::uint64_t{0}).add(id).add(label, 64));
  }
  for (const auto& [id, factor] :
       {std::pair('F', 1e-6), std::pair('B', 0.01), std::pair('G', 1e-7), std::pair('C', 0.001),
        std::pair('-', 0.0), std::pair('?', 1.0)}) {
    log.add(message(2).add(std::uint64_t{0}).add(id).add(factor));
  }
  return log.add(fmtu(10, "sddmmD", "FBBBBG")).add(fmtu(11, "s#k-?", "F-C-?"));
}

PackedBytes att(std::uint64_t time_us, std::int16_t roll) {
  return message(10)
      .add(time_us)
      .add(roll)
      .add(std::uint16_t{9'000})
      .add(std::int32_t{-250})
      .add(std::uint32_t{123})
      .add(std::int32_t{-351'332'423});
}

PackedBytes imu(std::uint64_t time_us, std::uint8_t instance, float rate) {
  return message(11)
      .add(time_us)
      .add(instance)
      .add(rate)
      .add(std::int16_t{-7})
      .add(std::int16_t{3});
}

PackedBytes small_log(std::uint64_t count) {
  PackedBytes log = definitions();
  for (std::uint64_t k = 0; k < count; ++k) {
    const std::uint64_t time_us = 1'000'000 + 100'000 * k;
    log.add(att(time_us, static_cast<std::int16_t>(100 * k)));
    log.add(imu(time_us + 10, static_cast<std::uint8_t>(k % 2), 500.0F));
  }
  return log;
}

const testing::BytesReader reader(bag::read_dataflash, "x.BIN");

// MULT says of c, C, e, E and L again what the letters say.
TEST(DataflashReader, FactorsAreAppliedOnce) {
  const std::vector<bag::Series> series = reader.series_of(
      small_log(2), {"ATT:Roll", "ATT:Yaw", "ATT:Alt", "ATT:Far", "ATT:Lat", "ATT:TimeUS",
                     "IMU[0]:Gyr", "IMU[0]:Acc", "IMU[0]:T", "IMU[1]:Gyr"});
  ASSERT_EQ(series.size(), 3U);
  const std::vector<double> expected{1.0, 90.0, -2.5, 1.23, -35.1332423, 1'100'000.0};
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_DOUBLE_EQ(series[0].values[k][1], expected[k]) << k;
  }
  EXPECT_EQ(series[0].times_ns, (std::vector<std::int64_t>{1'000'000'000, 1'100'000'000}));
  EXPECT_EQ(series[1].values, (std::vector<std::vector<double>>{{0.5}, {-7.0}, {3.0}}));
  EXPECT_EQ(series[2].times_ns, (std::vector<std::int64_t>{1'100'010'000}));
}

TEST(DataflashReader, UnitsAreThoseOfTheNumbers) {
  const bag::BagReport report = reader.report_of(small_log(2).bytes(), ReadMode::strict);
  ASSERT_EQ(report.topics.size(), 3U);
  std::vector<std::string> units;
  for (const bag::FieldRange& field : report.topics[0].fields) {
    units.push_back(field.path + " " + field.unit);
  }
  EXPECT_EQ(units, (std::vector<std::string>{"TimeUS us", "Roll deg", "Yaw deg", "Alt m", "Far m",
                                             "Lat deg"}));
  EXPECT_EQ(report.topics[1].name, "IMU[0]");
  EXPECT_EQ(report.topics[1].fields[1].unit, "");  // the instance
  EXPECT_EQ(report.topics[1].fields[2].unit, "deg/s");
  EXPECT_EQ(report.topics[1].fields[4].unit, "");  // unknown
}

TEST(DataflashReader, AFixOfTheGpsTellsTheDate) {
  PackedBytes log = small_log(2);
  log.add(fmt(20, 18, "GPS", "QBIH", "TimeUS,Status,GMS,GWk"));
  const auto gps = [](std::uint64_t time_us, std::uint8_t status, std::uint32_t ms) {
    return message(20).add(time_us).add(status).add(ms).add(std::uint16_t{2'260});
  };
  log.add(gps(1'400'000, 1, 17)).add(gps(2'000'000, 3, 259'218'000));
  // Week 2260 began on 30 April 2023; 3 days and 18 s of GPS's time later it is 3 May, 0 h UTC.
  const std::int64_t begin_ns = (1'683'072'000LL - 2) * 1'000'000'000;
  EXPECT_EQ(reader.series_of(log, {"ATT:Roll"})[0].times_ns[0], begin_ns + 1'000'000'000);
  EXPECT_EQ(reader.series_of(log, {"ATT:Roll"}, bag::Clock::header)[0].times_ns[0], 1'000'000'000);
}

TEST(DataflashReader, ArraysHalvesAndTextsAreRead) {
  PackedBytes log = definitions();
  log.add(fmt(30, 170, "ODD", "aNgnZBqd", "Acc,Text,G,N,Z,B,Q,D"));
  PackedBytes odd = message(30);
  for (std::int16_t k = 0; k < 32; ++k) {
    odd.add(static_cast<std::int16_t>(-k));
  }
  odd.add("text", 16).add(std::uint16_t{0xC100}).add("ab", 4).add("\xFF\xFE", 64);
  log.add(odd.add(std::uint8_t{200}).add(std::int64_t{-9}).add(0.1));
  const std::vector<bag::Series> series =
      reader.series_of(log, {"ODD:Acc[31]", "ODD:G", "ODD:B", "ODD:Q", "ODD:D"});
  EXPECT_EQ(series[0].values,
            (std::vector<std::vector<double>>{{-31.0}, {-2.5}, {200.0}, {-9.0}, {0.1}}));
  EXPECT_THROW(reader.series_of(log, {"ODD:Text"}), InputError);
}

TEST(DataflashReader, IsRecognisedByItsContent) {
  reader.expect_recognised(small_log(3), 6);
  const testing::TemporaryFolder folder;
  testing::write_text(folder / "b.log", "FMT, 128, 89, FMT, BBnNZ, Type,Length,Name\n");
  EXPECT_NE(testing::message_of<InputError>([&] {
              bag::open_bag(folder / "b.log");
            }).find("is a DataFlash log as text"),
            std::string::npos);
}

TEST(DataflashReader, ACopyAsMcapReadsTheSame) {
  reader.expect_same_as_mcap(small_log(5));
}

TEST(DataflashReader, DamageIsNamedWithItsOffsetAndRecoverReadsTheRest) {
  const std::size_t head = definitions().size();
  const std::size_t step = att(0, 0).size() + imu(0, 0, 0.0F).size();
  const std::size_t offset = head + 3 * step;  // an ATT
  reader.expect_damage_costs_one(small_log(8), offset, {0, 1, 2}, 15);
}

TEST(DataflashReader, AFileCutOffAnywhereIsNamedAndReadUpToThere) {
  const PackedBytes good = small_log(2);
  const std::size_t head = definitions().size();
  const std::size_t first = head + att(0, 0).size();
  for (std::size_t size = 1; size < good.size(); ++size) {
    const std::vector<std::byte> bytes(good.bytes().begin(),
                                       good.bytes().begin() + static_cast<std::ptrdiff_t>(size));
    const bag::BagReport report = reader.report_of(bytes);
    EXPECT_EQ(reader.refusal(bytes).empty(), report.loss_count == 0) << size;
    if (size > head && size < first) {
      EXPECT_EQ(report.loss_count, 1U) << size;
      EXPECT_NE(reader.refusal(bytes).find("offset " + std::to_string(head)), std::string::npos);
    }
    EXPECT_EQ(report.messages, size < first ? 0U : report.messages) << size;
  }
}

TEST(DataflashReader, DefinitionsThatCannotBeAreNamed) {
  const PackedBytes good = definitions();
  const auto refusal_with = [&](const PackedBytes& more) {
    return reader.refusal(PackedBytes(good).add(more).bytes());
  };
  const std::string offset = "offset " + std::to_string(good.size());
  for (const PackedBytes& more :
       {fmt(40, 3, "NIL", "", ""), fmt(40, 20, "", "Q", "TimeUS"), fmt(40, 11, "A\xFF", "Q", "T"),
        fmt(128, 90, "FMT", "BBnNZ", "Type"), fmt(10, 27, "ATT", "QcCeeL", "TimeUS,R,Y,A,F,L"),
        message(99)}) {
    EXPECT_NE(refusal_with(more).find(offset), std::string::npos) << refusal_with(more);
  }
  // The same once more is what a second start of the log writes.
  EXPECT_EQ(refusal_with(fmt(11, 20, "IMU", "QBfhh", "TimeUS,I,Gyr,Acc,T")), "");
}

TEST(DataflashReader, WhatHasAnotherSizeOrAnUnknownFormatCannotBeDecoded) {
  PackedBytes log = definitions();
  log.add(fmt(40, 12, "NEW", "Qy", "TimeUS,X")).add(fmt(41, 12, "LIE", "Qff", "TimeUS,X,Y"));
  log.add(message(40).add(std::uint64_t{1}).add(std::uint8_t{1}));
  log.add(message(41).add(std::uint64_t{2}).add(std::uint8_t{1})).add(att(3, 100));
  const bag::BagReport report = reader.report_of(log.bytes());
  ASSERT_EQ(report.topics.size(), 3U);
  EXPECT_NE(report.topics[2].not_decoded.find("isn't known"), std::string::npos);
  EXPECT_EQ(report.loss_count, 1U);  // LIE
  EXPECT_EQ(report.messages, 3U);
}

TEST(DataflashReader, ASecondLogInTheSameFileComesAfterTheFirst) {
  const PackedBytes first = small_log(3);
  const PackedBytes both = PackedBytes(first).add(first);
  EXPECT_NE(reader.refusal(both.bytes())
                .find("offset " + std::to_string(first.size() + definitions().size()) +
                      ": a second log begins"),
            std::string::npos)
      << reader.refusal(both.bytes());
  const std::vector<bag::Series> series =
      reader.series_of(both, {"ATT:Roll"}, bag::Clock::receive, ReadMode::recover);
  ASSERT_EQ(series[0].times_ns.size(), 6U);
  EXPECT_EQ(series[0].steps_back, 0U);
  EXPECT_EQ(series[0].times_ns[3] - series[0].times_ns[2], 60'000'010'000);
}

TEST(DataflashReader, ATimeThatCannotBeIsLost) {
  PackedBytes log = small_log(1);
  const std::string offset = "offset " + std::to_string(log.size());
  log.add(att(std::uint64_t{1} << 63U, 0)).add(att(1'500'000, 0));
  EXPECT_NE(reader.refusal(log.bytes()).find(offset), std::string::npos);
  EXPECT_EQ(reader.report_of(log.bytes()).messages, 3U);
}

TEST(DataflashReader, AnyBytesEndInMessagesOrAnInputError) {
  reader.expect_any_bytes_end(small_log(10));
}

// Of a few lines of Python (struct) after ArduPilot's description: messages, and the sum of the
// hashes of all values in their units.
TEST(DataflashReader, EveryValueOfARealLogIsWhatAnotherImplementationReads) {
  const std::filesystem::path file = testing::data_file("logs/ardusub_small.BIN");
  if (file.empty()) {
    GTEST_SKIP() << "the log isn't there";
  }
  const testing::HashSums expected{
      {"AHR2", {237, 2712122415U}},    {"ARM", {1, 3996588084U}},
      {"ATT", {237, 3817773977U}},     {"BARO[0]", {237, 1570601005U}},
      {"BARO[1]", {237, 1392757720U}}, {"BAT[0]", {237, 3820166335U}},
      {"CTRL", {237, 207539516U}},     {"CTUN", {237, 1561924367U}},
      {"DSF", {23, 3986627392U}},      {"DU32", {24, 184125576U}},
      {"EV", {2, 3575500690U}},        {"FTN", {237, 3681705679U}},
      {"IMU[0]", {594, 3057043309U}},  {"MAG[0]", {237, 1520065755U}},
      {"MAG[1]", {237, 4230718468U}},  {"MAVC", {5, 3292909585U}},
      {"MAV[0]", {23, 889507854U}},    {"MAV[1]", {23, 799333147U}},
      {"MAV[2]", {23, 1899893466U}},   {"MODE", {1, 2184710697U}},
      {"MOTB", {237, 1981497134U}},    {"MSG", {9, 1154368313U}},
      {"PARM", {876, 3504479643U}},    {"PM", {2, 3086719649U}},
      {"RATE", {237, 1891716063U}},    {"RCI2", {237, 498521091U}},
      {"RCIN", {237, 915856985U}},     {"RCOU", {237, 694877873U}},
      {"VIBE[0]", {237, 3085981789U}}, {"XKF1[0]", {237, 1711538657U}},
      {"XKF2[0]", {237, 3673741670U}}, {"XKF3[0]", {237, 2223803360U}},
      {"XKF4[0]", {237, 926238721U}},  {"XKF5[0]", {237, 2020055653U}},
      {"XKFS[0]", {237, 1754224836U}}, {"XKQ[0]", {237, 3437790745U}},
      {"XKT[0]", {5, 77807222U}},      {"XKV1[0]", {48, 1407357969U}},
      {"XKV2[0]", {48, 1239181336U}},
  };
  const auto bag = bag::open_bag(file);
  EXPECT_EQ(testing::hash_sums_of(*bag), expected);
}

}  // namespace
}  // namespace kelpie::dataflash_reader_test
