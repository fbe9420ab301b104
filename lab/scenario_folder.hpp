// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace kelpie::lab {

/// The folder of the scenario files: `scenarios` in the working folder where there is one, else
/// where `cmake --install` puts them beside the program, else that of the checkout that the program
/// was built in. Throws InputError where there is none of them.
std::filesystem::path scenario_folder();

}  // namespace kelpie::lab
