// SPDX-License-Identifier: Apache-2.0
// Serves a lamp by TLS only, to clients whose certificates are of the same authority.
#include <signal.h>

#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <string_view>

#include "experimental/lamp.hpp"
#include "rr/node.hpp"

namespace {

constexpr const char* usage =
    "usage: encrypted_service CERTIFICATE AUTHORITY REVOKED\n"
    "Serves a lamp until it is interrupted. CERTIFICATE (nodes/ID.pem), AUTHORITY (ca.pem) and\n"
    "REVOKED (revoked.pem) are files that `robdef ca` makes.\n";

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 4) {
    std::fputs(usage, stderr);
    return 2;
  }
  // Blocked before the node starts its threads, so that only the wait below takes them.
  sigset_t stop;
  sigemptyset(&stop);
  sigaddset(&stop, SIGINT);
  sigaddset(&stop, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &stop, nullptr);

  rr::NodeOptions options;
  options.name = "lamp.host";
  options.tls = {.certificate_file = argv[1],
                 .authority_files = {argv[2]},
                 .revocation_files = {argv[3]},
                 .is_required = true,
                 .must_certify_clients = true};
  options.log = [](rr::LogLevel level, std::string_view text) {
    if (level >= rr::LogLevel::warning) std::cerr << "service: " << text << std::endl;
  };
  rr::Node node(options);
  const auto service =
      node.register_service("lamp", std::make_shared<experimental::lamp::LampDefault>());
  const int port = node.listen_tcp(0, "127.0.0.1");
  std::printf("ready: rrs+tcp://127.0.0.1:%d/?nodeid=%s&service=lamp\n", port,
              node.id().text().c_str());
  std::fflush(stdout);
  int signal = 0;
  sigwait(&stop, &signal);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "encrypted_service: %s\n", error.what());
  return 1;
}
