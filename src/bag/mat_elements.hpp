// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>

#include "kelpie/core/error.hpp"

namespace kelpie::bag {

/// Whether the variables of a .mat file of version 5 are what their sizes say: libmatio believes
/// these. `bytes` is the file's content, which has a header; messages call it `file`. `lose` is
/// told of the first variable that isn't sound (offset, why): cut off, compressed content that is
/// damaged, more elements than bytes, structs more than 16 deep. Returns how many there are before.
/// Memory: the largest compressed variable, whose size is believed in proportion to what is stored.
std::size_t sound_mat_variables(std::span<const std::byte> bytes, const std::string& file,
                                const std::function<void(const InputError&)>& lose);

}  // namespace kelpie::bag
