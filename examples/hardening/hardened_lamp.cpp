// SPDX-License-Identifier: Apache-2.0
// Serves a lamp by TLS only, to clients with certificates, and to users by their rights, with an
// audit log. What it reads is in one folder, and may be replaced while it runs, but for the users.
#include <signal.h>

#include <cstdint>
#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>

#include "experimental/lamp.hpp"
#include "rr/audit.hpp"
#include "rr/node.hpp"
#include "rr/users.hpp"

namespace {

constexpr const char* usage =
    "usage: hardened_lamp FOLDER AUDIT ADDRESS PORT\n"
    "Serves a lamp until it is interrupted. FOLDER has node.cert.pem, node.key, ca.pem,\n"
    "revoked.pem, users and rights. AUDIT is the file for the audit log.\n";

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 5) {
    std::fputs(usage, stderr);
    return 2;
  }
  // Blocked before the node starts its threads, so that only the wait below takes them.
  sigset_t stop;
  sigemptyset(&stop);
  sigaddset(&stop, SIGINT);
  sigaddset(&stop, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &stop, nullptr);

  const std::string folder = argv[1];
  rr::NodeOptions options;
  options.name = "lamp.host";
  options.tls = {.certificate_file = folder + "/node.cert.pem",
                 .key_file = folder + "/node.key",
                 .authority_files = {folder + "/ca.pem"},
                 .revocation_files = {folder + "/revoked.pem"},
                 .is_required = true,
                 .must_certify_clients = true};
  options.audit.on_event = rr::AuditLog(argv[2]);
  options.log = [](rr::LogLevel level, std::string_view text) {
    if (level >= rr::LogLevel::warning) std::cerr << text << std::endl;
  };
  rr::Node node(options);
  const auto service =
      node.register_service("lamp", std::make_shared<experimental::lamp::LampDefault>(),
                            {.users = rr::PasswordUsers::from_file(folder + "/users"),
                             .rights_file = folder + "/rights"});
  const int port = node.listen_tcp(static_cast<std::uint16_t>(std::stoul(argv[4])), argv[3]);
  std::printf("ready: rrs+tcp://%s:%d/?nodeid=%s&service=lamp\n", argv[3], port,
              node.id().text().c_str());
  std::fflush(stdout);
  int signal = 0;
  sigwait(&stop, &signal);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "hardened_lamp: %s\n", error.what());
  return 1;
}
