// SPDX-License-Identifier: Apache-2.0
#include "dds/raw_type.hpp"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/q_radmin.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <vector>

namespace kelpie::dds {
namespace {

constexpr std::size_t kAlignment = 4;  // of payloads

struct RawType : ddsi_sertype {};

struct RawSample : ddsi_serdata {
  RawSample(const ddsi_sertype* of_type, ddsi_serdata_kind of_kind, std::size_t size)
      : ddsi_serdata{}, bytes((size + kAlignment - 1) / kAlignment * kAlignment) {
    ddsi_serdata_init(this, of_type, of_kind);
  }

  std::vector<std::byte> bytes;
};

const RawSample& raw(const ddsi_serdata* sample) {
  return *static_cast<const RawSample*>(sample);
}

// Cyclone DDS is C: no exception may pass; without memory there is no sample.
template <typename Fill>
ddsi_serdata* sample_or_null(const ddsi_sertype* type, ddsi_serdata_kind kind, std::size_t size,
                             const Fill& fill) {
  try {
    auto sample = std::make_unique<RawSample>(type, kind, size);
    fill(std::span(sample->bytes));
    return sample.release();
  } catch (const std::exception&) {
    return nullptr;
  }
}

// Fragments are ordered by position and may overlap.
ddsi_serdata* from_fragments(const ddsi_sertype* type, ddsi_serdata_kind kind,
                             const nn_rdata* fragment, std::size_t size) {
  return sample_or_null(type, kind, size, [&](std::span<std::byte> bytes) {
    std::size_t filled = 0;
    for (; fragment != nullptr; fragment = fragment->nextfrag) {
      const std::size_t end = std::min<std::size_t>(fragment->maxp1, bytes.size());
      if (end > filled && fragment->min <= filled) {
        const auto* const payload = reinterpret_cast<const std::byte*>(
            NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment)));
        std::copy_n(payload + (filled - fragment->min), end - filled, bytes.data() + filled);
        filled = end;
      }
    }
  });
}

ddsi_serdata* from_pieces(const ddsi_sertype* type, ddsi_serdata_kind kind,
                          ddsrt_msg_iovlen_t count, const ddsrt_iovec_t* pieces, std::size_t size) {
  return sample_or_null(type, kind, size, [&](std::span<std::byte> bytes) {
    std::size_t filled = 0;
    for (ddsrt_msg_iovlen_t i = 0; i < count; ++i) {
      const std::size_t length = std::min<std::size_t>(pieces[i].iov_len, bytes.size() - filled);
      std::copy_n(static_cast<const std::byte*>(pieces[i].iov_base), length, bytes.data() + filled);
      filled += length;
    }
  });
}

ddsi_serdata* without_bytes(const ddsi_sertype* type) {
  return sample_or_null(type, SDK_KEY, 0, [](std::span<std::byte>) {});
}

constexpr ddsi_serdata_ops sample_operations() {
  ddsi_serdata_ops ops{};
  // There are no keys: all samples are of one instance.
  ops.eqkey = [](const ddsi_serdata*, const ddsi_serdata*) { return true; };
  ops.get_size = [](const ddsi_serdata* sample) {
    return static_cast<std::uint32_t>(raw(sample).bytes.size());
  };
  ops.from_ser = from_fragments;
  ops.from_ser_iov = from_pieces;
  ops.from_keyhash = [](const ddsi_sertype* type, const ddsi_keyhash*) {
    return without_bytes(type);
  };
  // Samples come and go as bytes (dds_forwardcdr, dds_takecdr), never as objects.
  ops.from_sample = [](const ddsi_sertype* type, ddsi_serdata_kind kind,
                       const void*) -> ddsi_serdata* {
    return kind == SDK_DATA ? nullptr : without_bytes(type);
  };
  ops.to_sample = [](const ddsi_serdata*, void*, void**, void*) { return false; };
  ops.untyped_to_sample = [](const ddsi_sertype*, const ddsi_serdata*, void*, void**, void*) {
    return false;
  };
  ops.to_untyped = [](const ddsi_serdata* sample) {
    ddsi_serdata* const untyped = without_bytes(sample->type);
    if (untyped != nullptr) {
      untyped->type = nullptr;
    }
    return untyped;
  };
  ops.to_ser = [](const ddsi_serdata* sample, std::size_t first, std::size_t size, void* to) {
    std::copy_n(raw(sample).bytes.data() + first, size, static_cast<std::byte*>(to));
  };
  ops.to_ser_ref = [](const ddsi_serdata* sample, std::size_t first, std::size_t size,
                      ddsrt_iovec_t* piece) {
    piece->iov_base = const_cast<std::byte*>(raw(sample).bytes.data() + first);  // only read
    piece->iov_len = size;
    return ddsi_serdata_ref(sample);
  };
  ops.to_ser_unref = [](ddsi_serdata* sample, const ddsrt_iovec_t*) { ddsi_serdata_unref(sample); };
  ops.free = [](ddsi_serdata* sample) { delete static_cast<RawSample*>(sample); };
  ops.print = [](const ddsi_sertype*, const ddsi_serdata*, char* text, std::size_t size) {
    if (size > 0) {
      *text = '\0';
    }
    return std::size_t{0};
  };
  ops.get_keyhash = [](const ddsi_serdata*, ddsi_keyhash* hash, bool) { *hash = {}; };
  return ops;
}

void free_type(ddsi_sertype* type) {
  ddsi_sertype_fini(type);
  delete static_cast<RawType*>(type);
}

ddsi_sertype_ops type_operations() {
  ddsi_sertype_ops ops{};
  ops.version = ddsi_sertype_v0;
  ops.free = free_type;
  ops.zero_samples = [](const ddsi_sertype*, void*, std::size_t) {};
  ops.realloc_samples = [](void**, const ddsi_sertype*, void*, std::size_t, std::size_t) {};
  ops.free_samples = [](const ddsi_sertype*, void**, std::size_t, dds_free_op_t) {};
  // Asked only of types with one name and the same operations.
  ops.equal = [](const ddsi_sertype*, const ddsi_sertype*) { return true; };
  ops.hash = [](const ddsi_sertype*) { return std::uint32_t{0}; };
  return ops;
}

const ddsi_serdata_ops kSampleOperations = sample_operations();
const ddsi_sertype_ops kTypeOperations = type_operations();

}  // namespace

ddsi_sertype* new_raw_type(const std::string& dds_type) {
  auto type = std::make_unique<RawType>();
  ddsi_sertype_init(type.get(), dds_type.c_str(), &kTypeOperations, &kSampleOperations, true);
  type->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;  // as ROS 2 writes
  return type.release();
}

void free_raw_type(ddsi_sertype* type) {
  ddsi_sertype_unref(type);
}

ddsi_serdata* new_raw_sample(const ddsi_sertype* type, std::span<const std::byte> cdr) {
  auto sample = std::make_unique<RawSample>(type, SDK_DATA, cdr.size());
  std::ranges::copy(cdr, sample->bytes.begin());
  return sample.release();
}

std::span<const std::byte> bytes_of(const ddsi_serdata* sample) {
  return raw(sample).bytes;
}

}  // namespace kelpie::dds
