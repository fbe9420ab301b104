// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "kelpie/svr/online_svr.hpp"
#include "learner/error_alarm.hpp"
#include "learner/model_trial.hpp"
#include "learner/term_change.hpp"
#include "learner/tuning.hpp"
#include "svr/past_model.hpp"

namespace kelpie {

/// The store of past models of one axis (the paper's future work). The store monitors the errors of
/// the model in service one step ahead, in three states:
///
///     settling   learns the usual error           → watching  after 192 samples
///     watching   compares errors with the usual   → on_trial  errors have grown (ErrorAlarm)
///     on_trial   tries the past models            → watching  a past model fits and is recalled
///                (ModelTrial)                     → settling  no fit within 200 samples
///     any state                                   → settling  a challenger took over
///                                                 → on_trial  alert of another axis
///
/// A trial begins with the latest samples, from the start of grown errors.
/// reference/architecture.md has the states together with the other mechanisms.
///
/// The model in service is due for a copy 192 samples after the last of these events and then every
/// 64 samples. The copy replaces the former copy of the same model, or takes a new place. A model
/// without a copy that agrees with a past model is not copied, since the model may still be
/// changing; after 1,024 samples in agreement both are one model. A full store drops the model with
/// the fewest recalls, then the model longest out of service.
///
/// Memory: bytes(). Cost per sample: a copy of the sample; on trial a prediction per past model,
/// and at the start of a trial for up to 64 samples; keep() copies the buffer. Allocates in the
/// constructor only.
class PastModels {
 public:
  /// See the table above.
  enum class State : std::uint8_t { settling, watching, on_trial };

  /// Room for `settings.memory` models of learners with such a buffer.
  PastModels(const SampleCollector& buffer, const OnlineSvrSettings& settings);

  State state() const { return state_; }
  std::size_t capacity() const { return capacity_; }
  std::span<const PastModel> models() const { return {models_.data(), size_}; }

  /// Processes a sample and the error |y − f(x)| of the model in service before learning.
  void observe(std::span<const double> z, double y, double error, double t);

  /// OnlineRegressor::alert().
  void alert(double since_s, bool another);

  /// Whether a copy of the model in service is due.
  bool due() const {
    return state_ == State::watching && age_ >= kOnline.memory.settled &&
           age_ % kOnline.memory.keep_every == 0;
  }
  /// Copies the model in service, with the change since its samples; `function`: with this
  /// change. Cost O(n d).
  void keep(const OnlineSvr& service, const SvrFunction& function, const TermChange& change,
            double t);

  /// The past model that fits, the latest sample included; on trial only.
  std::optional<std::size_t> fitting() const;

  /// Start of the present vehicle [s]; on trial: start of the grown errors [s].
  double since() const { return state_ == State::on_trial ? grown_s_ : from_s_; }

  /// Reports a past model in service, with the start of its vehicle [s].
  void recall(std::size_t model, double since_s);
  /// Reports a challenger in service, with the start of its vehicle [s].
  void promote_challenger(double since_s);
  /// Reports a step of the model in service: nothing is known of its errors.
  void settle() { enter(State::settling); }
  /// Reports the withdrawal of the last change: the former model is in service again.
  void withdraw();

  /// Adds a model of another source. Requires room, an equal buffer, and a new number.
  void add(const PastModel& model);

  /// Reports another scale of the samples. Trials are suspended until finish_rescale(); the caller
  /// moves every past model by rescale_model().
  void rescale(const SampleMap& map);

  /// Moves a past model to the new scale; `function` was learned from the mapped samples.
  void rescale_model(std::size_t model, const SampleMap& map, const SvrFunction& function);

  /// Resumes trials after the last past model; starts a suspended trial.
  void finish_rescale();

  void visit(Archive& archive);  ///< core/archive.hpp

  /// Memory in bytes, beside the object itself.
  static std::size_t bytes(std::size_t inputs, std::size_t terms,
                           const OnlineSvrSettings& settings);

 private:
  static constexpr std::size_t kRecent = 64;

  /// Target and time of a sample, and the error of the model in service.
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

  std::size_t capacity_;
  std::size_t size_ = 0;
  std::vector<PastModel> models_;
  std::int64_t next_number_ = 1;
  SampleStore recent_z_;  ///< the last samples, in a ring
  std::array<Recent, kRecent> recent_{};
  std::size_t observed_ = 0;

  State state_ = State::settling;
  std::int64_t age_ = 0;       ///< samples since the last change of state by an event
  double from_s_ = 0.0;        ///< start of the present vehicle [s]
  double grown_s_ = 0.0;       ///< on trial: start of the grown errors [s]
  double mean_error_ = 0.0;    ///< of the model in service, a running mean
  std::int64_t averaged_ = 0;  ///< samples in `mean_error_`
  ErrorAlarm alarm_{kOnline.memory.alarm};
  ModelTrial trial_;
  std::optional<std::size_t> kept_as_;  ///< place of the copy of the model in service
  std::int64_t since_kept_ = 0;         ///< samples in service since the last copy
  std::optional<std::size_t> before_;   ///< `kept_as_` of the former model
  bool first_ = true;                   ///< the first vehicle is in service
  bool outdated_ = false;               ///< past models and samples have different scales
  bool another_ = false;                ///< another axis reported an unknown vehicle
  std::vector<double> sample_;          ///< scratch
};

}  // namespace kelpie
