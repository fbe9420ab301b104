// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "kelpie/core/error.hpp"

namespace kelpie::python {

namespace py = pybind11;

/// The arrays of function arguments: float64 in C order, never copied (py::arg().noconvert()).
using Array = py::array_t<double, py::array::c_style>;

/// A view of the rows of an array.
class Rows {
 public:
  /// Throws InputError naming the array unless the array is aligned and of shape (n, columns), or
  /// (n,) for a single column.
  Rows(const Array& array, std::size_t columns, const std::string& name);

  std::size_t size() const { return rows_; }
  std::span<const double> operator[](std::size_t row) const {
    return {data_ + row * columns_, columns_};
  }

  /// Throws InputError naming the array on another number of rows.
  void require_size(std::size_t rows, const std::string& name) const;

 private:
  const double* data_;
  std::size_t rows_;
  std::size_t columns_;
};

/// Row `row` of a writable array.
template <typename T>
std::span<T> row_of(T* data, std::size_t row, std::size_t columns) {
  return {data + row * columns, columns};
}

/// Runs step(row) for every row, while other threads of Python run. About twenty times a second the
/// lock of `take_lock` is released, and Python's signals are handled: Ctrl-C ends the loop between
/// two rows, by an exception. A holder of the lock never waits for the GIL, nor the reverse.
template <typename TakeLock, typename Step>
void for_rows(std::size_t rows, TakeLock take_lock, Step step) {
  constexpr std::chrono::milliseconds kSlice{50};
  using Clock = std::chrono::steady_clock;
  for (std::size_t row = 0; row < rows;) {
    {
      const py::gil_scoped_release release;
      [[maybe_unused]] const auto lock = take_lock();
      const Clock::time_point until = Clock::now() + kSlice;
      do {
        step(row++);
      } while (row < rows && Clock::now() < until);
    }
    if (PyErr_CheckSignals() != 0) {
      throw py::error_already_set();
    }
  }
}

inline py::ssize_t extent(std::size_t size) {
  return static_cast<py::ssize_t>(size);
}

}  // namespace kelpie::python
