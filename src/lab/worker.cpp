#include "lab/worker.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>

#include "trajectory/isolate.h"

namespace carom {

namespace {

bool send_all(int socket, const char* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t sent = send(socket, bytes, count, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    bytes += sent;
    count -= static_cast<std::size_t>(sent);
  }
  return true;
}

bool receive_all(int socket, char* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t got = recv(socket, bytes, count, 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    bytes += got;
    count -= static_cast<std::size_t>(got);
  }
  return true;
}

/// A text with its length before it.
bool send_text(int socket, std::string_view text) {
  const std::uint64_t length = text.size();
  std::array<char, sizeof length> header{};
  std::memcpy(header.data(), &length, sizeof length);
  return send_all(socket, header.data(), header.size()) && send_all(socket, text.data(), text.size());
}

std::optional<std::string> receive_text(int socket) {
  std::uint64_t length = 0;
  std::array<char, sizeof length> header{};
  if (!receive_all(socket, header.data(), header.size())) return std::nullopt;
  std::memcpy(&length, header.data(), sizeof length);
  std::string text(length, '\0');
  if (!receive_all(socket, text.data(), text.size())) return std::nullopt;
  return text;
}

/// Counts while it lives.
class Waiting {
 public:
  explicit Waiting(std::atomic<int>& count) : count_(count), rank_(++count) {}
  Waiting(const Waiting&) = delete;
  Waiting& operator=(const Waiting&) = delete;
  ~Waiting() { --count_; }
  int rank() const { return rank_; }

 private:
  std::atomic<int>& count_;
  int rank_;
};

/// One answer as a text: the status, a space, the JSON.
std::string text_of(const LabAnswer& answer) {
  return fmt::format("{} {}", answer.status, answer.json);
}

LabAnswer answer_from(const std::string& text) {
  LabAnswer answer;
  const char* end = text.data() + text.size();
  const char* space = std::from_chars(text.data(), end, answer.status).ptr;
  answer.json.assign(space == end ? end : space + 1, end);
  return answer;
}

LabAnswer answer_in_a_process(const LabSetup& setup, const std::string& what, const std::string& body) {
  const ProcessLimits limits{setup.limits.request_seconds,
                             setup.limits.memory_mib * static_cast<double>(setup.limits.engines)};
  const ProcessOutcome outcome =
      run_isolated({[&] { return text_of(answer_lab(setup, what, body)); }}, limits, 1).front();
  if (outcome.end == ProcessEnd::finished) return answer_from(outcome.payload);
  return lab_error(outcome.end == ProcessEnd::timed_out ? 400 : 500, outcome.reason);
}

}  // namespace

std::optional<LabAnswer> WorkerClient::ask(std::string_view what, const std::string& body) {
  const Waiting waiting(waiting_);
  if (waiting.rank() > kMostWaiting) return std::nullopt;
  const std::lock_guard lock(one_at_a_time_);
  if (!send_text(socket_, what) || !send_text(socket_, body)) return std::nullopt;
  const std::optional<std::string> text = receive_text(socket_);
  return text ? std::optional(answer_from(*text)) : std::nullopt;
}

void serve_requests(int socket, const LabSetup& setup) {
  while (true) {
    const std::optional<std::string> what = receive_text(socket);
    if (!what) return;
    const std::optional<std::string> body = receive_text(socket);
    if (!body) return;
    if (!send_text(socket, text_of(answer_in_a_process(setup, *what, *body)))) return;
  }
}

}  // namespace carom
