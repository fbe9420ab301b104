// SPDX-License-Identifier: Apache-2.0
// The part of OnlineSvr that learns many samples together: those of another scale or a past model.
#include <algorithm>
#include <array>
#include <optional>

#include "kelpie/core/scaling.hpp"
#include "kelpie/online/online_svr.hpp"

namespace kelpie {
namespace {

constexpr std::size_t kSliceOfRows = 25'000;  // elements of the kernel matrix per slice
constexpr std::size_t kElement = 30;          // work of one, in numbers

}  // namespace

void OnlineSvr::rescale(const SampleMap& map) {
  std::array<double, kMostInputs + kMostTerms> nowhere{};
  map(std::span(nowhere).first(buffer_.samples().dimension()), mean_);
  buffer_.rescale(map);
  filter_.clear();
  leaving_.reset();
  waiting_ = 0;
  unfinished_ = buffer_.size() == settings_.places();  // nobody has left for the next sample yet
  pruned_weight_ = false;
  solved_ = solver().restart(buffer_.problem());
  Decision decision;
  publish(decision);
}

void OnlineSvr::relearn(const PastModel& past, double now) {
  clear();
  while (!relearned_) {
    relearn_slice(past, now);
  }
}

bool OnlineSvr::relearn_slice(const PastModel& past, double now, const SampleMap& map) {
  if (relearned_) {
    return release_slice();
  }
  const std::size_t samples = std::min(past.size(), settings_.places() - 1);
  if (buffer_.size() < samples) {
    collect_slice(past, samples, now, map);
    if (buffer_.size() == samples && !map) {
      warm_start(past.function);
    }
    return false;
  }
  const std::optional<SolveReport> solved = solver().restart(buffer_.problem(), budget_);
  if (solved) {
    solved_ = *solved;
    Decision decision;
    publish(decision);
    relearned_ = true;
  }
  return false;
}

// Of another scale's samples hundreds may be without weight: more than one update can let go.
bool OnlineSvr::release_slice() {
  Decision decision;
  left_ = budget_;
  for (std::size_t work = 0; work < kSliceOfRows; work += 3 * buffer_.size()) {
    const std::optional<std::size_t> i = forgetting_.released(buffer_);
    if (!i) {
      return true;
    }
    if (!left_.spend(kElement * buffer_.size())) {
      break;
    }
    remove(decision, *i, &Decision::released);
  }
  return false;
}

// The weights that the samples had, which a solver need not find again. None unless the function is
// that of these samples.
void OnlineSvr::warm_start(const SvrFunction& function) {
  DualProblem& problem = buffer_.problem();
  const SampleStore& vectors = function.support_vectors();
  std::array<double, kMostInputs + kMostTerms> room{};
  std::array<double, kMostInputs> vector_room{};
  const std::span<double> z = std::span(room).first(vectors.dimension());
  const std::span<double> vector = std::span(vector_room).first(vectors.dimension());
  std::size_t known = 0;
  for (std::size_t i = 0; i < buffer_.size() && known < vectors.size(); ++i) {
    buffer_.samples().get(i, z);
    vectors.get(known, vector);
    if (std::ranges::equal(z, vector)) {
      problem.set_beta(i, function.beta()[known++]);
    }
  }
  for (std::size_t i = 0; i < buffer_.size(); ++i) {
    if (known < vectors.size()) {
      problem.set_beta(i, 0.0);
    }
    problem.renew(i);
  }
}

void OnlineSvr::collect_slice(const PastModel& past, std::size_t samples, double now,
                              const SampleMap& map) {
  std::array<double, kMostInputs + kMostTerms> place{};
  const std::span<double> z = std::span(place).first(buffer_.samples().dimension());
  const double latest = past.latest_s();
  Budget part = budget_;
  std::size_t work = 0;
  for (std::size_t i = buffer_.size();
       i < samples && work < kSliceOfRows && part.spend(kElement * i); ++i) {
    past.samples.get(i, z);
    double y = past.targets[i];
    if (map) {
      map(z, y);
    }
    buffer_.compare(z);
    buffer_.collect(z, y, now + (past.times_s[i] - latest));
    mean_ += (y - mean_) / static_cast<double>(++valid_samples_);
    work += i + 1;
  }
}

}  // namespace kelpie
