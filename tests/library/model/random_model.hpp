// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "kelpie/core/random.hpp"
#include "kelpie/model/trained_model.hpp"
#include "kelpie/motion/term_set.hpp"
#include "model/snapshot.hpp"

namespace kelpie::testing {

/// Terms of three inputs a, b, c that use all a formula can.
inline constexpr const char* kEveryFunction =
    "a*|b|; -a^2 + 2*b/(c^2 + 1); max(a, b) - min(b*c, 0); sign(a)*sqrt(abs(c) + 0.1);"
    "sin(a)*cos(b); tanh(a - c); tanh(0.1*a); (a^2 + 1)^1.5; b^5 - c^1 + a^0; 3; 1/(a - a)";

/// The values of these terms by hand, for any kind of number; the last is never finite: 0.
template <typename Number>
std::vector<Number> every_function(const Number& a, const Number& b, const Number& c) {
  using std::abs;
  using std::cos;
  using std::pow;
  using std::sin;
  using std::sqrt;
  using std::tanh;
  const Number zero(0.0 * a);
  const Number one(zero + 1.0);
  const Number greater = a < b ? b : a;
  const Number product(b * c);
  const Number less = product < zero ? product : zero;
  const Number root(sqrt(Number(abs(c) + 0.1)));
  return {Number(a * abs(b)),
          Number(-a * a + 2.0 * b / Number(c * c + one)),
          Number(greater - less),
          Number(a < zero ? Number(-root) : root),
          Number(sin(a) * cos(b)),
          Number(tanh(Number(a - c))),
          Number(tanh(Number(0.1 * a))),
          Number(pow(Number(a * a + one), 1.5)),
          Number(pow(b, 5.0) - c + one),
          Number(one * 3.0),
          zero};
}

struct ModelShape {
  std::vector<std::string> inputs{"a", "b", "c"};
  std::vector<std::string> targets{"x", "y", "z"};
  std::string terms = kEveryFunction;
  ScalingKind scaling = ScalingKind::full;
  std::size_t samples = 37;
};

inline AxisScaling random_scaling(RandomStream& random, const ModelShape& shape,
                                  std::size_t terms) {
  const std::size_t size = shape.inputs.size();
  AxisScaling scaling;
  scaling.input.mean = std::vector<double>(size);
  scaling.input.whitening = Matrix(size, size);
  for (std::size_t i = 0; i < size; ++i) {
    scaling.input.mean[i] = 0.3 * random.normal();
    for (std::size_t j = 0; shape.scaling == ScalingKind::full && j < i; ++j) {
      scaling.input.whitening(i, j) = 0.5 * random.normal();
    }
    scaling.input.whitening(i, i) = random.uniform(0.5, 2.0);
  }
  scaling.target = {random.normal(), random.uniform(0.1, 10.0)};
  for (std::size_t k = 0; k < terms; ++k) {
    scaling.term_scale.push_back(random.uniform(0.5, 5.0));
  }
  return scaling;
}

/// A function of this shape with random numbers.
inline SvrFunction random_function(RandomStream& random, const ModelShape& shape,
                                   std::size_t terms) {
  const KernelWeights weights{random.uniform(0.1, 1.0), random.uniform(0.0, 0.5), 0.1};
  SampleStore samples(shape.inputs.size() + terms, shape.samples);
  std::vector<double> sample(samples.dimension());
  std::vector<double> beta(shape.samples);
  for (double& value : beta) {
    for (double& coordinate : sample) {
      coordinate = random.normal();
    }
    samples.push_back(sample);
    value = 0.2 * random.normal();
  }
  SvrFunction function({random.uniform(0.05, 0.5), weights, shape.inputs.size(), terms},
                       shape.samples);
  function.assign(samples, beta, random.normal());
  return function;
}

/// Samples that nobody has seen.
inline KnownPlaces random_places(RandomStream& random, std::size_t inputs, std::size_t samples) {
  KnownPlaces known{SampleStore(inputs, samples), KernelDensity(inputs, samples, 0.7)};
  std::vector<double> z(inputs);
  for (std::size_t i = 0; i < samples; ++i) {
    for (double& coordinate : z) {
      coordinate = random.normal();
    }
    known.density.add(z, known.samples);
    known.samples.push_back(z);
  }
  return known;
}

/// A model of this shape with random numbers: a committee of two.
inline TrainedModel random_model(RandomStream& random, const ModelShape& shape) {
  const std::size_t axes = shape.targets.size();
  TrainedModel model{shape.inputs,
                     ModelSettings::from_preset("default", axes),
                     TermSet::from(shape.terms, shape.inputs, axes),
                     {}};
  model.settings.shared.terms = shape.terms;
  model.settings.shared.scaling = shape.scaling;
  const std::size_t terms = model.terms.size();
  for (const std::string& target : shape.targets) {
    FunctionMix mix{.members = {}, .limits = {.low = -1.0, .high = 2.0, .caution = 1.0}};
    for (const double share : {0.7, 0.3}) {
      mix.members.push_back(
          {share > 0.5 ? "learner" : "line", share, random_function(random, shape, terms)});
    }
    for (std::size_t k = 0; k < terms; ++k) {
      mix.term_ranges.push_back(
          {.low = -random.uniform(0.1, 1.0), .high = random.uniform(0.1, 1.0)});
      mix.nominal.push_back(0.3 * random.normal());
    }
    model.axes.push_back({target, random_scaling(random, shape, terms), std::move(mix), 1e-4, {}});
  }
  return model;
}

}  // namespace kelpie::testing
