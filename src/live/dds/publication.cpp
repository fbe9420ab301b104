// SPDX-License-Identifier: Apache-2.0
#include "dds/publication.hpp"

#include <dds/dds.h>

#include "dds/raw_type.hpp"

namespace kelpie::dds {

Publication::Publication(const Participant& participant, const std::string& topic,
                         const std::string& type, const Quality& quality)
    : end_(participant,
           {.publishes = true, .own = true, .topic = topic, .type = type, .quality = quality}),
      writer_(
          dds_create_writer(participant.number(), end_.number(), qos_of(quality).get(), nullptr),
          topic + " couldn't be published") {}

bool Publication::publish(std::span<const std::byte> cdr) {
  const bool sent = dds_writecdr(writer_.number(), new_raw_sample(end_.type(), cdr)) == 0;
  refused_ += sent ? 0 : 1;
  return sent;
}

std::size_t Publication::subscribers() const {
  dds_publication_matched_status_t status{};
  dds_get_publication_matched_status(writer_.number(), &status);
  return status.current_count;
}

std::vector<std::string> Publication::mismatches() const {
  return end_.mismatches(writer_.number());
}

}  // namespace kelpie::dds
