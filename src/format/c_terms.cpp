// SPDX-License-Identifier: Apache-2.0
#include "format/c_terms.hpp"
#include "kelpie/motion/term_set.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace kelpie::format {
namespace {

using Code = Expression::Code;
using Step = Expression::Step;

// Powers up to this one are multiplied out.
constexpr double kLargestWholePower = 64.0;

bool is_whole_power(double exponent) {
  return exponent == std::floor(exponent) && exponent <= kLargestWholePower;
}

// A formula step by step, every value with a name of its own.
class FormulaCode {
 public:
  FormulaCode(const Expression& formula, const CText& text) : formula_(formula), text_(text) {
    for (const Step& step : formula.steps()) {
      Operands operands{};
      for (int i = step.operands(); i > 0; --i) {
        operands[static_cast<std::size_t>(i - 1)] = stack_.back();
        stack_.pop_back();
      }
      stack_.push_back(operands_.size());
      operands_.push_back(operands);
    }
  }

  // Returns the name of the value.
  std::string value(std::string& body) {
    for (std::size_t i = 0; i < operands_.size(); ++i) {
      const Step& step = formula_.steps()[i];
      if (step.code == Code::number) {
        names_.push_back(text_.number(step.number));
      } else if (step.code == Code::column) {
        names_.push_back(fmt::format("x[{}]", step.column));
      } else {
        names_.push_back(fmt::format("a{}", i));
        define(body, "    ", names_.back(), value_of(step, operands_[i]));
      }
    }
    return names_.back();
  }

  // Requires value(). Returns the name of the slope; empty where there is none.
  std::string slope(std::string& body, std::size_t column) {
    slopes_.assign(operands_.size(), "");
    std::vector<std::string> code(operands_.size());
    for (std::size_t i = 0; i < operands_.size(); ++i) {
      const Step& step = formula_.steps()[i];
      if (step.code == Code::column) {
        slopes_[i] = step.column == column ? text_.number(1.0) : "";
      } else if (step.code != Code::number) {
        code[i] = slope_of(step, operands_[i], names_[i]);
        slopes_[i] = code[i].empty() ? "" : fmt::format("d{}", i);
      }
    }
    const std::vector<bool> wanted = wanted_slopes();
    for (std::size_t i = 0; i < code.size(); ++i) {
      if (wanted[i] && !code[i].empty()) {
        define(body, "      ", slopes_[i], code[i]);
      }
    }
    return slopes_.back();
  }

 private:
  using Operands = std::array<std::size_t, 2>;

  void define(std::string& body, const char* indent, const std::string& name,
              const std::string& code) const {
    body += fmt::format("{}const {} {} = {};\n", indent, text_.real(), name, code);
  }

  static std::string call(const std::string& function, const std::string& arguments) {
    return function + "(" + arguments + ")";
  }

  std::string value_of(const Step& step, const Operands& operands) {
    const std::string& a = names_[operands[0]];
    const std::string& b = names_[operands[1]];
    switch (step.code) {
      case Code::add:
        return a + " + " + b;
      case Code::subtract:
        return a + " - " + b;
      case Code::multiply:
        return a + " * " + b;
      case Code::divide:
        return a + " / " + b;
      case Code::negate:
        return "-" + a;
      case Code::power:
        return power(a, step.number);
      case Code::abs:
        return call("$NAME_abs", a);
      case Code::sign:
        return call("$NAME_sign", a);
      case Code::sqrt:
        return call("$sqrt", a);
      case Code::sin:
        return call("$sin", a);
      case Code::cos:
        return call("$cos", a);
      case Code::tanh:
        return call("$NAME_tanh", a);
      case Code::min:
        return call("$NAME_min", a + ", " + b);
      default:
        return call("$NAME_max", a + ", " + b);
    }
  }

  std::string power(const std::string& base, double exponent) {
    return is_whole_power(exponent) ? call("$NAME_power", fmt::format("{}, {}", base, exponent))
                                    : call("$pow", base + ", " + text_.number(exponent));
  }

  // As Expression::slope has it; empty: 0.
  std::string slope_of(const Step& step, const Operands& operands, const std::string& value) {
    const std::string& a = names_[operands[0]];
    const std::string& da = slopes_[operands[0]];
    if (step.operands() == 2) {
      return slope_of_two(step.code, operands, value);
    }
    if (da.empty()) {
      return "";
    }
    switch (step.code) {
      case Code::negate:
        return "-" + da;
      case Code::power:
        return step.number == 0.0
                   ? ""
                   : call("$NAME_chain", text_.number(step.number) + " * " +
                                             power(a, step.number - 1.0) + ", " + da);
      case Code::abs:
        return call("$NAME_abs_slope", a + ", " + da);
      case Code::sqrt:
        return call("$NAME_chain", "1 / (2 * " + value + "), " + da);
      case Code::sin:
        return call("$cos", a) + " * " + da;
      case Code::cos:
        return "-" + call("$sin", a) + " * " + da;
      case Code::tanh:
        return "(1 - " + value + " * " + value + ") * " + da;
      default:
        return "";  // sign
    }
  }

  std::string slope_of_two(Code code, const Operands& operands, const std::string& value) {
    const std::string& a = names_[operands[0]];
    const std::string& b = names_[operands[1]];
    const std::string& da = slopes_[operands[0]];
    const std::string& db = slopes_[operands[1]];
    if (da.empty() && db.empty()) {
      return "";
    }
    const std::string zero = text_.number(0.0);
    const std::string both = (da.empty() ? zero : da) + ", " + (db.empty() ? zero : db);
    switch (code) {
      case Code::add:
        return da.empty() ? db : db.empty() ? da : da + " + " + db;
      case Code::subtract:
        return db.empty() ? da : (da.empty() ? "" : da + " ") + "- " + db;
      case Code::multiply:
        return da.empty()   ? a + " * " + db
               : db.empty() ? da + " * " + b
                            : da + " * " + b + " + " + a + " * " + db;
      case Code::divide:
        return db.empty()
                   ? da + " / " + b
                   : "(" + (da.empty() ? "" : da + " ") + "- " + value + " * " + db + ") / " + b;
      case Code::min:
        return call("$NAME_min_slope", a + ", " + b + ", " + both);
      default:
        return call("$NAME_max_slope", a + ", " + b + ", " + both);
    }
  }

  // Those on the way from the column to the formula's: what sign and ^0 take isn't.
  std::vector<bool> wanted_slopes() const {
    std::vector<bool> wanted(operands_.size(), false);
    wanted.back() = true;
    for (std::size_t i = operands_.size(); i-- > 0;) {
      const int count = formula_.steps()[i].operands();
      for (int k = 0; k < count && wanted[i] && !slopes_[i].empty(); ++k) {
        wanted[operands_[i][static_cast<std::size_t>(k)]] = true;
      }
    }
    return wanted;
  }

  const Expression& formula_;
  const CText& text_;
  std::vector<std::size_t> stack_;
  std::vector<Operands> operands_;
  std::vector<std::string> names_;
  std::vector<std::string> slopes_;
};

}  // namespace

TermCode code_of(const TermSet& terms, const CText& text) {
  TermCode code;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    FormulaCode formula(terms.term(k), text);
    code.body += fmt::format("  {{ /* {} */\n", c_string(terms.text(k)));
    const std::string value = formula.value(code.body);
    code.body += fmt::format("    phi[{}] = $NAME_finite({}, {});\n", k, value, value);
    for (const std::size_t column : terms.term(k).columns()) {
      std::string steps;
      const std::string slope = formula.slope(steps, column);
      if (!slope.empty()) {
        code.body +=
            fmt::format("    if (slope) {{\n{}      slope[{}] = $NAME_finite({}, {});\n    }}\n",
                        steps, code.slopes.size(), value, slope);
        code.slopes.emplace_back(k, column);
      }
    }
    code.body += "  }\n";
  }
  code.helpers = c_helpers(code.body);
  return code;
}

}  // namespace kelpie::format
