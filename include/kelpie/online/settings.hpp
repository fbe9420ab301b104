// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "kelpie/core/setting.hpp"
#include "kelpie/kernel/storage.hpp"

namespace kelpie {

/// Which samples the outlier node rejects.
enum class OutlierRule : std::uint8_t {
  none,    ///< no sample
  iqr,     ///< eq. (12) as written
  robust,  ///< contradicted at full price, by far more than the model's usual error
};

/// Which sample leaves when the buffer is full.
enum class ForgetRule : std::uint8_t {
  fifo,   ///< the oldest
  paper,  ///< eq. (7) as written: φ = d / (√t_s + k), t_s the time stamp
  age,    ///< the same score on true age: φ = d (√age + k)
};

/// What is done when the vehicle changes.
enum class AdaptRule : std::uint8_t {
  none,        ///< nothing: the old samples are forgotten in time
  challenger,  ///< a learner without a past is tried, and takes over where it is better
};

/// How the dual problem is kept at its optimum.
enum class SolverKind : std::uint8_t {
  path,  ///< following the solution path: exact, and quick
  smo,   ///< warm-started sequential minimal optimisation, as in the paper
};

/// Everything one axis' learner is told. Targets and inputs are standardised before they come
/// here, so ε and C are in standard deviations of the target.
struct OnlineSvrSettings {
  SolverKind solver = SolverKind::path;
  Storage storage = Storage::float32;
  double ridge = 0.0;     ///< on the diagonal of K; 0: effective_ridge() chooses
  int buffer = 900;       ///< B: samples kept at most
  double epsilon = 0.12;  ///< ε: half width of the tube
  double c = 0.7;         ///< C: bound of a weight
  double gamma = 0.1;     ///< γ: S = Σ/γ, eq. (6)
  double fine = 0.7;      ///< weight of κ_SE^32 in the kernel, against that of κ_SE, which is 1
  double lambda = 0.5;    ///< λ: weight of the physics terms in the kernel, likewise
  double k = 10.0;        ///< eq. (7): weight of density against age [√s]
  double a = 0.99;        ///< eq. (10): how similar a duplicate is
  double b = 0.01;        ///< eq. (10): how near its target
  double xi = 0.97;       ///< ξ, eq. (9): how similar an explained sample is
  OutlierRule outlier = OutlierRule::robust;
  double outlier_factor = 16.0;  ///< robust: times the usual error
  ForgetRule forget = ForgetRule::age;
  AdaptRule adapt = AdaptRule::challenger;  ///< AdaptiveSvr
  int memory = 4;                           ///< past models kept at most: PastModels
  int anchors = 200;                        ///< samples without weight that stay at most
  double bandwidth = 0.0;        ///< h of H = h Σ^½, eq. (8); 0: Scott's B^(−1/(d+4))
  double tolerance = 1e-3;       ///< KKT gap up to which a model is served
  int max_iterations = 100'000;  ///< of SMO, for one solve

  /// Throws InputError naming the field, its value and what would be right.
  void validate() const;

  /// The ridge, or what suits the storage where none is given.
  double effective_ridge() const;

  /// Past models there is room for: only who notices a change can use them.
  std::size_t past_models() const {
    return adapt == AdaptRule::challenger ? static_cast<std::size_t>(memory) : 0;
  }

  /// Samples there is room for: B, and the one that is being learned.
  std::size_t places() const { return static_cast<std::size_t>(buffer) + 1; }
};

/// The table of all fields: config files, --set, the printed defaults and docs/settings.md come
/// from it.
std::span<const Setting<OnlineSvrSettings>> online_svr_fields();

}  // namespace kelpie
