// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/roomy_vector.hpp"
#include "core/vector.hpp"
#include "svr/kernel_matrix.hpp"

namespace kelpie {

/// The weights of a free sample on one line of the KKT table: [0, C], [−C, 0], or, with ε = 0,
/// [−C, C].
enum class Branch : std::int8_t { negative = -1, both = 0, positive = 1 };

/// The free samples F, with residuals on the edge of the tube, and the factor of their kernel
/// matrix L Lᵀ = K_FF, updated as samples join and leave, and L⁻¹1. Directions solve the bordered
/// system
///
///     K_FF dβ + 1 db = r,   1ᵀdβ = σ.
///
/// With the Schur complement s = 1ᵀ K_FF⁻¹ 1 = |L⁻¹1|² the solution is
/// db = (1ᵀ K_FF⁻¹ r − σ) / s and dβ = K_FF⁻¹ (r − 1 db).
///
/// Members are in the order of joining. Memory: capacity² doubles, allocated in the constructor.
class FreeSet {
 public:
  explicit FreeSet(std::size_t capacity);  ///< Allocates for `capacity` samples.

  std::size_t size() const { return members_.size(); }
  std::span<const std::size_t> members() const { return members_; }
  Branch branch(std::size_t place) const { return branch_[place]; }  ///< Of the member at a place.
  /// Whether a sample is free.
  bool contains(std::size_t sample) const { return place_[sample] != kNowhere; }
  /// Requires that the sample is a member.
  std::size_t place(std::size_t sample) const { return static_cast<std::size_t>(place_[sample]); }

  void clear();  ///< Removes all members.

  /// Adds a sample. A pivot lost to rounding, as of a duplicate, is replaced by a small positive
  /// pivot. Requires a sample outside the set. Cost O(|F|²).
  void join(const KernelMatrix& kernel, std::size_t sample, Branch branch);

  /// Removes the member at a place by plane rotations, without loss of accuracy. Cost O(|F|²).
  void leave(std::size_t place);

  /// Removes the oldest member and adds the same sample again: its row and column of L Lᵀ then
  /// equal K again. |F| calls renew the factorisation. Cost O(|F|²).
  void renew_oldest(const KernelMatrix& kernel);

  /// Changes the number of a sample. Ends an aim.
  void renumber(std::size_t from, std::size_t to);

  /// Keeps L⁻¹k_c for a sample c outside, through all joins and leaves until the next aim() or
  /// until c joins. Cost O(|F|²).
  void aim(const KernelMatrix& kernel, std::size_t c);

  /// dβ and db for dβ_c = s: r = −s k_c, σ = −s. Requires aim(), size() > 0 and room for size()
  /// values. Cost O(|F|²).
  double follow(double s, std::span<double> d_beta) const;

  /// dβ and db for any r, σ. `d_beta` holds r when called. Cost O(|F|²).
  double correct(double sigma, std::span<double> d_beta) const;

  /// core/archive.hpp. Includes the factor with its rounding errors.
  void visit(Archive& archive, std::size_t samples);

  /// Memory of a set in bytes, beside the object itself.
  static std::size_t bytes(std::size_t capacity);

 private:
  static constexpr std::ptrdiff_t kNowhere = -1;

  /// Index of L_ij: column by column, lower triangle only. Requires i >= j.
  std::size_t place_of(std::size_t i, std::size_t j) const {
    return j * capacity_ - j * (j + 1) / 2 + i;
  }
  std::span<double> column(std::size_t j) {  ///< L_jj and the elements below
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
  RoomyVector<std::size_t> members_;
  RoomyVector<Branch> branch_;
  std::vector<std::ptrdiff_t> place_;  ///< of every sample among the members
  std::vector<double> factor_;         ///< L: place_of()
  std::vector<double> ones_;           ///< L⁻¹ 1
  std::vector<double> aimed_;          ///< L⁻¹ k_c
  std::ptrdiff_t target_ = kNowhere;   ///< c
  std::vector<double> row_;
};

}  // namespace kelpie
