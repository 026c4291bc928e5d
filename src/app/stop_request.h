#pragma once

namespace carom {

/// While one of these lives, Ctrl-C and what else asks a program to end (SIGINT, SIGTERM, SIGHUP) is taken
/// note of, so that a long command stops after the run under way and writes what there is. A second of the
/// same ends the program at once.
/// @pre there is one at a time
class StopRequest {
 public:
  StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;
  ~StopRequest();

  bool made() const;

  /// Ends the program by the signal that came, as whoever sent it expects; does nothing where none did.
  void obey() const;
};

}  // namespace carom
