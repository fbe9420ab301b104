// SPDX-License-Identifier: Apache-2.0
#include "lab/scenario_folder.hpp"

#include <system_error>

#include "kelpie/core/error.hpp"

namespace kelpie::lab {

namespace fs = std::filesystem;

fs::path scenario_folder() {
  std::error_code none;
  const fs::path program = fs::read_symlink("/proc/self/exe", none).parent_path();
  for (const fs::path& folder :
       {fs::path("scenarios"), program / KELPIE_DATA_FROM_PROGRAM / "scenarios",
        program / "../../scenarios"}) {
    if (fs::is_directory(folder, none)) {
      return folder.lexically_normal();
    }
  }
  throw InputError("--scenarios",
                   "there is no folder 'scenarios' here or with the program; name one");
}

}  // namespace kelpie::lab
