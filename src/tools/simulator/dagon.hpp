// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace kelpie::simulator {

/// vehicles/dagon.toml, for a program that runs anywhere; CMake writes the source
/// (cmake/PageAssets.cmake).
extern const std::string_view kDagon;

}  // namespace kelpie::simulator
