// SPDX-License-Identifier: Apache-2.0
#include "motion/motion_terms.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>

#include "kelpie/core/setting.hpp"

namespace kelpie {
namespace {

constexpr std::size_t kFewCommands = 3;  // whose pairs are terms: rudders behind rotors

// A column as a formula names it.
std::string quoted(const std::string& name) {
  const bool word = std::ranges::all_of(
      name, [](unsigned char letter) { return std::isalnum(letter) != 0 || letter == '_'; });
  if (word && !name.empty() && std::isdigit(static_cast<unsigned char>(name[0])) == 0) {
    return name;
  }
  std::string text = "'";
  for (const char letter : name) {
    text.append(letter == '\'' ? 2 : 1, letter);
  }
  return text + "'";
}

// An angle in radians as a formula names it.
std::string angle_text(double unit, const std::string& name) {
  return unit == 1.0 ? quoted(name) : number_text(unit) + "*" + quoted(name);
}

std::vector<std::size_t> first_places(std::size_t count) {
  std::vector<std::size_t> places(count);
  std::iota(places.begin(), places.end(), std::size_t{0});
  return places;
}

}  // namespace

double MotionTerm::value(std::span<const double> x) const {
  if (form == TermForm::one) {
    return 1.0;
  }
  const double value = x[a];
  switch (form) {
    case TermForm::linear:
      return value;
    case TermForm::magnitude:
      return std::abs(value);
    case TermForm::square_law:
      return value * std::abs(value);
    case TermForm::product:
      return value * x[b];
    case TermForm::cross_flow:
      return value * std::abs(x[b]);
    case TermForm::lift:
      return value * x[b] * std::abs(x[b]);
    case TermForm::ahead:
      return std::max(value, 0.0) * std::max(value, 0.0);
    case TermForm::astern:
      return -(std::min(value, 0.0) * std::min(value, 0.0));
    case TermForm::sine:
      return std::sin(k * value);
    case TermForm::cosine:
      return std::cos(k * value);
    case TermForm::cosine_sine:
      return std::cos(k * value) * std::sin(l * x[b]);
    case TermForm::cosine_cosine:
      return std::cos(k * value) * std::cos(l * x[b]);
    case TermForm::quaternion_x:
      return 2.0 * (value * x[b] - x[c] * x[d]);
    case TermForm::quaternion_y:
      return 2.0 * (value * x[b] + x[c] * x[d]);
    case TermForm::quaternion_z:
      return 1.0 - 2.0 * (value * value + x[b] * x[b]);
    default:
      return value * value;
  }
}

std::string MotionTerm::text(std::span<const std::string> names) const {
  if (form == TermForm::one) {
    return "1";
  }
  std::string name = quoted(names[a]);
  switch (form) {
    case TermForm::linear:
      return name;
    case TermForm::magnitude:
      return "|" + name + "|";
    case TermForm::square_law:
      return name + "*|" + name + "|";
    case TermForm::product:
      return name + "*" + quoted(names[b]);
    case TermForm::cross_flow:
      return name + "*|" + quoted(names[b]) + "|";
    case TermForm::lift:
      return name + "*" + quoted(names[b]) + "*|" + quoted(names[b]) + "|";
    case TermForm::ahead:
      return "max(" + name + ",0)^2";
    case TermForm::astern:
      return "-min(" + name + ",0)^2";
    case TermForm::sine:
      return "sin(" + angle_text(k, names[a]) + ")";
    case TermForm::cosine:
      return "cos(" + angle_text(k, names[a]) + ")";
    case TermForm::cosine_sine:
      return "cos(" + angle_text(k, names[a]) + ")*sin(" + angle_text(l, names[b]) + ")";
    case TermForm::cosine_cosine:
      return "cos(" + angle_text(k, names[a]) + ")*cos(" + angle_text(l, names[b]) + ")";
    case TermForm::quaternion_x:
    case TermForm::quaternion_y:
      return "2*(" + name + "*" + quoted(names[b]) + (form == TermForm::quaternion_x ? "-" : "+") +
             quoted(names[c]) + "*" + quoted(names[d]) + ")";
    case TermForm::quaternion_z:
      return "1-2*(" + name + "^2+" + quoted(names[b]) + "^2)";
    default:
      return name + "^2";
  }
}

bool MotionTerm::depends_on(std::size_t input) const {
  const bool four = form == TermForm::quaternion_x || form == TermForm::quaternion_y;
  const bool two = four || form == TermForm::product || form == TermForm::cross_flow ||
                   form == TermForm::cosine_sine || form == TermForm::cosine_cosine ||
                   form == TermForm::quaternion_z || form == TermForm::lift;
  return form != TermForm::one &&
         (a == input || (two && b == input) || (four && (c == input || d == input)));
}

bool MotionTerm::damps(std::size_t input) const {
  return form >= TermForm::linear && form <= TermForm::cross_flow && form != TermForm::product &&
         a == input;
}

int MotionTerm::degree(std::size_t input) const {
  if (form == TermForm::one || form >= TermForm::sine) {
    return 0;
  }
  if (form == TermForm::product || form == TermForm::cross_flow) {
    return (a == input ? 1 : 0) + (b == input ? 1 : 0);
  }
  if (form == TermForm::lift) {
    return (a == input ? 1 : 0) + (b == input ? 2 : 0);
  }
  const bool simple = form == TermForm::linear || form == TermForm::magnitude;
  return a != input ? 0 : (simple ? 1 : 2);
}

MotionTerms::MotionTerms(std::size_t inputs, std::span<const std::size_t> velocities,
                         const Attitude& attitude)
    : velocities_(velocities.begin(), velocities.end()) {
  for (std::size_t i = 0; i < inputs; ++i) {
    if (std::ranges::find(velocities_, i) == velocities_.end() && !attitude.contains(i)) {
      commands_.push_back(i);
    }
  }
}

void MotionTerms::add_each(std::span<const std::size_t> inputs,
                           std::initializer_list<TermForm> forms) {
  for (const std::size_t input : inputs) {
    for (const TermForm form : forms) {
      add(form, input);
    }
  }
}

void MotionTerms::add_products(std::span<const std::size_t> inputs) {
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    for (std::size_t j = i + 1; j < inputs.size(); ++j) {
      add(TermForm::product, inputs[i], inputs[j]);
    }
  }
}

void MotionTerms::add_lift(std::size_t command) {
  add(TermForm::lift, command, velocities_.front());
  for (const std::size_t other : commands_) {
    if (other != command && commands_.size() <= kFewCommands) {
      add(TermForm::lift, command, other);
    }
  }
}

void MotionTerms::add_restoring(const Attitude& attitude) {
  const auto add_of = [&](MotionTerm term) { terms_.push_back(term); };
  if (attitude.quaternion) {
    const auto [x, y, z, w] = *attitude.quaternion;
    add_of({TermForm::quaternion_x, x, z, w, y});
    add_of({TermForm::quaternion_y, y, z, w, x});
    add_of({TermForm::quaternion_z, x, y});
  } else if (attitude.roll && attitude.pitch) {
    MotionTerm term{.form = TermForm::sine, .a = *attitude.pitch, .k = attitude.pitch_unit};
    add_of(term);
    term.b = *attitude.roll;
    term.l = attitude.roll_unit;
    for (const TermForm form : {TermForm::cosine_sine, TermForm::cosine_cosine}) {
      term.form = form;
      add_of(term);
    }
  } else if (attitude.roll || attitude.pitch) {
    const std::size_t input = attitude.roll ? *attitude.roll : *attitude.pitch;
    const double unit = attitude.roll ? attitude.roll_unit : attitude.pitch_unit;
    for (const TermForm form : {TermForm::sine, TermForm::cosine}) {
      add_of({.form = form, .a = input, .k = unit});
    }
  }
}

MotionTerms MotionTerms::linear(std::size_t inputs) {
  MotionTerms terms(inputs, {});
  terms.add_each(terms.commands_, {TermForm::linear});
  return terms;
}

MotionTerms MotionTerms::quadratic(std::size_t inputs, std::size_t velocities,
                                   const Attitude& attitude) {
  MotionTerms terms(inputs, first_places(velocities), attitude);
  std::vector<std::size_t> factors = terms.velocities_;
  factors.insert(factors.end(), terms.commands_.begin(), terms.commands_.end());
  for (const TermForm form : {TermForm::linear, TermForm::square_law}) {
    terms.add_each(factors, {form});
  }
  terms.add_products(terms.velocities_);
  terms.add_restoring(attitude);
  terms.without_products_ = terms.size();
  for (std::size_t i = 0; i < factors.size(); ++i) {
    for (std::size_t j = std::max(i + 1, velocities); j < factors.size(); ++j) {
      terms.add(TermForm::product, factors[i], factors[j]);
    }
  }
  return terms;
}

MotionTerms MotionTerms::fossen(std::size_t inputs, std::span<const std::size_t> velocities,
                                bool all_squares, bool cross_flow, const Attitude& attitude) {
  MotionTerms terms(inputs, velocities, attitude);
  terms.add_each(velocities, {TermForm::linear});
  terms.add_each(velocities, {TermForm::square_law});
  terms.add_products(velocities);
  terms.add_each(all_squares ? velocities : velocities.last(1), {TermForm::square});
  for (const std::size_t v : velocities) {
    for (const std::size_t w : velocities) {
      if (cross_flow && v != w) {
        terms.add(TermForm::cross_flow, v, w);
      }
    }
  }
  terms.add_each(terms.commands_, {TermForm::ahead, TermForm::astern});
  return terms;
}

MotionTerms MotionTerms::open_loop(std::size_t inputs, std::span<const std::size_t> velocities,
                                   std::size_t most, const Attitude& attitude) {
  const std::size_t states = velocities.size();
  const auto through_flow = [&](MotionTerms terms, std::size_t flows) {
    terms.add_restoring(attitude);
    for (const std::size_t n : terms.commands_) {
      terms.add(TermForm::linear, n);
      terms.add_lift(n);
    }
    for (const std::size_t n : terms.commands_) {
      for (const std::size_t v : velocities.first(flows)) {
        terms.add(TermForm::product, n, v);
      }
    }
    return terms;
  };
  const auto fitting = [&](bool cross_flow) {
    const MotionTerms first = fossen(inputs, velocities, cross_flow, cross_flow, attitude);
    const MotionTerms all = through_flow(first, states);
    return all.size() <= most ? all : through_flow(first, std::min<std::size_t>(states, 1));
  };
  const MotionTerms full = fitting(true);
  return full.size() <= most ? full : fitting(false);
}

std::size_t MotionTerms::without_inflow() const {
  const auto inflow = [&](const MotionTerm& term) {
    return term.form == TermForm::product &&
           std::ranges::any_of(commands_, [&](std::size_t n) { return term.depends_on(n); });
  };
  return static_cast<std::size_t>(std::ranges::find_if(terms_, inflow) - terms_.begin());
}

MotionTerms MotionTerms::diagnosis(std::size_t inputs, std::span<const std::size_t> velocities,
                                   const Attitude& attitude, std::span<const std::size_t> others) {
  MotionTerms terms(inputs, velocities, attitude);
  terms.add(TermForm::one);
  for (const TermForm form :
       {TermForm::linear, TermForm::magnitude, TermForm::square_law, TermForm::square}) {
    terms.add_each(velocities, {form});
  }
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    for (std::size_t j = 0; j < velocities.size(); ++j) {
      if (i < j) {
        terms.add(TermForm::product, velocities[i], velocities[j]);
      }
      if (i != j) {
        terms.add(TermForm::cross_flow, velocities[i], velocities[j]);
      }
    }
  }
  terms.add_each(terms.commands_, {TermForm::linear, TermForm::ahead, TermForm::astern});
  std::erase_if(terms.commands_, [&](std::size_t input) {
    return std::ranges::find(others, input) != others.end();
  });
  for (const std::size_t n : terms.commands_) {
    terms.add_lift(n);
  }
  terms.add_restoring(attitude);
  return terms;
}

MotionTerms MotionTerms::planar(std::size_t thrusters) {
  constexpr std::size_t kU = 0;
  constexpr std::size_t kV = 1;
  constexpr std::size_t kR = 2;
  MotionTerms terms(3 + thrusters, first_places(3));
  terms.add_each(terms.velocities_, {TermForm::linear});
  terms.add_each(terms.velocities_, {TermForm::square_law});
  terms.add(TermForm::product, kV, kR);
  terms.add(TermForm::product, kU, kR);
  terms.add(TermForm::square, kR);
  terms.add(TermForm::product, kU, kV);
  terms.add(TermForm::one);
  terms.add_each(terms.commands_, {TermForm::ahead, TermForm::astern});
  return terms;
}

MotionTerms MotionTerms::spatial(std::size_t thrusters) {
  constexpr std::size_t kVelocities = 6;
  constexpr std::size_t kComponents = 3;
  MotionTerms terms(kVelocities + kComponents + thrusters, first_places(kVelocities));
  terms.add_each(terms.velocities_, {TermForm::linear});
  terms.add_each(terms.velocities_, {TermForm::square_law});
  terms.add_products(terms.velocities_);
  terms.add_each(terms.velocities_, {TermForm::square});
  const std::span<const std::size_t> others(terms.commands_);
  terms.add_each(others.first(kComponents), {TermForm::linear});
  terms.add_each(others.subspan(kComponents), {TermForm::ahead, TermForm::astern});
  return terms;
}

MotionTerms MotionTerms::alignment(std::size_t inputs, std::span<const std::size_t> velocities) {
  MotionTerms terms(inputs, velocities);
  terms.add_each(velocities, {TermForm::linear, TermForm::square_law});
  terms.add_products(velocities);
  for (const std::size_t v : velocities) {
    for (const std::size_t w : velocities) {
      if (v != w) {
        terms.add(TermForm::cross_flow, v, w);
      }
    }
  }
  terms.add_each(terms.commands_, {TermForm::linear, TermForm::square_law});
  for (const std::size_t n : terms.commands_) {
    for (const std::size_t v : velocities.first(std::min<std::size_t>(velocities.size(), 1))) {
      terms.add(TermForm::product, n, v);
    }
    for (const std::size_t m : terms.commands_) {
      if (n != m && terms.commands_.size() <= kFewCommands) {
        terms.add(TermForm::cross_flow, n, m);
      }
    }
  }
  terms.add(TermForm::one);
  return terms;
}

MotionTerms MotionTerms::baseline(std::size_t inputs, std::size_t velocities) {
  MotionTerms terms(inputs, first_places(velocities));
  terms.add_each(first_places(inputs), {TermForm::linear, TermForm::square_law});
  for (std::size_t i = 0; i < velocities; ++i) {
    for (std::size_t j = i; j < velocities; ++j) {
      terms.add(TermForm::product, i, j);
    }
  }
  return terms;
}

void MotionTerms::evaluate(std::span<const double> x, std::span<double> values) const {
  std::ranges::transform(terms_, values.begin(),
                         [x](const MotionTerm& term) { return term.value(x); });
}

std::vector<std::string> MotionTerms::texts(std::span<const std::string> names) const {
  std::vector<std::string> texts;
  for (const MotionTerm& term : terms_) {
    texts.push_back(term.text(names));
  }
  return texts;
}

std::size_t MotionTerms::find(const MotionTerm& term) const {
  return static_cast<std::size_t>(std::ranges::find(terms_, term) - terms_.begin());
}

}  // namespace kelpie
