// SPDX-License-Identifier: Apache-2.0
#include "dds/entity.hpp"

#include <dds/dds.h>

#include "kelpie/core/error.hpp"

namespace kelpie::dds {

Entity::Entity(std::int32_t created, const std::string& what) : number_(created) {
  if (created < 0) {
    throw Failure(what + ": " + dds_strretcode(created));
  }
}

Entity::~Entity() {
  if (number_ > 0) {
    dds_delete(number_);
  }
}

}  // namespace kelpie::dds
