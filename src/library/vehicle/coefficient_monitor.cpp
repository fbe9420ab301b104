// SPDX-License-Identifier: Apache-2.0
#include "vehicle/coefficient_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/quantile.hpp"
#include "vehicle/tuning.hpp"

namespace kelpie {
namespace {

constexpr auto kWindows = kDiagnosis.windows;
static_assert(kWindows.back() == CoefficientMonitor::kBlocks);
static_assert(kWindows.size() <= static_cast<std::size_t>(kDiagnosis.block_rows));  // one per row

}  // namespace

CoefficientMonitor::CoefficientMonitor(std::size_t inputs, std::span<const std::size_t> states,
                                       std::vector<std::size_t> body_axes, const Attitude& attitude,
                                       std::span<const std::size_t> others)
    : terms_(MotionTerms::diagnosis(inputs, states, attitude, others)),
      explanations_(terms_, std::move(body_axes)),
      fit_(terms_.size(), states.size()),
      comparison_(terms_.size(), states.size(), explanations_.columns()),
      reference_(terms_.size(), states.size()),
      window_sums_(reference_),
      blocks_(kBlocks, reference_),
      starts_(kBlocks),
      window_(kWindows.size()),
      usual_(kWindows.size() * (explanations_.list().size() + 1), 1.0),
      expected_thrust_(terms_.size() * states.size()),
      thrust_(expected_thrust_.size()),
      directions_(explanations_.columns() * terms_.size() * states.size()),
      health_columns_(explanations_.health_columns()) {
  health_.reserve(terms_.commands().size());
}

bool CoefficientMonitor::ready() const {
  const double least = kDiagnosis.rows_per_term * static_cast<double>(terms_.size());
  const double usual = std::min(kDiagnosis.reference_s * rate_hz_, kDiagnosis.reference_rows);
  return reference_.rows() >= std::max(usual, least);
}

void CoefficientMonitor::restart() {
  reference_.clear();
  kept_ = 0;
  window_ = kWindows.size();
  alarm_ = 0;
  watched_ = 0;
  std::ranges::fill(usual_, 1.0);
  health_.clear();
}

void CoefficientMonitor::insert(const NormalEquations& block, double start_s, double end_s,
                                double since_s) {
  // Of a block without a gap: a pause lowers the rate of one block alone.
  rate_hz_ = std::max(kDiagnosis.rate_kept * rate_hz_, (block.rows() - 1.0) / (end_s - start_s));
  if (kept_ == kBlocks) {
    absorb_oldest();
  }
  const std::size_t place = (first_ + kept_) % kBlocks;
  blocks_[place] = block;
  starts_[place] = since_s;
  ++kept_;
  window_ = ready() ? 0 : kWindows.size();
}

void CoefficientMonitor::absorb_oldest() {
  const double most = kDiagnosis.memory_s * rate_hz_;
  if (reference_.rows() > most) {
    reference_.scale(most / reference_.rows());
  }
  reference_.add(blocks_[first_]);
  first_ = (first_ + 1) % kBlocks;
  --kept_;
}

bool CoefficientMonitor::step() {
  if (window_ == kWindows.size()) {
    return false;
  }
  if (window_ == 0) {
    fit_.fit(reference_);
    find_directions();
    window_sums_.clear();
    ++watched_;
    alarm_ = 0;
    alarm_excess_ = kDiagnosis.alarm_nats;
  }
  if (kWindows[window_] <= kept_) {
    add_newest(window_ > 0 ? kWindows[window_ - 1] : 0, kWindows[window_]);
    compare(window_sums_);
    test_window(window_);
  }
  ++window_;
  if (window_ == kWindows.size() && kept_ == kBlocks) {
    update_health();
  }
  return window_ == kWindows.size() && alarm_ > 0;
}

void CoefficientMonitor::find_directions() {
  for (std::size_t i = 0; i < thrust_.size(); ++i) {
    thrust_[i] = expected_thrust_[i] != 0.0 ? expected_thrust_[i] : fit_.theta()[i];
  }
  explanations_.directions(terms_, fit_.theta(), thrust_, directions_);
}

void CoefficientMonitor::expect_thrust(std::span<const double> thrust) {
  std::ranges::copy(thrust, expected_thrust_.begin());
  find_directions();
}

void CoefficientMonitor::add_newest(std::size_t from, std::size_t to) {
  for (std::size_t i = from; i < to; ++i) {
    window_sums_.add(blocks_[(first_ + kept_ - 1 - i) % kBlocks]);
  }
}

void CoefficientMonitor::compare(const NormalEquations& stretch) {
  comparison_.compare(reference_, fit_, stretch, directions_);
}

void CoefficientMonitor::test_window(std::size_t window) {
  const std::span<const Explanation> list = explanations_.list();
  const std::span<double> usual =
      std::span(usual_).subspan(window * (list.size() + 1), list.size() + 1);
  const double share = 1.0 / std::min(static_cast<double>(watched_), kDiagnosis.usual_blocks);
  const auto learn_usual = [&](std::size_t i, double evidence, std::size_t sizes) {
    const double scatter = 2.0 * evidence / static_cast<double>(sizes);
    usual[i] += share * (std::min(scatter, kDiagnosis.usual_limit * usual[i]) - usual[i]);
  };
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::size_t sizes = list[i].columns.size();
    const double evidence = comparison_.of(list[i].columns).evidence;
    const double excess = evidence / std::max(1.0, usual[i]) -
                          kDiagnosis.alarm_nats_per_size * static_cast<double>(sizes);
    if (excess > alarm_excess_ && watched_ > kBlocks) {
      alarm_excess_ = excess;
      alarm_ = window + 1;
    }
    learn_usual(i, evidence, sizes);
  }
  learn_usual(list.size(), comparison_.whole(), fit_.theta().size());
}

double CoefficientMonitor::usual_scatter() const {
  return std::max(1.0, usual_.back());
}

// Of the last minute, all thrusters at a time, whatever forces there are; of thrusters beyond the
// columns of an agreement nothing is known.
void CoefficientMonitor::update_health() {
  const std::span<const double> usual =
      std::span<const double>(usual_).last(explanations_.list().size() + 1);
  const double scatter = std::max(1.0, *std::ranges::max_element(usual));
  const double spread = kNormal90 * std::sqrt(scatter);
  const Agreement agreement = comparison_.of(health_columns_);
  const std::size_t told = health_columns_.size() - terms_.velocities().size();
  health_.clear();
  for (std::size_t i = 0; i < terms_.commands().size(); ++i) {
    health_.push_back(i < told
                          ? explanations_.cause(i, agreement.size[i], spread * agreement.error[i])
                          : explanations_.cause(i, 0.0, std::numeric_limits<double>::infinity()));
  }
}

// The windows are some blocks apart: which number of blocks up to that of the alarm explains most?
std::size_t CoefficientMonitor::sharpest_cut() {
  const std::size_t shorter = alarm_ > 1 ? kWindows[alarm_ - 2] : 0;
  std::size_t best = kWindows[alarm_ - 1];
  double most = -1.0;
  window_sums_.clear();
  add_newest(0, shorter);
  for (std::size_t i = shorter; i < kWindows[alarm_ - 1]; ++i) {
    add_newest(i, i + 1);
    compare(window_sums_);
    double evidence = 0.0;
    for (const Explanation& explanation : explanations_.list()) {
      evidence = std::max(evidence, comparison_.of(explanation.columns).evidence);
    }
    if (evidence > kDiagnosis.later_cut_gain * most) {
      most = evidence;
      best = i + 1;
    }
  }
  return best;
}

CoefficientMonitor::Cut CoefficientMonitor::cut(std::size_t guard, NormalEquations& after) {
  const std::size_t blocks = sharpest_cut();
  while (kept_ > blocks) {
    absorb_oldest();
  }
  fit_.fit(reference_);
  find_directions();
  for (std::size_t i = guard; i < kept_; ++i) {
    after.add(blocks_[(first_ + i) % kBlocks]);
  }
  kept_ = 0;
  health_.clear();
  return {starts_[first_], blocks};
}

// All that begin later, and the one before them.
void CoefficientMonitor::drop_since(double t) {
  window_ = kWindows.size();
  health_.clear();
  for (bool later = true; later && kept_ > 0; --kept_) {
    later = starts_[(first_ + kept_ - 1) % kBlocks] >= t;
  }
}

void CoefficientMonitor::accept_change(std::span<const double> delta, double kept,
                                       const NormalEquations& rows) {
  if (!delta.empty()) {
    reference_.shift(delta);
  }
  reference_.scale(kept);
  reference_.add(rows);
}

void CoefficientMonitor::visit(Archive& archive) {
  archive.part("reference", reference_);
  archive.part("window", window_sums_);
  archive.whole(first_, 0, kBlocks - 1);
  archive.whole(kept_, 0, kBlocks);
  archive.number(rate_hz_);
  for (std::size_t i = 0; i < kept_; ++i) {
    archive.part("block", blocks_[(first_ + i) % kBlocks]);
    archive.number(starts_[(first_ + i) % kBlocks]);
  }
  archive.part("fit", fit_);
  archive.whole(window_, 0, kWindows.size());
  archive.whole(alarm_, 0, kWindows.size());
  archive.number(alarm_excess_);
  archive.whole(watched_);
  archive.numbers(usual_);
  archive.list(health_, terms_.commands().size(),
               [&](Cause& cause) { visit_cause(archive, cause); });
  if (archive.loading()) {
    find_directions();
  }
}

}  // namespace kelpie
