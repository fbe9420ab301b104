// SPDX-License-Identifier: Apache-2.0
#include "format/model_c.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "format/c_casadi.hpp"
#include "format/c_known.hpp"
#include "format/c_templates.hpp"
#include "format/c_terms.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/text.hpp"
#include "kelpie/model/trained_model.hpp"
#include "model/snapshot.hpp"

namespace kelpie::format {
namespace {

void check(const TrainedModel& model, const CodeOptions& options) {
  if (!can_begin_c_names(options.name)) {
    throw InputError("--name",
                     "'" + options.name +
                         "' can't begin names in C: letters, digits and underscores, first a "
                         "letter, as in kelpie_model");
  }
  if (options.casadi && options.single) {
    throw InputError("--casadi", "calls with double; it doesn't go with --float");
  }
  std::vector<std::string> columns = model.input_names;
  for (const TrainedModel::Axis& axis : model.axes) {
    columns.push_back(axis.name);
  }
  for (const auto& [column, unit] : options.units) {
    if (std::ranges::find(columns, column) == columns.end()) {
      throw InputError("--units", "the model has no column '" + column + "'" +
                                      did_you_mean(column, columns) + "; its columns are " +
                                      join_text(columns, ", "));
    }
  }
}

std::size_t support_vectors(const FunctionMix& function) {
  std::size_t count = 0;
  for (const FunctionMix::Member& member : function.members) {
    count += member.function.beta().size();
  }
  return count;
}

class ModelCode {
 public:
  ModelCode(const TrainedModel& model, const CodeOptions& options)
      : model_(model),
        options_(options),
        text_(options.single),
        terms_(code_of(model.terms, text_)) {
    targets_ = model.target_names();
  }

  std::string file() const {
    return comment() + "\n#include <math.h>\n" + filled(kPrototypes) +
           names("input", model_.input_names) + names("target", targets_) + filled(kAxis) +
           tables() + filled(terms_.helpers) + term_function() + filled(kKernel) +
           filled(kEvaluate) +
           (options_.assess ? filled(known_tables(model_, text_)) + filled(kAssess) : "") +
           (options_.casadi ? filled(kCasadi) : "");
  }

  std::string header() const {
    return comment() + filled(kHeader) + filled(kPrototypes) + filled(kHeaderEnd);
  }

 private:
  std::string filled(std::string_view code) const {
    std::vector<std::pair<std::string, std::string>> words{
        {"@TERMS", model_.terms.size() > 0 ? "" : "@"},
        {"@SLOPES", terms_.slopes.empty() ? "@" : ""},
        {"@ASSESS", options_.assess ? "" : "@"},
        {"$INPUTS", std::to_string(model_.input_names.size())},
        {"$TARGETS", std::to_string(targets_.size())},
        {"$TERMS", std::to_string(model_.terms.size())},
        {"$SLOPES", std::to_string(terms_.slopes.size())},
        {"$SLOPE", terms_.slopes.empty() ? "0" : "jacobian ? slope : 0"},
        {"$EXP", library_name("exp")},
        {"$NOBODY", text_.number(KernelDensity::kEmptyDensity)},
        {"$REAL", text_.real()},
        {"$NAME", options_.name}};
    for (const std::string_view call : kLibraryCalls) {
      words.emplace_back("$" + std::string(call), library_name(call));
    }
    return without_lines(replaced(std::string(code), words), '@');
  }

  std::string library_name(std::string_view function) const {
    return std::string(function) + (options_.single ? "f" : "");
  }

  // What the file calls of the mathematical library.
  std::string library() const {
    std::string list = library_name("exp");
    for (const std::string_view call : kLibraryCalls) {
      if (terms_.body.find("$" + std::string(call) + "(") != std::string::npos) {
        list += ", " + library_name(call);
      }
    }
    return list;
  }

  std::string unit_of(const std::string& column) const {
    const auto found = options_.units.find(column);
    return found == options_.units.end() ? "" : found->second.text();
  }

  std::string column_lines(const char* array, std::span<const std::string> columns) const {
    std::string lines;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::string unit = unit_of(columns[i]);
      lines += fmt::format(" *   {}[{}]  {}{}\n", array, i, c_string(columns[i]),
                           unit.empty() ? "" : ", unit " + c_string(unit));
    }
    return lines;
  }

  // What a caller has to know of the commands; nothing where they weren't shifted.
  std::string alignment() const {
    const Alignment& shift = model_.alignment;
    if (shift.none()) {
      return "";
    }
    return fmt::format(
        " * Alignment: a prediction belongs to the commands that the log has {:.4g} s {}.\n"
        " *   Commands: {}\n",
        std::abs(shift.lag_s), shift.lag_s > 0.0 ? "later" : "earlier",
        c_string(join_text(shift.commands, ", ")));
  }

  std::string comment() const {
    std::string gaps;
    for (const TrainedModel::Axis& axis : model_.axes) {
      gaps += fmt::format(" *   {}: {} support vectors, KKT gap {:.3g} of its standard deviation\n",
                          c_string(axis.name), support_vectors(axis.function), axis.kkt_gap);
    }
    return fmt::format(
        "/* A learned model of a vehicle's dynamics, written by `kelpie export` from\n"
        " * {}\n *\n * Inputs:\n{} * Predictions:\n{}{} * Learned:\n{} *\n"
        " *   {} x[{}] = {{...}}, y[{}], jacobian[{}];\n"
        " *   {}_predict(x, y);\n"
        " *   {}_predict_with_jacobian(x, y, jacobian);\n *\n"
        " * jacobian[i * {} + j] is the derivative of y[i] by x[j]; at a kink of a term, that to\n"
        " * the right. Where a number of x isn't finite, y and jacobian are NaN.\n{}"
        " * Of <math.h>: {}. C99; no memory is asked for and nothing global changes, so that "
        "calls\n"
        " * may run side by side. */\n",
        c_string(options_.source), column_lines("x", model_.input_names),
        column_lines("y", targets_), alignment(), gaps, text_.real(), model_.input_names.size(),
        targets_.size(), targets_.size() * model_.input_names.size(), options_.name, options_.name,
        model_.input_names.size(), options_.assess ? filled(kAssessNote) : "", library());
  }

  std::string names(const char* kind, std::span<const std::string> columns) const {
    std::string names;
    std::string units;
    for (const std::string& column : columns) {
      names += (names.empty() ? "" : ", ") + c_string(column);
      units += (units.empty() ? "" : ", ") + c_string(unit_of(column));
    }
    return fmt::format(
        "\nconst char *const {0}_{1}_names[{2}] = {{{3}}};\n"
        "const char *const {0}_{1}_units[{2}] = {{{4}}};\n",
        options_.name, kind, columns.size(), names, units);
  }

  // C has no empty arrays: where no member has a support vector there is one without a weight.
  std::string tables() const {
    std::string axes;
    std::string members;
    std::string vectors;
    std::string weights;
    std::size_t member_count = 0;
    std::size_t count = 0;
    for (const TrainedModel::Axis& axis : model_.axes) {
      axes += axis_entry(axis, member_count);
      member_count += axis.function.members.size();
      for (const FunctionMix::Member& member : axis.function.members) {
        const std::span<const double> beta = member.function.beta();
        members += member_entry(axis.scaling, member, count);
        std::vector<double> z(model_.input_names.size());
        for (std::size_t i = 0; i < beta.size(); ++i) {
          member.function.support_vectors().get(i, z);
          vectors += "  " + text_.list(z) + ",\n";
          weights += "  " + text_.number(axis.scaling.target.scale * beta[i]) + ",\n";
        }
        count += beta.size();
      }
    }
    if (count == 0) {
      const std::vector<double> nowhere(model_.input_names.size());
      vectors = "  " + text_.list(nowhere) + ",\n";
      weights = "  " + text_.number(0.0) + ",\n";
      count = 1;
    }
    const std::string start = "static const " + std::string(text_.real()) + " " + options_.name;
    return filled("static const struct $NAME_axis $NAME_axes[$TARGETS] = {\n") + axes + "};\n\n" +
           filled(fmt::format("static const struct $NAME_member $NAME_members[{}] = {{\n",
                              member_count)) +
           members + "};\n\n" + start +
           filled(fmt::format("_support_vectors[{}][$INPUTS] = {{\n", count)) + vectors + "};\n\n" +
           start + fmt::format("_weights[{}] = {{\n", count) + weights + "};\n";
  }

  std::string axis_entry(const TrainedModel::Axis& axis, std::size_t first) const {
    const auto& [input, target, term_scale] = axis.scaling;
    std::string rows;
    for (std::size_t i = 0; i < input.whitening.rows(); ++i) {
      rows += (i > 0 ? ",\n    " : "") + text_.list(input.whitening.row(i));
    }
    return fmt::format(
        "  {{ {}, {}, {}, {},\n   {},\n   {{{}}} }},\n", first,
        first + axis.function.members.size(), text_.bound(target.invert(axis.function.limits.low)),
        text_.bound(target.invert(axis.function.limits.high)), text_.list(input.mean), rows);
  }

  std::string member_entry(const AxisScaling& scaling, const FunctionMix::Member& member,
                           std::size_t first) const {
    const SvrFunction& function = member.function;
    const KernelWeights& weights = function.kernel().weights();
    std::vector<double> coefficients;
    for (std::size_t k = 0; k < scaling.term_scale.size(); ++k) {
      coefficients.push_back(scaling.target.scale * function.term_weights()[k] /
                             scaling.term_scale[k]);
    }
    return fmt::format("  /* {} */\n  {{ {}, {}, {}, {}, {}, {}, {}{} }},\n", member.name,
                       text_.number(member.share), first, first + function.beta().size(),
                       text_.number(function.kernel().local().gamma()), text_.number(weights.s),
                       text_.number(weights.fine),
                       text_.number(scaling.target.invert(function.bias())),
                       coefficients.empty() ? "" : ",\n   " + text_.list(coefficients));
  }

  std::string term_function() const {
    if (model_.terms.size() == 0) {
      return "";
    }
    std::string tables;
    if (!terms_.slopes.empty()) {
      std::string terms;
      std::string columns;
      for (const auto& [term, column] : terms_.slopes) {
        terms += fmt::format("{}{}", terms.empty() ? "" : ", ", term);
        columns += fmt::format("{}{}", columns.empty() ? "" : ", ", column);
      }
      tables = fmt::format(
          "\n/* Which term's slope by which input each is. */\n"
          "static const int $NAME_slope_term[$SLOPES] = {{{}}};\n"
          "static const int $NAME_slope_column[$SLOPES] = {{{}}};\n",
          terms, columns);
    }
    return filled(tables +
                  "\nstatic void $NAME_terms(const $REAL *x, $REAL *phi, $REAL *slope)\n{\n"
                  "  (void)x;\n  (void)slope;\n" +
                  terms_.body + "}\n");
  }

  const TrainedModel& model_;
  const CodeOptions& options_;
  CText text_;
  TermCode terms_;
  std::vector<std::string> targets_;
};

}  // namespace

std::string model_c(const TrainedModel& model, const CodeOptions& options) {
  check(model, options);
  try {
    return ModelCode(model, options).file();
  } catch (const InputError& error) {
    throw InputError({.file = options.source, .line = 0, .field = {}}, error.what());
  }
}

std::string model_h(const TrainedModel& model, const CodeOptions& options) {
  check(model, options);
  return ModelCode(model, options).header();
}

}  // namespace kelpie::format
