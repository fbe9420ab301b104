// SPDX-License-Identifier: Apache-2.0
#include "kelpie/motion/expression.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <utility>

#include "kelpie/core/error.hpp"
#include "kelpie/core/text.hpp"

namespace kelpie {

class ExpressionParser {
 public:
  ExpressionParser(std::string_view text, std::span<const std::string> columns)
      : text_(text), columns_(columns) {}

  Expression parse() {
    sum();
    if (!at_end()) {
      fail("'" + std::string(1, text_[position_]) + "' is not expected here");
    }
    result_.text_ = std::string(text_);
    for (const Expression::Step& step : result_.steps_) {
      if (step.code == Code::column) {
        result_.columns_.push_back(step.column);
      }
    }
    std::ranges::sort(result_.columns_);
    const auto repeated = std::ranges::unique(result_.columns_);
    result_.columns_.erase(repeated.begin(), repeated.end());
    return std::move(result_);
  }

 private:
  using Code = Expression::Code;

  struct Function {
    std::string_view name;
    Code code;
    int arguments;
  };
  static constexpr std::array kFunctions = std::to_array<Function>({
      {"abs", Code::abs, 1},
      {"sign", Code::sign, 1},
      {"sqrt", Code::sqrt, 1},
      {"sin", Code::sin, 1},
      {"cos", Code::cos, 1},
      {"tanh", Code::tanh, 1},
      {"min", Code::min, 2},
      {"max", Code::max, 2},
  });

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError("'" + std::string(text_) + "'",
                     what + " (at character " + std::to_string(position_ + 1) + ")");
  }

  void skip_spaces() {
    while (position_ < text_.size() && text_[position_] == ' ') {
      ++position_;
    }
  }
  bool at_end() {
    skip_spaces();
    return position_ == text_.size();
  }
  bool take(char wanted) {
    if (at_end() || text_[position_] != wanted) {
      return false;
    }
    ++position_;
    return true;
  }
  void expect(char wanted) {
    if (!take(wanted)) {
      fail(std::string("'") + wanted + "' is missing");
    }
  }

  void emit(Code code, double number = 0.0, std::size_t column = 0) {
    result_.steps_.push_back({code, number, column});
    depth_ += 1 - result_.steps_.back().operands();
    if (depth_ > static_cast<int>(Expression::kDeepest)) {
      fail("is nested too deeply");
    }
  }

  void sum() {
    if (++nesting_ > kMostNested) {
      fail("is nested too deeply");
    }
    product();
    while (true) {
      if (take('+')) {
        product();
        emit(Code::add);
      } else if (take('-')) {
        product();
        emit(Code::subtract);
      } else {
        --nesting_;
        return;
      }
    }
  }

  void product() {
    power();
    while (true) {
      if (take('*')) {
        power();
        emit(Code::multiply);
      } else if (take('/')) {
        power();
        emit(Code::divide);
      } else {
        return;
      }
    }
  }

  void power() {
    if (take('-')) {
      if (++nesting_ > kMostNested) {
        fail("is nested too deeply");
      }
      power();
      emit(Code::negate);
      --nesting_;
      return;
    }
    operand();
    if (take('^')) {
      skip_spaces();
      emit(Code::power, number());
    }
  }

  void operand() {
    if (at_end()) {
      fail("ends where a column or number is expected");
    }
    const char first = text_[position_];
    if (take('(')) {
      sum();
      expect(')');
    } else if (take('|')) {
      sum();
      expect('|');
      emit(Code::abs);
    } else if (take('\'')) {
      const std::size_t end = text_.find('\'', position_);
      if (end == std::string_view::npos) {
        fail("a quote is not closed");
      }
      const std::string_view name = text_.substr(position_, end - position_);
      column(name);
      position_ = end + 1;
    } else if (std::isdigit(static_cast<unsigned char>(first)) != 0 || first == '.') {
      emit(Code::number, number());
    } else {
      word();
    }
  }

  double number() {
    double value = 0.0;
    const char* const start = text_.data() + position_;
    const auto [end, error] = std::from_chars(start, text_.data() + text_.size(), value);
    if (error != std::errc{} || !std::isfinite(value) || value < 0.0) {
      fail("a number >= 0 is expected");
    }
    position_ += static_cast<std::size_t>(end - start);
    return value;
  }

  void word() {
    std::size_t end = position_;
    while (end < text_.size() &&
           (std::isalnum(static_cast<unsigned char>(text_[end])) != 0 || text_[end] == '_')) {
      ++end;
    }
    if (end == position_) {
      fail("'" + std::string(1, text_[position_]) + "' is not expected here");
    }
    const std::string_view name = text_.substr(position_, end - position_);
    const auto* const function = std::ranges::find(kFunctions, name, &Function::name);
    if (function == kFunctions.end() || end == text_.size() || text_[end] != '(') {
      column(name);
      position_ = end;
      return;
    }
    position_ = end + 1;
    sum();
    for (int argument = 1; argument < function->arguments; ++argument) {
      expect(',');
      sum();
    }
    expect(')');
    emit(function->code);
  }

  void column(std::string_view name) {
    const auto found = std::ranges::find(columns_, name);
    if (found == columns_.end()) {
      const std::vector<std::string> known(columns_.begin(), columns_.end());
      fail("no column '" + std::string(name) + "'" + did_you_mean(name, known) + "; there are " +
           join_text(known, ", "));
    }
    emit(Code::column, 0.0, static_cast<std::size_t>(found - columns_.begin()));
  }

  static constexpr int kMostNested = 100;

  std::string_view text_;
  std::span<const std::string> columns_;
  std::size_t position_ = 0;
  int depth_ = 0;
  int nesting_ = 0;
  Expression result_;
};

Expression Expression::parse(std::string_view text, std::span<const std::string> columns) {
  return ExpressionParser(text, columns).parse();
}

}  // namespace kelpie
