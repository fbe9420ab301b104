// SPDX-License-Identifier: Apache-2.0
#include "lab/claims.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "lab/reproduction_report.hpp"
#include "lab/synthetic_reproduction.hpp"

namespace kelpie::claims_test {
namespace {

using synthetic::Made;

lab::Judgement lab::Claim::*const kPaper = &lab::Claim::paper;
lab::Judgement lab::Claim::*const kKelpie = &lab::Claim::kelpie;

std::vector<lab::Claim> claims(const lab::Reproduction& result) {
  return lab::claims_of(lab::reproduction_document(result));
}

// Every verdict for `who` on the claims whose text has `part` in it.
void expect(const Made& made, const std::string& part, lab::ClaimState finding,
            lab::Judgement lab::Claim::*who = kPaper) {
  std::size_t found = 0;
  for (const lab::Claim& claim : claims(synthetic::reproduction(made))) {
    if (claim.text.find(part) != std::string::npos) {
      EXPECT_EQ(lab::finding_text((claim.*who).finding), lab::finding_text(finding)) << part;
      ++found;
    }
  }
  EXPECT_GT(found, 0U) << part;
}

TEST(Claims, AllHoldWhereTheNumbersAreThePapers) {
  const std::vector<lab::Claim> found = claims(synthetic::reproduction());
  EXPECT_EQ(found.size(), 26U);  // thirteen of each of two streams
  for (const lab::Claim& claim : found) {
    EXPECT_EQ(lab::finding_text(claim.paper.finding), "holds")
        << claim.text << ": " << claim.paper.measured;
    EXPECT_NE(claim.paper.measured, "");
    if (!claim.kelpie.measured.empty()) {
      EXPECT_EQ(lab::finding_text(claim.kelpie.finding), "holds") << claim.text;
    }
  }
}

TEST(Claims, EveryVerdictTurnsWithItsNumbers) {
  using enum lab::ClaimState;
  expect({.own = 0.94}, "its own configuration well", fails);
  expect({.abroad = 0.93}, "does not describe the others", fails);
  expect({.paper = 0.94}, "the learner reaches", fails);
  expect({.after_switch = 0.96}, "drops when", fails);
  expect({.fifo_jitter = 0.015}, "FIFO is unstable", in_part);
  expect({.fifo_jitter = 0.01}, "FIFO is unstable", fails);
  expect({.paper_jitter = 0.2}, "is stable", in_part);
  expect({.paper_jitter = 0.5}, "is stable", fails);
  expect({.sosvr = 0.96}, "SOSVR is significantly", in_part);
  expect({.sosvr = 0.98}, "SOSVR is significantly", fails);
  expect({.table = 0.5}, "Table I", fails);
  // What holds for kelpie follows from kelpie's numbers alone, and the other way round.
  expect({.kelpie = 0.94}, "the learner reaches", fails, kKelpie);
  expect({.kelpie = 0.94}, "the learner reaches", holds, kPaper);
  expect({.paper = 0.94}, "the learner reaches", holds, kKelpie);
  expect({}, "its own configuration well", not_judged, kKelpie);  // of no row of kelpie's
}

TEST(Claims, HalfOfTheCasesIsInPart) {
  lab::Reproduction result = synthetic::reproduction();
  for (lab::StreamStudy& study : result.studies) {
    for (lab::OfflineModel& model : study.offline[1].models) {
      model.r2 = {0.9, 0.9};  // sway: poor at home, and the same abroad
    }
  }
  const std::vector<lab::Claim> found = claims(result);
  EXPECT_EQ(lab::finding_text(found.front().paper.finding), "holds in part");
  EXPECT_NE(found.front().paper.measured.find("2 of 4"), std::string::npos);
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
  for (lab::RowRuns& runs : study.rows) {
    for (lab::SeedRun& seed : runs.seeds) {
      for (study::AxisResult& axis : seed.axes) {
        axis.stages.resize(1);
      }
    }
  }
  result.studies.resize(1);
  std::vector<std::string> not_judged;
  for (const lab::Claim& claim : claims(result)) {
    if (claim.paper.finding == lab::ClaimState::not_judged) {
      not_judged.push_back(claim.text);
    }
  }
  EXPECT_EQ(not_judged, (std::vector<std::string>{
                            "A static model of one configuration does not describe the others.",
                            "Accuracy drops when the vehicle changes, and recovers.",
                            "SOSVR adapts to changed dynamics."}));
}

}  // namespace
}  // namespace kelpie::claims_test
