// SPDX-License-Identifier: Apache-2.0
#include "posterior/row_screen.hpp"

#include <algorithm>
#include <cmath>

#include "posterior/tuning.hpp"

namespace kelpie {
namespace {

auto runs_at(double t) {
  return [t](const Restart& one) { return one.runs(t); };
}

}  // namespace

RowScreen::RowScreen(std::size_t inputs, std::size_t terms)
    : rows_(inputs, kRows),
      restarts_{Restart(terms, kPosterior.nats_at_start), Restart(terms, kPosterior.nats_at_start),
                Restart(terms, kPosterior.nats_at_start), Restart(terms, kPosterior.nats)},
      follower_(terms, kPosterior.nats_on_probation, kPosterior.ahead_on_probation_s),
      before_(terms, terms),
      after_(terms, terms),
      phi_(terms) {}

void RowScreen::add(const RecentRows::Row& row, const Features& features,
                    std::span<const double> phi, Posterior& live) {
  first_s_ = begun_ ? first_s_ : row.t;
  const double step = begun_ ? std::clamp(row.t - last_s_, 0.0, kPosterior.longest_step_s) : 0.0;
  begun_ = true;
  last_s_ = row.t;
  won_.reset();
  dropped_ = 0;
  if (!waiting() && next_ == rows_.end() && std::ranges::none_of(restarts_, runs_at(row.t))) {
    rows_.clear();
  }
  const double share = std::min(1.0, step / std::max(learned_s_, kPosterior.first_restart_s));
  const Posterior::Looks looks = live.look(phi, row.left, share);
  if (looks.unknown > kPosterior.set_off && looks.noise > kPosterior.unexplained) {
    begin_anew(row.t);
    last_waits_ = false;
  } else {
    const bool has_weight =
        features.trust(row.x) == 1.0 || std::abs(looks.deviations) > kPosterior.far;
    last_waits_ =
        looks.surprise > kPosterior.surprise || (looks.unknown > kPosterior.most_unknown &&
                                                 has_weight && learned_s_ > kPosterior.garbage_s);
  }
  learned_s_ += last_waits_ ? 0.0 : step;
  begin_restarts(row.t);
  if (last_waits_ && !waiting()) {
    follower_.begin_from(live, kPosterior.kept_on_probation, row.t, features.groups());
  }
  if (last_waits_) {
    waits_s_ = waiting() ? waits_s_ : row.t;
    waited_s_ = row.t;
  }
  const bool waits = waiting() || last_waits_;
  rows_.push(row, last_waits_ ? State::waits : State::due);
  waits_since_ = !waits ? rows_.end() : std::min(waits_since_, rows_.end() - 1);
  if (waits) {
    follower_.update(phi, row.left, row.t, features.trust(row.x), live, live.rows_per_sample(),
                     features.groups());
  }
  run_restarts(row, features, phi, live);
  limit_waiting(features, live);
}

// Rows that have waited for long enough are learned, or judged.
void RowScreen::limit_waiting(const Features& features, const Posterior& live) {
  const bool is_crowded = rows_.full() && waits_since_ == rows_.begin();
  // What no terms explain may be garbage for longer.
  const double most_s =
      kPosterior.garbage_s * (restarts_[kRestarts].explains() ? 1.0 : kPosterior.patience);
  if (waiting() && (last_s_ - waits_s_ > most_s || is_crowded)) {
    release(State::due);
  } else if (waiting() && last_s_ - waited_s_ > kPosterior.calm_s) {
    judge(features, live);
  }
}

void RowScreen::end_waiting(const Features& features, const Posterior& live) {
  dropped_ = 0;
  if (waiting()) {
    judge(features, live);
  }
}

// With the row of the time t, as at the start.
void RowScreen::begin_anew(double t) {
  won_ = {.since_s = t, .is_change = false};
  rows_.clear();
  next_ = waits_since_ = rows_.end();
  first_s_ = t;
  learned_s_ = 0.0;
  started_ = 0;
  std::ranges::for_each(restarts_, [](Restart& one) { one.end(); });
}

// Before the row of the time t is kept.
void RowScreen::begin_restarts(double t) {
  Restart& last = restarts_[kRestarts];
  if (last_waits_ && !waiting() && !(last.runs(t) && last.leads())) {
    last.begin(rows_.end(), t, t + 2.0 * kPosterior.garbage_s);
  }
  const double due_s = kPosterior.first_restart_s * std::exp2(static_cast<double>(started_));
  if (started_ < kRestarts && t - first_s_ >= due_s) {
    restarts_.at(started_++).begin(rows_.end(), t, t + 1.5 * due_s + kPosterior.restart_s);
  }
}

void RowScreen::run_restarts(const RecentRows::Row& row, const Features& features,
                             std::span<const double> phi, const Posterior& live) {
  const double trust = features.trust(row.x);
  for (Restart& one : restarts_) {
    if (one.runs(row.t)) {
      // What garbage at the start has taught errs the same way for good.
      const bool may_be_garbage = &one != &restarts_[kRestarts];
      one.update(phi, row.left, row.t, trust, live, may_be_garbage ? 1.0 : live.rows_per_sample(),
                 features.groups());
    }
  }
  Restart& last = restarts_[kRestarts];
  if (last.runs(row.t) && last.leads()) {
    last.live_until(row.t + 2.0 * kPosterior.garbage_s);
  }
  const auto winner =
      std::ranges::find_if(restarts_.rbegin(), restarts_.rend(), [&](const auto& one) {
        return one.runs(row.t) && one.first_row() >= rows_.begin() && one.wins(row.t, learned_s_) &&
               (&one != &last || one.explains());
      });
  if (winner == restarts_.rend()) {
    return;
  }
  if (&*winner == &last &&
      distance(last.first_row(), true, features, live) < kPosterior.least_changed) {
    release(State::due_rare);  // teaches of places of which nothing was known
    last.end();
  } else {
    take_over(*winner);
  }
}

// With the last row, a restart wins.
void RowScreen::take_over(const Restart& winner) {
  const Restart& last = restarts_[kRestarts];
  won_ = {.since_s = winner.begin_s(),
          .is_change = &winner == &last && winner.begin_s() - first_s_ > kPosterior.garbage_s};
  learned_s_ = last_s_ - won_->since_s;
  next_ = winner.first_row();
  for (std::size_t i = rows_.begin(); i < rows_.end(); ++i) {
    rows_.state(i) = i < next_ ? State::done : State::due;
  }
  waits_since_ = rows_.end();
  for (Restart& one : restarts_) {
    one.begin_s() > won_->since_s ? one.forget_evidence() : one.end();
  }
  restarts_[kRestarts].end();
}

void RowScreen::judge(const Features& features, const Posterior& live) {
  if (distance(waits_since_, false, features, live) > kPosterior.most_distance) {
    release(State::dropped);
    return;
  }
  double squares = 0.0, products = 0.0, last = 0.0;
  each_row(waits_since_, false, features, [&](double y, double /*trust*/) {
    const double error = y - value(before_, phi_);
    squares += error * error;
    products += error * last;
    last = error;
  });
  release(products > kPosterior.coherence * squares ? State::due_rare : State::due);
  restarts_[kRestarts].end();  // no other vehicle
}

// Uses each row from the first on, or each that waits, with the row's terms in phi_ and its trust.
template <typename Use>
void RowScreen::each_row(std::size_t first, bool all, const Features& features, Use use) {
  for (std::size_t i = first; i < rows_.end(); ++i) {
    if (all || rows_.state(i) == State::waits) {
      const RecentRows::Row row = rows_[i];
      features.first(row.x, phi_);
      use(row.left, features.trust(row.x));
    }
  }
}

// How far rows contradict what is known, by the posteriors of the terms, which are small. `all`:
// not only rows that wait, and less their mean error, which may be the sensor's.
double RowScreen::distance(std::size_t first, bool all, const Features& features,
                           const Posterior& live) {
  before_.assign_first(live);
  for (int i = 0; i < kPosterior.young_rounds; ++i) {
    settle(before_, features.groups());
  }
  double offset = 0.0, weight = 0.0;
  if (all) {
    each_row(first, all, features, [&](double y, double trust) {
      weight += trust;
      offset += trust * (y - value(before_, phi_));
    });
    offset /= weight > 0.0 ? weight : 1.0;
  }
  after_ = before_;
  each_row(first, all, features,
           [&](double y, double trust) { after_.add(phi_, y - offset, trust, Likelihood::gauss); });
  settle(after_, features.groups());
  return before_.distance(after_);
}

void RowScreen::release(State state) {
  for (std::size_t i = waits_since_; i < rows_.end(); ++i) {
    if (rows_.state(i) == State::waits) {
      rows_.state(i) = state;
      dropped_ += state == State::dropped ? 1 : 0;
    }
  }
  next_ = std::min(next_, waits_since_);
  waits_since_ = rows_.end();
}

void RowScreen::believe_change(double since_s) {
  for (std::size_t i = rows_.begin(); i < rows_.end(); ++i) {
    State& state = rows_.state(i);
    if (rows_[i].t >= since_s && (state == State::waits || state == State::dropped)) {
      state = State::due;
      next_ = std::min(next_, i);
    }
  }
  waits_since_ = rows_.end();
  for (Restart& one : restarts_) {
    one.forget_evidence();
  }
}

std::optional<RowScreen::Due> RowScreen::next() {
  for (next_ = std::max(next_, rows_.begin()); next_ < rows_.end(); ++next_) {
    State& state = rows_.state(next_);
    if (state == State::due || state == State::due_rare) {
      const bool is_rare = state == State::due_rare;
      state = State::done;
      return Due{rows_[next_++], is_rare ? Likelihood::huber : Likelihood::student};
    }
  }
  return {};
}

void RowScreen::visit(Archive& archive) {
  archive.part("rows", rows_);
  archive.whole(next_, 0, rows_.end());
  archive.whole(waits_since_, 0, rows_.end());
  for (double* const one : {&waits_s_, &waited_s_, &first_s_, &last_s_, &learned_s_}) {
    archive.number(*one);
  }
  archive.flag(last_waits_);
  archive.flag(begun_);
  archive.whole(started_, 0, kRestarts);
  for (Restart& one : restarts_) {
    archive.part("restart", one);
  }
  archive.part("follower", follower_);
}

std::size_t RowScreen::bytes(std::size_t inputs, std::size_t terms) {
  return RecentRows::bytes(inputs, kRows) + (kRestarts + 2) * Restart::bytes(terms) +
         2 * Posterior::bytes(terms, terms) + terms * sizeof(double);
}

}  // namespace kelpie
