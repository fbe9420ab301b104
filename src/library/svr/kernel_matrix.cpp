// SPDX-License-Identifier: Apache-2.0
#include "svr/kernel_matrix.hpp"

#include <algorithm>

#include "core/vector.hpp"

namespace kelpie {
namespace {

constexpr std::size_t kLine = 16;  // floats in a cache line

std::size_t row_stride(std::size_t capacity) {
  return (capacity + kLine - 1) / kLine * kLine;
}

template <typename T>
void append_row(std::vector<T>& data, std::size_t stride, std::size_t n,
                std::span<const double> row, double self) {
  T* const last = data.data() + n * stride;
  for (std::size_t j = 0; j < n; ++j) {
    last[j] = static_cast<T>(row[j]);
    data[j * stride + n] = last[j];
  }
  last[n] = static_cast<T>(self);
}

// Requires i < last.
template <typename T>
void move_last(std::vector<T>& data, std::size_t stride, std::size_t i, std::size_t last) {
  const T* const from = data.data() + last * stride;
  const T self = from[last];
  std::copy_n(from, last, data.data() + i * stride);
  for (std::size_t j = 0; j < last; ++j) {
    data[j * stride + i] = from[j];
  }
  data[i * stride + i] = self;
}

template <typename T>
void combine_rows(const std::vector<T>& data, std::size_t stride, std::size_t n,
                  std::span<const std::size_t> rows, std::span<const double> weights,
                  std::span<double> out) {
  const auto row = [&](std::size_t k) { return data.data() + rows[k] * stride; };
  std::size_t k = 0;
  for (; k + 4 <= rows.size(); k += 4) {
    add_scaled({weights[k], weights[k + 1], weights[k + 2], weights[k + 3]},
               Four<T>{row(k), row(k + 1), row(k + 2), row(k + 3)}, out);
  }
  for (; k < rows.size(); ++k) {
    add_scaled(weights[k], std::span(row(k), n), out);
  }
}

// What is below the diagonal, row after row.
template <typename T>
void visit_lower(Archive& archive, std::vector<T>& data, std::size_t stride, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const std::span<T> row(data.data() + i * stride, i);
    archive.numbers(row);
    for (std::size_t j = 0; archive.loading() && j < i; ++j) {
      data[j * stride + i] = row[j];
    }
  }
}

}  // namespace

KernelMatrix::KernelMatrix(std::size_t capacity, Storage storage)
    : capacity_(capacity), stride_(row_stride(capacity)) {
  if (storage == Storage::float64) {
    doubles_.resize(capacity * stride_);
  } else {
    singles_.resize(capacity * stride_);
  }
  diagonal_.reserve(capacity);
}

double KernelMatrix::dot(std::size_t i, std::span<const double> v) const {
  const std::size_t n = size();
  if (singles_.empty()) {
    return kelpie::dot(std::span(doubles_.data() + i * stride_, n), v);
  }
  const float* const row = singles_.data() + i * stride_;
  return kelpie::dot(std::span(row, n), v) + (diagonal_[i] - static_cast<double>(row[i])) * v[i];
}

void KernelMatrix::combine(std::span<const std::size_t> rows, std::span<const double> weights,
                           std::span<double> out) const {
  if (singles_.empty()) {
    combine_rows(doubles_, stride_, size(), rows, weights, out);
    return;
  }
  combine_rows(singles_, stride_, size(), rows, weights, out);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::size_t i = rows[k];
    out[i] += weights[k] * (diagonal_[i] - static_cast<double>(singles_[i * stride_ + i]));
  }
}

void KernelMatrix::row(std::size_t i, std::span<double> out) const {
  for (std::size_t j = 0; j < out.size(); ++j) {
    out[j] = (*this)(i, j);
  }
}

void KernelMatrix::gather(std::size_t i, std::span<const std::size_t> columns,
                          std::span<double> out) const {
  if (singles_.empty()) {
    const double* const row = doubles_.data() + i * stride_;
    std::ranges::transform(columns, out.begin(), [row](std::size_t j) { return row[j]; });
    return;
  }
  std::ranges::transform(columns, out.begin(), [&](std::size_t j) { return (*this)(i, j); });
}

void KernelMatrix::add(std::span<const double> row, double self) {
  if (singles_.empty()) {
    append_row(doubles_, stride_, size(), row, self);
  } else {
    append_row(singles_, stride_, size(), row, self);
  }
  diagonal_.push_back(self);
}

void KernelMatrix::remove(std::size_t i) {
  const std::size_t last = size() - 1;
  if (i != last) {
    if (singles_.empty()) {
      move_last(doubles_, stride_, i, last);
    } else {
      move_last(singles_, stride_, i, last);
    }
    diagonal_[i] = diagonal_[last];
  }
  diagonal_.pop_back();
}

void KernelMatrix::visit(Archive& archive) {
  archive.list(diagonal_, capacity_, [&](double& self) { archive.number(self); });
  for (std::size_t i = 0; archive.loading() && i < size(); ++i) {
    if (singles_.empty()) {
      doubles_[i * stride_ + i] = diagonal_[i];
    } else {
      singles_[i * stride_ + i] = static_cast<float>(diagonal_[i]);
    }
  }
  if (singles_.empty()) {
    visit_lower(archive, doubles_, stride_, size());
  } else {
    visit_lower(archive, singles_, stride_, size());
  }
}

std::size_t KernelMatrix::bytes(std::size_t capacity, Storage storage) {
  const std::size_t element = storage == Storage::float64 ? sizeof(double) : sizeof(float);
  return capacity * (row_stride(capacity) * element + sizeof(double));
}

}  // namespace kelpie
