// SPDX-License-Identifier: Apache-2.0
#include "kelpie/motion/term_set.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"

namespace kelpie::term_set_test {
namespace {

const std::vector<std::string> kPlanar{"u", "v", "r", "th1", "th 2"};

std::vector<std::string> texts(const TermSet& set) {
  std::vector<std::string> list;
  for (std::size_t k = 0; k < set.size(); ++k) {
    list.push_back(set.text(k));
  }
  return list;
}

TEST(TermSet, FossensPlanarTerms) {
  const TermSet set = TermSet::from("fossen", kPlanar, 3);
  EXPECT_EQ(texts(set),
            (std::vector<std::string>{"u", "v", "r", "u*|u|", "v*|v|", "r*|r|", "u*v", "u*r", "v*r",
                                      "r^2", "max(th1,0)^2", "-min(th1,0)^2", "max('th 2',0)^2",
                                      "-min('th 2',0)^2"}));
  std::vector<double> values(set.size());
  set.evaluate(std::vector{0.5, -2.0, 3.0, -4.0, 5.0}, values);
  EXPECT_EQ(values, (std::vector<double>{0.5, -2.0, 3.0, 0.25, -4.0, 9.0, -1.0, 1.5, -6.0, 9.0, 0.0,
                                         -16.0, 25.0, 0.0}));
}

TEST(TermSet, OtherSets) {
  EXPECT_EQ(TermSet::from("none", kPlanar, 3).size(), 0U);
  EXPECT_EQ(texts(TermSet::from(" linear ", kPlanar, 3)),
            (std::vector<std::string>{"u", "v", "r", "th1", "'th 2'"}));
  EXPECT_EQ(texts(TermSet::from("u*r; th1*|th1| ; max(th1,0)^2", kPlanar, 3)),
            (std::vector<std::string>{"u*r", "th1*|th1|", "max(th1,0)^2"}));
  const std::vector<std::string> six{"u", "v", "w", "p", "q", "r", "n"};
  EXPECT_EQ(TermSet::from("6dof", six, 6).size(), 6U + 6U + 15U + 6U + 2U);
}

// Names help to say which products come first, and change nothing else.
TEST(TermSet, AutoIsQuadraticInAllInputsWhateverTheirNames) {
  const std::vector<std::string> known{"u", "v", "n"};
  const TermSet by_name = TermSet::from("auto", known, 2);
  EXPECT_EQ(texts(by_name), (std::vector<std::string>{"u", "v", "n", "u*|u|", "v*|v|", "n*|n|",
                                                      "u*v", "u*n", "v*n"}));
  EXPECT_EQ(by_name.without_products(), 7U);
  const std::vector<std::string> unknown{"a", "b", "n"};
  const TermSet without = TermSet::from("auto", unknown, 2);
  EXPECT_EQ(without.size(), by_name.size());
  EXPECT_EQ(without.without_products(), 6U);
  EXPECT_EQ(texts(without), texts(TermSet::from("quadratic", unknown, 2)));
}

TEST(TermSet, AutoLeavesOutProductsWhereThereWouldBeTooMany) {
  std::vector<std::string> many{"u", "v", "r"};
  while (many.size() < 64) {
    many.push_back("n" + std::to_string(many.size()));
  }
  EXPECT_EQ(TermSet::from("auto", std::span(many).first(20), 3).size(), 43U);
  EXPECT_EQ(TermSet::from("auto", std::vector(many.begin() + 3, many.end()), 3).size(), 122U);
}

TEST(TermSet, RefusesWhatMakesNoSense) {
  EXPECT_THROW(TermSet::from("fosen", kPlanar, 3), InputError);  // read as a column
  EXPECT_THROW(TermSet::from("6dof", kPlanar, 3), InputError);
  EXPECT_THROW(TermSet::from("fossen", kPlanar, 9), InputError);
  EXPECT_THROW(TermSet::from("u*r;;v", kPlanar, 3), InputError);
  std::string many = "u";
  for (int i = 0; i < kMostTerms; ++i) {
    many += ";u";
  }
  EXPECT_THROW(TermSet::from(many, kPlanar, 3), InputError);
}

TEST(TermSet, PowersOfAnInput) {
  const std::vector<std::string> inputs{"u", "n"};
  const TermSet set =
      TermSet::from("u; n*|n|; u*|u|*n; min(n,0)^2; sin(n); n + u; n^0.5", inputs, 1);
  const std::vector<double> powers{0.0, 2.0, 1.0, 2.0};
  for (std::size_t k = 0; k < powers.size(); ++k) {
    EXPECT_NEAR(set.power(k, 1), powers[k], 1e-12) << set.text(k);
  }
  for (std::size_t k = powers.size(); k < set.size(); ++k) {
    EXPECT_FALSE(std::isfinite(set.power(k, 1))) << set.text(k);
  }
}

// A thruster that has only run ahead gives its astern term no values to be scaled by.
TEST(TermSet, ATermNotSeenYetHasASensibleScale) {
  const TermSet set = TermSet::from("u;max(th1,0)^2;-min(th1,0)^2;0*u", kPlanar, 3);
  RandomStream random(1, "terms");
  Moments inputs(kPlanar.size());
  Moments terms(set.size());
  std::vector<double> values(set.size());
  for (int i = 0; i < 500; ++i) {
    const std::vector<double> x{random.normal(), 0.0, 0.0, 50.0 * std::abs(random.normal()), 0.0};
    inputs.add(x);
    set.evaluate(x, values);
    terms.add(values);
  }
  std::vector<double> scale(set.size());
  set.scales(inputs, terms, scale);
  EXPECT_NEAR(scale[0], 1.0, 0.1);
  EXPECT_GT(scale[1], 2000.0);
  EXPECT_NEAR(scale[2], 2500.0, 300.0);
  EXPECT_EQ(scale[3], 1.0);
}

TEST(TermSet, ASampleIsItsInputsThenItsTerms) {
  const TermSet set = TermSet::from("u*v;1/(u-2)", kPlanar, 3);
  AxisScaling scaling{{std::vector<double>(5, 1.0), Matrix(5, 5)}, {}, {4.0, 1.0}};
  for (std::size_t i = 0; i < 5; ++i) {
    scaling.input.whitening(i, i) = 2.0;
  }
  const ScaledSample sample = scale_sample(scaling, set, std::vector{2.0, 3.0, 4.0, 5.0, 6.0});
  ASSERT_EQ(sample.size(), 7U);
  EXPECT_EQ(sample[0], 2.0);
  EXPECT_EQ(sample[4], 10.0);
  EXPECT_EQ(sample[5], 1.5);
  EXPECT_EQ(sample[6], 0.0);  // not finite here
}

}  // namespace
}  // namespace kelpie::term_set_test
