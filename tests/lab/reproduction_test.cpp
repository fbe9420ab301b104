// SPDX-License-Identifier: Apache-2.0
#include "lab/reproduction.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <string>

#include "kelpie/core/error.hpp"
#include "lab/contenders.hpp"
#include "support.hpp"

namespace kelpie::reproduction_test {
namespace {

using testing::message_of;
using testing::TemporaryFolder;

// Scenario files of a folder of the test's own, short enough for a test.
class ReproductionTest : public ::testing::Test {
 protected:
  ReproductionTest() {
    const std::string head = "vehicle = '" KELPIE_SOURCE_DIR
                             "/vehicles/dagon.toml'\nrate_hz = 1.0\nnoise = 'as_recorded'\n"
                             "[[configurations]]\nname = 'a'\n"
                             "[[phases]]\nconfiguration = 'a'\n";
    write("main", head + "duration_s = 1650.0\n");
    const std::string again = "[[phases]]\nconfiguration = 'a'\n";
    write("concentrated", head + "duration_s = 425.0\n" + again +
                              "duration_s = 850.0\namplitude = 0.3\n" + again +
                              "duration_s = 425.0\n");
    plan_ = lab::quick_plan();
    plan_.scenarios = folder_.path();
    plan_.scenario = "main";
    plan_.scenario_share = 1.0;
    plan_.further_share = 1.0;
    plan_.grid = {.gamma = {0.1}, .c = {10.0}, .epsilon = {0.1}, .folds = 2, .thin = 8};
  }

  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / (name + ".toml")) << text;
  }

  TemporaryFolder folder_;
  lab::ReproductionPlan plan_;
};

// Every number of the main stream but the times.
std::vector<double> numbers_of(const lab::Reproduction& result) {
  std::vector<double> numbers;
  for (const lab::StreamStudy& study : result.studies) {
    if (study.key != "simulation") {
      continue;
    }
    for (const lab::RowRuns& runs : study.rows) {
      for (const lab::SeedRun& seed : runs.seeds) {
        for (const study::AxisResult& axis : seed.axes) {
          for (const study::ValidationPoint& point : axis.validation) {
            numbers.push_back(point.r2);
          }
          numbers.insert(numbers.end(), axis.stages.back().predicted.begin(),
                         axis.stages.back().predicted.end());
        }
      }
    }
    for (const lab::OfflineMatrix& matrix : study.offline) {
      for (const lab::OfflineModel& model : matrix.models) {
        numbers.insert(numbers.end(), model.r2.begin(), model.r2.end());
      }
    }
  }
  return numbers;
}

TEST_F(ReproductionTest, SameNumbersWithAnyNumberOfThreads) {
  plan_.further = {"concentrated"};
  plan_.threads = 1;
  const lab::Reproduction one = lab::reproduce(plan_);
  plan_.threads = 3;
  plan_.further.clear();
  EXPECT_EQ(numbers_of(one), numbers_of(lab::reproduce(plan_)));
  ASSERT_EQ(one.studies.size(), 4U);  // random and blocks of both; no real log was given
  EXPECT_FALSE(one.real_log);
  for (const lab::StreamStudy& study : one.studies) {
    const bool main = study.key == "simulation";
    EXPECT_TRUE(study.simulated);
    EXPECT_EQ(study.rows.size(), static_cast<std::size_t>(std::ranges::count(
                                     lab::reproduction_rows(), false, &lab::Row::slow)));
    EXPECT_EQ(study.offline.size(), main ? 3U : 0U);
    EXPECT_EQ(study.offline_terms.size(), main ? 3U : 0U);
    EXPECT_EQ(study.found.size(), main ? lab::searched_families().size() : 0U);
    for (const study::AxisResult& axis : study.rows.back().seeds[0].axes) {
      ASSERT_EQ(axis.stages.size(), 1U) << axis.name;
      EXPECT_GT(axis.stages[0].r2, 0.7) << axis.name;
      // The second phase of the concentrated stream is at low speed: nobody is judged on it.
      const auto in_second = [](double time_s) { return time_s > 425.5 && time_s < 1275.0; };
      EXPECT_EQ(std::ranges::none_of(axis.stages[0].time_s, in_second),
                !main || study.split_kind == study::SplitKind::blocks);
    }
  }
}

// Rows in order of the page, and what the paper's row may not have.
TEST_F(ReproductionTest, ThePapersRowsAreThePapersRules) {
  std::set<std::string> keys;
  for (const lab::Row& row : lab::reproduction_rows()) {
    EXPECT_TRUE(keys.insert(row.key).second) << row.key;
    const std::string settings = row.make(row, lab::AxisValues(3, {{"gamma", "0.03"}}), 3).settings;
    const auto says = [&](const std::string& part) {
      return (settings + " ").find(part + " ") != std::string::npos;
    };
    if (row.kind == lab::RowKind::paper) {
      for (const char* const rule : {"fine=0", "lambda=0", "terms=none", "outlier=iqr",
                                     "forget=paper", "adapt=none", "scaling=full", "memory=0"}) {
        EXPECT_TRUE(says(rule)) << row.key << ": " << settings;
      }
    }
    if (row.family == "paper" && row.key != std::string("paper_printed")) {
      EXPECT_TRUE(says("gamma=0.03")) << row.key << ": " << settings;
    }
    if (row.key == std::string("fifo")) {
      EXPECT_TRUE(says("forget=fifo") && says("buffer=900")) << settings;
    }
    if (row.key == std::string("sosvr")) {
      EXPECT_TRUE(says("dictionary=900")) << settings;
    }
    if (row.kind == lab::RowKind::kelpie) {
      const ModelSettings ours = ModelSettings::from_preset("default", 3);
      for (const auto& [name, value] : ours.values()) {
        EXPECT_TRUE(says(name + "=" + value)) << name;
      }
    }
  }
}

TEST_F(ReproductionTest, StopsWhenAsked) {
  std::size_t calls = 0;
  plan_.threads = 2;
  plan_.keep_going = [&](double share) {
    EXPECT_GE(share, 0.0);
    EXPECT_LE(share, 1.0);
    return ++calls < 30;
  };
  EXPECT_TRUE(lab::reproduce(plan_).interrupted);
}

TEST_F(ReproductionTest, RefusesWhatItCannotRun) {
  plan_.scenario = "mainn";
  const std::string unknown = message_of<InputError>([&] { lab::reproduce(plan_); });
  EXPECT_NE(unknown.find("'mainn' is no scenario (did you mean 'main'?)"), std::string::npos)
      << unknown;
  plan_.scenario = "main";
  plan_.seeds = 0;
  EXPECT_NE(message_of<InputError>([&] { lab::reproduce(plan_); }).find("seeds: 0 is out of range"),
            std::string::npos);
  plan_.seeds = 1;
  plan_.scenario_share = 0.1;  // 170 rows per configuration: no block to hold out
  EXPECT_NE(message_of<InputError>([&] { lab::reproduce(plan_); }).find("needs 1601 or more"),
            std::string::npos);
  plan_.scenario_share = 1.0;
  plan_.data = folder_.path();
  EXPECT_NE(message_of<InputError>([&] { lab::reproduce(plan_); }).find(lab::kRealLogName),
            std::string::npos);
}

}  // namespace
}  // namespace kelpie::reproduction_test
