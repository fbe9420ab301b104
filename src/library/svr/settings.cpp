// SPDX-License-Identifier: Apache-2.0
#include "kelpie/svr/settings.hpp"

#include <array>
#include <string_view>

namespace kelpie {
namespace {

using S = OnlineSvrSettings;

constexpr std::array<std::string_view, 2> kSolvers{"path", "smo"};
constexpr std::array<std::string_view, 2> kStorages{"double", "float"};
constexpr std::array<std::string_view, 3> kOutlierRules{"none", "iqr", "robust"};
constexpr std::array<std::string_view, 3> kForgetRules{"fifo", "paper", "age"};
constexpr std::array<std::string_view, 2> kAdaptRules{"none", "follow"};

// Beyond the upper end lies no use, and products of settings overflow.
constexpr double kMost = 1e9;
constexpr Range kPositive{.low = 0.0, .high = kMost, .open = true};
constexpr Range kNotNegative{.low = 0.0, .high = kMost};
constexpr Range kAtLeastOne{.low = 1.0, .high = kMost};
constexpr Range kShare{.low = 0.0, .high = 1.0};

constexpr std::string_view kKernel = "Kernel";
constexpr std::string_view kLearner = "Learner";
constexpr std::string_view kBuffer = "Buffer";
constexpr std::string_view kSolver = "Solver";

constexpr std::array kSettings = std::to_array<Setting<S>>({
    {"gamma", "γ: S = Σ/γ, so that κ_SE = exp(−γ d²), d the Mahalanobis distance (eq. 6)",
     &S::gamma, kPositive, kKernel},
    {"fine", "weight of κ_SE^32, which follows what holds for a short while only; 0: none",
     &S::fine, kNotNegative, kKernel},
    {"lambda",
     "λ: weight of the physics terms (see `terms`); 0: none",
     &S::lambda,
     kNotNegative,
     kKernel,
     {"terms", "none"}},
    {"epsilon", "ε: half width of the tube without penalty, in standard deviations of the target",
     &S::epsilon, kNotNegative, kLearner},
    {"c", "C: bound of a sample's weight, in standard deviations of the target", &S::c, kPositive,
     kLearner},
    {"xi", "ξ: above this κ_SE, a sample inside the tube is turned away as explained (eq. 9)",
     &S::xi, kShare, kLearner},
    {"a", "above this κ_SE, a sample with nearly the same target is a duplicate (eq. 10)", &S::a,
     kShare, kLearner},
    {"b",
     "how near a duplicate's target is, in standard deviations of the target (eq. 10)",
     &S::b,
     kNotNegative,
     kLearner,
     {"a", "1"}},
    {"outlier",
     "which samples are rejected as outliers: none, iqr (eq. 12), robust",
     choice_of<&S::outlier, S>(kOutlierRules),
     {},
     kEssential},
    {"outlier_factor",
     "an outlier's residual exceeds ε by this many usual errors",
     &S::outlier_factor,
     kPositive,
     kLearner,
     {"outlier", "none,iqr"}},
    {"buffer",
     "B: samples kept at most; time of an update and memory grow with it",
     &S::buffer,
     {.low = 2.0, .high = 20'000.0},
     kEssential},
    {"forget",
     "which sample leaves a full buffer: fifo (the oldest), paper (by eq. 7 on time stamps), age "
     "(by eq. 7 on true age)",
     choice_of<&S::forget, S>(kForgetRules),
     {},
     kBuffer},
    {"k",
     "k: weight of density against age when forgetting, in √s (eq. 7)",
     &S::k,
     kNotNegative,
     kBuffer,
     {"forget", "fifo"}},
    {"bandwidth",
     "h of the density's H = h Σ^½, in standard deviations of the inputs (eq. 8); 0: automatic, by "
     "Scott's rule",
     &S::bandwidth, kNotNegative, kBuffer},
    {"anchors",
     "how many samples without weight stay, the ones in the emptiest places",
     &S::anchors,
     {.low = 1.0, .high = 20'000.0},
     kBuffer},
    {"adapt",
     "when the vehicle changes: none, follow (what was learned becomes what would have been "
     "learned "
     "of the changed vehicle)",
     choice_of<&S::adapt, S>(kAdaptRules),
     {},
     kEssential,
     {.with = "learner", .values = "svr"}},
    {"memory",
     "how many past models are kept, each to be taken up again when its vehicle returns; 0: none",
     &S::memory,
     {.low = 0.0, .high = 64.0},
     kEssential,
     {"adapt", "none"}},
    {"solver",
     "how the dual problem (eq. 4) is solved: path (exact), smo (the paper's, to tolerance)",
     choice_of<&S::solver, S>(kSolvers),
     {},
     kSolver},
    {"storage",
     "numbers in which the buffer's kernel matrix is kept: double, float (half the memory)",
     choice_of<&S::storage, S>(kStorages),
     {},
     kSolver},
    {"ridge",
     "added to the diagonal of K, so that duplicates don't make it singular: a support vector's "
     "residual differs by ridge · |β|; 0: automatic, 1e-9 with double, 1e-6 with float",
     &S::ridge,
     {.low = 0.0, .high = 1.0},
     kSolver},
    {"tolerance",
     "KKT gap up to which a model is served, in standard deviations of the target",
     &S::tolerance,
     {.low = 0.0, .high = 1.0, .open = true},
     kSolver},
    {"max_iterations",
     "bound of SMO's iterations in one solve; with solver = path, where SMO takes over",
     &S::max_iterations, kAtLeastOne, kSolver},
});

}  // namespace

std::span<const Setting<OnlineSvrSettings>> online_svr_fields() {
  return kSettings;
}

double OnlineSvrSettings::effective_ridge() const {
  // Well above what rounding makes of K's smallest eigenvalues.
  return ridge > 0.0 ? ridge : (storage == Storage::float64 ? 1e-9 : 1e-6);
}

void OnlineSvrSettings::validate() const {
  for (const Setting<OnlineSvrSettings>& field : kSettings) {
    field.check(*this);
  }
}

}  // namespace kelpie
