#pragma once

#include <functional>

#include "lab/requests.h"

namespace carom {

/// Serves the lab's page and its API (requests.h) on the loopback interface, to this machine alone, until the
/// process gets SIGINT or SIGTERM, which end it with code 0.
///
///   GET  /api/modes, /api/engines, /api/scene?id=…
///   POST /api/run, /api/toml, /api/law      with Content-Type: application/json
///   GET  /…                                 a file of the page's folder, by its name alone
///
/// Other sites cannot use it through a person's browser: requests must name this host (which a name that was
/// pointed here does not), those of other origins are refused, and a POST needs a content type that a browser
/// asks for leave to send.
///
/// @param port   0: any that is free
/// @param ready  told the port once connections are taken
/// @throws MachineError where the port cannot be had, or the server ends by itself
void serve_lab(const LabSetup& setup, int port, const std::function<void(int port)>& ready);

}  // namespace carom
