// SPDX-License-Identifier: Apache-2.0
#include "report/sampling_table.hpp"

#include <gtest/gtest.h>

namespace kelpie::sampling_table_test {
namespace {

TEST(SamplingTable, SaysWhatWasFoundInASignalAndDoneToIt) {
  log::SamplingReport report;
  log::SamplingReport::OfSource& port = report.sources.emplace_back();
  port.name = "port";
  port.rate_hz = 25.0;
  port.lag_s = 0.3;
  port.lag_origin = "estimated";
  port.faults.samples = 3000;
  port.faults.duplicates = 4;
  log::SamplingReport::OfSource& u = report.sources.emplace_back();
  u.name = "u";
  report.lags = log::TopicAlignment{};
  report.rows = 10;
  report.segments = 1;
  const std::string table = report::sampling_table(report);
  for (const char* const words :
       {"3000    25.00  0.300  4 with the stamp before\n", "–\n", "lags estimated from the first",
        "10 rows, 0 whole in 1 stretch"}) {
    EXPECT_NE(table.find(words), std::string::npos) << words << "\n" << table;
  }
  const std::string notes = report::sampling_notes(report);
  EXPECT_TRUE(notes.starts_with("1 of 2 signals have silences")) << notes;
  EXPECT_TRUE(notes.ends_with("10 rows, 0 whole in 1 stretch\n\n")) << notes;
}

TEST(SamplingTable, OfATableAsItWasThereIsNothingToSay) {
  EXPECT_EQ(report::sampling_table({}), "");
  EXPECT_EQ(report::sampling_notes({}), "");
}

}  // namespace
}  // namespace kelpie::sampling_table_test
