// SPDX-License-Identifier: Apache-2.0
#include "motion/cause_ranking.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kelpie {
namespace {

constexpr double kMargin = 5.0;        // nats: 150 times as likely
constexpr double kLeastWorth = 30.0;   // nats, of anything that is told
constexpr double kLeastShare = 0.03;   // of thrust, drag, inertia, scale: less isn't told
constexpr double kSecondShare = 0.75;  // of what the first leaves that a second has to explain
constexpr double kExplainsMost = 0.6;  // less than that by the best pair: none of these
constexpr double kUnexplained = 2.0;   // times the usual scatter: a second cause is looked for
constexpr double kSecondCause = 12.0;  // nats that it has to be worth

// Whether two choices are one to who asks what happened.
bool same_cause(const Explanation& a, const Explanation& b) {
  return a.kind == b.kind && (a.place == b.place || a.kind == CauseKind::force);
}

bool matters(const Explanation& explanation, double size) {
  const bool is_share =
      explanation.kind != CauseKind::force && explanation.kind != CauseKind::sensor_bias;
  return !is_share || std::abs(size) >= kLeastShare;
}

class Judge {
 public:
  Judge(const Comparison& comparison, std::span<const Explanation> list,
        std::span<const Agreement> alone, double rows)
      : comparison_(comparison),
        list_(list),
        alone_(alone),
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

  bool matters_all(const Choice& choice) const {
    const bool first = matters(list_[choice.one], choice.agreement.size[0]);
    return first &&
           (choice.one == choice.other ||
            matters(list_[choice.other], choice.agreement.size[list_[choice.one].columns.size()]));
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

 private:
  const Comparison& comparison_;
  std::span<const Explanation> list_;
  std::span<const Agreement> alone_;
  double penalty_;
};

}  // namespace

CauseRanking rank_causes(const Comparison& comparison, std::span<const Explanation> explanations,
                         std::span<const Agreement> alone, double rows, double least_dispersion,
                         std::size_t unknowns) {
  const Judge judge(comparison, explanations, alone, rows);
  const auto singles = [&](auto take) {
    for (std::size_t i = 0; i < explanations.size(); ++i) {
      take(judge.single(i));
    }
  };
  const auto pairs = [&](auto take) {
    for (std::size_t i = 0; i < explanations.size(); ++i) {
      for (std::size_t j = i + 1; j < explanations.size(); ++j) {
        if (judge.overlap(i, j)) {
          continue;
        }
        if (const Choice pair = judge.pair(i, j); judge.matters_all(pair)) {
          take(pair);
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
  CauseRanking judgement;
  judge.best_two(singles, least_dispersion, judgement.best, judgement.rival);
  judgement.dispersion = dispersion_of(judgement.best);
  judgement.explained = std::min(judgement.best.agreement.evidence / whole, 1.0);
  if (judgement.dispersion > kUnexplained * least_dispersion) {
    Choice best;
    Choice rival;
    judge.best_two(pairs, least_dispersion, best, rival);
    const double dispersion = dispersion_of(best);
    const double single = judge.worth(judgement.best, dispersion);
    const double left = whole - judgement.best.agreement.evidence;
    const double gained = best.agreement.evidence - judgement.best.agreement.evidence;
    if (gained > kSecondShare * left && judge.worth(best, dispersion) > single + kSecondCause) {
      judgement.best = best;
      judgement.rival = rival;
      judgement.dispersion = dispersion;
      judgement.explained = std::min(best.agreement.evidence / whole, 1.0);
    }
  }
  judgement.best.worth = judge.worth(judgement.best, judgement.dispersion);
  judgement.rival.worth = judge.worth(judgement.rival, judgement.dispersion);
  judgement.margin = judgement.best.worth - judgement.rival.worth;
  if (judgement.best.worth < kLeastWorth || !judge.matters_all(judgement.best)) {
    judgement.state = FindingState::looking;
  } else if (judgement.explained < kExplainsMost) {
    judgement.state = FindingState::none;
  } else {
    judgement.state = judgement.margin > kMargin ? FindingState::named : FindingState::ambiguous;
  }
  return judgement;
}

}  // namespace kelpie
