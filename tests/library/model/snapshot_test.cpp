// SPDX-License-Identifier: Apache-2.0
// The Jacobian against automatic differentiation and against differences of predictions.
#include "model/snapshot.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <unsupported/Eigen/AutoDiff>

#include "allocation_count.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/model/trained_model.hpp"
#include "random_model.hpp"
#include "vehicle_stream.hpp"

namespace kelpie::snapshot_test {
namespace {

using testing::allocations;
using testing::Drive;
using testing::drive;
using testing::ModelShape;
using testing::random_model;

using Slopes = Eigen::AutoDiffScalar<Eigen::Vector3d>;
using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// What one member says, by the formulas of docs/reference/files.md.
Slopes by_formula(const SvrFunction& function, const std::array<Slopes, 3>& z,
                  const std::vector<Slopes>& terms) {
  const KernelWeights& weights = function.kernel().weights();
  Slopes sum(function.bias(), Eigen::Vector3d::Zero());
  for (std::size_t n = 0; n < function.beta().size(); ++n) {
    Slopes square(0.0, Eigen::Vector3d::Zero());
    for (std::size_t i = 0; i < 3; ++i) {
      const Slopes difference = z[i] - function.support_vectors().coordinate(i)[n];
      square += difference * difference;
    }
    const Slopes exponent = -function.kernel().local().gamma() * square;
    const Slopes wide = exponent * 32.0;
    sum += function.beta()[n] * (weights.s * exp(exponent) + weights.fine * exp(wide));
  }
  for (std::size_t k = 0; k < terms.size(); ++k) {
    sum += function.term_weights()[k] * terms[k];
  }
  return sum;
}

Slopes scaled_term(const TrainedModel::Axis& axis, const std::array<Slopes, 3>& raw,
                   std::size_t k) {
  return testing::every_function(raw[0], raw[1], raw[2])[k] / axis.scaling.term_scale[k];
}

// Within their ranges.
std::vector<Slopes> terms_of(const TrainedModel::Axis& axis, const std::array<Slopes, 3>& raw) {
  const std::vector<double>& term_scale = axis.scaling.term_scale;
  std::vector<Slopes> terms;
  for (std::size_t k = 0; k < term_scale.size(); ++k) {
    const auto [low, high] = axis.function.term_ranges[k];
    const Slopes free = scaled_term(axis, raw, k);
    const bool inside = free.value() > low && free.value() < high;
    terms.push_back(inside ? free
                           : Slopes(std::clamp(free.value(), low, high), Eigen::Vector3d::Zero()));
  }
  return terms;
}

// Value and gradient of an axis by the formula of reference/files.md, from what the model
// publishes.
// The value of the mix from the members' values.
Slopes with_caution(const FunctionMix& mix, const std::vector<Slopes>& values) {
  Slopes mean(0.0, Eigen::Vector3d::Zero());
  Slopes others = mean;
  double shares = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    mean += mix.members[k].share * values[k];
    if (k + 1 < values.size()) {
      others += mix.members[k].share * values[k];
      shares += mix.members[k].share;
    }
  }
  if (!(shares > 0.0)) {
    return mean;
  }
  others /= shares;
  Slopes variance(0.0, Eigen::Vector3d::Zero());
  for (std::size_t k = 0; k + 1 < values.size(); ++k) {
    const Slopes apart = values[k] - others;
    variance += mix.members[k].share / shares * apart * apart;
  }
  const Slopes g = mean - values.back();
  const Slopes spread = mix.limits.caution * variance;
  return mean - g * spread / (g * g + 1.0 + spread);
}

Slopes by_automatic_differentiation(const TrainedModel::Axis& axis, const std::vector<double>& x) {
  std::array<Slopes, 3> raw;
  for (int i = 0; i < 3; ++i) {
    raw[static_cast<std::size_t>(i)] = Slopes(x[static_cast<std::size_t>(i)], 3, i);
  }
  std::array<Slopes, 3> z;
  for (std::size_t i = 0; i < 3; ++i) {
    Slopes& value = z[i];
    value = Slopes(0.0, Eigen::Vector3d::Zero());
    for (std::size_t j = 0; j <= i; ++j) {
      value += axis.scaling.input.whitening(i, j) * (raw[j] - axis.scaling.input.mean[j]);
    }
  }
  const Limits& limits = axis.function.limits;
  const std::vector<Slopes> terms = terms_of(axis, raw);
  std::vector<Slopes> values;
  for (const auto& [name, share, function] : axis.function.members) {
    const Slopes free = by_formula(function, z, terms);
    const bool inside = free.value() > limits.low && free.value() < limits.high;
    values.push_back(inside ? free
                            : Slopes(std::clamp(free.value(), limits.low, limits.high),
                                     Eigen::Vector3d::Zero()));
  }
  Slopes total = with_caution(axis.function, values);
  for (std::size_t k = 0; k < axis.function.nominal.size(); ++k) {
    total += axis.function.nominal[k] * scaled_term(axis, raw, k);
  }
  return axis.scaling.target.mean + axis.scaling.target.scale * total;
}

std::vector<double> random_input(RandomStream& random) {
  return {random.normal(), random.normal(), random.normal()};
}

RC_GTEST_PROP(AxisGradient, IsThatOfAutomaticDifferentiation,
              (std::uint64_t seed, bool full, bool terms)) {
  RandomStream random(seed, "automatic");
  ModelShape shape;
  shape.scaling = full ? ScalingKind::full : ScalingKind::diagonal;
  shape.terms = terms ? shape.terms : "none";
  const TrainedModel model = random_model(random, shape);
  const std::vector<double> x = random_input(random);
  std::vector<double> y(3);
  Jacobian jacobian(3, 3);
  model.predict_with_jacobian(x, y, {jacobian.data(), 9});
  std::vector<double> predicted(3);
  model.predict(x, predicted);
  for (std::size_t i = 0; i < 3; ++i) {
    const Slopes exact = by_automatic_differentiation(model.axes[i], x);
    const double size = 1.0 + std::abs(exact.value()) + exact.derivatives().norm();
    RC_ASSERT(std::abs(y[i] - predicted[i]) <= 1e-12 * size);
    RC_ASSERT(std::abs(y[i] - exact.value()) <= 1e-11 * size);
    const Eigen::Vector3d found = jacobian.row(static_cast<Eigen::Index>(i));
    RC_ASSERT((found - exact.derivatives()).norm() <= 1e-11 * size);
  }
}

// Central differences of all axes by input j.
template <typename Model>
std::vector<double> differences(const Model& model, const std::vector<double>& x, std::size_t axes,
                                std::size_t j, double step) {
  std::vector<double> moved = x;
  std::vector<double> above(axes);
  std::vector<double> below(axes);
  moved[j] = x[j] + step;
  model.predict(moved, above);
  moved[j] = x[j] - step;
  model.predict(moved, below);
  for (std::size_t i = 0; i < axes; ++i) {
    above[i] = (above[i] - below[i]) / (2.0 * step);
  }
  return above;
}

constexpr double kDifference = 1e-5;

// The largest relative deviation of a Jacobian from central differences.
template <typename Model>
double off_differences(const Model& model, const std::vector<double>& x, std::size_t axes,
                       const std::vector<double>& scale) {
  const std::size_t inputs = x.size();
  std::vector<double> y(axes);
  std::vector<double> jacobian(axes * inputs);
  model.predict_with_jacobian(x, y, jacobian);
  double worst = 0.0;
  for (std::size_t j = 0; j < inputs; ++j) {
    const std::vector<double> slopes = differences(model, x, axes, j, kDifference * scale[j]);
    for (std::size_t i = 0; i < axes; ++i) {
      double largest = 0.0;
      for (std::size_t k = 0; k < inputs; ++k) {
        largest = std::max(largest, std::abs(jacobian[i * inputs + k]) * scale[k]);
      }
      worst = std::max(worst, std::abs(jacobian[i * inputs + j] - slopes[i]) * scale[j] / largest);
    }
  }
  return worst;
}

// Limits of predictions and ranges of terms are kinks at random places: within a step of a kink
// differences depend on the step.
bool is_near_kink(const TrainedModel& model, const std::vector<double>& x) {
  for (std::size_t j = 0; j < x.size(); ++j) {
    const std::vector<double> wide = differences(model, x, 3, j, kDifference);
    const std::vector<double> narrow = differences(model, x, 3, j, 0.5 * kDifference);
    for (std::size_t i = 0; i < wide.size(); ++i) {
      if (std::abs(wide[i] - narrow[i]) > 1e-7 * (1e-3 + std::abs(wide[i]))) {
        return true;
      }
    }
  }
  return false;
}

RC_GTEST_PROP(AxisGradient, IsThatOfCentralDifferences, (std::uint64_t seed, bool full)) {
  RandomStream random(seed, "differences");
  ModelShape shape;
  shape.scaling = full ? ScalingKind::full : ScalingKind::diagonal;
  const TrainedModel model = random_model(random, shape);
  const std::vector<double> x = random_input(random);
  RC_PRE(std::min({std::abs(x[0]), std::abs(x[1]), std::abs(x[2]), std::abs(x[0] - x[1])}) > 1e-3);
  RC_PRE(!is_near_kink(model, x));
  RC_ASSERT(off_differences(model, x, 3, {1.0, 1.0, 1.0}) < 1e-6);
}

ModelSettings settings(const char* scaling) {
  ModelSettings values = ModelSettings::from_preset("default", 2);
  values.shared.warmup = 50;
  values.assign("scaling", scaling);
  values.assign("terms", "speed*|speed|; thrust*|thrust|; speed");
  return values;
}

void learn(DynamicsModel& model, const Drive& samples, std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last; ++i) {
    model.update(samples.x[i], samples.y[i], 0.1 * static_cast<double>(i));
  }
}

// Inputs of sizes 0.4 and 800: the chain rule has to carry their units.
TEST(AxisGradient, OfALearnedModelIsInTheLogsUnits) {
  const Drive samples = drive(1, 600);
  for (const char* const scaling : {"full", "diagonal"}) {
    DynamicsModel model(samples.inputs, samples.targets, settings(scaling));
    learn(model, samples, 0, samples.x.size());
    const TrainedModel trained = model.trained();
    for (std::size_t i = 0; i < samples.x.size(); i += 20) {
      ASSERT_LT(off_differences(model, samples.x[i], 2, {0.4, 800.0}), 1e-6) << scaling << i;
      std::array<double, 2> y{};
      std::array<double, 4> learned{};
      std::array<double, 4> kept{};
      model.predict_with_jacobian(samples.x[i], y, learned);
      trained.predict_with_jacobian(samples.x[i], y, kept);
      ASSERT_EQ(learned, kept);
    }
  }
}

TEST(AxisGradient, BeforeThereIsAModelIsZeroBesideTheMean) {
  const Drive samples = drive(2, 60);
  DynamicsModel model(samples.inputs, samples.targets, settings("diagonal"));
  std::array<double, 2> y{};
  std::array<double, 2> mean{};
  std::array<double, 4> jacobian{1.0, 1.0, 1.0, 1.0};
  const std::array<double, 4> zeros{};
  learn(model, samples, 0, 9);
  model.predict_with_jacobian(samples.x[50], y, jacobian);
  model.predict(samples.x[50], mean);
  EXPECT_EQ(y, mean);
  EXPECT_EQ(jacobian, zeros);
  learn(model, samples, 9, 60);
  model.predict_with_jacobian(samples.x[50], y, jacobian);
  EXPECT_NE(jacobian[0], 0.0);
}

// Finite everywhere, also where a term or its slope has no bound.
TEST(AxisGradient, ATermWithoutABoundAddsNothing) {
  RandomStream random(3, "bound");
  ModelShape shape;
  const TrainedModel plain = [&] {
    RandomStream same(3, "bound");
    shape.terms = "0; 0; b";
    return random_model(same, shape);
  }();
  shape.terms = "1/a; sqrt(a); b";
  const TrainedModel model = random_model(random, shape);
  const std::vector<double> x{0.0, 0.5, -1.0};
  std::array<double, 3> y{};
  std::array<double, 9> found{};
  std::array<double, 9> wanted{};
  plain.predict_with_jacobian(x, y, wanted);
  model.predict_with_jacobian(x, y, found);
  EXPECT_EQ(found, wanted);
  EXPECT_TRUE(std::ranges::all_of(found, [](double slope) { return std::isfinite(slope); }));
}

TEST(AxisGradient, AllocatesNothing) {
  KELPIE_NEEDS_ALLOCATION_COUNT();
  const Drive samples = drive(4, 200);
  DynamicsModel model(samples.inputs, samples.targets, settings("full"));
  std::array<double, 2> y{};
  std::array<double, 4> jacobian{};
  learn(model, samples, 0, 20);
  std::size_t before = allocations;
  model.predict_with_jacobian(samples.x[0], y, jacobian);
  EXPECT_EQ(allocations - before, 0U);
  learn(model, samples, 20, 200);
  const TrainedModel trained = model.trained();
  before = allocations;
  model.predict_with_jacobian(samples.x[0], y, jacobian);
  trained.predict_with_jacobian(samples.x[1], y, jacobian);
  EXPECT_EQ(allocations - before, 0U);
}

}  // namespace
}  // namespace kelpie::snapshot_test
