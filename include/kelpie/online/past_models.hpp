// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "kelpie/online/error_alarm.hpp"
#include "kelpie/online/model_trial.hpp"
#include "kelpie/online/online_svr.hpp"
#include "kelpie/online/past_model.hpp"
#include "online/tuning.hpp"

namespace kelpie {

/// The memory of past models of one axis (the paper's future work). It watches the errors of the
/// model in service, one step ahead, in one of three states:
///
///     settling   learns which error is usual     → watching  after 192 samples
///     watching   compares errors with that       → on_trial  when they have grown (ErrorAlarm)
///     on_trial   tries all past models           → watching  one fits, and is taken up
///                (ModelTrial)                    → settling  none fitted within 200 samples
///     any state                                  → settling  a challenger was taken up
///                                                → on_trial  another axis raised an alert
///
/// A trial begins with the latest samples, those since errors began to grow.
///
/// The model in service is due to be kept when 192 samples have passed since the last of these
/// events, and every 64 samples from then on. It is copied over its own copy, or to a new place.
/// One that has no copy yet and agrees with a past model is not kept: it may be on its way to
/// another; if it still agrees after 1,024 samples, it is that past model. When all places are
/// taken, the least recalled model is dropped; of several, the one that has been out of service
/// longest.
///
/// Memory: bytes(). Cost per sample: a copy of it; on trial a prediction per past model, for at
/// most 64 samples at once when the trial begins; keep() copies the buffer. Allocates in the
/// constructor only.
class PastModels {
 public:
  /// What the memory is doing; the table above says what moves it from each.
  enum class State : std::uint8_t { settling, watching, on_trial };

  /// Room for `settings.memory` models of learners with such a buffer; without room nothing is ever
  /// kept.
  PastModels(const SampleCollector& buffer, const OnlineSvrSettings& settings);

  State state() const { return state_; }
  std::size_t capacity() const { return capacity_; }
  std::span<const PastModel> models() const { return {models_.data(), size_}; }

  /// One more sample, and the error |y − f(x)| of the model in service before it was learned.
  void observe(std::span<const double> z, double y, double error, double t);

  /// As OnlineRegressor::alert().
  void alert(double since_s, bool another);

  /// Whether it is time to keep the model in service.
  bool due() const {
    return state_ == State::watching && age_ >= kOnline.memory.settled &&
           age_ % kOnline.memory.keep_every == 0;
  }
  void keep(const OnlineSvr& service, double t);  ///< Copies it. Cost O(n d).

  /// The past model that fits, the latest sample included; none but on trial.
  std::optional<std::size_t> fitting() const;

  /// When the vehicle now in service was first met [s]; on trial: when errors began to grow.
  double since() const { return state_ == State::on_trial ? grown_s_ : from_s_; }

  /// A past model is in service from now on; its vehicle has been there since then [s].
  void recall(std::size_t model, double since_s);
  /// As recall(), of a challenger.
  void promote_challenger(double since_s);
  /// As if what was taken up last had not been.
  void withdraw();

  /// Takes in a model from elsewhere. Requires room, and one made for the same buffer with a number
  /// that is no other's.
  void add(const PastModel& model);

  /// Samples come in another scale from now on. The past models don't follow by themselves: no
  /// trial takes place until finish_rescale().
  void rescale(const SampleMap& map);

  /// A past model goes over to that scale; `function` is what its samples, put through the map, say
  /// now.
  void rescale_model(std::size_t model, const SampleMap& map, const SvrFunction& function);

  /// All past models have followed. A trial that was to be begins.
  void finish_rescale();

  void visit(Archive& archive);  ///< core/archive.hpp

  /// Memory in bytes, beside the object itself.
  static std::size_t bytes(std::size_t inputs, std::size_t terms,
                           const OnlineSvrSettings& settings);

 private:
  static constexpr std::size_t kRecent = 64;

  /// A sample beside its inputs and terms, and the error of the model in service.
  struct Recent {
    double y = 0.0;
    double t = 0.0;
    double error = 0.0;
  };

  void enter(State state);
  void set_in_service(std::optional<std::size_t> model, double since_s);
  void start_trial(double since_s);
  void average(double error);
  std::optional<std::size_t> agreeing(const SvrFunction& function);
  std::size_t place_for_another();
  void unite(std::size_t kept, std::size_t same);
  double stretched(const SampleMap& map, double difference);

  std::size_t capacity_;
  std::size_t size_ = 0;
  std::vector<PastModel> models_;
  std::int64_t next_number_ = 1;
  SampleStore recent_z_;  ///< the last samples, in a ring
  std::array<Recent, kRecent> recent_{};
  std::size_t observed_ = 0;

  State state_ = State::settling;
  std::int64_t age_ = 0;       ///< samples since a model was taken up or a trial began
  double from_s_ = 0.0;        ///< when the vehicle now in service was first met [s]
  double grown_s_ = 0.0;       ///< on trial: when errors began to grow [s]
  double mean_error_ = 0.0;    ///< of the model in service, recent samples weigh most
  std::int64_t averaged_ = 0;  ///< samples in it
  ErrorAlarm alarm_{kOnline.memory.alarm};
  ModelTrial trial_;
  std::optional<std::size_t> kept_as_;  ///< the place of the model in service; none: not kept yet
  std::int64_t since_kept_ = 0;         ///< samples in service since it was kept last
  std::optional<std::size_t> before_;   ///< that of the model before
  bool first_ = true;                   ///< no other vehicle has been in service yet
  bool outdated_ = false;               ///< the past models are in another scale than samples
  bool another_ = false;        ///< another axis found that the vehicle is none of the past models'
  std::vector<double> sample_;  ///< scratch
};

}  // namespace kelpie
