// SPDX-License-Identifier: Apache-2.0
#include "kelpie/motion/basis.hpp"

#include <algorithm>
#include <cmath>

namespace kelpie {
namespace {

double value_of(const Basis::Term& term, std::span<const double> x) {
  using Form = Basis::Form;
  const double a = x[term.a];
  switch (term.form) {
    case Form::one:
      return 1.0;
    case Form::straight:
    case Form::command:
      return a;
    case Form::magnitude:
      return std::abs(a);
    case Form::square_law:
      return a * std::abs(a);
    case Form::square:
      return a * a;
    case Form::product:
      return a * x[term.b];
    case Form::cross_flow:
      return a * std::abs(x[term.b]);
    case Form::ahead:
      return std::pow(std::max(a, 0.0), 2);
    case Form::astern:
      return -std::pow(std::min(a, 0.0), 2);
  }
  return 0.0;
}

}  // namespace

Basis::Basis(std::size_t inputs, std::span<const std::size_t> states)
    : states_(states.begin(), states.end()) {
  for (std::size_t i = 0; i < inputs; ++i) {
    if (std::ranges::find(states_, i) == states_.end()) {
      thrusters_.push_back(i);
    }
  }
  terms_.push_back({Form::one});
  for (const Form form : {Form::straight, Form::magnitude, Form::square_law, Form::square}) {
    for (const std::size_t state : states_) {
      terms_.push_back({form, state});
    }
  }
  for (std::size_t i = 0; i < states_.size(); ++i) {
    for (std::size_t j = 0; j < states_.size(); ++j) {
      if (i < j) {
        terms_.push_back({Form::product, states_[i], states_[j]});
      }
      if (i != j) {
        terms_.push_back({Form::cross_flow, states_[i], states_[j]});
      }
    }
  }
  for (const std::size_t thruster : thrusters_) {
    for (const Form form : {Form::command, Form::ahead, Form::astern}) {
      terms_.push_back({form, thruster});
    }
  }
}

void Basis::evaluate(std::span<const double> x, std::span<double> phi) const {
  std::ranges::transform(terms_, phi.begin(), [x](const Term& term) { return value_of(term, x); });
}

std::size_t Basis::find(Form form, std::size_t a, std::size_t b) const {
  const auto same = [&](const Term& term) {
    return term.form == form && term.a == a && term.b == b;
  };
  return static_cast<std::size_t>(std::ranges::find_if(terms_, same) - terms_.begin());
}

bool Basis::of_thruster(std::size_t k, std::size_t input) const {
  return terms_[k].form >= Form::command && terms_[k].a == input;
}

bool Basis::of_damping(std::size_t k, std::size_t input) const {
  const Form form = terms_[k].form;
  const bool damps = form == Form::straight || form == Form::magnitude ||
                     form == Form::square_law || form == Form::square || form == Form::cross_flow;
  return damps && terms_[k].a == input;
}

int Basis::degree(std::size_t k, std::size_t input) const {
  const Term& term = terms_[k];
  switch (term.form) {
    case Form::straight:
    case Form::magnitude:
      return term.a == input ? 1 : 0;
    case Form::square_law:
    case Form::square:
      return term.a == input ? 2 : 0;
    case Form::product:
    case Form::cross_flow:
      return (term.a == input ? 1 : 0) + (term.b == input ? 1 : 0);
    default:
      return 0;
  }
}

}  // namespace kelpie
