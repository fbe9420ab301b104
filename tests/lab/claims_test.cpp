// SPDX-License-Identifier: Apache-2.0
#include "lab/claims.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include "lab/synthetic_reproduction.hpp"

namespace kelpie::claims_test {
namespace {

using synthetic::Made;

// The findings of the claims whose text has `part` in it, first study first.
std::vector<lab::ClaimState> findings(const Made& made, const std::string& part) {
  std::vector<lab::ClaimState> found;
  for (const lab::Claim& claim : lab::claims_of(synthetic::reproduction(made))) {
    if (claim.paper.find(part) != std::string::npos) {
      found.push_back(claim.finding);
    }
  }
  return found;
}

void expect(const Made& made, const std::string& part, lab::ClaimState finding) {
  const std::vector<lab::ClaimState> found = findings(made, part);
  ASSERT_FALSE(found.empty()) << part;
  for (const lab::ClaimState one : found) {
    EXPECT_EQ(lab::finding_text(one), lab::finding_text(finding)) << part;
  }
}

TEST(Claims, AllHoldWhereTheNumbersAreThePapers) {
  const std::vector<lab::Claim> claims = lab::claims_of(synthetic::reproduction());
  EXPECT_EQ(claims.size(), 22U);  // eleven of each of two streams
  for (const lab::Claim& claim : claims) {
    EXPECT_EQ(lab::finding_text(claim.finding), "holds") << claim.paper << ": " << claim.measured;
    EXPECT_NE(claim.measured, "");
    EXPECT_TRUE(std::ranges::any_of(claim.rule, [](unsigned char c) { return std::isdigit(c); }))
        << "a rule names its figures: " << claim.rule;
  }
}

TEST(Claims, EveryVerdictTurnsWithItsNumbers) {
  expect({.own = 0.94}, "its own configuration well", lab::ClaimState::fails);
  expect({.abroad = 0.93}, "does not describe the others", lab::ClaimState::fails);
  expect({.proposed = 0.94}, "the learner reaches", lab::ClaimState::fails);
  expect({.after_switch = 0.96}, "drops when", lab::ClaimState::fails);
  expect({.fifo_jitter = 0.015}, "FIFO is unstable", lab::ClaimState::in_part);
  expect({.fifo_jitter = 0.01}, "FIFO is unstable", lab::ClaimState::fails);
  expect({.proposed_jitter = 0.2}, "is stable", lab::ClaimState::in_part);
  expect({.proposed_jitter = 0.5}, "is stable", lab::ClaimState::fails);
  expect({.sosvr = 0.96}, "SOSVR is significantly", lab::ClaimState::in_part);
  expect({.sosvr = 0.98}, "SOSVR is significantly", lab::ClaimState::fails);
  expect({.paper = 0.5}, "Table I", lab::ClaimState::fails);
}

TEST(Claims, HalfOfTheCasesIsInPart) {
  lab::Reproduction result = synthetic::reproduction();
  for (lab::StreamStudy& study : result.studies) {
    for (lab::OfflineModel& model : study.offline[1].models) {
      model.r2 = {0.9, 0.9};  // sway: poor at home, and the same abroad
    }
  }
  const std::vector<lab::Claim> claims = lab::claims_of(result);
  EXPECT_EQ(lab::finding_text(claims.front().finding), "holds in part");
  EXPECT_NE(claims.front().measured.find("2 of 4"), std::string::npos) << claims.front().measured;
}

TEST(Claims, WhatWasNotPutToTheTestIsNotJudged) {
  expect({.forgotten = 0}, "FIFO is unstable", lab::ClaimState::not_judged);
  expect({.forgotten = 0}, "is stable", lab::ClaimState::not_judged);
  lab::Reproduction result = synthetic::reproduction();
  lab::StreamStudy& study = result.studies.front();
  study.configurations = {0};
  for (lab::OfflineMatrix& matrix : study.offline) {
    matrix.models = {{0, {}, 0.98, 4000, {0.98}}};
  }
  for (lab::ContenderRuns& runs : study.contenders) {
    for (auto& seed : runs.seeds) {
      for (study::AxisResult& axis : seed) {
        axis.stages.resize(1);
      }
    }
  }
  result.studies.resize(1);
  std::vector<std::string> not_judged;
  for (const lab::Claim& claim : lab::claims_of(result)) {
    if (claim.finding == lab::ClaimState::not_judged) {
      not_judged.push_back(claim.paper);
    }
  }
  EXPECT_EQ(not_judged, (std::vector<std::string>{
                            "A static model of one configuration does not describe the others.",
                            "Accuracy drops when the vehicle changes, and recovers.",
                            "SOSVR adapts to changed dynamics."}));
}

}  // namespace
}  // namespace kelpie::claims_test
