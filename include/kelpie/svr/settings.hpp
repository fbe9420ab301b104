// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "kelpie/core/setting.hpp"
#include "kelpie/svr/resources.hpp"

namespace kelpie {

/// Rule of the outlier rejection node.
enum class OutlierRule : std::uint8_t {
  none,    ///< no sample
  iqr,     ///< eq. (12) as written
  robust,  ///< weight at ±C and a residual far above the usual error
};

/// The sample to remove from a full buffer.
enum class ForgetRule : std::uint8_t {
  fifo,   ///< the oldest
  paper,  ///< eq. (7) as written: φ = d / (√t_s + k), t_s the time stamp
  age,    ///< with the true age: φ = d (√age + k)
};

/// Reaction to a change of the vehicle.
enum class AdaptRule : std::uint8_t {
  none,    ///< no reaction: old samples are forgotten gradually
  follow,  ///< what was learned becomes what would have been learned of the changed vehicle
};

/// Solver of the dual problem.
enum class SolverKind : std::uint8_t {
  path,  ///< follows the solution path: exact and fast
  smo,   ///< warm-started sequential minimal optimisation, as in the paper
};

/// The settings of the learner of one axis. Targets and inputs are standardised beforehand: ε and C
/// are in standard deviations of the target.
struct OnlineSvrSettings {
  SolverKind solver = SolverKind::path;
  Storage storage = Storage::float32;
  double ridge = 0.0;     ///< on the diagonal of K; 0: effective_ridge() chooses
  int buffer = 900;       ///< B: largest number of samples
  double epsilon = 0.12;  ///< ε: half width of the tube
  double c = 0.7;         ///< C: bound of a weight
  double gamma = 0.1;     ///< γ: S = Σ/γ, eq. (6)
  double fine = 0.7;      ///< weight of κ_SE^32 in the kernel; κ_SE has the weight 1
  double lambda = 0.5;    ///< λ: weight of the physics terms in the kernel
  double k = 10.0;        ///< eq. (7): weight of density relative to age [√s]
  double a = 0.99;        ///< eq. (10): similarity of a duplicate
  double b = 0.01;        ///< eq. (10): distance of its target
  double xi = 0.97;       ///< ξ, eq. (9): similarity of an explained sample
  OutlierRule outlier = OutlierRule::robust;
  double outlier_factor = 16.0;  ///< robust: times the usual error
  ForgetRule forget = ForgetRule::age;
  AdaptRule adapt = AdaptRule::follow;
  int memory = 4;                ///< largest number of past vehicles
  int anchors = 200;             ///< largest number of samples without weight
  double bandwidth = 0.0;        ///< h of H = h Σ^½, eq. (8); 0: Scott's B^(−1/(d+4))
  double tolerance = 1e-3;       ///< largest KKT gap of a published model
  int max_iterations = 100'000;  ///< of SMO, per solve

  /// Throws InputError with field, value and valid range.
  void validate() const;

  /// `ridge`, or the default ridge of the storage.
  double effective_ridge() const;

  /// Number of places for past models; 0 without detection of changes.
  std::size_t past_models() const {
    return adapt == AdaptRule::follow ? static_cast<std::size_t>(memory) : 0;
  }

  /// Number of places for samples: B, and the sample in learning.
  std::size_t places() const { return static_cast<std::size_t>(buffer) + 1; }
};

/// The table of the fields: source of config files, --set, the printed defaults and
/// docs/reference/settings.md.
std::span<const Setting<OnlineSvrSettings>> online_svr_fields();

}  // namespace kelpie
