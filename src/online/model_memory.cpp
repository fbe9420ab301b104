// SPDX-License-Identifier: Apache-2.0
#include "kelpie/online/model_memory.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace kelpie {
namespace {

constexpr double kSamePlace = 0.99;  // κ_SE from which a sample lies where the one before did

constexpr double kMost = ErrorAlarm::kMost;
constexpr double kLeast = 1e-9;    // of a usual error: a noiseless stream has none
constexpr double kMemory = 500.0;  // samples over which an error is usual

// What makes a past model the vehicle's, in its own usual errors.
constexpr double kMargin = 0.5;  // that it has to be better by, per sample
constexpr double kLead = 15.0;   // and in all: at least four samples
constexpr double kFits = 2.0;    // its own mean error
constexpr int kPatience = 200;   // samples after which a trial is over

constexpr std::size_t kCompared = 64;  // samples by which two models are compared

// Samples without alarm after which a model that agrees with a past one is the same one, grown.
constexpr std::int64_t kTheSame = 1024;

// The mean of |a(x) − b(x)| over some samples, evenly chosen, without the fine parts.
double difference(const SvrFunction& a, const SvrFunction& b, const SampleStore& samples,
                  std::span<double> x) {
  const std::size_t count = std::min(samples.size(), kCompared);
  double sum = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    samples.get(k * samples.size() / count, x);
    sum += std::abs(a.lasting(x) - b.lasting(x));
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

}  // namespace

ModelMemory::ModelMemory(const SampleCollector& buffer, const OnlineSvrSettings& settings)
    : capacity_(settings.past_models()),
      models_(capacity_, PastModel(buffer.kernel(), buffer.samples().capacity())),
      trials_(capacity_),
      recent_z_(buffer.samples().dimension(), kRecent),
      last_(buffer.samples().dimension(), 1),
      sample_(buffer.samples().dimension()) {}

std::size_t ModelMemory::bytes(std::size_t dimension, const OnlineSvrSettings& settings) {
  return settings.past_models() * (PastModel::bytes(dimension, settings.places()) + sizeof(Trial)) +
         SampleStore::bytes(dimension, kRecent) + SampleStore::bytes(dimension, 1) +
         dimension * sizeof(double);
}

void ModelMemory::observe(std::span<const double> z, double y, double error, double t) {
  if (capacity_ == 0) {
    return;
  }
  const std::size_t place = observed_++ % kRecent;
  if (recent_z_.size() < kRecent) {
    recent_z_.push_back(z);
  } else {
    recent_z_.set(place, z);
  }
  recent_[place] = {.y = y, .t = t, .error = error};
  ++service_;
  ++quiet_;
  if (trial_ > 0) {
    try_all(z, recent_[place]);
    trial_ = trial_ < kPatience ? trial_ + 1 : 0;
  } else if (watch(error, t)) {
    try_recent(alarm_.since());
  }
}

void ModelMemory::alert(double since_s, bool another) {
  const bool just_found = trial_ == 0 && quiet_ < static_cast<std::int64_t>(kRecent);
  if (capacity_ == 0 || just_found) {
    return;
  }
  another_ = another;
  if (trial_ == 0) {
    try_recent(since_s);
  }
}

// Whether errors have grown.
bool ModelMemory::watch(double error, double t) {
  bool grown = false;
  if (seen_ >= kSettled) {
    grown = alarm_.watch(error / std::max(usual_, kLeast), t);
    error = std::min(error, kMost * usual_);
  }
  ++seen_;
  usual_ += (error - usual_) / std::min(static_cast<double>(seen_), kMemory);
  return grown;
}

void ModelMemory::keep(const OnlineSvr& service, double t) {
  if (!in_service_) {
    const std::optional<std::size_t> known = another_ ? std::nullopt : agreeing(service.model());
    if (known && quiet_ < kTheSame) {
      models_[*known].info.until_s = t;  // perhaps on its way to another: the picture stays
      return;
    }
    in_service_ = known ? *known : place_for_another();
    another_ = false;
  }
  PastModel& model = models_[*in_service_];
  PastModelInfo info = model.info;
  if (info.number == 0) {
    info.number = next_number_++;
    info.from_s = from_s_;
  }
  info.samples += service_;
  info.until_s = t;
  // An error within half the tube is none.
  info.usual_error = std::max({usual_, 0.5 * service.settings().epsilon, kLeast});
  model.keep(service.buffer(), service.model(), info);
  service_ = 0;
}

// The past model that a function says the same as.
std::optional<std::size_t> ModelMemory::agreeing(const SvrFunction& function) {
  for (std::size_t k = 0; k < size_; ++k) {
    const PastModel& known = models_[k];
    if (difference(known.function, function, known.samples, sample_) <= known.info.usual_error) {
      return k;
    }
  }
  return std::nullopt;
}

// A free place, or that of the least useful.
std::size_t ModelMemory::place_for_another() {
  const auto least = std::ranges::min_element(models(), {}, [](const PastModel& model) {
    return std::tuple(model.info.recalls, model.info.until_s);
  });
  const std::size_t place =
      size_ < capacity_ ? size_++ : static_cast<std::size_t>(least - models().begin());
  models_[place].info = {};
  return place;
}

// Leaves the picture of the model in service as it is, and begins the trials with the samples since
// errors have grown.
void ModelMemory::try_recent(double since_s) {
  take_up(std::nullopt, since_s);
  trial_ = 1;
  for (std::size_t i = observed_ - recent_z_.size(); i < observed_; ++i) {
    if (recent_[i % kRecent].t >= since_s) {
      recent_z_.get(i % kRecent, sample_);
      try_all(sample_, recent_[i % kRecent]);
    }
  }
}

void ModelMemory::try_all(std::span<const double> z, const Recent& sample) {
  if (size_ == 0 || same_place(z)) {
    return;
  }
  ++tried_;
  for (std::size_t k = 0; k < size_; ++k) {
    const double unit = models_[k].info.usual_error;
    const double own = std::abs(sample.y - models_[k].function.lasting(z)) / unit;
    trials_[k].lead += std::min(sample.error / unit, kMost) - std::min(own, kMost) - kMargin;
    trials_[k].error += std::min(own, kMost);
  }
}

// A vehicle at rest would make a case all by itself.
bool ModelMemory::same_place(std::span<const double> z) {
  double similarity = 0.0;
  if (last_.size() > 0) {
    models_.front().function.kernel().similarity(z, last_, {&similarity, 1});
  }
  if (similarity < kSamePlace) {
    last_.clear();
    last_.push_back(z);
  }
  return similarity >= kSamePlace;
}

std::optional<std::size_t> ModelMemory::fitting() const {
  std::optional<std::size_t> best;
  for (std::size_t k = 0; trial_ > 0 && k < size_; ++k) {
    const Trial& trial = trials_[k];
    const bool fits = trial.lead > kLead && trial.error <= kFits * tried_;
    if (fits && (!best || trial.lead > trials_[*best].lead)) {
      best = k;
    }
  }
  return best;
}

void ModelMemory::take_up(std::optional<std::size_t> model, double t) {
  in_service_ = model;
  from_s_ = t;
  usual_ = model ? models_[*model].info.usual_error : usual_;
  seen_ = model ? kSettled : 0;
  service_ = 0;
  alarm_.reset();
  quiet_ = 0;
  trial_ = 0;
  tried_ = 0;
  last_.clear();
  std::ranges::fill(trials_, Trial{});
  if (model) {
    another_ = false;
    ++models_[*model].info.recalls;
  }
}

void ModelMemory::add(const PastModel& model) {
  models_[size_++] = model;
  next_number_ = std::max(next_number_, model.info.number + 1);
}

void ModelMemory::restate(const SampleMap& map, const std::function<void(PastModel&)>& solve) {
  for (PastModel& model : std::span(models_).first(size_)) {
    for (std::size_t i = 0; i < model.size(); ++i) {
      model.samples.get(i, sample_);
      map(sample_, model.targets[i]);
      model.samples.set(i, sample_);
    }
    model.info.usual_error = stretched(map, model.info.usual_error);
    solve(model);
  }
  usual_ = stretched(map, usual_);
  alarm_.reset();
  trial_ = 0;
  recent_z_.clear();
  observed_ = 0;
}

// A difference of targets in the other scale.
double ModelMemory::stretched(const SampleMap& map, double difference) {
  double zero = 0.0;
  std::ranges::fill(sample_, 0.0);
  map(sample_, zero);
  std::ranges::fill(sample_, 0.0);
  map(sample_, difference);
  return difference - zero;
}

void ModelMemory::visit(Archive& archive) {
  archive.length(size_, capacity_);
  for (std::size_t k = 0; k < size_; ++k) {
    archive.part("past model", models_[k]);
    archive.number(trials_[k].lead);
    archive.number(trials_[k].error);
  }
  archive.part("recent", recent_z_);
  archive.whole(observed_);
  for (Recent& sample : std::span(recent_).first(recent_z_.size())) {
    archive.number(sample.y);
    archive.number(sample.t);
    archive.number(sample.error);
  }
  archive.whole(tried_);
  archive.whole(trial_);
  archive.part("last", last_);
  std::size_t place = in_service_.value_or(capacity_);
  archive.whole(place, 0, capacity_);
  archive.require(place == capacity_ || place < size_, "serves a past model that there isn't");
  in_service_ = place < size_ ? std::optional(place) : std::nullopt;
  archive.flag(another_);
  archive.number(from_s_);
  archive.number(usual_);
  archive.whole(seen_);
  archive.whole(service_);
  archive.part("alarm", alarm_);
  archive.whole(quiet_);
  archive.whole(next_number_, 1);
}

}  // namespace kelpie
