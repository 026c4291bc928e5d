#include "lab/server.h"

#include <fmt/format.h>
#include <httplib.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <map>

#include "core/error.h"
#include "core/files.h"
#include "lab/worker.h"

namespace carom {

namespace fs = std::filesystem;

namespace {

constexpr const char* kHost = "127.0.0.1";
constexpr int kThreads = 16;    // a browser keeps six connections open
constexpr int kBacklog = 64;    // connections that wait to be accepted
constexpr int kPatience_s = 5;  // for the bytes of a request, and for the next one on a connection
constexpr const char* kJson = "application/json";

// What ends with the program: set before the handler is.
volatile sig_atomic_t own_process = 0;
volatile sig_atomic_t http_process = 0;

extern "C" void end_lab(int /*signal*/) {
  // A job that was forked from here has this handler until it is done.
  if (getpid() == own_process && http_process > 0) kill(http_process, SIGKILL);
  _exit(0);
}

/// A scene's picture may be shown, a script of somebody else may not be run.
const httplib::Headers& security_headers() {
  static const httplib::Headers headers = {
      {"Content-Security-Policy",
       "default-src 'self'; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; object-src 'none'; "
       "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
      {"X-Content-Type-Options", "nosniff"},
      {"X-Frame-Options", "DENY"},
      {"Referrer-Policy", "no-referrer"},
      {"Cross-Origin-Opener-Policy", "same-origin"},
      {"Cross-Origin-Resource-Policy", "same-origin"},
      {"Cache-Control", "no-store"}};
  return headers;
}

const char* content_type(const fs::path& file) {
  static const std::map<std::string, const char*> types = {{".html", "text/html; charset=utf-8"},
                                                           {".js", "text/javascript; charset=utf-8"},
                                                           {".css", "text/css; charset=utf-8"},
                                                           {".json", "application/json"},
                                                           {".svg", "image/svg+xml"},
                                                           {".png", "image/png"},
                                                           {".ico", "image/vnd.microsoft.icon"},
                                                           {".woff2", "font/woff2"}};
  const auto found = types.find(file.extension().string());
  return found == types.end() ? "application/octet-stream" : found->second;
}

void give(const LabAnswer& answer, httplib::Response& response) {
  response.status = answer.status;
  response.set_content(answer.json, kJson);
}

/// The process that speaks HTTP.
class HttpServer {
 public:
  HttpServer(const LabSetup& setup, int port) : setup_(setup) {
    socket_t socket_to_listen = -1;
    server_.set_socket_options([&socket_to_listen](socket_t socket) {
      socket_to_listen = socket;
      // Not SO_REUSEPORT, with which two labs would share a port.
      const int yes = 1;
      setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    errno = 0;
    port_ = port == 0 ? server_.bind_to_any_port(kHost) : (server_.bind_to_port(kHost, port) ? port : -1);
    if (port_ < 0) {
      throw MachineError(
          fmt::format("port {} cannot be had: {}; allowed: another --port, or 0 for any that is free", port,
                      std::strerror(errno)));
    }
    // The library has the system keep five connections until they are accepted; those of a browser with a few
    // tabs that come at once would be reset.
    ::listen(socket_to_listen, kBacklog);
    server_.set_socket_options(nullptr);
    server_.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
    server_.set_payload_max_length(setup.limits.body_bytes);
    server_.set_read_timeout(kPatience_s);
    server_.set_write_timeout(kPatience_s);
    server_.set_keep_alive_timeout(kPatience_s);
    server_.set_default_headers(security_headers());
  }

  int port() const { return port_; }

  void serve(WorkerClient& worker) {
    server_.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      const std::string reason = refusal(request);
      if (reason.empty()) return httplib::Server::HandlerResponse::Unhandled;
      give(lab_error(403, reason), response);
      return httplib::Server::HandlerResponse::Handled;
    });
    for (const char* what : {"modes", "engines"}) {
      server_.Get(fmt::format("/api/{}", what), [&worker, what](const auto&, httplib::Response& response) {
        pass_on(worker, what, "", response);
      });
    }
    server_.Get("/api/scene", [&worker](const httplib::Request& request, httplib::Response& response) {
      std::string body = "{\"id\":";
      body += quoted(request.get_param_value("id"));
      pass_on(worker, "scene", body + "}", response);
    });
    for (const char* what : {"run", "toml", "law"}) {
      server_.Post(fmt::format("/api/{}", what),
                   [&worker, what](const httplib::Request& request, httplib::Response& response) {
                     if (!request.get_header_value("Content-Type").starts_with(kJson)) {
                       return give(lab_error(415, "allowed: Content-Type: application/json"), response);
                     }
                     pass_on(worker, what, request.body, response);
                   });
    }
    server_.Get("/.*", [this](const httplib::Request& request, httplib::Response& response) {
      give_file(request.path, response);
    });
    server_.set_error_handler([](const httplib::Request&, httplib::Response& response) {
      if (!response.body.empty()) return;
      const bool large = response.status == 413;
      give(lab_error(response.status,
                     large ? "the request is larger than the lab takes" : "there is nothing here"),
           response);
    });
    server_.listen_after_bind();
  }

 private:
  static std::string quoted(const std::string& text);

  static void pass_on(WorkerClient& worker, const char* what, const std::string& body,
                      httplib::Response& response) {
    const std::optional<LabAnswer> answer = worker.ask(what, body);
    if (!answer) {
      response.set_header("Retry-After", "2");
      return give(lab_error(503, "too many requests wait, try again in a moment"), response);
    }
    give(*answer, response);
  }

  /// Why a request is not this machine's own; empty where it is.
  std::string refusal(const httplib::Request& request) const {
    const std::string own[] = {fmt::format("127.0.0.1:{}", port_), fmt::format("localhost:{}", port_)};
    const auto is_own = [&](const std::string& host) { return host == own[0] || host == own[1]; };
    if (!is_own(request.get_header_value("Host"))) return "the lab answers to 127.0.0.1 and localhost alone";
    const std::string origin = request.get_header_value("Origin");
    if (!origin.empty() && !(origin.starts_with("http://") && is_own(origin.substr(7)))) {
      return "the lab answers to its own page alone";
    }
    return {};
  }

  void give_file(const std::string& path, httplib::Response& response) const {
    const std::string name = path == "/" ? "lab.html" : path.substr(1);
    for (const fs::directory_entry& entry : files_of_page()) {
      if (entry.path().filename() != name) continue;
      response.set_content(read_file(entry.path()), content_type(entry.path()));
      return;
    }
    if (path == "/") {
      response.set_content(
          "This build has no page for the lab: node and npm were missing. Its API is at /api/modes.\n",
          "text/plain; charset=utf-8");
      return;
    }
    response.status = 404;
  }

  /// Only these are served: a request's path is compared with their names, and never opened.
  std::vector<fs::directory_entry> files_of_page() const {
    std::vector<fs::directory_entry> files;
    if (!fs::is_directory(setup_.page)) return files;
    for (const fs::directory_entry& entry : fs::directory_iterator(setup_.page)) {
      if (entry.is_regular_file()) files.push_back(entry);
    }
    return files;
  }

  const LabSetup& setup_;
  httplib::Server server_;
  int port_ = -1;
};

std::string HttpServer::quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\' || code < 0x20U) {
      quoted += fmt::format("\\u{:04x}", code);
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

[[noreturn]] void speak_http(HttpServer& server, int socket, int other_end) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  close(other_end);
  try {
    WorkerClient worker(socket);
    server.serve(worker);
  } catch (const std::exception& error) {
    fmt::print(stderr, "carom: {}\n", error.what());
  }
  _exit(1);
}

void end_with_signals(pid_t http) {
  own_process = getpid();
  http_process = http;
  struct sigaction action {};
  action.sa_handler = end_lab;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

void serve_lab(const LabSetup& setup, int port, const std::function<void(int port)>& ready) {
  HttpServer server(setup, port);
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw MachineError(fmt::format("no socket: {}", std::strerror(errno)));
  }
  std::fflush(nullptr);  // what waits in a buffer is written once
  const pid_t http = fork();
  if (http < 0) throw MachineError(fmt::format("no process can be started: {}", std::strerror(errno)));
  if (http == 0) speak_http(server, ends[1], ends[0]);
  close(ends[1]);
  end_with_signals(http);
  ready(server.port());
  serve_requests(ends[0], setup);
  kill(http, SIGKILL);
  int status = 0;
  waitpid(http, &status, 0);
  throw MachineError("the lab's server has ended");
}

}  // namespace carom
