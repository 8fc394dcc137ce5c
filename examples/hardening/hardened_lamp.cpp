// SPDX-License-Identifier: Apache-2.0
// Serves a lamp by TLS only, to clients with certificates, and to users by their rights, with an
// audit log. What it reads is in one folder, and may be replaced while it runs, but for the users.
// It tells systemd when it is ready, and that it is alive.
#include <cstdint>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>

#include "experimental/lamp.hpp"
#include "rr/audit.hpp"
#include "rr/setup.hpp"
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
  const std::string folder = argv[1];
  rr::SetupOptions options;
  // It listens below, at the address that it is given, and by nothing else.
  options.discovery_listening_enable = options.local_enable = options.intra_enable = false;
  options.node.name = "lamp.host";
  options.node.tls = {.certificate_file = folder + "/node.cert.pem",
                      .key_file = folder + "/node.key",
                      .authority_files = {folder + "/ca.pem"},
                      .revocation_files = {folder + "/revoked.pem"},
                      .is_required = true,
                      .must_certify_clients = true};
  options.node.audit.on_event = rr::AuditLog(argv[2]);
  rr::NodeSetup node(options);
  const auto service =
      node->register_service("lamp", std::make_shared<experimental::lamp::LampDefault>(),
                             {.users = rr::PasswordUsers::from_file(folder + "/users"),
                              .rights_file = folder + "/rights"});
  const int port = node->listen_tcp(static_cast<std::uint16_t>(std::stoul(argv[4])), argv[3]);
  std::printf("ready: rrs+tcp://%s:%d/?nodeid=%s&service=lamp\n", argv[3], port,
              node->id().text().c_str());
  std::fflush(stdout);
  node.wait();
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "hardened_lamp: %s\n", error.what());
  return 1;
}
