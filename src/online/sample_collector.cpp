// SPDX-License-Identifier: Apache-2.0
#include "kelpie/online/sample_collector.hpp"

#include <algorithm>

namespace kelpie {
namespace {

double bandwidth(std::size_t inputs, const OnlineSvrSettings& settings) {
  return settings.bandwidth > 0.0
             ? settings.bandwidth
             : KernelDensity::scott(inputs, static_cast<std::size_t>(settings.buffer));
}

}  // namespace

SampleCollector::SampleCollector(std::size_t inputs, const OnlineSvrSettings& settings)
    : kernel_(settings.gamma),
      samples_(inputs, settings.places()),
      problem_(settings.places(), settings.epsilon, settings.c, settings.storage),
      self_(1.0 + settings.effective_ridge()),
      density_(inputs, settings.places(), bandwidth(inputs, settings)),
      time_(settings.places()),
      arrival_(settings.places()),
      row_(settings.places()) {}

std::size_t SampleCollector::bytes(std::size_t inputs, const OnlineSvrSettings& settings) {
  const std::size_t places = settings.places();
  return SampleStore::bytes(inputs, places) + DualProblem::bytes(places, settings.storage) +
         KernelDensity::bytes(inputs, places) +
         places * (2 * sizeof(double) + sizeof(std::uint64_t));
}

std::size_t SampleCollector::support_vectors() const {
  const std::span<const double> beta = problem_.beta();
  return size() - static_cast<std::size_t>(std::count(beta.begin(), beta.end(), 0.0));
}

std::span<const double> SampleCollector::similarity(std::span<const double> z) {
  kernel_.row(z, samples_, row_);
  return {row_.data(), size()};
}

void SampleCollector::collect(std::span<const double> z, double y, double t) {
  const std::size_t i = size();
  density_.add(z, samples_);
  problem_.add(std::span(row_).first(i), self_, y);
  samples_.push_back(z);
  time_[i] = t;
  arrival_[i] = next_arrival_++;
}

void SampleCollector::remove(std::size_t i) {
  density_.remove(i, samples_);
  problem_.remove(i);
  samples_.remove(i);
  time_[i] = time_[size()];
  arrival_[i] = arrival_[size()];
}

}  // namespace kelpie
