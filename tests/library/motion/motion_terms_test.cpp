// SPDX-License-Identifier: Apache-2.0
#include "motion/motion_terms.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "kelpie/core/random.hpp"
#include "kelpie/motion/expression.hpp"

namespace kelpie::motion_terms_test {
namespace {

const std::vector<std::string> kNames{"u", "v", "r", "th1", "th 2"};
const std::vector<std::size_t> kVelocities{0, 1, 2};

std::vector<MotionTerms> all_structures() {
  return {MotionTerms::linear(5),
          MotionTerms::quadratic(5, 3),
          MotionTerms::quadratic(5, 1, {.roll = 1, .pitch = 2, .roll_unit = 0.3}),
          MotionTerms::quadratic(5, 1, {.pitch = 4, .pitch_unit = 0.3}),
          MotionTerms::quadratic(5, 1, {.quaternion = std::array<std::size_t, 4>{2, 3, 1, 4}}),
          MotionTerms::fossen(5, kVelocities, false, false),
          MotionTerms::open_loop(5, kVelocities, 64, {.roll = 4}),
          MotionTerms::diagnosis(5, kVelocities),
          MotionTerms::planar(2),
          MotionTerms::alignment(5, kVelocities),
          MotionTerms::baseline(5, 3)};
}

TEST(MotionTerms, ATermAndItsFormulaHaveTheSameBits) {
  RandomStream random(1, "motion terms");
  for (const MotionTerms& terms : all_structures()) {
    const std::vector<std::string> texts = terms.texts(kNames);
    std::vector<double> values(terms.size());
    for (int i = 0; i < 50; ++i) {
      std::vector<double> x(kNames.size());
      for (double& value : x) {
        value = 3.0 * random.normal();
      }
      terms.evaluate(x, values);
      for (std::size_t k = 0; k < terms.size(); ++k) {
        EXPECT_EQ(values[k], Expression::parse(texts[k], kNames)(x)) << texts[k];
      }
    }
  }
}

TEST(MotionTerms, NoStructureHasATermTwice) {
  for (const MotionTerms& terms : all_structures()) {
    for (std::size_t k = 0; k < terms.size(); ++k) {
      EXPECT_EQ(terms.find(terms[k]), k);
    }
  }
}

TEST(MotionTerms, ATermKnowsItsVelocitiesAndCommands) {
  const MotionTerm cross_flow{TermForm::cross_flow, 0, 1};
  EXPECT_TRUE(cross_flow.depends_on(1));
  EXPECT_TRUE(cross_flow.damps(0));
  EXPECT_FALSE(cross_flow.damps(1));
  EXPECT_EQ(cross_flow.degree(1), 1);
  EXPECT_EQ((MotionTerm{TermForm::square_law, 2}).degree(2), 2);
  EXPECT_FALSE(MotionTerm{}.depends_on(0));
  EXPECT_EQ(MotionTerms::planar(2).commands(), (std::vector<std::size_t>{3, 4}));
}

}  // namespace
}  // namespace kelpie::motion_terms_test
