// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kelpie::study {

/// Names and values of settings for ModelSettings::assign().
using Assignments = std::vector<std::pair<std::string, std::string>>;

/// Distribution of the values drawn from a range.
enum class Spread : std::uint8_t {
  linear,  ///< uniform in x
  log,     ///< uniform in log x: positive values of unknown magnitude
  log1m,   ///< uniform in log (1 − x): values close below 1
};

/// One searched setting: a range of numbers, or a list of values.
struct Dimension {
  std::string name;
  Spread spread = Spread::linear;
  double low = 0.0;
  double high = 0.0;
  bool whole = false;                ///< whole numbers only
  bool shared = false;               ///< one value for all axes (ModelSettings::shared)
  std::vector<std::string> choices;  ///< values in place of the range; empty: the range

  std::string text() const;  ///< in the form of SearchSpace::search()
};

/// The settings that a search varies, and their ranges. Names and values are checked at once
/// against the tables of fields (model/settings.hpp), so every candidate is valid.
class SearchSpace {
 public:
  /// The numbers of the kernel (gamma, fine, lambda) and of the learner (c, epsilon, k, a, b, xi,
  /// outlier_factor). Without the buffer: data don't tell the available memory and time.
  static SearchSpace standard();

  /// Searches one setting over "name=low:high", "name=low:high:linear|log|log1m" or
  /// "name=value,value,…", in place of its earlier range. The default spread is the standard
  /// space's, or linear. Throws InputError naming the setting and the allowed values.
  void search(std::string_view text);

  /// Removes the setting from the search, if searched.
  void fix(std::string_view name);

  bool empty() const { return dimensions_.empty(); }
  const std::vector<Dimension>& dimensions() const { return dimensions_; }
  std::string text() const;  ///< all dimensions, separated by blanks

  /// `count` candidates for one axis. The first is empty: the base settings. Every dimension has a
  /// RandomStream of its own, so candidate i depends neither on `count` nor on the other searched
  /// settings. Numbers are rounded to four digits.
  std::vector<Assignments> candidates(std::uint64_t seed, std::size_t count) const;

  /// Every combination of the shared dimensions' choices; a single empty one without choices.
  std::vector<Assignments> shared_combinations() const;

 private:
  std::vector<Dimension> dimensions_;
};

}  // namespace kelpie::study
