// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <spawn.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "cli/commands.h"
#include "cli/number_option.h"
#include "cli/program.h"
#include "format/packet.h"

#ifdef SAC_HAS_HTTPLIB
#include <httplib.h>
#endif

namespace sac {
namespace {

namespace fs = std::filesystem;

struct ViewOptions {
  std::string input;
  std::string page;
  std::uint32_t port = 0;
  bool no_browser = false;
};

#ifdef SAC_HAS_HTTPLIB

constexpr const char* kHost = "127.0.0.1";
// Where an installation has the page, and where scripts/web makes it for a build in build/PRESET.
constexpr const char* kPlaces[] = {"../share/sac/page/index.html", "../../web/demo/index.html"};

// A stream that is read in pieces, whatever becomes of its name.
class ServedStream {
 public:
  ServedStream() = default;
  ~ServedStream() {
    if (fd_ >= 0) close(fd_);
  }
  ServedStream(const ServedStream&) = delete;
  ServedStream& operator=(const ServedStream&) = delete;

  Status Open(const std::string& path) {
    fd_ = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat about {};
    if (fd_ < 0 || fstat(fd_, &about) != 0) return Status::IoError(path + ": cannot be read");
    if (!S_ISREG(about.st_mode)) return Status::IoError(path + ": no file, whose parts a page can ask for");
    size_ = static_cast<std::size_t>(about.st_size);
    // Before a browser is opened for it.
    std::uint8_t begin[sizeof(kMagic)];
    const ssize_t got = pread(fd_, begin, sizeof(begin), 0);
    const bool is_stream = got == sizeof(begin) && std::equal(std::begin(begin), std::end(begin), std::begin(kMagic));
    return is_stream ? Status::Ok() : Status::Corrupt(path + ": not a .sac stream");
  }
  std::size_t size() const { return size_; }
  // Gives `sink` some of the bytes from `offset` on, `length` at most.
  bool Give(std::size_t offset, std::size_t length, httplib::DataSink& sink) const {
    char piece[1 << 16];
    const ssize_t got = pread(fd_, piece, std::min(length, sizeof(piece)), static_cast<off_t>(offset));
    return got > 0 && sink.write(piece, static_cast<std::size_t>(got));
  }

 private:
  int fd_ = -1;
  std::size_t size_ = 0;
};

// The folder of the page.
Status FindPage(const std::string& given, fs::path& page) {
  std::error_code error;
  if (given.empty()) {
    page = FindBesideProgram(kPlaces).parent_path();
    return page.empty() ? Status::IoError("view: the page is not installed beside sac; scripts/web build makes it")
                        : Status::Ok();
  }
  page = given;
  return fs::is_regular_file(page / "index.html", error) ? Status::Ok()
                                                         : Status::IoError(given + ": has no index.html");
}

// A name as part of an address: RFC 3986, 2.1.
std::string Escaped(const std::string& name) {
  std::string out;
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) || std::strchr("-._~", c) != nullptr) {
      out += c;
    } else {
      char code[4];
      std::snprintf(code, sizeof(code), "%%%02X", static_cast<unsigned char>(c));
      out += code;
    }
  }
  return out;
}

// Opens `address` where the desktop opens such; without one there is the address to read.
void OpenBrowser(const std::string& address) {
#ifdef __APPLE__
  std::string program = "open";
#else
  std::string program = "xdg-open";
#endif
  std::string argument = address;
  char* words[] = {program.data(), argument.data(), nullptr};
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  for (const int fd : {STDOUT_FILENO, STDERR_FILENO}) {
    posix_spawn_file_actions_addopen(&quiet, fd, "/dev/null", O_WRONLY, 0);
  }
  pid_t child = 0;
  posix_spawnp(&child, words[0], &quiet, nullptr, words, environ);
  posix_spawn_file_actions_destroy(&quiet);
}

// A page of another site cannot reach the clip under a name of its own for this machine (DNS rebinding).
httplib::Server::HandlerResponse RefuseOtherHosts(const httplib::Request& request, httplib::Response& response) {
  const std::string host = request.get_header_value("Host");
  const std::string name = host.substr(0, host.find(':'));
  if (name == kHost || name == "localhost") return httplib::Server::HandlerResponse::Unhandled;
  response.status = 403;
  return httplib::Server::HandlerResponse::Handled;
}

Status Serve(const ViewOptions& options) {
  fs::path page;
  SAC_RETURN_IF_ERROR(FindPage(options.page, page));
  ServedStream stream;
  SAC_RETURN_IF_ERROR(stream.Open(options.input));

  httplib::Server server;
  server.set_pre_routing_handler(RefuseOtherHosts);
  // The default would share a port with whoever has it.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  });
  server.set_default_headers({{"Cache-Control", "no-store"}});
  server.set_file_extension_and_mimetype_mapping("wasm", "application/wasm");
  // The name is the page's title; any name is answered with the one stream.
  server.Get("/clip/.*", [&stream](const httplib::Request&, httplib::Response& response) {
    response.set_content_provider(stream.size(), "application/octet-stream",
                                  [&stream](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                                    return stream.Give(offset, length, sink);
                                  });
  });
  if (!server.set_mount_point("/", page.string())) return Status::IoError(page.string() + ": cannot be read");
  const int port =
      options.port == 0
          ? server.bind_to_any_port(kHost)
          : (server.bind_to_port(kHost, static_cast<int>(options.port)) ? static_cast<int>(options.port) : -1);
  if (port < 0) return Status::IoError("view: port " + std::to_string(options.port) + " is taken or not allowed");

  const std::string name = fs::path(options.input).filename().string();
  const std::string address = std::string("http://") + kHost + ":" + std::to_string(port) + "/?clip=clip/" +
                              Escaped(Escaped(name));  // in a path, within a query
  std::printf("%s is shown at %s until this command is ended with Ctrl-C\n", options.input.c_str(), address.c_str());
  std::fflush(stdout);
  if (!options.no_browser) OpenBrowser(address);
  return server.listen_after_bind() ? Status::Ok() : Status::IoError("view: the server has ended");
}

#else

Status Serve(const ViewOptions&) {
  return Status::Unsupported("view: this build has no server; it takes Debian's libcpp-httplib-dev and libssl-dev");
}

#endif

}  // namespace

Command AddViewCommand(CLI::App& app) {
  auto options = std::make_shared<ViewOptions>();
  CLI::App* command = app.add_subcommand("view", "Show a stream in the browser.");
  command->add_option("STREAM", options->input, "the stream to show")->required()->option_text(" ");
  AddNumber(*command, "--port", options->port, 0u, 65535u, "of the page's address; 0 for any that is free [0]");
  command->add_flag("--no-browser", options->no_browser, "print the address only");
  command->add_option("--page", options->page, "a folder with another page that plays streams [the one installed]")
      ->option_text("DIR");
  command->footer(
      "The page is served to this machine alone, until the command is ended with Ctrl-C. Other files can be dropped "
      "on\n"
      "it; they go nowhere.\n\n"
      "Examples:\n"
      "  sac view walk.sac\n"
      "  sac view walk.sac --no-browser --port 8080    # then, from elsewhere: ssh -L 8080:localhost:8080 host\n");
  return {command, [] { return Status::Ok(); }, [options] { return Serve(*options); }};
}

}  // namespace sac
