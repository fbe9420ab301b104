// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kelpie::study {

/// Names and values of settings, as ModelSettings::assign takes them.
using Assignments = std::vector<std::pair<std::string, std::string>>;

/// How values of a range are spread when drawn.
enum class Spread : std::uint8_t {
  linear,  ///< uniform in x
  log,     ///< uniform in log x, for what is positive and of unknown magnitude
  log1m,   ///< uniform in log (1 − x), for what lies close below 1
};

/// One setting and what is searched of it: a range of numbers, or a list of values.
struct Dimension {
  std::string name;
  Spread spread = Spread::linear;
  double low = 0.0;
  double high = 0.0;
  bool whole = false;                ///< whole numbers only
  bool shared = false;               ///< one value for all axes (ModelSettings::shared)
  std::vector<std::string> choices;  ///< not empty: drawn from these instead of the range

  std::string text() const;  ///< as SearchSpace::search() reads it
};

/// Which settings a search varies, and over what. All names and values are checked against the
/// tables of fields (model/settings.hpp) when they are given, so that no candidate is ever invalid.
class SearchSpace {
 public:
  /// The numbers of the kernel (gamma, fine, lambda) and of the learner (c, epsilon, k, a, b, xi,
  /// outlier_factor). The buffer is not among them: the data can't say how much memory and time
  /// there is.
  static SearchSpace standard();

  /// Searches one setting over "name=low:high", "name=low:high:linear|log|log1m" or
  /// "name=value,value,…", in place of what was searched of it before. Without a spread it is the
  /// standard space's, or linear. Throws InputError naming the setting and what would be right.
  void search(std::string_view text);

  /// Searches the setting no longer; nothing happens when it wasn't.
  void fix(std::string_view name);

  bool empty() const { return dimensions_.empty(); }
  const std::vector<Dimension>& dimensions() const { return dimensions_; }
  std::string text() const;  ///< all dimensions, separated by blanks

  /// `count` candidates for one axis. The first is empty: the settings that the search starts from.
  /// Every dimension is drawn from a RandomStream of its own, so candidate i is the same whatever
  /// `count` is and whichever other settings are searched. Numbers are rounded to four digits.
  std::vector<Assignments> candidates(std::uint64_t seed, std::size_t count) const;

  /// Every combination of the shared dimensions' choices; one, empty, when there are none.
  std::vector<Assignments> shared_combinations() const;

 private:
  std::vector<Dimension> dimensions_;
};

}  // namespace kelpie::study
