// SPDX-License-Identifier: Apache-2.0
#include "study/alignment.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "kelpie/core/error.hpp"
#include "small_log.hpp"
#include "support.hpp"

namespace kelpie::alignment_study_test {
namespace {

using testing::message_of;
using testing::small_log;

std::vector<std::size_t> rows_of_commands(const log::Dataset& data) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < data.rows(); ++row) {
    rows.push_back(testing::row_of(data.input(row)[1]));
  }
  return rows;
}

TEST(Alignment, ShiftsTheCommandsOfALogWithinItsStretchesAndNothingElse) {
  log::Dataset data = small_log(9);
  data.configurations = {0, 0, 0, 0, 1, 1, 1, 1, 1};
  for (std::size_t row = 7; row < 9; ++row) {
    data.times_s[row] += 2.0;
  }
  const Alignment half_a_second{.lag_s = 0.5, .rows = 20, .commands = {"row"}};
  const log::Dataset shifted = study::aligned(data, half_a_second);  // two rows at 4 Hz
  EXPECT_EQ(rows_of_commands(shifted), (std::vector<std::size_t>{2, 3, 3, 3, 6, 6, 6, 8, 8}));
  EXPECT_EQ(shifted.targets, data.targets);
  EXPECT_EQ(shifted.times_s, data.times_s);
  for (std::size_t row = 0; row < 9; ++row) {
    EXPECT_EQ(shifted.input(row)[0], data.input(row)[0]);
  }
  EXPECT_EQ(study::aligned(data, {}).inputs, data.inputs);
}

TEST(Alignment, TakesSecondsInWholeRowsAndRefusesWhatIsNone) {
  const log::Dataset data = small_log(40);
  const study::Split split{"by hand", testing::all_rows(30), {}};
  const auto chosen = [&](const std::string& wish) {
    return study::choose_alignment(data, split, "u", wish);
  };
  EXPECT_EQ(chosen("none").alignment.rows, 0);
  EXPECT_EQ(chosen("-0.7").alignment.rows, -3);
  EXPECT_EQ(chosen("-0.7").alignment.lag_s, -0.75);
  EXPECT_EQ(study::alignment_text(chosen("-0.7"), 4.0),
            "commands are taken 0.75 s (3 rows) earlier: as given by --align");
  EXPECT_EQ(study::alignment_text(chosen("0.1"), 4.0),
            "commands are taken as they stand: 0.1 s are less than half a row");
  for (const char* const wish : {"", "Auto", "nan", "inf", "1e9", "-10.5", "0.5s", "0,5"}) {
    EXPECT_NE(message_of<InputError>([&] { chosen(wish); }).find("auto, none or seconds"),
              std::string::npos)
        << wish;
  }
  log::Dataset nameless = data;
  nameless.input_names = {"a", "b"};
  EXPECT_NE(message_of<InputError>([&] {
              study::choose_alignment(nameless, split, "auto", "0.5");
            }).find("name the velocities"),
            std::string::npos);
}

}  // namespace
}  // namespace kelpie::alignment_study_test
