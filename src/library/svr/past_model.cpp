// SPDX-License-Identifier: Apache-2.0
#include "svr/past_model.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace kelpie {

void PastModelInfo::visit(Archive& archive) {
  archive.whole(number);
  archive.number(from_s);
  archive.number(until_s);
  archive.whole(samples);
  archive.whole(recalls);
  archive.whole(earlier);
  archive.number(usual_error);
  archive.require(usual_error > 0.0, "has a usual error that isn't above 0");
}

PastModel::PastModel(const MixedKernel& kernel, std::size_t places)
    : samples(kernel.dimension(), places),
      targets(places),
      times_s(places),
      function(kernel, places) {}

std::size_t PastModel::bytes(std::size_t inputs, std::size_t terms, std::size_t places) {
  return sizeof(PastModel) + SampleStore::bytes(inputs + terms, places) +
         2 * places * sizeof(double) + SvrFunction::bytes(inputs, terms, places);
}

void PastModel::keep(const SampleCollector& buffer, const SvrFunction& model,
                     const PastModelInfo& about) {
  info = about;
  samples = buffer.samples();  // equal in size, so that nothing is allocated
  std::ranges::copy(buffer.problem().targets(), targets.begin());
  for (std::size_t i = 0; i < size(); ++i) {
    times_s[i] = buffer.time(i);
  }
  function = model;
}

void PastModel::keep(const SvrFunction& function_of, const OnlineSvrSettings& settings,
                     const Completion& complete) {
  std::vector<double> z(samples.dimension());
  const SampleStore& vectors = function_of.support_vectors();
  samples.clear();
  for (std::size_t i = 0; i < std::min(vectors.size(), samples.capacity() - 1); ++i) {
    vectors.get(i, std::span(z).first(vectors.dimension()));
    complete(z);
    const double beta = function_of.beta()[i];
    const bool bound = std::abs(beta) >= (1.0 - 1e-9) * settings.c;
    const double off = std::copysign(bound ? 2.0 * settings.epsilon : settings.epsilon, beta);
    targets[i] = function_of(z) + settings.effective_ridge() * beta + off;
    times_s[i] = 0.0;
    samples.push_back(z);
  }
}

double PastModel::latest_s() const {
  const std::span<const double> times = std::span(times_s).first(size());
  return times.empty() ? 0.0 : *std::ranges::max_element(times);
}

void PastModel::visit(Archive& archive) {
  archive.part("info", info);
  archive.part("samples", samples);
  archive.numbers(std::span(targets).first(size()));
  archive.numbers(std::span(times_s).first(size()));
  archive.part("function", function);
}

}  // namespace kelpie
