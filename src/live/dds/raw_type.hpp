// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>

struct ddsi_serdata;
struct ddsi_sertype;

namespace kelpie::dds {

/// A type of Cyclone DDS with a name and opaque bytes as samples, without a key. A topic takes over
/// the type; before, free_raw_type() frees the type.
ddsi_sertype* new_raw_type(const std::string& dds_type);
void free_raw_type(ddsi_sertype* type);

/// A sample of a raw type with a copy of `cdr`; a reader or writer takes the only reference.
ddsi_serdata* new_raw_sample(const ddsi_sertype* type, std::span<const std::byte> cdr);

/// Bytes of a raw sample, valid as long as the sample. Up to three zeros may follow the message,
/// since DDS sends multiples of four bytes.
std::span<const std::byte> bytes_of(const ddsi_serdata* sample);

}  // namespace kelpie::dds
