// SPDX-License-Identifier: Apache-2.0
#include "kelpie/motion/term_set.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/eigen.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/text.hpp"
#include "kelpie/motion/states.hpp"

namespace kelpie {
namespace {

constexpr std::size_t kSixDegrees = 6;

// A column as a formula names it.
std::string quoted(const std::string& name) {
  const bool word = std::ranges::all_of(
      name, [](unsigned char letter) { return std::isalnum(letter) != 0 || letter == '_'; });
  return word && !name.empty() && std::isdigit(static_cast<unsigned char>(name[0])) == 0
             ? name
             : "'" + name + "'";
}

std::vector<std::string> linear_terms(std::span<const std::string> inputs) {
  std::vector<std::string> terms;
  std::ranges::transform(inputs, std::back_inserter(terms), quoted);
  return terms;
}

// Damping, Coriolis and added mass, drag of one velocity by another, and thrust with a coefficient
// of its own ahead and astern.
std::vector<std::string> fossen_terms(std::span<const std::string> inputs, std::size_t velocities,
                                      bool all_squares, bool cross_flow) {
  const std::vector<std::string> names = linear_terms(inputs);
  std::vector<std::string> terms(names.begin(),
                                 names.begin() + static_cast<std::ptrdiff_t>(velocities));
  for (std::size_t i = 0; i < velocities; ++i) {
    terms.push_back(names[i] + "*|" + names[i] + "|");
  }
  for (std::size_t i = 0; i < velocities; ++i) {
    for (std::size_t j = i + 1; j < velocities; ++j) {
      terms.push_back(names[i] + "*" + names[j]);
    }
  }
  for (std::size_t i = all_squares ? 0 : velocities - 1; i < velocities; ++i) {
    terms.push_back(names[i] + "^2");
  }
  for (std::size_t i = 0; cross_flow && i < velocities; ++i) {
    for (std::size_t j = 0; j < velocities; ++j) {
      if (i != j) {
        terms.push_back(names[i] + "*|" + names[j] + "|");
      }
    }
  }
  for (std::size_t i = velocities; i < names.size(); ++i) {
    terms.push_back("max(" + names[i] + ",0)^2");
    terms.push_back("-min(" + names[i] + ",0)^2");
  }
  return terms;
}

// x, x|x|, the products of the velocities, then all other products where they fit in. `straight`
// is how many come before those.
std::vector<std::string> quadratic_terms(std::span<const std::string> inputs,
                                         std::size_t& straight) {
  const std::size_t velocities = named_velocities(inputs);
  const std::vector<std::string> names = linear_terms(inputs);
  std::vector<std::string> terms = names;
  for (const std::string& name : names) {
    terms.push_back(name + "*|" + name + "|");
  }
  const auto add_products = [&](auto wanted) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      for (std::size_t j = i + 1; j < names.size(); ++j) {
        if (wanted(j)) {
          terms.push_back(names[i] + "*" + names[j]);
        }
      }
    }
  };
  add_products([&](std::size_t j) { return j < velocities; });
  straight = terms.size();
  const std::size_t products = names.size() * (names.size() - 1) / 2;
  if (2 * names.size() + products <= kMostTerms) {
    add_products([&](std::size_t j) { return j >= velocities; });
  }
  return terms;
}

// The inputs' names with the velocities first.
std::vector<std::string> velocities_first(std::span<const std::string> inputs,
                                          std::span<const std::size_t> states) {
  std::vector<std::string> names;
  for (const std::size_t state : states) {
    names.push_back(inputs[state]);
  }
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (std::ranges::find(states, i) == states.end()) {
      names.push_back(inputs[i]);
    }
  }
  return names;
}

[[noreturn]] void reject_terms(const std::string& what) {
  throw InputError("terms", what);
}

}  // namespace

TermSet TermSet::from(std::string_view specification, std::span<const std::string> inputs,
                      std::size_t velocities) {
  std::string_view wanted = trimmed(specification);
  if (constexpr std::string_view kCounted = "fossen:"; wanted.starts_with(kCounted)) {
    double count = 0.0;
    if (!parse_number(wanted.substr(kCounted.size()), count) || !(count >= 1.0) ||
        count > kMostInputs || count != std::floor(count)) {
      reject_terms("'" + std::string(wanted) +
                   "' needs a whole number of velocities after the colon");
    }
    velocities = static_cast<std::size_t>(count);
    wanted = "fossen";
  }
  std::vector<std::string> texts;
  std::size_t straight = kMostTerms;
  if (wanted == "auto" || wanted == "quadratic") {
    texts = quadratic_terms(inputs, straight);
  } else if (wanted == "linear") {
    texts = linear_terms(inputs);
  } else if (wanted == "fossen" || wanted == "manoeuvring" || wanted == "6dof") {
    const bool six = wanted == "6dof";
    const bool cross_flow = wanted == "manoeuvring";
    if (velocities == 0 || velocities > inputs.size() || (six && velocities != kSixDegrees)) {
      reject_terms("'" + std::string(wanted) + "' needs " + (six ? "six" : "the") +
                   " velocities as first inputs, one per target; there are " +
                   std::to_string(velocities) + " targets and " + std::to_string(inputs.size()) +
                   " inputs");
    }
    texts = fossen_terms(inputs, velocities, six || cross_flow, cross_flow);
  } else if (wanted != "none") {
    texts = split_text(wanted, ';');
  }
  TermSet set = parsed(texts, inputs);
  set.straight_ = std::min(straight, set.size());
  return set;
}

TermSet TermSet::manoeuvring(std::span<const std::string> inputs,
                             std::span<const std::size_t> states) {
  const std::vector<std::string> texts =
      fossen_terms(velocities_first(inputs, states), states.size(), true, true);
  return texts.size() <= kMostTerms ? parsed(texts, inputs) : TermSet{};
}

TermSet TermSet::open_loop(std::span<const std::string> inputs,
                           std::span<const std::size_t> states) {
  const std::vector<std::string> names = linear_terms(velocities_first(inputs, states));
  std::vector<std::string> texts =
      fossen_terms(velocities_first(inputs, states), states.size(), true, true);
  const std::size_t straight = texts.size();
  for (std::size_t i = states.size(); i < names.size(); ++i) {
    for (std::size_t j = 0; j < states.size(); ++j) {
      texts.push_back(names[i] + "*" + names[j]);
    }
  }
  if (texts.size() > kMostOpenLoopTerms) {
    return manoeuvring(inputs, states);
  }
  TermSet set = parsed(texts, inputs);
  set.straight_ = straight;
  return set;
}

TermSet TermSet::parsed(const std::vector<std::string>& texts,
                        std::span<const std::string> inputs) {
  if (texts.size() > kMostTerms) {
    reject_terms(std::to_string(texts.size()) + " given; a model takes at most " +
                 std::to_string(kMostTerms));
  }
  TermSet set;
  for (const std::string& text : texts) {
    set.terms_.push_back(Expression::parse(text, inputs));
  }
  set.straight_ = set.size();
  return set;
}

void TermSet::evaluate(std::span<const double> x, std::span<double> out) const {
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    const double value = terms_[k](x);
    out[k] = std::isfinite(value) ? value : 0.0;
  }
}

void TermSet::add_gradient(std::span<const double> x, std::span<const double> weights,
                           std::span<double> gradient) const {
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    for (const std::size_t column : terms_[k].columns()) {
      const auto [value, slope] = terms_[k].slope(x, column);
      if (std::isfinite(value) && std::isfinite(slope)) {
        gradient[column] += weights[k] * slope;
      }
    }
  }
}

void TermSet::scales(const Moments& inputs, const Moments& terms, std::span<double> scales) const {
  const auto root_mean_square = [](const Moments& moments, std::size_t i) {
    return std::sqrt(moments.covariance(i, i) + moments.mean()[i] * moments.mean()[i]);
  };
  ScaledInput far(inputs.dimension());
  ShortVector<kMostTerms> at_far(size());
  for (std::size_t k = 0; k < size(); ++k) {
    scales[k] = root_mean_square(terms, k);
  }
  for (const double sign : {2.0, -2.0}) {
    for (std::size_t i = 0; i < far.size(); ++i) {
      far[i] = sign * root_mean_square(inputs, i);
    }
    evaluate(as_span(far), at_far);
    for (std::size_t k = 0; k < size(); ++k) {
      scales[k] = std::max(scales[k], 0.25 * std::abs(at_far[k]));
    }
  }
  std::ranges::replace_if(
      scales, [](double scale) { return !(scale > 0.0); }, 1.0);
}

ScaledSample scale_sample(const AxisScaling& scaling, const TermSet& terms,
                          std::span<const double> x) {
  ScaledSample sample(x.size() + terms.size());
  std::ranges::copy(scaling.input.apply(x), sample.begin());
  const std::span<double> phi = std::span(sample).subspan(x.size());
  terms.evaluate(x, phi);
  for (std::size_t k = 0; k < phi.size(); ++k) {
    phi[k] /= scaling.term_scale[k];
  }
  return sample;
}

}  // namespace kelpie
