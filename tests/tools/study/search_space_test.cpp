// SPDX-License-Identifier: Apache-2.0
#include "study/search_space.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/model/settings.hpp"
#include "support.hpp"

namespace kelpie::search_space_test {
namespace {

using testing::message_of;

study::SearchSpace space_of(const std::vector<std::string>& searches) {
  study::SearchSpace space;
  for (const std::string& text : searches) {
    space.search(text);
  }
  return space;
}

std::string refusal(const std::string& text) {
  return message_of<InputError>([&] { space_of({text}); });
}

double number(const study::Assignments& candidate, const std::string& name) {
  const auto found = std::ranges::find(candidate, name, &study::Assignments::value_type::first);
  double value = 0.0;
  EXPECT_TRUE(found != candidate.end() && parse_number(found->second, value)) << name;
  return value;
}

TEST(SearchSpace, EveryStandardCandidateIsValidAndInRange) {
  const study::SearchSpace space = study::SearchSpace::standard();
  const auto candidates = space.candidates(1, 200);
  ASSERT_EQ(candidates.size(), 200U);
  EXPECT_TRUE(candidates.front().empty()) << "the base stands first as it is";
  ASSERT_FALSE(space.dimensions().empty());
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    ModelSettings settings = ModelSettings::from_preset("default", 1);
    for (const auto& [name, text] : candidates[i]) {
      settings.assign(name, text);
    }
    EXPECT_NO_THROW(settings.validate());
    for (const study::Dimension& dimension : space.dimensions()) {
      const double value = number(candidates[i], dimension.name);
      EXPECT_GE(value, dimension.low) << dimension.name;
      EXPECT_LE(value, dimension.high) << dimension.name;
    }
  }
}

TEST(SearchSpace, ACandidateDependsOnSeedAndNumberAlone) {
  const study::SearchSpace space = study::SearchSpace::standard();
  const auto few = space.candidates(7, 5);
  const auto many = space.candidates(7, 50);
  EXPECT_TRUE(std::equal(few.begin(), few.end(), many.begin()));
  EXPECT_NE(space.candidates(8, 5), few);
}

TEST(SearchSpace, FixingOneSettingLeavesTheOthersDrawsAlone) {
  study::SearchSpace space = study::SearchSpace::standard();
  const double before = number(space.candidates(1, 3)[2], "xi");
  space.fix("gamma");
  const study::Assignments after = space.candidates(1, 3)[2];
  EXPECT_EQ(number(after, "xi"), before);
  EXPECT_EQ(std::ranges::find(after, "gamma", &study::Assignments::value_type::first), after.end());
}

TEST(SearchSpace, SpreadsPutHalfTheDrawsWhereTheySay) {
  const study::SearchSpace space =
      space_of({"gamma=0.01:1:log", "a=0.9:0.999:log1m", "c=1:11:linear", "anchors=1:4:linear"});
  std::size_t gamma = 0;
  std::size_t a = 0;
  std::size_t c = 0;
  std::set<double> anchors;
  const auto candidates = space.candidates(3, 1001);
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    gamma += number(candidates[i], "gamma") < 0.1 ? 1 : 0;
    a += number(candidates[i], "a") < 0.99 ? 1 : 0;
    c += number(candidates[i], "c") < 6.0 ? 1 : 0;
    anchors.insert(number(candidates[i], "anchors"));
  }
  EXPECT_NEAR(static_cast<double>(gamma), 500.0, 60.0);
  EXPECT_NEAR(static_cast<double>(a), 500.0, 60.0);
  EXPECT_NEAR(static_cast<double>(c), 500.0, 60.0);
  EXPECT_EQ(anchors, (std::set<double>{1.0, 2.0, 3.0, 4.0}));
}

TEST(SearchSpace, ChoicesAreAllDrawnAndSharedOnesAreCombined) {
  const study::SearchSpace space = space_of({"forget=age,paper", "scaling=full,diagonal"});
  std::set<std::string> drawn;
  for (const study::Assignments& candidate : space.candidates(1, 30)) {
    for (const auto& [name, text] : candidate) {
      EXPECT_EQ(name, "forget") << "axes can't differ in a shared setting";
      drawn.insert(text);
    }
  }
  EXPECT_EQ(drawn, (std::set<std::string>{"age", "paper"}));
  EXPECT_EQ(space.shared_combinations(),
            (std::vector<study::Assignments>{{{"scaling", "full"}}, {{"scaling", "diagonal"}}}));
}

TEST(SearchSpace, ALaterSearchReplacesTheStandardOneAndTextReadsBack) {
  study::SearchSpace space = study::SearchSpace::standard();
  space.search("gamma=0.01:1");
  EXPECT_EQ(space.dimensions().front().text(), "gamma=0.01:1:log")
      << "spread of the standard space";
  EXPECT_EQ(space_of(split_text(space.text(), ' ')).text(), space.text());
}

TEST(SearchSpace, RefusesWhatItCanNotSearchAndSaysWhatWouldDo) {
  EXPECT_NE(refusal("gama=0.1:1").find("did you mean 'gamma'"), std::string::npos);
  EXPECT_NE(refusal("s=0.1:1").find("lambda/s"), std::string::npos) << "a removed setting";
  EXPECT_NE(refusal("preset=default,paper").find("--set"), std::string::npos);
  EXPECT_NE(refusal("gamma").find("name=low:high"), std::string::npos);
  EXPECT_NE(refusal("gamma=1").find("--set gamma=1"), std::string::npos);
  EXPECT_NE(refusal("gamma=1:0.1").find("lesser to the greater"), std::string::npos);
  EXPECT_NE(refusal("gamma=a:1").find("'a' is not a number"), std::string::npos);
  EXPECT_NE(refusal("gamma=0.1:1:lg").find("did you mean 'log'"), std::string::npos);
  EXPECT_NE(refusal("epsilon=0:1:log").find("above 0"), std::string::npos);
  EXPECT_NE(refusal("xi=0.5:1:log1m").find("below 1"), std::string::npos);
  EXPECT_NE(refusal("xi=0.5:2:linear").find("0 to 1"), std::string::npos);
  EXPECT_NE(refusal("forget=age,papr").find("did you mean 'paper'"), std::string::npos);
  EXPECT_NE(refusal("forget=1:2").find("fifo"), std::string::npos);
  EXPECT_NE(refusal("warmup=10:20").find("holds for all axes"), std::string::npos);
  EXPECT_NE(refusal("gamma=1:2:log:3").find("low:high:linear"), std::string::npos);
}

}  // namespace
}  // namespace kelpie::search_space_test
