// SPDX-License-Identifier: Apache-2.0
#include "bag/compression.hpp"

#include <bzlib.h>
#include <fmt/format.h>
#include <lz4frame.h>
#include <zstd.h>

#include <limits>
#include <memory>

#include "bag/tuning.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::bag {
namespace {

std::string unpack_zstd(std::span<const std::byte> packed, std::span<std::byte> unpacked) {
  const std::size_t size =
      ZSTD_decompress(unpacked.data(), unpacked.size(), packed.data(), packed.size());
  if (ZSTD_isError(size) != 0) {
    return fmt::format("its zstd content is damaged ({})", ZSTD_getErrorName(size));
  }
  return size == unpacked.size() ? "" : "its zstd content is shorter than it says";
}

std::string unpack_lz4(std::span<const std::byte> packed, std::span<std::byte> unpacked) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)) != 0) {
    throw Failure("lz4: out of memory");
  }
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      raw, &LZ4F_freeDecompressionContext);
  std::size_t expected = 1;
  // A frame ends where nothing more is expected; a call may stop at a block's end before that.
  while (expected != 0) {
    std::size_t written = unpacked.size();
    std::size_t read = packed.size();
    expected =
        LZ4F_decompress(context.get(), unpacked.data(), &written, packed.data(), &read, nullptr);
    if (LZ4F_isError(expected) != 0) {
      return fmt::format("its lz4 content is damaged ({})", LZ4F_getErrorName(expected));
    }
    packed = packed.subspan(read);
    unpacked = unpacked.subspan(written);
    if (read == 0 && written == 0 && expected != 0) {
      return "its lz4 content is cut off or longer than it says";
    }
  }
  return unpacked.empty() ? "" : "its lz4 content is shorter than it says";
}

std::string unpack_bz2(std::span<const std::byte> packed, std::span<std::byte> unpacked) {
  constexpr std::size_t kMost = std::numeric_limits<unsigned int>::max();
  if (packed.size() > kMost || unpacked.size() > kMost) {
    return "its bz2 content is longer than 4 GB";
  }
  auto size = static_cast<unsigned int>(unpacked.size());
  // NOLINTBEGIN: bytes as text, and no const, in C
  const int error =
      BZ2_bzBuffToBuffDecompress(reinterpret_cast<char*>(unpacked.data()), &size,
                                 const_cast<char*>(reinterpret_cast<const char*>(packed.data())),
                                 static_cast<unsigned int>(packed.size()), 0, 0);
  // NOLINTEND
  if (error == BZ_MEM_ERROR) {
    throw Failure("bz2: out of memory");
  }
  if (error != BZ_OK) {
    return error == BZ_OUTBUFF_FULL ? "its bz2 content is longer than it says"
                                    : fmt::format("its bz2 content is damaged (error {})", error);
  }
  return size == unpacked.size() ? "" : "its bz2 content is shorter than it says";
}

}  // namespace

std::string unpack(std::string_view compression, std::span<const std::byte> packed,
                   std::uint64_t size, std::vector<std::byte>& unpacked) {
  const bool is_plain = compression.empty();
  if (is_plain ? size != packed.size() : !is_believable(size, packed.size())) {
    return fmt::format("{} bytes cannot come of {} stored ones", size, packed.size());
  }
  if (!is_plain && compression != "zstd" && compression != "lz4" && compression != "bz2") {
    return fmt::format("its compression '{}' is unknown; zstd, lz4 and bz2 are read", compression);
  }
  if (is_plain) {
    unpacked.assign(packed.begin(), packed.end());
    return "";
  }
  unpacked.resize(static_cast<std::size_t>(size));
  return compression == "zstd"  ? unpack_zstd(packed, unpacked)
         : compression == "lz4" ? unpack_lz4(packed, unpacked)
                                : unpack_bz2(packed, unpacked);
}

bool is_believable(std::uint64_t size, std::uint64_t packed) {
  return size <= kTuning.free_bytes || size / kTuning.most_ratio <= packed;
}

std::string check_unpacked(std::uint64_t messages, std::uint64_t bag_bytes) {
  return messages <= kTuning.free_messages + bag_bytes
             ? ""
             : fmt::format(
                   "the bag unpacks to more than {} messages, which cannot come of its {} "
                   "bytes",
                   messages - 1, bag_bytes);
}

std::string pack(std::string_view compression, std::string_view bytes) {
  if (compression.empty()) {
    return std::string(bytes);
  }
  const bool is_zstd = compression == "zstd";
  std::string packed(
      is_zstd ? ZSTD_compressBound(bytes.size()) : LZ4F_compressFrameBound(bytes.size(), nullptr),
      '\0');
  const std::size_t size = is_zstd ? ZSTD_compress(packed.data(), packed.size(), bytes.data(),
                                                   bytes.size(), kTuning.zstd_level)
                                   : LZ4F_compressFrame(packed.data(), packed.size(), bytes.data(),
                                                        bytes.size(), nullptr);
  if ((is_zstd ? ZSTD_isError(size) : LZ4F_isError(size)) != 0) {
    throw Failure("compressing a chunk failed");
  }
  packed.resize(size);
  return packed;
}

}  // namespace kelpie::bag
