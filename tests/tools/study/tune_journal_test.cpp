// SPDX-License-Identifier: Apache-2.0
#include "study/tune_journal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::tune_journal_test {
namespace {

using testing::message_of;
using testing::TemporaryFolder;

const study::TuneJournal::Header kHeader{{"dataset", "log.csv"}, {"seed", "1"}};

std::string result_of(double score) {
  study::ChainScore result;
  result.score = score;
  result.stretches = {score, 1.0 / 3.0};
  result.iterations_per_row = 0.1;
  return study::score_text(result);
}

void append(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::app) << text;
}

TEST(TuneJournal, GivesBackWhatAnEarlierOneWasTold) {
  const TemporaryFolder folder;
  const study::EvaluationKey good{0, "udot", 2, "gamma=0.1 c=10"};
  const study::EvaluationKey bad{0, "udot", 2, "gamma=3 c=10"};
  {
    study::TuneJournal journal(folder / "journal.jsonl", kHeader);
    journal.add(good, result_of(0.1 + 0.2));
    study::ChainScore given_up;
    given_up.given_up = true;
    journal.add(bad, study::score_text(given_up));
  }
  const study::TuneJournal journal(folder / "journal.jsonl", kHeader);
  EXPECT_EQ(journal.size(), 2U);
  EXPECT_EQ(journal.find(good)->score, 0.1 + 0.2) << "to the last bit";
  EXPECT_EQ(journal.find(good)->stretches, (std::vector<double>{0.1 + 0.2, 1.0 / 3.0}));
  EXPECT_TRUE(journal.find(bad)->given_up);
  EXPECT_TRUE(std::isnan(journal.find(bad)->score));
  EXPECT_FALSE(journal.find({0, "udot", 1, good.settings}));
  EXPECT_FALSE(journal.find({1, "udot", 2, good.settings})) << "another log";
}

TEST(TuneJournal, PassesOverALineThatWasCutOffAndGoesOnBehindTheWholeOnes) {
  const TemporaryFolder folder;
  const auto file = folder / "journal.jsonl";
  study::TuneJournal(file, kHeader).add({0, "udot", 0, "c=1"}, result_of(0.5));
  append(file, R"({"axis":"udot","rung":0,"sett)");
  {
    study::TuneJournal journal(file, kHeader);
    EXPECT_EQ(journal.size(), 1U);
    journal.add({0, "udot", 0, "c=2"}, result_of(0.6));
  }
  EXPECT_EQ(study::TuneJournal(file, kHeader).size(), 2U);
}

TEST(TuneJournal, RefusesAnotherSearchesJournalNamingWhatDiffers) {
  const TemporaryFolder folder;
  const auto file = folder / "journal.jsonl";
  { const study::TuneJournal begun(file, kHeader); }
  const std::string message = message_of<InputError>([&] {
    const study::TuneJournal other(file, {{"dataset", "log.csv"}, {"seed", "2"}});
  });
  EXPECT_NE(message.find("seed: this run has \"2\", but the journal was begun with \"1\""),
            std::string::npos)
      << message;
}

TEST(TuneJournal, RefusesThoseOfVersionsWithoutChecksums) {
  const TemporaryFolder folder;
  append(folder / "old", R"({"format":"kelpie-tune-journal","version":1,"seed":"1"})"
                         "\n");
  EXPECT_NE(message_of<InputError>([&] {
              const study::TuneJournal journal(folder / "old", kHeader);
            }).find("is no kelpie-tune-journal of this version of kelpie"),
            std::string::npos);
}

}  // namespace
}  // namespace kelpie::tune_journal_test
