// SPDX-License-Identifier: Apache-2.0
#include "rows.hpp"

namespace kelpie::python {
namespace {

std::string shape_text(const Array& array) {
  std::string text;
  for (py::ssize_t axis = 0; axis < array.ndim(); ++axis) {
    text += std::to_string(array.shape(axis)) + (axis + 1 < array.ndim() ? ", " : "");
  }
  return "(" + text + (array.ndim() == 1 ? ",)" : ")");
}

}  // namespace

Rows::Rows(const Array& array, std::size_t columns, const std::string& name)
    : data_(array.data()),
      rows_(array.ndim() > 0 ? static_cast<std::size_t>(array.shape(0)) : 0),
      columns_(columns) {
  const bool flat = array.ndim() == 1 && columns == 1;
  const bool fits = array.ndim() == 2 && static_cast<std::size_t>(array.shape(1)) == columns;
  if (!flat && !fits) {
    throw InputError(name, "is of shape " + shape_text(array) + "; it has to be (n, " +
                               std::to_string(columns) + ")");
  }
  if (reinterpret_cast<std::uintptr_t>(data_) % alignof(double) != 0) {
    throw InputError(name, "is not aligned in memory");
  }
}

void Rows::require_size(std::size_t rows, const std::string& name) const {
  if (rows_ != rows) {
    throw InputError(
        name, "has " + std::to_string(rows_) + " rows; it has to have " + std::to_string(rows));
  }
}

}  // namespace kelpie::python
