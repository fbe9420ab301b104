// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kelpie/core/vector.hpp"
#include "kelpie/kernel/kernel_matrix.hpp"

namespace kelpie {

/// Which weights a free sample may take without leaving its line of the KKT table: [0, C],
/// [−C, 0], or, where ε = 0 makes them one line, [−C, C].
enum class Branch : std::int8_t { negative = -1, both = 0, positive = 1 };

/// The free samples F, whose residuals sit on the edge of the tube, with what is needed to move
/// them together: L Lᵀ = K_FF, updated as samples join and leave, and L⁻¹1. Directions are
/// solutions of the bordered system
///
///     K_FF dβ + 1 db = r,   1ᵀdβ = σ.
///
/// Members are in the order of joining. Memory: capacity² doubles, allocated in the constructor.
class FreeSet {
 public:
  explicit FreeSet(std::size_t capacity);  ///< Allocates for so many samples.

  std::size_t size() const { return members_.size(); }
  std::span<const std::size_t> members() const { return members_; }
  Branch branch(std::size_t place) const { return branch_[place]; }  ///< Of the member at a place.
  /// Whether a sample is free.
  bool contains(std::size_t sample) const { return place_[sample] != kNowhere; }
  /// Requires that the sample is a member.
  std::size_t place(std::size_t sample) const { return static_cast<std::size_t>(place_[sample]); }

  void clear();  ///< Removes all members.

  /// Adds a sample. A pivot lost to rounding (a duplicate of a member, say) is lifted to a small
  /// positive one. Requires that the sample is no member. Cost O(|F|²).
  void join(const KernelMatrix& kernel, std::size_t sample, Branch branch);

  /// Removes the member at a place by plane rotations, which keep L as accurate as it was.
  /// Cost O(|F|²).
  void leave(std::size_t place);

  /// Takes the longest-standing member out and in again, by which its row and column of L Lᵀ are
  /// those of K afresh; |F| calls re-make the factorisation. Cost O(|F|²).
  void renew_oldest(const KernelMatrix& kernel);

  /// A sample's number has changed. Ends an aim.
  void renumber(std::size_t from, std::size_t to);

  /// Keeps L⁻¹k_c for a sample c outside, through all joins and leaves until the next aim() or
  /// until c joins. Cost O(|F|²).
  void aim(const KernelMatrix& kernel, std::size_t c);

  /// dβ and db for dβ_c = s: r = −s k_c, σ = −s. Requires aim(), size() > 0 and room for size()
  /// values. Cost O(|F|²).
  double follow(double s, std::span<double> d_beta) const;

  /// dβ and db for any r, σ. `d_beta` holds r when called. Cost O(|F|²).
  double correct(double sigma, std::span<double> d_beta) const;

  /// core/archive.hpp; members are of so many samples. The factor as it stands, rounding included.
  void visit(Archive& archive, std::size_t samples);

  /// Memory of a set in bytes, beside the object itself.
  static std::size_t bytes(std::size_t capacity);

 private:
  static constexpr std::ptrdiff_t kNowhere = -1;

  /// Where L_ij is: column after column, without what is above the diagonal. Requires i >= j.
  std::size_t place_of(std::size_t i, std::size_t j) const {
    return j * capacity_ - j * (j + 1) / 2 + i;
  }
  std::span<double> column(std::size_t j) {  ///< L_jj and what is below it
    return {factor_.data() + place_of(j, j), size() - j};
  }
  std::span<const double> column(std::size_t j) const {
    return {factor_.data() + place_of(j, j), size() - j};
  }
  void forward(std::span<double> r) const;   ///< r ← L⁻¹ r
  void backward(std::span<double> r) const;  ///< r ← L⁻ᵀ r
  Four<double> below(std::size_t j) const;
  double border(double sigma, std::span<double> w) const;
  void append(const KernelMatrix& kernel, std::size_t sample, Branch branch,
              std::span<const double> row);

  std::size_t capacity_;
  std::vector<std::size_t> members_;
  std::vector<Branch> branch_;
  std::vector<std::ptrdiff_t> place_;  ///< of every sample among the members
  std::vector<double> factor_;         ///< L: place_of()
  std::vector<double> ones_;           ///< L⁻¹ 1
  std::vector<double> aimed_;          ///< L⁻¹ k_c
  std::ptrdiff_t target_ = kNowhere;   ///< c
  std::vector<double> row_;
};

}  // namespace kelpie
