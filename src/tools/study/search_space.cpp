// SPDX-License-Identifier: Apache-2.0
#include "study/search_space.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "kelpie/model/settings.hpp"

namespace kelpie::study {
namespace {

constexpr std::array<std::string_view, 3> kSpreads{"linear", "log", "log1m"};

constexpr std::array<std::string_view, 10> kStandard{
    "gamma=0.001:3:log", "c=0.3:100:log",   "epsilon=0.005:0.3:log", "k=1:100:log",
    "a=0.9:0.999:log1m", "b=0.001:0.1:log", "xi=0.9:0.999:log1m",    "outlier_factor=4:30:log",
    "lambda=0.03:3:log", "fine=0.03:3:log",
};

[[noreturn]] void refuse(const std::string& name, const std::string& message) {
  throw InputError({.file = "--search", .line = 0, .field = name}, message);
}

// What one table of fields knows of a dimension: fills in its kind and checks its values.
template <typename T>
class FieldCheck {
 public:
  FieldCheck(std::span<const Setting<T>> fields, std::string_view name) {
    const auto found = std::ranges::find(fields, name, &Setting<T>::name);
    field_ = found == fields.end() ? nullptr : &*found;
  }

  bool known() const { return field_ != nullptr; }

  void apply(Dimension& dimension) const {
    using Choice = typename Setting<T>::Choice;
    dimension.whole = std::holds_alternative<int T::*>(field_->member);
    if (dimension.choices.empty() && std::holds_alternative<Choice>(field_->member)) {
      refuse(dimension.name, "has no range; give values out of " + field_->allowed());
    }
    for (const std::string& value : dimension.choices) {
      check(value);
    }
    if (dimension.choices.empty()) {
      check(number_text(dimension.low));
      check(number_text(dimension.high));
    }
  }

 private:
  void check(const std::string& value) const {
    T settings;
    field_->assign(settings, value);
    field_->check(settings);
  }

  const Setting<T>* field_;
};

void check_range(const Dimension& dimension) {
  if (!(dimension.low < dimension.high)) {
    refuse(dimension.name, "the range has to go from the lesser to the greater number");
  }
  if (dimension.spread == Spread::log && dimension.low <= 0.0) {
    refuse(dimension.name, "a log range has to begin above 0");
  }
  if (dimension.spread == Spread::log1m && dimension.high >= 1.0) {
    refuse(dimension.name, "a log1m range has to end below 1");
  }
}

void check_fields(Dimension& dimension) {
  const FieldCheck<SharedSettings> shared(shared_fields(), dimension.name);
  const FieldCheck<OnlineSvrSettings> axis(online_svr_fields(), dimension.name);
  dimension.shared = shared.known();
  if (shared.known()) {
    if (dimension.choices.empty()) {
      refuse(dimension.name, "holds for all axes together; give values separated by commas");
    }
    shared.apply(dimension);
  } else if (axis.known()) {
    axis.apply(dimension);
  } else {
    refuse(dimension.name, dimension.name == "preset"
                               ? "says where the other settings start from; give it by --set"
                               : unknown_setting(dimension.name));
  }
}

Spread standard_spread(const std::string& name) {
  for (const std::string_view text : kStandard) {
    if (split_text(text, '=')[0] == name) {
      const std::string spread = split_text(text, ':').back();
      return static_cast<Spread>(choice_setting(name, spread, kSpreads));
    }
  }
  return Spread::linear;
}

Dimension parse(std::string_view text) {
  const std::size_t sign = text.find('=');
  if (sign == std::string_view::npos || sign == 0) {
    throw InputError({.file = "--search", .line = 0, .field = {}},
                     "'" + std::string(text) +
                         "' is not of the form name=low:high, name=low:high:log or name=value,…");
  }
  Dimension dimension;
  dimension.name = trimmed(text.substr(0, sign));
  const std::string_view values = text.substr(sign + 1);
  const std::vector<std::string> parts = split_text(values, ':');
  if (parts.size() == 1) {
    dimension.choices = split_text(values, ',');
    if (dimension.choices.size() < 2) {
      refuse(dimension.name, "one value is no search; give low:high or several values, or --set " +
                                 std::string(text));
    }
  } else if (parts.size() <= 3) {
    dimension.low = number_setting(dimension.name, parts[0]);
    dimension.high = number_setting(dimension.name, parts[1]);
    dimension.spread = parts.size() == 3
                           ? static_cast<Spread>(choice_setting(dimension.name, parts[2], kSpreads))
                           : standard_spread(dimension.name);
    check_range(dimension);
  } else {
    refuse(dimension.name, "a range is low:high or low:high:linear|log|log1m");
  }
  return dimension;
}

std::string drawn_number(const Dimension& dimension, double share) {
  const auto between = [share](double low, double high) { return low + share * (high - low); };
  double value = 0.0;
  switch (dimension.spread) {
    case Spread::linear:
      value = between(dimension.low, dimension.high);
      break;
    case Spread::log:
      value = std::exp(between(std::log(dimension.low), std::log(dimension.high)));
      break;
    case Spread::log1m:
      value = 1.0 - std::exp(between(std::log1p(-dimension.low), std::log1p(-dimension.high)));
      break;
  }
  if (dimension.whole) {
    return number_text(std::round(value));
  }
  // Close below 1 it is the digits of 1 − x that count.
  const std::string rounded = dimension.spread == Spread::log1m ? fmt::format("{:.6g}", value)
                                                                : fmt::format("{:.4g}", value);
  return number_text(
      std::clamp(number_setting(dimension.name, rounded), dimension.low, dimension.high));
}

std::string drawn(const Dimension& dimension, RandomStream& random) {
  return dimension.choices.empty() ? drawn_number(dimension, random.uniform())
                                   : dimension.choices[random.below(dimension.choices.size())];
}

}  // namespace

std::string Dimension::text() const {
  if (!choices.empty()) {
    return name + "=" + join_text(choices, ",");
  }
  return fmt::format("{}={}:{}:{}", name, number_text(low), number_text(high),
                     kSpreads[static_cast<std::size_t>(spread)]);
}

SearchSpace SearchSpace::standard() {
  SearchSpace space;
  for (const std::string_view text : kStandard) {
    space.search(text);
  }
  return space;
}

void SearchSpace::search(std::string_view text) {
  Dimension dimension = parse(text);
  check_fields(dimension);
  const auto found = std::ranges::find(dimensions_, dimension.name, &Dimension::name);
  if (found != dimensions_.end()) {
    *found = std::move(dimension);
  } else {
    dimensions_.push_back(std::move(dimension));
  }
}

void SearchSpace::fix(std::string_view name) {
  std::erase_if(dimensions_, [name](const Dimension& d) { return d.name == name; });
}

std::string SearchSpace::text() const {
  std::vector<std::string> texts;
  texts.reserve(dimensions_.size());
  for (const Dimension& dimension : dimensions_) {
    texts.push_back(dimension.text());
  }
  return join_text(texts, " ");
}

std::vector<Assignments> SearchSpace::candidates(std::uint64_t seed, std::size_t count) const {
  std::vector<Assignments> list(count);
  for (const Dimension& dimension : dimensions_) {
    if (dimension.shared) {
      continue;
    }
    RandomStream random(seed, "tune " + dimension.name);
    for (std::size_t i = 1; i < count; ++i) {
      list[i].emplace_back(dimension.name, drawn(dimension, random));
    }
  }
  return list;
}

std::vector<Assignments> SearchSpace::shared_combinations() const {
  std::vector<Assignments> combinations(1);
  for (const Dimension& dimension : dimensions_) {
    if (!dimension.shared) {
      continue;
    }
    std::vector<Assignments> longer;
    for (const Assignments& combination : combinations) {
      for (const std::string& choice : dimension.choices) {
        longer.push_back(combination);
        longer.back().emplace_back(dimension.name, choice);
      }
    }
    combinations = std::move(longer);
  }
  return combinations;
}

}  // namespace kelpie::study
