// SPDX-License-Identifier: Apache-2.0
#include "vehicle/cause_ranking.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "vehicle/tuning.hpp"

namespace kelpie {
namespace {

// Whether two choices are one to who asks what happened.
bool same_cause(const Explanation& a, const Explanation& b) {
  return a.kind == b.kind && (a.place == b.place || a.kind == CauseKind::force);
}

bool matters(const Explanation& explanation, double size) {
  const bool is_share =
      explanation.kind != CauseKind::force && explanation.kind != CauseKind::sensor_bias;
  return !is_share || std::abs(size) >= kDiagnosis.least_share;
}

// Whether a load changes the inertia along every axis by no more than vehicles carry. Where nothing
// accelerates, an infinite inertia explains every contradiction, and an acceleration along one
// direction alone is a load as well as a thruster without thrust. With shares S of accelerations,
// inertia is (1 + S)⁻¹ times what it was; shares within their errors count as 0.
bool is_carried(std::span<const double> shares, std::span<const double> errors, double dispersion) {
  Eigen::Matrix3d rest = Eigen::Matrix3d::Identity();
  for (std::size_t c = 0; c < shares.size(); ++c) {
    const auto [on, from] = kLoadColumns[c];
    const double error = kDiagnosis.sure_errors * std::sqrt(dispersion) * errors[c];
    if (from != LoadColumn::kTurning && std::abs(shares[c]) > error) {
      rest(static_cast<Eigen::Index>(on), static_cast<Eigen::Index>(from)) += shares[c];
    }
  }
  const Eigen::Array3d inertia = rest.inverse().diagonal();
  return rest.determinant() > 0.0 && (inertia < kDiagnosis.most_inertia).all() &&
         (inertia > 1.0 / kDiagnosis.most_inertia).all();
}

class Ranker {
 public:
  Ranker(const Comparison& comparison, std::span<const Explanation> list,
         std::span<const Agreement> alone, double rows, double dispersion)
      : comparison_(comparison),
        list_(list),
        alone_(alone),
        dispersion_(dispersion),
        penalty_(0.5 * std::log(std::max(rows, 2.0))) {}

  Choice single(std::size_t i) const { return {i, i, alone_[i], 0.0}; }
  Choice pair(std::size_t i, std::size_t j) const {
    return {i, j, comparison_.of(list_[i].columns, list_[j].columns), 0.0};
  }

  double worth(const Choice& choice, double dispersion) const {
    std::size_t sizes = list_[choice.one].columns.size();
    if (choice.other != choice.one) {
      sizes += list_[choice.other].columns.size();
    }
    return choice.agreement.evidence / dispersion - penalty_ * static_cast<double>(sizes);
  }

  bool same(const Choice& a, const Choice& b) const {
    const auto has = [&](const Choice& choice, std::size_t cause) {
      return same_cause(list_[choice.one], list_[cause]) ||
             same_cause(list_[choice.other], list_[cause]);
    };
    return has(a, b.one) && has(a, b.other) && has(b, a.one) && has(b, a.other);
  }

  // Whether each cause of a choice has a size that matters.
  bool matter(const Choice& choice) const {
    return all_of(choice, [&](std::size_t cause, std::size_t first) {
      return matters(list_[cause], choice.agreement.size[first]);
    });
  }

  bool are_plausible(const Choice& choice) const {
    return all_of(choice, [&](std::size_t cause, std::size_t first) {
      return is_plausible(cause, choice.agreement, first);
    });
  }

  bool overlap(std::size_t i, std::size_t j) const {
    return std::ranges::any_of(list_[i].columns, [&](std::size_t column) {
      return std::ranges::find(list_[j].columns, column) != list_[j].columns.end();
    });
  }

  // The best of the choices that `visit` shows, and the best that is another cause than that.
  template <typename Visit>
  void best_two(Visit visit, double dispersion, Choice& best, Choice& rival) const {
    best.worth = rival.worth = -std::numeric_limits<double>::infinity();
    visit([&](Choice choice) {
      choice.worth = worth(choice, dispersion);
      if (choice.worth > best.worth) {
        best = choice;
      }
    });
    visit([&](Choice choice) {
      choice.worth = worth(choice, dispersion);
      if (choice.worth > rival.worth && !same(choice, best)) {
        rival = choice;
      }
    });
  }

  // All thrusters by one factor against the best single cause. While the others are idle, all
  // thrusters explain as much as one.
  void compare(Choice all, double dispersion, CauseRanking& ranking) const {
    all.worth = worth(all, dispersion);
    if (all.worth > ranking.best.worth + kDiagnosis.named_margin_nats) {
      ranking.rival = std::exchange(ranking.best, all);
    } else if (all.worth > ranking.rival.worth &&
               list_[ranking.best.one].kind != CauseKind::thruster) {
      ranking.rival = all;
    }
  }

 private:
  // Whether `test` holds of each cause of a choice and the place of its first size.
  template <typename Test>
  bool all_of(const Choice& choice, Test test) const {
    return test(choice.one, std::size_t{0}) &&
           (choice.one == choice.other || test(choice.other, list_[choice.one].columns.size()));
  }

  bool is_plausible(std::size_t cause, const Agreement& agreement, std::size_t first) const {
    const std::size_t count = list_[cause].columns.size();
    return list_[cause].kind != CauseKind::load ||
           is_carried(std::span(agreement.size).subspan(first, count),
                      std::span(agreement.error).subspan(first, count), dispersion_);
  }

  const Comparison& comparison_;
  std::span<const Explanation> list_;
  std::span<const Agreement> alone_;
  double dispersion_;
  double penalty_;
};

FindingState state_of(const CauseRanking& ranking, bool matters) {
  if (ranking.best.worth < kDiagnosis.least_nats || !matters) {
    return FindingState::looking;
  }
  if (ranking.explained < kDiagnosis.least_explained) {
    return FindingState::none;
  }
  return ranking.margin > kDiagnosis.named_margin_nats ? FindingState::named
                                                       : FindingState::ambiguous;
}

}  // namespace

CauseRanking rank_causes(const Comparison& comparison, std::span<const Explanation> explanations,
                         std::span<const Agreement> alone, double rows, double least_dispersion,
                         std::size_t unknowns) {
  const Ranker ranker(comparison, explanations, alone, rows, least_dispersion);
  const auto all_thrusters =
      std::ranges::find(explanations, CauseKind::all_thrusters, &Explanation::kind);
  const auto others = static_cast<std::size_t>(all_thrusters - explanations.begin());
  const auto singles = [&](auto visit) {
    for (std::size_t i = 0; i < others; ++i) {
      if (const Choice single = ranker.single(i); ranker.are_plausible(single)) {
        visit(single);
      }
    }
  };
  CauseRanking ranking;
  const auto is_load = [&](std::size_t i) { return explanations[i].kind == CauseKind::load; };
  const auto pairs = [&](auto visit) {
    const bool nearly_all = ranking.explained > kDiagnosis.alone_explained;
    for (std::size_t i = 0; i < others; ++i) {
      for (std::size_t j = i + 1; j < others; ++j) {
        if (ranker.overlap(i, j) || (nearly_all && (is_load(i) || is_load(j)))) {
          continue;
        }
        if (const Choice pair = ranker.pair(i, j);
            ranker.matter(pair) && ranker.are_plausible(pair)) {
          visit(pair);
        }
      }
    }
  };
  // What an explanation leaves over scatters the rows further than noise does (McCullagh's
  // dispersion of quasi-likelihoods).
  const auto dispersion_of = [&](const Choice& choice) {
    const double left = std::max(comparison.whole() - choice.agreement.evidence, 0.0);
    return std::max(least_dispersion, 2.0 * left / static_cast<double>(unknowns));
  };
  const double whole =
      std::max(comparison.whole() - 0.5 * least_dispersion * static_cast<double>(unknowns), 1e-9);
  ranker.best_two(singles, least_dispersion, ranking.best, ranking.rival);
  if (all_thrusters != explanations.end()) {
    ranker.compare(ranker.single(others), least_dispersion, ranking);
  }
  ranking.dispersion = dispersion_of(ranking.best);
  ranking.explained = std::min(ranking.best.agreement.evidence / whole, 1.0);
  if (ranking.dispersion > kDiagnosis.pair_dispersion * least_dispersion) {
    Choice best;
    Choice rival;
    ranker.best_two(pairs, least_dispersion, best, rival);
    const double dispersion = dispersion_of(best);
    const double single = ranker.worth(ranking.best, dispersion);
    const double left = whole - ranking.best.agreement.evidence;
    const double gained = best.agreement.evidence - ranking.best.agreement.evidence;
    if (gained > kDiagnosis.pair_share * left &&
        ranker.worth(best, dispersion) > single + kDiagnosis.pair_nats) {
      ranking.best = best;
      ranking.rival = rival;
      ranking.dispersion = dispersion;
      ranking.explained = std::min(best.agreement.evidence / whole, 1.0);
    }
  }
  ranking.best.worth = ranker.worth(ranking.best, ranking.dispersion);
  ranking.rival.worth = ranker.worth(ranking.rival, ranking.dispersion);
  ranking.margin = ranking.best.worth - ranking.rival.worth;
  ranking.state = state_of(ranking, ranker.matter(ranking.best));
  return ranking;
}

}  // namespace kelpie
