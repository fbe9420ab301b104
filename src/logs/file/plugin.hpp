// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace kelpie::file {

/// The shared object `name` of kelpie's: beside the running program, or in the folder in which an
/// installation has them. Throws Failure, "there is no … in … or …".
std::filesystem::path find_plugin(const std::string& name);

}  // namespace kelpie::file
