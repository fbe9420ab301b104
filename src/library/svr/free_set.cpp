// SPDX-License-Identifier: Apache-2.0
#include "svr/free_set.hpp"

#include <algorithm>
#include <cmath>
#include "svr/tuning.hpp"

namespace kelpie {

FreeSet::FreeSet(std::size_t capacity)
    : capacity_(capacity),
      place_(capacity, kNowhere),
      factor_(capacity * (capacity + 1) / 2),
      ones_(capacity),
      aimed_(capacity),
      row_(capacity) {
  members_.reserve(capacity);
  branch_.reserve(capacity);
}

std::size_t FreeSet::bytes(std::size_t capacity) {
  constexpr std::size_t kPerSample = sizeof(std::size_t) + sizeof(Branch) + sizeof(std::ptrdiff_t);
  constexpr std::size_t kVectors = 3;
  return capacity * (kPerSample + kVectors * sizeof(double)) +
         capacity * (capacity + 1) / 2 * sizeof(double);
}

void FreeSet::clear() {
  for (const std::size_t sample : members_) {
    place_[sample] = kNowhere;
  }
  members_.clear();
  branch_.clear();
  target_ = kNowhere;
}

void FreeSet::join(const KernelMatrix& kernel, std::size_t sample, Branch branch) {
  if (target_ == static_cast<std::ptrdiff_t>(sample)) {
    target_ = kNowhere;
    append(kernel, sample, branch, std::span(aimed_).first(size()));
    return;
  }
  const std::span<double> row = std::span(row_).first(size());
  kernel.gather(sample, members_, row);
  forward(row);
  append(kernel, sample, branch, row);
}

void FreeSet::append(const KernelMatrix& kernel, std::size_t sample, Branch branch,
                     std::span<const double> row) {
  const std::size_t m = size();
  const double self = kernel(sample, sample);
  const double pivot = std::sqrt(std::max(self - dot(row, row), kSvr.least_pivot * self));
  for (std::size_t j = 0; j < m; ++j) {
    factor_[place_of(m, j)] = row[j];
  }
  factor_[place_of(m, m)] = pivot;
  ones_[m] = (1.0 - dot(row, std::span(ones_).first(m))) / pivot;
  if (target_ != kNowhere) {
    const double similarity = kernel(static_cast<std::size_t>(target_), sample);
    aimed_[m] = (similarity - dot(row, std::span(aimed_).first(m))) / pivot;
  }
  place_[sample] = static_cast<std::ptrdiff_t>(m);
  members_.push_back(sample);
  branch_.push_back(branch);
}

void FreeSet::leave(std::size_t place) {
  const std::size_t m = size();
  // With row and column `place` gone, what column `place` held below them is rotated into the
  // columns to its right.
  const std::span<double> loose = std::span(row_).first(m);
  std::ranges::copy(column(place), loose.begin() + static_cast<std::ptrdiff_t>(place));
  double loose_one = ones_[place];
  double loose_aim = aimed_[place];
  for (std::size_t j = 0; j < place; ++j) {
    double* const rows = factor_.data() + place_of(place, j);
    std::copy(rows + 1, rows + (m - place), rows);
  }
  for (std::size_t j = place + 1; j < m; ++j) {
    const std::span<double> old = column(j);
    const double pivot = std::hypot(old[0], loose[j]);
    const double c = old[0] / pivot;
    const double s = loose[j] / pivot;
    rotate(c, s, old.subspan(1), loose.subspan(j + 1));
    rotate(c, s, {&ones_[j], 1}, {&loose_one, 1});
    rotate(c, s, {&aimed_[j], 1}, {&loose_aim, 1});
    old[0] = pivot;
    std::ranges::copy(old, factor_.data() + place_of(j - 1, j - 1));
    ones_[j - 1] = ones_[j];
    aimed_[j - 1] = aimed_[j];
  }
  place_[members_[place]] = kNowhere;
  members_.erase(members_.begin() + static_cast<std::ptrdiff_t>(place));
  branch_.erase(branch_.begin() + static_cast<std::ptrdiff_t>(place));
  for (std::size_t j = place; j < size(); ++j) {
    place_[members_[j]] = static_cast<std::ptrdiff_t>(j);
  }
}

void FreeSet::renew_oldest(const KernelMatrix& kernel) {
  const std::size_t sample = members_.front();
  const Branch branch = branch_.front();
  leave(0);
  join(kernel, sample, branch);
}

void FreeSet::renumber(std::size_t from, std::size_t to) {
  target_ = kNowhere;
  if (from == to) {
    return;
  }
  place_[to] = place_[from];
  place_[from] = kNowhere;
  if (contains(to)) {
    members_[place(to)] = to;
  }
}

void FreeSet::aim(const KernelMatrix& kernel, std::size_t c) {
  target_ = static_cast<std::ptrdiff_t>(c);
  const std::span<double> row = std::span(aimed_).first(size());
  kernel.gather(c, members_, row);
  forward(row);
}

void FreeSet::visit(Archive& archive, std::size_t samples) {
  std::size_t place = 0;
  archive.list(members_, samples, [&](std::size_t& sample) {
    archive.whole(sample);
    archive.require(sample < samples, "has a member that is no sample");
    if (archive.loading()) {
      archive.require(!contains(sample), "has a member twice");
      place_[sample] = static_cast<std::ptrdiff_t>(place++);
    }
  });
  archive.list(branch_, size(),
               [&](Branch& branch) { archive.choice(branch, Branch::negative, Branch::positive); });
  archive.require(branch_.size() == size(), "has members without a branch");
  for (std::size_t j = 0; j < size(); ++j) {
    archive.numbers(column(j));
  }
  archive.numbers(std::span(ones_).first(size()));
  archive.whole(target_, kNowhere, static_cast<std::ptrdiff_t>(samples) - 1);
  if (target_ != kNowhere) {
    archive.numbers(std::span(aimed_).first(size()));
  }
}

double FreeSet::follow(double s, std::span<double> d_beta) const {
  for (std::size_t k = 0; k < size(); ++k) {
    d_beta[k] = -s * aimed_[k];
  }
  return border(-s, d_beta);
}

double FreeSet::correct(double sigma, std::span<double> d_beta) const {
  forward(d_beta);
  return border(sigma, d_beta);
}

double FreeSet::border(double sigma, std::span<double> w) const {
  const std::span<const double> ones = std::span(ones_).first(size());
  const double d_bias = (dot(ones, w) - sigma) / dot(ones, ones);
  add_scaled(-d_bias, ones, w);
  backward(w);
  return d_bias;
}

// Four columns at a time, the small triangle among them first.
void FreeSet::forward(std::span<double> r) const {
  const std::size_t m = size();
  std::size_t j = 0;
  for (; j + 4 <= m; j += 4) {
    for (std::size_t k = j; k < j + 4; ++k) {
      for (std::size_t i = j; i < k; ++i) {
        r[k] -= factor_[place_of(k, i)] * r[i];
      }
      r[k] /= factor_[place_of(k, k)];
    }
    add_scaled({-r[j], -r[j + 1], -r[j + 2], -r[j + 3]}, below(j), r.subspan(j + 4));
  }
  for (; j < m; ++j) {
    const std::span<const double> l = column(j);
    r[j] /= l[0];
    add_scaled(-r[j], l.subspan(1), r.subspan(j + 1));
  }
}

void FreeSet::backward(std::span<double> r) const {
  const std::size_t m = size();
  const std::size_t blocks = m / 4 * 4;
  for (std::size_t j = m; j-- > blocks;) {
    const std::span<const double> l = column(j);
    r[j] = (r[j] - dot(l.subspan(1), r.subspan(j + 1))) / l[0];
  }
  for (std::size_t end = blocks; end > 0; end -= 4) {
    const std::size_t j = end - 4;
    const std::array<double, 4> known = dot(below(j), r.subspan(end));
    for (std::size_t k = end; k-- > j;) {
      r[k] -= known[k - j];
      for (std::size_t i = k + 1; i < end; ++i) {
        r[k] -= factor_[place_of(i, k)] * r[i];
      }
      r[k] /= factor_[place_of(k, k)];
    }
  }
}

// What columns j to j + 3 hold below row j + 3.
Four<double> FreeSet::below(std::size_t j) const {
  const double* const l = factor_.data();
  return {l + place_of(j + 4, j), l + place_of(j + 4, j + 1), l + place_of(j + 4, j + 2),
          l + place_of(j + 4, j + 3)};
}

}  // namespace kelpie
