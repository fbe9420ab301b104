// SPDX-License-Identifier: Apache-2.0
#include "bag/file_reader.hpp"

#include <fmt/format.h>

namespace kelpie::bag {

Place FileReader::place() const {
  Place place{.file = region_.file};
  if (has_noted()) {
    place.field = fmt::format("{}, {}offset {}", topics()[last_topic_].name, last_region_->part,
                              last_offset_);
  }
  return place;
}

void FileReader::note(std::size_t topic, std::size_t offset, const Region& region) {
  last_topic_ = topic;
  last_offset_ = offset;
  last_region_ = &region;
}

}  // namespace kelpie::bag
