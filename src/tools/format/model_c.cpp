// SPDX-License-Identifier: Apache-2.0
#include "format/model_c.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <set>
#include <utility>

#include "core/text.hpp"
#include "format/c_templates.hpp"
#include "format/c_text.hpp"
#include "kelpie/core/error.hpp"
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
  if (options.live && options.single) {
    throw InputError("--live", "renews doubles; it doesn't go with --float");
  }
  if (options.casadi && options.single) {
    throw InputError("--casadi", "calls with double; it doesn't go with --float");
  }
  std::vector<std::string> columns = model.input_names;
  for (const TrainedModel::Axis& axis : model.axes) {
    columns.push_back(axis.name);
  }
  for (const auto& [column, unit] : options.units) {
    require_name("--units", column, "column of the model", columns);
  }
}

std::size_t support_vectors(const FunctionMix& function) {
  std::size_t count = 0;
  for (const FunctionMix::Member& member : function.members) {
    count += member.function.beta().size();
  }
  return count;
}

// The steps of model_eval.inc, in the order of Expression::Code.
constexpr std::array<std::string_view, 16> kSteps{
    "number", "column", "add",  "subtract", "multiply", "divide", "pow", "negate",
    "abs",    "sign",   "sqrt", "sin",      "cos",      "tanh",   "min", "max"};

// Powers up to this one are multiplied out.
constexpr double kLargestWholePower = 64.0;

// Physics terms as rows of the tables in model_eval.inc.
struct TermTables {
  std::string steps;
  std::string ends;
  std::string slopes;  ///< never empty: C has no empty arrays
  std::size_t step_count = 0;
  std::size_t slope_count = 0;
  std::size_t pair_count = 0;                   ///< of columns of one term
  int depth = 0;                                ///< of the stack
  std::set<std::string_view> functions{"exp"};  ///< of <math.h> that the terms call, and exp
};

TermTables tables_of(const TermSet& terms, const CText& text) {
  TermTables tables;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    tables.steps += fmt::format("  /* {} */\n", c_string(terms.text(k)));
    int depth = 0;
    for (const Expression::Step& step : terms.term(k).steps()) {
      std::string_view name = kSteps.at(static_cast<std::size_t>(step.code));
      std::size_t index = step.column;
      double number = step.number;
      if (name == "pow" && number == std::floor(number) && number <= kLargestWholePower) {
        name = "power";
        index = static_cast<std::size_t>(std::exchange(number, 0.0));
      } else if (name == "pow" || name == "sqrt") {
        tables.functions.insert(name);
      } else if (name == "sin" || name == "cos") {
        tables.functions.insert({"sin", "cos"});  // the slope of one is the other
      }
      tables.steps += fmt::format("  {{kelpie_{}, {}, {}}},\n", name, index, text.number(number));
      ++tables.step_count;
      depth += 1 - step.operands();
      tables.depth = std::max(tables.depth, depth);
    }
    tables.ends += fmt::format("{}{}", k > 0 ? ", " : "", tables.step_count);
    for (const std::size_t column : terms.term(k).columns()) {
      tables.slopes += fmt::format("  {{{}, {}}},\n", k, column);
      ++tables.slope_count;
    }
    const std::size_t columns = terms.term(k).columns().size();
    tables.pair_count += columns * (columns + 1) / 2;
  }
  if (tables.slope_count == 0) {
    tables.slopes = "  {0, 0},\n";
    tables.slope_count = 1;
    tables.pair_count = 1;
  }
  return tables;
}

class ModelCode {
 public:
  ModelCode(const TrainedModel& model, const CodeOptions& options)
      : model_(model),
        options_(options),
        text_(options.single),
        terms_(tables_of(model.terms, text_)),
        targets_(model.target_names()) {
    for (std::size_t k = 0; !live() && k < model.alignment.actuators.size(); ++k) {
      if (!model.alignment.actuators[k].none()) {
        actuators_.push_back(k);
      }
    }
    for (std::size_t k = 0; live() && k < model.input_names.size(); ++k) {
      actuators_.push_back(k);  // any command may turn out to have one
    }
    if (!actuators_.empty()) {
      terms_.functions.insert("expm1");
    }
  }

  std::string file() const {
    return comment() + includes() + prototypes() + names("input", model_.input_names) +
           names("target", targets_) + definitions() + without_licence(kModelEvaluator) +
           (hessian() ? without_licence(kModelCurve) : "") +
           (live() ? without_licence(kModelBlock) + term_tables() + live_functions()
                   : tables() + functions()) +
           actuators() + (options_.casadi ? casadi() : "");
  }

  std::string header() const {
    return comment() + filled(kHeader) + prototypes() + filled(kHeaderEnd);
  }

 private:
  bool live() const { return options_.live.has_value(); }
  bool hessian() const { return options_.hessian || options_.casadi; }

  std::string includes() const {
    return live() ? "\n#define _POSIX_C_SOURCE 200809L\n#include <fcntl.h>\n#include <math.h>\n"
                    "#include <stddef.h>\n#include <string.h>\n#include <sys/mman.h>\n"
                    "#include <sys/stat.h>\n#include <unistd.h>\n"
                  : "\n#include <math.h>\n";
  }

  std::string filled(std::string_view code) const {
    const std::vector<std::pair<std::string, std::string>> words{
        {"$INPUTS", std::to_string(model_.input_names.size())},
        {"$TARGETS", std::to_string(targets_.size())},
        {"$ACTUATORS", std::to_string(actuators_.size())},
        {"$KEPT", std::to_string(most_kept())},
        {"$DELAY_STEPS", std::to_string(kDelaySteps)},
        {"$REAL", text_.real()},
        {"$ROW", live() ? "$NAME_actuator_of(i)" : "$NAME_actuator_table[i]"},
        {"$FAILED", live() ? "kelpie_own()->number == 0" : "0"},
        {"$POINT", model_.terms.size() == 0 ? ""
                                            : "  if (own) {\n"
                                              "    own->tables.steps = $NAME_steps;\n"
                                              "    own->tables.ends = $NAME_ends;\n"
                                              "    own->tables.slopes = $NAME_slopes;\n  }\n"},
        {"$NAME", options_.name}};
    return replaced(std::string(code), words);
  }

  std::string prototypes() const {
    return filled(kPrototypes) + (hessian() ? filled(kHessianPrototypes) : "") +
           (options_.assess ? filled(kAssessPrototype) : "") +
           (actuators_.empty() ? "" : filled(kActuatorPrototypes)) +
           (live() ? filled(kLivePrototypes) : "");
  }

  int most_kept() const {
    const bool late =
        live() || std::ranges::any_of(model_.alignment.actuators, [](const Actuator& actuator) {
          return actuator.delay_s > 0.0;
        });
    return late ? kDelaySteps + 4 : 2;
  }

  std::string actuators() const {
    if (actuators_.empty()) {
      return "";
    }
    const std::string type = filled(
        "\nstruct $NAME_actuator {\n  int input;\n"
        "  $REAL neutral, dead_band, astern, lag, rate, delay;\n};\n");
    if (live()) {
      return type + filled(kLiveActuator) + filled(kActuators);
    }
    std::string rows;
    for (const std::size_t k : actuators_) {
      const std::string& command = model_.alignment.commands[k];
      const auto input = std::ranges::find(model_.input_names, command);
      rows += fmt::format("  {{{}", input - model_.input_names.begin());
      for (const Actuator::Field& field : Actuator::fields()) {
        rows += ", " + text_.number(model_.alignment.actuators[k].*field.number);
      }
      rows += "}, /* " + c_string(command) + " */\n";
    }
    return type + table("struct $NAME_actuator", "actuator_table[$ACTUATORS]", rows) +
           filled(kActuators);
  }

  // What model_eval.inc wants to be defined.
  std::string definitions() const {
    std::string text = filled("\n#define KELPIE_REAL $REAL\n");
    for (const std::string_view function : terms_.functions) {
      std::string macro(function);
      std::ranges::transform(macro, macro.begin(),
                             [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
      text += fmt::format("#define KELPIE_{} {}\n", macro, library_name(function));
    }
    text += fmt::format(
        "#define KELPIE_INPUTS {}\n#define KELPIE_TARGETS {}\n#define KELPIE_TERMS {}\n",
        model_.input_names.size(), targets_.size(), model_.terms.size());
    text += fmt::format("#define KELPIE_SLOPES {}\n#define KELPIE_STACK {}\n", terms_.slope_count,
                        terms_.depth);
    text += hessian() ? fmt::format("#define KELPIE_PAIRS {}\n", terms_.pair_count) : "";
    if (live()) {
      const auto& [file, layout] = *options_.live;
      text += fmt::format(
          "#define KELPIE_FILE {}\n#define KELPIE_IDENTITY {:#018x}ULL\n"
          "#define KELPIE_LANES {}\n#define KELPIE_MEMBERS {}\n#define KELPIE_VECTORS {}\n#define "
          "KELPIE_PLACES {}\n",
          c_string(file), layout.identity, BlockLayout::kLanes, layout.members, layout.vectors,
          layout.places);
    }
    return text + (options_.assess ? fmt::format("#define KELPIE_ASSESS {}\n",
                                                 text_.number(KernelDensity::kEmptyDensity))
                                   : "");
  }

  static std::string without_licence(std::string_view file) {
    return "\n" + std::string(file.substr(file.find('\n') + 1));
  }

  std::string functions() const {
    return filled(kFunctions) + (hessian() ? filled(kHessian) : "") +
           (options_.assess ? filled(kAssess) : "");
  }

  std::string live_functions() const {
    return filled(kLiveFunctions) + (hessian() ? filled(kLiveHessian) : "") +
           (options_.assess ? filled(kLiveAssess) : "");
  }

  std::string casadi() const {
    const auto shape = [this](const std::string& function, int order, const std::string& result,
                              const char* output) {
      const std::vector<std::pair<std::string, std::string>> words{
          {"$F", function},
          {"$ARGUMENTS", std::to_string(order + 1)},
          {"$RESULTS", order < 2 ? "1" : "2"},
          {"$RESULT_NAME", result + (order < 2 ? "" : "_x")},
          {"$RESULT_NONE", result + "_out_y"},
          {"$SHAPE", output}};
      return filled(replaced(std::string(kCasadiShape), words));
    };
    return filled(kCasadi) + shape("$NAME", 0, "y", "y") +
           shape("jac_$NAME", 1, "jac_y_x", "jacobian") +
           shape("jac_jac_$NAME", 2, "jac_jac_y_x", "hessian");
  }

  std::string library_name(std::string_view function) const {
    return std::string(function) + (options_.single ? "f" : "");
  }

  // The functions of <math.h> that the file calls, exp first.
  std::string library() const {
    std::string list = library_name("exp");
    for (const std::string_view function : terms_.functions) {
      list += function == "exp" ? "" : ", " + library_name(function);
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
  std::string shift() const {
    const Alignment& shift = model_.alignment;
    const Current& water = shift.water;
    std::string current =
        water.none() ? ""
                     : fmt::format(
                           " * {} and {} are velocities through the water, and accelerations are "
                           "against the\n * water: add the current to get over ground.\n",
                           c_string(water.surge), c_string(water.sway));
    if (!shift.shifts()) {
      return current;
    }
    return current +
           fmt::format(
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
        " * the right. Where a number of x isn't finite, y and jacobian are NaN.\n{}{}{}"
        " * Of <math.h>: {}. C99{} */\n",
        c_string(options_.source), column_lines("x", model_.input_names),
        column_lines("y", targets_), shift(), gaps, text_.real(), model_.input_names.size(),
        targets_.size(), targets_.size() * model_.input_names.size(), options_.name, options_.name,
        model_.input_names.size(),
        (hessian() ? filled(kHessianNote) : "") + (options_.assess ? filled(kAssessNote) : ""),
        actuators_.empty() ? "" : filled(kActuatorNote), live() ? filled(kLiveNote) : "", library(),
        live() ? ", POSIX. Calls may run side by side: every thread has a copy of the numbers."
               : "; no memory is asked for and nothing global changes, so that calls\n"
                 " * may run side by side.");
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

  // A constant array. C has no empty arrays: one without rows holds `row`.
  std::string table(const std::string& type, const std::string& declarator, const std::string& rows,
                    const std::string& row = "") const {
    return filled(fmt::format("\nstatic const {} $NAME_{} = {{\n", type, declarator)) +
           (rows.empty() ? row : rows) + "};\n";
  }

  std::string point(std::span<const double> z) const { return "  " + text_.list(z) + ",\n"; }

  std::string tables() const {
    std::string axes;
    std::string members;
    std::string vectors;
    std::string weights;
    std::size_t member_count = 0;
    std::size_t count = 0;
    std::vector<double> z(model_.input_names.size());
    for (const TrainedModel::Axis& axis : model_.axes) {
      axes += axis_entry(axis, member_count);
      member_count += axis.function.members.size();
      for (const FunctionMix::Member& member : axis.function.members) {
        const std::span<const double> beta = member.function.beta();
        members += member_entry(axis.scaling, member, count);
        for (std::size_t i = 0; i < beta.size(); ++i) {
          member.function.support_vectors().get(i, z);
          vectors += point(z);
          weights += "  " + text_.number(axis.scaling.target.scale * beta[i]) + ",\n";
        }
        count += beta.size();
      }
    }
    const bool terms = model_.terms.size() > 0;
    const std::string none = point(std::vector<double>(z.size()));
    std::string text = table("struct kelpie_axis", "axes[]", axes) +
                       table("struct kelpie_member", "members[]", members) +
                       table("$REAL", "support_vectors[][$INPUTS]", vectors, none) +
                       table("$REAL", "weights[]", weights, "  0\n");
    text += term_tables();
    text += options_.assess ? known_tables(none) : "";
    const char* const fields = "  $NAME_axes, $NAME_members, $NAME_support_vectors, $NAME_weights";
    return text +
           table("struct kelpie_tables", "tables",
                 filled(fields +
                        std::string(terms ? ",\n  $NAME_steps, $NAME_ends, $NAME_slopes" : "") +
                        (options_.assess ? ",\n  $NAME_known, $NAME_places, $NAME_densities" : "") +
                        "\n"));
  }

  std::string term_tables() const {
    return model_.terms.size() == 0 ? ""
                                    : table("struct kelpie_step", "steps[]", terms_.steps) +
                                          table("short", "ends[]", "  " + terms_.ends + "\n") +
                                          table("short", "slopes[][2]", terms_.slopes);
  }

  std::string known_tables(const std::string& none) const {
    std::string axes;
    std::string places;
    std::string densities;
    std::size_t count = 0;
    std::vector<double> z(model_.input_names.size());
    for (const TrainedModel::Axis& axis : model_.axes) {
      const std::size_t samples = axis.known ? axis.known->samples.size() : 0;
      for (std::size_t i = 0; i < samples; ++i) {
        axis.known->samples.get(i, z);
        places += point(z);
        densities += "  " + text_.number(axis.known->density.sums()[i] - 1.0) + ",\n";
      }
      const double h = axis.known ? axis.known->density.bandwidth() : 0.0;
      axes +=
          fmt::format("  {{ {}, {}, {}, {} }},\n", count, count + samples,
                      text_.bound(axis.half_width), text_.number(h > 0.0 ? 0.5 / (h * h) : 0.0));
      count += samples;
    }
    return table("struct kelpie_known", "known[]", axes) +
           table("$REAL", "places[][$INPUTS]", places, none) +
           table("$REAL", "densities[]", densities, "  0\n");
  }

  std::string axis_entry(const TrainedModel::Axis& axis, std::size_t first) const {
    const auto& [input, target, term_scale] = axis.scaling;
    const Limits& limits = axis.function.limits;
    std::string rows;
    for (std::size_t i = 0; i < input.whitening.rows(); ++i) {
      rows += (i > 0 ? ",\n    " : "") + text_.list(input.whitening.row(i));
    }
    std::string ranges;
    for (std::size_t k = 0; k < term_scale.size(); ++k) {
      const auto [low, high] = axis.function.term_range(k);
      ranges += fmt::format("{}{{{}, {}}}", k > 0 ? ", " : "", text_.bound(low * term_scale[k]),
                            text_.bound(high * term_scale[k]));
    }
    const std::vector<double> nominal = axis.function.nominal.empty()
                                            ? std::vector<double>(term_scale.size())
                                            : in_units(axis.scaling, axis.function.nominal);
    return fmt::format("  {{ {}, {}, {}, {}, {}, {},\n   {},\n   {{{}}}{} }},\n", first,
                       first + axis.function.members.size(), text_.bound(target.invert(limits.low)),
                       text_.bound(target.invert(limits.high)), text_.number(limits.caution),
                       text_.number(target.scale * target.scale), text_.list(input.mean), rows,
                       ranges.empty() ? "" : ",\n   {" + ranges + "},\n   " + text_.list(nominal));
  }

  // Coefficients in physical units, of weights of scaled terms.
  static std::vector<double> in_units(const AxisScaling& scaling, std::span<const double> weights) {
    std::vector<double> coefficients(weights.begin(), weights.end());
    for (std::size_t k = 0; k < coefficients.size(); ++k) {
      coefficients[k] *= scaling.target.scale / scaling.term_scale[k];
    }
    return coefficients;
  }

  std::string member_entry(const AxisScaling& scaling, const FunctionMix::Member& member,
                           std::size_t first) const {
    const SvrFunction& function = member.function;
    const KernelWeights& weights = function.kernel().weights();
    const std::vector<double> coefficients = in_units(scaling, function.term_weights());
    return fmt::format("  /* {} */\n  {{ {}, {}, {}, {}, {}, {}, {}{} }},\n", c_string(member.name),
                       text_.number(member.share), first, first + function.beta().size(),
                       text_.number(function.kernel().local().gamma()), text_.number(weights.s),
                       text_.number(weights.fine),
                       text_.number(scaling.target.invert(function.bias())),
                       coefficients.empty() ? "" : ",\n   " + text_.list(coefficients));
  }

  const TrainedModel& model_;
  const CodeOptions& options_;
  CText text_;
  TermTables terms_;
  std::vector<std::string> targets_;
  std::vector<std::size_t> actuators_;  // those that do something, of the commands
};

}  // namespace

std::string model_c(const TrainedModel& model, const CodeOptions& options) {
  check(model, options);
  return in_file(options.source, [&] { return ModelCode(model, options).file(); });
}

std::string model_h(const TrainedModel& model, const CodeOptions& options) {
  check(model, options);
  return ModelCode(model, options).header();
}

std::size_t table_bytes(const TrainedModel& model, const CodeOptions& options) {
  constexpr std::size_t kIntegers = 2 * sizeof(std::int32_t);  // of an axis, and of a member
  const std::size_t real = options.single ? sizeof(float) : sizeof(double);
  const std::size_t inputs = model.input_names.size();
  std::size_t bytes = tables_of(model.terms, CText(options.single)).step_count * 2 * real;
  bytes +=
      model.alignment.actuators.size() * (sizeof(std::int32_t) + Actuator::fields().size() * real);
  for (const TrainedModel::Axis& axis : model.axes) {
    bytes += kIntegers + (4 + inputs + inputs * inputs + 3 * model.terms.size()) * real;
    for (const FunctionMix::Member& member : axis.function.members) {
      bytes += kIntegers + (5 + model.terms.size()) * real;
      bytes += member.function.beta().size() * (inputs + 1) * real;
    }
    if (options.assess) {
      bytes += kIntegers + 2 * real;
      bytes += (axis.known ? axis.known->samples.size() : 0) * (inputs + 1) * real;
    }
  }
  return bytes;
}

}  // namespace kelpie::format
