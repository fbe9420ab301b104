// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "kelpie/model/trained_model.hpp"
#include "kelpie/motion/unit.hpp"

namespace kelpie::format {

/// How a model is written as C.
struct CodeOptions {
  std::string name = "kelpie_model";  ///< what all names begin with
  bool single = false;                ///< float instead of double
  bool assess = false;                ///< interval and novelty, too
  bool casadi = false;                ///< the functions that CasADi and acados call, too
  std::string source = "model.json";  ///< where the model comes from, for the comment at the top
  std::map<std::string, Unit> units;  ///< of columns, by name; others have none
};

/// A trained model as one file of C99 that needs nothing but exp() (docs/controller.md): no memory
/// is asked for, nothing global changes, calls may run side by side. It predicts as
/// TrainedModel::predict_with_jacobian does, in double to about 1e-13 of a target's scale, NaN
/// where a number isn't finite; with `assess` it has the interval and the novelty of
/// TrainedModel::predict. sqrt, sin, cos and pow are called where a formula of the model wants
/// them.
///
/// Throws InputError on a name that isn't of letters, digits and underscores with a letter first, a
/// unit of a column that the model doesn't have, `casadi` with `single`, and a number out of a
/// float's range.
std::string model_c(const TrainedModel& model, const CodeOptions& options);

/// What a caller of it includes: its prototypes, in C and C++. Throws as model_c() does.
std::string model_h(const TrainedModel& model, const CodeOptions& options);

/// What the numbers of the file take in flash; some kilobytes of code come with them. It takes no
/// memory but the stack.
std::size_t table_bytes(const TrainedModel& model, const CodeOptions& options);

}  // namespace kelpie::format
