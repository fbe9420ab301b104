// SPDX-License-Identifier: Apache-2.0
#include "posterior/past_vehicles.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/vector.hpp"
#include "posterior/tuning.hpp"

namespace kelpie {

void PastVehicle::learn(const SampleSums& sums, double tau, std::span<const std::uint8_t> group) {
  rows_per_sample = tau;
  posterior.clear();
  posterior.add(sums, 1.0 / tau);
  for (int i = 0; i < kPosterior.young_rounds; ++i) {
    settle(posterior, group);
  }
  info.usual_error = std::sqrt(posterior.noise());
  evidence.clear();
}

void PastVehicle::visit(Archive& archive) {
  info.visit(archive);
  archive.list(weights, weights.capacity(), [&](double& one) { archive.number(one); });
  archive.part("posterior", posterior);
  archive.number(rows_per_sample);
  archive.part("evidence", evidence);
  archive.number(since_s);
}

PastVehicles::PastVehicles(std::size_t terms, std::size_t features, std::size_t most)
    : places_(most + 1, PastVehicle(terms, features)) {}

const PastVehicle* PastVehicles::update(std::span<const double> phi, double y, double t,
                                        double trust, const Posterior& live) {
  begun_s_ = rows_++ == 0 ? t : begun_s_;
  last_s_ = t;
  if (!live.ready()) {
    return nullptr;
  }
  const double share = t - alerted_s_ <= kPosterior.garbage_s ? kPosterior.alerted : 1.0;
  const std::span<const double> terms = phi.first(live.first_weights().size());
  const double error = y - value(live, phi);
  const double said = live.centre() + dot(live.first_weights(), terms);
  const double tau = std::min(live.rows_per_sample(),
                              kPosterior.most_correlated * static_cast<double>(rows_) + 1.0);
  const PastVehicle* back = nullptr;
  for (std::size_t k = 0; k < size_; ++k) {
    PastVehicle& one = places_[k];
    if (in_service_ == k) {
      continue;
    }
    one.since_s = one.evidence.rows() == 0.0 ? t : one.since_s;
    const double low = std::min(live.noise(), one.posterior.noise());
    const double high = std::max(live.noise(), one.posterior.noise());
    const double own = one.weights.empty() ? error - value(one.posterior, terms) + said
                                           : y - dot(one.weights, phi.first(one.weights.size()));
    const double gain = trust * Evidence::gain(error, own, low);
    one.evidence.add(own * own > kPosterior.surprise * high ? std::min(gain, 0.0) : gain,
                     std::max(tau, one.rows_per_sample));
    back = back == nullptr && one.evidence.is_clear(share) ? &one : back;
  }
  return back;
}

void PastVehicles::recall(const PastVehicle& vehicle) {
  begin();
  in_service_ = static_cast<std::size_t>(&vehicle - places_.data());
  ++places_[*in_service_].info.recalls;
}

void PastVehicles::leave(const Posterior& live, double since_s,
                         std::span<const std::uint8_t> group) {
  const PastModelInfo info{.from_s = begun_s_, .until_s = since_s, .samples = rows_};
  const double tau = live.rows_per_sample();
  const auto terms = static_cast<double>(live.first_weights().size());
  // Rows since the change are of the next vehicle.
  const double served = last_s_ > begun_s_ ? (since_s - begun_s_) / (last_s_ - begun_s_) : 0.0;
  const bool is_known = live.ready() && static_cast<double>(rows_) * served >=
                                            kPosterior.samples_per_term * terms * tau;
  std::optional<std::size_t> place = in_service_;
  if (places_.size() > 1 && is_known) {
    PastVehicle& left = places_[size_];
    left.info = info;
    left.learn(live.sums(), tau, group);
    left.weights.assign(live.weights().begin(), live.weights().end());
    left.weights[0] += live.centre();
    place = keep(left);
  }
  begin();
  left_ = place;
}

// The vehicle stands behind the others; returns its new place.
std::size_t PastVehicles::keep(PastVehicle& left) {
  const auto last = places_.begin() + static_cast<std::ptrdiff_t>(size_);
  auto place = std::find_if(places_.begin(), last, [&](const PastVehicle& one) {
    return left.posterior.distance(one.posterior) < kPosterior.least_changed;
  });
  if (in_service_) {
    place = places_.begin() + static_cast<std::ptrdiff_t>(*in_service_);
  }
  if (place != last) {
    const PastModelInfo& known = place->info;
    left.info.number = known.number;
    left.info.from_s = known.from_s;
    left.info.samples += known.samples;
    left.info.recalls = known.recalls;
    left.info.earlier = known.earlier;
  } else {
    left.info.number = next_number_++;
    if (size_ + 1 < places_.size()) {
      return size_++;
    }
    place = std::min_element(places_.begin(), last, [](const auto& a, const auto& b) {
      return a.info.usefulness() < b.info.usefulness();
    });
  }
  std::swap(*place, left);
  return static_cast<std::size_t>(place - places_.begin());
}

void PastVehicles::come_back() {
  begin();
  in_service_ = left_;
}

void PastVehicles::begin() {
  in_service_.reset();
  rows_ = 0;
  std::ranges::for_each(places_, [](PastVehicle& one) { one.evidence.clear(); });
}

void PastVehicles::change_features(const Matrix& t) {
  for (PastVehicle& one : std::span(places_).first(size_)) {
    if (!one.weights.empty()) {
      change_functions(one.weights, one.posterior.weights().size(), t);
    }
  }
}

void PastVehicles::forget_kernel() {
  std::ranges::for_each(places_, [](PastVehicle& one) { one.weights.clear(); });
}

bool PastVehicles::add(const PastModelInfo& info, const SampleSums& sums, double rows_per_sample,
                       std::span<const std::uint8_t> group) {
  PastVehicle& one = places_[size_];
  one.learn(sums, 1.0, group);
  one.rows_per_sample = rows_per_sample;
  one.info = info;
  const auto is_finite = [](double weight) { return std::isfinite(weight); };
  if (!std::ranges::all_of(one.posterior.weights(), is_finite)) {
    return false;
  }
  ++size_;
  next_number_ = std::max(next_number_, info.number + 1);
  return true;
}

void PastVehicles::visit(Archive& archive) {
  archive.length(size_, places_.size() - 1);
  for (PastVehicle& one : std::span(places_).first(size_)) {
    archive.part("past vehicle", one);
  }
  archive.whole(next_number_, 1);
  for (std::optional<std::size_t>* const one : {&in_service_, &left_}) {
    std::size_t place = one->value_or(size_);
    archive.whole(place, 0, size_);
    *one = place < size_ ? std::optional(place) : std::nullopt;
  }
  archive.whole(rows_);
  archive.number(begun_s_);
  archive.number(last_s_);
  archive.any_number(alerted_s_);
}

}  // namespace kelpie
