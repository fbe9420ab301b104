// SPDX-License-Identifier: Apache-2.0
#include "kelpie/svr/decision.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <string_view>

namespace kelpie::tally_test {
namespace {

std::int64_t sum_of(const Tally& tally) {
  std::int64_t sum = 0;
  for (const TallyField& field : tally_fields()) {
    sum += tally.*field.total;
  }
  return sum;
}

TEST(Tally, EveryTotalHasOneLineAndNamesOfItsOwn) {
  std::set<std::string_view> keys;
  std::set<std::string_view> names;
  std::set<std::string_view> labels;
  // NOLINTNEXTLINE(misc-const-correctness): written to through pointers to members
  Tally tally;
  for (const TallyField& field : tally_fields()) {
    EXPECT_TRUE(keys.insert(field.key).second) << field.key;
    EXPECT_TRUE(names.insert(field.name).second) << field.name;
    EXPECT_TRUE(labels.insert(field.label).second) << field.label;
    EXPECT_FALSE(field.meaning.empty()) << field.key;
    EXPECT_EQ(++(tally.*field.total), 1) << field.key << " counts what another line counts";
  }
}

// A decision that does one thing is counted in one total, beside `accepted`.
TEST(Tally, EveryThingThatHappensIsCountedOnce) {
  const auto extra = [](const Decision& decision, std::int64_t Tally::*total) {
    Tally tally;
    tally.add(decision);
    EXPECT_EQ(tally.accepted, 1);
    EXPECT_EQ(sum_of(tally), 1 + tally.*total);
    return tally.*total;
  };
  EXPECT_EQ(extra({.outliers = 3}, &Tally::outliers), 3);
  EXPECT_EQ(extra({.forgotten = 2}, &Tally::forgotten), 2);
  EXPECT_EQ(extra({.released = 4}, &Tally::released), 4);
  EXPECT_EQ(extra({.rejected_by_tolerance = true}, &Tally::rejected_by_tolerance), 1);
  EXPECT_EQ(extra({.unfinished = true}, &Tally::unfinished), 1);
  EXPECT_EQ(extra({.fallbacks = 2}, &Tally::fallbacks), 2);
  EXPECT_EQ(extra({.changed = true}, &Tally::changes), 1);
  EXPECT_EQ(extra({.withdrawn = true}, &Tally::withdrawn), 1);
  EXPECT_EQ(extra({.recalled = 7}, &Tally::recalls), 1);
}

TEST(Tally, ASampleIsCountedByItsVerdict) {
  Tally tally;
  for (const Verdict verdict :
       {Verdict::accepted, Verdict::explained, Verdict::duplicate, Verdict::invalid,
        Verdict::implausible, Verdict::held_back, Verdict::crowded_out}) {
    tally.add({.verdict = verdict});
  }
  for (const TallyField& field : tally_fields()) {
    EXPECT_EQ(tally.*field.total, field.kind == TallyKind::arrival ? 1 : 0) << field.key;
  }
  EXPECT_EQ(sum_of(tally), 6);  // held back: counted when it is learned
}

}  // namespace
}  // namespace kelpie::tally_test
