// SPDX-License-Identifier: Apache-2.0
#include "kelpie/report/claims.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

#include "synthetic_reproduction.hpp"

namespace kelpie::claims_test {
namespace {

using synthetic::Made;

// The findings of the claims whose text has `part` in it, first study first.
std::vector<Finding> findings(const Made& made, const std::string& part) {
  std::vector<Finding> found;
  for (const Claim& claim : claims_of(synthetic::reproduction(made))) {
    if (claim.paper.find(part) != std::string::npos) {
      found.push_back(claim.finding);
    }
  }
  return found;
}

void expect(const Made& made, const std::string& part, Finding finding) {
  const std::vector<Finding> found = findings(made, part);
  ASSERT_FALSE(found.empty()) << part;
  for (const Finding one : found) {
    EXPECT_EQ(finding_text(one), finding_text(finding)) << part;
  }
}

TEST(Claims, AllHoldWhereTheNumbersAreThePapers) {
  for (const Claim& claim : claims_of(synthetic::reproduction())) {
    EXPECT_EQ(finding_text(claim.finding), "holds") << claim.paper << ": " << claim.measured;
    EXPECT_NE(claim.measured, "");
    EXPECT_TRUE(std::ranges::any_of(claim.rule, [](unsigned char c) { return std::isdigit(c); }))
        << "a rule names its figures: " << claim.rule;
  }
}

TEST(Claims, EveryVerdictTurnsWithItsNumbers) {
  expect({.own = 0.94}, "its own configuration well", Finding::fails);
  expect({.abroad = 0.93}, "does not describe the others", Finding::fails);
  expect({.proposed = 0.94}, "the learner reaches", Finding::fails);
  expect({.after_switch = 0.96}, "drops when", Finding::fails);
  expect({.fifo_jitter = 0.015}, "FIFO is unstable", Finding::in_part);
  expect({.fifo_jitter = 0.01}, "FIFO is unstable", Finding::fails);
  expect({.proposed_jitter = 0.2}, "is stable", Finding::in_part);
  expect({.proposed_jitter = 0.5}, "is stable", Finding::fails);
  expect({.sosvr = 0.96}, "SOSVR is significantly", Finding::in_part);
  expect({.sosvr = 0.98}, "SOSVR is significantly", Finding::fails);
  expect({.paper = 0.5}, "Table I", Finding::fails);
}

TEST(Claims, HalfOfTheCasesIsInPart) {
  Reproduction result = synthetic::reproduction();
  for (StreamStudy& study : result.studies) {
    for (OfflineModel& model : study.offline[1].models) {
      model.r2 = {0.9, 0.9};  // sway: poor at home, and the same abroad
    }
  }
  const std::vector<Claim> claims = claims_of(result);
  EXPECT_EQ(finding_text(claims.front().finding), "holds in part");
  EXPECT_NE(claims.front().measured.find("2 of 4"), std::string::npos) << claims.front().measured;
}

TEST(Claims, WhatWasNotPutToTheTestIsNotJudged) {
  expect({.forgotten = 0}, "FIFO is unstable", Finding::not_judged);
  expect({.forgotten = 0}, "is stable", Finding::not_judged);
  Reproduction result = synthetic::reproduction();
  StreamStudy& study = result.studies.front();
  study.configurations = {0};
  for (OfflineMatrix& matrix : study.offline) {
    matrix.models = {{0, {}, 0.98, 4000, {0.98}}};
  }
  for (ContenderRuns& runs : study.contenders) {
    for (auto& seed : runs.seeds) {
      for (AxisResult& axis : seed) {
        axis.stages.resize(1);
      }
    }
  }
  result.studies.resize(1);
  for (const Claim& claim : claims_of(result)) {
    if (claim.paper.find("others") != std::string::npos ||
        claim.paper.find("drops") != std::string::npos ||
        claim.paper.find("SOSVR adapts") != std::string::npos) {
      EXPECT_EQ(finding_text(claim.finding), "could not be judged") << claim.paper;
    }
  }
}

}  // namespace
}  // namespace kelpie::claims_test
