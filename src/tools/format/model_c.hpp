// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "kelpie/model/trained_model.hpp"
#include "kelpie/motion/unit.hpp"

namespace kelpie::format {

/// Options of the export to C.
struct CodeOptions {
  std::string name = "kelpie_model";  ///< prefix of every public name
  bool single = false;                ///< float instead of double
  bool assess = false;                ///< adds NAME_assess: interval and novelty
  bool casadi = false;                ///< adds the functions called by CasADi and acados
  std::string source = "model.json";  ///< origin of the model, for the comment at the top
  std::map<std::string, Unit> units;  ///< of columns, by name; missing columns have no unit
};

/// A trained model as one file of C99 (docs/howto/controller.md): constant tables and the evaluator
/// model_eval.inc. The file needs exp() alone, and sqrt, sin, cos or pow for formulas with these
/// functions. No allocation and no global state; safe from many threads. Predictions equal
/// TrainedModel::predict_with_jacobian, in double to about 1e-13 of the scale of a target, with NaN
/// for inputs that aren't finite; `assess` adds interval and novelty of TrainedModel::predict.
///
/// Throws InputError on a name other than letters, digits and underscores with a letter first, on a
/// unit for an unknown column, on `casadi` with `single`, and on a number out of range for float.
std::string model_c(const TrainedModel& model, const CodeOptions& options);

/// The header of the exported file: prototypes for C and C++. Throws as model_c() does.
std::string model_h(const TrainedModel& model, const CodeOptions& options);

/// Bytes of the constant tables in flash; code adds some kilobytes. The exported functions use no
/// memory but the stack.
std::size_t table_bytes(const TrainedModel& model, const CodeOptions& options);

}  // namespace kelpie::format
