// SPDX-License-Identifier: Apache-2.0
#include "learner/past_models.hpp"

#include <algorithm>
#include <utility>

#include "learner/sample_map.hpp"
#include "learner/tuning.hpp"

namespace kelpie {
PastModels::PastModels(const SampleCollector& buffer, const OnlineSvrSettings& settings)
    : capacity_(settings.past_models()),
      models_(capacity_, PastModel(buffer.kernel(), buffer.samples().capacity())),
      recent_z_(buffer.samples().dimension(), kRecent),
      trial_(buffer.samples().dimension(), capacity_),
      sample_(buffer.samples().dimension()) {}

std::size_t PastModels::bytes(std::size_t inputs, std::size_t terms,
                              const OnlineSvrSettings& settings) {
  const std::size_t dimension = inputs + terms;
  const std::size_t models = settings.past_models();
  return models * PastModel::bytes(inputs, terms, settings.places()) +
         ModelTrial::bytes(dimension, models) + SampleStore::bytes(dimension, kRecent) +
         dimension * sizeof(double);
}

void PastModels::observe(std::span<const double> z, double y, double error, double t) {
  if (capacity_ == 0) {
    return;
  }
  if (first_ && !kept_as_ && since_kept_ == 0) {  // the run begins
    from_s_ = t;
    grown_s_ = t;
  }
  const std::size_t place = observed_++ % kRecent;
  if (recent_z_.size() < kRecent) {
    recent_z_.push_back(z);
  } else {
    recent_z_.set(place, z);
  }
  recent_[place] = {.y = y, .t = t, .error = error};
  ++since_kept_;
  ++age_;
  switch (state_) {
    case State::settling:
      average(error);
      state_ = averaged_ < kOnline.memory.settled ? State::settling : State::watching;
      break;
    case State::watching: {
      const bool grown = alarm_.watch(error / std::max(mean_error_, kOnline.memory.least_error), t);
      average(std::min(error, kOnline.alarm.clip * mean_error_));
      if (grown) {
        start_trial(alarm_.since());
      }
      break;
    }
    case State::on_trial:
      if (!outdated_) {
        trial_.add(z, y, error, models());
      }
      age_ = outdated_ ? 0 : age_;  // it is yet to begin
      if (age_ == kOnline.memory.trial_length) {
        enter(State::settling);
        if (std::exchange(another_, false)) {
          set_in_service({}, grown_s_);
        }
      }
      break;
  }
}

void PastModels::alert(double since_s, bool another) {
  const bool just_found = state_ != State::on_trial && age_ < static_cast<std::int64_t>(kRecent);
  if (capacity_ == 0 || just_found) {
    return;
  }
  another_ = another;
  if (state_ != State::on_trial) {
    start_trial(since_s);
  }
}

// Nothing is known of the model in service.
void PastModels::enter(State state) {
  state_ = state;
  age_ = 0;
  averaged_ = 0;
  alarm_.reset();
  trial_.clear();
}

// From now on the model in service is kept as this one; none: as a new one.
void PastModels::set_in_service(std::optional<std::size_t> model, double since_s) {
  before_ = kept_as_;
  first_ = false;
  kept_as_ = model;
  from_s_ = since_s;
  since_kept_ = 0;
}

// On the samples since errors began to grow.
void PastModels::start_trial(double since_s) {
  enter(State::on_trial);
  grown_s_ = since_s;
  for (std::size_t i = observed_ - recent_z_.size(); !outdated_ && i < observed_; ++i) {
    const Recent& recent = recent_[i % kRecent];
    if (recent.t >= since_s) {
      recent_z_.get(i % kRecent, sample_);
      trial_.add(sample_, recent.y, recent.error, models());
    }
  }
}

void PastModels::recall(std::size_t model, double since_s) {
  enter(State::watching);  // its usual error is known
  mean_error_ = models_[model].info.usual_error;
  averaged_ = kOnline.memory.settled;
  set_in_service(model, since_s);
  another_ = false;
  ++models_[model].info.recalls;
}

void PastModels::promote_challenger(double since_s) {
  enter(State::settling);
  set_in_service({}, since_s);
  another_ = false;
}

void PastModels::withdraw() {
  enter(State::settling);
  if (kept_as_ && models_[*kept_as_].info.recalls > 0) {  // else a copy made on probation
    --models_[*kept_as_].info.recalls;
  }
  set_in_service(before_, from_s_);
}

void PastModels::average(double error) {
  ++averaged_;
  mean_error_ +=
      (error - mean_error_) / std::min(static_cast<double>(averaged_), kOnline.memory.window);
}

std::optional<std::size_t> PastModels::fitting() const {
  return state_ == State::on_trial ? trial_.fitting(kept_as_) : std::nullopt;
}

void PastModels::keep(const OnlineSvr& service, const SvrFunction& function,
                      const TermChange& change, double t) {
  std::optional<std::size_t> same = agreeing(function);
  if (same && age_ < kOnline.memory.same_after) {
    models_[*same].info.until_s = t;  // perhaps on its way to another: the picture stays
    if (!kept_as_) {
      return;
    }
    same.reset();
  }
  if (!kept_as_) {
    kept_as_ = same ? *same : place_for_another();
  } else if (same) {
    unite(*kept_as_, *same);
  }
  PastModel& model = models_[*kept_as_];
  PastModelInfo info = model.info;
  if (info.number == 0) {
    info.number = next_number_++;
    info.from_s = from_s_;
  }
  info.samples += since_kept_;
  info.until_s = t;
  // An error within half the tube is none.
  info.usual_error =
      std::max({mean_error_, 0.5 * service.settings().epsilon, kOnline.memory.least_error});
  model.keep(service.buffer(), function, info);
  for (std::size_t i = 0; change.any() && i < model.size(); ++i) {
    model.samples.get(i, sample_);
    model.targets[i] += change(sample_);
  }
  since_kept_ = 0;
}

// The past model, but its own copy, that is of the same vehicle as the function in service. That a
// run begins with a vehicle of an earlier one is likely; that a change brought one back is not.
std::optional<std::size_t> PastModels::agreeing(const SvrFunction& function) {
  for (std::size_t k = 0; k < size_; ++k) {
    const PastModel& known = models_[k];
    if (kept_as_ != k && (first_ && known.info.earlier > 0 ? known.explained_by(function, sample_)
                                                           : known.agrees(function, sample_))) {
      return k;
    }
  }
  return std::nullopt;
}

// The model in service is kept as another past model, too: from now on as that one alone.
void PastModels::unite(std::size_t kept, std::size_t same) {
  PastModelInfo& info = models_[same].info;
  const PastModelInfo& own = models_[kept].info;
  info.number = std::min(info.number, own.number);
  info.from_s = std::min(info.from_s, own.from_s);
  info.samples += own.samples;
  info.earlier += own.earlier;
  info.recalls += own.recalls;
  std::swap(models_[kept], models_[--size_]);
  kept_as_ = same == size_ ? kept : same;
  before_.reset();
}

// A free place, or that of the least useful.
std::size_t PastModels::place_for_another() {
  const auto least = std::ranges::min_element(
      models(), {}, [](const PastModel& model) { return model.info.usefulness(); });
  const std::size_t place =
      size_ < capacity_ ? size_++ : static_cast<std::size_t>(least - models().begin());
  if (before_ == place) {
    before_.reset();  // a withdrawal keeps the vehicle anew
  }
  models_[place].info = {};
  return place;
}

void PastModels::add(const PastModel& model) {
  models_[size_++] = model;
  next_number_ = std::max(next_number_, model.info.number + 1);
  enter(State::on_trial);
}

void PastModels::rescale(const SampleMap& map) {
  outdated_ = true;
  mean_error_ *= linear_part(map, sample_).gain;
  alarm_.reset();
  if (state_ == State::on_trial) {
    enter(State::on_trial);  // what was tried was so in the scale before
  }
  recent_z_.clear();
  observed_ = 0;
}

void PastModels::rescale_model(std::size_t model, const SampleMap& map,
                               const SvrFunction& function) {
  PastModel& past = models_[model];
  for (std::size_t i = 0; i < past.size(); ++i) {
    past.samples.get(i, sample_);
    map(sample_, past.targets[i]);
    past.samples.set(i, sample_);
  }
  past.info.usual_error *= linear_part(map, sample_).gain;
  past.function.assign(function);
}

void PastModels::finish_rescale() {
  outdated_ = false;
  if (state_ == State::on_trial) {
    start_trial(grown_s_);
  }
}

void PastModels::visit(Archive& archive) {
  archive.length(size_, capacity_);
  for (PastModel& model : std::span(models_).first(size_)) {
    archive.part("past model", model);
  }
  archive.whole(next_number_, 1);
  archive.part("recent", recent_z_);
  archive.whole(observed_);
  for (Recent& sample : std::span(recent_).first(recent_z_.size())) {
    archive.number(sample.y);
    archive.number(sample.t);
    archive.number(sample.error);
  }
  archive.choice(state_, State{}, State::on_trial);
  archive.whole(age_);
  archive.number(from_s_);
  archive.number(grown_s_);
  archive.number(mean_error_);
  archive.whole(averaged_);
  archive.part("alarm", alarm_);
  archive.part("trial", trial_, size_);
  std::size_t place = kept_as_.value_or(capacity_);
  archive.whole(place, 0, capacity_);
  archive.require(place == capacity_ || place < size_, "serves a past model that there isn't");
  std::size_t before = before_.value_or(capacity_);
  archive.whole(before, 0, capacity_);
  if (archive.loading()) {
    kept_as_ = place < size_ ? std::optional(place) : std::nullopt;
    before_ = before < size_ ? std::optional(before) : std::nullopt;
  }
  archive.whole(since_kept_);
  archive.flag(outdated_);
  archive.flag(another_);
  archive.flag(first_);
}

}  // namespace kelpie
