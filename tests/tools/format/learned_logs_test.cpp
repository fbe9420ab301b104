// SPDX-License-Identifier: Apache-2.0
#include "format/learned_logs.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::learned_logs_test {
namespace {

using format::LearnedLog;

log::Dataset dataset(std::vector<double> inputs) {
  log::Dataset data;
  data.input_names = {"u"};
  data.target_names = {"udot"};
  data.targets.assign(inputs.size(), 1.0);
  data.times_s.assign(inputs.size(), 0.0);
  data.inputs = std::move(inputs);
  return data;
}

std::vector<bool> marks(std::string_view text) {
  std::vector<bool> found;
  for (const char letter : text) {
    found.push_back(letter == 'h');
  }
  return found;
}

TEST(LearnedLogs, ARowIsHeldOutWhereAllLearningHeldItOut) {
  const log::Dataset first = dataset({1, 2, 3, 4, 5});
  const log::Dataset second = dataset({6, 7, 8});
  const std::vector<std::size_t> rows{0, 3, 4, 5, 7};
  const std::vector<LearnedLog> logs =
      format::with_held_out({format::learned_log(first), format::learned_log(second)}, rows);
  EXPECT_EQ(format::held_out_rows(logs, first), marks("h..hh"));
  EXPECT_EQ(format::held_out_rows(logs, second), marks("h.h"));
  EXPECT_TRUE(format::held_out_rows(logs, dataset({1, 2, 3, 4})).empty());
  EXPECT_TRUE(format::held_out_rows(logs, dataset({1, 2, 3, 4, 6})).empty());
  std::vector<LearnedLog> twice = logs;
  twice.push_back(
      format::with_held_out({format::learned_log(first)}, std::vector<std::size_t>{3})[0]);
  EXPECT_EQ(format::held_out_rows(twice, first), marks("...h."));
}

TEST(LearnedLogs, ComeBackFromJson) {
  const log::Dataset data = dataset({1, 2, 3, 4, 5});
  const std::vector<LearnedLog> logs =
      format::with_held_out({format::learned_log(data)}, std::vector<std::size_t>{1, 2, 4});
  const file::Json json = format::learned_json(logs);
  EXPECT_EQ(json[0]["held_out"].dump(), "[[1,2],[4,4]]");
  EXPECT_EQ(format::read_learned(file::JsonNode(json, "m.json", "learned")), logs);
}

TEST(LearnedLogs, WhatIsWrongIsNamed) {
  const auto said = [](const std::string& text) {
    const file::Json json = file::parse_json(text, "m.json");
    return testing::message_of<InputError>(
        [&] { format::read_learned(file::JsonNode(json, "m.json", "learned")); });
  };
  const std::string start = R"([{"checksum": "00", "rows": 5, "held_out": )";
  EXPECT_NE(said(start + "[[3, 5]]}]").find("m.json: learned[0].held_out[0]: has to be first"),
            std::string::npos)
      << said(start + "[[3, 5]]}]");
  for (const std::string wrong : {"[[2, 1]]}]", "[[1, 2], [2, 3]]}]", "[[-1, 2]]}]", "[[0.5, 2]]}]",
                                  "[[1]]}]", "[1]}]", "null}]", "[[1, 1e99]]}]"}) {
    EXPECT_NE(said(start + wrong), "") << wrong;
  }
  EXPECT_NE(said(R"([{"checksum": "00", "rows": -1, "held_out": []}])"), "");
  EXPECT_NE(said("[1]"), "");
}

}  // namespace
}  // namespace kelpie::learned_logs_test
