// SPDX-License-Identifier: Apache-2.0
#include "file/plugin.hpp"

#include <fmt/format.h>

#include <system_error>

#include "kelpie/core/error.hpp"

namespace kelpie::file {

std::filesystem::path find_plugin(const std::string& name) {
  namespace fs = std::filesystem;
  std::error_code none;
  const fs::path program = fs::read_symlink("/proc/self/exe", none).parent_path();
  const fs::path installed = (program / KELPIE_PLUGINS_FROM_PROGRAM).lexically_normal();
  for (const fs::path& folder : {program, installed}) {
    if (fs::exists(folder / name, none)) {
      return folder / name;
    }
  }
  throw Failure(
      fmt::format("there is no {} in {} or {}", name, program.string(), installed.string()));
}

}  // namespace kelpie::file
