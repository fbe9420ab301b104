// SPDX-License-Identifier: Apache-2.0
#include "autopilot/byte_line.hpp"

#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <thread>
#include <utility>

#include "autopilot/tuning.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::autopilot {
namespace {

constexpr std::size_t kLongestDatagram = 65'536;

sockaddr* as_address(sockaddr_storage& storage) {
  return reinterpret_cast<sockaddr*>(&storage);  // NOLINT: as sockets want it
}

std::string reason() {
  return std::generic_category().message(errno);
}

constexpr std::size_t kBuffer = 4096;

constexpr std::array<std::pair<unsigned, speed_t>, 14> kRates{{
    {9600, B9600},
    {19200, B19200},
    {38400, B38400},
    {57600, B57600},
    {115200, B115200},
    {230400, B230400},
    {460800, B460800},
    {500000, B500000},
    {576000, B576000},
    {921600, B921600},
    {1000000, B1000000},
    {1500000, B1500000},
    {2000000, B2000000},
    {3000000, B3000000},
}};

const std::pair<unsigned, speed_t>* rate_of(unsigned bits_per_s) {
  return std::ranges::find(kRates, bits_per_s, &std::pair<unsigned, speed_t>::first);
}

// Bytes as they come, without echo, signals or flow control.
bool make_raw(int line, speed_t rate) {
  termios state{};
  if (::tcgetattr(line, &state) != 0) {
    return false;
  }
  ::cfmakeraw(&state);
  state.c_cflag |= CLOCAL | CREAD;
  state.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
  state.c_cc[VMIN] = 0;
  state.c_cc[VTIME] = 0;
  return ::cfsetispeed(&state, rate) == 0 && ::cfsetospeed(&state, rate) == 0 &&
         ::tcsetattr(line, TCSANOW, &state) == 0;
}

}  // namespace

bool Address::operator==(const Address& other) const {
  return bytes == other.bytes && std::memcmp(&storage, &other.storage, bytes) == 0;
}

std::string Address::text() const {
  std::array<char, NI_MAXHOST> host{};
  std::array<char, NI_MAXSERV> port{};
  const auto* const address = reinterpret_cast<const sockaddr*>(&storage);  // NOLINT: as above
  const bool is_known = ::getnameinfo(address, bytes, host.data(), host.size(), port.data(),
                                      port.size(), NI_NUMERICHOST | NI_NUMERICSERV) == 0;
  return is_known ? std::string(host.data()) + ":" + port.data() : "the line";
}

UdpLine::UdpLine(const Connection& connection)
    : listens_(connection.kind == Connection::Kind::udp_listen), buffer_(kLongestDatagram) {
  addrinfo wanted{};
  wanted.ai_socktype = SOCK_DGRAM;
  wanted.ai_flags = listens_ ? AI_PASSIVE : 0;
  addrinfo* found = nullptr;
  const int error = ::getaddrinfo(connection.host.c_str(), std::to_string(connection.port).c_str(),
                                  &wanted, &found);
  if (error != 0) {
    throw InputError(connection.host + ": " + ::gai_strerror(error));
  }
  Address address;
  std::memcpy(&address.storage, found->ai_addr, found->ai_addrlen);
  address.bytes = found->ai_addrlen;
  socket_ = ::socket(found->ai_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  ::freeaddrinfo(found);
  if (socket_ < 0) {
    throw Failure("UDP: " + reason());
  }
  if (!listens_) {
    peer_ = address;
  } else if (::bind(socket_, as_address(address.storage), address.bytes) != 0) {
    const std::string why = reason();
    ::close(socket_);
    throw InputError("UDP port " + std::to_string(connection.port) + " of " + connection.host +
                     ": " + why);
  }
}

UdpLine::~UdpLine() {
  ::close(socket_);
}

std::span<const std::byte> UdpLine::read(std::chrono::milliseconds timeout) {
  pollfd ready{.fd = socket_, .events = POLLIN, .revents = 0};
  if (::poll(&ready, 1, static_cast<int>(timeout.count())) <= 0) {
    return {};
  }
  last_ = {.bytes = sizeof(last_.storage)};
  const ssize_t bytes = ::recvfrom(socket_, buffer_.data(), buffer_.size(), 0,
                                   as_address(last_.storage), &last_.bytes);
  return bytes > 0 ? std::span<const std::byte>(buffer_).first(static_cast<std::size_t>(bytes))
                   : std::span<const std::byte>();
}

void UdpLine::answer(const Address& to) {
  peer_ = listens_ ? to : peer_;
}

void UdpLine::write(std::span<const std::byte> bytes) {
  if (peer_.bytes > 0) {
    static_cast<void>(::sendto(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
                               as_address(peer_.storage), peer_.bytes));
  }
}

std::uint16_t UdpLine::port() const {
  Address own;
  own.bytes = sizeof(own.storage);
  ::getsockname(socket_, as_address(own.storage), &own.bytes);
  const bool is_ip6 = own.storage.ss_family == AF_INET6;
  return ntohs(is_ip6 ? reinterpret_cast<sockaddr_in6&>(own.storage).sin6_port  // NOLINT: the
                      : reinterpret_cast<sockaddr_in&>(own.storage).sin_port);  // NOLINT: same
}

bool is_baud_rate(unsigned bits_per_s) {
  return rate_of(bits_per_s) != kRates.end();
}

std::string baud_rates_text() {
  std::vector<std::string> texts;
  texts.reserve(kRates.size());
  for (const auto& [rate, code] : kRates) {
    texts.push_back(std::to_string(rate));
  }
  return join_text(texts, ", ");
}

SerialLine::SerialLine(const Connection& connection) : connection_(connection), buffer_(kBuffer) {
  if (const std::string why = open(); !why.empty()) {
    throw InputError(connection.device + ": " + why);
  }
}

std::string SerialLine::open() {
  tried_ = Clock::now();
  auto line =
      std::make_unique<file::Descriptor>(connection_.device, O_RDWR | O_NOCTTY | O_NONBLOCK);
  if (!line->is_open()) {
    const std::string why = reason();
    return errno == EACCES ? why + "; may you use serial lines (group dialout)?" : why;
  }
  if (!make_raw(line->number(), rate_of(connection_.baud)->second)) {
    return "is no serial line, or can't have " + std::to_string(connection_.baud) + " baud";
  }
  line_ = std::move(line);
  return {};
}

void SerialLine::lose() {
  line_.reset();
  tried_ = Clock::now();
}

std::span<const std::byte> SerialLine::read(std::chrono::milliseconds timeout) {
  if (!line_ && Clock::now() - tried_ >= kTuning.between_tries) {
    open();
  }
  if (!line_) {
    std::this_thread::sleep_for(timeout);
    return {};
  }
  pollfd ready{.fd = line_->number(), .events = POLLIN, .revents = 0};
  if (::poll(&ready, 1, static_cast<int>(timeout.count())) <= 0) {
    return {};
  }
  const ssize_t bytes = ::read(line_->number(), buffer_.data(), buffer_.size());
  if (bytes > 0) {
    return std::span<const std::byte>(buffer_).first(static_cast<std::size_t>(bytes));
  }
  if (bytes == 0 || (errno != EAGAIN && errno != EINTR)) {
    lose();
  }
  return {};
}

void SerialLine::write(std::span<const std::byte> bytes) {
  if (line_) {
    static_cast<void>(::write(line_->number(), bytes.data(), bytes.size()));
  }
}

std::string SerialLine::fault() const {
  return line_ ? "" : connection_.device + " is gone; it is opened again when it is back";
}

std::unique_ptr<ByteLine> open_line(const Connection& connection) {
  if (connection.kind == Connection::Kind::serial) {
    return std::make_unique<SerialLine>(connection);
  }
  return std::make_unique<UdpLine>(connection);
}

}  // namespace kelpie::autopilot
