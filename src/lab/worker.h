#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "lab/requests.h"

namespace carom {

// The lab is two processes. One speaks HTTP with many threads; the other has a single thread, as it must have
// to start processes from (trajectory/isolate.h), and does the work, one request at a time. A socket connects
// them.

/// The end of the socket at which requests are made. Threads may share it.
class WorkerClient {
 public:
  explicit WorkerClient(int socket) : socket_(socket) {}

  /// Waits for the answer; nothing where more requests wait already than people would send at a time, or the
  /// worker is no more.
  std::optional<LabAnswer> ask(std::string_view what, const std::string& body);

 private:
  static constexpr int kMostWaiting = 8;

  int socket_;
  std::mutex one_at_a_time_;
  std::atomic<int> waiting_ = 0;
};

/// Does what comes through the socket until its other end is closed; each request in a process of its own,
/// within the limits of the setup.
void serve_requests(int socket, const LabSetup& setup);

}  // namespace carom
