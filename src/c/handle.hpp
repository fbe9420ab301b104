// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "kelpie/kelpie.h"
#include "kelpie/model/dynamics_model.hpp"

/// What C holds a pointer to.
struct kelpie_model {
  std::vector<std::string> inputs;
  std::vector<std::string> targets;
  std::string settings;  ///< every one of them, as kelpie_create() reads them
  kelpie::DynamicsModel model;
};

namespace kelpie {

/// A fresh model; `text` are settings as kelpie_create() reads them. Throws InputError, as the two
/// others do.
std::unique_ptr<kelpie_model> made(std::vector<std::string> inputs,
                                   std::vector<std::string> targets, std::string_view text);

/// As bytes, with all that it was made of, so that loaded() needs nothing else.
std::string saved(const kelpie_model& from);
std::unique_ptr<kelpie_model> loaded(std::string_view bytes);

}  // namespace kelpie
