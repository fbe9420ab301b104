// SPDX-License-Identifier: Apache-2.0
#include "file/content.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <system_error>
#include <vector>

#include "file/descriptor.hpp"
#include "file/tuning.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::file {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kReadStep = std::size_t{1} << 18U;

// Reads a file to the end.
class ContentReader {
 public:
  ContentReader(const fs::path& file, const std::string& wanted, std::size_t most_bytes)
      : file_(file), wanted_(wanted), most_bytes_(most_bytes) {}

  std::string read() {
    struct stat status = {};
    check(::stat(file_.c_str(), &status) == 0, status);
    // A pipe that nobody writes yet must not block open(), which could not say so.
    const Descriptor descriptor(file_, O_RDONLY | O_NONBLOCK);
    check(descriptor.is_open() && ::fstat(descriptor.number(), &status) == 0, status);
    const bool is_pipe = S_ISFIFO(status.st_mode);
    if (!is_pipe) {
      const auto size = static_cast<std::size_t>(std::max<off_t>(status.st_size, 0));
      require_room(size);
      content_.reserve(size);
    }
    do {
      if (is_pipe) {
        wait(descriptor);
      }
    } while (read_some(descriptor));
    return std::move(content_);
  }

 private:
  [[noreturn]] void refuse(const std::string& reason) const {
    throw InputError({.file = file_.string()}, reason + "; " + wanted_ + " is needed");
  }

  void check(bool succeeded, const struct stat& status) const {
    if (!succeeded) {
      refuse("cannot be read: " + std::generic_category().message(errno));
    }
    if (S_ISDIR(status.st_mode)) {
      refuse("is a folder");
    }
    if (!S_ISREG(status.st_mode) && !S_ISFIFO(status.st_mode)) {
      refuse("is a device");
    }
  }

  void require_room(std::size_t bytes) const {
    if (bytes > most_bytes_) {
      throw InputError({.file = file_.string()},
                       fmt::format("is larger than {}, the most that is read of {}",
                                   megabytes(most_bytes_), wanted_));
    }
  }

  // Until there is something to read, or no writer any more.
  void wait(const Descriptor& descriptor) {
    pollfd waiting{.fd = descriptor.number(), .events = POLLIN, .revents = 0};
    int ready = ::poll(&waiting, 1, kTuning.silence_ms);
    if (ready == 0 && !has_said_) {
      has_said_ = true;
      fmt::print(stderr,
                 "kelpie: {}: is a pipe, and nothing has come for {} s; waiting (Ctrl-C ends)\n",
                 file_.string(), kTuning.silence_ms / 1000);
    }
    if (ready == 0) {
      ready = ::poll(&waiting, 1, -1);
    }
    if (ready < 0) {
      throw Failure(fmt::format("{}: waiting for the pipe was ended: {}", file_.string(),
                                std::generic_category().message(errno)));
    }
  }

  // Returns false at the end.
  bool read_some(const Descriptor& descriptor) {
    const ssize_t count = ::read(descriptor.number(), step_.data(), step_.size());
    if (count < 0 && errno != EAGAIN && errno != EINTR) {
      throw Failure(fmt::format("{}: reading failed: {}", file_.string(),
                                std::generic_category().message(errno)));
    }
    content_.append(step_.data(), count > 0 ? static_cast<std::size_t>(count) : 0);
    require_room(content_.size());
    return count != 0;
  }

  const fs::path& file_;
  const std::string& wanted_;
  std::size_t most_bytes_;
  std::vector<char> step_ = std::vector<char>(kReadStep);
  std::string content_;
  bool has_said_ = false;
};

}  // namespace

std::string read_content(const fs::path& file, const std::string& wanted, std::size_t most_bytes) {
  return ContentReader(file, wanted, most_bytes).read();
}

std::string beginning_of(const fs::path& file, std::size_t most_bytes) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    return {};
  }
  std::string bytes(most_bytes, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

std::string megabytes(std::size_t bytes) {
  return fmt::format("{} MB", std::round(static_cast<double>(bytes) / 1e5) / 10.0);
}

}  // namespace kelpie::file
