// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <string>
#include <vector>

#include "bindings.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/model/trained_model.hpp"
#include "kelpie/vehicle/diagnosis.hpp"
#include "rows.hpp"
#include "turns.hpp"

namespace kelpie::python {

/// A DynamicsModel for Python: learns and predicts blocks of rows, safe from many threads of Python
/// (a reader-writer lock).
class LiveModel {
 public:
  LiveModel(std::vector<std::string> inputs, std::vector<std::string> targets,
            const SettingTexts& settings);

  /// Learns rows x (n, inputs) and y (n, axes) at the times t (n) [s], one after the other. Returns
  /// the decisions (n, axes). After an interrupt, earlier rows stay learned.
  py::array_t<Decision> update(const Array& x, const Array& y, const Array& t);

  /// kelpie::set_nominal(), of the axis of a target.
  void set_nominal(const std::string& target, const std::map<std::string, double>& coefficients);
  /// The same, of the mean of earlier models (study::nominal_of()).
  void set_nominal_models(const std::vector<TrainedModel>& models);

  /// DynamicsModel::learn_held_back().
  void learn_held_back() {
    const WritingTurn turn(turns_);
    model_.learn_held_back();
  }

  Array predict(const Array& x) const;  ///< (n, axes)
  /// (n, axes), for samples `ahead_s` (n) after the last learned sample.
  py::array_t<Prediction> assess(const Array& x, const Array& ahead_s) const;
  py::tuple predict_with_jacobian(const Array& x) const;  ///< (n, axes), (n, axes, inputs)
  py::list status() const;                                ///< one dict per axis
  /// Changes of the vehicle: dict with `findings` and `health`; None without known velocities.
  py::object diagnosis() const;
  /// What the thrusters can still do, with commands between (input, least, most). Throws InputError
  /// as Authority does, and without known velocities.
  Authority authority(const std::vector<std::tuple<std::string, double, double>>& ranges) const;
  Array coefficients() const;  ///< (axes, terms); NaN before there is a model
  std::vector<std::string> terms() const;

  /// A copy of the models in service. Throws InputError before every axis has a model.
  TrainedModel trained() const;

  /// A model that continues to learn from a trained model, from `start_s` [s] on.
  static std::unique_ptr<LiveModel> resume_from(const TrainedModel& trained, double start_s);

  /// The whole state: names, settings, number of samples, and the learners' state with a checksum.
  py::tuple state() const;
  /// The saved model, which continues to the last bit. Throws InputError on a state that is
  /// incomplete or of another version.
  static std::unique_ptr<LiveModel> resume(const py::tuple& state);

  const std::vector<std::string>& inputs() const { return inputs_; }
  const std::vector<std::string>& targets() const { return targets_; }
  const SettingTexts& settings() const { return settings_; }
  /// The lag of commands in the alignment of the model before [s]; 0 without.
  double alignment_s() const { return alignment_.lag_s; }
  py::list actuators() const { return actuators_of(alignment_); }  ///< of the same model
  std::int64_t samples() const;  ///< learned or rejected since the start

 private:
  LiveModel(std::vector<std::string> inputs, std::vector<std::string> targets,
            SettingTexts settings, DynamicsModel model, std::int64_t samples, Alignment alignment);

  auto reading() const {
    turns_.require_whole();
    return [this] { return std::shared_lock(turns_.mutex); };
  }

  std::vector<std::string> inputs_;
  std::vector<std::string> targets_;
  SettingTexts settings_;
  DynamicsModel model_;
  Alignment alignment_;
  std::int64_t samples_ = 0;
  mutable Turns turns_;
};

}  // namespace kelpie::python
