// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "kelpie/kelpie.h"
#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/model/shared_model.hpp"
#include "kelpie/model/trained_model.hpp"

/// The objects behind the handles of C.
struct kelpie_model {
  std::vector<std::string> inputs;
  std::vector<std::string> targets;
  std::string settings;  ///< all settings, in the form of kelpie_create()
  std::unique_ptr<kelpie::DynamicsModel> own;
  std::unique_ptr<kelpie::SharedModel> shared{};  ///< in place of `own`

  const kelpie::DynamicsModel& model() const { return shared ? shared->model() : *own; }
};

struct kelpie_shared {
  std::unique_ptr<kelpie_model> model;  ///< with `shared`
};

struct kelpie_trained {
  kelpie::TrainedModel model;
  std::vector<std::string> targets;
  std::string alignment;
};

namespace kelpie {

/// A fresh model; `text`: settings in the form of kelpie_create(). Throws InputError.
std::unique_ptr<kelpie_model> made(std::vector<std::string> inputs,
                                   std::vector<std::string> targets, std::string_view text);

/// The model as bytes, with names and settings, complete for loaded().
std::string saved(const kelpie_model& from);
std::unique_ptr<kelpie_model> loaded(std::string_view bytes);

}  // namespace kelpie
