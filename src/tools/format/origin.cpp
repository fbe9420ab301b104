// SPDX-License-Identifier: Apache-2.0
#include "format/origin.hpp"

#include <system_error>
#include <utility>

#include "format/model_json.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/model/trained_model.hpp"
#include "kelpie/motion/term_set.hpp"

namespace kelpie::format {
namespace {

std::variant<TrainedModel, SavedModel> read(const std::filesystem::path& file,
                                            std::vector<LearnedLog>& learned) {
  if (std::error_code none; std::filesystem::is_directory(file, none)) {
    throw InputError({.file = file.string(), .line = 0, .field = {}},
                     "is a folder; name the model.json or the checkpoint.kelpie in it");
  }
  if (is_checkpoint(file)) {
    return saved_model(read_checkpoint(file));
  }
  ModelInfo info;
  TrainedModel model = read_model(file, &info);
  learned = std::move(info.learned);
  return model;
}

// A scaling of this size, to be loaded over.
AxisScaling any_scaling(std::size_t inputs, std::size_t terms) {
  Matrix whitening(inputs, inputs);
  for (std::size_t i = 0; i < inputs; ++i) {
    whitening(i, i) = 1.0;
  }
  return {{std::vector<double>(inputs), whitening}, {}, std::vector<double>(terms, 1.0)};
}

}  // namespace

Origin::Origin(const std::filesystem::path& file)
    : file_(file.string()), saved_(read(file, learned_)) {
  if (const auto* const saved = std::get_if<SavedModel>(&saved_)) {
    inputs_ = saved->inputs;
    targets_ = saved->targets;
    settings_ = saved->settings;
    alignment_ = saved->alignment;
  } else {
    const TrainedModel& trained = std::get<TrainedModel>(saved_);
    inputs_ = trained.input_names;
    targets_ = trained.target_names();
    settings_ = trained.settings;
    alignment_ = trained.alignment;
  }
}

bool Origin::scale_given() const {
  const auto* const saved = std::get_if<SavedModel>(&saved_);
  return saved != nullptr && saved->scale_given;
}

DynamicsModel Origin::fresh(const ModelSettings& settings) const {
  if (!scale_given()) {
    return {inputs_, targets_, settings};
  }
  const TermSet terms = TermSet::from(settings.shared.terms, inputs_, targets_.size());
  const std::vector<AxisScaling> scales(targets_.size(), any_scaling(inputs_.size(), terms.size()));
  return {inputs_, targets_, settings, scales};
}

DynamicsModel Origin::model(const ModelSettings& settings, double start_s) const {
  return in_file(file_, [&] {
    if (const auto* const saved = std::get_if<SavedModel>(&saved_)) {
      return DynamicsModel::resume(fresh(settings), saved->state);
    }
    TrainedModel trained = std::get<TrainedModel>(saved_);
    trained.settings = settings;
    return DynamicsModel::resume_from(trained, start_s);
  });
}

}  // namespace kelpie::format
