// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>

struct ddsi_serdata;
struct ddsi_sertype;

namespace kelpie::dds {

/// A type for Cyclone DDS of which it knows the name alone: samples are bytes that nobody looks at,
/// without a key. Whoever creates a topic with it hands it over; before that it is freed by
/// free_raw_type().
ddsi_sertype* new_raw_type(const std::string& dds_type);
void free_raw_type(ddsi_sertype* type);

/// A sample of a raw type with a copy of these bytes; its reader or writer takes the one reference.
ddsi_serdata* new_raw_sample(const ddsi_sertype* type, std::span<const std::byte> cdr);

/// The bytes of a sample of a raw type, valid as long as it is; behind them may stand up to three
/// zeros, since DDS sends multiples of four.
std::span<const std::byte> bytes_of(const ddsi_serdata* sample);

}  // namespace kelpie::dds
