// SPDX-License-Identifier: Apache-2.0
#include "bag/file_reader.hpp"

#include <fmt/format.h>

namespace kelpie::bag {

bool FileReader::next(Message& message) {
  while (at_ < bytes_.size()) {
    try {
      if (step(message)) {
        return true;
      }
    } catch (const InputError& error) {
      lose(error);
      pass_damage();
    }
  }
  return false;
}

Place FileReader::place() const {
  return {.file = region_.file,
          .line = 0,
          .field = has_noted()
                       ? fmt::format("{}, offset {}", topics()[last_topic_].name, last_offset_)
                       : ""};
}

void FileReader::note(std::size_t topic, std::size_t offset) {
  last_topic_ = topic;
  last_offset_ = offset;
}

}  // namespace kelpie::bag
