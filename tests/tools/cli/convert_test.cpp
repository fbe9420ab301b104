// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "bag/ros1_bags.hpp"
#include "cli/command.hpp"
#include "cli/shell.hpp"

namespace kelpie::convert_test {
namespace {

using testing::content_of;
using testing::kelpie;
using testing::Outcome;

const std::string kBag = KELPIE_SOURCE_DIR "/tests/logs/bag/fixtures/zstd.mcap";

class Convert : public testing::CommandTest {
 protected:
  Outcome convert(const std::string& arguments) { return run("convert " + arguments); }
};

TEST_F(Convert, ColumnsOfTwoTopicsBecomeALog) {
  const Outcome outcome =
      testing::succeeded(convert(kBag + " --columns /cmd:linear.y,/sample:speeds[0] --out l.csv"));
  // /sample comes 30 ms after /cmd: a row has the sample before it.
  EXPECT_TRUE(
      content("l.csv").starts_with("t,/cmd:linear.y,/sample:speeds[0]\n0,-0,nan\n0.1,-1,0.5\n"))
      << content("l.csv");
}

TEST_F(Convert, AnMcapCopyGivesTheSameLog) {
  ASSERT_EQ(convert(kBag + " --out copy.mcap").exit_code, 0);
  const std::string columns = " --columns /sample:pairs[1].b,/cmd:linear.x --out ";
  ASSERT_EQ(convert(kBag + columns + "a.csv").exit_code, 0);
  ASSERT_EQ(convert("copy.mcap" + columns + "b.csv").exit_code, 0);
  EXPECT_EQ(content("a.csv"), content("b.csv"));
}

TEST_F(Convert, AConfigurationFileMakesSamplesAndSaysWhatWasDone) {
  std::ofstream(folder_ / "c.toml") << "[log]\nrate = 20\n[log.states]\nx = \"/cmd:linear.x\"\n";
  const Outcome outcome = testing::succeeded(convert(kBag + " --config c.toml --out s.csv"));
  EXPECT_NE(outcome.out.find("rate/Hz"), std::string::npos) << outcome.out;
  EXPECT_TRUE(content("s.csv").find("\n0.05,0.05\n0.1,0.1\n") != std::string::npos)
      << content("s.csv");
}

TEST_F(Convert, ABagOfRos1IsConvertedAndOneThatIsCutOffOnlyIfAskedFor) {
  const std::string bag = testing::small_ros1(6).file();
  write("a.bag", bag);
  write("cut.bag", bag.substr(0, bag.size() - 1));
  ASSERT_EQ(convert("a.bag --out a.mcap").exit_code, 0);
  ASSERT_EQ(convert("a.bag --columns /a:x --out a.csv").exit_code, 0);
  ASSERT_EQ(convert("a.mcap --columns /a:x --out b.csv").exit_code, 0);
  EXPECT_EQ(content("a.csv"), "t,/a:x\n0,0\n1,1\n2,2\n3,3\n4,4\n5,5\n");
  EXPECT_EQ(content("a.csv"), content("b.csv"));
  testing::expect_refused(convert("cut.bag --out cut.mcap"), "cut.bag: offset ");
  EXPECT_FALSE(exists("cut.mcap"));
  const Outcome recovered = convert("cut.bag --recover --columns /a:x --out c.csv");
  EXPECT_EQ(recovered.exit_code, 0) << recovered.err;
  EXPECT_NE(recovered.err.find("lost: "), std::string::npos);
  EXPECT_EQ(content("c.csv"), content("a.csv"));
}

TEST_F(Convert, ABagIsNotReplacedAndAPipeIsNone) {
  std::filesystem::copy_file(kBag, folder_ / "a.mcap");
  EXPECT_NE(convert("a.mcap --out a.mcap").err.find("a.mcap: --out: would overwrite an input"),
            std::string::npos);
  EXPECT_EQ(content("a.mcap"), content_of(kBag));
  const std::string said =
      testing::shell(folder_, KELPIE_COMMAND " convert <(cat a.mcap) --out b.mcap");
  EXPECT_NE(said.find("is a pipe or a device; a bag has to be a file"), std::string::npos) << said;
}

TEST_F(Convert, WhatDoesNotFitIsRefusedAndNothingIsWritten) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {" --out x.csv",
       "--columns: is missing; name columns as in /odom:twist.twist.linear.x, or give --config"},
      {" --columns /cmd:linear.x --out x.mcap", "belongs to CSV files"},
      {" --columns /cmd:linear.x --out x.txt", "a name ending in .csv or .mcap"},
      {" --columns /cmd:linaer.x --out x.csv", "did you mean 'linear.x'?"},
      {" --columns /cmd:linear.x --clock header --out x.csv", "has no header"},
      {" --clock header --out x.mcap", "--clock: is of the rows of --columns"},
      {" --clock header --config c.toml --out x.csv", "--clock: is of the rows of --columns"},
      {" --columns /cmd:linear.x --msg-dir none --out x.csv", "none: is not a folder"},
  };
  for (const auto& [arguments, message] : cases) {
    testing::expect_refused(convert(kBag + arguments), message);
  }
  for (const char* const name : {"x.csv", "x.mcap", "x.txt"}) {
    EXPECT_FALSE(std::filesystem::exists(folder_ / name));
  }
}

}  // namespace
}  // namespace kelpie::convert_test
