// SPDX-License-Identifier: Apache-2.0
#include "core/bounded_minimum.hpp"

#include <vector>

#include "core/decomposition.hpp"
#include "core/eigen.hpp"

namespace kelpie {
namespace {

using Eigen::Index;

// Where a variable is held; 0: free.
enum Side : int { kLower = -1, kFree = 0, kUpper = 1 };

// The program with the variables held at present.
class ActiveSet {
 public:
  ActiveSet(std::span<const double> h, std::span<const double> g, std::span<const double> lower,
            std::span<const double> upper, std::span<double> z)
      : h_(columns_of(h, g.size())),
        g_(as_vector(g)),
        lower_(as_vector(lower)),
        upper_(as_vector(upper)),
        z_(as_vector(z)),
        side_(g.size(), kLower) {
    z_ = lower_;
  }

  /// Moves the free variables to their minimum, or as far as a bound; whether all the way.
  bool advance() {
    std::vector<Index> free;
    for (Index i = 0; i < g_.size(); ++i) {
      if (side(i) == kFree) {
        free.push_back(i);
      }
    }
    if (free.empty()) {
      return true;
    }
    const Eigen::VectorXd slope = h_ * z_ - g_;
    const Eigen::VectorXd step =
        solve_symmetric(Eigen::MatrixXd(h_(free, free)), Eigen::VectorXd(-slope(free)));
    double share = 1.0;
    Index blocked = g_.size();
    for (Index k = 0; k < step.size(); ++k) {
      const Index i = free[static_cast<std::size_t>(k)];
      const double room = (step(k) > 0.0 ? upper_(i) : lower_(i)) - z_(i);
      if (step(k) != 0.0 && room / step(k) < share) {
        share = room / step(k);
        blocked = i;
      }
    }
    for (Index k = 0; k < step.size(); ++k) {
      const Index i = free[static_cast<std::size_t>(k)];
      z_(i) += share * step(k);
      if (i == blocked) {
        side(i) = step(k) > 0.0 ? kUpper : kLower;
        z_(i) = step(k) > 0.0 ? upper_(i) : lower_(i);
      }
    }
    return blocked == g_.size();
  }

  /// Frees the held variable whose Lagrange multiplier is most wrong; whether there is one.
  bool release() {
    const Eigen::VectorXd slope = h_ * z_ - g_;
    double most = 1e-12 * (1.0 + g_.cwiseAbs().maxCoeff());
    Index worst = g_.size();
    for (Index i = 0; i < g_.size(); ++i) {
      if (upper_(i) > lower_(i) && side(i) * slope(i) > most) {
        most = side(i) * slope(i);
        worst = i;
      }
    }
    if (worst < g_.size()) {
      side(worst) = kFree;
    }
    return worst < g_.size();
  }

 private:
  int& side(Index i) { return side_[static_cast<std::size_t>(i)]; }

  Eigen::Map<const Eigen::MatrixXd> h_;
  Eigen::Map<const Eigen::VectorXd> g_, lower_, upper_;
  Eigen::Map<Eigen::VectorXd> z_;
  std::vector<int> side_;
};

}  // namespace

// Each round frees or holds a variable; the value falls, so no active set comes twice. The bound on
// the rounds is for rounding errors alone.
void bounded_minimum(std::span<const double> h, std::span<const double> g,
                     std::span<const double> lower, std::span<const double> upper,
                     std::span<double> z) {
  ActiveSet set(h, g, lower, upper, z);
  bool goes_on = true;
  for (std::size_t round = 0; goes_on && round < 64 * (g.size() + 1); ++round) {
    goes_on = !set.advance() || set.release();
  }
}

}  // namespace kelpie
