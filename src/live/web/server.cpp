// SPDX-License-Identifier: Apache-2.0
#include "web/server.hpp"

#include <fmt/format.h>
#include <microhttpd.h>
#include <poll.h>
#include <pthread.h>
#include <sys/resource.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <chrono>
#include <csignal>
#include <exception>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "kelpie/core/error.hpp"
#include "web/events.hpp"
#include "web/listener.hpp"
#include "web/metrics.hpp"
#include "web/paced_stream.hpp"

namespace kelpie::web {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kText = "text/plain; charset=utf-8";
constexpr const char* kHtml = "text/html; charset=utf-8";
constexpr const char* kMetrics = "text/plain; version=0.0.4; charset=utf-8";
constexpr std::array<std::pair<const char*, const char*>, 6> kHeaders{
    {{MHD_HTTP_HEADER_CONNECTION, "close"},
     {"X-Content-Type-Options", "nosniff"},
     {"Referrer-Policy", "no-referrer"},
     {"Cross-Origin-Resource-Policy", "same-origin"},
     {"Content-Security-Policy", "frame-ancestors 'none'"},
     {MHD_HTTP_HEADER_CACHE_CONTROL, "no-store"}}};

// Blocks all signals of new threads: the main thread handles signals.
class NoSignals {
 public:
  NoSignals() {
    sigset_t all;
    sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~NoSignals() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  NoSignals(const NoSignals&) = delete;
  NoSignals& operator=(const NoSignals&) = delete;

 private:
  sigset_t before_{};
};

// An answer before the library has it.
struct Answer {
  unsigned status = MHD_HTTP_OK;
  std::string text{};
  std::vector<std::pair<const char*, std::string>> headers{};
};

Answer refusal(unsigned status, const std::string& why) {
  return {.status = status, .text = why + "\n"};
}

std::string value_of(MHD_Connection* connection, MHD_ValueKind kind, const char* name) {
  const char* const value = ::MHD_lookup_connection_value(connection, kind, name);
  return value == nullptr ? "" : value;
}

std::string header(MHD_Connection* connection, const char* name) {
  return value_of(connection, MHD_HEADER_KIND, name);
}

bool is_look(std::string_view method) {
  return method == MHD_HTTP_METHOD_GET || method == MHD_HTTP_METHOD_HEAD;
}

// By the head alone, before a byte of the body is read.
std::optional<Answer> body_refusal(MHD_Connection* connection) {
  const std::string coding = header(connection, MHD_HTTP_HEADER_CONTENT_ENCODING);
  if (!coding.empty() && coding != "identity") {
    return refusal(MHD_HTTP_UNSUPPORTED_MEDIA_TYPE, "Coded bodies are refused.");
  }
  if (!header(connection, MHD_HTTP_HEADER_TRANSFER_ENCODING).empty()) {
    return refusal(MHD_HTTP_LENGTH_REQUIRED, "Bodies without a length are refused.");
  }
  const std::string length = header(connection, MHD_HTTP_HEADER_CONTENT_LENGTH);
  std::size_t bytes = 0;
  const auto [end, error] = std::from_chars(length.data(), length.data() + length.size(), bytes);
  const bool is_number = error == std::errc{} && end == length.data() + length.size();
  if (!length.empty() && (!is_number || bytes > kTuning.body_bytes)) {
    return refusal(MHD_HTTP_CONTENT_TOO_LARGE, "The body is too long.");
  }
  return std::nullopt;
}

}  // namespace

// The library calls all private functions in the page's thread.
class Server::Http {
 public:
  Http(const live::Endpoint& endpoint, const std::string& field, Parts parts);
  ~Http();
  Http(const Http&) = delete;
  Http& operator=(const Http&) = delete;

 private:
  struct Guest {
    int socket = -1;
    Clock::time_point came = Clock::now();
    std::unique_ptr<PacedStream> stream{};  // of a reader of /events
    bool is_dismissed = false;
  };

  static MHD_Result on_request(void* self, MHD_Connection* connection, const char* path,
                               const char* method, const char* version, const char* body,
                               std::size_t* body_bytes, void** state);
  static void on_connection(void* self, MHD_Connection* connection, void** guest,
                            MHD_ConnectionNotificationCode what);

  void run();
  void tick();
  static void dismiss(Guest& guest);
  void greet(MHD_Connection* connection, void** guest);
  std::optional<Answer> refused(MHD_Connection* connection, std::string_view path,
                                std::string_view method) const;
  MHD_Result answer(MHD_Connection* connection, std::string_view path, std::string_view method);
  MHD_Result stream(MHD_Connection* connection);
  Answer press(std::string_view path) const;
  const std::string& metrics();

  Parts parts_;
  std::list<Guest> guests_;                     // by the time of arrival
  std::shared_ptr<const live::Health> health_;  // that metrics_ shows
  std::string metrics_;
  std::atomic<bool> stops_{false};
  MHD_Daemon* daemon_ = nullptr;
  std::thread thread_;
};

namespace {

MHD_Result send(MHD_Connection* connection, unsigned status, MHD_Response* response,
                const char* type) {
  for (const auto& [name, value] : kHeaders) {
    ::MHD_add_response_header(response, name, value);
  }
  ::MHD_add_response_header(response, MHD_HTTP_HEADER_CONTENT_TYPE, type);
  const MHD_Result result = ::MHD_queue_response(connection, status, response);
  ::MHD_destroy_response(response);
  return result;
}

MHD_Result send(MHD_Connection* connection, Answer answer, const char* type = kText) {
  MHD_Response* const response = ::MHD_create_response_from_buffer(
      answer.text.size(), answer.text.data(), MHD_RESPMEM_MUST_COPY);
  for (const auto& [name, value] : answer.headers) {
    ::MHD_add_response_header(response, name, value.c_str());
  }
  return send(connection, answer.status, response, type);
}

}  // namespace

Server::Http::Http(const live::Endpoint& endpoint, const std::string& field, Parts parts)
    : parts_(std::move(parts)) {
  const int listener = listen_at(endpoint, field);
  daemon_ = ::MHD_start_daemon(  // NOLINT: the library's way of options
      MHD_USE_EPOLL | MHD_ALLOW_SUSPEND_RESUME, 0, nullptr, nullptr, &on_request, this,
      MHD_OPTION_LISTEN_SOCKET, listener, MHD_OPTION_CONNECTION_LIMIT,
      static_cast<unsigned>(kTuning.streams + kTuning.guests + kTuning.leaving),
      MHD_OPTION_CONNECTION_MEMORY_LIMIT, kTuning.connection_bytes, MHD_OPTION_CONNECTION_TIMEOUT,
      static_cast<unsigned>(kTuning.longest_request.count()), MHD_OPTION_NOTIFY_CONNECTION,
      &on_connection, this, MHD_OPTION_END);
  if (daemon_ == nullptr) {
    throw Failure("the page's server cannot start");
  }
  const NoSignals guard;
  thread_ = std::thread([this] { run(); });
}

Server::Http::~Http() {
  stops_ = true;
  thread_.join();
  const auto begin = Clock::now();
  const auto is_sent = [](const Guest& one) { return !one.stream || one.stream->has_sent_all(); };
  do {  // MHD_stop_daemon requires resumed connections
    for (const Guest& guest : guests_) {
      if (guest.stream) {
        guest.stream->end();
      }
    }
    ::MHD_run_wait(daemon_, static_cast<int>(kTuning.between_events.count()));
  } while (!std::ranges::all_of(guests_, is_sent) && Clock::now() - begin < kTuning.farewell);
  ::MHD_run(daemon_);
  ::MHD_stop_daemon(daemon_);
}

void Server::Http::run() {
  ::setpriority(PRIO_PROCESS, 0, ::getpriority(PRIO_PROCESS, 0) + kTuning.niceness);
  const MHD_DaemonInfo* const info = ::MHD_get_daemon_info(daemon_, MHD_DAEMON_INFO_EPOLL_FD);
  pollfd events{.fd = info->epoll_fd, .events = POLLIN, .revents = 0};
  for (Clock::time_point ticked; !stops_;) {
    MHD_UNSIGNED_LONG_LONG due_ms = 0;
    const bool is_due = ::MHD_get_timeout(daemon_, &due_ms) == MHD_YES && due_ms == 0;
    ::poll(&events, 1, is_due ? 0 : static_cast<int>(kTuning.between_events.count()));
    ::MHD_run(daemon_);
    if (Clock::now() - ticked >= kTuning.between_events) {
      ticked = Clock::now();
      tick();
    }
  }
}

void Server::Http::tick() {
  for (Guest& guest : guests_) {
    if (guest.stream) {
      guest.stream->resume();
    } else if (Clock::now() - guest.came > kTuning.longest_request) {
      dismiss(guest);
    }
  }
}

// The library meets the end of the connection and closes the socket.
void Server::Http::dismiss(Guest& guest) {
  guest.is_dismissed = true;
  ::shutdown(guest.socket, SHUT_RDWR);
}

void Server::Http::on_connection(void* self, MHD_Connection* connection, void** guest,
                                 MHD_ConnectionNotificationCode what) {
  auto& http = *static_cast<Http*>(self);
  if (what == MHD_CONNECTION_NOTIFY_STARTED) {
    http.greet(connection, guest);
  } else {
    http.guests_.remove_if([&](const Guest& one) { return &one == *guest; });
  }
}

void Server::Http::greet(MHD_Connection* connection, void** guest) {
  const auto may_go = [](const Guest& one) { return !one.stream && !one.is_dismissed; };
  if (static_cast<std::size_t>(std::ranges::count_if(guests_, may_go)) >= kTuning.guests) {
    dismiss(*std::ranges::find_if(guests_, may_go));
  }
  const auto* const info = ::MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
  *guest = &guests_.emplace_back(Guest{.socket = info->connect_fd});
}

MHD_Result Server::Http::on_request(void* self, MHD_Connection* connection, const char* path,
                                    const char* method, const char* /*version*/,
                                    const char* /*body*/, std::size_t* body_bytes, void** state) {
  auto& http = *static_cast<Http*>(self);
  const bool is_head = std::exchange(*state, self) == nullptr;
  if (!is_head && *body_bytes > 0) {
    *body_bytes = 0;
    return MHD_YES;
  }
  try {
    if (!is_head) {
      return http.answer(connection, path, method);
    }
    std::optional<Answer> refused = http.refused(connection, path, method);
    return refused ? send(connection, std::move(*refused)) : MHD_YES;
  } catch (const std::exception&) {  // none may pass through the library; memory is short
    return MHD_NO;                   // closes the connection
  }
}

std::optional<Answer> Server::Http::refused(MHD_Connection* connection, std::string_view path,
                                            std::string_view method) const {
  switch (
      parts_.access.decide({.changes_state = !is_look(method),
                            .host = header(connection, MHD_HTTP_HEADER_HOST),
                            .origin = header(connection, MHD_HTTP_HEADER_ORIGIN),
                            .site = header(connection, "Sec-Fetch-Site"),
                            .token = value_of(connection, MHD_GET_ARGUMENT_KIND, "token"),
                            .cookie = header(connection, MHD_HTTP_HEADER_COOKIE),
                            .authorization = header(connection, MHD_HTTP_HEADER_AUTHORIZATION)})) {
    case AccessDecision::unknown_host:
      return refusal(MHD_HTTP_FORBIDDEN, "Unknown host name: use localhost.");
    case AccessDecision::foreign_page:
      return refusal(MHD_HTTP_FORBIDDEN, "Buttons of other pages are refused.");
    case AccessDecision::no_token:
      return refusal(MHD_HTTP_UNAUTHORIZED,
                     "The token is missing: kelpie prints the whole address at its start.");
    case AccessDecision::granted_by_query:
      if (path == "/") {  // a redirection keeps the token out of the address bar
        return Answer{.status = MHD_HTTP_SEE_OTHER,
                      .headers = {{MHD_HTTP_HEADER_SET_COOKIE, parts_.access.cookie()},
                                  {MHD_HTTP_HEADER_LOCATION, "/"}}};
      }
      break;
    case AccessDecision::granted:
      break;
  }
  return body_refusal(connection);
}

MHD_Result Server::Http::answer(MHD_Connection* connection, std::string_view path,
                                std::string_view method) {
  if (method == MHD_HTTP_METHOD_POST) {
    return send(connection, press(path));
  }
  if (is_look(method) && path == "/events") {
    return stream(connection);
  }
  if (is_look(method) && path == "/metrics") {
    return send(connection, {.text = metrics()}, kMetrics);
  }
  if (is_look(method) && path == "/") {
    return send(connection, MHD_HTTP_OK,
                ::MHD_create_response_from_buffer(parts_.page.size(), parts_.page.data(),
                                                  MHD_RESPMEM_PERSISTENT),
                kHtml);
  }
  return send(connection, refusal(MHD_HTTP_NOT_FOUND, "There is no such page."));
}

MHD_Result Server::Http::stream(MHD_Connection* connection) {
  const auto is_stream = [](const Guest& one) { return one.stream != nullptr; };
  if (static_cast<std::size_t>(std::ranges::count_if(guests_, is_stream)) >= kStreams) {
    return send(connection, {.status = MHD_HTTP_SERVICE_UNAVAILABLE,
                             .text = "Too many readers.\n",
                             .headers = {{MHD_HTTP_HEADER_RETRY_AFTER, "5"}}});
  }
  auto& guest = *static_cast<Guest*>(
      ::MHD_get_connection_info(connection, MHD_CONNECTION_INFO_SOCKET_CONTEXT)->socket_context);
  guest.stream =
      std::make_unique<PacedStream>(EventStream(parts_.configuration, parts_.feed), connection);
  const auto read = [](void* stream, std::uint64_t /*at*/, char* to, std::size_t most) {
    try {
      return static_cast<PacedStream*>(stream)->read(to, most);
    } catch (const std::exception&) {
      return static_cast<ssize_t>(MHD_CONTENT_READER_END_WITH_ERROR);
    }
  };
  return send(connection, MHD_HTTP_OK,
              ::MHD_create_response_from_callback(MHD_SIZE_UNKNOWN, kTuning.stream_bytes, read,
                                                  guest.stream.get(), nullptr),
              "text/event-stream");
}

const std::string& Server::Http::metrics() {
  if (std::shared_ptr<const live::Health> health = parts_.feed.health(); health != health_) {
    health_ = std::move(health);
    metrics_ = metrics_text(*health_);
  }
  return metrics_;
}

Answer Server::Http::press(std::string_view path) const {
  for (const live::Request request :
       {live::Request::save, live::Request::freeze, live::Request::resume, live::Request::reset}) {
    if (path == "/" + std::string(live::request_name(request))) {
      parts_.requests.push(request);
      return {.status = MHD_HTTP_ACCEPTED, .text = "asked for\n"};
    }
  }
  return refusal(MHD_HTTP_NOT_FOUND, "There is no such button.");
}

Server::Server(const live::Endpoint& endpoint, const std::string& field, Parts parts)
    : http_(std::make_unique<Http>(endpoint, field, std::move(parts))) {}

Server::~Server() = default;

}  // namespace kelpie::web
