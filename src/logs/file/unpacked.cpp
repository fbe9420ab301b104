// SPDX-License-Identifier: Apache-2.0
#include "file/unpacked.hpp"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <string_view>
#include <vector>

#include "file/content.hpp"
#include "file/tuning.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::file {
namespace {

constexpr std::string_view kGzip = "\x1F\x8B";
constexpr std::string_view kZstd = "\x28\xB5\x2F\xFD";
constexpr std::size_t kStep = std::size_t{1} << 18U;

// Takes what was unpacked, as long as it can be a log.
class Unpacked {
 public:
  Unpacked(const std::string& packed, const std::string& source)
      : source_(source),
        most_(std::min(kTuning.table_bytes,
                       std::max(kTuning.free_unpacked, kTuning.most_ratio * packed.size()))) {}

  void add(const char* bytes, std::size_t count) {
    if (count > most_ - text_.size()) {
      refuse("unpacks to more than " + megabytes(most_) +
             ", too large for a log; if it is one, unpack it first");
    }
    text_.append(bytes, count);
  }
  [[noreturn]] void refuse(const std::string& message) const {
    throw InputError({.file = source_}, message);
  }
  std::string take() { return std::move(text_); }

 private:
  const std::string& source_;
  std::size_t most_;
  std::string text_;
};

// One member after the other, as `cat a.gz b.gz` makes them.
std::string unpack_gzip(const std::string& packed, const std::string& source) {
  constexpr int kGzipOnly = 16 + MAX_WBITS;
  Unpacked unpacked(packed, source);
  std::vector<char> step(kStep);
  z_stream stream{};
  if (::inflateInit2(&stream, kGzipOnly) != Z_OK) {
    throw Failure("zlib: out of memory");
  }
  const std::unique_ptr<z_stream, decltype(&::inflateEnd)> end(&stream, &::inflateEnd);
  int state = Z_OK;
  for (std::size_t at = 0; at < packed.size() || (state == Z_OK && stream.avail_out == 0);) {
    if (state == Z_STREAM_END && ::inflateReset(&stream) != Z_OK) {
      throw Failure("zlib: out of memory");
    }
    const std::size_t given =
        std::min<std::size_t>(packed.size() - at, std::numeric_limits<uInt>::max());
    // zlib doesn't write there, but its type says it may.
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + at));  // NOLINT
    stream.avail_in = static_cast<uInt>(given);
    stream.next_out = reinterpret_cast<Bytef*>(step.data());  // NOLINT: bytes as text
    stream.avail_out = static_cast<uInt>(step.size());
    state = ::inflate(&stream, Z_NO_FLUSH);
    if (state != Z_OK && state != Z_STREAM_END && state != Z_BUF_ERROR) {
      unpacked.refuse("its gzip content is damaged" +
                      std::string(stream.msg == nullptr ? "" : ": ") +
                      (stream.msg == nullptr ? "" : stream.msg));
    }
    at += given - stream.avail_in;
    unpacked.add(step.data(), step.size() - stream.avail_out);
    if (state == Z_BUF_ERROR) {
      break;
    }
  }
  if (state != Z_STREAM_END) {
    unpacked.refuse("its gzip content is cut off");
  }
  return unpacked.take();
}

std::string unpack_zstd(const std::string& packed, const std::string& source) {
  Unpacked unpacked(packed, source);
  std::vector<char> step(kStep);
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(),
                                                                     &ZSTD_freeDCtx);
  if (context == nullptr) {
    throw Failure("zstd: out of memory");
  }
  ZSTD_inBuffer input{packed.data(), packed.size(), 0};
  std::size_t due = 1;
  std::size_t written = 0;
  while (input.pos < input.size || (due != 0 && written == step.size())) {
    ZSTD_outBuffer output{step.data(), step.size(), 0};
    due = ZSTD_decompressStream(context.get(), &output, &input);
    if (ZSTD_isError(due) != 0) {
      unpacked.refuse(std::string("its zstd content is damaged: ") + ZSTD_getErrorName(due));
    }
    written = output.pos;
    unpacked.add(step.data(), written);
  }
  if (due != 0) {
    unpacked.refuse("its zstd content is cut off");
  }
  return unpacked.take();
}

}  // namespace

std::string unpacked(std::string content, const std::string& source) {
  if (content.starts_with(kGzip)) {
    return unpack_gzip(content, source);
  }
  if (content.starts_with(kZstd)) {
    return unpack_zstd(content, source);
  }
  return content;
}

}  // namespace kelpie::file
