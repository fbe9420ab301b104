// SPDX-License-Identifier: Apache-2.0
#include "web/server.hpp"

#include <fmt/format.h>
#include <httplib.h>
#include <poll.h>
#include <pthread.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <functional>
#include <semaphore>
#include <system_error>
#include <thread>
#include <utility>

#include "kelpie/core/error.hpp"
#include "web/events.hpp"
#include "web/metrics.hpp"

namespace kelpie::web {
namespace {

constexpr std::size_t kWorkers = kTuning.streams + kTuning.others;
constexpr const char* kText = "text/plain; charset=utf-8";
constexpr const char* kHtml = "text/html; charset=utf-8";

// A connection for cpp-httplib with limits on a request's size and duration (Tuning). The
// destructor closes the socket.
class Connection final : public httplib::Stream {
 public:
  // Gives up soon after `stops` becomes true.
  Connection(int socket, const std::atomic<bool>& stops) : socket_(socket), stops_(stops) {}
  ~Connection() override;
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  bool is_readable() const override { return true; }
  bool is_writable() const override { return !stops_; }
  ssize_t read(char* to, std::size_t size) override;
  ssize_t write(const char* from, std::size_t size) override;
  void get_remote_ip_and_port(std::string& /*ip*/, int& /*port*/) const override {}
  void get_local_ip_and_port(std::string& /*ip*/, int& /*port*/) const override {}
  socket_t socket() const override { return socket_; }

 private:
  using Clock = std::chrono::steady_clock;

  bool wait_for(short events, Clock::time_point until) const;  // NOLINT: poll()'s type

  int socket_;
  const std::atomic<bool>& stops_;
  Clock::time_point came_ = Clock::now();
  std::size_t read_ = 0;
};

Connection::~Connection() {
  ::shutdown(socket_, SHUT_RDWR);
  ::close(socket_);
}

ssize_t Connection::read(char* to, std::size_t size) {
  const std::size_t most = std::min(size, kTuning.request_bytes - read_);
  if (most == 0 || !wait_for(POLLIN, came_ + kTuning.longest_request)) {
    return -1;
  }
  const ssize_t count = ::recv(socket_, to, most, MSG_DONTWAIT);
  read_ += count > 0 ? static_cast<std::size_t>(count) : 0;
  return count;
}

ssize_t Connection::write(const char* from, std::size_t size) {
  return wait_for(POLLOUT, Clock::now() + kTuning.longest_write)
             ? ::send(socket_, from, size, MSG_DONTWAIT | MSG_NOSIGNAL)
             : -1;
}

bool Connection::wait_for(short events, Clock::time_point until) const {  // NOLINT
  while (!stops_ && Clock::now() < until) {
    pollfd one{.fd = socket_, .events = events, .revents = 0};
    const int ready = ::poll(&one, 1, static_cast<int>(kTuning.stop_check.count()));
    if (ready != 0) {
      return ready > 0;
    }
  }
  return false;
}

// Accepts no connection while all workers are busy: a flood must not use up the file descriptors.
class Workers final : public httplib::TaskQueue {
 public:
  void enqueue(std::function<void()> task) override {
    free_.acquire();
    pool_.enqueue([this, task = std::move(task)] {
      task();
      free_.release();
    });
  }
  void shutdown() override { pool_.shutdown(); }

 private:
  std::counting_semaphore<> free_{kWorkers};
  httplib::ThreadPool pool_{kWorkers};
};

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

void refuse(httplib::Response& response, int status, const std::string& why) {
  response.status = status;
  response.set_content(why + "\n", kText);
}

AccessRequest access_request(const httplib::Request& request) {
  return {.changes_state = request.method != "GET" && request.method != "HEAD",
          .host = request.get_header_value("Host"),
          .origin = request.get_header_value("Origin"),
          .token = request.get_param_value("token"),
          .cookie = request.get_header_value("Cookie"),
          .authorization = request.get_header_value("Authorization")};
}

}  // namespace

class Server::Http final : public httplib::Server {
 public:
  Http(const live::Endpoint& endpoint, const std::string& field, Parts parts)
      : parts_(std::move(parts)) {
    new_task_queue = [] { return new Workers; };  // NOLINT: the library owns the queue
    // Another program on the same port, as SO_REUSEPORT allows, would take every second request.
    set_socket_options([](socket_t socket) {
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
    });
    set_default_headers({{"X-Content-Type-Options", "nosniff"},
                         {"Referrer-Policy", "no-referrer"},
                         {"Cross-Origin-Resource-Policy", "same-origin"},
                         {"Content-Security-Policy", "frame-ancestors 'none'"},
                         {"Cache-Control", "no-store"}});
    set_payload_max_length(kTuning.request_bytes);
    set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      return admit(request, response);
    });
    add_routes();
    errno = 0;
    if (!bind_to_port(endpoint.host, endpoint.port)) {
      throw InputError(field, fmt::format("cannot listen on {}:{}: {}", endpoint.host,
                                          endpoint.port, std::generic_category().message(errno)));
    }
    const NoSignals guard;
    listening_ = std::thread([this] { listen_after_bind(); });
    while (!is_running()) {  // stop() does nothing before
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  ~Http() override {
    stops_ = true;
    stop();
    listening_.join();
  }
  Http(const Http&) = delete;
  Http& operator=(const Http&) = delete;

 private:
  bool process_and_close_socket(socket_t socket) override {
    Connection connection(socket, stops_);
    bool is_closed = false;
    return process_request(connection, true, is_closed, [](httplib::Request& request) {
      request.headers.erase("Accept-Encoding");  // compression would cost the learner CPU time
    });
  }

  HandlerResponse admit(const httplib::Request& request, httplib::Response& response) {
    switch (parts_.access.decide(access_request(request))) {
      case AccessDecision::granted:
        return HandlerResponse::Unhandled;
      case AccessDecision::granted_by_query:
        response.set_header("Set-Cookie", parts_.access.cookie());
        if (request.path != "/") {
          return HandlerResponse::Unhandled;
        }
        response.set_redirect("/", 303);  // keeps the token out of the address bar
        break;
      case AccessDecision::unknown_host:
        refuse(response, 403, "Unknown host name: use localhost.");
        break;
      case AccessDecision::foreign_page:
        refuse(response, 403, "Buttons of other pages are refused.");
        break;
      case AccessDecision::no_token:
        refuse(response, 401,
               "The token is missing: kelpie prints the whole address at its start.");
        break;
    }
    return HandlerResponse::Handled;
  }

  void add_routes() {
    Get("/", [this](const httplib::Request&, httplib::Response& response) {
      response.set_content(parts_.page, kHtml);
    });
    Get("/metrics", [this](const httplib::Request&, httplib::Response& response) {
      const std::shared_ptr<const live::Health> health = parts_.feed.health();
      response.set_content(health ? metrics_text(*health) : "",
                           "text/plain; version=0.0.4; charset=utf-8");
    });
    Get("/events",
        [this](const httplib::Request&, httplib::Response& response) { stream(response); });
    for (const live::Request request : {live::Request::save, live::Request::freeze,
                                        live::Request::resume, live::Request::reset}) {
      Post("/" + std::string(live::request_name(request)),
           [this, request](const httplib::Request&, httplib::Response& response) {
             parts_.requests.push(request);
             response.status = 202;
             response.set_content("asked for\n", kText);
           });
    }
  }

  void stream(httplib::Response& response) {
    if (readers_.fetch_add(1) >= kStreams) {
      --readers_;
      response.set_header("Retry-After", "5");
      refuse(response, 503, "Too many readers.");
      return;
    }
    auto events = std::make_shared<EventStream>(parts_.configuration, parts_.feed);
    response.set_chunked_content_provider(
        "text/event-stream",
        [this, events](std::size_t, httplib::DataSink& sink) {
          const std::string text = events->next();
          if (stops_ || (!text.empty() && !sink.write(text.data(), text.size()))) {
            return false;
          }
          std::this_thread::sleep_for(kTuning.between_events);
          return true;
        },
        [this](bool) { --readers_; });
  }

  Parts parts_;
  std::atomic<bool> stops_{false};
  std::atomic<std::size_t> readers_{0};
  std::thread listening_;
};

Server::Server(const live::Endpoint& endpoint, const std::string& field, Parts parts)
    : http_(std::make_unique<Http>(endpoint, field, std::move(parts))) {}

Server::~Server() = default;

}  // namespace kelpie::web
