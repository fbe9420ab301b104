// SPDX-License-Identifier: Apache-2.0
#include "svr/sample_collector.hpp"

#include <algorithm>

namespace kelpie {
namespace {

double bandwidth(std::size_t inputs, const OnlineSvrSettings& settings) {
  return settings.bandwidth > 0.0
             ? settings.bandwidth
             : KernelDensity::scott(inputs, static_cast<std::size_t>(settings.buffer));
}

}  // namespace

SampleCollector::SampleCollector(std::size_t inputs, std::size_t terms,
                                 const OnlineSvrSettings& settings)
    : kernel_(settings.gamma, {.fine = settings.fine, .lambda = settings.lambda}, inputs, terms),
      samples_(kernel_.dimension(), settings.places()),
      problem_(settings.places(), settings.epsilon, settings.c, settings.storage),
      ridge_(settings.effective_ridge()),
      density_(inputs, settings.places(), bandwidth(inputs, settings)),
      time_(settings.places()),
      arrival_(settings.places()),
      similarity_(settings.places()),
      row_(settings.places()) {}

std::size_t SampleCollector::bytes(std::size_t inputs, std::size_t terms,
                                   const OnlineSvrSettings& settings) {
  const std::size_t places = settings.places();
  return SampleStore::bytes(inputs + terms, places) + DualProblem::bytes(places, settings.storage) +
         KernelDensity::bytes(inputs, places) +
         places * (3 * sizeof(double) + sizeof(std::uint64_t));
}

void SampleCollector::compare(std::span<const double> x) {
  kernel_.similarity(x, samples_, similarity_);
  kernel_.row(x, samples_, similarity_, row_);
}

void SampleCollector::collect(std::span<const double> x, double y, double t) {
  const std::size_t i = size();
  density_.add(kernel_.inputs_of(x), samples_);
  problem_.add(row(), kernel_.self(x) + ridge_, y);
  samples_.push_back(x);
  time_[i] = t;
  arrival_[i] = next_arrival_++;
}

void SampleCollector::clear() {
  density_.clear();
  problem_.clear();
  samples_.clear();
  next_arrival_ = 0;
}

void SampleCollector::visit(Archive& archive) {
  archive.part("samples", samples_);
  archive.part("problem", problem_);
  archive.require(problem_.size() == size(), "has more or fewer weights than samples");
  archive.part("density", density_, size());
  archive.numbers(std::span(time_).first(size()));
  for (std::uint64_t& arrival : std::span(arrival_).first(size())) {
    archive.whole(arrival);
  }
  archive.whole(next_arrival_);
}

void SampleCollector::remove(std::size_t i) {
  density_.remove(i, samples_);
  problem_.remove(i);
  samples_.remove(i);
  time_[i] = time_[size()];
  arrival_[i] = arrival_[size()];
}

double novelty(const SampleCollector& buffer, std::span<const double> x) {
  return buffer.density().novelty(buffer.kernel().inputs_of(x), buffer.samples());
}

KnownPlaces known_places(const SampleCollector& buffer) {
  const std::size_t inputs = buffer.kernel().inputs();
  const std::size_t places = buffer.samples().capacity();
  KnownPlaces known{SampleStore(inputs, places),
                    KernelDensity(inputs, places, buffer.density().bandwidth())};
  refresh(known, buffer);
  return known;
}

void refresh(KnownPlaces& known, const SampleCollector& buffer) {
  known.samples.assign(buffer.samples());
  known.density.assume(buffer.density().sums());
}

}  // namespace kelpie
