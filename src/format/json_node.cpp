// SPDX-License-Identifier: Apache-2.0
#include "format/json_node.hpp"

#include <fstream>
#include <iterator>

namespace kelpie::format {

Json parse_json(const std::string& text, const std::string& source) {
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    throw InputError({.file = source, .line = 0, .field = "file"},
                     std::string("is not JSON: ") + error.what());
  }
}

std::string json_text(const std::filesystem::path& file, const std::string& what) {
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream.is_open() || stream.bad() || std::filesystem::is_directory(file)) {
    throw InputError({.file = file.string(), .line = 0, .field = {}},
                     "cannot be read; " + what + " is needed");
  }
  return text;
}

}  // namespace kelpie::format
