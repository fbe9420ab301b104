// SPDX-License-Identifier: Apache-2.0
#include "model/errors_by_effect.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kelpie/core/random.hpp"

namespace kelpie::errors_by_effect_test {
namespace {

// A calm vehicle of noise 0.1 that manoeuvres in one row of ten, with effects of 1 to 10; the model
// has errors of a share of the effects besides.
ErrorsByEffect after_a_drive(double share) {
  RandomStream random(1, "errors");
  ErrorsByEffect errors;
  for (int i = 0; i < 20'000; ++i) {
    const double effect = i % 10 == 0 ? random.uniform(1.0, 10.0) : 0.05;
    const double error = 0.1 * random.normal() + share * effect * random.normal();
    errors.add_with(error, effect);
    if (i % 4 == 1) {
      errors.add(error);
    }
  }
  return errors;
}

TEST(ErrorsByEffect, AManoeuvreHasTheErrorsOfManoeuvres) {
  const ErrorsByEffect errors = after_a_drive(0.2);
  EXPECT_NEAR(errors.value(), 0.1, 0.02);
  EXPECT_NEAR(errors.ratio(0.05), 1.0, 0.2);
  EXPECT_NEAR(errors.ratio(4.0) * errors.value(), 0.2 * 4.0, 0.3);
  EXPECT_NEAR(errors.ratio(9.0) * errors.value(), 0.2 * 8.0, 0.6);
}

TEST(ErrorsByEffect, ErrorsOfOneSizeHaveOneSizeEverywhere) {
  const ErrorsByEffect errors = after_a_drive(0.0);
  for (const double effect : {0.01, 0.5, 2.0, 9.0}) {
    EXPECT_NEAR(errors.ratio(effect), 1.0, 0.25) << effect;
  }
}

TEST(ErrorsByEffect, LargerEffectsThanAllBeforeHaveErrorsInProportion) {
  const ErrorsByEffect errors = after_a_drive(0.2);
  EXPECT_NEAR(errors.ratio(40.0) / errors.ratio(9.0), 2.0, 1e-9);  // two octaves, the last is open
  ErrorsByEffect unknown;
  EXPECT_EQ(unknown.ratio(3.0), 1.0);
}

}  // namespace
}  // namespace kelpie::errors_by_effect_test
