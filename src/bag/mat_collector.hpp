// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bag/mat_file.hpp"

struct matvar_t;  // of libmatio

namespace kelpie::bag {

/// A name as MATLAB allows them: letters, digits and underscores, a letter first.
std::string mat_identifier(std::string_view name);

/// Takes variables of libmatio apart into arrays of real numbers, as read_mat_arrays() says.
class MatCollector {
 public:
  using Lose = std::function<void(const InputError&)>;

  /// Both have to outlive it.
  MatCollector(const std::filesystem::path& file, const Lose& lose) : file_(file), lose_(lose) {}

  /// Throws InputError (file, path): structs more than 16 deep, and what `lose` throws of damage.
  void add(matvar_t* variable, const std::string& path, std::size_t depth = 0);

  std::vector<MatArray>& arrays() { return arrays_; }

 private:
  void add_numbers(const matvar_t& variable, std::size_t count, const std::string& path);
  void add_structs(matvar_t* variable, std::size_t count, const std::string& path,
                   std::size_t depth);
  void lose(const std::string& path, const std::string& message) const;

  const std::filesystem::path& file_;
  const Lose& lose_;
  std::vector<MatArray> arrays_;
};

}  // namespace kelpie::bag
