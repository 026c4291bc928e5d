#include "app/stop_request.h"

#include <array>
#include <csignal>
#include <cstdio>

namespace carom {

namespace {

constexpr std::array kAsking = {SIGINT, SIGTERM, SIGHUP};

volatile std::sig_atomic_t asked_by = 0;

extern "C" void take_note(int signal) {
  asked_by = signal;
}

}  // namespace

StopRequest::StopRequest() {
  asked_by = 0;
  for (const int signal : kAsking) {
    struct sigaction before {};
    sigaction(signal, nullptr, &before);
    if (before.sa_handler == SIG_IGN) continue;  // as nohup has it
    struct sigaction action {};
    action.sa_handler = take_note;
    action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
    sigaction(signal, &action, nullptr);
  }
}

StopRequest::~StopRequest() {
  for (const int signal : kAsking) {
    struct sigaction now {};
    sigaction(signal, nullptr, &now);
    if (now.sa_handler == take_note) std::signal(signal, SIG_DFL);
  }
}

bool StopRequest::made() const {
  return asked_by != 0;
}

void StopRequest::obey() const {
  if (!made()) return;
  std::fflush(stdout);
  std::signal(asked_by, SIG_DFL);
  std::raise(asked_by);
}

}  // namespace carom
