// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include "files/model_block.hpp"
#include "kelpie/model/trained_model.hpp"
#include "kelpie/motion/unit.hpp"

namespace kelpie::format {

/// The block with the numbers of an exported model, which a learner renews.
struct LiveBlock {
  std::string file;  ///< opened by the exported model
  BlockLayout layout;
};

/// Options of the export to C.
struct CodeOptions {
  std::string name = "kelpie_model";  ///< prefix of every public name
  bool single = false;                ///< float instead of double
  bool assess = false;                ///< adds NAME_assess: interval and novelty
  bool hessian = false;               ///< adds NAME_hessian and NAME_hessian_vector
  bool casadi = false;  ///< adds the functions called by CasADi and acados; hessian, too
  std::string source = "model.json";  ///< origin of the model, for the comment at the top
  std::map<std::string, Unit> units;  ///< of columns, by name; missing columns have no unit
  std::optional<LiveBlock> live{};    ///< numbers from a block in place of constant tables
};

/// A trained model as one file of C99 (docs/howto/controller.md): constant tables and the evaluator
/// model_eval.inc. The file needs exp() alone, and sqrt, sin, cos or pow for formulas with these
/// functions. No allocation and no global state; safe from many threads. Predictions equal
/// TrainedModel::predict_with_jacobian, in double to about 1e-13 of the scale of a target, with NaN
/// for inputs that aren't finite; `assess` adds interval and novelty of TrainedModel::predict,
/// `hessian` the second derivatives in closed form (model_curve.inc), 0 of x|x| at 0.
///
/// With `live` the terms alone are constant, and model_block.inc reads all other numbers: the file
/// then needs POSIX, and copies the latest publication into memory of the calling thread.
///
/// Throws InputError on a name other than letters, digits and underscores with a letter first, on a
/// unit for an unknown column, on `casadi` or `live` with `single`, and on a number out of range
/// for float.
std::string model_c(const TrainedModel& model, const CodeOptions& options);

/// The header of the exported file: prototypes for C and C++. Throws as model_c() does.
std::string model_h(const TrainedModel& model, const CodeOptions& options);

/// Bytes of the constant tables in flash; code adds some kilobytes. The exported functions use no
/// memory but the stack.
std::size_t table_bytes(const TrainedModel& model, const CodeOptions& options);

}  // namespace kelpie::format
