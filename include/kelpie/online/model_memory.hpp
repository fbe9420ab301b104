// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "kelpie/online/error_alarm.hpp"
#include "kelpie/online/online_svr.hpp"
#include "kelpie/online/past_model.hpp"

namespace kelpie {

/// The memory of past models of one axis (the paper's future work). While errors stay as usual, the
/// model in service is kept, and its picture renewed. When they grow (ErrorAlarm), the picture is
/// left as it is, and all past models are tried on the samples since then and on those that follow.
/// One that fits is the vehicle as it was known: its errors are as usual for it, and far below
/// those of the model in service. If none fits, what settles next is another model, unless it
/// agrees with a past one. The store is bounded: when it is full, the model leaves that was
/// recalled least, and of these the one longest out of service.
///
/// Memory: bytes(). Cost per sample: a copy of it, and for 200 samples after an alarm a prediction
/// per past model, at most 64 of them at its beginning; every 64 samples without alarm a copy of
/// the buffer. Allocates in the constructor only.
class ModelMemory {
 public:
  /// Room for `settings.memory` models of learners with such a buffer; without room nothing is ever
  /// kept.
  ModelMemory(const SampleCollector& buffer, const OnlineSvrSettings& settings);

  std::size_t capacity() const { return capacity_; }
  std::span<const PastModel> models() const { return {models_.data(), size_}; }

  /// One more sample, and how far the model in service was off before it was learned.
  void observe(std::span<const double> z, double y, double error, double t);

  /// As OnlineRegressor::alert().
  void alert(double since_s, bool another);

  /// Whether it is time to keep the model in service.
  bool due() const { return capacity_ > 0 && quiet_ >= kSettled && quiet_ % kKeepEvery == 0; }
  void keep(const OnlineSvr& service, double t);  ///< A newer picture of one, or another.

  /// The past model that is the vehicle's, the latest sample included.
  std::optional<std::size_t> fitting() const;

  /// When the vehicle now in service was first met [s]; with a past model that fits: since when
  /// errors have grown.
  double since() const { return from_s_; }

  /// What is in service from now on: a past model, or one that is new.
  void take_up(std::optional<std::size_t> model, double t);

  /// Takes in a model from elsewhere. Requires room, and one made for the same buffer with a number
  /// that is no other's.
  void add(const PastModel& model);

  /// Goes over to another scale; `solve` learns a past model's samples afresh.
  void restate(const SampleMap& map, const std::function<void(PastModel&)>& solve);

  void visit(Archive& archive);  ///< core/archive.hpp

  /// Memory in bytes, beside the object itself.
  static std::size_t bytes(std::size_t dimension, const OnlineSvrSettings& settings);

 private:
  static constexpr std::int64_t kSettled = 192;  ///< samples without alarm before a model is kept
  static constexpr std::int64_t kKeepEvery = 64;

  static constexpr std::size_t kRecent = 64;

  /// A sample beside its inputs and terms, and the error of the model in service.
  struct Recent {
    double y = 0.0;
    double t = 0.0;
    double error = 0.0;
  };
  /// How a past model does since errors have grown, in its own usual errors, summed up.
  struct Trial {
    double lead = 0.0;   ///< over the model in service
    double error = 0.0;  ///< its own
  };

  bool watch(double error, double t);
  void try_recent(double since_s);
  void try_all(std::span<const double> z, const Recent& sample);
  bool same_place(std::span<const double> z);
  std::optional<std::size_t> agreeing(const SvrFunction& function);
  std::size_t place_for_another();
  double stretched(const SampleMap& map, double difference);

  std::size_t capacity_;
  std::size_t size_ = 0;
  std::vector<PastModel> models_;
  std::vector<Trial> trials_;
  SampleStore recent_z_;  ///< the last samples, in a ring
  std::array<Recent, kRecent> recent_{};
  std::size_t observed_ = 0;
  int tried_ = 0;                          ///< samples of the trials
  int trial_ = 0;                          ///< samples since they began; 0: there is none
  SampleStore last_;                       ///< the latest sample that was tried on
  std::optional<std::size_t> in_service_;  ///< where the model in service is kept
  bool another_ = false;                   ///< its vehicle is none of the past models'
  double from_s_ = 0.0;                    ///< when its vehicle was first met
  double usual_ = 0.0;                     ///< mean error of the model in service
  std::int64_t seen_ = 0;                  ///< samples that went into it
  std::int64_t service_ = 0;               ///< samples since it was kept last
  ErrorAlarm alarm_{10.0};                 ///< four bad samples in a row at least
  std::int64_t quiet_ = 0;                 ///< samples without alarm
  std::int64_t next_number_ = 1;
  std::vector<double> sample_;  ///< scratch
};

}  // namespace kelpie
