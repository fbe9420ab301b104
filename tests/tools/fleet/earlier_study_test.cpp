// SPDX-License-Identifier: Apache-2.0
#include "fleet/earlier_study.hpp"
#include "file/atomic_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "fleet/forged_study.hpp"
#include "fleet/study_json.hpp"
#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::earlier_study_test {
namespace {

using fleet::kNoValue;
using testing::ForgedStudy;
using testing::message_of;
using testing::write_text;

// Dives of one vehicle with these R², now and then, of the first learner; the second keeps its own.
fleet::StudyChange change(const std::vector<double>& then, const std::vector<double>& now) {
  const auto run = [](const std::vector<double>& r2, ForgedStudy& study) {
    study.add_vehicle("one", r2.size());
    return study.results([&](const fleet::Combination& one) {
      return ForgedStudy::with_r2({one.learner == 0 ? r2[one.mission] : 0.5});
    });
  };
  ForgedStudy before;
  {
    const auto kept = run(then, before);
    const fleet::Results& results = *kept;
    const fleet::StudySummary summary = fleet::summarise(results);
    file::write_files_whole(before.folder.path(),
                            {{"study.json", fleet::study_json(results, summary, nullptr)}});
  }
  fleet::EarlierStudy earlier = fleet::read_earlier_study(before.folder / "study.json");
  std::filesystem::remove(before.folder / fleet::kJournalName);
  ForgedStudy after;
  return fleet::compare_studies(*run(now, after), std::move(earlier));
}

TEST(EarlierStudy, IsMatchedRunByRun) {
  const fleet::StudyChange same = change({0.9, 0.8, kNoValue}, {0.9, 0.8, kNoValue});
  EXPECT_EQ(same.matched, 6U);
  EXPECT_TRUE(same.worst.empty());
  EXPECT_TRUE(fleet::losses(same, 0.0).empty());

  const fleet::StudyChange changed = change({0.9, 0.8, 0.7, 0.6}, {0.9, 0.6, 0.5, 0.9, 0.4});
  EXPECT_EQ(changed.matched, 8U);
  EXPECT_EQ(changed.only_now, 2U);
  EXPECT_EQ(changed.only_then, 0U);
  const fleet::Gain& gain = changed.gains.at(0);
  EXPECT_EQ(gain.learner, "kelpie");
  EXPECT_NEAR(gain.difference.median, -0.1, 1e-12);
  EXPECT_NEAR(gain.difference.least, -0.2, 1e-12);
  EXPECT_EQ(gain.now.better, 1U);
  EXPECT_EQ(gain.now.worse, 2U);
  EXPECT_EQ(changed.worst.size(), 2U);
  EXPECT_EQ(fleet::losses(changed, 0.09).size(), 1U);
  EXPECT_TRUE(fleet::losses(changed, 0.11).empty());
}

TEST(EarlierStudy, WhoHasLostItsR2HasBecomeWorse) {
  const fleet::StudyChange changed = change({0.9, 0.8, 0.7}, {0.9, kNoValue, 0.7});
  EXPECT_EQ(changed.gains.at(0).lost, 1U);
  EXPECT_EQ(fleet::losses(changed, 0.5).size(), 1U);
  ASSERT_EQ(changed.worst.size(), 1U);
  EXPECT_TRUE(std::isnan(changed.worst[0].now));
}

TEST(EarlierStudy, RefusesWhatIsNone) {
  const testing::TemporaryFolder folder;
  const auto refused = [&](const std::string& text) {
    write_text(folder / "old.json", text);
    return message_of<InputError>([&] { fleet::read_earlier_study(folder / "old.json"); });
  };
  const std::string head = R"({"format": "kelpie-study", "version": 1, "kelpie": "0", "runs": )";
  EXPECT_EQ(refused(head + "[]}"), "");
  EXPECT_NE(refused("").find("is not JSON"), std::string::npos);
  EXPECT_NE(refused(head + "[{").find("is not JSON"), std::string::npos);
  EXPECT_NE(refused("[]").find("format"), std::string::npos);
  EXPECT_NE(refused(R"({"format": "kelpie-study", "version": 2})").find("version"),
            std::string::npos);
  EXPECT_NE(refused(head + R"([{"axes": 1}]})").find("runs.axes"), std::string::npos);
  EXPECT_NE(refused(head + R"([{"axes": [{}]}]})").find("runs"), std::string::npos);
  const std::string run = R"("log": "a", "split": "tail", "learner": "b", "axes": [{"name": "c",)";
  EXPECT_NE(
      refused(head + R"([{"seed": "x", )" + run + R"( "r2": {"final": 1}}]}]})").find("runs.seed"),
      std::string::npos);
  EXPECT_NE(
      refused(head + R"([{"seed": 1, )" + run + R"( "r2": {"final": 1e999}}]}]})").find("old.json"),
      std::string::npos);
}

}  // namespace
}  // namespace kelpie::earlier_study_test
