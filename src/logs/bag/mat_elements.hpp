// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>

#include "kelpie/core/error.hpp"

namespace kelpie::bag {

/// Counts the sound variables at the beginning of a .mat file of version 5, because libmatio trusts
/// the sizes in the file. `bytes` is the content including the header; messages call the file
/// `file`. `lose` receives the first unsound variable (offset, reason): cut off, damaged compressed
/// content, more elements than bytes, structs more than 16 deep. Memory: the largest compressed
/// variable; the unpacked size is accepted only in proportion to the packed bytes.
std::size_t sound_mat_variables(std::span<const std::byte> bytes, const std::string& file,
                                const std::function<void(const InputError&)>& lose);

}  // namespace kelpie::bag
